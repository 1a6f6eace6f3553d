// The page of a study: charts with their tables, the mechanisms side by side, how it was made.

const numeric = (name, unit, get, best = true, digits = 2) =>
  ({ name, unit, get, best, text: (value) => number(value, digits) });
/** None is best: a drift that grows slowly may be large. */
const fixed = (name, get) => ({ name, get, best: false, text: (value) =>
  (typeof value === "string" ? value : measured(value) ? value.toFixed(2).replace(/^-(0\.00)$/, "$1") : "–") });
const growth = (of) => [fixed("exponent of growth", (run) => (of(run).power ? of(run).exponent : "no power")),
  fixed("± half range", (run) => of(run).half_range)];
const counted = (name, get) => ({ name, get, best: true, optional: true, text: count });
const optional = (column) => ({ ...column, optional: true });

const rung = study.drift_study ? "" : "; of each ladder its first rung";
const largest = (what) => `${what}; strong lines are the largest value so far, faint lines the value itself${rung}`;
const anyFailed = runs.some((run) => run.status !== "done");
const withReference = runs.some((run) => measured(run.error.position_max));

/** Of the position drift: m, or rad where all loop equations are angles. */
const driftUnit = runs[0]?.drift.unit || "m";

/** Captions and columns of the histories that the data name. */
const told = {
  position_drift: [largest("How far the loops are open"), [
    numeric("largest drift", driftUnit, (run) => run.drift.position_max),
    optional(numeric("between steps", driftUnit, (run) => run.drift.between_steps_max)),
    ...growth((run) => run.growth.position),
  ]],
  velocity_drift: [largest("How fast the loops open"), [
    numeric("largest drift", `${driftUnit}/s`, (run) => run.drift.velocity_max),
    ...growth((run) => run.growth.velocity),
  ]],
  angle_drift: [largest("How far the axes of loops, and what else of them is an angle, are apart"), [
    numeric("largest drift", "rad", (run) => run.drift.angle_max),
    optional(numeric("between steps", "rad", (run) => run.drift.angle_between_steps_max)),
    ...growth((run) => run.growth.angle),
  ]],
  angle_rate_drift: [largest("How fast these come apart"), [
    numeric("largest drift", "rad/s", (run) => run.drift.angle_rate_max),
    ...growth((run) => run.growth.angle_rate),
  ]],
  energy_error: [largest("Energy, less the work done on the mechanism, against its value at the start"), [
    numeric("largest energy error", "J", (run) => run.energy.error_max),
  ]],
  position_error: [largest(`Distance from ${study.reference || "the reference"}`), [
    numeric("largest position error", "", (run) => run.error.position_max),
    optional(numeric("largest velocity error", "", (run) => run.error.velocity_max)),
  ]],
  force_error: [largest("How far the loop forces λ are off, solved from (3) at the coordinates and rates of the run"), [
    numeric("largest error of λ", "", (run) => run.error.force_max),
  ]],
  multiplier_error: [largest("How far λ is off as the form itself has it: in its state, or σ̇ + κσ of momentum forms"), [
    numeric("largest error of its own λ", "", (run) => run.error.multiplier_max),
  ]],
  multiplier_difference: [largest("The form's own λ beside λ solved from (3) at the same state: noise of the one, which needs no reference"), [
    optional(numeric("largest difference", "", (run) => run.multiplier_difference_max)),
  ]],
  momentum_error: [largest("How far p is off in what moves: without Φ_qᵀσ, which a gauge chooses"), [
    numeric("largest error of p", "", (run) => run.error.momentum_max),
  ]],
  impulse_error: [largest("How far the impulses of the loops since the start are off, ∫λ dt, whatever the gauge"), [
    numeric("largest error of ∫λ dt", "", (run) => run.error.impulse_max),
  ]],
  effort_error: [largest("How far the efforts of drives are off"), [
    numeric("largest error of efforts", "", (run) => run.error.effort_max),
  ]],
  reaction_error: [largest("How far the reactions of joints are off, of those that are unique"), [
    numeric("largest error of reactions", "", (run) => run.error.reaction_max),
  ]],
  work_error: [largest("How far the work of drives, and of what has no potential, is off"), [
    numeric("largest error of work", "", (run) => run.error.work_max),
  ]],
  impulse: [largest("What a gauge keeps from growing: the multipliers σ of momentum forms"), []],
};
const histories = study.histories.map((history) => ({ ...history, caption: told[history.key][0], columns: told[history.key][1] }));

const time = { xTitle: "processor time", xUnit: "s", cost: (run) => run.time.cpu_s };
const costs = {
  ...time,
  title: "Error against processor time",
  caption: (study.drift_study ? "" : "The wide line joins the runs that no other beats in both. ") + (withReference
    ? "Left and low is better. Largest position error against the reference; time of the integration alone."
    : "Left and low is better. Without a reference the largest position drift stands for the error; time of the integration alone."),
  yTitle: withReference ? "error of positions max |err|/(1+|ref|)" : `largest position drift |Φ| [${driftUnit}]`,
  unit: withReference ? "1" : driftUnit,
  value: (run) => (withReference ? run.error.position_max : run.drift.position_max),
  columns: [
    optional(numeric("position error", "", (run) => run.error.position_max)),
    optional(numeric("velocity error", "", (run) => run.error.velocity_max)),
    optional(numeric("largest drift", driftUnit, (run) => run.drift.position_max)),
    optional(numeric("of angles", "rad", (run) => run.drift.angle_max)),
    numeric("processor time", "s", (run) => run.time.cpu_s, true, 3),
    optional(numeric("wall time", "s", (run) => run.time.wall_s, true, 3)),
    counted("steps", (run) => run.counters.steps),
    counted("rejected", (run) => run.counters.rejected),
    counted("evaluations", (run) => run.counters.evaluations),
    { ...counted("Jacobians", (run) => run.counters.jacobians), best: false },
    { ...counted("factorizations", (run) => run.counters.factorizations), best: false },
    { ...counted("Newton iterations", (run) => run.counters.newton_iterations), best: false },
    { ...counted("repeats", (run) => run.time.repeats), best: false },
  ],
};

