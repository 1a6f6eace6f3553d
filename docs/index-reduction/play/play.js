// The page: sliders, runs that go on between two pictures, three charts, a table and the mechanism.
"use strict";

const known = { pendulum, "four-bar": fourBar };
const about = {
  "index-3": ["#56b4e9", "Φ = 0, generalised-α"],
  "index-2": ["#0072b2", "Φ̇ = 0, half-explicit, order 5"],
  "index-1": ["#d55e00", "Φ̈ = 0, RK4"],
  baumgarte: ["#e69f00", "Φ̈ + 2αΦ̇ + β²Φ = 0, RK4"],
  projected: ["#999999", "Φ̈ = 0, corrected, RK4"],
  momentum: ["#009e73", "(7), (8), leak κ, RK4"],
};
const sliders = [
  { key: "alpha", label: "α [1/s]", from: 0.1, to: 1000, at: 10 },
  { key: "beta", label: "β [1/s]", from: 0.1, to: 1000, at: 10 },
  { key: "kappa", label: "κ [1/s], 0: no gauge", from: 0.1, to: 300, at: 3, zero: true },
  { key: "h", label: "h [ms]", from: 1, to: 50, at: 5, unit: 1e-3 },
];
const points = 600;  // of a curve
const floor = 1e-17;  // what is less is drawn there
const byId = (id) => document.getElementById(id);
const theme = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const short = (x) => (x === 0 ? "0" : x.toExponential(1));

function put(parent, tag, attributes = {}, text = "") {
  const e = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) e.setAttribute(name, value);
  e.textContent = text;
  parent.append(e);
  return e;
}

// ---- settings

for (const s of sliders) {
  const label = put(byId("sliders"), "label", { class: "slider" });
  put(label, "span", {}, s.label);
  s.output = put(label, "output");
  s.input = put(label, "input", { type: "range", min: 0, max: 100, step: 0.1,
    value: 100 * Math.log(s.at / s.from) / Math.log(s.to / s.from) });
}
for (const [form, [colour, words]] of Object.entries(about)) {
  const label = put(byId("forms"), "label");
  const box = put(label, "input", { type: "checkbox", value: form });
  box.checked = true;
  put(label, "span", { class: "swatch", style: `border-color: ${colour}` });
  label.append(form, " ");
  put(label, "small", {}, words);
}
function valueOf(s) {
  const part = Number(s.input.value) / 100;
  if (s.zero && part === 0) return 0;
  return Number((s.from * (s.to / s.from) ** part).toPrecision(2));
}
function settings() {
  const all = {};
  for (const s of sliders) {
    s.output.textContent = valueOf(s);
    all[s.key] = valueOf(s) * (s.unit || 1);
  }
  return all;
}

// ---- charts

const kinds = ["position", "velocity", "energy"];
let charts = [], runs = [], frame = 0;

function chartOf(kind, end, logarithmic) {
  const div = byId(kind), width = Math.max(280, div.clientWidth);
  div.replaceChildren();
  const axis = { stroke: () => theme("--muted"), grid: { stroke: () => theme("--grid") }, ticks: { stroke: () => theme("--rule") } };
  const exponents = (u, ticks) => ticks.map((x) => (x && Math.log10(x) % 2 === 0 ? `1e${Math.round(Math.log10(x))}` : ""));
  return new uPlot({
    width, height: Math.min(340, Math.max(240, 0.4 * width)), legend: { show: false }, cursor: { show: false },
    scales: { x: { time: false, ...(logarithmic ? { distr: 3, range: [end / points, end] } : { range: [0, end] }) }, y: { distr: 3, range: [floor, 10] } },
    axes: [{ ...axis, label: "t [s]" }, { ...axis, size: 60, values: exponents, splits: () => [...Array(19).keys()].map((k) => 10 ** (k - 17)) }],
    series: [{}, ...runs.map((run) => ({ stroke: about[run.form][0], width: 2, spanGaps: true }))],
  }, [[], ...runs.map(() => [])], div);
}

