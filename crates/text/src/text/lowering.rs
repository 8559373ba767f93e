//! From values of the graph to instructions: which registers there are, and what is fused.

use std::collections::HashMap;

use crate::text::content::{Bound, Text};
use crate::text::function::Function;
use crate::text::graph::{Graph, Id, Level, Node};
use crate::text::instructions::{
    FrictionPlaces, Instruction, MOST_TERMS, Place, Register, Scalar, ScalarStep, SeriesStep, Sum,
};
use crate::text::terms::Terms;

/// Instructions that are being made.
pub(crate) struct Making {
    graph: Graph,
    frictions: Vec<(Id, Id)>,
    /// How often a value is used by others.
    uses: Vec<usize>,
    places: HashMap<Id, Place>,
    /// What computes the numbers.
    pub(crate) scalars: Vec<ScalarStep>,
    /// Which of them change with the mode.
    pub(crate) of_mode: Vec<Scalar>,
    /// What computes the series.
    pub(crate) series: Vec<Instruction>,
    /// How many registers there are.
    pub(crate) registers: usize,
    /// Series that may grow within a step from below the rounding of others.
    pub(crate) growing: Vec<Register>,
}

impl Making {
    pub(crate) fn new(text: &Text) -> Self {
        let mut graph = text.graph.clone();
        let states = (0..text.states.len()).map(|it| (graph.leaf(Node::State(it)), it));
        let places = states.map(|(id, state)| (id, Place::Series(state))).collect();
        Making {
            uses: uses(&graph, text),
            graph,
            frictions: text.frictions.iter().map(|it| (it.sliding, it.at_rest)).collect(),
            places,
            scalars: Vec::new(),
            of_mode: Vec::new(),
            series: Vec::new(),
            registers: text.states.len(),
            growing: Vec::new(),
        }
    }

    pub(crate) fn place(&mut self, id: Id) -> Place {
        match self.graph.level(id) {
            Level::Motion => Place::Series(self.register(id)),
            _ => Place::Scalar(self.scalar(id)),
        }
    }

    pub(crate) fn bound(&mut self, bound: Option<Bound>) -> Option<(usize, Scalar)> {
        bound.map(|it| (it.state, self.scalar(it.value)))
    }

    pub(crate) fn friction(&mut self, text: &Text, place: usize) -> FrictionPlaces {
        let it = &text.frictions[place];
        let mut factors = it.linear.factors.clone();
        let size = |factor: &(usize, Id)| text.value_at_defaults(factor.1).abs();
        let largest =
            (0..factors.len()).max_by(|a, b| size(&factors[*a]).total_cmp(&size(&factors[*b])));
        let leading = factors.swap_remove(largest.expect("a friction is of a state"));
        FrictionPlaces {
            of: self.place(it.of),
            sliding: self.place(it.sliding),
            holds: self.place(it.holds),
            at_rest: self.place(it.at_rest),
            leading: (leading.0, self.scalar(leading.1)),
            others: factors.iter().map(|it| (it.0, self.scalar(it.1))).collect(),
        }
    }

    /// The place of a value that is no series.
    pub(crate) fn scalar(&mut self, id: Id) -> Scalar {
        if let Some(Place::Scalar(known)) = self.places.get(&id) {
            return *known;
        }
        let step = match self.graph.node(id) {
            Node::Number(bits) => ScalarStep::Number(f64::from_bits(bits)),
            Node::Parameter(place) => ScalarStep::Parameter(place),
            Node::Switch(place) => ScalarStep::Switch(place),
            Node::Pulse(place) => ScalarStep::Pulse(place),
            Node::Sign(place) => ScalarStep::Sign(place),
            Node::Add(a, b) => ScalarStep::Add(self.scalar(a), self.scalar(b)),
            Node::Sub(a, b) => ScalarStep::Sub(self.scalar(a), self.scalar(b)),
            Node::Mul(a, b) => ScalarStep::Mul(self.scalar(a), self.scalar(b)),
            Node::Div(a, b) => ScalarStep::Div(self.scalar(a), self.scalar(b)),
            Node::Neg(a) => ScalarStep::Neg(self.scalar(a)),
            Node::Of(function, a) => ScalarStep::Of(function, self.scalar(a)),
            Node::Max(a, b) => ScalarStep::Max(self.scalar(a), self.scalar(b)),
            Node::Min(a, b) => ScalarStep::Min(self.scalar(a), self.scalar(b)),
            Node::Measured(_) => unreachable!("the motion needs nothing that is measured of it"),
            Node::State(_) | Node::Time | Node::Friction(_) => unreachable!("these are series"),
        };
        let place = self.scalars.len();
        self.scalars.push(step);
        if self.graph.level(id) == Level::Mode {
            self.of_mode.push(place);
        }
        self.places.insert(id, Place::Scalar(place));
        place
    }

