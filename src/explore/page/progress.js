// The progress of a run whose results are shown while they come.

import * as ask from "./ask.js";
import { by, say } from "./element.js";

const EVERY = 2000;
/** Parts of the run that are told to those who hear the page. */
const TOLD = 10;

/** A time in words. */
export function duration(seconds) {
  if (seconds < 90) return `${Math.ceil(seconds)} s`;
  const minutes = Math.round(seconds / 60);
  return minutes < 90 ? `${minutes} min` : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

function show({ done, cases, seconds_left: left }) {
  by("progress").hidden = false;
  Object.assign(by("progress-bar"), { max: cases, value: done });
  const time = left === null ? "" : `, about ${duration(left)} left`;
  by("progress-told").textContent = `Run under way: ${done.toLocaleString("en")} of ${cases.toLocaleString("en")} cases${time}`;
}

/** Shows the progress of a run until it is complete; `again` is called where there are new results. */
export async function watch(running, again) {
  let { version } = running, told = 0;
  for (let now = running; now;) {
    show(now);
    const part = Math.floor(TOLD * now.done / now.cases);
    if (part > told) { told = part; say(by("progress-told").textContent); }
    await new Promise((done) => setTimeout(done, EVERY));
    try {
      now = await ask.object("/api/progress");
    } catch (it) {
      by("progress-told").textContent = `The progress is not known: ${it.message}`;
      continue;
    }
    if (!now || now.version !== version) {
      version = now?.version;
      await again().catch((it) => { by("progress-told").textContent = `The new results could not be read: ${it.message}`; });
    }
  }
  by("progress").hidden = true;
  say("The run is complete");
}
