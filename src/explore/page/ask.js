// Asks the server: objects, maps, trade-offs and streams of lines.

import * as view from "./view.js";

/** What is told where nobody answers. */
const GONE = "capsulemap explore no longer answers; start it again";
/** The status of what is not shown because another program has changed the file. */
const CHANGED = 409;

// A browser tells of a connection that is refused or cut by a TypeError.
const gone = (it) => { throw it instanceof TypeError ? new Error(GONE) : it; };

async function answered(address, signal) {
  const answer = await fetch(address, { signal, credentials: "same-origin" }).catch(gone);
  if (answer.ok) return answer;
  const told = await answer.json().catch(() => ({ error: `the server answered ${answer.status}` }));
  if (answer.status === CHANGED) dispatchEvent(new CustomEvent("results-changed", { detail: told.error }));
  throw new Error(told.error);
}

// Each is asked in the units of the page.
const address = (path, pairs) => `${path}?${new URLSearchParams({ ...pairs, ...(view.text("units") ? { units: view.text("units") } : {}) })}`;

/** An object. */
export async function object(path, pairs = {}, signal) {
  return (await answered(address(path, pairs), signal)).json().catch(gone);
}

// An object, and what follows it in the same answer.
async function packed(path, pairs, signal) {
  const bytes = await (await answered(address(path, pairs), signal)).arrayBuffer().catch(gone);
  const length = new DataView(bytes).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  return { head, bytes, begins: 4 + length };
}

/** A map: its description, red, green, blue and opacity of each cell, and its values, from the least ordinate up. */
export async function map(pairs, signal) {
  const { head, bytes, begins } = await packed("/api/map", pairs, signal);
  const cells = head.x.values.length * head.y.values.length;
  const colours = new Uint8ClampedArray(bytes, begins, 4 * cells);
  return { ...head, colours, values: new Float32Array(bytes, begins + 4 * cells, cells) };
}

/** A trade-off: its description, and price and speed of each cell of the map. */
export async function tradeOff(pairs, signal) {
  const { head, bytes, begins } = await packed("/api/trade-off", pairs, signal);
  const prices = new Float32Array(bytes, begins, head.count);
  return { ...head, prices, speeds: new Float32Array(bytes, begins + 4 * head.count, head.count) };
}

/** Objects that come line by line; each is given to `take` as it comes. The last may say why they end early. */
export async function lines(path, pairs, take, signal) {
  const reader = (await answered(address(path, pairs), signal)).body.getReader();
  const decoder = new TextDecoder();
  let rest = "";
  for (;;) {
    const { done, value } = await reader.read().catch(gone);
    const parts = (rest + (done ? "" : decoder.decode(value, { stream: true }))).split("\n");
    rest = done ? "" : parts.pop();
    for (const it of parts.filter((line) => line).map((line) => JSON.parse(line))) {
      if (it.error) throw new Error(it.error);
      take(it);
    }
    if (done) return;
  }
}

/** A figure as a file. */
export async function figure(pairs) {
  return (await answered(address("/api/figure", pairs))).blob();
}
