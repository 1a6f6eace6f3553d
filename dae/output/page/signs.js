// The signs of runs: colour for the form, marker for the integrator, dash for what still differs.

/** The eight colours of Okabe and Ito. Black is the ink of the theme; yellow needs an outline on white. */
const { palette } = study;
const yellow = palette.length - 1;
const signs = runs.map((run) => run.sign);

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
