//! The values of outputs that a study defines, and their derivatives.

use capsulemap_models::description::Definitions;

use crate::text::expression::Operator;
use crate::text::function::Function;

/// What an own output is computed by. Of outputs there are those of the model and, behind them, the own ones.
#[derive(Debug, Clone, PartialEq)]
pub enum Node {
    /// A number.
    Number(f64),
    /// The output at a place.
    Output(usize),
    /// The parameter at a place.
    Parameter(usize),
    /// The negative.
    Minus(Box<Node>),
    /// Two values joined by an operator.
    Joined(Operator, Box<[Node; 2]>),
    /// A function of a value.
    Of(Function, Box<Node>),
    /// The greater of two values, or the lesser.
    Chosen(Choice, Box<[Node; 2]>),
}

/// Which of two values is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// The greater one.
    Greater,
    /// The lesser one.
    Lesser,
}

/// The own outputs of a study.
#[derive(Debug)]
pub struct OwnValues {
    /// What each is computed by.
    pub nodes: Vec<Node>,
    /// Their places, those first that others use.
    pub order: Vec<usize>,
    /// The parameters that they use, each with the name of one that does.
    pub parameters: Vec<(usize, String)>,
}

/// A value and its derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Slope {
    value: f64,
    slope: f64,
}

/// The values that expressions may use with their derivatives, by place.
struct Known<'a> {
    parameters: [&'a [f64]; 2],
    outputs: [Vec<f64>; 2],
}

impl Definitions for OwnValues {
    fn values(&self, parameters: &[f64], outputs: &[f64]) -> Vec<f64> {
        let none = vec![0.0; parameters.len().max(outputs.len())];
        let none = [&none[..parameters.len()], &none[..outputs.len()]];
        let [values, _] = self.both([parameters, none[0]], [outputs, none[1]]);
        values
    }

    fn slopes(&self, parameters: [&[f64]; 2], outputs: [&[f64]; 2]) -> Vec<f64> {
        let [_, slopes] = self.both(parameters, outputs);
        slopes
    }

    fn parameters(&self) -> &[(usize, String)] {
        &self.parameters
    }
}

impl OwnValues {
    /// The values of all and their derivatives, by those of parameters and outputs.
    fn both(&self, parameters: [&[f64]; 2], outputs: [&[f64]; 2]) -> [Vec<f64>; 2] {
        let first = outputs[0].len();
        let outputs = outputs.map(|it| {
            let mut all = it.to_vec();
            all.resize(first + self.nodes.len(), f64::NAN);
            all
        });
        let mut known = Known { parameters, outputs };
        for place in &self.order {
            let Slope { value, slope } = self.nodes[*place].at(&known);
            known.outputs[0][first + place] = value;
            known.outputs[1][first + place] = slope;
        }
        known.outputs.map(|mut it| it.split_off(first))
    }
}

impl Node {
    fn at(&self, known: &Known<'_>) -> Slope {
        let both = |sides: &[Node; 2]| sides.each_ref().map(|it| it.at(known));
        match self {
            Node::Number(value) => Slope { value: *value, slope: 0.0 },
            Node::Output(place) => {
                Slope { value: known.outputs[0][*place], slope: known.outputs[1][*place] }
            }
            Node::Parameter(place) => {
                Slope { value: known.parameters[0][*place], slope: known.parameters[1][*place] }
            }
            Node::Minus(of) => {
                let Slope { value, slope } = of.at(known);
                Slope { value: -value, slope: -slope }
            }
            Node::Joined(operator, sides) => joined(*operator, both(sides)),
            Node::Of(function, of) => of.at(known).through(*function),
            Node::Chosen(choice, sides) => {
                let [a, b] = both(sides);
                let takes_second = match choice {
                    Choice::Greater => b.value > a.value,
                    Choice::Lesser => b.value < a.value,
                };
                // What is not known is not less than anything.
                if takes_second || b.value.is_nan() { b } else { a }
            }
        }
    }
}

fn joined(operator: Operator, [a, b]: [Slope; 2]) -> Slope {
    match operator {
        Operator::Plus => Slope { value: a.value + b.value, slope: a.slope + b.slope },
        Operator::Minus => Slope { value: a.value - b.value, slope: a.slope - b.slope },
        Operator::Times => {
            Slope { value: a.value * b.value, slope: a.slope * b.value + a.value * b.slope }
        }
        Operator::Over => {
            let value = a.value / b.value;
            Slope { value, slope: (a.slope - value * b.slope) / b.value }
        }
        Operator::Power => a.to_the(b),
    }
}

impl Slope {
    /// The value to the power of another.
    fn to_the(self, exponent: Slope) -> Slope {
        let value = power(self.value, exponent.value);
        let of_base = match self.slope {
            0.0 => 0.0,
            slope => exponent.value * power(self.value, exponent.value - 1.0) * slope,
        };
        let of_exponent = match exponent.slope {
            0.0 => 0.0,
            slope => value * Function::Log.value(self.value) * slope,
        };
        Slope { value, slope: of_base + of_exponent }
    }

    /// A function of the value.
    fn through(self, function: Function) -> Slope {
        let value = function.value(self.value);
        let steepness = match function {
            Function::Sqrt => 0.5 / value,
            Function::Exp => value,
            Function::Log => 1.0 / self.value,
            Function::Sin => Function::Cos.value(self.value),
            Function::Cos => -Function::Sin.value(self.value),
            Function::Tanh => 1.0 - value * value,
            Function::Abs => self.value.signum(),
        };
        Slope { value, slope: steepness * self.slope }
    }
}

/// A power; the squares of a value, its cubes and the like as products, which round as one writes them.
fn power(base: f64, exponent: f64) -> f64 {
    match exponent {
        1.0 => base,
        2.0 => base * base,
        3.0 => base * base * base,
        _ => libm::pow(base, exponent),
    }
}
