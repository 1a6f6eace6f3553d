// Numbers, colours and elements: the small words of the page.

const study = JSON.parse(document.getElementById("study").textContent);
const runs = study.runs;

/** Below this a logarithmic axis shows nothing but rounding: values are drawn on this line. */
const roundingFloor = 1e-17;

const measured = (value) => typeof value === "number" && Number.isFinite(value);

const raised = (n) => String(n).replace(/[-0-9]/g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]));

/** 0.27, 12, 2.7×10⁻⁵: `digits` significant digits; "–" when not measured. */
function number(value, digits = 2) {
  if (!measured(value)) return "–";
  if (value === 0) return "0";
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e").map(Number);
  if (exponent >= -2 && exponent < 4) return String(Number(value.toPrecision(digits)));
  return `${mantissa.toFixed(digits - 1)}×10${raised(exponent)}`;
}

/** 10⁻³, or 2·10⁻³ between the powers. */
function tick(value) {
  const exponent = Math.floor(Math.log10(value) + 1e-9);
  const mantissa = Math.round(value / 10 ** exponent);
  return (mantissa === 1 ? "" : `${mantissa}·`) + "10" + raised(exponent);
}

const count = (value) => (measured(value) ? String(value).replace(/\B(?=(\d{3})+$)/g, "\u202f") : "–");

/** An element with attributes and children; strings become text. */
function element(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  for (const child of children) node.append(...(typeof child === "string" ? dotted(child) : [child]));
  return node;
}

/** Text in which the dot of Φ̇ stands above its letter: fonts put it inside. */
function dotted(text) {
  return text.split("Φ\u0307").flatMap((part, i) => {
    if (!i) return [part];
    const rate = document.createElement("span"), dot = document.createElement("span");
    rate.className = "rate";
    dot.className = "hidden";
    dot.textContent = "\u0307";
    rate.append("Φ", dot);
    return [rate, part];
  });
}

function drawing(name, attributes = {}, ...children) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

const theme = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** A link that saves `text()` as a file; the text is made when it is asked for. */
function download(label, file, text) {
  const link = element("a", { href: "data:text/csv;charset=utf-8,", download: file }, label);
  link.addEventListener("click", () => {
    link.href = "data:text/csv;charset=utf-8," + encodeURIComponent(text());
  });
  return link;
}

// A frame that is narrower than its table says so.
for (const event of ["load", "resize"]) {
  addEventListener(event, () => document.querySelectorAll(".frame").forEach((frame) =>
    frame.classList.toggle("wide", frame.scrollWidth > frame.clientWidth + 1)));
}

const csvCell = (text) => (/[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
const csvNumber = (value) => (measured(value) ? String(value) : "");

const fileName = (study.scene || "study").replace(/[^A-Za-z0-9]+/g, "-").replace(/^-|-$/g, "").toLowerCase();
