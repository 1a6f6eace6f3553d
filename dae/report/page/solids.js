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

/** What a body is drawn of, in its axes: faces of its solid, a ball, bars between the points that hold it. */
const solids = picture.bodies.map((body) => {
  const [a, b, c] = body.size;
  const faces = [], bars = [];
  let ball = null;
  if (body.shape === "box") {
    const corner = (i, j, k) => plus(body.com, [(i * a) / 2, (j * b) / 2, (k * c) / 2]);
    for (const s of [-1, 1]) {
      faces.push([corner(s, -1, -1), corner(s, 1, -1), corner(s, 1, 1), corner(s, -1, 1)],
        [corner(-1, s, -1), corner(-1, s, 1), corner(1, s, 1), corner(1, s, -1)],
        [corner(-1, -1, s), corner(1, -1, s), corner(1, 1, s), corner(-1, 1, s)]);
    }
  } else if (body.shape === "cylinder") {
    const along = unit(body.along);
    const x = unit(cross(along, Math.abs(along[0]) < 0.8 ? [1, 0, 0] : [0, 1, 0])), y = cross(along, x);
    const sides = 14;
    const rim = (s, k) => plus(plus(body.com, scaled(along, (s * a) / 2)),
      plus(scaled(x, b * Math.cos((2 * Math.PI * k) / sides)), scaled(y, b * Math.sin((2 * Math.PI * k) / sides))));
    for (const s of [-1, 1]) faces.push(Array.from({ length: sides }, (_, k) => rim(s, k)));
    for (let k = 0; k < sides; ++k) faces.push([rim(-1, k), rim(-1, k + 1), rim(1, k + 1), rim(1, k)]);
  } else if (body.shape === "sphere") {
    ball = { at: body.com, r: a };
  }
  const solid = faces.length > 0 || ball;
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
  return { faces, ball, bars, sheet: outline };
});

/** Points that a picture must hold, of a few frames of each film. */
function extentOf(films) {
  const points = [];
  for (const film of films) {
    const looks = Math.min(film.count, 48);
    for (let i = 0; i < looks; ++i) {
      const state = film.frame(Math.floor((i * (film.count - 1)) / Math.max(1, looks - 1)), 0);
      picture.bodies.forEach((body, k) => {
        for (const end of body.ends) points.push(pointOf(state, k, end));
        for (const face of solids[k].faces) for (const corner of face) points.push(pointOf(state, k, corner));
        if (solids[k].ball) for (const axis of [0, 1, 2]) for (const s of [-1, 1]) {
          const p = pointOf(state, k, solids[k].ball.at);
          p[axis] += s * solids[k].ball.r;
          points.push(p);
        }
      });
    }
  }
  for (const pair of [...picture.loops, ...picture.springs]) if (pair.parent < 0) points.push(pair.at_parent);
  for (const body of picture.bodies) if (body.parent < 0) points.push(body.at_parent);
  return points.filter((p) => p.every(Number.isFinite));
}

/** How thick bars are [m]: a part of the middle one's length. */
const barWidth = (() => {
  const lengths = solids.flatMap(({ bars }) => bars.map(([a, b]) => norm(minus(a, b)))).filter((l) => l > 0).sort((a, b) => a - b);
  return 0.1 * (lengths[lengths.length >> 1] || picture.length);
})();
