// Signs and lines of a picture on a canvas: joints, mass centres, springs, grids, axes, a scale bar, names.

/** "#rrggbb" towards another by a part. */
function blend(from, to, part) {
  const channels = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
  const [a, b] = [channels(from), channels(to)];
  return `rgb(${a.map((x, i) => Math.round(x + (b[i] - x) * Math.min(1, Math.max(0, part)))).join(" ")})`;
}

/** "#rrggbb" lit from where `shade`, the cosine to the light, is positive. */
function shadedHex(hex, shade) {
  const lit = shade > 0 ? blend(hex, "#ffffff", 0.3 * shade) : blend(hex, "#000000", -0.4 * shade);
  return "#" + lit.match(/\d+/g).map((x) => Number(x).toString(16).padStart(2, "0")).join("");
}

/** step of a grid or a scale bar: 1, 2 or 5 times a power of ten, at most `most`. */
function roundLength(most) {
  const decade = decadeFloor(most);
  return decade * [5, 2, 1].find((m) => decade * m <= most * 1.0001);
}

function trace(ctx, points) {
  ctx.beginPath();
  points.forEach((p, k) => ctx[k ? "lineTo" : "moveTo"](p[0], p[1]));
  ctx.closePath();
}
function stroke(ctx, points, colour, line, dash = []) {
  ctx.strokeStyle = colour;
  ctx.lineWidth = line;
  ctx.lineCap = "round";
  ctx.lineJoin = "round";
  ctx.setLineDash(dash);
  ctx.beginPath();
  points.forEach((p, k) => ctx[k ? "lineTo" : "moveTo"](p[0], p[1]));
  ctx.stroke();
  ctx.setLineDash([]);
}
function disc(ctx, p, r) {
  ctx.beginPath();
  ctx.arc(p[0], p[1], r, 0, 2 * Math.PI);
}
function ring(ctx, p, r, colour, fill) {
  disc(ctx, p, r);
  ctx.fillStyle = fill;
  ctx.fill();
  ctx.strokeStyle = colour;
  ctx.lineWidth = Math.min(2.2, 0.5 * r);
  ctx.stroke();
}
/** The sign of a mass centre: quarters black and white by turns. */
function quartered(ctx, p, r, colours) {
  ring(ctx, p, r, colours.ink, colours.ground);
  ctx.fillStyle = colours.ink;
  for (const from of [0, Math.PI]) {
    ctx.beginPath();
    ctx.moveTo(p[0], p[1]);
    ctx.arc(p[0], p[1], r, from, from + Math.PI / 2);
    ctx.fill();
  }
}
function groundSign(ctx, [x, y], colours, small) {
  ctx.beginPath();
  ctx.moveTo(x, y);
  ctx.lineTo(x - 9 * small, y + 13 * small);
  ctx.lineTo(x + 9 * small, y + 13 * small);
  ctx.closePath();
  ctx.fillStyle = colours.ground;
  ctx.fill();
  ctx.strokeStyle = colours.ink;
  ctx.lineWidth = 1.8;
  ctx.lineJoin = "round";
  ctx.stroke();
  stroke(ctx, [[x - 13 * small, y + 13 * small], [x + 13 * small, y + 13 * small]], colours.ink, 1.8);
  ring(ctx, [x, y], 4 * small, colours.ink, colours.ground);
}
/** A spring: straight, windings, straight. */
function coil(ctx, p, q, colour) {
  const length = Math.hypot(q[0] - p[0], q[1] - p[1]) || 1;
  const along = [(q[0] - p[0]) / length, (q[1] - p[1]) / length], across = [-along[1], along[0]];
  const turns = 9, wide = Math.min(7, 0.12 * length);
  const points = [p];
  for (let k = 0; k <= 2 * turns; ++k) {
    const at = length * (0.15 + (0.7 * k) / (2 * turns)), off = k % 2 ? wide : -wide;
    points.push([p[0] + along[0] * at + across[0] * off, p[1] + along[1] * at + across[1] * off]);
  }
  stroke(ctx, [...points, q], colour, 1.5);
}

