// What the charts share: logarithmic axes, crosses and labels at the ends of curves, legends, showing and hiding.

const font = '14px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif';
const charts = [];  // {plot, show(run, on), near(run or null)}
const hidden = new Set();

const decadeFloor = (value) => 10 ** Math.floor(Math.log10(value) + 1e-9);
const decadeCeil = (value) => 10 ** Math.ceil(Math.log10(value) - 1e-9);

/** Whole decades around the data, one at least; never far below the rounding floor. */
function wholeDecades(u, low, high) {
  if (!measured(low) || !measured(high) || low <= 0) return [1e-3, 1];
  const from = decadeFloor(low), to = decadeCeil(high);
  return [from, to > from ? to : from * 10];
}

/** To the next 1, 2, 5 on either side: for data within few decades. */
function nearSteps(u, low, high) {
  if (!measured(low) || !measured(high) || low <= 0) return [1e-3, 1];
  const steps = [1, 2, 5, 10];
  const bottom = decadeFloor(low / 1.15), top = decadeFloor(high * 1.15);
  const from = bottom * [...steps].reverse().find((s) => bottom * s <= low / 1.15);
  const to = top * steps.find((s) => top * s >= high * 1.15);
  return [from, Math.max(to, 2 * from)];
}

/** Powers of ten as far apart as the room asks; 1-2-5 where the axis spans few decades. */
function powersOfTen(u, axis, low, high, increment, space) {
  const side = u.axes[axis].side % 2;
  const length = side ? u.bbox.height : u.bbox.width;
  const room = Math.max(2, Math.floor(length / uPlot.pxRatio / (side ? 40 : 64)));
  const first = Math.round(Math.log10(decadeFloor(low))), last = Math.round(Math.log10(decadeCeil(high)));
  const apart = Math.ceil((last - first) / room) || 1;
  const mantissas = Math.log10(high / low) < 2.5 && apart === 1 && room > 3 * (last - first) ? [1, 2, 5] : [1];
  const ticks = [];
  for (let k = Math.ceil(first / apart) * apart; k <= last; k += apart) {
    for (const m of mantissas) {
      const value = Number(`${m}e${k}`);
      if (value >= low * 0.999 && value <= high * 1.001) ticks.push(value);
    }
  }
  return ticks;
}

const axisStyle = {
  stroke: () => theme("--muted"),
  grid: { stroke: () => theme("--grid"), width: 1 },
  ticks: { stroke: () => theme("--rule"), width: 1, size: 5 },
  border: { show: true, stroke: () => theme("--rule"), width: 1 },
  font,
  labelFont: font,
  filter: (u, ticks) => ticks,
  splits: powersOfTen,
  values: (u, ticks) => ticks.map(tick),
};

function plotHeight(width) {
  return Math.round(Math.min(480, Math.max(320, 0.42 * width)));
}

/** Text on the canvas with a rim of the ground, so that lines under it do not cut it. */
function canvasText(ctx, text, x, y, { align = "left", colour = theme("--ink") } = {}) {
  const ratio = uPlot.pxRatio;
  ctx.save();
  ctx.font = font.replace(/^14px/, `${14 * ratio}px`);
  ctx.textAlign = align;
  ctx.textBaseline = "middle";
  ctx.lineJoin = "round";
  ctx.lineWidth = 4 * ratio;
  ctx.strokeStyle = theme("--ground");
  ctx.strokeText(text, x, y);
  ctx.fillStyle = colour;
  ctx.fillText(text, x, y);
  ctx.restore();
}

/** The cross at which a failed run ends. */
function canvasCross(ctx, x, y, colour) {
  const r = 5 * uPlot.pxRatio;
  for (const [stroke, width] of [[theme("--ground"), 6], [colour, 3]]) {
    ctx.beginPath();
    ctx.moveTo(x - r, y - r);
    ctx.lineTo(x + r, y + r);
    ctx.moveTo(x - r, y + r);
    ctx.lineTo(x + r, y - r);
    ctx.lineWidth = width * uPlot.pxRatio;
    ctx.strokeStyle = stroke;
    ctx.stroke();
  }
}

