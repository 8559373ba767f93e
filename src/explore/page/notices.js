// What the address asks for and the page cannot show, in sentences at its head.

import * as view from "./view.js";
import { by } from "./element.js";
import { chosen, ends, page } from "./shown.js";

// What of the address cannot be read.
function unread() {
  const told = [], has = (key) => view.text(key) !== null;
  if (has("at") && !chosen()) told.push("The case in the address (at) cannot be read: no motion is chosen.");
  if (has("line") && !ends()) {
    const isLine = view.text("line").split("~").map(view.coordinates).filter((it) => it).length === 2;
    told.push(isLine ? "The line in the address lies over other axes and is not shown." : "The line in the address (line) cannot be read and is not shown.");
  }
  return told;
}

/** Tells what the address asks for and the file does not have. */
export function notice() {
  const told = [...page.choices.unknown(), ...unread()];
  // The same words are not told twice.
  if (by("notice").textContent !== told.join(" ")) by("notice").textContent = told.join(" ");
  by("notice").hidden = !told.length;
}
