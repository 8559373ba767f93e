//! A study built in code: written as a study file that parses to the same study, and checked by its rules.

use super::compared::{OUTDATED, UNWRITTEN};
use super::continuation::FirstOrbit;
use super::drawing_text::write_drawing;
use super::draws::Range;
use super::own_outputs::written;
use super::path_text::{are_same, write_path};
use super::toml_text::{Document, inline, list, number, plain_quantity, quantity, text};
use super::{
    Axis, Boundaries, CaseSet, Continuation, Coordinate, Draws, Fault, Faults, Grid, Inherit,
    Normal, Ramp, Refine, Spacing, Study, Varying,
};
use crate::description::{Parameter, Parameters, Presence, State};
use crate::of::default_model;
use crate::orbit::{Exponents, HistorySpan, Protocol};

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
        let model = self.base.model();
        if model.without_own() != default_model() && model.equations.is_none() {
            document.put("model", text(model.name));
        }
        let are_all = self.outputs.iter().copied().eq(self.base.model().outputs());
        let kept = (!are_all).then(|| list(self.outputs.iter().map(|output| text(output.name()))));
        if let Some(kept) = kept.as_ref().filter(|_| model.own.is_none()) {
            document.put("outputs", kept);
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
        self.ramps.iter().for_each(|ramp| self.write_ramp(&mut document, ramp));
        self.drawings
            .iter()
            .for_each(|drawing| write_drawing(&mut document, drawing, self.base.model()));
        document.0.extend(written(model, kept));
        if let Some(equations) = model.equations {
            document.0 = format!("{}\n{}", document.0, equations.tables);
        }
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
                faults.faults.iter().map(|it| Fault { line: None, ..it.clone() }).collect()
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
        // One that is told of where it is not given would be given by its text.
        let written = self
            .base
            .stated()
            .filter(|(it, _)| it.presence() == Presence::Always || self.base.is_given(*it));
        let varies = |it: Parameter| varied.contains(&Coordinate::Parameter(it));
        for (parameter, value) in written {
            if !varies(parameter) && !parameter.replaced_by().any(varies) {
                document.put(parameter.symbol(), quantity(value, parameter.dimension()));
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
        let name = axes.get(*axis).map(|axis| axis.name().to_owned());
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
        let given = self.base.model().parameters().filter(|parameter| {
            varied.contains(&Coordinate::Parameter(*parameter))
                || branch.varied().any(|other| other == *parameter)
        });
        document.put("at", values_of(given, &branch.parameters));
        document
            .put("start", inline_start(&branch.start, branch.start_phase, branch.section_phase));
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

    fn write_ramp(&self, document: &mut Document, ramp: &Ramp) {
        document.element("ramps");
        document.put("name", text(&ramp.name));
        document.put("along", text(ramp.along.symbol()));
        let [from, to] = ramp.ends.map(|end| quantity(end, ramp.along.dimension()));
        document.put("from", from);
        document.put("to", to);
        let rate = plain_quantity(ramp.rate, ramp.along.dimension());
        document.put("rate", text(&format!("{rate}/s")));
        let varied = self.case_set.varied();
        let given = self
            .base
            .model()
            .parameters()
            .filter(|it| *it != ramp.along && varied.contains(&Coordinate::Parameter(*it)));
        document.put("at", values_of(given, &ramp.parameters));
        document.put("start", inline_start(&ramp.start, ramp.start_phase, ramp.section_phase));
        document.put("begins", text(ramp.begins.name()));
        document.put("parts", ramp.parts);
    }
}

/// The values of some parameters, in one line.
fn values_of(given: impl Iterator<Item = Parameter>, of: &Parameters) -> String {
    inline(given.map(|parameter| {
        (parameter.symbol().to_owned(), quantity(of[parameter], parameter.dimension()))
    }))
}

/// A start in one line.
fn inline_start(state: &State, start_phase: f64, section_phase: f64) -> String {
    let own = start(state, start_phase, section_phase).into_iter();
    inline(
        own.map(|(key, coordinate, value)| {
            (key.to_owned(), quantity(value, coordinate.dimension()))
        }),
    )
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
    document.element("axes");
    document.put("name", text(axis.name()));
    let (None, Some(Varying { coordinate, values })) = (&axis.path, axis.single()) else {
        return write_path(document, axis);
    };
    let dimension = coordinate.dimension();
    match spacing(values) {
        Some((from, to, spacing)) => {
            document.put("from", quantity(from, dimension));
            document.put("to", quantity(to, dimension));
            document.put("points", values.len());
            document.put("spacing", text(spacing.name()));
        }
        None => document.put("values", list(values.iter().map(|it| quantity(*it, dimension)))),
    }
}

/// The ends and the spacing that make exactly these values, if there are such.
fn spacing(values: &[f64]) -> Option<(f64, f64, Spacing)> {
    let (&[from, _, _, ..], &[.., to]) = (values, values) else { return None };
    let found = [Spacing::Linear, Spacing::Logarithmic].into_iter().find(|spacing| {
        let can_be = *spacing == Spacing::Linear || (from > 0.0 && to > 0.0);
        can_be && from != to && are_same(&spacing.values(from, to, values.len()), values)
    });
    found.map(|spacing| (from, to, spacing))
}

fn write_draws(document: &mut Document, draws: &Draws) {
    document.table("draws");
    document.put("kind", text(draws.kind.name()));
    match draws.saltelli() {
        Some(design) => document.put("base_samples", draws.count / design.row_length()),
        None => document.put("count", draws.count),
    }
    document.put("seed", draws.seed);
    for Range { coordinate, from, to, spacing, normal } in &draws.ranges {
        let dimension = coordinate.dimension();
        document.element("axes");
        document.put("name", text(coordinate.name()));
        document.put("from", quantity(*from, dimension));
        document.put("to", quantity(*to, dimension));
        match normal {
            None => document.put("spacing", text(spacing.name())),
            Some(Normal { mean, deviation }) => {
                document.put("mean", quantity(*mean, dimension));
                document.put("deviation", quantity(*deviation, dimension));
            }
        }
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
    // What is asked for by few is written where it is, so that the texts of other studies stay.
    if protocol.exponents != Exponents::Largest {
        document.put("exponents", text(protocol.exponents.name()));
    }
    if let Some(error) = protocol.mean_error {
        document.put("mean_error", number(error));
    }
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
            if study.manifolds {
                document.put("manifolds", true);
            }
        }
    }
    let refine = study.refine.as_ref().filter(|it| matches!(it, Refine::Outputs(_)));
    if refine.is_some() || study.boundaries.is_some() {
        document.table("map");
    }
    if let Some(Refine::Outputs(within)) = refine {
        let each = within
            .iter()
            .map(|(output, most)| (output.name().to_owned(), quantity(*most, output.dimension())));
        document.put("refine", inline(each));
    }
    if let Some(Boundaries { longest_step, most_points, most_tries }) = study.boundaries {
        let keys = [
            ("longest_step", number(longest_step)),
            ("most_points", most_points.to_string()),
            ("most_tries", most_tries.to_string()),
        ];
        let keys = keys.into_iter().map(|(key, value)| (key.to_owned(), value));
        document.put("boundaries", inline(keys));
    }
}