// A ladder is judged along three more axes: what it does not see of the machine, and what its error hides.
const furtherCosts = [
  {
    title: "Error against evaluations", xTitle: "evaluations of right-hand side or residual", xUnit: "",
    cost: (run) => run.counters.evaluations,
    caption: "The same runs without the speed of this machine; an implicit method's Jacobians are not among them.",
    yTitle: costs.yTitle, unit: costs.unit, value: costs.value, columns: [],
  },
  {
    ...time, title: "Position drift against processor time",
    caption: "CPU time against the largest position drift.",
    yTitle: `largest position drift |Φ| [${driftUnit}]`, unit: driftUnit, value: (run) => run.drift.position_max, columns: [],
  },
  {
    ...time, title: "Energy error against processor time",
    caption: "Largest error of the energy, less the work done on the mechanism.",
    yTitle: "largest energy error |E − E₀| [J]", unit: "J", value: (run) => run.energy.error_max, columns: [],
  },
];

function chartSection(spec, chart, curves) {
  const notes = element("div", { class: "notes" });
  const tail = [];
  if (spec.columns.length) {
    const table = runTable(spec.title, chart.shown, spec.columns);
    tail.push(table.frame);
    notes.append(download("Table as CSV", `${fileName}-${spec.title.toLowerCase().replaceAll(" ", "-")}.csv`, table.csv));
  }
  if (curves) notes.append(download("Curves as CSV", `${fileName}-${spec.key.replaceAll("_", "-")}-curves.csv`, chart.csv));
  const cross = anyFailed ? " A cross marks where a run failed." : "";
  return section(spec.title, curves ? spec.caption + "." + cross : spec.caption + cross, chart.figure, ...tail, notes);
}

function failedSection() {
  const list = element("dl");
  for (const run of runs.filter((one) => one.status !== "done")) {
    list.append(element("dt", {}, run.label),
      element("dd", {}, `${run.status} at ${number(run.stopped_at, 4)} s${run.reason ? ": " + run.reason : ""}`));
  }
  return section("Runs that did not finish", "Their curves and numbers go up to where they stopped.", list);
}

/** The mechanism as each run moved it, or, of a ladder, at its start; null where nothing is drawn. */
function sideBySide() {
  const films = study.motions.map(filmOf);
  if (!films.length || !picture.bodies.length) return null;
  const moving = films.some((film) => film.run >= 0);
  const titleOf = (film) => film.run < 0 ? null : element("span", {}, swatch(film.run, false), " ", runs[film.run].label);
  const player = moviePlayer(films, titleOf, films.length > 1 ? ["loops", "joints"] : usualBoxes);
  const magnified = player.factor() > 1
    ? `Gaps of loops are drawn ${player.factor() < 1e4 ? player.factor() : `10${raised(Math.round(Math.log10(player.factor())))}`} times as wide as they are, the same factor in all. `
    : player.factor() === 1 ? "Gaps of loops are drawn in true size. " : "";
  player.clock.set(player.clock.end);  // where the gaps are to be seen
  return section(moving ? "The mechanism in every form" : "The mechanism at the start", `${moving ? magnified : ""}${steeringWords()}.`, player.figure);
}

{
  const main = document.getElementById("main");
  const add = (node) => node && main.append(node);
  let mechanismsShown = false;
  const addMechanisms = () => {
    if (!mechanismsShown) add(sideBySide());
    mechanismsShown = true;
  };
  let costsShown = false;
  const addCosts = () => {
    if (costsShown) return;
    costsShown = true;
    const chart = scatterChart(costs);
    if (chart) add(chartSection(costs, chart, false));
    if (study.drift_study) return;
    for (const spec of furtherCosts) {
      if (!withReference && spec.value === costs.value && spec.xUnit === "s") continue;
      const further = scatterChart(spec);
      if (further) add(chartSection(spec, further, false));
    }
  };

  // A ladder is made for this chart; a drift study shows it after what drifts.
  if (!study.drift_study) addCosts();
  let explained = false;
  for (const spec of histories) {
    if (spec.key === "position_error") addCosts();
    const chart = historyChart(spec);
    if (!chart) continue;
    if (!explained) {
      spec.caption += ". Click a name to hide or show its run everywhere, twice to see it alone; drag across a chart to " +
        "zoom, double-click for the whole";
      explained = true;
    }
    // The error has its table with the costs.
    if (spec.key === "position_error" && runs.some((run) => measured(run.time.cpu_s))) spec.columns = [];
    add(chartSection(spec, chart, true));
    if (study.drift_study) addMechanisms();
  }
  if (anyFailed) add(failedSection());
  addMechanisms();
  add(makingSection());
  followTheme();
}
