// Where bodies are at a time, from the tracks of a motion: R_k = R_j T, x_k = x_j + R_j s − R_k c, so that joints
// hold between the samples too. Vectors are [x, y, z], quaternions [w, x, y, z].

const picture = study.picture;

const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const inner = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => scaled(a, 1 / (norm(a) || 1));
const mixed = (a, b, part) => plus(scaled(a, 1 - part), scaled(b, part));

const product = ([a, b, c, d], [e, f, g, h]) =>
  [a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e];
function turned([w, ...v], a) {
  const t = scaled(cross(v, a), 2);
  return plus(a, plus(scaled(t, w), cross(v, t)));
}
const inverse = ([w, x, y, z]) => [w, -x, -y, -z];
const about = (axis, angle) => [Math.cos(angle / 2), ...scaled(axis, Math.sin(angle / 2))];

/** Along the shorter great circle, at constant rate. */
function slerp(p, q, part) {
  let cosine = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
  const sign = cosine < 0 ? -1 : 1;
  cosine = Math.min(1, sign * cosine);
  const angle = Math.acos(cosine), sine = Math.sin(angle);
  const [a, b] = sine < 1e-6 ? [1 - part, part] : [Math.sin((1 - part) * angle) / sine, Math.sin(part * angle) / sine];
  const mix = p.map((x, i) => a * x + sign * b * q[i]);
  const size = Math.hypot(...mix);
  return mix.map((x) => x / size);
}

/** start, end, and at(t): {turns, places, gaps} of all bodies and loops in ground axes. */
function filmOf(motion) {
  const { count, start, every } = motion;
  const bytes = Uint8Array.from(atob(motion.data), (c) => c.charCodeAt(0));
  const numbers = new Int16Array(bytes.buffer);
  let at = 0;
  const next = () => numbers.subarray(at, (at += count));
  const bodies = picture.bodies.map((body) => ({
    ...body,
    angle: body.turn === "axis" ? next() : null,
    free: body.turn === "free" ? [next(), next(), next(), next()] : null,
    slide: body.slides ? [next(), next(), next()] : null,
  }));
  const gaps = picture.loops.map(() => (picture.planar ? [next(), next()] : [next(), next(), next()]));

  // Where a body turns so far between two frames that the way is anybody's guess, frames are shown one by one.
  const quarter = 16384;
  const coarse = bodies.some((body) => body.angle?.some((a, k) => k && Math.abs((a - body.angle[k - 1]) << 16 >> 16) > quarter));

  const turnAt = (body, k, part) => {
    if (body.angle) {
      const step = part ? ((body.angle[k + 1] - body.angle[k]) << 16) >> 16 : 0;  // the shorter way round
      return product(body.rest, about(body.axis, ((body.angle[k] + part * step) * Math.PI) / 32768));
    }
    if (!body.free) return body.rest;
    const of = (i) => { const q = body.free.map((track) => track[i]), size = Math.hypot(...q); return q.map((x) => x / size); };
    return part ? slerp(of(k), of(k + 1), part) : of(k);
  };
  const value = (tracks, k, part, scale) =>
    tracks.map((track) => ((part ? (1 - part) * track[k] + part * track[k + 1] : track[k]) * scale) / 32767);

  function frame(k, part) {
    const turns = [], places = [];
    bodies.forEach((body, i) => {
      const own = turnAt(body, k, part);
      const slide = body.slide ? value(body.slide, k, part, motion.slide_scale) : body.at_parent;
      const parent = body.parent;
      turns[i] = parent < 0 ? own : product(turns[parent], own);
      const joint = parent < 0 ? slide : plus(places[parent], turned(turns[parent], slide));
      places[i] = minus(joint, turned(turns[i], body.at_child));
    });
    return {
      turns, places,
      gaps: gaps.map((tracks) => {
        const g = value(tracks, k, part, motion.gap_scale);
        return picture.planar ? plus(scaled(picture.view[0], g[0]), scaled(picture.view[1], g[1])) : g;
      }),
    };
  }

  return {
    run: motion.run, start, every, count, coarse, largestGap: motion.gap_scale,
    end: start + every * Math.max(0, count - 1),
    frame,
    at(t) {
      const k = every > 0 ? Math.min(Math.max((t - start) / every, 0), count - 1) : 0;
      const whole = Math.floor(k + 1e-9);
      return frame(whole, coarse || whole + 1 >= count ? 0 : Math.max(0, k - whole));
    },
  };
}

/** A point of a body, or of the ground, in ground axes. */
const pointOf = (state, body, at) => (body < 0 ? at : plus(state.places[body], turned(state.turns[body], at)));
