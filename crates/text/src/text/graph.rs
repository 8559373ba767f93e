//! The graph of all expressions of a text: each value stands once, and what is constant is known to be.

use std::collections::HashMap;

use crate::text::function::Function;

/// A value in the graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id(u32);

impl Id {
    /// Its place among the values.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// What a value is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Node {
    /// A number, by its bits.
    Number(u64),
    /// A parameter by its place.
    Parameter(usize),
    /// A state by its place.
    State(usize),
    /// Time since the start of the cycle.
    Time,
    /// A switch by its place: 1 on its side, else 0.
    Switch(usize),
    /// A pulse by its place: 1 while it lasts, else 0.
    Pulse(usize),
    /// The sign of the sliding of a friction by its place; 0 at rest.
    Sign(usize),
    /// A friction by its place.
    Friction(usize),
    /// What is measured of a motion that has settled, by its place.
    Measured(usize),
    /// A sum.
    Add(Id, Id),
    /// A difference.
    Sub(Id, Id),
    /// A product.
    Mul(Id, Id),
    /// A quotient.
    Div(Id, Id),
    /// The negative.
    Neg(Id),
    /// A function of one value.
    Of(Function, Id),
    /// The greater of two constants.
    Max(Id, Id),
    /// The lesser of two constants.
    Min(Id, Id),
}

/// How often a value changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Not within a case.
    Case,
    /// Only where a mode ends.
    Mode,
    /// At all times.
    Motion,
}

/// The values, each after those that it is of.
#[derive(Debug, Clone, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    levels: Vec<Level>,
    known: HashMap<Node, Id>,
}

impl Graph {
    /// What a value is of.
    pub fn node(&self, id: Id) -> Node {
        self.nodes[id.index()]
    }

    /// How often it changes.
    pub fn level(&self, id: Id) -> Level {
        self.levels[id.index()]
    }

