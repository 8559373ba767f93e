//! `capsulemap tradeoff --margins`: motions that settle step by step stay until where they are said to end, and no longer.

use serde_json::Value;

use capsulemap::capsule::{
    CapsuleState as _, Case, Orbit, Output, Parameter, Parameters, State, settle_case,
};
use capsulemap::orbit::{Outcome, Protocol};

use super::program::WorkDir;

/// The paper's capsule near a fold, and where it moves fast.
const STUDIES: [&str; 2] = [
    "[parameters]\nk2 = \"100 kN/m\"\ndelta = \"0.22 mm\"\n\
     [[axes]]\nname = \"p_d\"\nvalues = [\"1.25 N\", \"1.26 N\"]\n\
     [[axes]]\nname = \"omega\"\nvalues = [\"31.9 rad/s\", \"32 rad/s\"]\n",
    "[parameters]\nk2 = \"20 kN/m\"\ndelta = \"3 mm\"\n\
     [[axes]]\nname = \"p_d\"\nvalues = [\"7 N\", \"7.2 N\"]\n\
     [[axes]]\nname = \"omega\"\nvalues = [\"54 rad/s\", \"56 rad/s\"]\n",
];
/// Steps from the optimum to beside where it ends, each shorter than the one before by the same share, as basins shrink there.
const STEPS: u32 = 150;
/// So far beside the end, as a share of the parameter, the motions on both sides are compared.
const BESIDE: f64 = 1e-5;

fn number(point: &Value, key: &str) -> f64 {
    point[key].as_f64().unwrap_or_else(|| panic!("{key} in {point}"))
}

/// The parameters of a motion.
fn parameters(point: &Value) -> Parameters {
    let mut parameters = Parameters::default();
    for (symbol, value) in point["parameters"].as_object().expect("parameters") {
        if let Some(parameter) = Parameter::named(symbol) {
            parameters[parameter] = value.as_f64().expect("a number");
        }
    }
    parameters
}

/// A motion that is followed by settling again and again.
struct Settling {
    parameters: Parameters,
    parameter: Parameter,
    last: State<f64>,
}

impl Settling {
    /// The motion to which the last one leads at a value.
    fn at(&mut self, value: f64) -> Orbit {
        self.parameters[self.parameter] = value;
        let protocol = Protocol { max_cycles: 100_000, ..Protocol::default() };
        let case = Case::at_section(self.parameters.clone(), self.last, 0.0);
        let orbit = settle_case(&case, &protocol);
        self.last = State { x2: 0.0, ..orbit.end.capsule() };
        orbit
    }
}

/// What is wrong with a margin, if anything is, and whether it has an end.
fn judged(point: &Value, parameter: Parameter, margin: &Value) -> (Option<String>, bool) {
    let until = number(margin, "until");
    let period = point["period"].as_u64().expect("a period");
    let start = |key: &str| number(&point["start"], key);
    let last = State::of([start("start_r"), start("start_y1"), 0.0, start("start_y2")]);
    let mut settling = Settling { parameters: parameters(point), parameter, last };
    let from = settling.parameters[parameter];
    let beside = BESIDE * from * (until - from).signum();
    let stays = |orbit: &Orbit| orbit.outcome == Outcome::Periodic && orbit.period == period;
    // A capsule at rest still takes power.
    let mut power = f64::NAN;
    for step in 0..=STEPS {
        let left = (beside / (until - from)).powf(f64::from(step) / f64::from(STEPS));
        let orbit = settling.at(until + left * (from - until));
        if !stays(&orbit) {
            return (Some(format!("is {:?} with {left} of it left", orbit.outcome)), true);
        }
        power = orbit.outputs[Output::Power];
    }
    if margin["end"] == "none" {
        let share = until / from;
        let is_range = [0.5, 1.5].iter().any(|it| (share - it).abs() < 1e-12);
        return ((!is_range).then(|| format!("ends at {share} of the value")), false);
    }
    // Beyond the end it is another motion, which stays another one where the first one is again.
    if !stays(&settling.at(until + beside)) {
        return (None, true);
    }
    let back = settling.at(until - beside);
    let again = back.outputs[Output::Power];
    let is_same = stays(&back) && (again - power).abs() <= 1e-6 * power.abs();
    (is_same.then(|| "is passed".to_owned()), true)
}

#[test]
fn motions_stay_until_the_ends_of_their_margins_and_no_longer() {
    let mut ends = 0;
    let mut faults = Vec::new();
    for study in STUDIES {
        let folder = WorkDir::new();
        folder.put("study.toml", study);
        folder.run(&["sweep", "study.toml"]).done();
        let asked = ["tradeoff", "results/study/study.h5", "--margins", "--json"];
        let answer = folder.run(&asked).json();
        let point = &answer["fastest"];
        for (symbol, margins) in point["margins"].as_object().expect("margins") {
            let parameter = Parameter::named(symbol).expect("a parameter");
            for side in ["down", "up"] {
                assert_ne!(margins[side]["end"], "not known", "{symbol} {margins}");
                let (fault, is_end) = judged(point, parameter, &margins[side]);
                faults.extend(fault.map(|it| format!("{symbol} {side} {}: {it}", margins[side])));
                ends += usize::from(is_end);
            }
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
    assert!(ends >= 12, "{ends} ends");
}
