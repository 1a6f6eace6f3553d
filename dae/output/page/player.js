// One time for everything on the page: the clock, its controls, and the mechanisms that follow it.

/** {t, start, end, playing, speed}; set(t), toggle(), step(n); onTime(f) and onState(f) are called with changes. */
function clockOf(films, until = -Infinity) {
  const start = Math.min(...films.map((film) => film.start)), end = Math.max(until, ...films.map((film) => film.end));
  const every = Math.min(...films.map((film) => film.every).filter((x) => x > 0), Math.max(end - start, 1e-9));
  const timeListeners = [], stateListeners = [];
  // In real time where that takes no longer than half a minute; else all of it in twenty seconds or so.
  const speeds = [0.001, 0.01, 0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50, 100, 1000, 10000];
  const span = end - start;
  const wanted = span > 30 ? span / 20 : span < 2 ? span / 6 : 1;
  const clock = { t: start, start, end, playing: false, speeds, speed: speeds.reduce((a, b) => (Math.abs(Math.log(b / wanted)) < Math.abs(Math.log(a / wanted)) ? b : a)) };
  let before = 0;

  clock.onTime = (listener) => timeListeners.push(listener);
  clock.onState = (listener) => stateListeners.push(listener);
  clock.set = (t) => {
    clock.t = Math.min(end, Math.max(start, t));
    timeListeners.forEach((listener) => listener(clock.t));
  };
  clock.step = (n) => { clock.pause(); clock.set(start + (Math.round((clock.t - start) / every) + n) * every); };
  clock.play = () => {
    if (!(span > 0)) return;
    if (clock.t >= end) clock.set(start);
    clock.playing = true;
    before = performance.now();
    requestAnimationFrame(tick);
    stateListeners.forEach((listener) => listener());
  };
  clock.pause = () => { clock.playing = false; stateListeners.forEach((listener) => listener()); };
  clock.toggle = () => (clock.playing ? clock.pause() : clock.play());
  function tick(now) {
    if (!clock.playing) return;
    clock.set(clock.t + Math.min(0.1, Math.max(0, now - before) / 1000) * clock.speed);
    before = now;
    clock.t >= end ? clock.pause() : requestAnimationFrame(tick);
  }
  return clock;
}

/** Play, step, scrub, time, speed. */
function clockBar(clock) {
  const button = (text, label, act) => {
    const node = element("button", { type: "button", "aria-label": label, title: label }, text);
    node.addEventListener("click", act);
    return node;
  };
  const play = button("▶", "Play", () => clock.toggle());
  play.classList.add("play");
  const slide = element("input", { type: "range", min: 0, max: 10000, value: 0, step: 1, "aria-label": "Time" });
  slide.addEventListener("input", () => { clock.pause(); clock.set(clock.start + ((clock.end - clock.start) * slide.value) / 10000); });
  const time = element("output", { class: "time" });
  // Of a page of poses the clock shows the travel of the swept coordinate.
  const [clockName, clockUnit] = study.timeline?.[0]?.x_title?.match(/^(.*) \[(.*)\]$/)?.slice(1) ?? ["t", "s"];
  const digits = Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(Math.max(clock.end - clock.start, 1e-6)) + 1e-9)));
  const speed = element("select", { "aria-label": "Speed" },
    ...clock.speeds.map((s) => element("option", { value: s, ...(s === clock.speed ? { selected: "" } : {}) }, `${s}×`)));
  speed.addEventListener("change", () => { clock.speed = Number(speed.value); });
  clock.onTime((t) => {
    slide.value = clock.end > clock.start ? (10000 * (t - clock.start)) / (clock.end - clock.start) : 0;
    time.textContent = `${clockName} = ${t.toFixed(digits)} ${clockUnit}`;
    slide.setAttribute("aria-valuetext", time.textContent);
  });
  clock.onState(() => {
    play.textContent = clock.playing ? "❚❚" : "▶";
    play.setAttribute("aria-label", clock.playing ? "Pause" : "Play");
  });
  addEventListener("keydown", (event) => {
    if (!play.isConnected || ["INPUT", "SELECT", "BUTTON", "A"].includes(event.target.tagName)) return;
    if (event.key === " ") clock.toggle();
    else if (event.key === "," || event.key === ".") clock.step(event.key === "." ? 1 : -1);
    else return;
    event.preventDefault();
  });
  return element("div", { class: "clock", role: "group", "aria-label": "Time" }, play,
    button("◂", "One frame back", () => clock.step(-1)), button("▸", "One frame on", () => clock.step(1)), slide, time, speed);
}

/** Which power of ten shows the largest gap as a sixth of the mechanism; 0 where all of them are rounding. */
function gapFactor(films, size) {
  const largest = Math.max(0, ...films.map((film) => film.largestGap));
  if (!(largest > 1e-14 * size)) return 0;
  return Math.max(1, 10 ** Math.floor(Math.log10((0.17 * size) / largest)));
}

const many = (n, one, more = one + "s") => `${n} ${n === 1 ? one : more}`;

/**
 * The figure: tick boxes, one panel for each film, the clock. titleOf(film) is the panel's heading or null; names: the
 * boxes ticked at first; until: the end of curves that go on without a film. Returns {figure, clock, stages}.
 */
