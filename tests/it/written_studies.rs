//! Studies built in code: written as study files that parse to the same, whatever their keys hold, and checked.

use std::collections::BTreeMap;

use capsulemap::capsule::description::CAPSULE;
use capsulemap::capsule::{
    CapsuleParameters as _, DriveKind, Parameter, Parameters, Reaction, Resistance, State,
    Switching,
};
use capsulemap::description::{Kept, Presence};
use capsulemap::orbit::{Exponents, Protocol};
use capsulemap::quantity::Allowed;
use capsulemap::study::{
    Axis, CaseSet, Continuation, Coordinate, Direction, DrawKind, Draws, FirstOrbit, Grid, Inherit,
    Normal, Range, Refine, Spacing, Study, Varying,
};

use super::random_numbers::Random;

mod drawn_protocols;
mod drawn_ramps;

/// The coordinate in place of which one stands.
fn replaced(coordinate: Coordinate) -> Option<Coordinate> {
    let Coordinate::Parameter(parameter) = coordinate else { return None };
    parameter.replaces().map(Coordinate::Parameter)
}

impl Random {
    fn axis(&mut self, coordinate: Coordinate) -> Axis {
        let ends = [self.number(coordinate.allowed()), self.number(coordinate.allowed())];
        let points = 1 + self.below(6);
        let values = match self.below(3) {
            0 => (0..points).map(|_| self.number(coordinate.allowed())).collect::<Vec<_>>(),
            1 => Spacing::Linear.values(ends[0], ends[1], points),
            _ => Spacing::Logarithmic.values(ends[0].abs() + 1e-6, ends[1].abs() + 1e-5, points),
        };
        let mut distinct: Vec<f64> = Vec::new();
        for value in values {
            if !distinct.contains(&value) {
                distinct.push(value);
            }
        }
        Axis::of(coordinate, distinct)
    }

    /// A path, the first quantity of which has other values at each place.
    fn path(&mut self, mut coordinates: Vec<Coordinate>) -> Axis {
        coordinates.sort_by_key(|it| Coordinate::all(&CAPSULE).position(|other| other == *it));
        let mut axis = self.axis(coordinates[0]);
        let places = axis.places();
        if coordinates.len() == 1 {
            axis.varying[0].values.sort_by(f64::total_cmp);
        }
        for coordinate in coordinates.into_iter().skip(1) {
            let ends = [self.number(coordinate.allowed()), self.number(coordinate.allowed())];
            let values = match self.is_so() {
                true => Spacing::Linear.values(ends[0], ends[1], places),
                false => (0..places).map(|_| self.number(coordinate.allowed())).collect(),
            };
            axis.varying.push(Varying { coordinate, values });
        }
        Axis { path: Some("line".to_owned()), ..axis }
    }

    fn range(&mut self, coordinate: Coordinate) -> Range {
        let [from, to] = self.ends(coordinate.allowed());
        if from < to && self.is_so() {
            let normal = Normal { mean: 0.5 * (from + to), deviation: 0.3 * (to - from) };
            return Range {
                normal: Some(normal),
                ..Range::even(coordinate, [from, to], Spacing::Linear)
            };
        }
        let can_be_log = from > 0.0 && to > 0.0;
        let spacing =
            if can_be_log && self.is_so() { Spacing::Logarithmic } else { Spacing::Linear };
        Range::even(coordinate, [from, to], spacing)
    }

    fn case_set(&mut self) -> CaseSet {
        let mut coordinates = self.some(&Coordinate::all(&CAPSULE).collect::<Vec<_>>());
        coordinates.truncate(self.below(5));
        let all = coordinates.clone();
        coordinates.retain(|it| !all.iter().any(|other| replaced(*other) == Some(*it)));
        if self.below(3) == 0 && !coordinates.is_empty() {
            let ranges: Vec<Range> = coordinates.into_iter().map(|it| self.range(it)).collect();
            let kind = self.one(&DrawKind::NAMES).1;
            let count = match kind {
                DrawKind::Saltelli => (ranges.len() + 2) << (1 + self.below(12)),
                DrawKind::Uniform | DrawKind::LowDiscrepancy => 1 + self.below(10_000),
            };
            return CaseSet::Draws(Draws { kind, count, seed: self.bits() >> 1, ranges });
        }
        let together = if self.below(3) == 0 { coordinates.len() / 2 } else { 0 };
        let along = coordinates.split_off(coordinates.len() - together);
        let mut axes: Vec<Axis> = coordinates.into_iter().map(|it| self.axis(it)).collect();
        if !along.is_empty() {
            axes.push(self.path(along));
        }
        let parameters: Vec<usize> =
            (0..axes.len()).filter(|axis| axes[*axis].is_of_parameters()).collect();
        let directions = self.some(&Direction::ALL);
        let inherit = (!parameters.is_empty() && !directions.is_empty())
            .then(|| Inherit { axis: self.one(&parameters), directions });
        CaseSet::Grid(Grid { axes, inherit })
    }

