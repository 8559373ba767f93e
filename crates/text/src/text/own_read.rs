//! The definitions of own outputs, each read once those that it uses are.

use std::collections::BTreeMap;

use strsim::damerau_levenshtein;

use capsulemap_models::description::Description;
use capsulemap_models::quantity::printable::is_obeyed;

use crate::text::entries::{Entry, needed};
use crate::text::expression::{Expression, Kind, expression, is_name};
use crate::text::function::Function;
use crate::text::names::OF_TWO;
use crate::text::own_expression::{Lowering, Named, Names, in_unit, told};
use crate::text::own_value::{Node, OwnValues};
use crate::text::unit::Unit;
use crate::text::written::{Source, Written};

/// Own outputs of a study at most.
const MOST: usize = 100;
/// Names that a message lists at most.
const MOST_LISTED: usize = 10;

/// What is said of an own output.
#[derive(Debug)]
pub struct Own {
    /// Its name.
    pub name: String,
    /// Its expression, on one line.
    pub expression: String,
    /// What it is, where that is said.
    pub meaning: Option<String>,
    /// Its unit as files have it.
    pub unit: String,
    /// Whether it is smooth along a family of orbits.
    pub is_smooth: bool,
}

/// A definition before it is known what its names stand for.
struct Begun {
    name: String,
    at: usize,
    written: Option<Written>,
    read: Option<Expression>,
    unit: Option<String>,
    meaning: Option<String>,
}

/// What the names in definitions stand for.
struct Meanings<'r> {
    model: &'static Description,
    begun: &'r [Begun],
    /// The own outputs that are read by their places, nothing where something in one is wrong.
    done: BTreeMap<usize, Option<Named>>,
    /// The own output that is being read.
    place: usize,
    /// The parameters that are used, each with the own output that does.
    parameters: BTreeMap<usize, usize>,
}

/// Reads all definitions; none where something in one is wrong.
pub(crate) fn read_all<'a>(
    source: &Source<'a>,
    model: &'static Description,
    entries: &[Entry<'_, 'a>],
) -> Option<(Vec<Own>, OwnValues)> {
    if let Some(it) = entries.get(MOST) {
        source.fault(it.at, format!("more than {MOST} own outputs"));
        return None;
    }
    let begun: Vec<Begun> = entries.iter().map(|it| begin(source, model, it)).collect();
    let mut meanings = Meanings {
        model,
        begun: &begun,
        done: BTreeMap::new(),
        place: 0,
        parameters: BTreeMap::new(),
    };
    let order = meanings.read_in_order(source);
    let Meanings { mut done, parameters, .. } = meanings;
    let (mut own, mut nodes) = (Vec::new(), Vec::new());
    for (place, it) in begun.iter().enumerate() {
        let Named { node, unit, is_smooth } = done.remove(&place)??;
        let characters = it.written.as_ref()?.characters.split_whitespace();
        own.push(Own {
            name: it.name.clone(),
            expression: characters.collect::<Vec<_>>().join(" "),
            meaning: it.meaning.clone(),
            unit: written(it.unit.as_deref(), &unit),
            is_smooth,
        });
        nodes.push(node);
    }
    let used = parameters.into_iter().map(|(place, by)| (place, begun[by].name.clone()));
    Some((own, OwnValues { nodes, order, parameters: used.collect() }))
}

/// What stands in an entry.
fn begin<'a>(source: &Source<'a>, model: &'static Description, it: &Entry<'_, 'a>) -> Begun {
    check_name(source, model, it);
    let (written, [unit, meaning]) = match it.value.get_ref().as_table() {
        None => (source.expression(it.value, &it.name), [None, None]),
        Some(table) => {
            source.only(
                table,
                &format!("[outputs.own.{}]", it.name),
                &["value", "unit", "meaning"],
            );
            let texts = ["unit", "meaning"].map(|key| {
                let string = source.string(table.get(key)?, key)?;
                if !is_one_line(&string.characters) {
                    source.fault(string.at, format!("{key} must be one line, and not empty"));
                }
                Some(string.characters)
            });
            (needed(source, table, it, "value"), texts)
        }
    };
    let read = written.as_ref().and_then(|written| {
        let read = expression(&written.characters, written.at);
        read.map_err(|misread| source.misread(misread)).ok()
    });
    Begun { name: it.name.clone(), at: it.at, written, read, unit, meaning }
}

/// Notes a name that an own output cannot have.
fn check_name(source: &Source<'_>, model: &'static Description, it: &Entry<'_, '_>) {
    let name = it.name.as_str();
    let functions = Function::NAMES.iter().map(|it| it.0).chain(OF_TWO);
    let has_meaning = functions.chain(["pi"]).any(|it| it == name);
    let choices = model.choices.iter().map(|it| it.name);
    if !is_name(name) {
        let message = format!("{name:?} is no name: letters, digits and _, no digit first");
        source.fault(it.at, message);
    } else if has_meaning {
        source.fault(it.at, format!("{name:?} has a meaning in every expression already"));
    } else if model.names().into_iter().chain(choices).any(|it| it == name) {
        let message = format!("the model {} has something called {name:?} already", model.name);
        source.fault(it.at, message);
    }
}

