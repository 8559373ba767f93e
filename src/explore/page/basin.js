// The basins at some parameters: which attractor each start leads to, painted coarse and then finer.

import * as ask from "./ask.js";
import * as busy from "./busy.js";
import * as tip from "./tip.js";
import { button, element, labelled, marked, parted, say, said, table } from "./element.js";
import { isReversed } from "./form.js";
import { handOver, saveButtons } from "./keep.js";
import { cross, cursor, entry, rimmed, sectionPoint } from "./marks.js";
import { model, shown } from "./model.js";
import { Plane } from "./plane.js";
import { short } from "./ticks.js";

const UNDECIDED = [136, 136, 136];
// The coordinates of the starts of the plane, and what the ends of their ranges are called in requests.
const plane = () => model.starts.slice(0, 2);
const ends = () => plane().flatMap(({ name }) => [`${name}_from`, `${name}_to`]);

/** The basins on a canvas, as a plane; `stop` is where the first coordinate meets the surface of impacts, and `points` are section points with their colours, in SI. */
class BasinPlane extends Plane {
  over(drawn, to) {
    if (!this.hasStop()) return;
    const at = this.share(this.data.x, this.stop * this.data.x.factor);
    drawn.setLineDash([6, 4]);
    rimmed(drawn, () => { drawn.moveTo(...to([at, 0])); drawn.lineTo(...to([at, 1])); }, "#000000", 1.5);
    drawn.setLineDash([]);
  }

  hasStop() {
    const [low, high] = this.data.x.range, stop = this.stop * this.data.x.factor;
    return stop >= low && stop <= high;
  }

  above(drawn, put) {
    for (const { at, colour } of this.points || []) put(this.shares(at), (_, place) => sectionPoint(drawn, place, `rgb(${colour})`));
    if (this.chosen) put(this.chosen, cross);
    if (this.mark && !this.mark.every((it, i) => it === this.chosen?.[i])) put(this.mark, cursor);
  }
}

/** Basins in their place. `on` is told of a `choose`n start and of the `range` of starts that is wanted. */
export class Basin {
  constructor(place, on) {
    Object.assign(this, { on, running: null, asked: null, told: element("p", { id: "basin-told" }), heading: element("p", { id: "basin-at" }) });
    this.canvas = element("canvas", { id: "basin", tabIndex: 0, role: "application", ariaLabel: "Basins" });
    this.canvas.setAttribute("aria-roledescription", "map");
    this.canvas.setAttribute("aria-describedby", "basin-help basin-hover");
    this.hovered = element("p", { id: "basin-hover", className: "told", textContent: "\u00a0" });
    this.attractors = element("div", { id: "basin-attractors" });
    this.legend = element("ul", { className: "legend", ariaLabel: "Marks of the basin" });
    this.bar = element("progress", { max: 1, value: 0, ariaLabel: "Starts computed" });
    const help = element("p", { id: "basin-help", className: "note" });
    help.textContent = "Click a start for its motion. Keys: arrows move the mark, Enter computes there, + and − zoom, 0 shows all.";
    const choose = (point) => on.choose({ ...this.parameters, [this.data.x.name]: point[0], [this.data.y.name]: point[1] });
    this.plane = new BasinPlane(this.canvas, { choose, hover: (at, isKey, event) => this.hover(at, isKey, event) });
    this.saving = element("div", { className: "buttons" }, saveButtons("basin", "basin", () => ({ kind: "basin", ...this.request })));
    place.append(this.heading, this.told, this.bar, this.canvas, this.hovered, this.legend, this.attractors, help, this.ranges(), this.saving);
  }

