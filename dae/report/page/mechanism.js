// The mechanism at the start: bodies as lines or polygons, joints, loops and ground as signs, a scale bar.

function mechanismSvg(width) {
  const { lines, points } = study.sketch;
  const all = [...lines.flatMap((line) => line.points), ...points.map((point) => point.at)];
  const xs = all.map((p) => p[0]), ys = all.map((p) => p[1]);
  const low = [Math.min(...xs), Math.min(...ys)], high = [Math.max(...xs), Math.max(...ys)];
  const span = [high[0] - low[0], high[1] - low[1]];
  const margin = { side: Math.min(90, 0.16 * width), top: 40, bottom: 84 };
  const scale = Math.min((width - 2 * margin.side) / (span[0] || 1e-9), 380 / (span[1] || 1e-9),
    span[0] || span[1] ? Infinity : 100);
  const height = Math.round(span[1] * scale + margin.top + margin.bottom);
  const left = (width - span[0] * scale) / 2;
  const place = ([x, y]) => [left + (x - low[0]) * scale, margin.top + (high[1] - y) * scale];

  const svg = drawing("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img",
    "aria-label": `The mechanism at the start. Bodies: ${lines.map((l) => l.body).join(", ")}. ` +
      points.map((p) => `${p.kind} ${p.name}`).join(", ") + "." });
  const taken = [];   // boxes of signs and names
  const bodies = [];  // small boxes along the bodies

  for (const line of lines) {
    const placed = line.points.map(place);
    const closed = placed.length > 2 &&
      Math.hypot(placed[0][0] - placed.at(-1)[0], placed[0][1] - placed.at(-1)[1]) < 0.5;
    svg.append(drawing(closed ? "polygon" : "polyline", {
      points: placed.map((p) => p.map((v) => v.toFixed(1)).join(",")).join(" "),
      fill: closed ? "var(--surface)" : "none", stroke: "var(--muted)",
      "stroke-width": closed ? 2.5 : 6, "stroke-linejoin": "round", "stroke-linecap": "round" }));
    placed.slice(1).forEach((end, k) => {
      const start = placed[k], pieces = Math.ceil(Math.hypot(end[0] - start[0], end[1] - start[1]) / 6) || 1;
      for (let i = 0; i <= pieces; ++i) {
        const at = (axis) => start[axis] + ((end[axis] - start[axis]) * i) / pieces;
        bodies.push({ x: at(0) - 4, y: at(1) - 4, w: 8, h: 8 });
      }
    });
  }

  for (const { kind, at, name } of points) {
    const [x, y] = place(at);
    taken.push({ x: x - 10, y: y - 10, w: 20, h: 20 });
    const ring = (r, stroke, fill = "var(--ground)") =>
      drawing("circle", { cx: x, cy: y, r, fill, stroke, "stroke-width": 2.5 });
    if (kind === "ground") {
      svg.append(drawing("path", { d: `M${x} ${y}l-11 16h22zM${x - 16} ${y + 16}h32m-28 7l5-7m4 7l5-7m4 7l5-7`,
        fill: "var(--ground)", stroke: "var(--ink)", "stroke-width": 2, "stroke-linejoin": "round" }));
      svg.append(ring(4, "var(--ink)"));
      taken.push({ x: x - 18, y, w: 36, h: 26 });
    } else if (kind === "loop") {
      svg.append(ring(9, "#d55e00"), ring(3.5, "#d55e00", "#d55e00"));
    } else if (kind === "marker") {
      svg.append(drawing("path", { d: `M${x - 7} ${y}h14M${x} ${y - 7}v14`, stroke: "var(--accent)", "stroke-width": 2.5 }));
    } else {
      svg.append(ring(5.5, "var(--ink)"));
    }
  }

  // Names stand in the nearest place where they cross neither a sign, nor a body, nor one another.
  const crossed = (box, weight, others) => weight * others.filter((other) =>
    box.x < other.x + other.w && box.x + box.w > other.x && box.y < other.y + other.h && box.y + box.h > other.y).length;
  const name = (text, [x, y], distance, quiet) => {
    if (!text) return;
    const w = textWidth(text) + 4, h = 18;
    let best = null;
    for (const d of [distance, 1.7 * distance, 2.6 * distance]) {
      for (let k = 0; k < 12; ++k) {
        const angle = (Math.PI * k) / 6;
        const cx = x + Math.cos(angle) * (d + w / 2), cy = y - Math.sin(angle) * (d + h / 2);
        const box = { x: cx - w / 2, y: cy - h / 2, w, h };
        const outside = box.x < 0 || box.x + w > width || box.y < 0 || box.y + h > height - 44;
        const cost = crossed(box, 100, taken) + crossed(box, 10, bodies) + (outside ? 1000 : 0) + d + k / 100;
        if (!best || cost < best.cost) best = { box, cost, cx, cy };
      }
    }
    taken.push(best.box);
    svg.append(drawing("text", { x: best.cx, y: best.cy + 5, "text-anchor": "middle", class: quiet ? "quiet" : "" }, text));
  };
  for (const point of points) name(point.kind === "loop" ? `loop ${point.name}` : point.name, place(point.at), 11, false);
  for (const line of lines) {
    const placed = line.points.map(place);
    const half = (placed.length - 1) / 2;
    const a = placed[Math.floor(half)], b = placed[Math.ceil(half)];
    name(line.body, [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], 9, true);
  }

  // The scale bar: 1, 2 or 5 times a power of ten, at most a third of the width.
  const most = Math.min(width / 3, 220) / scale;
  const decade = decadeFloor(most);
  const bar = decade * [5, 2, 1].find((m) => decade * m <= most * 1.0001);
  const y = height - 26, x = width / 2 - (bar * scale) / 2;
  svg.append(drawing("path", { d: `M${x} ${y - 5}v10m0-5h${bar * scale}m0-5v10`, stroke: "var(--ink)", "stroke-width": 2, fill: "none" }),
    drawing("text", { x: width / 2, y: y + 20, "text-anchor": "middle" }, `${number(bar)} m`));
  return svg;
}

/** The section with the drawing, or null without a sketch. */
function mechanismSection() {
  if (!study.sketch.lines.length && !study.sketch.points.length) return null;
  const frame = element("div", { class: "mechanism" });
  new ResizeObserver(() => requestAnimationFrame(() => {
    const width = Math.min(frame.clientWidth, 900);
    if (width > 0 && frame.firstChild?.getAttribute("width") !== String(width)) frame.replaceChildren(mechanismSvg(width));
  })).observe(frame);
  const kinds = new Set(study.sketch.points.map((point) => point.kind));
  const words = [["joint", "joints are circles"], ["loop", "loop closures double circles"], ["ground", "ground is hatched"],
    ["marker", "markers are crosses"]].filter(([kind]) => kinds.has(kind)).map(([, text]) => text).join(", ");
  return section("The mechanism at the start", words ? words[0].toUpperCase() + words.slice(1) + "." : "", frame);
}
