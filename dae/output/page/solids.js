// What bodies are drawn of: faces, balls and bars in body axes; and how much room they take.

/** Corners in the order of their angle about the middle, or null where they do not lie in a plane. */
function around(corners) {
  const middle = scaled(corners.reduce(plus), 1 / corners.length);
  const arms = corners.map((c) => minus(c, middle));
  let normal = [0, 0, 0];
  for (let i = 1; i < arms.length; ++i) {
    const n = cross(arms[0], arms[i]);
    if (norm(n) > norm(normal)) normal = n;
  }
  const size = Math.max(...arms.map(norm));
  if (norm(normal) < 1e-6 * size * size) return null;
  normal = unit(normal);
  if (arms.some((a) => Math.abs(inner(a, normal)) > 0.02 * size)) return null;
  const x = unit(arms[0]), y = cross(normal, x);
  return corners.map((c, i) => [Math.atan2(inner(arms[i], y), inner(arms[i], x)), c])
    .sort((a, b) => a[0] - b[0]).map(([, c]) => c);
}

/** A convex solid in axes of its own: corners, and faces as lists of them; `edged`: its edges are lines. */
function convex(kind, [a, b, c]) {
  if (kind === "box") {
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [((i & 1) - 0.5) * a, (((i >> 1) & 1) - 0.5) * b, ((i >> 2) - 0.5) * c]);
    return { corners, faces: [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]], edged: true };
  }
  // A profile of [radius, z], turned about z; factors stretch an ellipsoid.
  const arc = (n, from, to, r, z) => Array.from({ length: n + 1 }, (_, k) => from + ((to - from) * k) / n).map((w) => [r * Math.cos(w), z + r * Math.sin(w)]);
  const half = Math.PI / 2, sides = 14;
  const profile = kind === "cylinder" ? [[b, -a / 2], [b, a / 2]]
    : kind === "capsule" ? [...arc(3, -half, 0, b, -a / 2), ...arc(3, 0, half, b, a / 2)] : arc(8, -half, half, 1, 0);
  const factors = kind === "ellipsoid" ? [a, b, c] : [1, 1, 1];
  const corners = [], rings = profile.map(([r, z]) => Array.from({ length: sides }, (_, k) => {
    const w = (2 * Math.PI * k) / sides;
    return corners.push([r * Math.cos(w) * factors[0], r * Math.sin(w) * factors[1], z * factors[2]]) - 1;
  }));
  const faces = kind === "cylinder" ? [rings[0], rings[1]] : [];
  for (let i = 1; i < rings.length; ++i) for (let k = 0; k < sides; ++k) {
    faces.push([rings[i - 1][k], rings[i - 1][(k + 1) % sides], rings[i][(k + 1) % sides], rings[i][k]]);
  }
  return { corners, faces, edged: false };
}

