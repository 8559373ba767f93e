//! A study built in code: written as a study file that parses to the same study, and checked by its rules.

use super::appearance::dimension_of;
use super::compared::{OUTDATED, UNWRITTEN};
use super::continuation::FirstOrbit;
use super::draws::Range;
use super::toml_text::{Document, inline, list, number, plain_quantity, quantity, text};
use super::{
    Axis, CaseSet, Continuation, Coordinate, Drawing, Draws, Fault, Faults, Grid, Inherit,
    QuantitySettings, Refine, Setting, Spacing, Study,
};
use crate::description::{Description, Output, Parameter, State};
use crate::of::default_model;
use crate::orbit::{HistorySpan, Protocol};
use crate::quantity::Dimension;

impl Study {
    /// The study as the text of a study file, with all digits and in SI units.
    ///
    /// [`Study::parse`] makes the same study of it, but for `text` and `remarks`, if the study is one that
    /// [`Study::validated`] accepts. What the study holds constant of a coordinate that varies is left out.
    pub fn to_toml(&self) -> String {
        let mut document = Document::default();
        if !self.title.is_empty() {
            document.put("title", text(&self.title));
        }
        if self.base.model() != default_model() {
            document.put("model", text(self.base.model().name));
        }
        if !self.outputs.iter().copied().eq(self.base.model().outputs()) {
            let names = self.outputs.iter().map(|output| text(output.name()));
            document.put("outputs", list(names));
        }
        self.write_parameters(&mut document);
        match &self.case_set {
            CaseSet::Grid(grid) => {
                grid.axes.iter().for_each(|axis| write_axis(&mut document, axis))
            }
            CaseSet::Draws(draws) => write_draws(&mut document, draws),
        }
        self.write_start(&mut document);
        write_protocol(&mut document, &self.protocol);
        write_basin(&mut document, self);
        for branch in &self.branches {
            self.write_branch(&mut document, branch);
        }
        self.drawings
            .iter()
            .for_each(|drawing| write_drawing(&mut document, drawing, self.base.model()));
        document.0
    }

    /// The study with its text, as it is read back from that; `name` stands for the file in messages.
    ///
    /// Method: what [`Study::to_toml`] writes is parsed, so that a study built in code obeys the rules of a
    /// study file, with the same messages.
    ///
    /// # Errors
    ///
    /// Everything that is not allowed, at once, and whatever a study file cannot hold, such as parameters of a
    /// branch that differ from those of the study without being varied.
    pub fn validated(self, name: &str) -> Result<Study, Faults> {
        let read = Study::parse(name, &self.to_toml());
        let faults = match &read {
            Ok(read) => self.differences(read, UNWRITTEN),
            Err(faults) => {
                let without_line = |fault: &Fault| Fault { line: None, ..fault.clone() };
                faults.faults.iter().map(without_line).collect()
            }
        };
        if faults.is_empty() { read } else { Err(Faults { file: name.to_owned(), faults }) }
    }

    /// Makes sure that the study is the one that its text says: results keep the text, and are resumed and checked by it.
    ///
    /// # Errors
    ///
    /// What of a study that was changed in code is not as its text has it; [`Study::validated`] writes the text anew.
    pub fn check_text(&self, name: &str) -> Result<(), Faults> {
        let faults = self.differences(&Study::parse(name, &self.text)?, OUTDATED);
        if faults.is_empty() { Ok(()) } else { Err(Faults { file: name.to_owned(), faults }) }
    }

    fn write_parameters(&self, document: &mut Document) {
        document.table("parameters");
        let varied = self.case_set.varied();
        for parameter in self.base.model().parameters() {
            if !varied.contains(&Coordinate::Parameter(parameter)) {
                let value = quantity(self.base[parameter], parameter.dimension());
                document.put(parameter.symbol(), value);
            }
        }
        self.base.choices().for_each(|(name, option)| document.put(name, text(option)));
    }

    fn write_start(&self, document: &mut Document) {
        document.table("start");
        let varied = self.case_set.varied();
        for (key, coordinate, value) in start(&self.start, self.start_phase, self.section_phase) {
            if !varied.contains(&coordinate) {
                document.put(key, quantity(value, coordinate.dimension()));
            }
        }
        let CaseSet::Grid(Grid { axes, inherit: Some(Inherit { axis, directions }) }) =
            &self.case_set
        else {
            return;
        };
        // An axis that is not there is named by its number, which is refused as unknown.
        let name = axes.get(*axis).map(|axis| axis.coordinate.name().to_owned());
        document.put("inherit", text(&name.unwrap_or_else(|| axis.to_string())));
        document.put("directions", list(directions.iter().map(|it| text(it.name()))));
    }

