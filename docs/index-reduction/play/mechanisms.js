// Two mechanisms as functions of their coordinates: what the methods of methods.js take.
//
//   mass(q) = M,  push(q, u) = Q + L_q − Ṁ u,  slope(q, u) = L_q + Q,  energy(q, u) = T + V,
//   phi(q) = Φ,  jacobian(q) = Φ_q,  jacobianRate(q, u) = Φ̇_q,  bodies(q): lines to be drawn
//
// Coordinates and rows of Φ are those of examples/pendulum/cartesian.toml and examples/four_bar/scene.toml.
"use strict";

const gravity = 9.81;  // [m/s²]

/** A point mass of 1 kg on a rod of 1 m, coordinates x, y, released level. Φ = (x² + y² − l²)/(2l) */
const pendulum = {
  name: "pendulum",
  guess: [-1, 0],
  held: 2,  // coordinates that the start keeps
  mass: () => [[1, 0], [0, 1]],
  push: () => [0, -gravity],
  slope: () => [0, -gravity],
  energy: ([, y], [u, v]) => 0.5 * (u * u + v * v) + gravity * y,
  phi: ([x, y]) => [0.5 * (x * x + y * y - 1)],
  jacobian: ([x, y]) => [[x, y]],
  jacobianRate: (q, [u, v]) => [[u, v]],
  bodies: ([x, y]) => [[[0, 0], [x, y]]],
  view: { x: [-1.2, 1.2], y: [-1.25, 0.3] },
};

/**
 * A planar crank-rocker of three slender rods, falling from rest with the crank upright. Coordinates: the crank's angle O,
 * the coupler's A counted from the crank, the rocker's C. Φ = rocker's end − coupler's end.
 *
 *   T = ½ (m₁/3 + m₂) a² Ȯ² + ½ m₂ a b cos A Ȯ (Ȯ + Ȧ) + ⅙ m₂ b² (Ȯ + Ȧ)² + ⅙ m₃ c² Ċ²
 *   V = g (m₁ a/2 sin O + m₂ (a sin O + b/2 sin(O + A)) + m₃ c/2 sin C)
 */
const fourBar = (() => {
  const a = 0.5, b = 2, c = 1.5, d = 2, m1 = 1, m2 = 2, m3 = 1.5;
  const { sin, cos } = Math;
  const coupling = (A) => 0.5 * m2 * a * b * cos(A);  // ∂²T/∂Ȯ∂(Ȯ + Ȧ)
  const couplingSlope = (A) => -0.5 * m2 * a * b * sin(A);
  const mass = ([, A]) => {
    const crank = (m1 / 3 + m2) * a * a, both = coupling(A), coupler = m2 * b * b / 3;
    return [[crank + 2 * both + coupler, both + coupler, 0], [both + coupler, coupler, 0], [0, 0, m3 * c * c / 3]];
  };
  const slope = ([O, A, C], [o, aDot]) => [
    -gravity * ((m1 / 2 + m2) * a * cos(O) + m2 * b / 2 * cos(O + A)),
    couplingSlope(A) * o * (o + aDot) - gravity * m2 * b / 2 * cos(O + A),
    -gravity * m3 * c / 2 * cos(C),
  ];
  const potential = ([O, A, C]) =>
    gravity * (m1 * a / 2 * sin(O) + m2 * (a * sin(O) + b / 2 * sin(O + A)) + m3 * c / 2 * sin(C));
  return {
    name: "four-bar",
    guess: [1.5707963267948966, -1.06, 1.74],
    held: 1,
    mass,
    slope,
    push: (q, u) => {
      const s = slope(q, u), rate = couplingSlope(q[1]) * u[1];  // Ṁ u = rate (2Ȯ + Ȧ, Ȯ, 0)
      return [s[0] - rate * (2 * u[0] + u[1]), s[1] - rate * u[0], s[2]];
    },
    energy: (q, u) => {
      const M = mass(q);
      let twice = 0;
      for (let i = 0; i < 3; ++i) for (let j = 0; j < 3; ++j) twice += u[i] * M[i][j] * u[j];
      return 0.5 * twice + potential(q);
    },
    phi: ([O, A, C]) => [
      c * cos(C) + d - a * cos(O) - b * cos(O + A),
      c * sin(C) - a * sin(O) - b * sin(O + A),
    ],
    jacobian: ([O, A, C]) => {
      const x = b * sin(O + A), y = -b * cos(O + A);
      return [[a * sin(O) + x, x, -c * sin(C)], [-a * cos(O) + y, y, c * cos(C)]];
    },
    jacobianRate: ([O, A, C], [o, aDot, cDot]) => {
      const x = b * cos(O + A) * (o + aDot), y = b * sin(O + A) * (o + aDot);
      return [[a * cos(O) * o + x, x, -c * cos(C) * cDot], [a * sin(O) * o + y, y, -c * sin(C) * cDot]];
    },
    bodies: ([O, A, C]) => {
      const knee = [a * cos(O), a * sin(O)];
      return [[[0, 0], knee], [knee, [knee[0] + b * cos(O + A), knee[1] + b * sin(O + A)]],
              [[d, 0], [d + c * cos(C), c * sin(C)]]];
    },
    view: { x: [-0.8, 3.8], y: [-1.7, 1.9] },
  };
})();

if (typeof module !== "undefined") module.exports = { pendulum, fourBar };
