//! The fronts of a trade-off: one for each set of conditions under which motions between the cases were sought, and direction.

use super::canvas::{Canvas, Dash, Stroke};
use super::error::FigureError;
use super::header::{Entry, Mark};
use super::panel::Panel;
use super::style::{CURVE_WIDTH, GREEN, INK, MINOR_WIDTH, PURPLE, VERMILION};
use super::symbol::{FASTEST, KNEE, LEAST, LEAST_PER_GAIN, MOST_GAIN, Symbol};
use super::text::Text;
use super::trade_off_motions::{Best, DIRECTIONS, Motions};
use super::view::View;
use crate::campaign::{KeptFront, RefinedMotion};
use crate::tradeoff::{Candidate, GainAndCost};

/// How fronts under conditions are drawn, one after the other.
const UNDER_CONDITIONS: [(plotters::style::RGBColor, Dash); 4] =
    [(GREEN, Dash::None), (PURPLE, Dash::None), (GREEN, Dash::Usual), (PURPLE, Dash::Usual)];

/// The front in each direction under some conditions.
pub struct Front<'a> {
    /// The motions that it is among.
    pub motions: Motions<'a>,
    /// The best in each direction.
    pub best: [Best; 2],
    /// What tells it from others in the table of optima; none of the front without conditions.
    pub letter: Option<char>,
    stroke: Stroke,
}

/// Price and gain shown per SI unit.
#[derive(Debug, Clone, Copy)]
pub struct Factors {
    /// Of the output that should be small.
    pub price: f64,
    /// Of the gain.
    pub gain: f64,
}

impl Factors {
    /// Those of a view with a gain and a cost.
    pub fn of(view: &View<'_>, of: GainAndCost) -> Factors {
        let [gain, price] = of.both().map(|it| view.quantity(it.name()).factor);
        Factors { price, gain }
    }

    /// Price and gain of a motion in the units of the figure.
    pub fn place(self, motion: &Candidate) -> (f64, f64) {
        (motion.price * self.price, motion.gain * self.gain)
    }

    /// Prices and gains (SI) in the units of the figure.
    pub fn places(self, points: &[(f64, f64)]) -> Vec<(f64, f64)> {
        points.iter().map(|(price, gain)| (price * self.price, gain * self.gain)).collect()
    }
}

