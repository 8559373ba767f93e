// Elements of the page, and the words that stand in them.

import { short } from "./ticks.js";

/** The element with this id. */
export const by = (id) => document.getElementById(id);

/** A sentence of a clause. */
export const sentence = (words) => `${words[0].toUpperCase()}${words.slice(1)}${/[.!?]$/.test(words) ? "" : "."}`;

/** A new element with these properties and children. */
export function element(name, content = {}, ...children) {
  const made = Object.assign(document.createElement(name), content);
  made.append(...children);
  return made;
}

/** A button that calls `act`. */
export function button(text, act, more = {}) {
  const made = element("button", { type: "button", textContent: text, ...more });
  made.addEventListener("click", act);
  return made;
}

/** A checkbox, a field or a list with its words. */
export const labelled = (words, field) => element("label", {}, element("span", {}, ...marked(words)), " ", field);

/** A list of choices: keys with their words. */
export function select(name, options, value, changed) {
  const made = element("select", { name }, ...options.map(([key, text]) => element("option", { value: key, textContent: text })));
  made.value = value;
  made.addEventListener("change", () => changed(made.value));
  return made;
}

/** The parts of a label: its words, and whether each is an index, as that of k2, unlike the words "as" and "is". Units have none. */
export function runs(label) {
  const end = label.lastIndexOf(" (");
  const [words, unit] = end < 0 ? [label, ""] : [label.slice(0, end), label.slice(end)];
  const parts = words.split(/(?<![\p{L}\d])(?![ai]s)([a-zA-Zμ])([ds12])(?![\p{L}\d])/u);
  const all = parts.map((text, i) => [text, i % 3 === 2]);
  return [...all, [squared(unit), false]].filter(([text]) => text);
}

/** A label as nodes, with its indices. */
export const marked = (label) => runs(label).map(([text, isIndex]) => (isIndex ? element("sub", { textContent: text }) : text));

/** The name and the unit of a label such as "Frequency ω (rad/s)". */
export function parted(label) {
  const found = /^(.*) \(([^()]*)\)$/.exec(label);
  return found ? [found[1], squared(found[2])] : [label, ""];
}

// A unit with its squares, "m/s2", as it is written.
const squared = (unit) => unit.replace(/(?<=\p{L})2/gu, "²");

/** "Frequency ω = 62 rad/s", for a value in the unit of the label, or for the text of one. */
export function said(label, value) {
  const [name, unit] = parted(label), text = typeof value === "number" ? short(value) : value;
  const sign = text.startsWith("≈") ? "" : "= ";
  return `${name} ${sign}${text}${unit && /\d|∞/.test(text) ? ` ${unit}` : ""}`;
}

const isNumber = (cell) => typeof cell === "number" || /^[−-]?[\d≈∞]/.test(cell);

// A row; `numeric` says which columns have numbers, which stand to the right.
function row(cells, numeric, isHead) {
  const cell = (it, i) => {
    if (it instanceof Node) return element(i ? "td" : "th", i ? {} : { scope: "row" }, it);
    const made = element(isHead || i === 0 ? "th" : "td", { className: numeric[i] ? "number" : "" }, ...marked(String(it)));
    if (made.localName === "th") made.scope = isHead ? "col" : "row";
    return made;
  };
  return element("tr", {}, ...cells.map(cell));
}

/** A table with a head; the first cell of each row names it. */
export function table(name, head, rows) {
  const numeric = head.map((_, i) => i > 0 && rows.some((cells) => isNumber(cells[i])));
  const body = element("tbody", {}, ...rows.map((cells) => row(cells, numeric, false)));
  return element("table", {}, element("caption", { className: "unseen", textContent: name }), element("thead", {}, row(head, numeric, true)), body);
}

/** A table that opens on demand and scrolls. */
export function folded(heading, head, rows, isOpen = false) {
  const made = element("details", {}, element("summary", { textContent: heading }));
  // A long table is built where it is looked at.
  const build = () => {
    if (!made.open || made.childElementCount > 1) return;
    made.append(element("div", { className: "scroll", tabIndex: 0, role: "group", ariaLabel: heading }, table(heading, head, rows())));
  };
  made.addEventListener("toggle", build);
  made.open = isOpen;
  build();
  return made;
}

let saying = 0;
/** Tells those who hear the page, at most every half second: the last words count. */
export function say(words) {
  clearTimeout(saying);
  saying = setTimeout(() => { by("said").textContent = words; }, 500);
}

/** Shows what went wrong; a request that was given up is no fault. */
export function fault(it) {
  if (it.name === "AbortError") return;
  by("fault-told").textContent = it.message;
  by("fault").hidden = false;
}
