//! Random texts: an oscillator with a random spring, and some of a wall, a stop, friction, pulses and a state of first order.

use std::collections::HashMap;
use std::sync::{LazyLock, Mutex};

use capsulemap_text::program::Program;
use capsulemap_text::read;

use super::draws::Random;

/// A random text, with the box that its parameters are drawn from.
#[derive(Clone)]
pub struct RandomText {
    /// Its program.
    pub program: &'static Program,
    /// Of each parameter the range that it is drawn from.
    ranges: Vec<[f64; 2]>,
    /// Of each place of a state the range that a start is drawn from.
    starts: [[f64; 2]; 5],
}

impl RandomText {
    /// Random values of its parameters, and a random start.
    pub fn case(&self, random: &mut Random) -> (Vec<f64>, [f64; 5]) {
        let values = self.ranges.iter().map(|range| random.uniform(range[0], range[1])).collect();
        (values, self.starts.map(|range| random.uniform(range[0], range[1])))
    }

    /// Its parameters by their places.
    pub fn directions(&self) -> Vec<usize> {
        (0..self.ranges.len()).collect()
    }
}

/// A text that is being written.
#[derive(Default)]
struct Writing {
    parameters: Vec<(&'static str, [f64; 2])>,
    force: String,
    rest: String,
}

impl Writing {
    fn parameter(&mut self, name: &'static str, range: [f64; 2]) {
        self.parameters.push((name, range));
    }

