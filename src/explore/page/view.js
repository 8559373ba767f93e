// What is shown, held in the address of the page, so that a link shows the same.

const held = new URLSearchParams(location.hash.slice(1));
const listeners = [];

/** The text of a key; none where it is not set. */
export const text = (key) => held.get(key);

/** The number of a key; none where it is not set. */
export const number = (key) => (held.has(key) ? Number(held.get(key)) : null);

/** Sets keys, or removes those whose value is none, and tells the listeners. */
export function set(pairs) {
  for (const [key, value] of Object.entries(pairs)) {
    if (value === null || value === undefined) held.delete(key);
    else held.set(key, String(value));
  }
  history.replaceState(null, "", `#${held}`);
  listeners.forEach((listener) => listener(Object.keys(pairs)));
}

/** Calls `listener` with the keys that have changed. */
export const changed = (listener) => listeners.push(listener);
