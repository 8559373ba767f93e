//! A value as a sum of scaled terms and a constant, so that one instruction computes it.

use crate::text::graph::{Graph, Id, Level, Node};

/// A sum of scaled terms.
pub(crate) struct Terms {
    /// Each with its factor, which does not move, and what it is a factor of, which does.
    pub(crate) each: Vec<(Id, Id)>,
    /// What is added, which does not move; the number zero where nothing is.
    pub(crate) constant: Id,
}

impl Terms {
    /// Those of a value that moves; what `is_whole` stays a term by itself, be it a sum or not.
    pub(crate) fn of(graph: &mut Graph, id: Id, is_whole: impl Fn(Id) -> bool) -> Terms {
        let mut terms = Terms { each: Vec::new(), constant: graph.number(0.0) };
        let one = graph.number(1.0);
        // What is left to be taken apart, the first at the end: texts may be deep.
        let mut left = vec![(one, id)];
        while let Some((factor, part)) = left.pop() {
            if graph.level(part) != Level::Motion {
                let more = graph.mul(factor, part);
                terms.constant = graph.add(terms.constant, more);
                continue;
            }
            if part != id && (is_whole(part) || is_distance(graph, part)) {
                terms.add(graph, factor, part);
                continue;
            }
            match graph.node(part) {
                Node::Add(a, b) => left.extend([(factor, b), (factor, a)]),
                Node::Sub(a, b) => left.extend([(graph.neg(factor), b), (factor, a)]),
                Node::Neg(a) => left.push((graph.neg(factor), a)),
                Node::Mul(a, b) if graph.level(a) != Level::Motion => {
                    left.push((graph.mul(factor, a), b));
                }
                Node::Mul(a, b) if graph.level(b) != Level::Motion => {
                    left.push((graph.mul(factor, b), a));
                }
                _ => terms.add(graph, factor, part),
            }
        }
        terms
    }

    /// Adds a term to those of the same value.
    fn add(&mut self, graph: &mut Graph, factor: Id, of: Id) {
        match self.each.iter_mut().find(|it| it.1 == of) {
            Some((known, _)) => *known = graph.add(*known, factor),
            None => self.each.push((factor, of)),
        }
    }
}

/// Whether a value is how far a state is from a place, which is not taken apart: where both are near, it is small beside either.
fn is_distance(graph: &Graph, id: Id) -> bool {
    let is_state = |id: Id| matches!(graph.node(id), Node::State(_));
    let stays = |id: Id| graph.level(id) != Level::Motion;
    match graph.node(id) {
        Node::Add(a, b) | Node::Sub(a, b) => is_state(a) && stays(b) || stays(a) && is_state(b),
        _ => false,
    }
}