    /// The register of a value that is a series, or of a constant as one.
    fn register(&mut self, id: Id) -> Register {
        if let Some(Place::Series(known)) = self.places.get(&id) {
            return *known;
        }
        if self.graph.level(id) != Level::Motion {
            // As a series it has no place of its own among the values, which know it as a number.
            let step = SeriesStep::Constant(self.scalar(id));
            return self.push(step);
        }
        let register = self.computed(id);
        self.places.insert(id, Place::Series(register));
        register
    }

    /// Computes a series that is not there yet.
    fn computed(&mut self, id: Id) -> Register {
        match self.graph.node(id) {
            Node::Time => self.push(SeriesStep::Time),
            Node::Friction(place) => {
                let (sliding, at_rest) = self.frictions[place];
                let (sliding, at_rest) = (self.register(sliding), self.register(at_rest));
                self.push(SeriesStep::Friction(place, sliding, at_rest))
            }
            Node::Add(..) | Node::Sub(..) | Node::Neg(_) => self.sum(id),
            Node::Mul(a, b) if !self.is_series(a) || !self.is_series(b) => self.sum(id),
            Node::Mul(a, b) if a == b => {
                let a = self.register(a);
                self.push(SeriesStep::Square(a))
            }
            Node::Mul(a, b) => {
                let (a, b) = (self.register(a), self.register(b));
                self.push(SeriesStep::Mul(a, b))
            }
            Node::Div(a, b) => {
                let (a, b) = (self.register(a), self.register(b));
                self.push_growing(SeriesStep::Div(a, b))
            }
            Node::Of(function, a) => self.function(function, a),
            _ => unreachable!("constants are no series"),
        }
    }

    /// Computes a sum of scaled terms; what others are of, too, is a term by itself.
    fn sum(&mut self, id: Id) -> Register {
        let (uses, places) = (&self.uses, &self.places);
        let is_whole = |it: Id| uses.get(it.index()) != Some(&1) || places.contains_key(&it);
        let Terms { each, constant } = Terms::of(&mut self.graph, id, is_whole);
        let constant = (self.graph.number_of(constant) != Some(0.0)).then(|| self.scalar(constant));
        let mut terms: Vec<(Factor, Register)> = Vec::new();
        for (factor, of) in each {
            let register = self.register(of);
            match self.graph.number_of(factor) {
                Some(0.0) => {}
                Some(1.0) => terms.push((Factor::One, register)),
                Some(-1.0) => terms.push((Factor::MinusOne, register)),
                _ => terms.push((Factor::Of(self.scalar(factor)), register)),
            }
        }
        self.sum_of(terms, constant)
    }