/** Meshes of the picture: corners, and triangles as lists of them, counter-clockwise from outside. */
const meshes = (picture.meshes ?? []).map(({ middle, scale, points, corners }) => {
  const shorts = (text, kind) => new kind(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const places = shorts(points, Int16Array), numbers = shorts(corners, Uint16Array);
  const three = (array, i) => [array[3 * i], array[3 * i + 1], array[3 * i + 2]];
  return {
    corners: Array.from({ length: places.length / 3 }, (_, i) => plus(middle, scaled(three(places, i), scale / 32767))),
    faces: Array.from({ length: numbers.length / 3 }, (_, i) => three(numbers, i)),
    edged: false,
  };
});

/** Solids to be drawn, each with the body (−1: ground) whose axes its corners, normals and middle are in. */
const parts = [];
function addPart(body, kind, size, at, turn, colour) {
  if (kind === "sphere") return parts.push({ body, ball: size[0], middle: at, colour });
  const { corners, faces, edged } = kind === "mesh" ? meshes[size] : convex(kind, size);
  const normals = faces.map((face) => {
    if (kind === "mesh") {
      const [p, q, r] = face.map((i) => corners[i]);
      return unit(cross(minus(q, p), minus(r, p)));
    }
    // The diagonals span a face, of a triangle with a doubled corner too.
    const [p, q, r, s] = [0, 1, 2, 3].map((i) => corners[face[Math.floor((i * face.length) / 4)]]);
    const n = unit(cross(minus(r, p), minus(s, q)));
    return inner(n, face.map((i) => corners[i]).reduce(plus)) < 0 ? scaled(n, -1) : n;
  });
  parts.push({ body, middle: at, faces, edged, colour,
    corners: corners.map((c) => plus(at, turned(turn, c))), normals: normals.map((n) => turned(turn, n)) });
}
for (const s of picture.solids) addPart(s.body, s.kind, s.mesh ?? s.size, s.at ?? [0, 0, 0], s.turn ?? [1, 0, 0, 0], s.colour);
const seenBodies = new Set(picture.solids.map((s) => s.body));
picture.bodies.forEach((body, k) => {
  if (seenBodies.has(k) || !["box", "cylinder", "sphere"].includes(body.shape)) return;
  const along = unit(body.along), n = cross([0, 0, 1], along);  // of a cylinder, turned from z
  const turn = body.shape !== "cylinder" ? [1, 0, 0, 0] : norm(n) < 1e-9 ? [1, 0, 0, 0] : about(unit(n), Math.acos(Math.max(-1, Math.min(1, along[2]))));
  addPart(k, body.shape, body.size, body.com, turn);
});

/** What a body is drawn of where no solid hides it: bars between the points that hold it, a sheet between them. */
const solids = picture.bodies.map((body, k) => {
  const [a, b, c] = body.size, bars = [];
  const solid = ["box", "cylinder", "sphere"].includes(body.shape);
  if (seenBodies.has(k)) return { bars, sheet: null };
  const outline = !solid && body.ends.length > 2 ? around(body.ends) : null;
  if (solid) {
    // Arms from the solid to what holds it, where that is outside.
    const reach = { box: Math.hypot(a, b, c) / 2, cylinder: Math.hypot(a / 2, b), sphere: a }[body.shape];
    for (const end of body.ends) if (norm(minus(end, body.com)) > 1.02 * reach) bars.push([body.com, end]);
  } else if (outline) {
    outline.forEach((corner, k) => bars.push([corner, outline[(k + 1) % outline.length]]));
  } else if (body.ends.length > 2) {
    // In space, or in line: from the middle, or along the line.
    const far = body.ends.reduce((m, e) => (norm(minus(e, body.ends[0])) > norm(minus(m, body.ends[0])) ? e : m));
    const line = unit(minus(far, body.ends[0]));
    const straight = body.ends.every((e) => norm(cross(minus(e, body.ends[0]), line)) < 1e-6 * norm(minus(far, body.ends[0])));
    if (straight) {
      const sorted = [...body.ends].sort((p, q) => inner(p, line) - inner(q, line));
      bars.push([sorted[0], sorted[sorted.length - 1]]);
    } else {
      const middle = scaled(body.ends.reduce(plus), 1 / body.ends.length);
      for (const end of body.ends) bars.push([middle, end]);
    }
  } else if (body.ends.length === 2) {
    bars.push([body.ends[0], body.ends[1]]);
  }
  return { bars, sheet: outline };
});

/**
 * Wheels of couplers, in axes of their bodies. Of two joints about parallel axes on one body, with ratios of one sign,
 * ρ₁q₁ + ρ₂q₂ = c, the pitch circles touch: r₁ : r₂ = ρ₁ : ρ₂ and r₁ + r₂ is the distance of the axes. rim(part,
 * factor): a point of the circle of factor times the radius.
 */
const wheels = [];
for (const { bodies: tied, ratios } of picture.couplers) {
  const at = tied.map((k) => picture.bodies[k]);
  if (at.length !== 2 || at[0].parent !== at[1].parent || at.some((b) => b.turn !== "axis" || b.slides) || !(ratios[0] * ratios[1] > 0)) continue;
  const [p, q] = at.map((b) => turned(b.rest, b.axis));
  if (norm(cross(p, q)) > 1e-6) continue;
  const between = minus(at[1].at_parent, at[0].at_parent), apart = norm(minus(between, scaled(p, inner(between, p))));
  at.forEach((body, i) => {
    const radius = (apart * Math.abs(ratios[i])) / (Math.abs(ratios[0]) + Math.abs(ratios[1]));
    const x = unit(cross(body.axis, Math.abs(body.axis[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0])), y = cross(body.axis, x);
    const rim = (part, factor) => plus(body.at_child, plus(scaled(x, factor * radius * Math.cos(2 * Math.PI * part)), scaled(y, factor * radius * Math.sin(2 * Math.PI * part))));
    if (radius > 0) wheels.push({ body: tied[i], middle: body.at_child, rim });
  });
}

/** Points that a picture must hold, of a few frames of each film. */
function extentOf(films) {
  const points = [];
  for (const film of films) {
    const looks = Math.min(film.count, 48);
    for (let i = 0; i < looks; ++i) {
      const state = film.frame(Math.floor((i * (film.count - 1)) / Math.max(1, looks - 1)), 0);
      picture.bodies.forEach((body, k) => {
        for (const end of seenBodies.has(k) ? [body.at_child] : body.ends) points.push(pointOf(state, k, end));
      });
      for (const part of parts) {
        if (part.body < 0) continue;  // a floor is wider than what moves on it
        for (const corner of part.corners ?? []) points.push(pointOf(state, part.body, corner));
        if (part.ball) for (const axis of [0, 1, 2]) for (const s of [-1, 1]) {
          const p = [...pointOf(state, part.body, part.middle)];
          p[axis] += s * part.ball;
          points.push(p);
        }
      }
      for (const wheel of wheels) for (let i = 0; i < 4; ++i) points.push(pointOf(state, wheel.body, wheel.rim(i / 4, 1)));
      for (const line of picture.strokes ?? [])
        if (line.closed) for (const p of line.points) points.push(pointOf(state, line.body, p));  // others go on as far as is drawn
    }
  }
  for (const pair of picture.loops) if (pair.parent < 0) points.push(pair.at_parent);
  for (const body of picture.bodies) if (body.parent < 0) points.push(body.at_parent);
  // The ground's end of a spring, unless it is so far away that the mechanism would be a dot.
  const low = [0, 1, 2].map((i) => points.reduce((m, p) => Math.min(m, p[i]), Infinity));
  const high = [0, 1, 2].map((i) => points.reduce((m, p) => Math.max(m, p[i]), -Infinity));
  const reach = 0.5 * norm(minus(high, low));
  for (const { parent, at_parent: p } of picture.springs) {
    if (parent < 0 && p.every((x, i) => x > low[i] - reach && x < high[i] + reach)) points.push(p);
  }
  return points.filter((p) => p.every(Number.isFinite));
}

/** How thick bars are [m]: a part of the middle one's length. */
const barWidth = (() => {
  const lengths = solids.flatMap(({ bars }) => bars.map(([a, b]) => norm(minus(a, b)))).filter((l) => l > 0).sort((a, b) => a - b);
  return 0.1 * (lengths[lengths.length >> 1] || picture.length);
})();

/**
 * Limits of joints: of an angle a sector between its bounds, from the joint outwards towards the body's mass; of a
 * displacement the way between them. points(state): the outline; now(state): where the joint stands.
 */
const ranges = picture.bodies.flatMap((body, k) => {
  if (!body.limits) return [];
  const [low, high] = body.limits, parent = (state) => (body.parent < 0 ? [1, 0, 0, 0] : state.turns[body.parent]);
  const centre = (state) => pointOf(state, k, body.at_child);
  if (body.kind === "prismatic") {
    if (high - low > 20 * picture.length) return [];
    const along = turned(body.rest, body.axis), across = unit(cross(along, Math.abs(along[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0]));
    const at = (state, q, off) => pointOf(state, body.parent, plus(body.at_parent, plus(scaled(along, q), scaled(across, off * barWidth))));
    const where = (state) => inner(along, turned(inverse(parent(state)), minus(centre(state), pointOf(state, body.parent, body.at_parent))));
    return [{
      points: (state) => [at(state, low, -0.6), at(state, low, 0.6), at(state, low, 0), at(state, high, 0), at(state, high, -0.6), at(state, high, 0.6)],
      now: (state) => [at(state, where(state), -0.4), at(state, where(state), 0.4)],
      passed: (state) => where(state) < low - 1e-6 || where(state) > high + 1e-6,
    }];
  }
  if (body.turn !== "axis" || high - low >= 2 * Math.PI) return [];
  const arm = minus(body.com, body.at_child), flat = minus(arm, scaled(body.axis, inner(arm, body.axis)));
  const out = norm(flat) > 1e-6 * picture.length ? unit(flat) : unit(cross(body.axis, Math.abs(body.axis[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0]));
  const radius = Math.max(2.2 * barWidth, 0.5 * norm(flat)), steps = Math.max(2, Math.ceil((high - low) / 0.15));
  const ray = (state, angle, r) => plus(centre(state), scaled(turned(product(parent(state), body.rest), turned(about(body.axis, angle), out)), r));
  const angle = (state) => {
    const [w, ...v] = product(inverse(body.rest), product(inverse(parent(state)), state.turns[k]));
    return 2 * Math.atan2(inner(v, body.axis), w);
  };
  const middle = (low + high) / 2, turn = 2 * Math.PI;
  return [{
    points: (state) => [centre(state), ...Array.from({ length: steps + 1 }, (_, i) => ray(state, low + ((high - low) * i) / steps, radius)), centre(state)],
    now: (state) => [centre(state), plus(centre(state), scaled(turned(state.turns[k], out), 1.25 * radius))],
    passed: (state) => Math.abs(angle(state) - middle - turn * Math.round((angle(state) - middle) / turn)) > (high - low) / 2 + 1e-4,
  }];
});
