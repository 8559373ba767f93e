// The colours of the map: which they are, how values are spread along them, and between which ends.

import * as view from "./view.js";
import { button, by, element, labelled, parted, select } from "./element.js";
import { isReversed } from "./form.js";
import { NAMES, ramp } from "./ramps.js";
import { bent } from "./scale.js";

const SCALES = ["linear", "log", "symlog"];
/** Colours of the bar. */
const STEPS = 256;
/** What is below this share of the largest value is no sign of its own. */
const TRACE = 1e-3;

/** The keys of the address on which the colours depend. */
export const KEYS = ["colours", "scale", "limits"];

/** What is asked for: the name of the colours, the scale and the ends of the values; none where they are as usual. */
export function asked() {
  const known = (key, all) => (all.includes(view.text(key)) ? view.text(key) : null), ends = view.numbers("limits", 2);
  return { map: known("colours", NAMES), scale: known("scale", SCALES), ends: ends && ends[0] < ends[1] ? ends : null };
}

/** The same for the figure that the server saves, as far as it takes it. */
export function saved({ settings }) {
  const { map, scale, ends } = asked(), all = { "colour-map": map, scale, limits: ends?.join() };
  return Object.fromEntries(Object.entries(all).filter(([key, value]) => value && settings?.includes(key)));
}

// The ends of the finite values, on a logarithmic scale of those above zero.
function extent(values, isLog) {
  let [low, high] = [Infinity, -Infinity];
  for (const it of values) if (Number.isFinite(it) && (!isLog || it > 0)) { low = Math.min(low, it); high = Math.max(high, it); }
  return [low, high];
}

/** A map with the colours that are asked for; those of the server where none are. */
export function coloured(data) {
  const { map, scale, ends } = asked(), { key, values } = data;
  if (key.kinds || !(map || scale || ends)) return data;
  const spread = scale || key.spread, isLog = spread === "log", whole = extent(values, isLog);
  const [low, high] = ends && !(isLog && ends[0] <= 0) ? ends : spread === key.spread ? key.range : whole;
  if (!(low < high)) return data;
  const width = key.spread === "symlog" ? key.width : 10 ** Math.floor(Math.log10(TRACE * Math.max(Math.abs(low), Math.abs(high))));
  const made = { range: [low, high], spread, width }, to = bent(made);
  const share = (value) => (to(value) - to(low)) / (to(high) - to(low));
  const most = Math.max(...whole.map(Math.abs)), hasBoth = whole[0] < -TRACE * most && whole[1] > TRACE * most;
  const isCentred = hasBoth && !isLog && low <= 0 && high >= 0, centre = isCentred ? share(0) : null;
  const colour = ramp(map || (isCentred ? "blue-red" : "viridis"));
  const bar = Array.from({ length: STEPS }, (_, i) => {
    const at = i / (STEPS - 1);
    return colour(centre === null ? at : 0.5 + 0.5 * (at - centre) / Math.max(centre, 1 - centre));
  });
  const bytes = new Uint8ClampedArray(4 * values.length);
  values.forEach((value, i) => {
    if (!Number.isFinite(value) || (isLog && value <= 0)) return;
    bytes.set([...bar[Math.round(Math.min(Math.max(share(value), 0), 1) * (STEPS - 1))], 255], 4 * i);
  });
  return { ...data, colours: bytes, key: { ...made, colours: bar } };
}

/** Builds the form of the colours, which opens by its tool. */
export function listen() {
  const usual = [["", "as usual"]], names = (all) => [...usual, ...all.map((it) => [it, it])];
  const map = select("colours", names(NAMES), "", (colours) => view.step({ colours: colours || null }));
  const scale = select("scale", names(SCALES), "", (it) => view.step({ scale: it || null }));
  const ends = ["from", "to"].map((name) => element("input", { type: "number", step: "any", name, required: true }));
  const reset = button("As usual", () => view.step(Object.fromEntries(KEYS.map((it) => [it, null]))));
  const form = by("colours-form"), told = element("p", { className: "note", id: "colours-note" });
  form.append(labelled("Colours", map), labelled("Scale", scale), labelled("From", ends[0]), labelled("to", ends[1]), element("button", { textContent: "Set limits" }), reset, told);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    if (!isReversed(...ends, "Limits")) view.step({ limits: ends.map((it) => Number(it.value)).join(",") });
  });
  by("colours-button").addEventListener("click", () => {
    form.hidden = !form.hidden;
    by("colours-button").setAttribute("aria-expanded", String(!form.hidden));
  });
}

/** Fills the form for the map that is shown; the figure that is saved has the settings that the server takes. */
export function fill({ key, told }, { settings }) {
  const form = by("colours-form"), now = asked(), isBar = !key.kinds;
  for (const it of form.querySelectorAll("select, input, button")) it.disabled = !isBar;
  [form.elements.colours.value, form.elements.scale.value] = [now.map ?? "", now.scale ?? ""];
  if (isBar) ["from", "to"].forEach((name, i) => { form.elements[name].value = String(Number(key.range[i].toPrecision(6))); });
  const isSaved = !Object.values(now).some((it) => it) || ["colour-map", "scale", "limits"].every((it) => settings?.includes(it));
  const unit = parted(told)[1], where = isBar && unit ? `Limits in ${unit}. ` : "";
  by("colours-note").textContent = isBar ? `${where}${isSaved ? "" : "The command under Data draws the figure with them; PDF and SVG here are as usual."}` : "Kinds have colours of their own.";
  by("colours-button").classList.toggle("changed", isBar && Object.values(now).some((it) => it));
}
