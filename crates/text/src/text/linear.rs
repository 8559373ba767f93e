//! What a value is as a function of others that it is linear in.

use std::collections::HashMap;

use crate::text::graph::{Graph, Id, Level, Node};

/// A value as a sum: constant factors times states, and a constant.
#[derive(Debug, Clone, PartialEq)]
pub struct Linear {
    /// The states by their places, each with its factor; none twice.
    pub factors: Vec<(usize, Id)>,
    /// What is left.
    pub constant: Id,
}

/// A value as a linear function of the states with constants for factors; none where it is not one.
pub fn linear(graph: &mut Graph, id: Id) -> Option<Linear> {
    LinearForms::default().of(graph, id)
}

/// Linear forms of values that are known already, as a value may be used many times.
#[derive(Debug, Default)]
struct LinearForms {
    known: HashMap<Id, Option<Linear>>,
}

impl LinearForms {
    fn of(&mut self, graph: &mut Graph, id: Id) -> Option<Linear> {
        if let Some(known) = self.known.get(&id) {
            return known.clone();
        }
        let found = self.found(graph, id);
        self.known.insert(id, found.clone());
        found
    }

    fn found(&mut self, graph: &mut Graph, id: Id) -> Option<Linear> {
        let zero = graph.number(0.0);
        if graph.level(id) == Level::Case {
            return Some(Linear { factors: Vec::new(), constant: id });
        }
        match graph.node(id) {
            Node::State(place) => {
                let one = graph.number(1.0);
                Some(Linear { factors: vec![(place, one)], constant: zero })
            }
            Node::Add(a, b) => {
                let [a, b] = [self.of(graph, a)?, self.of(graph, b)?];
                Some(sum(graph, a, b))
            }
            Node::Sub(a, b) => {
                let [a, b] = [self.of(graph, a)?, self.of(graph, b)?];
                let less = scaled(b, |it| graph.neg(it));
                Some(sum(graph, a, less))
            }
            Node::Neg(a) => {
                let a = self.of(graph, a)?;
                Some(scaled(a, |it| graph.neg(it)))
            }
            Node::Mul(a, b) => {
                let (constant, of) = if graph.level(a) == Level::Case { (a, b) } else { (b, a) };
                if graph.level(constant) != Level::Case {
                    return None;
                }
                let of = self.of(graph, of)?;
                Some(scaled(of, |it| graph.mul(constant, it)))
            }
            _ => None,
        }
    }
}

fn scaled(of: Linear, mut by: impl FnMut(Id) -> Id) -> Linear {
    let factors = of.factors.into_iter().map(|(place, factor)| (place, by(factor))).collect();
    Linear { factors, constant: by(of.constant) }
}

fn sum(graph: &mut Graph, a: Linear, b: Linear) -> Linear {
    let mut factors = a.factors;
    for (place, factor) in b.factors {
        match factors.iter_mut().find(|it| it.0 == place) {
            Some(known) => known.1 = graph.add(known.1, factor),
            None => factors.push((place, factor)),
        }
    }
    factors.retain(|(_, factor)| graph.number_of(*factor) != Some(0.0));
    Linear { factors, constant: graph.add(a.constant, b.constant) }
}

/// A value whose friction stands apart: what it is without, and the factor of the friction; the factor is none where it does not
/// depend on that.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Apart {
    /// The value where the friction is zero.
    pub without: Id,
    /// By what the friction is multiplied.
    pub factor: Option<Id>,
}

/// Takes a friction out of values that are linear in it.
#[derive(Debug, Default)]
pub struct TakenApart {
    known: HashMap<Id, Option<Apart>>,
}

impl TakenApart {
    /// A value with the friction at a place apart; none where it is not linear in that.
    pub fn of(&mut self, graph: &mut Graph, id: Id, friction: usize) -> Option<Apart> {
        if let Some(known) = self.known.get(&id) {
            return *known;
        }
        let found = self.found(graph, id, friction);
        self.known.insert(id, found);
        found
    }

    fn found(&mut self, graph: &mut Graph, id: Id, friction: usize) -> Option<Apart> {
        let node = graph.node(id);
        if node == Node::Friction(friction) {
            let (without, one) = (graph.number(0.0), graph.number(1.0));
            return Some(Apart { without, factor: Some(one) });
        }
        let parts = graph.parts(id);
        let mut apart = Vec::new();
        for part in parts {
            apart.push(self.of(graph, part, friction)?);
        }
        if apart.iter().all(|it| it.factor.is_none()) {
            return Some(Apart { without: id, factor: None });
        }
        match (node, &apart[..]) {
            (Node::Add(..), [a, b]) => {
                let without = graph.add(a.without, b.without);
                let factor = match [a.factor, b.factor] {
                    [Some(a), Some(b)] => Some(graph.add(a, b)),
                    [a, b] => a.or(b),
                };
                Some(Apart { without, factor })
            }
            (Node::Sub(..), [a, b]) => {
                let without = graph.sub(a.without, b.without);
                let factor = match [a.factor, b.factor] {
                    [Some(a), Some(b)] => Some(graph.sub(a, b)),
                    [a, b] => a.or_else(|| b.map(|it| graph.neg(it))),
                };
                Some(Apart { without, factor })
            }
            (Node::Neg(_), [a]) => {
                let without = graph.neg(a.without);
                Some(Apart { without, factor: a.factor.map(|it| graph.neg(it)) })
            }
            (Node::Mul(..), [a, b]) => {
                let (of, by) = if a.factor.is_some() { (a, b) } else { (b, a) };
                if by.factor.is_some() {
                    return None;
                }
                let without = graph.mul(of.without, by.without);
                Some(Apart { without, factor: of.factor.map(|it| graph.mul(it, by.without)) })
            }
            (Node::Div(..), [a, b]) if b.factor.is_none() => {
                let without = graph.div(a.without, b.without);
                Some(Apart { without, factor: a.factor.map(|it| graph.div(it, b.without)) })
            }
            _ => None,
        }
    }
}
