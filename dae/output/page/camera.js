// The eye: in the plane a shift and a scale, in space an orbit around a target with perspective. One camera may serve
// several canvases, so that mechanisms side by side are seen alike.

/** points: everything the pictures ever show; the camera fits them. */
function cameraOf(points) {
  const [right, up, toward] = picture.view;
  const coordinates = points.map((p) => [inner(p, right), inner(p, up), inner(p, toward)]);
  const low = [0, 1, 2].map((i) => coordinates.reduce((m, c) => Math.min(m, c[i]), Infinity));
  const high = [0, 1, 2].map((i) => coordinates.reduce((m, c) => Math.max(m, c[i]), -Infinity));
  const middle = low.map((l, i) => (Number.isFinite(l) ? (l + high[i]) / 2 : 0));
  const span = low.map((l, i) => (Number.isFinite(l) ? high[i] - l : 0));
  const size = Math.max(...span, picture.length * 0.5, 1e-9);
  const radius = coordinates.reduce((m, c) => Math.max(m, Math.hypot(...c.map((x, i) => x - middle[i]))), 0) || size;
  const world = (c) => plus(plus(scaled(right, c[0]), scaled(up, c[1])), scaled(toward, c[2]));
  const planar = picture.planar;
  const listeners = [];
  const home = { yaw: 0.62, pitch: 0.42 };
  const camera = { planar, size, span, middle, low, right, up, toward, world, zoom: 1, yaw: 0, pitch: 0, shift: [0, 0, 0] };

  camera.fit = () => { Object.assign(camera, { zoom: 1, shift: [0, 0, 0] }, planar ? {} : home); camera.changed(); };
  camera.look = (yaw, pitch) => { Object.assign(camera, { yaw, pitch }); camera.changed(); };
  camera.changed = () => listeners.forEach((listener) => listener());
  camera.onChange = (listener) => listeners.push(listener);

  /** For a canvas of this size: project(p) → [x, y, depth, pixels per metre there]; depth grows away from the eye. */
  camera.through = (width, height) => {
    const pad = Math.min(48, 0.12 * Math.min(width, height));
    const target = plus(world(middle), camera.shift);
    if (planar) {
      const scale = camera.zoom * Math.min((width - 2 * pad) / (span[0] || size), (height - 2 * pad) / (span[1] || size));
      const project = (p) => {
        const d = minus(p, target);
        return [width / 2 + inner(d, right) * scale, height / 2 - inner(d, up) * scale, -inner(d, toward), scale];
      };
      return { project, scale, toEye: () => toward, right, up };
    }
    const [cy, sy, cp, sp] = [Math.cos(camera.yaw), Math.sin(camera.yaw), Math.cos(camera.pitch), Math.sin(camera.pitch)];
    const ahead = plus(plus(scaled(right, -sy * cp), scaled(up, -sp)), scaled(toward, -cy * cp));  // where the eye looks
    const side = plus(scaled(right, cy), scaled(toward, -sy));
    const top = cross(side, ahead);
    // The sphere around everything fits the narrower side of the canvas.
    const focal = 2.6;  // distance over half the picture's height
    const half = Math.min(width, height) / 2 - pad;
    const distance = (1.05 * focal * radius) / camera.zoom;
    const eye = minus(target, scaled(ahead, distance));
    const project = (p) => {
      const d = minus(p, eye), depth = Math.max(inner(d, ahead), 0.02 * distance);
      const scale = (focal * half) / depth;
      return [width / 2 + inner(d, side) * scale, height / 2 - inner(d, top) * scale, depth, scale];
    };
    return { project, scale: (focal * half) / distance, toEye: (p) => unit(minus(eye, p)), right: side, up: top, near: distance - radius, far: distance + radius };
  };

  camera.pan = (dx, dy, eye) => {
    camera.shift = plus(camera.shift, plus(scaled(eye.right, -dx / eye.scale), scaled(eye.up, dy / eye.scale)));
    camera.changed();
  };
  camera.orbit = (dx, dy) => {
    camera.yaw -= dx * 0.008;
    camera.pitch = Math.min(1.57, Math.max(-1.57, camera.pitch + dy * 0.008));
    camera.changed();
  };
  camera.zoomBy = (factor) => { camera.zoom = Math.min(400, Math.max(0.05, camera.zoom * factor)); camera.changed(); };
  Object.assign(camera, planar ? {} : home);
  return camera;
}

/** Mouse: drag turns (in the plane: shifts), with shift or the right button shifts; the wheel zooms once the picture
 * was clicked. Touch: one finger turns, two shift and spread. Keys: arrows, + and −, 0 fits. */
function steerCamera(canvas, camera, eyeOf) {
  const held = new Map();
  canvas.addEventListener("pointerdown", (event) => {
    held.set(event.pointerId, [event.clientX, event.clientY]);
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
  });
  canvas.addEventListener("pointermove", (event) => {
    const from = held.get(event.pointerId);
    if (!from) return;
    const to = [event.clientX, event.clientY];
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    held.set(event.pointerId, to);
    if (held.size === 2) {
      const other = [...held].find(([id]) => id !== event.pointerId)[1];
      const apart = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
      if (apart(from) > 0) camera.zoomBy(apart(to) / apart(from));
      camera.pan(dx / 2, dy / 2, eyeOf());
    } else if (held.size === 1) {
      if (camera.planar || event.shiftKey || event.buttons & 6) camera.pan(dx, dy, eyeOf());
      else camera.orbit(dx, dy);
    }
  });
  for (const over of ["pointerup", "pointercancel"]) canvas.addEventListener(over, (event) => held.delete(event.pointerId));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("dblclick", () => camera.fit());
  canvas.addEventListener("wheel", (event) => {
    if (document.activeElement !== canvas && !event.ctrlKey) return;
    event.preventDefault();
    camera.zoomBy(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0016)));
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const [dx, dy] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key] ?? [0, 0];
    if (dx || dy) camera.planar || event.shiftKey ? camera.pan(-24 * dx, -24 * dy, eyeOf()) : camera.orbit(14 * dx, 14 * dy);
    else if (event.key === "+" || event.key === "=") camera.zoomBy(1.2);
    else if (event.key === "-") camera.zoomBy(1 / 1.2);
    else if (event.key === "0") camera.fit();
    else return;
    event.preventDefault();
  });
}
