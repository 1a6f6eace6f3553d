// A quantity over time, both axes logarithmic: strong the largest value so far, faint the value itself.

/** Points of run i, clipped at the floor, with the running maximum; null where it has none. */
function historyOf(i, key) {
  const series = runs[i].series[key];
  if (!series || series.t.length < 1) return null;
  const y = series.y.map((value) => Math.max(value, roundingFloor));
  let largest = 0;
  const top = y.map((value) => (largest = Math.max(largest, value)));
  const wavy = y.some((value, k) => value < 0.8 * top[k]);
  return { run: i, t: series.t, y, top, wavy };
}

/** The last point at or before t; the first one before that. */
function pointAt(curve, t) {
  let low = 0, high = curve.t.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (curve.t[middle] <= t) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** spec: {key, yTitle, unit, slopes}; returns the figure, or null without data. */
function historyChart(spec) {
  const curves = runs.map((run, i) => historyOf(i, spec.key)).filter(Boolean);
  if (!curves.length) return null;
  const shown = curves.map((curve) => curve.run);

  // One column of data per line drawn: outlines and faint lines lie under the strong ones.
  const lines = [];
  for (const curve of curves) if (curve.wavy) lines.push({ curve, y: curve.y, kind: "faint" });
  for (const curve of curves) {
    if (signs[curve.run].colour === yellow) lines.push({ curve, y: curve.top, kind: "outline" });
    lines.push({ curve, y: curve.top, kind: "strong" });
  }
  const data = uPlot.join(lines.map((line) => [line.curve.t, line.y]));

  const faintness = curves.length > 6 ? 0.2 : 0.4;  // many oscillations over one another would hide the lines

  const worst = curves.reduce((a, b) => (b.top.at(-1) > a.top.at(-1) ? b : a));
  const least = curves.reduce((a, b) => (b.top.at(-1) < a.top.at(-1) ? b : a));
  const alternative = `${spec.yTitle} over time, ${curves.length} ${curves.length === 1 ? "curve" : "curves"}. ` +
    `Largest: ${runs[worst.run].label}, ${number(worst.top.at(-1))} ${spec.unit}. ` +
    `Smallest: ${runs[least.run].label}, ${number(least.top.at(-1))} ${spec.unit}. The table below has the numbers.`;

  const { figure, plot, reading, names } = frameOf(spec, alternative, shown, (run) => near(run));
  const width = plot.clientWidth || document.getElementById("main").clientWidth - 32;
  const room = () => labelRoom(u?.width ?? width, shown);
  let times = [0, Infinity];  // what the horizontal axis spans; known before the vertical one is asked for
  let u;
  u = new uPlot({
    width,
    height: plotHeight(width),
    padding: [10, () => room() || 14, 0, 0],
    legend: { show: false },
    cursor: {
      sync: { key: "time" },
      y: false,
      points: { show: (plotted, s) => (lines[s - 1].kind === "strong" ? dot(lines[s - 1].curve.run) : null) },
    },
    scales: {
      x: { time: false, distr: 3, log: 10, range: (plotted, low, high) => (times = [low, high > low ? high : low * 10]) },
      y: { distr: 3, log: 10, range: (plotted) => wholeDecades(plotted, ...extent(...times)) },
    },
    axes: [
      { ...axisStyle, label: "time t [s]", labelSize: 22, size: 34 },
      { ...axisStyle, size: 58 },
    ],
    series: [{}, ...lines.map(({ curve, kind }) => ({
      stroke: () => (kind === "outline" ? theme("--outline") : inkOf(signs[curve.run])),
      width: { faint: 0.75, outline: 5, strong: 2.5 }[kind],
      dash: kind === "faint" ? [] : signs[curve.run].dash,
      alpha: kind === "faint" ? faintness : 1,
      cap: kind === "faint" ? "butt" : "round",
      spanGaps: true,
      points: { show: false },
    }))],
    hooks: { drawAxes: [under], draw: [over], setCursor: [read] },
  }, data, plot);

  function visible() {
    return curves.filter((curve) => !hidden.has(curve.run));
  }

  // What the vertical axis has to hold: the strong lines, and of the faint ones what reaches two decades below them.
  function extent(min, max) {
    let low = Infinity, faint = Infinity, high = 0;
    for (const curve of visible()) {
      curve.t.forEach((t, k) => {
        if (t < min || t > max) return;
        low = Math.min(low, curve.top[k]);
        faint = Math.min(faint, curve.y[k]);
        high = Math.max(high, curve.top[k]);
      });
    }
    return high > 0 ? [Math.max(faint, low / 100), high] : [null, null];
  }

  // The steepest line runs three times above the largest curve's end; the others start where it does.
  function under() {
    floorLine(u);
    if (!spec.slopes.length || !visible().length) return;
    const largest = visible().reduce((a, b) => (b.top.at(-1) > a.top.at(-1) ? b : a));
    const steepest = Math.max(...spec.slopes);
    const start = largest.t[0], end = largest.t.at(-1);
    const y = Math.max(3 * largest.top.at(-1) * (start / end) ** steepest, u.scales.y.min);
    for (const slope of spec.slopes) powerLine(u, start, y, slope, slope === 1 ? "∝ t" : `∝ t${raised(slope)}`);
  }

  function over() {
    const ends = visible().map((curve) => ({
      run: curve.run,
      x: u.valToPos(curve.t.at(-1), "x", true),
      y: u.valToPos(curve.top.at(-1), "y", true),
      inside: curve.t.at(-1) <= u.scales.x.max * 1.0001,
    })).filter((end) => end.inside);
    if (room()) endLabels(u, ends);
    for (const end of ends) {
      if (runs[end.run].status !== "done") canvasCross(u.ctx, end.x, end.y, theme("--failed"));
      else if (manyIntegrators) canvasMarker(u.ctx, signs[end.run], end.x, end.y, 4.5);
    }
  }

  function read() {
    const asked = u.cursor.left >= 0 ? u.posToVal(u.cursor.left, "x") : null;
    reading.textContent = asked === null
      ? `At the end of each run [${spec.unit}]:`
      : `At t = ${number(asked, 3)} s [${spec.unit}]:`;
    for (const curve of curves) {
      const last = curve.t.length - 1;
      const k = asked === null ? last : pointAt(curve, asked);
      const stopped = runs[curve.run].status !== "done" && (asked === null || asked > curve.t[last] * 1.001);
      names.items.get(curve.run).value.textContent =
        (stopped ? "✕ " : "") + (curve.top[k] <= roundingFloor ? "0" : number(curve.top[k]));
    }
  }

  function near(run) {
    lines.forEach((line, k) => {
      const base = line.kind !== "faint" ? 1 : run === line.curve.run ? 0.7 : faintness;
      u.series[k + 1].alpha = run === null || run === line.curve.run ? base : 0.15 * base;
    });
    u.redraw(false);
  }

  function show() {
    u.batch(() => lines.forEach((line, k) => u.setSeries(k + 1, { show: !hidden.has(line.curve.run) })));
    for (const [run, item] of names.items) item.button.setAttribute("aria-pressed", String(!hidden.has(run)));
    u.redraw(false, true);
  }

  steerable(u, plot);
  fitted(u, plot);
  read();
  charts.push({ shown, show, redraw: () => u.redraw(false, true) });
  return { figure, shown, csv: () => historyCsv(spec, curves) };
}

function dot(run) {
  const node = element("div", { class: "dot" });
  const sign = signs[run];
  node.style.background = palette[sign.colour] === "ink" ? "var(--ink)" : palette[sign.colour];
  return node;
}

function historyCsv(spec, curves) {
  const rows = ["run,t [s]," + csvCell(`${spec.key} [${spec.unit}]`)];
  for (const { run } of curves) {
    const { t, y } = runs[run].series[spec.key];
    t.forEach((time, k) => rows.push(`${csvCell(runs[run].label)},${time},${y[k]}`));
  }
  return rows.join("\n") + "\n";
}