function canvasMarker(ctx, sign, x, y, r) {
  const path = markerPath(sign.marker, x, y, r * uPlot.pxRatio);
  ctx.fillStyle = inkOf(sign);
  ctx.lineWidth = (sign.colour === yellow ? 3 : 2) * uPlot.pxRatio;
  ctx.strokeStyle = sign.colour === yellow && theme("--outline") !== "transparent" ? theme("--outline") : theme("--ground");
  ctx.stroke(path);
  ctx.fill(path);
}

/** A thin dashed line of slope n through (x, y) across the plot, named near its middle. */
function powerLine(u, x, y, slope, name) {
  const { ctx, bbox } = u;
  const low = u.scales.x.min, high = u.scales.x.max;
  const at = (value) => y * (value / x) ** slope;
  const px = (value) => u.valToPos(value, "x", true);
  const py = (value) => u.valToPos(Math.max(value, 1e-300), "y", true);
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.setLineDash([5 * uPlot.pxRatio, 5 * uPlot.pxRatio]);
  ctx.lineWidth = uPlot.pxRatio;
  ctx.strokeStyle = theme("--muted");
  ctx.beginPath();
  ctx.moveTo(px(low), py(at(low)));
  ctx.lineTo(px(high), py(at(high)));
  ctx.stroke();
  ctx.restore();
  // The name stands over the middle of what is to be seen of the line.
  const yLow = u.scales.y.min, yHigh = u.scales.y.max;
  const inside = [];
  for (let k = 0; k <= 40; ++k) {
    const value = low * (high / low) ** (k / 40);
    if (at(value) > yLow && at(value) < yHigh) inside.push(value);
  }
  if (inside.length < 6) return;
  const value = inside[Math.floor(inside.length * 0.55)];
  canvasText(ctx, name, px(value), py(at(value)) - 11 * uPlot.pxRatio, { align: "center", colour: theme("--muted") });
}

/** The line under which everything is rounding; only where the axis reaches it. */
function floorLine(u) {
  if (u.scales.y.min > roundingFloor * 1.01) return;
  const y = u.valToPos(roundingFloor, "y", true);
  const { ctx, bbox } = u;
  ctx.save();
  ctx.setLineDash([2 * uPlot.pxRatio, 3 * uPlot.pxRatio]);
  ctx.lineWidth = uPlot.pxRatio;
  ctx.strokeStyle = theme("--muted");
  ctx.beginPath();
  ctx.moveTo(bbox.left, y);
  ctx.lineTo(bbox.left + bbox.width, y);
  ctx.stroke();
  ctx.restore();
  canvasText(ctx, "rounding", bbox.left + 8 * uPlot.pxRatio, y - 10 * uPlot.pxRatio, { colour: theme("--muted") });
}

/** Moves heights apart until each has `gap` of room within [top, bottom]; their order stays. */
function spread(heights, gap, top, bottom) {
  const order = heights.map((y, i) => i).sort((a, b) => heights[a] - heights[b]);
  const placed = heights.slice();
  let last = top - gap;
  for (const i of order) last = placed[i] = Math.max(placed[i], last + gap);
  let next = bottom + gap;
  for (const i of order.reverse()) next = placed[i] = Math.min(placed[i], next - gap);
  return placed;
}

/** Names at the ends of curves, in the margin right of the plot, each with a thin leader. */
function endLabels(u, ends) {
  const ratio = uPlot.pxRatio, { ctx, bbox } = u;
  const right = bbox.left + bbox.width;
  const gap = 17 * ratio;
  const heights = spread(ends.map((end) => end.y), gap, bbox.top + gap / 2, bbox.top + bbox.height - gap / 2);
  ends.forEach((end, k) => {
    const y = heights[k], colour = inkOf(signs[end.run]);
    ctx.save();
    ctx.lineWidth = ratio;
    ctx.globalAlpha = 0.75;
    ctx.strokeStyle = theme("--muted");
    ctx.beginPath();
    if (end.x < right - 2 * ratio) {
      ctx.setLineDash([ratio, 4 * ratio]);
      ctx.moveTo(end.x + 8 * ratio, end.y);
      ctx.lineTo(right, end.y);
      ctx.stroke();
      ctx.setLineDash([]);
      ctx.beginPath();
    }
    ctx.moveTo(right + 2 * ratio, end.y);
    ctx.lineTo(right + 16 * ratio, y);
    ctx.stroke();
    ctx.restore();
    ctx.fillStyle = colour;
    ctx.fillRect(right + 18 * ratio, y - 2 * ratio, 12 * ratio, 4 * ratio);
    canvasText(ctx, runs[end.run].label, right + 35 * ratio, y);
  });
}