/** A damper: a rod with a piston in a cup. */
function dashpot(ctx, p, q, colour) {
  const length = Math.hypot(q[0] - p[0], q[1] - p[1]) || 1, wide = Math.min(7, 0.12 * length);
  const at = (along, across) => [p[0] + ((q[0] - p[0]) * along) + ((p[1] - q[1]) * across) / length, p[1] + ((q[1] - p[1]) * along) + ((q[0] - p[0]) * across) / length];
  stroke(ctx, [p, at(0.35, 0)], colour, 1.5);
  stroke(ctx, [at(0.62, wide), at(0.35, wide), at(0.35, -wide), at(0.62, -wide)], colour, 1.5);
  stroke(ctx, [at(0.5, 0.7 * wide), at(0.5, -0.7 * wide)], colour, 2);
  stroke(ctx, [at(0.5, 0), q], colour, 1.5);
}
/** What acts between two points: a spring, a damper, or both side by side. */
function between(ctx, p, q, kind, colour) {
  if (kind !== "spring-damper") return kind === "damper" ? dashpot(ctx, p, q, colour) : coil(ctx, p, q, colour);
  const length = Math.hypot(q[0] - p[0], q[1] - p[1]) || 1, off = [(-6 * (q[1] - p[1])) / length, (6 * (q[0] - p[0])) / length];
  const beside = (x, s) => [x[0] + s * off[0], x[1] + s * off[1]];
  coil(ctx, beside(p, 1), beside(q, 1), colour);
  dashpot(ctx, beside(p, -1), beside(q, -1), colour);
  for (const x of [p, q]) stroke(ctx, [beside(x, 1), beside(x, -1)], colour, 1.5);
}
/** A spring about a joint. */
function spiral(ctx, [x, y], r, colour) {
  stroke(ctx, Array.from({ length: 49 }, (_, k) => {
    const w = (2.5 * 2 * Math.PI * k) / 48, s = r * (0.45 + (0.75 * k) / 48);
    return [x + s * Math.cos(w), y - s * Math.sin(w)];
  }), colour, 1.5);
}
/** A damper about a joint: an arc with its ends closed. */
function cup(ctx, [x, y], r, colour) {
  const arc = (s, n) => Array.from({ length: n }, (_, k) => [x + s * Math.cos(0.5 + k / (n - 1) * 1.6), y + s * Math.sin(0.5 + k / (n - 1) * 1.6)]);
  const [inside, outside] = [arc(0.8 * r, 12), arc(1.25 * r, 12)];
  stroke(ctx, [...inside, ...outside.reverse()], colour, 1.5);
}
function arrowHead(ctx, tip, angle, colour) {
  ctx.beginPath();
  ctx.moveTo(...tip);
  for (const s of [-0.42, 0.42]) ctx.lineTo(tip[0] - 9 * Math.cos(angle + s), tip[1] - 9 * Math.sin(angle + s));
  ctx.closePath();
  ctx.fillStyle = colour;
  ctx.fill();
}
function arrow(ctx, p, q, colour) {
  stroke(ctx, [p, q], colour, 2.4);
  arrowHead(ctx, q, Math.atan2(q[1] - p[1], q[0] - p[0]), colour);
}
/** What turns a joint: three quarters of a circle with a head. */
function roundArrow(ctx, [x, y], r, colour) {
  const way = Array.from({ length: 25 }, (_, k) => 0.4 - (k / 24) * 1.5 * Math.PI).map((w) => [x + r * Math.cos(w), y + r * Math.sin(w)]);
  stroke(ctx, way, colour, 2);
  arrowHead(ctx, way[24], Math.atan2(way[24][1] - way[22][1], way[24][0] - way[22][0]), colour);
}