    fn state(&mut self) -> State<f64> {
        let [r, y1, y2] = [(); 3].map(|()| self.number(Allowed::Finite));
        State::of([r, y1, 0.0, y2])
    }

    /// A parameter that neither stands in place of one of these coordinates nor has one of them in its place.
    fn free_of(&mut self, others: &[Coordinate]) -> Parameter {
        let drawn = self.one(Parameter::ALL);
        let own = Coordinate::Parameter(drawn.into());
        let is_bound =
            others.iter().any(|it| replaced(*it) == Some(own) || replaced(own) == Some(*it));
        if is_bound { Parameter::M1 } else { drawn }
    }

    fn branch(&mut self, study: &Study, name: String) -> Continuation {
        let varied = study.case_set.varied();
        let along = self.free_of(&varied);
        let second = self.free_of(&[varied, vec![Coordinate::Parameter(along.into())]].concat());
        let mut parameters = study.base.clone();
        let mut around = |parameter: Parameter, parameters: &mut Parameters| {
            let ends = self.ends(parameter.allowed());
            let range = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            parameters[parameter] = self.uniform(range[0], range[1]).clamp(range[0], range[1]);
            range
        };
        let second_range = around(second, &mut parameters);
        let range = around(along, &mut parameters);
        for coordinate in study.case_set.varied() {
            if let Coordinate::Parameter(parameter) = coordinate
                && ![along, second].iter().any(|it| parameter == *it)
            {
                parameters[parameter] = self.number(parameter.allowed());
            }
        }
        let second = Some((second.into(), second_range)).filter(|(second, _)| *second != along);
        Continuation {
            name,
            along: along.into(),
            range,
            parameters,
            start: self.state().into(),
            start_phase: self.number(Allowed::Finite),
            section_phase: self.number(Allowed::Finite),
            first: match self.is_so() {
                true => FirstOrbit::Settle,
                false => FirstOrbit::Newton { period: 1 + self.below(100) as u64 },
            },
            doublings: self.below(21) as u32,
            second,
            curve_range: None,
            longest_step: self.uniform(1e-6, 1.0),
            most_points: 2 + self.below(1_000_000 - 1),
        }
    }

    fn study(&mut self) -> Study {
        let case_set = self.case_set();
        let varied = case_set.varied();
        let has_branches = self.is_so();
        let mut study = Study { title: self.text(&[]), case_set, ..Study::default() };
        for &parameter in Parameter::ALL {
            let in_place = replaced(Coordinate::Parameter(parameter.into()));
            let is_free = in_place.is_none_or(|it| !varied.contains(&it));
            let is_replaced = varied
                .iter()
                .any(|it| replaced(*it) == Some(Coordinate::Parameter(parameter.into())));
            let is_there = !is_replaced
                && (parameter.presence() != Presence::Optional || (self.is_so() && is_free));
            if is_there && !varied.contains(&Coordinate::Parameter(parameter.into())) {
                study.base[parameter] = self.number(parameter.allowed());
            }
        }
        study.base.resist_by(self.one(&Resistance::NAMES).1);
        if !has_branches {
            study.base.switch_by(self.one(&Switching::NAMES).1);
        }
        if study.base.switching() == Switching::Filippov {
            let kinds = [DriveKind::Harmonic, DriveKind::Square, DriveKind::TwoHarmonics];
            study.base.drive_by(self.one(&kinds));
            study.base.react_on(self.one(&Reaction::NAMES).1);
        } else if study.with_parts().have_optional_parts() {
            study.base.switch_by(Switching::Filippov);
        }
        let state = self.state();
        let unless =
            |coordinate, value: f64| if varied.contains(&coordinate) { 0.0 } else { value };
        for (coordinate, value) in CAPSULE.section_coordinates().zip([state.r, state.y1, state.y2])
        {
            study.start[coordinate] = unless(Coordinate::Start(coordinate), value);
        }
        study.start_phase = unless(Coordinate::StartPhase, self.number(Allowed::Finite));
        study.section_phase = unless(Coordinate::SectionPhase, self.number(Allowed::Finite));
        study.protocol = self.protocol();
        if self.is_so() {
            let all = study.protocol.exponents == Exponents::All;
            let asked = CAPSULE.outputs().filter(|it| all || it.kept() != Kept::WithExponents);
            study.outputs = self.some(&asked.collect::<Vec<_>>());
        }
        for number in 0..if has_branches { self.below(3) } else { 0 } {
            let name = format!("{number}{}", self.text(&[]));
            let branch = self.branch(&study, name);
            study.branches.push(branch);
        }
        for number in 0..if has_branches { self.below(3) } else { 0 } {
            let name = format!("{number}{}", self.text(&[]));
            let ramp = self.ramp(&study, name);
            study.ramps.push(ramp);
        }
        for number in 0..self.below(3) {
            let name = format!("{number} \"ω'");
            let drawing = self.drawing(&study, name);
            study.drawings.push(drawing);
        }
        study
    }
}

