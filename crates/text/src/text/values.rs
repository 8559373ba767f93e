//! Expressions as values of the graph: names looked up, definitions in their places.

use crate::text::content::Measured;
use crate::text::expression::{Condition, Expression, Kind, Operator, condition, expression};
use crate::text::function::Function;
use crate::text::graph::{Graph, Id, Level, Node};
use crate::text::names::{MEASURES, Meaning, Names, OF_TWO};
use crate::text::written::{Source, Written, hint};

/// Values of a text at most, so that what goes through them needs no more room than a thread has.
const MOST_VALUES: usize = 2000;
/// Definitions that use each other, one by the next, at most.
const DEEPEST: usize = 100;
/// The greatest whole power.
const MOST_POWER: f64 = 64.0;

/// Makes values of expressions, and notes what is wrong in them.
pub struct Values<'a, 's> {
    pub source: &'s Source<'a>,
    pub names: Names,
    pub graph: Graph,
    /// What the frictions are of, once that is known, by their places.
    pub of_frictions: Vec<Option<Id>>,
    /// What the definitions are, once that is known, by their places.
    definitions: Vec<Definition>,
    /// How many definitions are being computed, one for the next.
    depth: usize,
    /// What is measured for outputs.
    pub measured: Vec<Measured>,
    /// The events of which there are counts, with where these stand.
    pub counts: Vec<(String, usize)>,
    /// The outputs that are known so far, by their places.
    pub outputs: Vec<Option<Id>>,
    /// Whether an output is read, which may measure something.
    pub is_output: bool,
}

/// How far a definition has come.
#[derive(Clone, Copy)]
enum Definition {
    Waits,
    Begun,
    Is(Option<Id>),
}

impl<'a, 's> Values<'a, 's> {
    /// Of these names.
    pub fn new(source: &'s Source<'a>, names: Names, frictions: usize) -> Self {
        let definitions = vec![Definition::Waits; names.definitions.len()];
        let of_frictions = vec![None; frictions];
        Values {
            source,
            names,
            graph: Graph::default(),
            of_frictions,
            definitions,
            depth: 0,
            measured: Vec::new(),
            counts: Vec::new(),
            outputs: Vec::new(),
            is_output: false,
        }
    }

    /// The value of an expression; none where something in it is wrong.
    pub fn value(&mut self, written: &Written) -> Option<Id> {
        match expression(&written.characters, written.at) {
            Ok(it) => self.of(&it),
            Err(misread) => {
                self.source.misread(misread);
                None
            }
        }
    }

    /// The same of an expression of parameters and numbers alone.
    pub fn constant(&mut self, written: &Written, what: &str) -> Option<Id> {
        let id = self.value(written)?;
        if self.graph.level(id) != Level::Case {
            let message = format!("{what} may be of parameters and numbers alone");
            self.source.fault(written.at, message);
            return None;
        }
        Some(id)
    }

    /// How much the greater side of a condition is greater.
    pub fn excess(&mut self, written: &Written) -> Option<Id> {
        let Condition { sides: [greater, lesser] } =
            match condition(&written.characters, written.at) {
                Ok(it) => it,
                Err(misread) => {
                    self.source.misread(misread);
                    return None;
                }
            };
        let both = [self.of(&greater), self.of(&lesser)];
        let [Some(greater), Some(lesser)] = both else { return None };
        Some(self.graph.sub(greater, lesser))
    }

    /// Makes the values of definitions that nothing has asked for, so that what is wrong in them is told.
    pub fn all_definitions(&mut self) {
        for place in 0..self.definitions.len() {
            self.definition(place, None);
        }
    }

    fn of(&mut self, expression: &Expression) -> Option<Id> {
        if self.graph.len() > MOST_VALUES {
            let message = format!("the text has more than {MOST_VALUES} values");
            self.source.fault(expression.at.start, message);
            return None;
        }
        match &expression.kind {
            Kind::Number(number) => Some(self.graph.number(*number)),
            Kind::Name(name) => self.named(name, expression.at.start),
            Kind::Minus(of) => {
                let of = self.of(of)?;
                Some(self.graph.neg(of))
            }
            Kind::Joined(operator, sides) => self.joined(*operator, sides),
            Kind::Call(name, arguments) => self.call(name, arguments, expression.at.start),
        }
    }

    fn named(&mut self, name: &str, at: usize) -> Option<Id> {
        let meaning = match self.names.meaning(name) {
            Ok(it) => it,
            Err(message) => {
                self.source.fault(at, message);
                return None;
            }
        };
        Some(match meaning {
            Meaning::Pi => self.graph.number(std::f64::consts::PI),
            Meaning::Time => self.graph.leaf(Node::Time),
            Meaning::State(place) => self.graph.leaf(Node::State(place)),
            Meaning::Parameter(place) => self.graph.leaf(Node::Parameter(place)),
            Meaning::Switch(place) => self.graph.leaf(Node::Switch(place)),
            Meaning::Pulse(place) => self.graph.leaf(Node::Pulse(place)),
            Meaning::Friction(place) => self.graph.leaf(Node::Friction(place)),
            Meaning::Definition(place) => return self.definition(place, Some(at)),
            Meaning::Output(place) => match self.outputs.get(place).filter(|_| self.is_output) {
                Some(known) => return *known,
                None => {
                    let message = format!("{name} is an output; only later outputs may use it");
                    self.source.fault(at, message);
                    return None;
                }
            },
        })
    }

