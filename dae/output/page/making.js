// What every page has: sections, how it was made, the change of colours.

function section(title, caption, ...content) {
  return element("section", {}, element("h2", {}, title), element("p", { class: "caption" }, caption), ...content);
}

function makingSection() {
  const { environment } = study;
  const repeats = [...new Set(runs.map((run) => run.time.repeats))].sort((a, b) => a - b);
  const span = [...new Set(runs.map((run) => run.end_time))].map((t) => `${number(t, 4)} s`).join(", ");
  const list = element("dl");
  const line = (name, value, code = false) => {
    if (value) list.append(element("dt", {}, name), element("dd", {}, code ? element("code", {}, value) : value));
  };
  line("command", study.command, true);
  line("scene", [study.scene, study.scene_file].filter(Boolean).join(", "));
  line("hash of the scene", study.scene_hash, true);
  if (runs.length) line("simulated time", span);
  for (const [name, value] of study.plan) line(`plan: ${name}`, value);
  if (runs.length) line("reference", study.reference || "none");
  line("repeats", repeats.some((n) => n > 0) ? `${repeats.join(", ")}; times are their median` : "");
  line("versions", Object.entries(environment.versions).map(([name, version]) => `${name} ${version}`).join(", "));
  line("compiler", environment.compiler);
  line("instruction level", `x86-64-v${environment.level}`);
  line("flags", environment.flags, true);
  line("build", environment.build_type);
  line("processor", environment.cpu);
  line("date", environment.date);
  const all = download("All numbers of all runs as CSV", `${fileName}.csv`, () => study.csv);
  return section("How it was made", "", list, ...(runs.length ? [element("p", { class: "notes" }, all)] : []));
}

/** Charts take their colours when they are drawn: again when the theme changes, and in ink on paper. */
function followTheme() {
  const redraw = () => charts.forEach((chart) => chart.redraw());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  const paper = (on) => () => {
    document.documentElement.classList.toggle("paper", on);
    redraw();
  };
  addEventListener("beforeprint", paper(true));
  addEventListener("afterprint", paper(false));
}