    /// Computes a sum of these terms by the shortest instruction that there is.
    fn sum_of(&mut self, mut terms: Vec<(Factor, Register)>, constant: Option<Scalar>) -> Register {
        use Factor::{MinusOne, Of, One};
        while terms.len() > MOST_TERMS {
            let rest = terms.split_off(MOST_TERMS);
            let sum = self.sum_of(terms, None);
            terms = [(One, sum)].into_iter().chain(rest).collect();
        }
        let step = match (&terms[..], constant) {
            ([(One, a)], None) => return *a,
            ([(MinusOne, a)], None) => SeriesStep::Neg(*a),
            ([(Of(s), a)], None) => SeriesStep::Scale(*s, *a),
            ([(One, a)], Some(s)) => SeriesStep::AddConstant(*a, s),
            ([(MinusOne, a)], Some(s)) => SeriesStep::FromConstant(s, *a),
            ([(One, a), (One, b)], None) => SeriesStep::Add(*a, *b),
            ([(One, a), (MinusOne, b)] | [(MinusOne, b), (One, a)], None) => {
                SeriesStep::Sub(*a, *b)
            }
            ([(One, a), (Of(s), b)] | [(Of(s), b), (One, a)], None) => {
                SeriesStep::AddScaled(*a, *s, *b)
            }
            ([(Of(s), a), (Of(r), b)], None) => SeriesStep::TwoScaled(*s, *a, *r, *b),
            _ => {
                let terms: Vec<(Scalar, Register)> =
                    terms.iter().map(|(factor, a)| (self.factor(*factor), *a)).collect();
                SeriesStep::Sum(Sum::new(&terms, constant))
            }
        };
        self.push(step)
    }

    /// The place of a factor.
    fn factor(&mut self, factor: Factor) -> Scalar {
        let value = match factor {
            Factor::Of(scalar) => return scalar,
            Factor::One => 1.0,
            Factor::MinusOne => -1.0,
        };
        let id = self.graph.number(value);
        self.scalar(id)
    }

    fn function(&mut self, function: Function, a: Id) -> Register {
        match function {
            Function::Sqrt => {
                let a = self.register(a);
                self.push_growing(SeriesStep::Sqrt(a))
            }
            Function::Exp => {
                let a = self.register(a);
                self.push_growing(SeriesStep::Exp(a))
            }
            Function::Log => {
                let a = self.register(a);
                self.push_growing(SeriesStep::Log(a))
            }
            Function::Tanh => {
                let a = self.register(a);
                let of = self.push_growing(SeriesStep::Tanh(a));
                self.growing.push(of + 1);
                of
            }
            Function::Sin | Function::Cos => self.sine_or_cosine(function, a),
            Function::Abs => unreachable!("it is of constants alone"),
        }
    }

    /// The sine or the cosine of a series, of which both are computed.
    fn sine_or_cosine(&mut self, function: Function, a: Id) -> Register {
        let step = match self.graph.line(a) {
            Some([start, rate]) => SeriesStep::Rotation(self.scalar(start), self.scalar(rate)),
            None => SeriesStep::SinCos(self.register(a)),
        };
        let sine = self.push(step);
        for (place, other) in [Function::Sin, Function::Cos].into_iter().enumerate() {
            let id = self.graph.leaf(Node::Of(other, a));
            self.places.insert(id, Place::Series(sine + place));
        }
        if function == Function::Sin { sine } else { sine + 1 }
    }

    fn is_series(&self, id: Id) -> bool {
        self.graph.level(id) == Level::Motion
    }

    fn push(&mut self, step: SeriesStep) -> Register {
        let register = self.registers;
        self.registers += step.registers();
        let (folds, is_pair) = (step.folds(), step.registers() == 2);
        self.series.push(Instruction { register, step, is_kept: true, folds, is_pair });
        register
    }

    fn push_growing(&mut self, step: SeriesStep) -> Register {
        let register = self.push(step);
        self.growing.push(register);
        register
    }
}

/// The factor of a term.
#[derive(Debug, Clone, Copy)]
enum Factor {
    One,
    MinusOne,
    Of(Scalar),
}

/// How often each value is used by what the motion needs.
fn uses(graph: &Graph, text: &Text) -> Vec<usize> {
    let mut uses = vec![0; graph.len()];
    let mut waiting = text.roots();
    while let Some(id) = waiting.pop() {
        uses[id.index()] += 1;
        if uses[id.index()] == 1 {
            waiting.extend(graph.parts(id));
        }
    }
    uses
}