    fn definition(&mut self, place: usize, used_at: Option<usize>) -> Option<Id> {
        match self.definitions[place] {
            Definition::Is(id) => id,
            Definition::Begun => {
                let name = &self.names.definitions[place].0;
                let message = format!("{name} is defined by itself in the end");
                self.source.fault(used_at.unwrap_or_default(), message);
                None
            }
            Definition::Waits if self.depth == DEEPEST => {
                let message = format!("more than {DEEPEST} definitions use each other in a row");
                self.source.fault(used_at.unwrap_or_default(), message);
                None
            }
            Definition::Waits => {
                self.definitions[place] = Definition::Begun;
                let written = self.names.definitions[place].1.clone();
                self.depth += 1;
                let id = self.value(&written);
                self.depth -= 1;
                self.definitions[place] = Definition::Is(id);
                id
            }
        }
    }

    fn joined(&mut self, operator: Operator, sides: &[Expression; 2]) -> Option<Id> {
        let left = self.of(&sides[0]);
        if operator == Operator::Power {
            let exponent = self.of(&sides[1])?;
            return self.power(left?, exponent, sides[1].at.start);
        }
        let right = self.of(&sides[1]);
        let [Some(left), Some(right)] = [left, right] else { return None };
        Some(match operator {
            Operator::Plus => self.graph.add(left, right),
            Operator::Minus => self.graph.sub(left, right),
            Operator::Times => self.graph.mul(left, right),
            _ => self.graph.div(left, right),
        })
    }

    fn power(&mut self, base: Id, exponent: Id, at: usize) -> Option<Id> {
        let whole = self.graph.number_of(exponent).filter(|it| it.fract() == 0.0);
        let Some(exponent) = whole.filter(|it| it.abs() <= MOST_POWER) else {
            let message = format!(
                "a power must be a whole number from -{MOST_POWER} to {MOST_POWER}; \
                 others are exp(exponent*log(base)), roots are sqrt"
            );
            self.source.fault(at, message);
            return None;
        };
        let power = self.graph.power(base, exponent.abs() as u32);
        if exponent >= 0.0 {
            return Some(power);
        }
        let one = self.graph.number(1.0);
        Some(self.graph.div(one, power))
    }

    /// The largest or least value, an integral or a count, of one argument.
    fn measure(&mut self, name: &str, of: &Expression) -> Option<Id> {
        let measured = if name == "count" {
            let Kind::Name(event) = &of.kind else {
                self.source.fault(of.at.start, "count is of the name of an event");
                return None;
            };
            self.counts.push((event.clone(), of.at.start));
            Measured::Count(event.clone())
        } else {
            self.is_output = false;
            let value = self.of(of);
            self.is_output = true;
            let kinds = [
                ("integral", Measured::Integral as fn(Id) -> Measured),
                ("mean", Measured::Mean),
                ("max", Measured::Largest),
                ("min", Measured::Least),
            ];
            let kind = kinds.iter().find(|it| it.0 == name).expect("it is one of these").1;
            kind(value?)
        };
        let known = self.measured.iter().position(|it| *it == measured);
        let place = known.unwrap_or(self.measured.len());
        if known.is_none() {
            self.measured.push(measured);
        }
        Some(self.graph.leaf(Node::Measured(place)))
    }

    fn call(&mut self, name: &str, arguments: &[Expression], at: usize) -> Option<Id> {
        let is_measure = MEASURES.contains(&name) || OF_TWO.contains(&name);
        if let ([of], true) = (arguments, self.is_output && is_measure) {
            return self.measure(name, of);
        }
        if MEASURES.contains(&name) {
            let message =
                format!("{name} is of one value and for outputs alone, not one within another");
            self.source.fault(at, message);
            return None;
        }
        let mut values = Vec::new();
        for argument in arguments {
            values.push(self.of(argument));
        }
        let function = Function::NAMES.iter().find(|it| it.0 == name).map(|it| it.1);
        let expected = match (function, OF_TWO.contains(&name)) {
            (None, false) => {
                let measures = MEASURES.into_iter().filter(|_| self.is_output);
                let known = Function::NAMES.iter().map(|it| it.0).chain(OF_TWO).chain(measures);
                let known: Vec<&str> = known.collect();
                let message = format!("there is no function {name:?}{}", hint(name, known));
                self.source.fault(at, message);
                return None;
            }
            (Some(_), _) => 1,
            _ => 2,
        };
        if values.len() != expected {
            let plural = if expected == 1 { "argument" } else { "arguments" };
            let message = format!("{name} takes {expected} {plural}, not {}", values.len());
            self.source.fault(at, message);
            return None;
        }
        let values: Vec<Id> = values.into_iter().collect::<Option<_>>()?;
        match function {
            Some(Function::Abs) => self.abs(values[0], at),
            Some(function) => Some(self.graph.function(function, values[0])),
            None if values.iter().any(|it| self.graph.level(*it) != Level::Case) => {
                let message = format!(
                    "{name} of what changes is a switch: write [system.switch.NAME] with `where`"
                );
                self.source.fault(at, message);
                None
            }
            None if name == "max" => Some(self.graph.max(values[0], values[1])),
            None => Some(self.graph.min(values[0], values[1])),
        }
    }

    /// The magnitude of a constant, or of what a friction is of, whose sign is known.
    fn abs(&mut self, of: Id, at: usize) -> Option<Id> {
        if self.graph.level(of) == Level::Case {
            return Some(self.graph.function(Function::Abs, of));
        }
        let turned = self.graph.neg(of);
        let known = |it: &Option<Id>| it.is_some_and(|it| it == of || it == turned);
        let Some(friction) = self.of_frictions.iter().position(known) else {
            self.source.fault(
                at,
                "abs of what changes is allowed only of the `of` of a friction; elsewhere it is a switch: write \
                 [system.switch.NAME] with `where`",
            );
            return None;
        };
        let sign = self.graph.leaf(Node::Sign(friction));
        let of = self.of_frictions[friction].expect("it was found");
        Some(self.graph.mul(sign, of))
    }
}