  // The range of starts by numbers.
  ranges() {
    const words = plane().flatMap(({ label }) => [`${label} from`, "to"]), names = plane().flatMap(({ label }) => ["from", "to"].map((end) => `${parted(label)[0]} ${end}`));
    this.inputs = ends().map((name, i) => element("input", { name, type: "number", step: "any", required: true, ariaLabel: names[i] }));
    const form = element("form", { className: "row" }, ...this.inputs.map((it, i) => labelled(words[i], it)), element("button", { textContent: "Compute" }));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const pairs = [this.inputs.slice(0, 2), this.inputs.slice(2)];
      if (pairs.some((ends, i) => isReversed(...ends, words[2 * i].replace(" from", "")))) return;
      this.on.range(this.inputs.map((it, i) => Number(it.value) / plane()[i >> 1].factor));
    });
    const whole = button("Usual range", () => this.on.range(null));
    form.append(whole);
    return element("details", {}, element("summary", { textContent: "Range of starts" }), form);
  }

  /** Computes the basins at parameters; `words` say them. `range` is that of the starts, or none for the usual. */
  async show(parameters, range, words) {
    const pairs = range ? Object.fromEntries(ends().map((name, i) => [name, range[i]])) : {};
    const request = { ...parameters, ...pairs }, asked = JSON.stringify(request);
    if (asked === this.asked) return;
    this.stop();
    const running = new AbortController();
    Object.assign(this, { running, asked, request, parameters, data: null, last: null, began: performance.now() });
    this.heading.textContent = `At ${words}.`;
    this.at = words;
    this.task = busy.begin("basin", "Basin");
    this.told.textContent = "The first starts are computed.";
    say("The basin is computed");
    Object.assign(this.bar, { value: 0, hidden: false });
    this.plane.data = null;
    Object.assign(this.plane, { mark: null, chosen: null, points: [] });
    [this.attractors, this.legend].forEach((it) => it.replaceChildren());
    try {
      await ask.lines("/api/basin", request, (it) => this.receive(it), running.signal);
      this.bar.hidden = true;
      this.task.end();
      say(this.told.textContent);
    } catch (it) {
      if (it.name === "AbortError") return;
      this.task.end(false);
      this.asked = null;
      this.bar.hidden = true;
      this.told.textContent = it.message;
      say(it.message);
    }
  }

  /** Computes nothing more. */
  stop() {
    this.running?.abort();
    this.task?.end(false);
    this.asked = null;
    handOver("basin", "", null);
  }

  // The description of the basins comes first, then how many starts are computed, and the labels of each grid.
  receive(it) {
    if (it.side) return this.describe(it);
    this.tell(it);
    return it.labels && this.take(it);
  }

  tell({ computed, cases }) {
    const seconds = ((performance.now() - this.began) / 1e3).toFixed(1), left = computed < cases ? "; it becomes finer" : "";
    this.told.textContent = `${computed} of ${cases} starts in ${seconds} s${left}.`;
    Object.assign(this.bar, { value: computed, max: cases });
    this.task.tell(`${computed} of ${cases}`, computed / cases);
  }

  describe(head) {
    this.head = head;
    this.plane.stop = head.surface ?? NaN;
    // The plane varies the other two coordinates of the start.
    const held = head.held.map(({ name, value, unit }) => `${name} = ${short(value)}${unit && ` ${unit}`}`).join(", ");
    this.heading.replaceChildren(...marked(`At ${this.at}. Every start has ${held}.`));
    const all = [...head.x.range, ...head.y.range];
    this.inputs.forEach((input, i) => { input.value = String(Number(all[i].toPrecision(6))); });
    handOver("basin", "Basin: study for capsulemap sweep", head.study, true);
  }

  take(pass) {
    const { head } = this, side = (head.side - 1) / pass.step + 1;
    this.last = pass;
    const colours = new Map(pass.attractors.map((it) => [it.label, it.colour]));
    const bytes = new Uint8ClampedArray(4 * pass.labels.length);
    pass.labels.forEach((label, i) => bytes.set([...(colours.get(label) || pass.unknown || UNDECIDED), 255], 4 * i));
    const axis = (it) => ({
      ...it, log: false,
      values: Array.from({ length: side }, (_, i) => (it.range[0] + i / (side - 1) * (it.range[1] - it.range[0])) / it.factor),
      ends: Array.from({ length: side }, (_, i) => (i === side - 1 ? 1 : (i + 0.5) / (side - 1))),
    });
    this.data = { x: axis(head.x), y: axis(head.y), colours: bytes };
    this.plane.points = pass.attractors.flatMap((it) => (it.points || []).map((at) => ({ at, colour: it.colour })));
    this.plane.show(this.data);
    this.explain();
    this.canvas.setAttribute("aria-label", `Basins of ${pass.attractors.length} attractors over ${head.x.label} and ${head.y.label}, ${side} by ${side} starts`);
    this.list(pass);
    this.on.shown();
  }

  // What lies over the basins.
  explain() {
    const { plane, head } = this, made = [];
    if (plane.hasStop()) made.push(entry(`surface of impacts, ${parted(head.x.label)[0]} = ${model.surface.name}`, (drawn, [x, y]) => {
      drawn.setLineDash([4, 3]);
      rimmed(drawn, () => { drawn.moveTo(x, y - 9); drawn.lineTo(x, y + 9); }, "#000000", 1.5);
      drawn.setLineDash([]);
    }));
    const isSeen = plane.points.some(({ at }) => plane.isSeen(plane.shares(at)));
    if (isSeen) made.push(entry(`section point of an attractor, in its colour${head.held.length > 1 ? `, projected: its ${head.held[0].name} is its own` : ""}`, (drawn, at) => sectionPoint(drawn, at, "#888888")));
    if (plane.chosen) made.push(entry("chosen start", (drawn, at) => cross(drawn, at)));
    this.legend.replaceChildren(...made);
  }

  // What each colour means, with its share of the starts so far.
  list({ attractors, labels, unknown }) {
    const count = (label) => labels.filter((it) => it === label).length;
    const swatch = (colour) => { const made = element("span", { className: "swatch" }); made.style.background = `rgb(${colour})`; return made; };
    const part = (number) => `${short(100 * number / labels.length, 3)} %`;
    const named = (text, colour) => element("span", {}, swatch(colour), text);
    const rows = attractors.map((it) => {
      const period = it.outcome === "periodic" ? `periodic, period ${it.period}` : it.outcome;
      return [named(String(it.label), it.colour), period, shown(it[model.main_output.name], model.main_output), part(count(it.label))];
    });
    const known = new Set(attractors.map((it) => it.label)), others = labels.filter((it) => !known.has(it)).length;
    if (others) rows.push([named("none", unknown || UNDECIDED), "undecided", "–", part(others)]);
    this.attractors.replaceChildren(table("Attractors of the basin", ["attractor", "motion", model.main_output.label, "share of starts"], rows));
  }

  hover(at, isKey, event = null) {
    if (at && event) this.beside(at, event); else tip.hide();
    const words = at ? this.words(at) : "\u00a0";
    this.hovered.textContent = words;
    if (at && isKey) say(words);
  }

  // Values beside the pointer.
  beside(at, event) {
    const { x, y } = this.data, label = this.last.labels[at.number], it = this.last.attractors.find((one) => one.label === label);
    const rows = [x, y].map((axis, i) => tip.pair(axis.label, short(at.cell[i] * axis.factor)));
    if (it) rows.push(tip.pair(model.main_output.label, shown(it[model.main_output.name], model.main_output)));
    tip.show(event, { head: it ? `attractor ${label}` : "undecided", colour: `rgb(${it?.colour ?? UNDECIDED})`, rows });
  }

  words(at) {
    const { x, y } = this.data, label = this.last.labels[at.number], it = this.last.attractors.find((one) => one.label === label);
    const where = `${said(x.label, at.cell[0] * x.factor)}, ${said(y.label, at.cell[1] * y.factor)}`;
    return `${where}: ${it ? `attractor ${label}` : "undecided"}`;
  }

  /** Puts the mark at the start of a motion, if it is one of these basins. */
  mark(coordinates) {
    if (!this.data) return;
    const [x, y] = [coordinates?.[this.data.x.name], coordinates?.[this.data.y.name]];
    const isAt = Object.entries(this.parameters).every(([name, value]) => coordinates?.[name] === value);
    // A start that has another phase, or another of the coordinates that the plane does not vary, lies in another plane.
    const isHere = isAt && this.head.held.every(({ name, value }) => (coordinates?.[`start_${name}`] ?? value) === value);
    const place = isHere && x !== undefined && y !== undefined ? this.plane.shares([x, y]) : null;
    this.plane.chosen = place;
    if (place) this.plane.mark = place;
    this.plane.draw();
    this.explain();
  }
}