    /// Adds a term to the force on the mass, and what it needs.
    fn add(&mut self, term: &str, parameters: &[(&'static str, [f64; 2])], rest: &str) {
        self.force += term;
        parameters.iter().for_each(|it| self.parameter(it.0, it.1));
        self.rest += rest;
    }

    fn written(self, section: &str, third: Option<&str>) -> RandomText {
        let parameters: Vec<String> = self
            .parameters
            .iter()
            .map(|(name, [low, high])| format!("{name} = {}", 0.5 * (low + high)))
            .collect();
        let (state, rate) = match third {
            Some(rate) => (", z = \"1\"", format!("z = \"{rate}\"\n")),
            None => ("", String::new()),
        };
        let text = format!(
            "[system]\nname = \"random\"\nstates = {{ x = \"1\", v = \"1\"{state} }}\nsection = {section}\n\
             [system.parameters]\n{}\n[system.rates]\nx = \"v\"\nv = \"{}\"\n{rate}{}",
            parameters.join("\n"),
            self.force,
            self.rest
        );
        let read = read(&text).unwrap_or_else(|faults| panic!("{faults:?}\n{text}"));
        let ranges = self.parameters.iter().map(|it| it.1).collect();
        let program = Box::leak(Box::new(Program::new(read, 3)));
        // On a section where x falls, x is behind the others.
        let (near, none) = ([-0.5, 0.4], [0.0; 2]);
        let starts = match section.contains("falls") {
            true => [[-1.0, 1.0], near, none, near, none],
            false => [near, near, near, none, none],
        };
        RandomText { program, ranges, starts }
    }
}

/// One of some, by chance.
fn one_of<T: Copy>(random: &mut Random, of: &[T]) -> T {
    of[(random.uniform(0.0, of.len() as f64) as usize).min(of.len() - 1)]
}

/// What is measured of every other text.
const OUTPUTS: &str = "[system.outputs]\nmost = \"max(x)\"\nleast = \"min(v*x)\"\nwork = \"integral(v*x^2)\"\nboth = \"most + mean(x)\"\n";
/// Springs of all functions that a text may have.
const SPRINGS: [&str; 6] = [
    "-k*x",
    "-k*x - x^3",
    "-k*sin(x) - 0.2*x",
    "-k*tanh(x) - 0.5*x",
    "-k*x/sqrt(1 + x^2) - 0.3*x",
    "-k*x*(1 + 0.5*exp(-x^2))",
];
/// Rates of a state of first order, and the force by which it acts on the mass.
const THIRD: [(&str, &str); 4] = [
    ("(x - z)/tau", " - 0.3*z"),
    ("(x*x - z)/tau", " - 0.2*z"),
    ("tanh(v/0.01) - z/tau", " - 0.2*z"),
    ("log(2 + x^2) - z/tau", " + 0.1*z"),
];

/// Laws of friction on the ground, and on ground that moves.
const AT_REST: [&str; 3] = [
    "of = \"v\"\nsliding = \"mu\"\nholds = \"mu*h\"\n",
    "of = \"v\"\nsliding = \"mu*(1 + exp(-abs(v)/0.2))\"\nholds = \"mu*h*2\"\n",
    "of = \"v - 0.3\"\nsliding = \"mu\"\n",
];

/// Adds what makes the oscillator switch.
fn add_switching(writing: &mut Writing, random: &mut Random, kinds: u64, laws: &[&str]) {
    if kinds & 1 != 0 {
        // A wall alone may hold the mass; the force presses on it for a part of the cycle.
        let (restitution, lasting) = match kinds & 7 == 1 {
            true => ([0.0, 0.6], "lasting = true\n"),
            false => ([0.5, 0.9], ""),
        };
        let impact = "[[system.events]]\nname = \"impact\"\nwhile = \"x < wall\"\nreset = { x = \"wall\", v = \"-e*v\" }\n";
        writing.add(
            "",
            &[("wall", [0.45, 0.8]), ("e", restitution)],
            &format!("{impact}{lasting}"),
        );
    }
    if kinds & 2 != 0 {
        let damped = one_of(random, &[" - touch*ks*(x + gap)", " - touch*(ks*(x + gap) + 0.2*v)"]);
        writing.add(
            damped,
            &[("ks", [2.0, 20.0]), ("gap", [0.1, 0.6])],
            "[system.switch.touch]\nwhere = \"x < -gap\"\n",
        );
    }
    if kinds & 4 != 0 {
        let law = one_of(random, laws);
        writing.add(" - fr", &[("mu", [0.05, 0.3])], &format!("[system.friction.fr]\n{law}"));
        if law.contains("*h") {
            writing.parameter("h", [1.0, 1.4]);
        }
    }
}

/// Texts that have been drawn, by their numbers and whether they are driven.
static DRAWN: LazyLock<Mutex<HashMap<(u64, bool), RandomText>>> = LazyLock::new(Mutex::default);

fn once(number: u64, is_driven: bool, draw: impl FnOnce() -> RandomText) -> RandomText {
    let mut drawn = DRAWN.lock().expect("no test has failed in here");
    drawn.entry((number, is_driven)).or_insert_with(draw).clone()
}

/// The driven random text of a number.
pub fn driven(number: u64) -> RandomText {
    once(number, true, || {
        let mut random = Random::new(700 + number);
        let mut writing = Writing::default();
        writing.add(
            "f*cos(w*t) - c*v",
            &[("f", [0.2, 1.0]), ("w", [0.6, 2.0]), ("c", [0.05, 0.4])],
            "",
        );
        writing.add(one_of(&mut random, &SPRINGS), &[("k", [0.5, 2.0])], "");
        add_switching(&mut writing, &mut random, number + 1, &AT_REST);
        if number.is_multiple_of(2) {
            writing.add("", &[], OUTPUTS);
        }
        if number % 3 == 1 {
            writing.add(
                " + p*on",
                &[("p", [0.1, 0.5]), ("d", [0.2, 0.8])],
                "[system.pulse.on]\nperiod = \"2*pi/w\"\nduty = \"d\"\n",
            );
        }
        let third = (number % 2 == 1).then(|| one_of(&mut random, &THIRD));
        if let Some((_, force)) = third {
            writing.add(force, &[("tau", [0.5, 2.0])], "");
        }
        writing.written("{ every = \"2*pi/w\" }", third.map(|it| it.0))
    })
}

/// The autonomous random text of a number: a spring that the mass is driven from by negative damping, or by a moving ground.
pub fn autonomous(number: u64) -> RandomText {
    once(number, false, || {
        let mut random = Random::new(900 + number);
        let mut writing = Writing::default();
        writing.add("c*v - 0.5*v*x^2 - b*v^3", &[("c", [0.1, 0.6]), ("b", [0.05, 0.5])], "");
        writing.add(one_of(&mut random, &SPRINGS), &[("k", [0.5, 2.0])], "");
        add_switching(&mut writing, &mut random, number + 1, &AT_REST[2..]);
        if number.is_multiple_of(2) {
            writing.add("", &[], OUTPUTS);
        }
        let third = (number % 2 == 1).then(|| one_of(&mut random, &THIRD));
        if let Some((_, force)) = third {
            writing.add(force, &[("tau", [0.5, 2.0])], "");
        }
        writing.written("{ when = \"x falls\", within = 200.0 }", third.map(|it| it.0))
    })
}