/// A study without its text and what is told of that, shown with all digits, so that 0 and -0 differ too.
fn shown(study: &Study) -> String {
    format!("{:#?}", Study { text: String::new(), remarks: Vec::new(), ..study.clone() })
}

fn assert_round_trip(study: &Study) {
    let text = study.to_toml();
    let read =
        Study::parse("written.toml", &text).unwrap_or_else(|faults| panic!("{faults}\n{text}"));
    assert_eq!(shown(&read), shown(study), "{text}");
    // What is told of the text depends on what it gives, which here is all.
    let remarks = read.remarks.clone();
    assert_eq!(read, Study { text: text.clone(), remarks, ..study.clone() });
    assert_eq!(read.fingerprint(), study.fingerprint());
    assert_eq!(read.to_toml(), text);
}

#[test]
fn a_study_of_any_keys_is_read_back_as_it_was_written() {
    let mut random = Random::new(3);
    let mut seen = BTreeMap::<&str, usize>::new();
    for _ in 0..2000 {
        let study = random.study();
        assert_round_trip(&study);
        let validated = study.clone().validated("built").unwrap_or_else(|it| panic!("{it}"));
        assert_eq!(shown(&validated), shown(&study));
        let text = study.to_toml();
        assert_eq!(validated.text, text);
        for key in [
            "[draws]",
            "inherit =",
            "[[branches]]",
            "[[ramps]]",
            "second =",
            "points =",
            "values =",
        ]
        .into_iter()
        .chain([
            "\"logarithmic\"",
            "[history]",
            "outputs =",
            "at = {",
            "width =",
            "cycles = [",
        ]) {
            *seen.entry(key).or_default() += usize::from(text.contains(key));
        }
    }
    assert!(seen.values().all(|&count| count > 100), "{seen:?}");
}

#[test]
fn every_study_that_is_kept_is_read_back_as_it_was_written() {
    let mut count = 0;
    for entry in std::fs::read_dir("studies").expect("the studies") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let text = std::fs::read_to_string(&path).expect("text");
            let study = Study::parse(&path.display().to_string(), &text);
            assert_round_trip(&study.unwrap_or_else(|faults| panic!("{faults}")));
            count += 1;
        }
    }
    assert!(count > 5);
}

#[test]
fn an_axis_keeps_its_form_and_its_bits() {
    let axis = |values: Vec<f64>| Study {
        case_set: CaseSet::Grid(Grid {
            axes: vec![Axis::of(Coordinate::Parameter(Parameter::K2.into()), values)],
            inherit: None,
        }),
        ..Study::default()
    };
    let even = axis(Spacing::Linear.values(2000.0, 1e5, 50)).to_toml();
    assert!(even.contains("points = 50\nspacing = \"linear\"") && !even.contains("values"));
    let log = axis(Spacing::Logarithmic.values(2000.0, 1e5, 50)).to_toml();
    assert!(
        log.contains("from = \"2000.0 N/m\"\nto = \"100000.0 N/m\"\npoints = 50\nspacing = \"log")
    );
    let mut values = Spacing::Linear.values(2000.0, 1e5, 50);
    values[7] = f64::from_bits(values[7].to_bits() + 1);
    assert!(axis(values).to_toml().contains("values = [\"2000.0 N/m\", "));
}

