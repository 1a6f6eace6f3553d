// Six ways to integrate M u̇ + Φ_qᵀλ = Q + L_q − Ṁ u, Φ(q) = 0, each with a fixed step h:
//
//   index-3     q̇ = v, the equations as they are               generalised-α of spectral radius 0.8
//   index-2     Φ̇ = 0 in place of Φ = 0                        half-explicit Runge-Kutta of order 5
//   index-1     Φ̈ = 0, solved for λ: an ODE                    RK4
//   baumgarte   Φ̈ + 2αΦ̇ + β²Φ = 0, solved for λ                RK4
//   projected   index-1, q and u put onto Φ = 0, Φ̇ = 0         RK4, after each step
//   momentum    (7), (8) with gauge leak κ                     RK4
//
// They are the program's forms acceleration-index3, acceleration-index2, acceleration, baumgarte, projected and momentum,
// with its integrators generalised-alpha, hem5 and rk4: dae/form, dae/integrator, where the sources are.
"use strict";

// ---- linear algebra of a few rows

/** Solves A x = b in place, with row pivots; false where A is singular. */
function solve(A, b) {
  const n = b.length;
  for (let k = 0; k < n; ++k) {
    let best = k;
    for (let i = k + 1; i < n; ++i) if (Math.abs(A[i][k]) > Math.abs(A[best][k])) best = i;
    if (!(Math.abs(A[best][k]) > 0)) return false;
    [A[k], A[best]] = [A[best], A[k]];
    [b[k], b[best]] = [b[best], b[k]];
    for (let i = k + 1; i < n; ++i) {
      const factor = A[i][k] / A[k][k];
      if (factor === 0) continue;
      for (let j = k + 1; j < n; ++j) A[i][j] -= factor * A[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (let k = n - 1; k >= 0; --k) {
    for (let j = k + 1; j < n; ++j) b[k] -= A[k][j] * b[j];
    b[k] /= A[k][k];
  }
  return b.every(Number.isFinite);
}

const times = (A, x) => A.map((row) => row.reduce((sum, a, j) => sum + a * x[j], 0));
const transposedTimes = (A, y) => A[0].map((_, j) => A.reduce((sum, row, i) => sum + row[j] * y[i], 0));
const plus = (x, factor, y) => x.map((v, i) => v + factor * y[i]);
const norm = (x) => Math.hypot(...x);

/** (x, y) of M x + Φ_qᵀ y = r, J x = g; null where the matrix is singular. */
function saddle(M, force, J, r, g) {
  const n = M.length, m = J.length;
  const A = [];
  for (let i = 0; i < n; ++i) A.push([...M[i], ...force.map((row) => row[i])]);
  for (let i = 0; i < m; ++i) A.push([...J[i], ...new Array(m).fill(0)]);
  const b = [...r, ...g];
  return solve(A, b) ? [b.slice(0, n), b.slice(n)] : null;
}

// ---- the forms

/** u̇ and λ of (3) with Baumgarte's feedback. */
function accelerations(s, q, u, alpha = 0, beta = 0) {
  const J = s.jacobian(q), bias = times(s.jacobianRate(q, u), u);
  let g = bias.map((x) => -x);
  if (alpha !== 0) g = plus(g, -2 * alpha, times(J, u));
  if (beta !== 0) g = plus(g, -beta * beta, s.phi(q));
  return saddle(s.mass(q), J, J, s.push(q, u), g);
}

/** u and σ of (7). */
function velocities(s, q, p) {
  const J = s.jacobian(q);
  return saddle(s.mass(q), J, J, p, J.map(() => 0));
}

/** The state nearest in the metric of M: q onto Φ = 0, u onto Φ̇ = 0. */
function project(s, q, u) {
  let before = Infinity;
  for (let k = 0; k < 10; ++k) {
    const J = s.jacobian(q);
    const found = saddle(s.mass(q), J, J, q.map(() => 0), s.phi(q).map((x) => -x));
    if (!found) return null;
    const length = Math.max(...found[0].map(Math.abs));
    if (k > 0 && !(length < 0.5 * before)) break;
    q = plus(q, 1, found[0]);
    if (length <= 1e-8) break;
    before = length;
  }
  const found = velocities(s, q, times(s.mass(q), u));
  return found && [q, found[0]];
}

/** One step of RK4 for y' = f(y); null where f fails. */
function rk4(f, y, h) {
  const k1 = f(y);
  const k2 = k1 && f(plus(y, h / 2, k1));
  const k3 = k2 && f(plus(y, h / 2, k2));
  const k4 = k3 && f(plus(y, h, k3));
  return k4 && y.map((v, i) => v + h * (k1[i] / 6 + k2[i] / 3 + k3[i] / 3 + k4[i] / 6));
}

/** ODEs in (q, u). */
function accelerationForm(s, start, { h, alpha = 0, beta = 0, after = null }) {
  const n = start.q.length;
  let q = start.q, u = start.u;
  const f = (y) => {
    const rates = y.slice(n), found = accelerations(s, y.slice(0, n), rates, alpha, beta);
    return found && [...rates, ...found[0]];
  };
  return {
    step() {
      const y = rk4(f, [...q, ...u], h);
      if (!y) return false;
      let state = [y.slice(0, n), y.slice(n)];
      if (after) state = after(s, ...state);
      if (!state) return false;
      [q, u] = state;
      return true;
    },
    state: () => ({ q, u }),
  };
}

/** ODE in (q, p); ṗ = L_q + Q + Φ̇_qᵀσ − κ Φ_qᵀσ. */
function momentumForm(s, start, { h, kappa }) {
  const n = start.q.length;
  const J = s.jacobian(start.q);
  const sigma = kappa > 0 ? start.lambda.map((x) => x / kappa) : start.lambda.map(() => 0);  // no transient
  let y = [...start.q, ...plus(times(s.mass(start.q), start.u), 1, transposedTimes(J, sigma))];
  const f = (at) => {
    const q = at.slice(0, n), found = velocities(s, q, at.slice(n));
    if (!found) return null;
    const [u, impulse] = found;
    let force = plus(s.slope(q, u), 1, transposedTimes(s.jacobianRate(q, u), impulse));
    if (kappa > 0) force = plus(force, -kappa, transposedTimes(s.jacobian(q), impulse));
    return [...u, ...force];
  };
  return {
    step() {
      const next = rk4(f, y, h);
      if (!next) return false;
      y = next;
      return true;
    },
    state: () => {
      const q = y.slice(0, n), found = velocities(s, q, y.slice(n));
      return { q, u: found ? found[0] : q.map(() => NaN) };
    },
  };
}

// ---- index 2: half-explicit Runge-Kutta on the stages of Dormand and Prince (dae/integrator/tableau_hem5.h)

const root19 = Math.sqrt(19);
const stages = [
  [],
  [1 / 5],
  [3 / 40, 9 / 40],
  [44 / 45, -56 / 15, 32 / 9],
  [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
  [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
];
const closures = [
  [],
  [3 / 40, 9 / 40],
  [9 / 80, 0, 27 / 80],
  [2 / 45, 0, 128 / 225, 14 / 75],
  [(7100489 - 167578 * root19) / 75168900, 0, (419310944 + 11462912 * root19) / 995987925,
   (1466359 + 346957 * root19) / 6264075, (-29745873 - 7794954 * root19) / 442661300],
  [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
];

/**
 * In (q, v): stage i by `stages`, its λ such that Φ̇ = 0 at the point that `closures` reaches. There q does not depend on
 * λ, and v does linearly.
 */
function index2Form(s, start, { h }) {
  const n = start.q.length;
  const first = accelerations(s, start.q, start.u);
  let y = [...start.q, ...start.u], rate = [...start.u, ...first[0]];
  const combine = (k, row) => {
    let sum = y;
    row.forEach((a, j) => { if (a !== 0) sum = plus(sum, h * a, k[j]); });
    return sum;
  };
  return {
    step() {
      const k = [rate];
      let there = null;
      for (let i = 1; i < 6; ++i) {
        const at = combine(k, stages[i]), base = combine(k, closures[i].slice(0, i)), weight = h * closures[i][i];
        const q = at.slice(0, n), v = at.slice(n);
        there = plus(base.slice(0, n), weight, v);
        const J = s.jacobian(there), g = times(J, base.slice(n)).map((x) => -x / weight);
        const found = saddle(s.mass(q), s.jacobian(q), J, s.push(q, v), g);
        if (!found) return false;
        k.push([...v, ...found[0]]);
      }
      y = combine(k, closures[5]);
      const found = accelerations(s, y.slice(0, n), y.slice(n));
      if (!found) return false;
      rate = [...y.slice(n), ...found[0]];
      return true;
    },
    state: () => ({ q: y.slice(0, n), u: y.slice(n) }),
  };
}

// ---- index 3: generalised-α (dae/integrator/newmark.h)

function index3Form(s, start, { h, radius = 0.8 }) {
  const am = (2 * radius - 1) / (radius + 1), af = radius / (radius + 1);
  const gamma = 0.5 + af - am, beta = 0.25 * (gamma + 0.5) ** 2, kappa = (1 - af) / (1 - am);
  let { q, u: v, lambda } = start, vdot = accelerations(s, q, v)[0], a = vdot;
  return {
    step() {
      let next = vdot, multiplier = lambda, size = Infinity, best = Infinity, stood = 0;
      const place = () => {
        const an = a.map((x, i) => ((1 - af) * next[i] + af * vdot[i] - am * x) / (1 - am));
        return {
          an,
          vn: v.map((x, i) => x + h * ((1 - gamma) * a[i] + gamma * an[i])),
          qn: q.map((x, i) => x + h * (v[i] + h * ((0.5 - beta) * a[i] + beta * an[i]))),
        };
      };
      for (let count = 0; count < 60; ++count) {
        // Newton's matrix without the derivatives of forces: (M Φ_qᵀ; h²βκ Φ_q 0), which converges like h².
        const { qn, vn } = place();
        const M = s.mass(qn), J = s.jacobian(qn);
        const wanted = plus(plus(s.push(qn, vn), -1, times(M, next)), -1, transposedTimes(J, multiplier));
        const found = saddle(M, J, J, wanted, s.phi(qn).map((x) => -x / (h * h * beta * kappa)));
        if (!found) return false;
        next = plus(next, 1, found[0]);
        multiplier = plus(multiplier, 1, found[1]);
        size = h * h * norm(found[0]);
        if (!Number.isFinite(size)) return false;
        stood = size < 0.5 * best ? 0 : stood + 1;
        best = Math.min(best, size);
        if (size === 0 || (best < 1e-11 && stood > 2)) break;  // rounding
      }
      if (!(size < 1e-11)) return false;
      const { qn, vn, an } = place();
      [q, v, a, vdot, lambda] = [qn, vn, an, next, multiplier];
      return true;
    },
    state: () => ({ q, u: v }),
  };
}

const forms = {
  "index-3": index3Form,
  "index-2": index2Form,
  "index-1": (s, start, { h }) => accelerationForm(s, start, { h }),
  baumgarte: accelerationForm,
  projected: (s, start, { h }) => accelerationForm(s, start, { h, after: project }),
  momentum: momentumForm,
};

// ---- runs

/** At rest, on Φ = 0, with the first `held` coordinates as guessed, and λ. */
function startOf(s) {
  const n = s.guess.length;
  let q = [...s.guess];
  for (let k = 0; k < 20 && s.held < n; ++k) {
    const A = s.jacobian(q).map((row) => row.slice(s.held)), b = s.phi(q).map((x) => -x);
    if (!solve(A, b)) break;
    q = q.map((x, i) => (i < s.held ? x : x + b[i - s.held]));
    if (Math.max(...b.map(Math.abs)) < 1e-15) break;
  }
  const u = q.map(() => 0);
  return { q, u, lambda: accelerations(s, q, u)[1] };
}

/**
 * A run under way: advance(count) takes so many steps and gives, per step, {t, q, u, position, velocity, energy}: |Φ|, |Φ̇|
 * and |E − E(0)|. `failed`: a step was not possible, or the loop has come apart.
 */
function runOf(s, form, settings) {
  const start = startOf(s), method = forms[form](s, start, settings), before = s.energy(start.q, start.u);
  const run = { t: 0, steps: 0, failed: false, start };
  run.advance = (count) => {
    const samples = [];
    for (let i = 0; i < count && !run.failed; ++i) {
      if (!method.step()) {
        run.failed = true;
        break;
      }
      run.t = ++run.steps * settings.h;
      const { q, u } = method.state();
      const sample = { t: run.t, q, u, position: norm(s.phi(q)), velocity: norm(times(s.jacobian(q), u)),
                       energy: Math.abs(s.energy(q, u) - before) };
      if (!Number.isFinite(sample.energy) || sample.position > 10) run.failed = true;
      else samples.push(sample);
    }
    return samples;
  };
  return run;
}

if (typeof module !== "undefined") module.exports = { forms, runOf, startOf };
