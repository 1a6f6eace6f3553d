// Tables of runs: sortable by keyboard and mouse, the best value of each column marked.

/** What was asked of a run and how it was solved: the last columns of every table. */
const settingColumns = [
  { name: "integrator", get: (run) => run.integrator },
  { name: "tolerance or step", get: (run) => run.tolerance, order: (run) => run.step || run.rtol },
  { name: "gauge", get: (run) => run.gauge },
  { name: "Jacobian", get: (run) => run.jacobian },
  { name: "linear solver", get: (run) => run.linear_solver },
  { name: "KKT", get: (run) => run.kkt },
  { name: "projection", get: (run) => (run.project ? "each step" : "none") },
  { name: "feedback", get: (run) => (run.baumgarte[0] || run.baumgarte[1]
      ? `α ${number(run.baumgarte[0])}, β ${number(run.baumgarte[1])} 1/s`
      : run.beta ? `β ${number(run.beta)} 1/s` : ""), optional: true },
  { name: "penalty", get: (run) => (run.penalty ? number(run.penalty) : ""), optional: true },
  { name: "partitions", get: (run) => (run.partitions ? String(run.partitions) : ""), optional: true },
];

const reliable = (run) => run.status === "done" && !run.departure;

const statusColumn = {
  name: "status",
  get: (run) => (run.status !== "done" ? `${run.status}, ${number(run.stopped_at, 4)} s`
    : run.departure ? "done, not to be relied on" : "done"),
  failed: (run) => !reliable(run),
};

/**
 * A framed table of `shown` (indices of runs). A column has name, get(run); numbers also unit, text(value) and
 * best: true where small is good. Runs that did not finish or are not to be relied on are never best.
 */
function runTable(title, shown, columns) {
  const all = [...columns, statusColumn, ...settingColumns].filter(
    (column) => !column.optional || shown.some((i) => !["", "–"].includes(cellText(column, runs[i]))));

  const head = element("tr");
  const body = element("tbody");
  const headers = [{ name: "form", get: (run) => run.label }, ...all].map((column, c) => {
    const button = element("button", { type: "button" }, element("span", { class: "title" }, column.name));
    if (column.unit) button.append(element("span", { class: "unit" }, `[${column.unit}]`));
    const header = element("th", { scope: "col", class: column.text ? "" : "text" }, button);
    button.addEventListener("click", () => {
      const up = header.getAttribute("aria-sort") !== "ascending";
      for (const other of headers) other.removeAttribute("aria-sort");
      header.setAttribute("aria-sort", up ? "ascending" : "descending");
      rows.sort((a, b) => compare(column, runs[a.run], runs[b.run], up));
      body.append(...rows.map((row) => row.node));
    });
    head.append(header);
    return header;
  });

  const best = all.map((column) => {
    if (!column.best || study.ambiguous) return null;
    const values = shown.filter((i) => reliable(runs[i])).map((i) => column.get(runs[i])).filter(measured);
    const least = Math.min(...values);
    return values.some((value) => value > least) ? least : null;  // where all are equal none is best
  });
  const rows = shown.map((i) => {
    const name = element("th", { scope: "row" }, swatch(i), " ", runs[i].label);
    const cells = all.map((column, c) => {
      const cell = element("td", {}, cellText(column, runs[i]));
      if (!column.text) cell.className = "text";
      if (column.failed?.(runs[i])) cell.classList.add("failed");
      if (best[c] !== null && reliable(runs[i]) && column.get(runs[i]) === best[c]) {
        cell.classList.add("best");
        cell.append(element("span", { class: "hidden" }, " (best)"));
      }
      return cell;
    });
    return { run: i, node: element("tr", {}, name, ...cells) };
  });
  body.append(...rows.map((row) => row.node));

  const csv = () => [
    ["form", ...all.map((column) => (column.unit ? `${column.name} [${column.unit}]` : column.name))],
    ...rows.map(({ run }) => [runs[run].label, ...all.map((column) => {
      const value = column.get(runs[run]);
      return column.text ? csvNumber(value) : value ?? "";
    })]),
  ].map((row) => row.map((cell) => csvCell(String(cell))).join(",")).join("\n") + "\n";

  const table = element("table", {}, element("caption", { class: "hidden" }, title), element("thead", {}, head), body);
  const frame = element("div", { class: "frame", tabindex: "0", role: "region", "aria-label": `Table: ${title}` }, table);
  return { frame, csv };
}

function cellText(column, run) {
  const value = column.get(run);
  if (column.text) return column.text(value);
  return value === "" || value == null ? "–" : String(value);
}

function compare(column, a, b, up) {
  const key = column.order ?? column.get;
  const x = key(a), y = key(b);
  if (typeof x === "string" && typeof y === "string") return up ? x.localeCompare(y) : y.localeCompare(x);
  if (!measured(x) || !measured(y)) return measured(y) - measured(x);  // not measured comes last either way
  return up ? x - y : y - x;
}