/** Of every curve the largest value in each of `points` equal spans. */
function drawCharts() {
  const times = runs.length ? runs.reduce((longest, run) => (run.times.length > longest.length ? run.times : longest), []) : [];
  kinds.forEach((kind, i) => charts[i].setData([times, ...runs.map((run) => times.map((_, k) => run[kind][k] ?? null))], true));
}

// ---- the mechanism

function drawPicture(mechanism) {
  const canvas = byId("picture"), ratio = devicePixelRatio || 1;
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  const { x, y } = mechanism.view, ctx = canvas.getContext("2d");
  const scale = Math.min(canvas.width / (x[1] - x[0]), canvas.height / (y[1] - y[0]));
  const px = (p) => [canvas.width / 2 + scale * (p[0] - (x[0] + x[1]) / 2), canvas.height / 2 - scale * (p[1] - (y[0] + y[1]) / 2)];
  ctx.lineCap = "round";
  for (const run of runs) {
    ctx.strokeStyle = about[run.form][0];
    ctx.globalAlpha = run.failed ? 0.25 : 0.8;
    ctx.lineWidth = 4 * ratio;
    for (const [from, to] of mechanism.bodies(run.q)) {
      ctx.beginPath();
      ctx.moveTo(...px(from));
      ctx.lineTo(...px(to));
      ctx.stroke();
    }
  }
}

function drawTable() {
  byId("maxima").tBodies[0].replaceChildren(...runs.map((run) => {
    const row = document.createElement("tr");
    const head = put(row, "th", { scope: "row" });
    put(head, "span", { class: "swatch", style: `border-color: ${about[run.form][0]}` });
    head.append(run.form);
    for (const kind of kinds) put(row, "td", {}, short(run.largest[kind]));
    put(row, "td", run.failed ? { class: "apart" } : {}, run.failed ? `came apart at ${run.t.toPrecision(3)}` : run.t.toFixed(1));
    return row;
  }));
}

// ---- runs

function begin() {
  cancelAnimationFrame(frame);
  const chosen = settings(), end = Number(byId("end").value);
  const mechanism = known[document.querySelector("[name=mechanism]:checked").value];
  const span = end / points;
  runs = [...document.querySelectorAll("#forms input:checked")].map(({ value }) => {
    const run = runOf(mechanism, value, chosen);
    return Object.assign(run, { form: value, q: run.start.q, times: [], position: [], velocity: [], energy: [],
                                largest: { position: 0, velocity: 0, energy: 0 } });
  });
  const take = (run, sample) => {
    run.q = sample.q;
    const at = Math.min(points - 1, Math.floor((sample.t - 1e-9) / span));
    if (at >= run.times.length) {
      run.times.push(sample.t);
      for (const kind of kinds) run[kind].push(floor);
    }
    for (const kind of kinds) {
      const last = run[kind].length - 1;
      run[kind][last] = Math.max(run[kind][last], sample[kind]);
      run.largest[kind] = Math.max(run.largest[kind], sample[kind]);
    }
  };
  charts = kinds.map((kind) => chartOf(kind, end, byId("logarithmic").checked));
  const go = () => {
    const until = performance.now() + 25;
    let open = runs.filter((run) => !run.failed && run.t < end - 1e-9);
    while (open.length && performance.now() < until) {
      // All runs reach the same time together, so that the picture compares them.
      const t = Math.min(...open.map((run) => run.t)) + span;
      for (const run of open) {
        const steps = Math.max(1, Math.round((Math.min(t, end) - run.t) / chosen.h));
        for (const sample of run.advance(steps)) take(run, sample);
      }
      open = open.filter((run) => !run.failed && run.t < end - 1e-9);
    }
    drawCharts();
    drawTable();
    drawPicture(mechanism);
    if (open.length) frame = requestAnimationFrame(go);
    else document.documentElement.dataset.done = "yes";
  };
  delete document.documentElement.dataset.done;
  go();
}

document.getElementById("settings").addEventListener("input", begin);
document.getElementById("settings").addEventListener("submit", (e) => e.preventDefault());
let width = innerWidth;
addEventListener("resize", () => { if (innerWidth !== width) { width = innerWidth; begin(); } });
begin();
