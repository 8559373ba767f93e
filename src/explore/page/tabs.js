// The views of the pane behind tabs, of which one is in front.

import * as view from "./view.js";
import { by } from "./element.js";

/** The view in front where the address names none. */
let first = "motion";
const NAMES = ["motion", "line", "basin", "trade-off", "branches", "data"];
const asked = new Map();

const tab = (name) => by(`${name}-tab`);
const there = () => NAMES.filter((name) => !tab(name).hidden);

/** The view that is in front. */
export function front() {
  const name = view.text("pane");
  return there().includes(name) ? name : first;
}

/** What of the address brings a view to the front. */
export const pane = (name) => ({ pane: name });

/** Puts another view in front where the address names none. */
export const begin = (name) => { first = name; turn(); };

/** Shows the view that the address names. */
export function turn() {
  const now = front();
  for (const name of NAMES) {
    const isFront = name === now;
    tab(name).setAttribute("aria-selected", String(isFront));
    tab(name).tabIndex = isFront ? 0 : -1;
    if (by(`${name}-section`).closest("#pane")) by(`${name}-section`).hidden = !isFront;
  }
}

/** Calls `act` where a person turns to a view. */
export const turned = (name, act) => asked.set(name, act);

/** Takes a view away that a file does not have. */
export function remove(name) {
  tab(name).hidden = true;
  turn();
}

function choose(name) {
  view.set(pane(name));
  asked.get(name)?.();
}

// Arrows go around the tabs, as the pattern of tabs asks for.
function key(event) {
  const all = there(), at = all.indexOf(front());
  const to = { ArrowLeft: at - 1, ArrowRight: at + 1, Home: 0, End: all.length - 1 }[event.key];
  if (to === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  const name = all[(to + all.length) % all.length];
  choose(name);
  tab(name).focus();
}

/** Listens to the tabs. */
export function listen() {
  for (const name of NAMES) tab(name).addEventListener("click", () => choose(name));
  by("tabs").addEventListener("keydown", key);
  turn();
}