    fn write_branch(&self, document: &mut Document, branch: &Continuation) {
        document.element("branches");
        document.put("name", text(&branch.name));
        let [from, to] = branch.range.map(|end| quantity(end, branch.along.dimension()));
        document.put("along", text(branch.along.symbol()));
        document.put("from", from);
        document.put("to", to);
        let varied = self.case_set.varied();
        let is_given = |parameter: &Parameter| {
            varied.contains(&Coordinate::Parameter(*parameter))
                || branch.varied().any(|other| other == *parameter)
        };
        let at = self.base.model().parameters().filter(is_given).map(|parameter| {
            let value = quantity(branch.parameters[parameter], parameter.dimension());
            (parameter.symbol().to_owned(), value)
        });
        document.put("at", inline(at));
        let own = start(&branch.start, branch.start_phase, branch.section_phase);
        let own = own.into_iter().map(|(key, coordinate, value)| {
            (key.to_owned(), quantity(value, coordinate.dimension()))
        });
        document.put("start", inline(own.into_iter()));
        if let FirstOrbit::Newton { period } = branch.first {
            document.put("orbit", text("newton"));
            document.put("period", period);
        }
        document.put("doublings", branch.doublings);
        if let Some((parameter, range)) = branch.second {
            let [from, to] = range.map(|end| quantity(end, parameter.dimension()));
            let pairs = [("name", text(parameter.symbol())), ("from", from), ("to", to)];
            let pairs = pairs.into_iter().map(|(key, value)| (key.to_owned(), value));
            document.put("second", inline(pairs));
        }
        document.put("longest_step", number(branch.longest_step));
        document.put("most_points", branch.most_points);
    }
}

/// The keys of a start with their values.
fn start(
    state: &State,
    start_phase: f64,
    section_phase: f64,
) -> Vec<(&'static str, Coordinate, f64)> {
    let coordinates = state.model().start_coordinates();
    let of_state = coordinates.map(|it| (it.name(), Coordinate::Start(it), state[it]));
    let phases = Coordinate::phases(state.model()).zip([start_phase, section_phase]);
    of_state.chain(phases.map(|(it, phase)| (it.name(), it, phase))).collect()
}

fn write_axis(document: &mut Document, axis: &Axis) {
    let Axis { coordinate, values } = axis;
    document.element("axes");
    document.put("name", text(coordinate.name()));
    let value = |value: f64| quantity(value, coordinate.dimension());
    match spacing(values) {
        Some((from, to, spacing)) => {
            document.put("from", value(from));
            document.put("to", value(to));
            document.put("points", values.len());
            document.put("spacing", text(spacing.name()));
        }
        None => document.put("values", list(values.iter().map(|&it| value(it)))),
    }
}

/// The ends and the spacing that make exactly these values, if there are such.
fn spacing(values: &[f64]) -> Option<(f64, f64, Spacing)> {
    let (&[from, _, _, ..], &[.., to]) = (values, values) else { return None };
    let fits = |spacing: &Spacing| {
        let can_be = *spacing == Spacing::Linear || (from > 0.0 && to > 0.0);
        let spaced = || spacing.values(from, to, values.len());
        can_be && from != to && spaced().iter().zip(values).all(|(a, b)| a.to_bits() == b.to_bits())
    };
    let found = [Spacing::Linear, Spacing::Logarithmic].into_iter().find(fits);
    found.map(|spacing| (from, to, spacing))
}

fn write_draws(document: &mut Document, draws: &Draws) {
    document.table("draws");
    document.put("kind", text(draws.kind.name()));
    document.put("count", draws.count);
    document.put("seed", draws.seed);
    for Range { coordinate, from, to, spacing } in &draws.ranges {
        document.element("axes");
        document.put("name", text(coordinate.name()));
        document.put("from", quantity(*from, coordinate.dimension()));
        document.put("to", quantity(*to, coordinate.dimension()));
        document.put("spacing", text(spacing.name()));
    }
}