impl<'a> Front<'a> {
    /// The fronts of a view over the axes `free`, with a gain and a cost: that without conditions first.
    ///
    /// Motions between the cases, which may lie anywhere along an axis, take part only where no axis is held.
    pub fn all(
        view: &View<'a>,
        of: GainAndCost,
        free: &[&str],
    ) -> Result<Vec<Front<'a>>, FigureError> {
        let is_whole = free.len() == view.axes().len();
        let refined = if is_whole { view.refined } else { &[] };
        let (alone, under): (Vec<&KeptFront>, Vec<&KeptFront>) =
            refined.iter().partition(|it| it.conditions.is_empty());
        let first = Motions::of(view, of, free, alone.first().copied())?;
        let mut fronts = vec![Front {
            best: DIRECTIONS.map(|direction| first.best(direction).shown(view)),
            motions: first,
            letter: None,
            stroke: Stroke::solid(VERMILION, CURVE_WIDTH),
        }];
        for ((letter, place), sought) in ('a'..='z').zip(0..).zip(under) {
            let motions = Motions::of(view, of, free, Some(sought))?;
            // In a direction in which nothing was sought there is nothing to tell.
            let best = DIRECTIONS.map(|direction| match sought.has_sought(direction) {
                true => motions.best(direction).shown(view),
                false => Best::none(direction),
            });
            let (colour, dash) = UNDER_CONDITIONS[place % UNDER_CONDITIONS.len()];
            let stroke = Stroke { dash, ..Stroke::solid(colour, CURVE_WIDTH) };
            fronts.push(Front { motions, best, letter: Some(letter), stroke });
        }
        Ok(fronts)
    }

    /// What a curve is called in a direction, with its conditions.
    fn called(&self, what: &str, best: &Best) -> String {
        let direction = best.direction.name();
        match self.motions.condition() {
            Some(condition) => format!("{what}, {direction}, where {condition}"),
            None => format!("{what}, {direction}"),
        }
    }

    /// Draws both directions with their optima.
    pub fn draw(&self, canvas: &mut Canvas, panel: &Panel, factors: Factors) {
        let of_cases = Stroke::solid(INK, MINOR_WIDTH);
        for best in &self.best {
            // That of all motions lies over that of the cases, which it is where no motion between them is better.
            let alone = Some((&best.front_of_cases, of_cases)).filter(|_| self.has_cases_alone());
            for (front, stroke) in alone.into_iter().chain([(&best.front, self.stroke)]) {
                let line = stairs(&factors.places(front));
                if line.len() > 1 {
                    panel.curve(canvas, &line, stroke);
                }
            }
        }
        for best in &self.best {
            let all = self.called("Pareto front", best);
            panel.record(canvas, &all, factors.places(&best.front));
            let alone = self.called("that of the cases alone", best);
            panel.record(canvas, &alone, factors.places(&best.front_of_cases));
            for (symbol, motion) in marked(&self.motions, best) {
                let (x, y) = factors.place(motion);
                if panel.holds(x, y) {
                    panel.record(canvas, &self.called(symbol.words, best), [(x, y)]);
                    symbol.draw(canvas, panel.place(x, y));
                }
            }
        }
    }

    /// Whether the front of the cases alone has a line of its own: only that without conditions, so that lines stay few.
    fn has_cases_alone(&self) -> bool {
        self.letter.is_none() && self.motions.between() > 0
    }

    /// Whether the search for one of its optima has not converged.
    pub fn has_open_optima(&self) -> bool {
        let optima = self.best.iter().flat_map(|best| marked(&self.motions, best));
        let mut between = optima.filter_map(|(_, motion)| self.motions.refined(motion));
        between.any(RefinedMotion::is_open)
    }

    /// What its lines mean: the directions, and the conditions.
    pub fn legend(&self) -> Vec<Entry> {
        let drawn = self.best.iter().filter(|best| best.front.len() > 1);
        let directions: Vec<&str> = drawn.map(|best| best.direction.name()).collect();
        if directions.is_empty() {
            return Vec::new();
        }
        let of_letter = self.letter.map_or(String::new(), |letter| format!("({letter}) "));
        let condition =
            self.motions.condition().map_or(String::new(), |it| format!(", where {it}"));
        let front = format!("{of_letter}Pareto front, {}{condition}", directions.join(" and "));
        let mut legend = vec![(Mark::Line(self.stroke), Text::plain(&front))];
        if self.has_cases_alone() {
            let line = Mark::Line(Stroke::solid(INK, MINOR_WIDTH));
            legend.push((line, Text::plain("that of the cases alone")));
        }
        legend
    }

    /// How many motions between the cases take part, from which searches, and under which conditions.
    pub fn about(&self) -> String {
        let motions = &self.motions;
        let between = motions.between();
        let condition = motions.condition().map_or(String::new(), |it| format!(" where {it}"));
        let from = motions.searched().map_or(String::new(), |searched| {
            format!(
                ", found by local search: {}; better ones may lie elsewhere",
                searched.in_words()
            )
        });
        format!("{between} periodic motions between the cases{condition}{from}")
    }
}

/// The optima in a direction with what marks them, those that matter least first.
pub fn marked<'m>(motions: &'m Motions<'_>, best: &Best) -> Vec<(Symbol, &'m Candidate)> {
    let of_all = &best.of_all;
    let [least, most] = match motions.of.has_own_gain() {
        true => [LEAST, FASTEST],
        false => [LEAST_PER_GAIN, MOST_GAIN],
    };
    let each = [(least, of_all.least_per_gain), (KNEE, of_all.knee), (most, of_all.most_gain)];
    let found = each.into_iter().filter_map(|(symbol, place)| Some((symbol, place?)));
    found.map(|(symbol, place)| (symbol, motions.at(place))).collect()
}

/// The front as stairs: up to the next case, the last one stays the best.
fn stairs(front: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut line = Vec::new();
    for (at, (energy, speed)) in front.iter().enumerate() {
        if at > 0 {
            line.push((*energy, front[at - 1].1));
        }
        line.push((*energy, *speed));
    }
    line
}
