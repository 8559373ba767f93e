//! Expressions over outputs and parameters of a model as what computes them, with their units.

use crate::text::expression::{Expression, Kind, Operator};
use crate::text::function::Function;
use crate::text::own_value::{Choice, Node};
use crate::text::unit::Unit;
use crate::text::written::{Source, hint};

/// What a name stands for.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// What computes it.
    pub node: Node,
    /// The unit of its value.
    pub unit: Unit,
    /// Whether it is smooth along a family of orbits.
    pub is_smooth: bool,
}

/// What names stand for; own outputs are told of once they are read.
pub trait Names {
    /// What a name stands for; nothing where something in it is wrong, which is told there.
    ///
    /// # Errors
    /// The nearest names that there are, where there is none such.
    fn named(&mut self, name: &str) -> Result<Option<Named>, Vec<String>>;
}

/// What reads expressions, and notes what is wrong in them.
pub struct Lowering<'n, 's, 'a> {
    pub source: &'s Source<'a>,
    pub names: &'n mut dyn Names,
}

impl Lowering<'_, '_, '_> {
    /// What computes an expression, in the unit that it has; none where something in it is wrong.
    pub fn of(&mut self, expression: &Expression) -> Option<Named> {
        match &expression.kind {
            Kind::Number(number) => Some(plain(Node::Number(*number))),
            Kind::Name(name) => self.named(name, expression.at.start),
            Kind::Minus(of) => {
                let of = self.of(of)?;
                Some(Named { node: Node::Minus(Box::new(of.node)), ..of })
            }
            Kind::Joined(operator, sides) => {
                let [left, right] = sides.each_ref().map(|it| self.of(it));
                let (left, right) = (left?, right?);
                let at = sides[1].at.start;
                match operator {
                    Operator::Power => self.power(left, right, at),
                    Operator::Plus | Operator::Minus => {
                        let (left, right) = self.alike(left, right, at, "added")?;
                        Some(joined(*operator, left.unit.clone(), left, right))
                    }
                    Operator::Times => {
                        Some(joined(*operator, left.unit.times(&right.unit), left, right))
                    }
                    Operator::Over => {
                        Some(joined(*operator, left.unit.over(&right.unit), left, right))
                    }
                }
            }
            Kind::Call(name, arguments) => self.call(name, arguments, expression.at.start),
        }
    }

    fn named(&mut self, name: &str, at: usize) -> Option<Named> {
        match self.names.named(name) {
            Ok(found) => found,
            Err(_) if name == "pi" => Some(plain(Node::Number(std::f64::consts::PI))),
            Err(_) if Unit::is_known(name) => {
                Some(Named { unit: Unit::of(name), ..plain(Node::Number(1.0)) })
            }
            Err(known) => {
                self.source.fault(at, format!("nothing is called {name:?}{}", hint(name, &known)));
                None
            }
        }
    }

    /// A power. That of a value with a unit has a number as its exponent, by which the unit is known.
    fn power(&mut self, base: Named, exponent: Named, at: usize) -> Option<Named> {
        let number = number_of(&exponent.node);
        match number.filter(|_| exponent.unit.is_number()) {
            Some(number) => {
                let unit = base.unit.power(number);
                Some(joined(Operator::Power, unit, base, exponent))
            }
            None => {
                let base = self.number(base, at, "what is raised to a power that is no number")?;
                let exponent = self.number(exponent, at, "an exponent")?;
                Some(joined(Operator::Power, Unit::one(), base, exponent))
            }
        }
    }

    /// Two values in the unit of the first; zero has any.
    fn alike(
        &mut self,
        left: Named,
        right: Named,
        at: usize,
        what: &str,
    ) -> Option<(Named, Named)> {
        let is_zero = |it: &Named| it.node == Node::Number(0.0) && it.unit.is_number();
        if is_zero(&left) {
            return Some((Named { unit: right.unit.clone(), ..left }, right));
        }
        if is_zero(&right) {
            return Some((left, right));
        }
        let Some(right_alike) = in_unit(right.clone(), &left.unit) else {
            let [a, b] = [&left, &right].map(|it| told(&it.unit));
            self.source.fault(at, format!("{a} and {b} cannot be {what}"));
            return None;
        };
        Some((left, right_alike))
    }

    /// A value as a plain number, which it has to be.
    fn number(&mut self, value: Named, at: usize, what: &str) -> Option<Named> {
        let unit = told(&value.unit);
        let found = in_unit(value, &Unit::one());
        if found.is_none() {
            self.source.fault(at, format!("{what} must be a plain number or an angle, not {unit}"));
        }
        found
    }

    fn call(&mut self, name: &str, arguments: &[Expression], at: usize) -> Option<Named> {
        let values: Vec<Option<Named>> = arguments.iter().map(|it| self.of(it)).collect();
        let of_two = [("max", Choice::Greater), ("min", Choice::Lesser)];
        let choice = of_two.iter().find(|it| it.0 == name);
        let function = Function::NAMES.iter().find(|it| it.0 == name);
        let wanted = if choice.is_some() { 2 } else { 1 };
        if choice.is_none() && function.is_none() {
            let names = of_two.iter().map(|it| it.0).chain(Function::NAMES.map(|it| it.0));
            let names: Vec<&str> = names.collect();
            let message = format!("there is no function {name:?}{}", hint(name, names));
            self.source.fault(at, message);
            return None;
        }
        if values.len() != wanted {
            let message = format!("{name} is of {wanted} values, not of {}", values.len());
            self.source.fault(at, message);
            return None;
        }
        let mut values = values.into_iter().collect::<Option<Vec<Named>>>()?.into_iter();
        let first = values.next()?;
        match (choice, function) {
            (Some((_, choice)), _) => {
                let at = arguments[1].at.start;
                let (left, right) = self.alike(first, values.next()?, at, "compared")?;
                let (unit, both) = (left.unit, Box::new([left.node, right.node]));
                Some(Named { node: Node::Chosen(*choice, both), unit, is_smooth: false })
            }
            (_, Some((_, function))) => {
                let place = arguments[0].at.start;
                let of = match function {
                    Function::Sqrt | Function::Abs => first,
                    _ => self.number(first, place, &format!("what {name} is of"))?,
                };
                let unit = match function {
                    Function::Sqrt => of.unit.power(0.5),
                    _ => of.unit,
                };
                Some(Named { node: Node::Of(*function, Box::new(of.node)), unit, ..of })
            }
            _ => None,
        }
    }
}