fn write_protocol(document: &mut Document, protocol: &Protocol) {
    document.table("protocol");
    document.put("tolerance", number(protocol.tolerance));
    document.put("recurrence", number(protocol.recurrence));
    document.put("accelerate", protocol.accelerate);
    document.put("max_cycles", protocol.max_cycles);
    document.put("max_steps", protocol.max_steps);
    document.put("max_period", protocol.max_period);
    document.put("measured_cycles", protocol.measured_cycles);
    document.put("exponent_cycles", protocol.exponent_cycles);
    document.put("exponent_error", number(protocol.exponent_error));
    document.put("points", protocol.points);
    document.put("impact_points", protocol.impact_points);
    if let Some(HistorySpan { cycles, per_cycle, from_start }) = protocol.history {
        document.table("history");
        document.put("from", text(if from_start { "start" } else { "attractor" }));
        document.put("cycles", cycles);
        document.put("samples_per_cycle", per_cycle);
    }
}

fn write_basin(document: &mut Document, study: &Study) {
    if study.case_set.varies_starts_alone() {
        document.table("basin");
        document.put("early_decision", study.early_decision);
        if let CaseSet::Grid(_) = study.case_set {
            document.put("refine", study.refine.is_some());
        }
    }
    if let Some(Refine::Outputs(within)) = &study.refine {
        document.table("map");
        let one = |(output, most): &(Output, f64)| {
            (output.name().to_owned(), quantity(*most, output.dimension()))
        };
        document.put("refine", inline(within.iter().map(one)));
    }
}

fn write_drawing(document: &mut Document, drawing: &Drawing, model: &'static Description) {
    document.element("figures");
    document.put("name", text(&drawing.name));
    document.put("kind", text(drawing.kind.name()));
    for (key, value) in [("title", &drawing.title), ("x", &drawing.x), ("y", &drawing.y)] {
        if let Some(value) = value {
            document.put(key, text(value));
        }
    }
    if !drawing.of.is_empty() {
        document.put("of", list(drawing.of.iter().map(|name| text(name))));
    }
    if !drawing.at.is_empty() || !drawing.panels.is_empty() {
        let value = |name: &str, value: f64| {
            let known = Coordinate::all(model).find(|coordinate| coordinate.name() == name);
            known.map_or(number(value), |it| quantity(value, it.dimension()))
        };
        let one = drawing.at.iter().map(|(name, it)| (text(name), value(name, *it)));
        let several = drawing
            .panels
            .iter()
            .map(|(name, values)| (text(name), list(values.iter().map(|it| value(name, *it)))));
        document.put("at", inline(one.chain(several)));
    }
    if let Some(cycles) = drawing.cycles {
        document.put("cycles", list(cycles.into_iter().map(number)));
    }
    if let Some(sweep) = drawing.sweep {
        document.put("sweep", text(sweep.name()));
    }
    if let Some(name) = &drawing.colour_by {
        document.put("colour_by", text(name));
    }
    if drawing.curves {
        document.put("curves", drawing.curves);
    }
    document.put("branches", drawing.branches);
    let sizes = [
        ("width", drawing.width_mm),
        ("height", drawing.height_mm),
        ("marker_size", drawing.marker_mm),
    ];
    for (key, size) in sizes {
        if let Some(size) = size {
            document.put(key, text(&format!("{size:?} mm")));
        }
    }
    if let Some(dpi) = drawing.dpi {
        document.put("dpi", number(dpi));
    }
    if !drawing.hide.is_empty() {
        document.put("hide", list(drawing.hide.iter().map(|name| text(name))));
    }
    if !drawing.texts.is_empty() {
        let place = |(name, value): (&String, &f64)| {
            let dimension = dimension_of(name, model).unwrap_or(Dimension::Number);
            (text(name), quantity(*value, dimension))
        };
        let words =
            drawing.texts.iter().map(|(words, at)| (text(words), inline(at.iter().map(place))));
        document.put("texts", inline(words));
    }
    document.put("legend", drawing.legend);
    document.put("data", drawing.data);
    document.put("svg_text", drawing.svg_text);
    for (key, setting) in Setting::NAMES {
        let of_quantity = |(name, set): (&String, &QuantitySettings)| {
            let dimension = dimension_of(name, model).unwrap_or(Dimension::Number);
            let parts = set.parts(setting, |value| plain_quantity(value, dimension))?;
            let parts: Vec<String> = parts.iter().map(|part| text(part)).collect();
            let value = if setting.is_list() { list(parts.into_iter()) } else { parts.concat() };
            Some((text(name), value))
        };
        let all: Vec<_> = drawing.settings.iter().filter_map(of_quantity).collect();
        if !all.is_empty() {
            document.put(key, inline(all.into_iter()));
        }
    }
}