/** Squares of a round length on the plane, behind everything. */
function flatGrid(ctx, eye, camera, width, height, colours) {
  const step = roundLength(110 / eye.scale);
  const origin = eye.project([0, 0, 0]);
  ctx.strokeStyle = colours.grid;
  ctx.lineWidth = 1;
  ctx.beginPath();
  for (let x = origin[0] - Math.floor(origin[0] / (step * eye.scale)) * step * eye.scale; x < width; x += step * eye.scale) {
    ctx.moveTo(x, 0);
    ctx.lineTo(x, height);
  }
  for (let y = origin[1] - Math.floor(origin[1] / (step * eye.scale)) * step * eye.scale; y < height; y += step * eye.scale) {
    ctx.moveTo(0, y);
    ctx.lineTo(width, y);
  }
  ctx.stroke();
}
/** Squares on the level of the lowest point, around the mechanism; what lies behind the eye is left out. */
function groundGrid(ctx, eye, camera, colours) {
  const step = roundLength(camera.size / 3.5);
  const reach = Math.ceil((0.9 * camera.size) / step);
  const snap = (x) => Math.round(x / step) * step;
  const [cx, cz, level] = [snap(camera.middle[0]), snap(camera.middle[2]), camera.low[1] - 0.02 * camera.size];
  const line = (x0, z0, x1, z1) => {
    const [p, q] = [eye.project(camera.world([x0, level, z0])), eye.project(camera.world([x1, level, z1]))];
    ctx.moveTo(p[0], p[1]);
    ctx.lineTo(q[0], q[1]);
  };
  ctx.strokeStyle = colours.grid;
  ctx.lineWidth = 1;
  ctx.beginPath();
  for (let i = -reach; i <= reach; ++i) {
    line(cx + i * step, cz - reach * step, cx + i * step, cz + reach * step);
    line(cx - reach * step, cz + i * step, cx + reach * step, cz + i * step);
  }
  ctx.stroke();
  const corner = eye.project(camera.world([cx + reach * step, level, cz + reach * step]));
  ctx.fillStyle = colours.muted;
  ctx.font = font;
  ctx.textAlign = "center";
  ctx.fillText(`squares of ${number(step)} m`, Math.min(Math.max(corner[0], 80), ctx.canvas.clientWidth - 80), Math.min(corner[1] + 20, ctx.canvas.clientHeight - 8));
}
/** The ground's axes in the corner. */
function triad(ctx, eye, height, colours) {
  const from = [40, height - 40];
  const axes = [["x", [1, 0, 0], "#d55e00"], ["y", [0, 1, 0], "#009e73"], ["z", [0, 0, 1], "#0072b2"]]
    .map(([text, axis, colour]) => [text, inner(axis, eye.right), inner(axis, eye.up), colour]);
  for (const [text, x, y, colour] of axes) {
    const tip = [from[0] + 26 * x, from[1] - 26 * y];
    stroke(ctx, [from, tip], colour, 2.4);
    ctx.fillStyle = colours.ink;
    ctx.font = font;
    ctx.textAlign = "center";
    ctx.textBaseline = "middle";
    ctx.fillText(text, from[0] + 36 * x, from[1] - 36 * y);
  }
  ctx.textBaseline = "alphabetic";
}
function scaleBar(ctx, scale, width, height, colours) {
  const bar = roundLength(Math.min(width / 4, 180) / scale);
  const x = 16, y = height - 14;
  stroke(ctx, [[x, y - 5], [x, y], [x + bar * scale, y], [x + bar * scale, y - 5]], colours.ink, 1.8);
  ctx.fillStyle = colours.ink;
  ctx.font = font;
  ctx.textAlign = "left";
  ctx.fillText(`${number(bar)} m`, x + 6, y - 7);
}

/** Names in the nearest place where they cross neither a sign nor one another; those that find none are left out. */
function name(ctx, labels, width, height, colours) {
  const taken = labels.map(({ at }) => ({ x: at[0] - 8, y: at[1] - 8, w: 16, h: 16 }));
  const crossed = (box) => taken.some((other) =>
    box.x < other.x + other.w && box.x + box.w > other.x && box.y < other.y + other.h && box.y + box.h > other.y);
  ctx.font = font;
  ctx.textBaseline = "middle";
  ctx.textAlign = "center";
  ctx.lineJoin = "round";
  const once = labels.filter(({ at, text }, i) =>  // a marker often has the name of the joint it sits on
    labels.findIndex((other) => other.text === text && Math.hypot(other.at[0] - at[0], other.at[1] - at[1]) < 12) === i);
  for (const { at, text, quiet, off } of once.sort((a, b) => a.quiet - b.quiet)) {
    if (!text) continue;
    const w = textWidth(text) + 4, h = 17;
    let best = null;
    for (const d of [off, 1.8 * off]) {
      for (let k = 0; k < 12 && !best; ++k) {
        const angle = (Math.PI * (k + 1)) / 6;
        const cx = at[0] + Math.cos(angle) * (d + w / 2), cy = at[1] - Math.sin(angle) * (d + h / 2);
        const box = { x: cx - w / 2, y: cy - h / 2, w, h };
        const inside = box.x > 0 && box.x + w < width && box.y > 0 && box.y + h < height;
        if (inside && !crossed(box)) best = { box, cx, cy };
      }
    }
    if (!best) continue;
    taken.push(best.box);
    ctx.lineWidth = 4;
    ctx.strokeStyle = colours.ground;
    ctx.strokeText(text, best.cx, best.cy);
    ctx.fillStyle = quiet ? colours.muted : colours.ink;
    ctx.fillText(text, best.cx, best.cy);
  }
  ctx.textBaseline = "alphabetic";
}
