// Asks the server: objects, maps and streams of lines.

async function answered(address, signal) {
  const answer = await fetch(address, { signal, credentials: "same-origin" });
  if (answer.ok) return answer;
  const told = await answer.json().catch(() => ({ error: `the server answered ${answer.status}` }));
  throw new Error(told.error);
}

const address = (path, pairs) => `${path}?${new URLSearchParams(pairs)}`;

/** An object. */
export async function object(path, pairs = {}, signal) {
  return (await answered(address(path, pairs), signal)).json();
}

/** A map: its description, red, green, blue and opacity of each cell, and its values, from the least ordinate up. */
export async function map(pairs, signal) {
  const bytes = await (await answered(address("/api/map", pairs), signal)).arrayBuffer();
  const length = new DataView(bytes).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  const cells = head.x.values.length * head.y.values.length;
  const colours = new Uint8ClampedArray(bytes, 4 + length, 4 * cells);
  return { ...head, colours, values: new Float32Array(bytes, 4 + length + 4 * cells, cells) };
}

/** Objects that come line by line; each is given to `take` as it comes. */
export async function lines(path, pairs, take, signal) {
  const reader = (await answered(address(path, pairs), signal)).body.getReader();
  const decoder = new TextDecoder();
  let rest = "";
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return;
    const parts = (rest + decoder.decode(value, { stream: true })).split("\n");
    rest = parts.pop();
    parts.forEach((line) => take(JSON.parse(line)));
  }
}

/** The address of a figure. */
export const figure = (pairs, format) => address("/api/figure", { ...pairs, format });
