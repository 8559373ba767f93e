//! Whether the units of a text fit each other; where they do not it is told, and the text is taken as it is.

use std::collections::HashMap;

use toml::de::DeTable;

use crate::text::content::{Section, Text};
use crate::text::entries::{Parsed, Value, entries};
use crate::text::expression::{Expression, Kind, Operator, condition, expression};
use crate::text::fault::Fault;
use crate::text::unit::Unit;
use crate::text::written::{Source, Written};

/// The unit in which time is, unless nothing in a text has one.
const TIME: &str = "s";
/// Expressions and definitions, each within the next, at most, so that they need no more room than a thread has; of deeper ones
/// nothing is known.
const DEEPEST: usize = 300;

/// What is known of the unit of a value.
#[derive(Debug, Clone, PartialEq)]
enum Known {
    /// Nothing: a parameter without a unit may have any.
    Nothing,
    /// It is a number as it is written, which may have any unit in a sum, and none in a product.
    Number,
    /// It is this.
    Is(Unit),
}

impl Known {
    /// What a unit says that may be given.
    fn of(unit: Option<&String>) -> Self {
        unit.map_or(Known::Nothing, |it| Known::Is(Unit::of(it)))
    }
}

/// What does not fit in a text without faults, each with its place, in order of lines.
pub fn misfits<'a>(source: &Source<'a>, table: &DeTable<'a>, text: &Text) -> Vec<Fault> {
    let parsed = Parsed::of(source, table);
    let mut fitting = Fitting::begun(source, &parsed, text);
    fitting.all(&parsed, table, text);
    let mut misfits = fitting.misfits;
    misfits.sort_by_key(|it| (it.line, it.column));
    misfits.dedup();
    misfits
}

/// Units of names as far as they are known, and what has not fitted.
struct Fitting<'s, 'a> {
    source: &'s Source<'a>,
    names: HashMap<String, Known>,
    /// Definitions, and the sizes of frictions, by name.
    written: HashMap<String, Written>,
    time: Known,
    depth: usize,
    misfits: Vec<Fault>,
}

impl<'s, 'a> Fitting<'s, 'a> {
    fn begun(source: &'s Source<'a>, parsed: &Parsed<'_, 'a>, text: &Text) -> Self {
        let states = text.states.iter().map(|it| (&it.name, Some(&it.unit)));
        let parameters = text.parameters.iter().map(|it| (&it.name, it.unit.as_ref()));
        let mut names: HashMap<String, Known> =
            states.chain(parameters).map(|(name, unit)| (name.clone(), Known::of(unit))).collect();
        // Where all is plain numbers, time is one, too.
        let has_unit = names.values().any(|it| matches!(it, Known::Is(unit) if !unit.is_number()));
        let time = Known::Is(if has_unit { Unit::of(TIME) } else { Unit::one() });
        names.insert("t".into(), time.clone());
        names.insert("pi".into(), Known::Number);
        let numbers = parsed.switches.iter().chain(&parsed.pulses);
        names.extend(numbers.map(|it| (it.name.clone(), Known::Is(Unit::one()))));
        let definitions = parsed.definitions.iter().map(|it| (it, Some(it.value)));
        let frictions = parsed.frictions.iter().map(|it| {
            let table = it.value.get_ref().as_table();
            (it, table.and_then(|it| it.get("sliding")))
        });
        let written = definitions.chain(frictions).filter_map(|(it, value)| {
            Some((it.name.clone(), source.expression(value?, &it.name)?))
        });
        Fitting { source, names, written: written.collect(), time, depth: 0, misfits: Vec::new() }
    }

