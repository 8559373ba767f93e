//! Which values grow evenly in time, as the argument of a harmonic drive does.

use std::collections::HashMap;

use crate::text::graph::{Graph, Id, Level, Node};

impl Graph {
    /// A value that grows evenly in time: what it is at time 0, and its rate; none where it is not one.
    pub fn line(&mut self, id: Id) -> Option<[Id; 2]> {
        self.line_by(id, &mut HashMap::new())
    }

    fn line_by(&mut self, id: Id, known: &mut HashMap<Id, Option<[Id; 2]>>) -> Option<[Id; 2]> {
        if let Some(known) = known.get(&id) {
            return *known;
        }
        let found = self.found_line(id, known);
        known.insert(id, found);
        found
    }

    fn found_line(&mut self, id: Id, known: &mut HashMap<Id, Option<[Id; 2]>>) -> Option<[Id; 2]> {
        let zero = self.number(0.0);
        if self.level(id) != Level::Motion {
            return Some([id, zero]);
        }
        match self.node(id) {
            Node::Time => Some([zero, self.number(1.0)]),
            Node::Add(a, b) => {
                let ([a, of_a], [b, of_b]) = (self.line_by(a, known)?, self.line_by(b, known)?);
                Some([self.add(a, b), self.add(of_a, of_b)])
            }
            Node::Sub(a, b) => {
                let ([a, of_a], [b, of_b]) = (self.line_by(a, known)?, self.line_by(b, known)?);
                Some([self.sub(a, b), self.sub(of_a, of_b)])
            }
            Node::Neg(a) => {
                let [a, of_a] = self.line_by(a, known)?;
                Some([self.neg(a), self.neg(of_a)])
            }
            Node::Mul(a, b) => {
                let (by, of) = if self.level(a) == Level::Motion { (b, a) } else { (a, b) };
                if self.level(by) == Level::Motion {
                    return None;
                }
                let [of, rate] = self.line_by(of, known)?;
                Some([self.mul(by, of), self.mul(by, rate)])
            }
            _ => None,
        }
    }
}
