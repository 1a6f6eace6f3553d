// The page of an equilibrium: the mechanism swinging in one mode at a time, beside the table of all.

{
  const main = document.getElementById("main");
  const { modes } = study;
  const filmed = study.motions.filter((motion) => motion.run >= 0);
  const stage = element("div");
  const left = element("div", { class: "left" }, stage), right = element("div", { class: "right" });
  main.append(element("section", { class: "beside modes" }, left, right));

  const swings = (mode) => mode.s[1] > 0;
  const title = (i) => {
    const mode = modes[i];
    const what = swings(mode) ? `${number(mode.frequency, 4)} Hz` : mode.kind === "rigid" ? "rigid" : `${mode.kind}, ${number(mode.s[0], 3)}/s`;
    return `mode ${i + 1}: ${what}`;
  };

  let shown = 0, amplitude = 1, player = null;

  /**
   * The motion of a mode in its own time. Frames of a real mode go from −φ to φ, and s tells where it is between them:
   * cos ωt e^{σt}; those of another go once around. A rigid mode is shown as if it swung in two seconds.
   */
  function swingOf(motion) {
    const mode = modes[motion.run], film = filmOf(motion);
    const [sigma, omega] = mode.kind === "rigid" ? [0, Math.PI] : mode.s;
    const cycles = 20;
    const long = omega > 0 ? (cycles * 2 * Math.PI) / omega : Infinity, short = sigma !== 0 ? 5 / Math.abs(sigma) : Infinity;
    const end = mode.real ? Math.max(Math.min(long, short), omega > 0 ? (2 * Math.PI) / omega : 0) : long;
    const half = (film.count - 1) / 2;
    const at = (t) => {
      if (!mode.real) {
        const turn = (omega * t) / (2 * Math.PI);
        return film.at((turn - Math.floor(turn)) * (film.count - 1));
      }
      const size = Math.exp(sigma > 0 ? sigma * (t - end) : sigma * t);
      return film.at(half * (1 + amplitude * size * Math.cos(omega * t)));
    };
    const count = 32 * cycles + 1, every = end / (count - 1);
    return { run: motion.run, start: 0, end, every, count, coarse: false, largestGap: 0, at, frame: (k, part) => at((k + part) * every) };
  }

  const choice = element("select", { "aria-label": "Mode" }, ...filmed.map((motion) => element("option", { value: motion.run }, title(motion.run))));
  choice.addEventListener("change", () => choose(Number(choice.value)));
  const size = element("input", { type: "range", min: 0, max: 1, step: 0.01, value: 1, "aria-label": "Amplitude" });
  size.addEventListener("input", () => { amplitude = Number(size.value); player.clock.set(player.clock.t); });
  const sized = element("label", {}, "amplitude", size);

  function choose(run) {
    shown = run;
    player?.clock.pause();
    player = moviePlayer([swingOf(filmed.find((motion) => motion.run === run))], () => null, usualBoxes, -Infinity);
    sized.hidden = !modes[run].real;
    choice.value = run;
    stage.replaceChildren(element("div", { class: "boxes" }, choice, sized), player.figure);
    rows.forEach((row, i) => row.classList.toggle("chosen", i === run));
    player.clock.set(0);
  }

  const rows = modes.map((mode, i) => {
    const can = filmed.some((motion) => motion.run === i);
    const name = can ? element("button", { type: "button" }, `show ${i + 1}`) : `${i + 1}`;
    if (can) name.addEventListener("click", () => choose(i));
    const cells = [mode.kind, swings(mode) ? number(mode.frequency, 5) : "–", swings(mode) ? number(mode.s[1], 5) : "–",
      measured(mode.damping_ratio) ? number(mode.damping_ratio, 3) : "–", number(mode.s[0], 3), mode.moves];
    return element("tr", {}, element("th", { scope: "row" }, name),
      ...cells.map((text, k) => element("td", k === 5 ? { class: "text moves" } : k === 0 ? { class: "text" } : {}, text)));
  });
  const head = element("tr", {}, ...["mode", "kind", "f [Hz]", "ω [rad/s]", "damping ratio", "growth [1/s]", "moves most"].map((text) =>
    element("th", { scope: "col", class: "text plain" }, text)));
  const table = element("table", {}, element("caption", { class: "hidden" }, "Modes"), element("thead", {}, head), element("tbody", {}, ...rows));
  const frame = element("div", { class: "frame", tabindex: "0", role: "region", "aria-label": "Table: modes" }, table);
  right.append(element("h2", {}, "Modes"), frame,
    element("p", { class: "notes" }, download("All modes with their shapes as CSV", `${fileName}-modes.csv`, () => study.csv)));

  if (filmed.length && picture.bodies.length) {
    choose(filmed[0].run);
    left.append(element("p", { class: "caption" }, `${steeringWords()}. The swing is drawn far larger than small motions are, the loops closed throughout` +
      (filmed.length < modes.length ? `; the first ${filmed.length} modes are shown.` : ".")));
  } else {
    left.append(element("p", { class: "caption" }, !modes.length ? "Nothing moves." : picture.without_bodies ? "A system of formulas: there are no bodies to draw." : "The mechanism is not drawn: it has more bodies than a page holds."));
  }
  main.append(makingSection());
  followTheme();
}
