// Sobol indices of a file whose cases are a design for them: which of the quantities that are drawn an output depends on.

import * as ask from "./ask.js";
import { button, element, labelled, marked, parted, select, table } from "./element.js";
import { handOver, quoted } from "./keep.js";
import { short } from "./ticks.js";

const KINDS = [["first", "first order, by itself"], ["total", "total order, with others"]];

// An index with its interval: a bar as long as its share, and the numbers.
function index([value, half]) {
  const bar = element("span", { className: "bar" }), part = Math.min(Math.max(value, 0), 1);
  bar.style.setProperty("--part", part);
  return element("span", { className: "index" }, bar, element("span", {}, `${short(value, 3)} ± ${short(half, 2)}`));
}

/** The indices in their place, with a choice of the output. */
export class Indices {
  constructor(place, file) {
    this.file = file;
    this.place = element("section", { id: "indices", ariaLabel: "Sobol indices" });
    // They take a second of a large design, and are found when they are asked for.
    this.ask = button("Sobol indices of these cases", () => this.show());
    this.place.append(element("p", { className: "buttons" }, this.ask));
    place.append(this.place);
    handOver("indices", "Sobol indices", `capsulemap sensitivity ${quoted(file.file)}`);
  }

  async show() {
    this.ask.disabled = true;
    this.data = await ask.object("/api/sensitivity").catch((it) => ({ failure: it.message }));
    this.draw(this.data.outputs?.[0]?.name);
  }

  draw(name) {
    const { quantities, outputs, failure, confidence, base_samples: samples } = this.data;
    if (failure) { this.place.replaceChildren(element("p", { className: "note failure", textContent: `Sobol indices: ${failure}` })); return; }
    const it = outputs.find((one) => one.name === name), names = outputs.map((one) => [one.name, parted(one.label)[0]]);
    const field = labelled("Sobol indices of", select("indices-of", names, name, (to) => { this.draw(to); this.place.querySelector("select").focus(); }));
    const made = [element("div", { className: "buttons" }, field)];
    if (it.why) made.push(element("p", { className: "note", textContent: `There are no indices: ${it.why}.` }));
    else {
      const rows = quantities.map((one, i) => [element("span", {}, ...marked(parted(one.label)[0])), ...KINDS.map(([kind]) => index(it[kind][i]))]);
      made.push(table("Sobol indices", ["quantity", ...KINDS.map(([, words]) => words)], rows));
    }
    const left = it.left_out ? `; ${it.left_out} are left out, as a case of them failed, is undecided or has no value` : "";
    made.push(element("p", { className: "note", textContent: `Of ${it.rows} of ${samples} base samples${left}. Intervals at ${short(100 * confidence)} %. An index is the share of the variance that a quantity makes.` }));
    this.place.replaceChildren(...made);
  }
}
