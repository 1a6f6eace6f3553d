// Curves over the clock's time, linear in t: one chart for each unit. A line marks the clock's time in all of them; the
// pointer over a chart sets it while nothing plays, a click or a touch always.

/** chart: {key, title, y_title, unit, log, t, curves: [{name, y, colour, dash}]}. */
function timelineChart(chart, clock) {
  const off = new Set(chart.curves.map((_, i) => i).filter((i) => i >= 8));
  const plot = element("div", { class: "plot", tabindex: "0", role: "img", "aria-label":
    `${chart.title} over ${chart.x_title ?? "time"}: ${chart.curves.map((c) => c.name).slice(0, 20).join(", ")}.` });
  const list = element("ul", { class: "legend" });
  const alone = chart.curves.length === 1;
  const axisTitle = element("p", { class: "axis-title" }, element("span", {}, `↑ ${chart.y_title}`));
  const figure = element("figure", { class: "timeline" }, element("h3", {}, chart.title), axisTitle, plot, list);
  const colourOf = (curve) => (palette[curve.colour] === "ink" ? theme("--ink") : palette[curve.colour]);
  const floor = chart.log ? roundingFloor : -Infinity;
  const data = [chart.t, ...chart.curves.map((c) => c.y.map((y) => (y === null ? null : Math.max(y, floor))))];
  const height = (width) => Math.round(Math.min(260, Math.max(190, 0.36 * width)));
  const now = element("div", { class: "now" });

  const u = new uPlot({
    width: 600, height: 220, padding: [8, 14, 0, 0],
    legend: { show: false },
    cursor: { show: false, drag: { x: false, y: false } },
    scales: {
      x: { time: false, range: () => [clock.start, clock.end > clock.start ? clock.end : clock.start + 1] },
      y: chart.log ? { distr: 3, log: 10, range: wholeDecades } : { range: (plotted, low, high) => roomAround(low, high) },
    },
    axes: [
      { ...axisStyle, splits: undefined, values: (plotted, ticks) => ticks.map(plain), filter: undefined, label: chart.x_title ?? "time t [s]", labelSize: 22, size: 32, space: 70 },
      chart.log ? { ...axisStyle, size: 58 } : { ...axisStyle, splits: undefined, filter: undefined, values: (plotted, ticks) => ticks.map(plain), size: 58, space: 36 },
    ],
    series: [{}, ...chart.curves.map((curve, i) => ({
      show: !off.has(i), stroke: () => colourOf(curve), width: 2, dash: curve.dash, points: { show: false }, spanGaps: false,
    }))],
    hooks: { setSize: [place], ready: [place] },
  }, data, plot);
  u.over.append(now);

  if (chart.left_out) figure.append(element("p", { class: "axis-title" }, `${many(chart.left_out, "more curve")} in ${chart.file ?? "trajectory.csv"}`));
  const values = chart.curves.map((curve, i) => {
    const value = element("span", { class: "value" });
    const svg = drawing("svg", { class: "swatch", width: 34, height: 16, viewBox: "0 0 34 16", "aria-hidden": "true" });
    const ink = palette[curve.colour] === "ink" ? "var(--ink)" : palette[curve.colour];
    if (curve.colour === yellow) svg.append(drawing("line", { x1: 0, y1: 8, x2: 34, y2: 8, stroke: "var(--outline)", "stroke-width": 5, "stroke-dasharray": curve.dash.join(" ") }));
    svg.append(drawing("line", { x1: 0, y1: 8, x2: 34, y2: 8, stroke: ink, "stroke-width": 3, "stroke-dasharray": curve.dash.join(" ") }));
    const button = element("button", { type: "button", "aria-pressed": String(!off.has(i)) }, svg, element("span", { class: "name" }, curve.name), value);
    button.addEventListener("click", () => {
      off.has(i) ? off.delete(i) : off.add(i);
      button.setAttribute("aria-pressed", String(!off.has(i)));
      u.setSeries(i + 1, { show: !off.has(i) });
    });
    if (alone) axisTitle.append(value);
    else list.append(element("li", {}, button));
    return value;
  });

  function place() {
    if (!u) return;
    const x = u.valToPos(clock.t, "x");
    now.style.transform = `translateX(${x}px)`;
  }
  function read() {
    place();
    const k = nearest(chart.t, clock.t);
    chart.curves.forEach((curve, i) => { values[i].textContent = curve.y[k] === null ? "–" : curve.y[k] <= floor ? "0" : number(curve.y[k], 4); });
  }
  const seek = (event) => {
    const box = u.over.getBoundingClientRect();
    if (box.width) clock.set(u.posToVal(event.clientX - box.left, "x"));
  };
  u.over.addEventListener("pointermove", (event) => {
    if (event.pointerType !== "mouse" || event.buttons || !clock.playing) seek(event);
  });
  u.over.addEventListener("pointerdown", seek);
  plot.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    clock.set(clock.t + (step * (clock.end - clock.start)) / 100);
  });
  const fit = () => {
    const width = plot.clientWidth;
    if (width > 0 && width !== u.width) u.setSize({ width, height: height(width) });
    place();
  };
  addEventListener("resize", fit);
  new ResizeObserver(() => requestAnimationFrame(fit)).observe(plot);
  clock.onTime(read);
  charts.push({ shown: [], show: () => {}, redraw: () => u.redraw(false, true) });
  read();
  return figure;
}

/** 0.002, 12.5, 3×10⁻⁵. */
function plain(value) {
  const size = Math.abs(value);
  if (size < 1e-13) return "0";
  return size >= 1e-3 && size < 1e5 ? String(Number(value.toPrecision(6))) : value < 0 ? "−" + number(size, 2) : number(size, 2);
}

function roomAround(low, high) {
  if (!measured(low) || !measured(high)) return [0, 1];
  const room = high > low ? 0.06 * (high - low) : Math.max(Math.abs(high) * 0.1, 1e-3);
  return [low - room, high + room];
}

/** Place in ascending times of the one nearest to t. */
function nearest(times, t) {
  let low = 0, high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    times[middle] <= t ? (low = middle) : (high = middle);
  }
  return t - times[low] < times[high] - t ? low : high;
}
