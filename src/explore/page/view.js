// What is shown, held in the address of the page, so that a link shows the same.

const read = () => new URLSearchParams(location.hash.slice(1));
let held = read();
const listeners = [];

/** The text of a key; none where it is not set. */
export const text = (key) => held.get(key);

/** The number of a key; none where it is not set or no number. */
export const number = (key) => (held.has(key) && Number.isFinite(Number(held.get(key))) ? Number(held.get(key)) : null);

/** The numbers of a key where there are `count`; else none. */
export function numbers(key, count) {
  const all = held.get(key)?.split(",").map(Number);
  return all?.length === count && all.every(Number.isFinite) ? all : null;
}

/** Sets keys, or removes those whose value is none, and tells the listeners which have changed. */
export function set(pairs) {
  const before = new URLSearchParams(held);
  for (const [key, value] of Object.entries(pairs)) {
    if (value === null || value === undefined) held.delete(key);
    else held.set(key, String(value));
  }
  const keys = Object.keys(pairs).filter((key) => before.get(key) !== held.get(key));
  if (!keys.length) return;
  // Commas and colons stay readable.
  const text = String(held).replace(/%2C/g, ",").replace(/%3A/g, ":").replace(/%7E/g, "~").replace(/%3B/g, ";");
  history.replaceState(null, "", `#${text}`);
  listeners.forEach((listener) => listener(keys));
}

/** Calls `listener` with the keys that have changed. */
export const changed = (listener) => listeners.push(listener);

// Another address of the same page was opened, or written by hand.
window.addEventListener("hashchange", () => {
  const before = held;
  held = read();
  const keys = [...new Set([...before.keys(), ...held.keys()])].filter((key) => before.get(key) !== held.get(key));
  if (keys.length) listeners.forEach((listener) => listener(keys));
});

/** A case by the names of its coordinates as text, "omega:62.5,p_d:3", with the `sweep` whose motion it starts from, if there are several. */
export const written = (coordinates) => Object.entries(coordinates).map(([name, value]) => `${name}:${value}`).join(",");

/** The case of a text; none where it is no such text. */
export function coordinates(text) {
  const pairs = (text || "").split(",").map((pair) => pair.split(":"));
  const read = ([name, value]) => [name, name === "sweep" ? value : Number(value)];
  const isFit = ([name, value]) => /^\w+$/.test(name) && value && (name === "sweep" ? /^\w+$/.test(value) : Number.isFinite(Number(value)));
  return pairs.every(isFit) ? Object.fromEntries(pairs.map(read)) : null;
}
