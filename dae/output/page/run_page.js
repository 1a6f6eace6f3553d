// The page of one run, or of a scene alone: the mechanism moving, beside its curves; what was asked and what came out.

{
  const main = document.getElementById("main");
  const films = study.motions.map(filmOf);
  const until = Math.max(0, ...study.timeline.map((chart) => chart.t.at(-1)));
  const player = films.length && picture.bodies.length
    ? moviePlayer(films, () => null, runs.length || picture.solids.length ? usualBoxes : [...usualBoxes, "masses"], until) : null;
  const clock = player?.clock ?? clockOf([{ start: 0, end: 0, every: 0 }], until);
  const factor = player?.factor() ?? 0;
  const magnified = factor > 1 ? ` Gaps of loops are drawn ${factor < 1e4 ? factor : `10${raised(Math.round(Math.log10(factor)))}`} times as wide as they are.`
    : factor === 1 && runs.length ? " Gaps of loops are drawn in true size." : "";

  const left = element("div", { class: "left" });
  if (player) left.append(player.figure, element("p", { class: "caption" }, `${steeringWords()}.${magnified}`));
  else if (!picture.without_bodies) left.append(element("p", { class: "caption" }, "The mechanism is not drawn: it has more bodies than a page holds."));
  const right = element("div", { class: "right" });
  main.append(element("section", { class: "beside" + (study.timeline.length && !picture.without_bodies ? "" : " alone") }, ...(picture.without_bodies ? [right] : [left, right])));
  for (const chart of study.timeline) right.append(timelineChart(chart, clock));

  if (runs.length) {
    const run = runs[0], list = element("dl");
    const line = (name, value) => value && list.append(element("dt", {}, name), element("dd", {}, value));
    line("form", run.form);
    line("integrator", `${run.integrator}, ${run.tolerance}`);
    line("gauge", run.gauge);
    line("corrected after each step", run.project ? "yes" : "no");
    line("(7) is solved by", run.kkt);
    line("status", run.status === "done" ? "done" : run.status === "event" ? run.reason : `${run.status} at ${number(run.stopped_at, 4)} s: ${run.reason}`);
    const drift = (value, unit) => (measured(value) ? `${number(value)} ${unit}` : "");
    line("largest position drift", drift(run.drift.position_max, run.drift.unit));
    line("largest velocity drift", drift(run.drift.velocity_max, `${run.drift.unit}/s`));
    line("largest position drift of angles", drift(run.drift.angle_max, "rad"));
    line("largest velocity drift of angles", drift(run.drift.angle_rate_max, "rad/s"));
    line("largest energy error", measured(run.energy.error_max) ? `${number(run.energy.error_max)} J` : "");
    line("largest position error", measured(run.error.position_max) ? number(run.error.position_max) : "");
    line("steps", `${count(run.counters.steps)}, ${count(run.counters.rejected)} rejected, ${count(run.counters.evaluations)} evaluations`);
    line("processor time", measured(run.time.cpu_s) ? `${number(run.time.cpu_s, 3)} s` : "");
    main.append(section("What was asked and what came out", "All samples are in trajectory.csv beside this page.", list));
  }
  if (!picture.without_bodies) main.append(bodiesSection());
  main.append(makingSection());
  clock.set(clock.start);
  followTheme();
}

/** What the picture is made of, as a table. */
function bodiesSection() {
  const body = element("tbody");
  const nameOf = (k) => (k < 0 ? "ground" : picture.bodies[k].name);
  for (const b of picture.bodies) body.append(element("tr", {}, element("th", { scope: "row" }, b.name),
    element("td", { class: "text" }, b.joint), element("td", { class: "text" }, b.kind), element("td", { class: "text" }, nameOf(b.parent))));
  for (const l of picture.loops) body.append(element("tr", {}, element("th", { scope: "row" }, nameOf(l.child)),
    element("td", { class: "text" }, `loop ${l.name}`), element("td", { class: "text" }, l.kind), element("td", { class: "text" }, nameOf(l.parent))));
  const head = element("tr", {}, ...["body", "held by", "kind", "on"].map((text) => element("th", { scope: "col", class: "text plain" }, text)));
  const table = element("table", {}, element("caption", { class: "hidden" }, "Bodies, joints and loops"), element("thead", {}, head), body);
  const frame = element("div", { class: "frame", tabindex: "0", role: "region", "aria-label": "Table: bodies" }, table);
  const rows = picture.bodies.length + picture.loops.length;
  const whole = element("details", rows <= 14 ? { open: "" } : {}, element("summary", {}, many(picture.bodies.length, "body", "bodies") + (picture.loops.length ? `, ${many(picture.loops.length, "loop")}` : "")), frame);
  return section("Bodies, joints and loops", "", whole);
}