impl Meanings<'_> {
    /// Reads each definition after those that it uses; returns them in that order, without those in a circle, which are noted.
    fn read_in_order(&mut self, source: &Source<'_>) -> Vec<usize> {
        let mut order = Vec::new();
        while order.len() < self.begun.len() {
            let all = 0..self.begun.len();
            let mut waiting = all.filter(|place| !order.contains(place));
            match waiting.clone().find(|place| self.waits_for(*place).is_none()) {
                Some(place) => {
                    self.place = place;
                    let found = self.read(source, place);
                    self.done.insert(place, found);
                    order.push(place);
                }
                None => {
                    let circle = self.circle(waiting.next().expect("one waits"));
                    let names: Vec<&str> =
                        circle.iter().map(|it| self.begun[*it].name.as_str()).collect();
                    let message = match names[..] {
                        [one] => format!("{one} is defined by itself"),
                        _ => format!("defined in a circle: {}, {}", names.join(", "), names[0]),
                    };
                    source.fault(self.begun[circle[0]].at, message);
                    order.extend(&circle);
                    self.done.extend(circle.into_iter().map(|place| (place, None)));
                }
            }
        }
        order
    }

    fn read(&mut self, source: &Source<'_>, place: usize) -> Option<Named> {
        let begun = self.begun;
        let Begun { name, read, written, unit, .. } = &begun[place];
        let found = Lowering { source, names: self }.of(read.as_ref()?)?;
        let wanted = unit.as_ref().map_or_else(|| found.unit.of_si(), |it| Unit::of(it));
        let shown = told(&found.unit);
        let in_wanted = in_unit(found, &wanted);
        if in_wanted.is_none() {
            let at = written.as_ref().map_or(0, |it| it.at);
            source.fault(at, format!("{name} is {shown}, not {}", told(&wanted)));
        }
        in_wanted
    }

    /// The first own output that one uses and that is not read yet.
    fn waits_for(&self, place: usize) -> Option<usize> {
        let mut names = Vec::new();
        names_in(self.begun[place].read.as_ref()?, &mut names);
        let places = names.into_iter().filter_map(|name| self.own(name));
        places.filter(|it| !self.done.contains_key(it)).min()
    }

    /// Own outputs of which each uses the next, and the last the first, found from one of those that wait.
    fn circle(&self, from: usize) -> Vec<usize> {
        let mut path = vec![from];
        loop {
            let next = self.waits_for(path[path.len() - 1]).expect("each of them waits");
            if let Some(begins) = path.iter().position(|it| *it == next) {
                return path.split_off(begins);
            }
            path.push(next);
        }
    }

    /// The place of the own output called so.
    fn own(&self, name: &str) -> Option<usize> {
        self.begun.iter().position(|it| it.name == name)
    }

    /// The names that there are that are nearest to one.
    fn nearest(&self, name: &str) -> Vec<String> {
        let outputs = self.model.outputs.iter().map(|it| it.quantity.name);
        let parameters = self.model.parameters.iter().map(|it| it.quantity.name);
        let own = self.begun.iter().map(|it| it.name.as_str());
        let mut names: Vec<&str> = outputs.chain(parameters).chain(own).collect();
        names.sort_by_key(|it| (!it.contains(name), damerau_levenshtein(name, it)));
        let others = names.len().saturating_sub(MOST_LISTED);
        let mut nearest: Vec<String> =
            names.into_iter().take(MOST_LISTED).map(Into::into).collect();
        if others > 0 {
            nearest.push(format!("{others} other outputs and parameters, or a unit"));
        }
        nearest
    }
}

impl Names for Meanings<'_> {
    fn named(&mut self, name: &str) -> Result<Option<Named>, Vec<String>> {
        if let Some(place) = self.own(name) {
            let found = self.done.get(&place).cloned().flatten();
            let node = Node::Output(self.model.outputs.len() + place);
            return Ok(found.map(|it| Named { node, ..it }));
        }
        if let Some(output) = self.model.output(name) {
            let (node, unit) = (Node::Output(output.index()), Unit::of(output.unit()));
            return Ok(Some(Named { node, unit, is_smooth: output.is_smooth() }));
        }
        let Some(parameter) = self.model.parameter(name) else { return Err(self.nearest(name)) };
        self.parameters.entry(parameter.index()).or_insert(self.place);
        let (node, unit) =
            (Node::Parameter(parameter.index()), Unit::of(parameter.dimension().unit()));
        Ok(Some(Named { node, unit, is_smooth: true }))
    }
}

/// The names that an expression uses.
fn names_in<'e>(expression: &'e Expression, names: &mut Vec<&'e str>) {
    match &expression.kind {
        Kind::Number(_) => {}
        Kind::Name(name) => names.push(name),
        Kind::Minus(of) => names_in(of, names),
        Kind::Joined(_, sides) => sides.iter().for_each(|it| names_in(it, names)),
        Kind::Call(_, arguments) => arguments.iter().for_each(|it| names_in(it, names)),
    }
}

/// The unit of an own output as it is written in files: that which is given, or that of the SI.
fn written(given: Option<&str>, unit: &Unit) -> String {
    given.map_or_else(|| unit.in_fewest(), |it| it.trim().to_owned())
}

/// Whether a text can stand in a label: it is one line, without what a terminal obeys.
fn is_one_line(text: &str) -> bool {
    !text.trim().is_empty() && !text.contains(is_obeyed)
}