    /// Looks at everything that a text says.
    fn all(&mut self, parsed: &Parsed<'_, 'a>, table: &DeTable<'a>, text: &Text) {
        self.unknown_units(parsed, text);
        for it in &parsed.definitions {
            self.named(&it.name);
        }
        for it in &parsed.switches {
            self.condition(part(it.value, "where"));
        }
        for it in &parsed.frictions {
            self.value(part(it.value, "of"));
            let sliding = self.named(&it.name);
            self.expects(part(it.value, "holds"), &sliding, &format!("`holds` of {}", it.name));
        }
        for it in &parsed.pulses {
            self.expects(part(it.value, "period"), &self.time.clone(), "a period");
            self.expects(part(it.value, "duty"), &Known::Is(Unit::one()), "a share");
        }
        for it in entries(self.source, table, "rates") {
            let state = self.named(&it.name);
            let rate = self.joined(Operator::Over, &state, &self.time.clone());
            self.expects(Some(it.value), &rate, &format!("the rate of {}", it.name));
        }
        let events = table.get("events").and_then(|it| it.get_ref().as_array());
        for event in events.into_iter().flat_map(|it| it.iter()) {
            self.condition(part(event, "while"));
            let Some(event) = event.get_ref().as_table() else { continue };
            for it in entries(self.source, event, "reset") {
                let state = self.named(&it.name);
                self.expects(Some(it.value), &state, &format!("what becomes of {}", it.name));
            }
        }
        let key = if matches!(text.section, Section::Every(_)) { "every" } else { "within" };
        let section = table.get("section").and_then(|it| part(it, key));
        self.expects(section, &self.time.clone(), &format!("`{key}` of the section"));
        for (it, output) in parsed.outputs.iter().zip(&text.outputs) {
            let value = part(it.value, "value").unwrap_or(it.value);
            let unit = Known::of(output.unit.as_ref());
            let found = self.expects(Some(value), &unit, &format!("the output {}", it.name));
            let known = if unit == Known::Nothing { found } else { unit };
            self.names.insert(it.name.clone(), known);
        }
    }

    /// Tells names in units of which nothing is known.
    fn unknown_units(&mut self, parsed: &Parsed<'_, 'a>, text: &Text) {
        let states = parsed.states.iter().zip(text.states.iter().map(|it| Some(&it.unit)));
        let parameters = text.parameters.iter().map(|it| it.unit.as_ref());
        let parameters = parsed.parameters.iter().zip(parameters);
        let outputs = parsed.outputs.iter().zip(text.outputs.iter().map(|it| it.unit.as_ref()));
        for (it, unit) in states.chain(parameters).chain(outputs) {
            let Some(unit) = unit else { continue };
            for unknown in Unit::of(unit).unknown() {
                let name = &it.name;
                let message = format!(
                    "the unit of {name}: nothing is known of {unknown:?}, which counts as a unit of its own"
                );
                self.misfit(it.at, message);
            }
        }
    }

    fn misfit(&mut self, at: usize, message: String) {
        self.misfits.push(self.source.remark(at, message));
    }

    /// Looks at an expression, whose unit should be the one that is expected.
    fn expects(&mut self, value: Option<&Value<'a>>, expected: &Known, what: &str) -> Known {
        let Some(written) = value.and_then(|it| self.source.expression(it, what)) else {
            return Known::Nothing;
        };
        let found = self.written(&written);
        if let (Known::Is(found), Known::Is(expected)) = (&found, expected)
            && !found.fits(expected)
        {
            let (found, expected) = (found.written(), expected.written());
            self.misfit(written.at, format!("{what} is in {found}, not in {expected}"));
        }
        found
    }

    /// Looks at an expression.
    fn value(&mut self, value: Option<&Value<'a>>) -> Known {
        self.expects(value, &Known::Nothing, "a value")
    }

    /// Looks at a condition, whose sides should have one unit.
    fn condition(&mut self, value: Option<&Value<'a>>) {
        let written = value.and_then(|it| self.source.string(it, "a condition"));
        let Some(Written { characters, at }) = written else { return };
        let Ok(condition) = condition(&characters, at) else { return };
        let [greater, lesser] = condition.sides.each_ref().map(|it| self.of(it));
        self.sum(&greater, &lesser, at, "are compared");
    }

    fn written(&mut self, written: &Written) -> Known {
        let read = expression(&written.characters, written.at);
        read.map_or(Known::Nothing, |it| self.of(&it))
    }

    /// The unit of what a name stands for.
    fn named(&mut self, name: &str) -> Known {
        if let Some(known) = self.names.get(name) {
            return known.clone();
        }
        let Some(written) = self.written.get(name).cloned() else { return Known::Nothing };
        let known = self.written(&written);
        self.names.insert(name.to_owned(), known.clone());
        known
    }

