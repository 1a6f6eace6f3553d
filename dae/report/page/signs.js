// Which sign stands for which run: colour for the form, marker for the integrator, dash for what still differs.

/** The eight colours of Okabe and Ito. Black is the ink of the theme; yellow needs an outline on white. */
const palette = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "ink", "#e69f00", "#56b4e9", "#f0e442"];
const yellow = palette.length - 1;

/** Every form has its colour on every page; where a page has more than eight, later ones share it with a dash. */
const preferred = [
  ["momentum", 0], ["acceleration", 1], ["momentum-stabilised", 2], ["stabilised-index2", 3], ["projected", 4],
  ["baumgarte", 5], ["momentum-index2", 6], ["augmented-lagrangian", 7], ["momentum-index1", 0],
  ["acceleration-index1", 1], ["partitioned", 2], ["acceleration-index3", 3], ["momentum-index3", 6],
  ["acceleration-index2", 5], ["augmented-lagrangian-canonical", 0], ["maximal-coordinates", 7],
];

const dashes = [[], [9, 5], [2, 4], [12, 4, 2, 4], [16, 6], [2, 8]];
const markers = ["circle", "square", "triangle", "diamond", "plus", "star"];

const signs = (() => {
  const order = (form) => {
    const i = preferred.findIndex(([name]) => name === form);
    return i < 0 ? preferred.length : i;
  };
  const forms = [...new Set(runs.map((run) => run.form))];
  const integrators = [...new Set(runs.map((run) => run.integrator))];

  const uses = palette.map(() => 0);
  const colourOf = {}, roundOf = {};
  for (const form of [...forms].sort((a, b) => order(a) - order(b))) {
    let colour = order(form) < preferred.length ? preferred[order(form)][1] : 0;
    const free = uses.indexOf(0);
    if (uses[colour] > 0) colour = free >= 0 ? free : uses.indexOf(Math.min(...uses));
    if (free < 0 && order(form) < preferred.length) colour = preferred[order(form)][1];
    roundOf[form] = uses[colour]++;
    colourOf[form] = colour;
  }

  const variants = {};
  return runs.map((run, i) => {
    if (run.ladder !== i && !study.drift_study) return null;  // a rung takes the sign of its ladder
    const key = `${run.form} ${run.integrator}`;
    variants[key] = (variants[key] ?? -1) + 1;
    return {
      colour: colourOf[run.form],
      dash: dashes[(roundOf[run.form] + 2 * variants[key]) % dashes.length],
      marker: markers[integrators.indexOf(run.integrator) % markers.length],
    };
  }).map((sign, i, all) => sign ?? all[runs[i].ladder]);
})();

const manyIntegrators = new Set(runs.map((run) => run.integrator)).size > 1;

const inkOf = (sign) => (palette[sign.colour] === "ink" ? theme("--ink") : palette[sign.colour]);

/** A marker of radius r at (x, y), as a path of the canvas. */
function markerPath(kind, x, y, r) {
  const path = new Path2D();
  const corners = {
    square: [[-1, -1], [1, -1], [1, 1], [-1, 1]],
    triangle: [[0, -1.2], [1.15, 0.85], [-1.15, 0.85]],
    diamond: [[0, -1.35], [1.35, 0], [0, 1.35], [-1.35, 0]],
    plus: [[-0.4, -1.2], [0.4, -1.2], [0.4, -0.4], [1.2, -0.4], [1.2, 0.4], [0.4, 0.4], [0.4, 1.2], [-0.4, 1.2],
      [-0.4, 0.4], [-1.2, 0.4], [-1.2, -0.4], [-0.4, -0.4]],
    star: Array.from({ length: 10 }, (_, k) => {
      const size = k % 2 ? 0.6 : 1.4, angle = (Math.PI * k) / 5;
      return [size * Math.sin(angle), -size * Math.cos(angle)];
    }),
  }[kind];
  if (!corners) path.arc(x, y, r, 0, 2 * Math.PI);
  else corners.forEach(([dx, dy], k) => path[k ? "lineTo" : "moveTo"](x + r * dx, y + r * dy));
  path.closePath();
  return path;
}

const markerShapes = {
  circle: '<circle cx="17" cy="8" r="4.5"/>',
  square: '<rect x="12.5" y="3.5" width="9" height="9"/>',
  triangle: '<path d="M17 2.5L22 12.5H12Z"/>',
  diamond: '<path d="M17 2L23 8L17 14L11 8Z"/>',
  plus: '<path d="M15 2h4v4h4v4h-4v4h-4v-4h-4v-4h4Z"/>',
  star: '<path d="M17 1l2 5h5l-4 3 2 5-5-3-5 3 2-5-4-3h5Z"/>',
};

/** The sign of run i for a legend or a table: a piece of its line, and its marker where integrators differ. */
function swatch(i, dot = manyIntegrators) {
  const sign = signs[i];
  const colour = palette[sign.colour] === "ink" ? "var(--ink)" : palette[sign.colour];
  const svg = drawing("svg", { class: "swatch", width: 34, height: 16, viewBox: "0 0 34 16", "aria-hidden": "true" });
  const line = `x1="0" y1="8" x2="34" y2="8"`;
  svg.innerHTML =
    (sign.colour === yellow ? `<line ${line} stroke="var(--outline)" stroke-width="5" stroke-dasharray="${sign.dash}"/>` : "") +
    `<line ${line} stroke="${colour}" stroke-width="3" stroke-dasharray="${sign.dash}"/>` +
    (dot ? `<g fill="${colour}" stroke="var(--ground)">${markerShapes[sign.marker]}</g>` : "");
  return svg;
}
