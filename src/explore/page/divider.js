// The divider between the map and the pane, which is moved by pointer and keys.

import { by } from "./element.js";

const KEY = "capsulemap-divider";
const [LEAST, MOST] = [25, 70];

function put(share) {
  const part = Math.round(Math.min(Math.max(share, LEAST), MOST));
  document.documentElement.style.setProperty("--part", `${part}%`);
  by("divider").setAttribute("aria-valuenow", String(part));
  // A browser may keep nothing.
  try { localStorage.setItem(KEY, part); } catch { /* It is as it was on the next day. */ }
}

const now = () => Number(by("divider").getAttribute("aria-valuenow"));

function key(event) {
  const to = { ArrowLeft: now() - 2, ArrowRight: now() + 2, Home: LEAST, End: MOST }[event.key];
  if (to === undefined) return;
  event.preventDefault();
  put(to);
}

/** Listens to the divider, and puts it where it was last. */
export function listen() {
  const divider = by("divider");
  let kept = null;
  try { kept = localStorage.getItem(KEY); } catch { /* As above. */ }
  if (kept) put(Number(kept));
  divider.addEventListener("keydown", key);
  divider.addEventListener("dblclick", () => put(46));
  divider.addEventListener("pointerdown", (event) => { divider.setPointerCapture(event.pointerId); event.preventDefault(); });
  divider.addEventListener("pointermove", (event) => {
    if (divider.hasPointerCapture(event.pointerId)) put(100 * event.clientX / document.documentElement.clientWidth);
  });
}