    fn of(&mut self, expression: &Expression) -> Known {
        if self.depth == DEEPEST {
            return Known::Nothing;
        }
        self.depth += 1;
        let known = self.of_parts(expression);
        self.depth -= 1;
        known
    }

    fn of_parts(&mut self, expression: &Expression) -> Known {
        match &expression.kind {
            Kind::Number(_) => Known::Number,
            Kind::Name(name) => self.named(name),
            Kind::Minus(of) => self.of(of),
            Kind::Joined(Operator::Power, sides) => match (self.of(&sides[0]), number(&sides[1])) {
                (Known::Is(unit), Some(exponent)) => Known::Is(unit.power(exponent)),
                (Known::Number, _) => Known::Number,
                _ => Known::Nothing,
            },
            Kind::Joined(Operator::Plus | Operator::Minus, sides) => {
                let [left, right] = sides.each_ref().map(|it| self.of(it));
                self.sum(&left, &right, sides[1].at.start, "are added")
            }
            Kind::Joined(operator, sides) => {
                let [left, right] = sides.each_ref().map(|it| self.of(it));
                self.joined(*operator, &left, &right)
            }
            Kind::Call(name, arguments) => self.call(name, arguments),
        }
    }

    /// The unit of a sum, or of two sides of a condition.
    fn sum(&mut self, left: &Known, right: &Known, at: usize, what: &str) -> Known {
        match (left, right) {
            (Known::Is(a), Known::Is(b)) => {
                if !a.fits(b) {
                    self.misfit(at, format!("{} and {} {what}", a.written(), b.written()));
                    return Known::Nothing;
                }
                Known::Is(a.clone())
            }
            (Known::Is(unit), _) | (_, Known::Is(unit)) => Known::Is(unit.clone()),
            (Known::Number, Known::Number) => Known::Number,
            _ => Known::Nothing,
        }
    }

    /// The unit of a product or a quotient. A number that is a factor may turn one unit into another of another size.
    fn joined(&self, operator: Operator, left: &Known, right: &Known) -> Known {
        let is_over = operator == Operator::Over;
        match (left, right) {
            (Known::Nothing, _) | (_, Known::Nothing) => Known::Nothing,
            (Known::Number, Known::Number) => Known::Number,
            (Known::Is(a), Known::Number) => Known::Is(a.clone().of_any_size()),
            (Known::Number, Known::Is(b)) => {
                Known::Is(b.power(if is_over { -1.0 } else { 1.0 }).of_any_size())
            }
            (Known::Is(a), Known::Is(b)) => Known::Is(if is_over { a.over(b) } else { a.times(b) }),
        }
    }

    fn call(&mut self, name: &str, arguments: &[Expression]) -> Known {
        let units: Vec<Known> = arguments.iter().map(|it| self.of(it)).collect();
        let [first, others @ ..] = &units[..] else { return Known::Nothing };
        match (name, first) {
            ("sqrt", Known::Is(unit)) => Known::Is(unit.power(0.5)),
            ("sqrt" | "abs" | "mean" | "max" | "min", _) => {
                let at = arguments[arguments.len() - 1].at.start;
                let second = others.first().cloned();
                second.map_or(first.clone(), |it| self.sum(first, &it, at, "are compared"))
            }
            ("integral", _) => self.joined(Operator::Times, first, &self.time.clone()),
            ("count", _) => Known::Is(Unit::one()),
            (_, Known::Is(unit)) if !unit.is_number() => {
                let message =
                    format!("{name} is of a number or an angle, not of {}", unit.written());
                self.misfit(arguments[0].at.start, message);
                Known::Is(Unit::one())
            }
            _ => Known::Is(Unit::one()),
        }
    }
}

/// What stands under a key of a value that is a table.
fn part<'t, 'a>(value: &'t Value<'a>, key: &str) -> Option<&'t Value<'a>> {
    value.get_ref().as_table().and_then(|it| it.get(key))
}

/// The number that an expression is.
fn number(expression: &Expression) -> Option<f64> {
    match &expression.kind {
        Kind::Number(number) => Some(*number),
        Kind::Minus(of) => number(of).map(|it| -it),
        _ => None,
    }
}