/// A value that is a plain number.
fn plain(node: Node) -> Named {
    Named { node, unit: Unit::one(), is_smooth: true }
}

fn joined(operator: Operator, unit: Unit, left: Named, right: Named) -> Named {
    let is_smooth = left.is_smooth && right.is_smooth;
    Named { node: Node::Joined(operator, Box::new([left.node, right.node])), unit, is_smooth }
}

/// The number that a value is.
fn number_of(node: &Node) -> Option<f64> {
    match node {
        Node::Number(number) => Some(*number),
        Node::Minus(of) => number_of(of).map(|it| -it),
        Node::Joined(Operator::Over, sides) => Some(number_of(&sides[0])? / number_of(&sides[1])?),
        _ => None,
    }
}

/// The same value in another unit; none where that is of another kind.
pub fn in_unit(value: Named, unit: &Unit) -> Option<Named> {
    let ratio = value.unit.ratio(unit)?;
    let node = match ratio {
        1.0 => value.node,
        _ => Node::Joined(Operator::Times, Box::new([value.node, Node::Number(ratio)])),
    };
    Some(Named { node, unit: unit.clone(), ..value })
}

/// A unit in words.
pub fn told(unit: &Unit) -> String {
    match unit.is_number() {
        true => "a plain number".to_owned(),
        false => unit.in_fewest(),
    }
}
