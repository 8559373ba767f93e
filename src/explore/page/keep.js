// What is handed over: the commands and studies of the views, and figures as files.

import * as ask from "./ask.js";
import { button, by, element, fault, say } from "./element.js";

const entries = new Map();
/** The order in which the views are listed. */
const ORDER = ["map", "trade-off", "motion", "pin-a", "pin-b", "line", "basin", "indices"];

/** A text as an argument of a shell. */
export const quoted = (text) => (/^[\w.,=:/+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

/** Lists the command or the study (`isStudy`) of a view; nothing without a text. */
export function handOver(id, title, text, isStudy = false) {
  const known = entries.get(id);
  if (known?.dataset.text === text && known?.dataset.title === title) return;
  entries.delete(id);
  if (text) entries.set(id, entry(id, title, text, isStudy));
  by("commands").replaceChildren(...ORDER.filter((it) => entries.has(it)).map((it) => entries.get(it)));
}

/** A button that copies what `text` gives. */
export function copyButton(words, title, text) {
  const copy = button(words, async () => {
    try {
      await navigator.clipboard.writeText(text());
      say(`${title}: copied`);
      copy.textContent = "Copied";
      setTimeout(() => { copy.textContent = words; }, 2000);
    } catch (it) { fault(it); }
  }, { ariaLabel: `${words}: ${title}` });
  return copy;
}

function entry(id, title, text, isStudy) {
  const buttons = element("div", { className: "buttons" }, copyButton("Copy", title, () => text));
  if (isStudy) buttons.append(button("Save as TOML", () => given(new Blob([text], { type: "application/toml" }), `${id}.toml`), { ariaLabel: `Save as TOML: ${title}` }));
  const place = element("pre", { tabIndex: 0, role: "group", ariaLabel: title, textContent: text });
  const made = element("div", { className: "hand-over" }, element("h3", { textContent: title }), place, buttons);
  Object.assign(made.dataset, { text, title });
  return made;
}

// Gives bytes to the browser as a file to be kept.
function given(blob, name) {
  const link = element("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** Saves a figure; the button tells that it is being drawn. */
export async function save(pairs, format, pressed) {
  if (pressed.getAttribute("aria-disabled") === "true") return;
  // A tool has its words beside its icon.
  const place = pressed.querySelector(".words") ?? pressed, words = place.textContent;
  pressed.setAttribute("aria-disabled", "true");
  place.textContent = place === pressed ? "Being drawn …" : "…";
  say("The figure is being drawn");
  try {
    given(await ask.figure({ ...pairs, format }), `${pairs.kind}.${format}`);
    say("The figure is saved");
  } catch (it) { fault(it); }
  place.textContent = words;
  pressed.removeAttribute("aria-disabled");
}

/** Buttons that save what `pairs` gives as PDF and as SVG. */
export function saveButtons(id, words, pairs) {
  const one = (format) => {
    const name = format.toUpperCase(), made = button(name, () => save(pairs(), format, made), { id: `${id}-${format}-button`, ariaLabel: `Save ${words} as ${name}` });
    return made;
  };
  return element("span", { className: "saving" }, `Save ${words} as`, one("pdf"), one("svg"));
}
