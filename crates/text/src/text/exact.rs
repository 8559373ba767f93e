//! The values of a text at a point, one by one with the functions of a library: what the instructions and the series are checked by.

use capsulemap_engine::flow::{Field, Switched};

use crate::text::function::Function;
use crate::text::graph::{Graph, Id, Node};
use crate::text::mode::TextMode;
use crate::text::oscillator::Oscillator;

/// Where the values of a text are asked for.
struct Point<'a> {
    graph: &'a Graph,
    parameters: &'a [f64],
    states: &'a [f64],
    pulses: &'a [f64],
    mode: &'a TextMode<f64>,
    time: f64,
    /// Of each friction its size and what it is at rest.
    frictions: Vec<(Id, Id)>,
    known: Vec<Option<f64>>,
}

impl Point<'_> {
    fn value(&mut self, id: Id) -> f64 {
        if let Some(known) = self.known[id.index()] {
            return known;
        }
        let value = match self.graph.node(id) {
            Node::Number(bits) => f64::from_bits(bits),
            Node::Parameter(place) => self.parameters[place],
            Node::State(place) => self.states[place],
            Node::Time => self.time,
            Node::Switch(place) => self.mode.switches[place],
            Node::Pulse(place) => self.pulses[place],
            Node::Sign(place) => self.mode.signs[place],
            Node::Measured(_) => f64::NAN,
            Node::Friction(place) => {
                let (sliding, at_rest) = self.frictions[place];
                match self.mode.signs[place] {
                    0.0 => self.value(at_rest),
                    sign => sign * self.value(sliding),
                }
            }
            Node::Add(a, b) => self.value(a) + self.value(b),
            Node::Sub(a, b) => self.value(a) - self.value(b),
            Node::Mul(a, b) => self.value(a) * self.value(b),
            Node::Div(a, b) => self.value(a) / self.value(b),
            Node::Neg(a) => -self.value(a),
            Node::Of(function, a) => exactly(function, self.value(a)),
            Node::Max(a, b) => self.value(a).max(self.value(b)),
            Node::Min(a, b) => self.value(a).min(self.value(b)),
        };
        self.known[id.index()] = Some(value);
        value
    }
}

/// A function of a number, by a library.
fn exactly(function: Function, x: f64) -> f64 {
    match function {
        Function::Sqrt => libm::sqrt(x),
        Function::Exp => libm::exp(x),
        Function::Log => libm::log(x),
        Function::Sin => libm::sin(x),
        Function::Cos => libm::cos(x),
        Function::Tanh => libm::tanh(x),
        Function::Abs => libm::fabs(x),
    }
}

impl<const D: usize, const N: usize, const AUTONOMOUS: bool> Field
    for Oscillator<f64, D, N, AUTONOMOUS>
{
    type Coordinates = [f64; N];

    fn coordinates(state: &[f64; N]) -> [f64; N] {
        *state
    }

    fn rates(&self, mode: &TextMode<f64>, time: f64, state: &[f64; N]) -> [f64; N] {
        let text = &self.program.text;
        let states: Vec<f64> = self.program.layout.iter().map(|at| state[*at]).collect();
        let mut point = Point {
            graph: &text.graph,
            parameters: &self.parameters,
            states: &states,
            pulses: &self.pulses(mode),
            mode,
            time: time + self.later,
            frictions: text.frictions.iter().map(|it| (it.sliding, it.at_rest)).collect(),
            known: vec![None; text.graph.len()],
        };
        let mut rates = [0.0; N];
        for (rate, at) in text.rates.iter().zip(&self.program.layout) {
            rates[*at] = point.value(*rate);
        }
        for (place, it) in self.program.lasting.iter().enumerate() {
            if let Some(it) = it.filter(|_| mode.contacts[place] > 0.5) {
                rates[self.program.layout[it.state]] = 0.0;
                rates[self.program.layout[it.velocity]] = 0.0;
            }
        }
        rates
    }

    fn weights(&self) -> [f64; N] {
        self.program.scales(Switched::period(self))
    }
}
