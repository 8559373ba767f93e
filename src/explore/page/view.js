// What is shown, held in the address of the page, so that a link shows the same.

const read = () => new URLSearchParams(location.hash.slice(1));
let held = read();
const listeners = [];
// A state of none is that of an address written by hand.
if (!history.state) history.replaceState({ steps: 0 }, "");
/** How many steps lie behind what is shown, and how many there are with those that were undone. */
const steps = { now: history.state.steps, all: history.state.steps };
/** Steps of one kind that follow each other so soon are one [ms]. */
const SOON = 1000;

/** The text of a key; none where it is not set. */
export const text = (key) => held.get(key);

/** The number of a key; none where it is not set or no number. */
export const number = (key) => (held.has(key) && Number.isFinite(Number(held.get(key))) ? Number(held.get(key)) : null);

/** The numbers of a key where there are `count`; else none. */
export function numbers(key, count) {
  const all = held.get(key)?.split(",").map(Number);
  return all?.length === count && all.every(Number.isFinite) ? all : null;
}

// Writes keys into the address; returns those that have changed.
function put(pairs, write) {
  const before = new URLSearchParams(held);
  for (const [key, value] of Object.entries(pairs)) {
    if (value === null || value === undefined) held.delete(key);
    else held.set(key, String(value));
  }
  const keys = Object.keys(pairs).filter((key) => before.get(key) !== held.get(key));
  if (!keys.length) return keys;
  if (write === "pushState") steps.all = ++steps.now;
  // Commas and colons stay readable.
  const text = String(held).replace(/%2C/g, ",").replace(/%3A/g, ":").replace(/%7E/g, "~").replace(/%3B/g, ";");
  history[write]({ steps: steps.now }, "", `#${text}`);
  return keys;
}

function tell(keys) { if (keys.length) listeners.forEach((listener) => listener(keys)); }

/** Sets keys, or removes those whose value is none, and tells the listeners which have changed. */
export const set = (pairs) => tell(put(pairs, "replaceState"));

/** The same as a step that the Back of the browser undoes. */
export const step = (pairs) => tell(put(pairs, "pushState"));

let settled = { keys: "", at: -Infinity };
/** The same for what changes many times in a row, as while a map is moved: those are one step. */
export function settle(pairs) {
  const keys = Object.keys(pairs).join(), isSame = settled.keys === keys && performance.now() - settled.at < SOON;
  settled = { keys, at: performance.now() };
  (isSame ? set : step)(pairs);
}

/** Undoes a step, or does it again (1), as far as there is one. */
export function go(by) {
  const to = steps.now + by;
  if (to < 0 || to > steps.all) return;
  settled.at = -Infinity;
  history.go(by);
}

/** Whether there are steps to undo and to do again. */
export const undoable = () => [steps.now > 0, steps.now < steps.all];

/** Sets keys to what is shown already, and tells nobody. */
export const restore = (pairs) => { put(pairs, "replaceState"); };

/** Calls `listener` with the keys that have changed. */
export const changed = (listener) => listeners.push(listener);

// Another address of the same page was opened, or written by hand.
window.addEventListener("hashchange", () => {
  const before = held;
  held = read();
  // An address that was written by hand is a step.
  if (!history.state) { steps.all = ++steps.now; history.replaceState({ steps: steps.now }, ""); }
  steps.now = history.state.steps;
  steps.all = Math.max(steps.all, steps.now);
  const keys = [...new Set([...before.keys(), ...held.keys()])].filter((key) => before.get(key) !== held.get(key));
  tell(keys);
});

/** What else is said of a case, in words: the `sweep` whose motion it starts from, and whether its start is `from` the line. */
const WORDS = ["sweep", "from"];

/** The case as the server is asked for it. */
export const asked = ({ from, ...coordinates }) => coordinates;

/** The case at other values of parameters: its start is then no motion of the line. */
export const moved = (coordinates, values) => ({ ...asked(coordinates), ...values });

/** A case by the names of its coordinates as text, "omega:62.5,p_d:3", with the words that are said of it. */
export const written = (coordinates) => Object.entries(coordinates).map(([name, value]) => `${name}:${value}`).join(",");

/** The case of a text; none where it is no such text. */
export function coordinates(text) {
  const pairs = (text || "").split(",").map((pair) => pair.split(":"));
  const isWord = (name) => WORDS.includes(name);
  const read = ([name, value]) => [name, isWord(name) ? value : Number(value)];
  const isFit = ([name, value]) => /^\w+$/.test(name) && value && (isWord(name) ? /^\w+$/.test(value) : Number.isFinite(Number(value)));
  return pairs.every(isFit) ? Object.fromEntries(pairs.map(read)) : null;
}