#[test]
fn all_faults_of_a_study_built_in_code_are_reported_at_once() {
    let values = vec![60.0, f64::NAN, 60.0];
    let axes = vec![Axis::of(Coordinate::Parameter(Parameter::Omega.into()), values)];
    let mut study = Study {
        title: "two\nlines".to_owned(),
        case_set: CaseSet::Grid(Grid {
            axes,
            inherit: Some(Inherit { axis: 3, directions: vec![Direction::Upward; 2] }),
        }),
        protocol: Protocol { tolerance: 1.0, max_cycles: 0, ..Protocol::default() },
        ..Study::default()
    };
    study.base[Parameter::M1] = -1.0;
    study.start = State { y1: f64::INFINITY, ..State::default() }.into();
    let faults = study.validated("built").expect_err("a faulty study");
    assert!(faults.faults.iter().all(|fault| fault.line.is_none()));
    let ran = faults.to_string();
    for words in [
        "built: ",
        "title: must be one line",
        "parameters.m1: -1 kg must be a finite number above zero",
        "axes[1].values[2]: NaN rad/s must be",
        "axes[1].values[3]: 60, in SI units, is given twice",
        "start.inherit: unknown axis of this study \"3\"",
        "start.y1: inf m/s must be a finite number",
        "protocol.tolerance: 1 must lie between",
        "protocol.max_cycles: expected a whole number",
    ] {
        assert!(ran.contains(words), "{words}: {ran}");
    }
}

#[test]
fn what_a_study_file_cannot_hold_is_reported() {
    let ran = |study: Study| study.validated("built").expect_err("a fault").to_string();
    let start = State { x2: 1.0, ..State::default() }.into();
    assert!(ran(Study { start, ..Study::default() }).contains("start: a study file cannot hold"));
    let axes = vec![Axis::of(Coordinate::Parameter(Parameter::Pd.into()), vec![1.0])];
    let inherit = Some(Inherit { axis: 0, directions: Vec::new() });
    let case_set = CaseSet::Grid(Grid { axes, inherit });
    assert!(ran(Study { case_set, ..Study::default() }).contains("axes: a study file cannot hold"));
    // `[basin]` is for studies whose cases differ in their starts alone, and its `refine` for grids: see docs/study/basin.md.
    let message = ran(Study { early_decision: false, ..Study::default() });
    assert!(message.contains("basin.early_decision: a study file cannot hold false"), "{message}");
    let axes = vec![Axis::of(Coordinate::Parameter(Parameter::Pd.into()), vec![1.0, 2.0])];
    let case_set = CaseSet::Grid(Grid { axes, inherit: None });
    let refine = Some(Refine::Attractors);
    let message = ran(Study { case_set, refine, ..Study::default() });
    assert!(
        message.contains("basin.refine: a study file cannot hold Some(Attractors)"),
        "{message}"
    );
    // A map is refined by one output or more.
    let axes = ["p_d", "k2"].map(|name| {
        let parameter = Parameter::named(name).expect("a parameter");
        Axis::of(Coordinate::Parameter(parameter.into()), vec![1.0, 2.0])
    });
    let case_set = CaseSet::Grid(Grid { axes: axes.to_vec(), inherit: None });
    let refine = Some(Refine::Outputs(Vec::new()));
    let message = ran(Study { case_set, refine, ..Study::default() });
    assert!(message.contains("map.refine"), "{message}");
    let mut random = Random::new(4);
    let mut branch = random.branch(&Study::default(), "one".to_owned());
    branch.range.reverse();
    let reversed = Study { branches: vec![branch], ..Study::default() };
    assert!(ran(reversed).contains("branches[1]: a study file cannot hold"));
    // What is held constant of a coordinate that varies does not count.
    let axes = vec![Axis::of(Coordinate::Parameter(Parameter::Pd.into()), vec![1.0])];
    let case_set = CaseSet::Grid(Grid { axes, inherit: None });
    let mut study = Study { case_set, ..Study::default() };
    study.base[Parameter::Pd] = -1.0;
    assert!(study.validated("built").is_ok());
}

/// Files of results and kept blocks have it: with another one they would be those of another study.
#[test]
fn fingerprints_stay() {
    let known = [
        (include_str!("../../studies/basin.toml"), "0f279dc54f51e3cc1785f819bdb0405f"),
        (include_str!("../../studies/erosion.toml"), "988dde0b48494b76f1515b3be509d446"),
    ];
    for (text, known) in known {
        let study = Study::parse("known.toml", text).unwrap_or_else(|faults| panic!("{faults}"));
        assert_eq!(study.fingerprint(), known);
    }
}