function moviePlayer(films, titleOf, ticked, until) {
  const camera = cameraOf(extentOf(films));
  const clock = clockOf(films, until);
  const moving = clock.end > clock.start;
  const fitting = gapFactor(films, camera.size);
  let factor = fitting;
  const has = { names: true, joints: true, loops: picture.loops.length > 0, traces: picture.markers.length > 0 && moving,
    limits: ranges.length > 0, masses: true, frames: true, grid: true };
  const show = Object.fromEntries(Object.keys(has).map((key) => [key, has[key] && ticked.includes(key)]));
  const panels = element("div", { class: "panels" + (films.length > 1 ? " several" : "") });
  const stages = films.map((film, i) => {
    const title = titleOf(film);
    const canvas = element("canvas", { tabindex: "0", role: "img", "aria-label":
      `The mechanism${title ? " of " + title.textContent.trim() : ""}: ${many(picture.bodies.length, "body", "bodies")}, ` +
      `${many(picture.bodies.length, "joint")}, ${many(picture.loops.length, "loop")}. Bodies: ${picture.bodies.slice(0, 40).map((b) => b.name).join(", ")}.` });
    if (camera.planar) {
      canvas.classList.add("flat");
      if (films.length === 1) canvas.style.setProperty("--shape", Math.min(2.8, Math.max(1.25, camera.span[0] / (camera.span[1] || 1e-9))));
    }
    const note = element("p", { class: "opening" });
    panels.append(element("figure", {}, ...(title ? [element("figcaption", {}, title)] : []), canvas, ...(picture.loops.length ? [note] : [])));
    const stage = stageOf(canvas, film, camera, show, () => factor);
    steerCamera(canvas, camera, stage.eye);
    return { ...stage, canvas, note };
  });

  let asked = false;
  function draw() {
    asked = false;
    for (const { draw: on, note, film } of stages) {
      const state = on(clock.t);
      if (!state) continue;
      const widest = Math.max(0, ...state.gaps.map(norm));
      const over = film.count > 1 && clock.t > film.end + 1e-9 * (1 + Math.abs(film.end));
      note.textContent = `${over ? `stopped at ${number(film.end, 4)} s; ` : ""}` +
        (widest > 1e-14 * camera.size ? `widest gap ${number(widest)} m` : "closed to rounding");
    }
  }
  const soon = () => { if (!asked) { asked = true; requestAnimationFrame(draw); } };
  clock.onTime(soon);
  camera.onChange(soon);
  stages.forEach(({ canvas }) => new ResizeObserver(soon).observe(canvas));
  charts.push({ shown: [], show: () => {}, redraw: draw });

  const boxes = element("div", { class: "boxes" });
  const words = { names: "names", joints: "joints", loops: "loops", traces: "traces", limits: "limits", masses: "mass centres", frames: "body axes", grid: "grid" };
  for (const key of Object.keys(has).filter((k) => has[k])) {
    const box = element("input", { type: "checkbox", ...(show[key] ? { checked: "" } : {}) });
    box.addEventListener("change", () => { show[key] = box.checked; soon(); });
    boxes.append(element("label", {}, box, words[key]));
  }
  if (picture.loops.length && fitting) {
    const factors = [...new Set([1, fitting, ...Array.from({ length: 15 }, (_, k) => 10 ** k)])].sort((a, b) => a - b);
    const select = element("select", { "aria-label": "Gaps magnified" }, ...factors.map((f) =>
      element("option", { value: f, ...(f === fitting ? { selected: "" } : {}) }, f === 1 ? "true size" : `× ${f < 1000 ? f : "10" + raised(Math.round(Math.log10(f)))}`)));
    select.addEventListener("change", () => { factor = Number(select.value); soon(); });
    boxes.append(element("label", {}, "gaps", select));
  }
  const looks = element("div", { class: "looks", role: "group", "aria-label": "View" });
  const look = (text, act) => {
    const node = element("button", { type: "button" }, text);
    node.addEventListener("click", act);
    looks.append(node);
  };
  if (!camera.planar) {
    look("Front", () => camera.look(0, 0));
    look("Side", () => camera.look(Math.PI / 2, 0));
    look("Top", () => camera.look(0, 1.57));
  }
  look("Fit", () => camera.fit());
  look("+", () => camera.zoomBy(1.25));
  look("−", () => camera.zoomBy(0.8));
  boxes.append(looks);

  const figure = element("div", { class: "movie" }, panels, ...(moving ? [clockBar(clock)] : []), boxes);
  if (moving && films.every((film) => film.count < 2)) {
    figure.append(element("p", { class: "caption" }, "The start only: a film of so many bodies is more than a page holds."));
  }
  if (films.some((film) => film.coarse)) {
    figure.append(element("p", { class: "caption" }, `Frames are ${number(films[0].every, 3)} s apart and bodies turn far between them: ` +
      "they are shown one by one, and which way a body went is not told."));
  }
  clock.set(clock.start);
  return { figure, clock, stages, camera, factor: () => factor };
}

/** Boxes that a single picture starts with: names only where they leave it readable. */
const usualBoxes = ["joints", "loops", "traces", "grid", ...(ranges.length <= 8 ? ["limits"] : []), ...(picture.bodies.length + picture.loops.length <= 16 ? ["names"] : [])];

/** What can be done with the picture, in a sentence. */
function steeringWords() {
  return (picture.planar ? "Drag shifts" : "Drag turns, with shift it shifts") +
    "; click, then the wheel zooms; space plays, comma and full stop step";
}