let measuring;
function textWidth(text) {
  measuring ??= document.createElement("canvas").getContext("2d");
  measuring.font = font;
  return measuring.measureText(text).width;
}

/** Room for names at the ends of curves, or 0 when they would crowd the plot. */
function labelRoom(width, shown) {
  const visible = shown.filter((i) => !hidden.has(i));
  const widest = Math.max(0, ...visible.map((i) => textWidth(runs[i].label)));
  const fits = width >= 720 && widest < 0.28 * width && visible.length * 17 <= plotHeight(width) - 60;
  return fits ? Math.ceil(widest) + 42 : 0;
}

/** Names, signs and read values of the curves; a click shows or hides a run in every chart. */
function legend(shown, near, nameOf) {
  const list = element("ul", { class: "legend" });
  const items = new Map();
  for (const i of shown) {
    const value = element("span", { class: "value" });
    const button = element("button", { type: "button", "aria-pressed": "true" },
      swatch(i), element("span", { class: "name" }, nameOf(i)), value);
    button.addEventListener("click", () => toggle(i));
    button.addEventListener("dblclick", () => only(i));
    for (const [event, run] of [["mouseenter", i], ["focus", i], ["mouseleave", null], ["blur", null]]) {
      button.addEventListener(event, () => near(run));
    }
    list.append(element("li", {}, button));
    items.set(i, { button, value });
  }
  return { list, items };
}

function toggle(run) {
  hidden.has(run) ? hidden.delete(run) : hidden.add(run);
  charts.forEach((chart) => chart.show());
}

/** This run alone; every run again when it was alone already. */
function only(run) {
  const all = new Set(charts.flatMap((chart) => chart.shown));
  const alone = hidden.size === all.size - 1 && !hidden.has(run);
  hidden.clear();
  if (!alone) for (const i of all) if (i !== run) hidden.add(i);
  charts.forEach((chart) => chart.show());
}

/** A figure: axis title, plot (an image with a text alternative; arrow keys move its cursor), reading, legend. */
function frameOf(spec, alternative, shown, near, nameOf = (i) => runs[i].label) {
  const plot = element("div", { class: "plot", tabindex: "0", role: "img", "aria-label": alternative });
  const reading = element("p", { class: "reading" });
  const names = legend(shown, near, nameOf);
  const figure = element("div", {}, element("p", { class: "axis-title" }, `↑ ${spec.yTitle}`), plot, reading, names.list);
  return { figure, plot, reading, names };
}

/** The cursor by keyboard and by touch; `u` is a uPlot. */
function steerable(u, plot) {
  plot.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -8, ArrowRight: 8, Home: -1e6, End: 1e6 }[event.key];
    if (!step) return;
    event.preventDefault();
    const width = u.over.clientWidth;
    const from = u.cursor.left >= 0 ? u.cursor.left : width;
    u.setCursor({ left: Math.min(width, Math.max(0, from + step)), top: u.over.clientHeight / 2 });
  });
  const follow = (event) => {
    if (event.pointerType === "mouse") return;
    const box = u.over.getBoundingClientRect();
    u.setCursor({ left: event.clientX - box.left, top: event.clientY - box.top });
  };
  u.over.addEventListener("pointerdown", follow);
  u.over.addEventListener("pointermove", follow);
}

/** Keeps a chart as wide as its place: at once when the window changes, in the next frame when something else does (a
 * chart that changes its height while sizes are being reported would be reported itself). */
function fitted(u, plot) {
  const fit = () => {
    const width = plot.clientWidth;
    if (width > 0 && width !== u.width) u.setSize({ width, height: plotHeight(width) });
  };
  addEventListener("resize", fit);
  new ResizeObserver(() => requestAnimationFrame(fit)).observe(plot);
}
