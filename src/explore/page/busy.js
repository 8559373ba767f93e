// What is computed: where and how long, at the head of the page and at the tab of its view.

import { by, element } from "./element.js";

/** How often the time is told anew [ms]. */
const EVERY = 250;
/** What takes less is not told before it is done [ms]. */
const SOON = 150;
const running = new Map();
let clock = 0, last = null;

/** A time in words. */
export const time = (milliseconds) => (milliseconds < 995 ? `${Math.round(milliseconds)} ms` : `${(milliseconds / 1e3).toFixed(1)} s`);

function put() {
  const now = performance.now(), late = [...running.values()].filter((it) => now - it.began > SOON);
  const words = late.map((it) => ({ text: `${it.words}${it.told ? ` ${it.told}` : ""}, ${time(now - it.began)}`, isRunning: true }));
  if (!words.length && last) words.push({ text: last, isRunning: false });
  by("busy").replaceChildren(...words.map(({ text, isRunning }) => element("li", { className: isRunning ? "running" : "", textContent: text })));
  for (const tab of by("tabs").children) {
    const of = late.find((it) => tab.id === `${it.view}-tab`);
    tab.classList.toggle("running", !!of);
    tab.style.setProperty("--share", of?.share ?? 0);
  }
}

/** Tells of a computation for a `view` from now on; returns how to `tell` of its progress and that it has `end`ed. */
export function begin(view, words) {
  const it = { view, words, began: performance.now(), told: "", share: 0 };
  running.set(view, it);
  clock ||= setInterval(put, EVERY);
  return {
    tell: (told, share = 0) => Object.assign(it, { told, share }),
    end: (isDone = true) => {
      if (running.get(view) !== it) return;
      running.delete(view);
      if (isDone) last = `${words}: ${time(performance.now() - it.began)}`;
      if (!running.size) { clearInterval(clock); clock = 0; }
      // Not before what was computed is painted.
      requestAnimationFrame(() => setTimeout(put));
    },
  };
}
