// Numbers, dates and elements of the page.

/** Returns an element. Texts become text, never HTML. */
function element(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children.filter((child) => child !== null && child !== ""));
  return node;
}

function byId(id) {
  return document.getElementById(id);
}

const minus = "−";

/** Returns a number with a few digits, and a dash for none: 1,920, 0.001659, 7.58e−5. */
function numberText(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  const size = Math.abs(value);
  let text;
  if (Number.isInteger(value) && size < 1e7) {
    text = size >= 10000 ? value.toLocaleString("en-GB") : String(value);
  } else if (size >= 1e-3 && size < 1e5) {
    text = String(Number(value.toPrecision(digits)));
  } else {
    text = String(Number(value.toPrecision(digits)).toExponential()).replace("e+", "e");
  }
  return text.replaceAll("-", minus);
}

/** Returns a number with its unit, for the inside of an element. */
function quantity(value, unit, digits = 4) {
  const nodes = [numberText(value, digits)];
  if (unit) nodes.push(element("span", { class: "unit" }, "\u00a0" + unit));
  return nodes;
}

/** Returns a share in percent: 100 % and 0 % only where nothing is hidden by rounding. */
function percentText(value) {
  if (value === null) return "–";
  return Math.abs(value) >= 99.99 && value !== 100 ? numberText(value, 7) : numberText(value, 3);
}

/** Returns a duration in seconds as people say it: 0.98 s, 3 min 5 s, 2 h 10 min. */
function durationText(seconds) {
  if (seconds < 60) return numberText(seconds, 3) + "\u00a0s";
  const whole = Math.round(seconds);
  const minutes = Math.floor(whole / 60);
  if (minutes < 60) return `${minutes}\u00a0min ${whole % 60}\u00a0s`;
  return `${Math.floor(minutes / 60)}\u00a0h ${minutes % 60}\u00a0min`;
}

/** Returns an ISO date as "28 November 2026, 01:10 UTC". */
function dateText(iso) {
  const date = new Date(iso);
  if (Number.isNaN(date.getTime())) return iso;
  const day = date.toLocaleDateString("en-GB",
    { day: "numeric", month: "long", year: "numeric", timeZone: "UTC" });
  const time = date.toLocaleTimeString("en-GB",
    { hour: "2-digit", minute: "2-digit", timeZone: "UTC" });
  return `${day}, ${time} UTC`;
}

/** Returns a count with its noun. */
function counted(count, noun) {
  return `${numberText(count)} ${noun}${count === 1 ? "" : "s"}`;
}
