// One mechanism on a canvas: what is far is drawn first and paler, and every line has a rim of the ground, so that
// nearer ones pass in front of it.

const gapColour = "#d55e00";
const driveColour = "#009e73", loadColour = "#cc79a7";
const traceColour = () => theme("--accent");

/**
 * A canvas that shows a film at a time. show: {names, joints, loops, limits, masses, frames, traces, grid}; magnified(): the
 * factor of gaps. draw(t) returns what it drew, for those who read the page by program.
 */
function stageOf(canvas, film, camera, show, magnified) {
  const ctx = canvas.getContext("2d");
  let eye = null, width = 0, height = 0;
  const traces = picture.markers.map((marker) => {
    const stride = Math.max(1, Math.ceil(film.count / 3000));
    const points = [];
    for (let k = 0; k < film.count; k += stride) points.push([film.start + k * film.every, pointOf(film.frame(k, 0), marker.body, marker.at)]);
    return points;
  });

  function resize() {
    const ratio = devicePixelRatio || 1;
    width = canvas.clientWidth;
    height = canvas.clientHeight;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  function draw(t) {
    if (canvas.clientWidth !== width || canvas.clientHeight !== height) resize();
    if (!width || !height) return null;
    eye = camera.through(width, height);
    const state = film.at(t);
    const colours = { ground: theme("--ground"), ink: theme("--ink"), muted: theme("--muted"), rule: theme("--rule"), grid: theme("--grid"), body: theme("--body") };
    ctx.clearRect(0, 0, width, height);
    if (show.grid) camera.planar ? flatGrid(ctx, eye, camera, width, height, colours) : groundGrid(ctx, eye, camera, colours);

    const items = [];  // {depth, draw}
    const small = Math.min(1, Math.max(0.35, (10 * barWidth * eye.scale) / 42));  // of signs where links are short
    const fog = (depth) => (camera.planar ? 0 : (0.55 * (depth - eye.near)) / (eye.far - eye.near));
    // In pieces, each at its own depth; the ends are round.
    const bar = (a, b, colour, metres, least, most) => {
      const [from, to] = [eye.project(a), eye.project(b)];
      const pieces = camera.planar ? 1 : Math.min(16, Math.max(2, Math.ceil(Math.hypot(to[0] - from[0], to[1] - from[1]) / 20)));
      for (let i = 0; i < pieces; ++i) {
        const p = eye.project(mixed(a, b, i / pieces)), q = eye.project(mixed(a, b, (i + 1) / pieces));
        const depth = (p[2] + q[2]) / 2;
        const line = Math.min(most, Math.max(least, (metres * (p[3] + q[3])) / 2));
        const rim = blend(colours.ink, colours.ground, 0.35 + fog(depth)), inside = blend(colour, colours.ground, fog(depth));
        const ends = [...(i ? [] : [p]), ...(i + 1 < pieces ? [] : [q])];
        items.push({ depth, draw: () => {
          const away = 0.7 / (Math.hypot(q[0] - p[0], q[1] - p[1]) || 1), dx = away * (q[0] - p[0]), dy = away * (q[1] - p[1]);
          const thick = (stroke, wide, over) => {
            ctx.strokeStyle = ctx.fillStyle = stroke;
            ctx.lineWidth = wide;
            ctx.lineCap = "butt";
            ctx.beginPath();
            ctx.moveTo(p[0] - over * dx, p[1] - over * dy);
            ctx.lineTo(q[0] + over * dx, q[1] + over * dy);
            ctx.stroke();
            if (over) for (const end of ends) { disc(ctx, end, wide / 2); ctx.fill(); }
          };
          thick(colours.ground, line + 3, 0);
          thick(rim, line, 1);
          thick(inside, line - Math.min(2.4, 0.45 * line), 1);
        } });
      }
    };
    const light = unit(plus(plus(scaled(eye.right, -0.35), scaled(eye.up, 0.75)), scaled(eye.toEye(camera.world(camera.middle)), 0.6)));

    for (const part of parts) {
      const base = part.colour ?? colours.body, turn = part.body < 0 ? [1, 0, 0, 0] : state.turns[part.body];
      if (part.ball) {
        const p = eye.project(pointOf(state, part.body, part.middle));
        items.push({ depth: p[2], draw: () => {
          const r = Math.max(2, part.ball * p[3]);
          const glow = ctx.createRadialGradient(p[0] - 0.35 * r, p[1] - 0.4 * r, 0.1 * r, p[0], p[1], r);
          glow.addColorStop(0, blend(base, "#ffffff", 0.45));
          glow.addColorStop(1, blend(base, colours.ground, fog(p[2])));
          ctx.fillStyle = glow;
          ctx.strokeStyle = blend(colours.ink, colours.ground, 0.45 + fog(p[2]));
          ctx.lineWidth = 1;
          disc(ctx, p, r);
          ctx.fill();
          ctx.stroke();
        } });
        continue;
      }
      const corners = part.corners.map((c) => pointOf(state, part.body, c)), projected = corners.map(eye.project);
      part.faces.forEach((face, i) => {
        const normal = turned(turn, part.normals[i]);
        if (inner(normal, eye.toEye(corners[face[0]])) <= 0) return;
        const outline = face.map((k) => projected[k]);
        const depth = outline.reduce((m, p) => m + p[2], 0) / outline.length, shade = inner(normal, light);
        items.push({ depth, draw: () => {
          trace(ctx, outline);
          ctx.fillStyle = ctx.strokeStyle = blend(shadedHex(base, shade), colours.ground, fog(depth));
          ctx.fill();
          ctx.lineJoin = "round";
          ctx.lineWidth = 0.8;
          if (part.edged || face.length > 4) ctx.strokeStyle = blend(colours.ink, colours.ground, 0.45 + fog(depth));
          ctx.stroke();
        } });
      });
    }
    for (const wheel of wheels) {
      const teeth = 24, middle = eye.project(pointOf(state, wheel.body, wheel.middle));
      const rim = Array.from({ length: 4 * teeth }, (_, k) => eye.project(pointOf(state, wheel.body, wheel.rim(k / (4 * teeth), k % 4 < 2 ? 1.03 : 0.97))));
      items.push({ depth: middle[2] + 1e-9, draw: () => {
        trace(ctx, rim);
        ctx.globalAlpha = 0.35;
        ctx.fillStyle = colours.body;
        ctx.fill();
        ctx.globalAlpha = 1;
        stroke(ctx, [...rim, rim[0]], blend(colours.ink, colours.ground, 0.35), 1.4);
        stroke(ctx, [middle, rim[0]], blend(colours.ink, colours.ground, 0.35), 1.4);  // shows how far it turned
      } });
    }

    for (const line of picture.strokes ?? []) {  // slots and outlines
      const way = line.points.map((p) => eye.project(pointOf(state, line.body, p)));
      if (line.closed) way.push(way[0]);
      const depth = way.reduce((m, p) => m + p[2], 0) / way.length;
      items.push({ depth, draw: () => stroke(ctx, way, blend(colours.ink, colours.ground, 0.25 + fog(depth)), 1.8) });
    }
    picture.bodies.forEach((body, k) => {
      const { bars, sheet } = solids[k];
      const place = (p) => pointOf(state, k, p);
      if (sheet) {
        const projected = sheet.map((c) => eye.project(place(c)));
        const depth = projected.reduce((m, p) => Math.max(m, p[2]), -Infinity) + 1e-6;
        items.push({ depth, draw: () => {
          trace(ctx, projected);
          ctx.globalAlpha = 0.35;
          ctx.fillStyle = colours.body;
          ctx.fill();
          ctx.globalAlpha = 1;
        } });
      }
      const metres = ["cylinder", "box", "sphere"].includes(body.shape) ? 0.5 * barWidth : barWidth;
      const colour = body.pale ? colours.rule : colours.body;
      for (const [a, b] of bars) bar(place(a), place(b), colour, metres, 2, camera.planar ? 9 : 13);
      if (show.frames) {
        const origin = place([0, 0, 0]);
        ["#d55e00", "#009e73", "#0072b2"].forEach((colour, i) => {
          const tip = place([0, 1, 2].map((j) => (i === j ? 2.2 * barWidth : 0)));
          items.push({ depth: eye.project(origin)[2] - 1e-9, draw: () => stroke(ctx, [eye.project(origin), eye.project(tip)], colour, 2) });
        });
      }
      if (show.masses) {
        const p = eye.project(place(body.com));
        items.push({ depth: -Infinity, draw: () => quartered(ctx, p, 6, colours) });  // seen through the body
      }
    });

    for (const spring of picture.springs) {
      const a = pointOf(state, spring.parent, spring.at_parent), b = pointOf(state, spring.child, spring.at_child);
      const p = eye.project(a), q = eye.project(b);
      items.push({ depth: (p[2] + q[2]) / 2, draw: () => between(ctx, p, q, spring.kind, blend(colours.muted, colours.ground, 0.5 * fog((p[2] + q[2]) / 2))) });
    }
    for (const load of picture.loads) {
      const at = pointOf(state, load.body, load.at), p = eye.project(at);
      const way = load.in_body && load.body >= 0 ? turned(state.turns[load.body], load.force) : load.force;
      if (norm(way) > 0) {
        const tip = eye.project(plus(at, scaled(unit(way), 0.15 * Math.max(...camera.span))));
        items.push({ depth: -1e9, draw: () => arrow(ctx, p, tip, loadColour) });
      }
      if (norm(load.torque) > 0) items.push({ depth: -1e9, draw: () => roundArrow(ctx, p, 15 * small, loadColour) });
    }
    picture.bodies.forEach((body, k) => {
      if (!show.joints || !(body.spring || body.damper || body.drive || body.torque)) return;
      const at = eye.project(pointOf(state, k, body.at_child));
      items.push({ depth: at[2] - 2.4 * barWidth, draw: () => {
        if (body.spring) spiral(ctx, at, 11 * small, colours.muted);
        if (body.damper) cup(ctx, at, 13 * small, colours.muted);
        if (body.drive) roundArrow(ctx, at, 15 * small, driveColour);
        if (body.torque) roundArrow(ctx, at, 18 * small, loadColour);
      } });
    });

    const labels = [];
    const nearer = camera.planar ? 0 : 1.2 * barWidth;
    if (show.limits) for (const range of ranges) {
      const ends = range.points(state).map(eye.project), now = range.now(state).map(eye.project);
      items.push({ depth: -1e8, draw: () => {
        stroke(ctx, ends, colours.muted, 1.2);
        for (const bound of [ends.slice(0, 2), ends.slice(-2)]) stroke(ctx, bound, colours.muted, 1.6);
        stroke(ctx, now, range.passed(state) ? gapColour : colours.muted, range.passed(state) ? 2.4 : 1.2);
      } });
    }
    if (show.joints) {
      picture.bodies.forEach((body, k) => {
        if (body.kind === "free") return;
        const at = eye.project(pointOf(state, k, body.at_child));
        const ground = body.parent < 0;
        items.push({ depth: at[2] - nearer, draw: () => (ground ? groundSign(ctx, at, colours, small) : ring(ctx, at, 4.5 * small, colours.ink, colours.ground)) });
        if (!body.pale) labels.push({ at, text: body.joint, quiet: false, off: 11 });
      });
    }
    if (show.loops) {
      const factor = magnified();
      picture.loops.forEach((loop, i) => {
        const b = pointOf(state, loop.child, loop.at_child);
        const a = loop.kind === "distance" ? pointOf(state, loop.parent, loop.at_parent) : minus(b, state.gaps[i]);
        const apart = plus(loop.kind === "distance" ? b : a, scaled(state.gaps[i], factor));
        const end = eye.project(loop.kind === "distance" ? b : a), open = eye.project(apart);
        if (loop.kind === "distance") {
          const from = eye.project(a);
          items.push({ depth: (from[2] + end[2]) / 2, draw: () => stroke(ctx, [from, end], gapColour, 2, [6, 4]) });
        }
        items.push({ depth: Math.min(end[2], open[2]) - 2 * nearer, draw: () => {
          const pixels = Math.hypot(open[0] - end[0], open[1] - end[1]);
          if (pixels > 1) {
            stroke(ctx, [end, open], colours.ground, 7);
            stroke(ctx, [end, open], gapColour, 3.5);
          }
          ring(ctx, end, 7 * small, gapColour, colours.ground);
          disc(ctx, pixels > 1 ? open : end, 3.2 * small);
          ctx.fillStyle = gapColour;
          ctx.fill();
        } });
        if (!picture.bodies[loop.child]?.pale) labels.push({ at: end, text: `loop ${loop.name}`, quiet: false, off: 13 });
      });
    }
    if (show.traces) {
      traces.forEach((points) => {
        const past = points.filter(([when]) => when <= t + 1e-12).map(([, p]) => eye.project(p));
        if (past.length > 1) items.push({ depth: camera.planar ? Infinity : past.reduce((m, p) => m + p[2], 0) / past.length, draw: () => { ctx.globalAlpha = 0.75; stroke(ctx, past, traceColour(), 1.4); ctx.globalAlpha = 1; } });
      });
    }
    picture.markers.forEach((marker) => {
      const at = eye.project(pointOf(state, marker.body, marker.at));
      items.push({ depth: at[2] - 2 * nearer, draw: () => {
        stroke(ctx, [[at[0] - 6, at[1]], [at[0] + 6, at[1]]], traceColour(), 2.2);
        stroke(ctx, [[at[0], at[1] - 6], [at[0], at[1] + 6]], traceColour(), 2.2);
      } });
      if (show.names && !picture.bodies[marker.body]?.pale) labels.push({ at, text: marker.name, quiet: false, off: 11 });
    });
    if (show.names) {
      picture.bodies.forEach((body, k) => {
        if (body.pale) return;
        const { bars } = solids[k];
        const middle = bars.length === 1 ? mixed(...bars[0], 0.5) : scaled(body.ends.reduce(plus), 1 / body.ends.length);
        labels.push({ at: eye.project(pointOf(state, k, middle)), text: body.name, quiet: true, off: 10 });
      });
    }

    items.sort((a, b) => b.depth - a.depth);
    for (const item of items) item.draw();
    if (show.names) name(ctx, labels, width, height, colours);
    camera.planar ? scaleBar(ctx, eye.scale, width, height, colours) : triad(ctx, eye, height, colours);
    return state;
  }
  return { draw, film, eye: () => eye ?? camera.through(canvas.clientWidth, canvas.clientHeight) };
}
