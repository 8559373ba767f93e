// Values beside the pointer.

import { by, element, marked, parted } from "./element.js";

/** Distance from the pointer [CSS pixels]. */
const AWAY = 14;

/** Hides the values. */
export function hide() { by("tip").hidden = true; }

/** Shows values beside the pointer of an event: a first line, a colour before it, and pairs of a name and its text. */
export function show({ clientX: x, clientY: y, pointerType }, { head, colour, rows }) {
  // A finger hides what lies beside it.
  if (pointerType === "touch") return hide();
  const tip = by("tip"), first = element("strong", {}, ...(colour ? [swatch(colour)] : []), ...marked(head));
  const pairs = rows.flatMap(([name, text]) => [element("span", { className: "name" }, ...marked(name)), element("span", { className: "value" }, text)]);
  tip.replaceChildren(first, element("div", { className: "pairs" }, ...pairs));
  tip.hidden = false;
  const { width, height } = tip.getBoundingClientRect(), { innerWidth: wide, innerHeight: high } = window;
  const left = x + AWAY + width > wide - 4 ? x - AWAY - width : x + AWAY;
  const top = y + AWAY + height > high - 4 ? y - AWAY - height : y + AWAY;
  tip.style.transform = `translate(${Math.max(4, left)}px, ${Math.max(4, top)}px)`;
}

function swatch(colour) {
  const made = element("span", { className: "swatch" });
  made.style.background = colour;
  return made;
}

/** A row of the values: the name of a label, and a number's text with its unit. */
export function pair(label, text) {
  const [name, unit] = parted(label);
  return [name, `${text}${unit && /\d|∞/.test(text) ? ` ${unit}` : ""}`];
}
