// Error against processor time, one marker per run; the rungs of a ladder are joined.

/** Order of the one-step methods drawn as a reference: error ∝ (evaluations)^−order. */
const methodOrder = { rk4: 4, dp5: 5, dop853: 8, vern9: 9 };

/**
 * spec: {yTitle, unit, value(run)} and the abscissa {xTitle, xUnit, cost(run)}; returns the figure, or null without
 * data. In a ladder the runs that no other beats in both are joined: the front.
 */
function scatterChart(spec) {
  const points = runs.map((run, i) => ({ run: i, x: spec.cost(run), y: spec.value(run) }))
    .filter((point) => measured(point.x) && measured(point.y) && point.x > 0)
    .map((point) => ({ ...point, y: Math.max(point.y, roundingFloor) }));
  if (!points.length) return null;
  const ladders = Map.groupBy ? Map.groupBy(points, (p) => runs[p.run].ladder) : grouped(points);
  const shown = [...ladders.keys()];
  const sorted = [...points].sort((a, b) => a.x - b.x);

  const best = points.filter((p) => runs[p.run].status === "done").sort((a, b) => a.y - b.y)[0];
  const alternative = `${spec.yTitle} against ${spec.xTitle}, ${points.length} runs. ` +
    (best ? `Smallest: ${runs[best.run].label}, ${number(best.y)} ${spec.unit} for ${number(best.x)} ${spec.xUnit}. ` : "") +
    "The table below has the numbers.";
  const { figure, plot, reading, names } = frameOf(spec, alternative, shown, (run) => near(run),
    (i) => (study.drift_study ? runs[i].label : runs[i].ladder_label));
  const width = plot.clientWidth || document.getElementById("main").clientWidth - 32;
  names.list.classList.add("wide");
  let highlighted = null;  // a ladder, from its legend entry
  let read = null;         // the point under the cursor

  const u = new uPlot({
    width,
    height: plotHeight(width),
    padding: [14, 20, 0, 0],
    legend: { show: false },
    cursor: { x: false, y: false, drag: { x: false, y: false }, points: { show: false } },
    scales: {
      x: { time: false, distr: 3, log: 10, range: nearSteps },
      y: { distr: 3, log: 10, range: wholeDecades },
    },
    axes: [
      { ...axisStyle, label: spec.xUnit === "s" ? `${spec.xTitle} [s]` : spec.xTitle, labelSize: 22, size: 34 },
      { ...axisStyle, size: 58 },
    ],
    series: [{}, { paths: () => null, points: { show: false } }],
    hooks: { drawAxes: [under], draw: [over], setCursor: [follow] },
  }, [sorted.map((p) => p.x), sorted.map((p) => p.y)], plot);

  const at = (p) => ({ x: u.valToPos(p.x, "x", true), y: u.valToPos(p.y, "y", true) });
  const visible = () => points.filter((p) => !hidden.has(runs[p.run].ladder));

  // Cheapest first, every next one better.
  const front = study.drift_study ? [] : sorted.filter((p) => runs[p.run].status === "done")
    .reduce((best, p) => (best.length && p.y >= best[best.length - 1].y ? best : [...best, p]), []);

  function frontLine() {
    if (front.length < 2) return;
    const { ctx } = u;
    ctx.save();
    ctx.lineWidth = 8 * uPlot.pxRatio;
    ctx.strokeStyle = theme("--rule");
    ctx.lineJoin = "round";
    ctx.beginPath();
    front.forEach((p, k) => {
      const { x, y } = at(p);
      if (k) ctx.lineTo(x, at(front[k - 1]).y);
      ctx[k ? "lineTo" : "moveTo"](x, y);
    });
    ctx.stroke();
    ctx.restore();
  }

  function under() {
    frontLine();
    floorLine(u);
    if (study.drift_study) return;
    const orders = [...new Set(visible().map((p) => methodOrder[runs[p.run].integrator]).filter(Boolean))];
    // Through a place where a ladder seldom is: right of the middle, high.
    const between = (scale, part) => scale.min ** (1 - part) * scale.max ** part;
    const x = between(u.scales.x, 0.6), y = between(u.scales.y, 0.75);
    for (const order of orders) powerLine(u, x, y, -order, `order ${order}`);
  }

  function over() {
    const { ctx } = u;
    for (const [ladder, rungs] of ladders) {
      if (hidden.has(ladder) || rungs.length < 2) continue;
      ctx.save();
      ctx.globalAlpha = highlighted === null || highlighted === ladder ? 1 : 0.15;
      ctx.lineWidth = 2 * uPlot.pxRatio;
      ctx.strokeStyle = inkOf(signs[ladder]);
      ctx.setLineDash(signs[ladder].dash.map((d) => d * uPlot.pxRatio));
      ctx.beginPath();
      rungs.forEach((p, k) => ctx[k ? "lineTo" : "moveTo"](at(p).x, at(p).y));
      ctx.stroke();
      ctx.restore();
    }
    for (const p of visible()) {
      const { x, y } = at(p);
      ctx.save();
      ctx.globalAlpha = highlighted === null || highlighted === runs[p.run].ladder ? 1 : 0.15;
      if (runs[p.run].status === "done") canvasMarker(ctx, signs[p.run], x, y, p === read ? 8 : 6);
      else canvasCross(ctx, x, y, inkOf(signs[p.run]));
      ctx.restore();
    }
    if (u.width >= 600 && !study.drift_study) nameLadders();
    else if (u.width >= 600) namePoints(visible().map((p) => ({ ...at(p), name: runs[p.run].label })));
  }

  // A ladder is named at its tightest rung.
  function nameLadders() {
    namePoints(shown.filter((ladder) => !hidden.has(ladder)).map((ladder) => {
      const last = ladders.get(ladder).reduce((a, b) => (b.y < a.y ? b : a));
      return { ...at(last), name: runs[ladder].ladder_label };
    }));
  }

  // Right, left, above or below its point, where neither another name nor a point is; else the legend has to do.
  function namePoints(named) {
    const ratio = uPlot.pxRatio, { bbox, ctx } = u;
    const taken = visible().map((p) => ({ x: at(p).x - 9 * ratio, y: at(p).y - 9 * ratio, w: 18 * ratio, h: 18 * ratio }));
    for (const { x, y, name } of named) {
      const w = textWidth(name) * ratio, h = 17 * ratio, d = 12 * ratio;
      const places = [[x + d, y - h / 2], [x - d - w, y - h / 2], [x - w / 2, y - d - h], [x - w / 2, y + d],
        [x + d, y - h - 2 * ratio], [x + d, y + 2 * ratio], [x - d - w, y - h - 2 * ratio], [x - d - w, y + 2 * ratio]];
      const free = places.find(([px, py]) =>
        px > bbox.left && px + w < bbox.left + bbox.width + 18 * ratio && py > bbox.top && py + h < bbox.top + bbox.height &&
        !taken.some((box) => px < box.x + box.w && px + w > box.x && py < box.y + box.h && py + h > box.y &&
          !(Math.abs(box.x + box.w / 2 - x) < 1 && Math.abs(box.y + box.h / 2 - y) < 1)));
      if (!free) continue;
      taken.push({ x: free[0], y: free[1], w, h });
      canvasText(ctx, name, free[0], free[1] + h / 2);
    }
  }

  function describe(p) {
    return spec.xUnit === "s" ? `${number(p.y)} in ${number(p.x)} s` : `${number(p.y)} with ${count(p.x)}`;
  }

  function follow() {
    const { left, top } = u.cursor;
    const before = read;
    read = null;
    if (left >= 0) {
      const distance = (p) => Math.hypot(u.valToPos(p.x, "x") - left, u.valToPos(p.y, "y") - top);
      const nearest = visible().sort((a, b) => distance(a) - distance(b))[0];
      if (nearest && distance(nearest) < 40) read = nearest;
    }
    fill();
    if (read !== before) u.redraw(false);
  }

  function fill() {
    reading.textContent = read
      ? `${runs[read.run].label}: ${describe(read)} (${runs[read.run].integrator}, ${runs[read.run].tolerance})`
      : `${study.drift_study ? "Each run" : "Smallest of each ladder"} [${spec.unit}]:`;
    for (const [ladder, item] of names.items) {
      const rungs = ladders.get(ladder);
      const p = rungs.includes(read) ? read : rungs.reduce((a, b) => (b.y < a.y ? b : a));
      item.value.textContent = (runs[p.run].status === "done" ? "" : "✕ ") + describe(p);
      item.button.classList.toggle("near", rungs.includes(read));
    }
  }

  function near(run) {
    highlighted = run;
    u.redraw(false);
  }

  function show() {
    for (const [run, item] of names.items) item.button.setAttribute("aria-pressed", String(!hidden.has(run)));
    u.redraw(false, true);
  }

  steerable(u, plot);
  fitted(u, plot);
  fill();
  charts.push({ shown, show, redraw: () => u.redraw(false, true) });
  return { figure, shown: points.map((p) => p.run) };
}

function grouped(points) {
  const ladders = new Map();
  for (const p of points) {
    const key = runs[p.run].ladder;
    ladders.set(key, [...(ladders.get(key) ?? []), p]);
  }
  return ladders;
}