    /// How many values there are.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The number that a value is, if it is one.
    pub fn number_of(&self, id: Id) -> Option<f64> {
        match self.node(id) {
            Node::Number(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// A number.
    pub fn number(&mut self, value: f64) -> Id {
        // Zero has one sign, so that values which are equal are one.
        self.put(Node::Number((value + 0.0).to_bits()))
    }

    /// A value that others are made of.
    pub fn leaf(&mut self, node: Node) -> Id {
        self.put(node)
    }

    /// a + b
    pub fn add(&mut self, a: Id, b: Id) -> Id {
        match [self.number_of(a), self.number_of(b)] {
            [Some(a), Some(b)] => self.number(a + b),
            [Some(0.0), _] => b,
            [_, Some(0.0)] => a,
            _ => self.put(Node::Add(a, b)),
        }
    }

    /// a - b
    pub fn sub(&mut self, a: Id, b: Id) -> Id {
        match [self.number_of(a), self.number_of(b)] {
            [Some(a), Some(b)] => self.number(a - b),
            [Some(0.0), _] => self.neg(b),
            [_, Some(0.0)] => a,
            _ if a == b => self.number(0.0),
            _ => self.put(Node::Sub(a, b)),
        }
    }

    /// a b
    pub fn mul(&mut self, a: Id, b: Id) -> Id {
        match [self.number_of(a), self.number_of(b)] {
            [Some(a), Some(b)] => self.number(a * b),
            [Some(0.0), _] | [_, Some(0.0)] => self.number(0.0),
            [Some(1.0), _] => b,
            [_, Some(1.0)] => a,
            [Some(-1.0), _] => self.neg(b),
            [_, Some(-1.0)] => self.neg(a),
            _ => self.product(a, b),
        }
    }

    /// A product of a factor that changes less often and another one, which has no such factor itself.
    fn product(&mut self, a: Id, b: Id) -> Id {
        let (factor, of) = if self.level(a) <= self.level(b) { (a, b) } else { (b, a) };
        if self.level(factor) == Level::Motion || self.level(of) != Level::Motion {
            return self.put(Node::Mul(a.min(b), a.max(b)));
        }
        match self.node(of) {
            Node::Mul(c, d) if self.level(c) != Level::Motion => {
                let both = self.mul(factor, c);
                self.mul(both, d)
            }
            Node::Mul(c, d) if self.level(d) != Level::Motion => {
                let both = self.mul(factor, d);
                self.mul(both, c)
            }
            Node::Neg(c) => {
                let less = self.neg(factor);
                self.mul(less, c)
            }
            _ => self.put(Node::Mul(factor, of)),
        }
    }

    /// a/b
    pub fn div(&mut self, a: Id, b: Id) -> Id {
        match [self.number_of(a), self.number_of(b)] {
            [Some(a), Some(b)] => self.number(a / b),
            [Some(0.0), _] => self.number(0.0),
            [_, Some(1.0)] => a,
            [_, Some(-1.0)] => self.neg(a),
            _ if self.level(a) == Level::Motion && self.level(b) != Level::Motion => {
                let one = self.number(1.0);
                let inverse = self.div(one, b);
                self.mul(inverse, a)
            }
            _ => self.put(Node::Div(a, b)),
        }
    }

    /// -a
    pub fn neg(&mut self, a: Id) -> Id {
        match self.node(a) {
            Node::Number(bits) => self.number(-f64::from_bits(bits)),
            Node::Neg(a) => a,
            Node::Sub(a, b) => self.sub(b, a),
            Node::Mul(c, d) if self.level(a) == Level::Motion && self.level(c) != Level::Motion => {
                let less = self.neg(c);
                self.mul(less, d)
            }
            _ => self.put(Node::Neg(a)),
        }
    }

    /// A whole power by products, which are valid for every base.
    pub fn power(&mut self, base: Id, exponent: u32) -> Id {
        match exponent {
            0 => self.number(1.0),
            1 => base,
            _ => {
                let half = self.power(base, exponent / 2);
                let square = self.mul(half, half);
                if exponent.is_multiple_of(2) { square } else { self.mul(square, base) }
            }
        }
    }

    /// A function of a value.
    pub fn function(&mut self, function: Function, a: Id) -> Id {
        match self.number_of(a) {
            Some(a) => self.number(function.value(a)),
            None => self.put(Node::Of(function, a)),
        }
    }

    /// The greater of two constants.
    pub fn max(&mut self, a: Id, b: Id) -> Id {
        match [self.number_of(a), self.number_of(b)] {
            [Some(a), Some(b)] => self.number(if a < b { b } else { a }),
            _ => self.put(Node::Max(a, b)),
        }
    }

    /// The lesser of two constants.
    pub fn min(&mut self, a: Id, b: Id) -> Id {
        match [self.number_of(a), self.number_of(b)] {
            [Some(a), Some(b)] => self.number(if b < a { b } else { a }),
            _ => self.put(Node::Min(a, b)),
        }
    }

    /// The constants where the parameters have these values by their places, in the order of the values; no numbers of others.
    pub fn constants(&self, parameter: &dyn Fn(usize) -> f64, measured: &[f64]) -> Vec<f64> {
        let mut values: Vec<f64> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let of = |id: Id| values[id.index()];
            values.push(match *node {
                Node::Number(bits) => f64::from_bits(bits),
                Node::Parameter(place) => parameter(place),
                Node::Measured(place) => measured.get(place).copied().unwrap_or(f64::NAN),
                Node::Add(a, b) => of(a) + of(b),
                Node::Sub(a, b) => of(a) - of(b),
                Node::Mul(a, b) => of(a) * of(b),
                Node::Div(a, b) => of(a) / of(b),
                Node::Neg(a) => -of(a),
                Node::Of(function, a) => function.value(of(a)),
                Node::Max(a, b) => of(a).max(of(b)),
                Node::Min(a, b) => of(a).min(of(b)),
                _ => f64::NAN,
            });
        }
        values
    }

    /// The values that a value is of.
    pub fn parts(&self, id: Id) -> Vec<Id> {
        match self.node(id) {
            Node::Add(a, b)
            | Node::Sub(a, b)
            | Node::Mul(a, b)
            | Node::Div(a, b)
            | Node::Max(a, b)
            | Node::Min(a, b) => vec![a, b],
            Node::Neg(a) | Node::Of(_, a) => vec![a],
            _ => Vec::new(),
        }
    }

    /// Whether a value is of another in the end, or is it.
    pub fn depends_on(&self, id: Id, of: Node) -> bool {
        let Some(&sought) = self.known.get(&of) else { return false };
        // Values stand after those that they are of.
        let mut depends = vec![false; self.nodes.len()];
        for at in 0..=id.index() {
            let here = Id(at as u32);
            depends[at] = here == sought || self.parts(here).iter().any(|it| depends[it.index()]);
        }
        depends[id.index()]
    }

    fn put(&mut self, node: Node) -> Id {
        if let Some(&id) = self.known.get(&node) {
            return id;
        }
        let id = Id(self.nodes.len() as u32);
        self.levels.push(self.level_of(node));
        self.nodes.push(node);
        self.known.insert(node, id);
        id
    }

    fn level_of(&self, node: Node) -> Level {
        match node {
            Node::Number(_) | Node::Parameter(_) | Node::Measured(_) => Level::Case,
            Node::Switch(_) | Node::Pulse(_) | Node::Sign(_) => Level::Mode,
            Node::State(_) | Node::Time | Node::Friction(_) => Level::Motion,
            Node::Add(a, b)
            | Node::Sub(a, b)
            | Node::Mul(a, b)
            | Node::Div(a, b)
            | Node::Max(a, b)
            | Node::Min(a, b) => self.level(a).max(self.level(b)),
            Node::Neg(a) | Node::Of(_, a) => self.level(a),
        }
    }
}
