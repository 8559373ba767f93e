//! Where a motion goes when the parameter steps from one value to another: the attractors that orbits left behind lead to.

use std::f64::consts::TAU;

use super::cases::on_all_threads;
use super::final_motion::final_motion;
use super::{Machine, RunError};
use crate::attractor::{Attractor, Label, Share, shares_of_draws};
use crate::description::{Section, State};
use crate::model::{Case, Leads, Setting};
use crate::orbit::{Outcome, Protocol};
use crate::study::layout::Layout;
use crate::study::{DrawKind, Draws, Study};

/// The odd multiplier of a linear congruential generator (Knuth, MMIX), by which seeds of steps differ.
const APART: u64 = 6_364_136_223_846_793_005;

/// What is drawn of each orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// So many draws of each orbit.
    pub draws: usize,
    /// Tells sets of draws apart.
    pub seed: u64,
    /// The radius of the ball in which the state is displaced when the parameter steps, in the units in which section points are
    /// compared; zero for none.
    pub ball: f64,
}

/// A step of the parameter of a study, between two of its values, by their places on the axis.
pub type Step = [usize; 2];

/// What a step of the parameter does to each attractor.
#[derive(Debug, Clone, PartialEq)]
pub struct Tipping {
    /// The values of the parameter before and after the step (SI).
    pub values: [f64; 2],
    /// The attractors before the step that starts lead to.
    pub rows: Vec<TippingRow>,
}

/// What a step does to an attractor.
#[derive(Debug, Clone, PartialEq)]
pub struct TippingRow {
    /// The attractor before the step, by its number.
    pub attractor: u32,
    /// What it is.
    pub outcome: Outcome,
    /// Its period [cycles].
    pub period: u32,
    /// The draws of its orbit that lead to each attractor after the step, by the numbers of these; empty of a motion that does not repeat.
    pub orbit: Vec<Share>,
    /// The draws that lead to no attractor that a start after the step leads to.
    pub unknown: usize,
    /// The starts of its basin before the step that lead to each attractor after it, as if the starts were drawn.
    pub basin: Vec<Share>,
    /// The starts of its basin whose attractor after the step is not known.
    pub basin_unknown: usize,
}

/// What some steps of the parameter of a study do to its attractors; `labels` are the attractors of all its cases, by their numbers along
/// the axis. None where the study is not of one parameter and of starts.
///
/// # Method
///
/// The orbit that is left behind: the motion has settled on a periodic attractor, and the parameter steps at a moment that is
/// evenly distributed over the period: of a model with a drive at any phase, which does not jump, of one without as the motion passes its
/// section. The state is carried over, displaced by a vector that is evenly distributed in a ball. Where it leads is followed. Each
/// probability has Wilson's interval at 95 percent of so many independent draws. The basin that is left behind: the starts of the
/// grid that lead to the attractor before the step, by what they lead to after it.
///
/// # Source
///
/// Of an orbit, partial basin instability and phase tipping: H. Alkhayuon, R. C. Tyson and S. Wieczorek, Proc. R. Soc. A 477, 2021. Of
/// a basin: B. Kaszas, U. Feudel and T. Tel, Sci. Rep. 9, 2019.
///
/// # Guarantees
///
/// The same for any threads; each step by itself, whatever steps are asked for beside it.
///
/// # Breaks
///
/// An attractor that no start of the grid leads to is not known, and orbits that are left behind cannot be seen to lead to it: they
/// are counted as unknown. The interval of a basin takes the starts of the grid for independent ones.
pub fn tipping(
    study: &Study,
    labels: &[Label],
    steps: &[Step],
    drawn: &Steps,
    machine: Machine,
) -> Result<Option<Vec<Tipping>>, RunError> {
    let layout = Layout::of(study);
    let Some(axis) = layout.axis.filter(|_| layout.lines() == 1 && layout.cases() > 1) else {
        return Ok(None);
    };
    // Along a path of several the places stand for values.
    let single = study.axes()[axis].single();
    let attractors = labels.iter().filter_map(|it| match it {
        Label::Attractor(number) => Some(*number as usize + 1),
        _ => None,
    });
    let attractors = attractors.max().unwrap_or(0);
    let found = on_all_threads(machine.threads, steps.len(), |place| {
        let [from, to] = steps[place].map(|at| Cell { study, layout: &layout, labels, at });
        let stepping = Stepping { from, to, drawn, attractors };
        let value = |at: usize| single.map_or(at as f64, |it| it.values[at]);
        Tipping { values: steps[place].map(value), rows: stepping.rows() }
    })?;
    Ok(Some(found))
}

/// The starts at one value of the parameter, by its place on the axis.
#[derive(Clone, Copy)]
struct Cell<'a> {
    study: &'a Study,
    layout: &'a Layout,
    labels: &'a [Label],
    at: usize,
}

impl Cell<'_> {
    fn case(&self, start: usize) -> usize {
        self.layout.case(0, self.at, start)
    }

    fn label(&self, start: usize) -> Label {
        self.labels[self.case(start)]
    }

    /// What every motion here depends on.
    fn setting(&self) -> Setting {
        Setting::of(&self.study.case(self.case(0)))
    }

    /// The attractor of a number, as the first start that leads to it shows it; none where none does.
    fn attractor(&self, number: u32) -> Option<Attractor<Section>> {
        let own = Label::Attractor(number);
        let start = (0..self.layout.cases()).find(|start| self.label(*start) == own)?;
        let (index, model) = (self.case(start), self.study.model());
        let case = self.study.case(index);
        let protocol = plain(&self.study.protocol);
        let motion = final_motion(&model.settle(&case, &protocol, None));
        model.attractor(&Setting::of(&case), index, &motion, &protocol)
    }
}

/// The same protocol without what is kept of a motion beside where it leads.
fn plain(protocol: &Protocol) -> Protocol {
    Protocol { points: 0, impact_points: 0, history: None, ..*protocol }
}

/// A step from one value to another.
struct Stepping<'a> {
    from: Cell<'a>,
    to: Cell<'a>,
    drawn: &'a Steps,
    /// How many attractors there are along the axis.
    attractors: usize,
}

impl Stepping<'_> {
    fn rows(&self) -> Vec<TippingRow> {
        let numbers = 0..self.attractors as u32;
        let after: Vec<(u32, Attractor<Section>)> =
            numbers.clone().filter_map(|it| Some((it, self.to.attractor(it)?))).collect();
        let known: Vec<_> = after.iter().map(|(number, it)| (*number, it)).collect();
        let machine = Machine { threads: Some(1), ..Machine::default() };
        let study = self.to.study;
        let leads = study.model().leads(&self.to.setting(), &study.protocol, machine, &known);
        let before = numbers.filter_map(|it| Some((it, self.from.attractor(it)?)));
        before.map(|(number, attractor)| self.row(number, &attractor, leads.as_ref())).collect()
    }

    fn row(&self, number: u32, attractor: &Attractor<Section>, leads: &dyn Leads) -> TippingRow {
        let repeats = attractor.outcome == Outcome::Periodic;
        let draws = if repeats { self.draws(number, attractor) } else { Vec::new() };
        let points: Vec<Section> = draws.iter().flatten().cloned().collect();
        let mut led = leads.of(&points).into_iter();
        let labels: Vec<Label> = draws
            .iter()
            .map(|draw| draw.as_ref().and_then(|_| led.next().flatten()))
            .map(|it| it.map_or(Label::Undecided, Label::Attractor))
            .collect();
        let own = Label::Attractor(number);
        let basin: Vec<Label> = (0..self.from.layout.cases())
            .filter(|start| self.from.label(*start) == own)
            .map(|start| self.to.label(start))
            .collect();
        let shares =
            |labels: &[Label]| shares_of_draws(labels.len(), |at| labels[at], self.attractors);
        let unknown =
            |labels: &[Label]| labels.iter().filter(|it| **it == Label::Undecided).count();
        TippingRow {
            attractor: number,
            outcome: attractor.outcome,
            period: if repeats { attractor.points.len() as u32 } else { 0 },
            orbit: if repeats { shares(&labels) } else { Vec::new() },
            unknown: unknown(&labels),
            basin: shares(&basin),
            basin_unknown: unknown(&basin),
        }
    }

    /// The section points after the step to which draws of an orbit come; none where one cannot be followed.
    fn draws(&self, number: u32, attractor: &Attractor<Section>) -> Vec<Option<Section>> {
        // Numbers of their own for each step and orbit.
        let places = [self.from.at, self.to.at, number as usize];
        let seed = places.iter().fold(self.drawn.seed, |seed, place| {
            seed.wrapping_mul(APART).wrapping_add(*place as u64)
        });
        let kind = DrawKind::Uniform;
        let draws = Draws { kind, count: self.drawn.draws, seed, ranges: Vec::new() };
        (0..draws.count)
            .map(|index| self.draw(attractor, &mut (0..).map(|place| draws.share(index, place))))
            .collect()
    }

    /// Where a draw comes to, by random numbers from 0 to below 1.
    fn draw(
        &self,
        attractor: &Attractor<Section>,
        random: &mut dyn Iterator<Item = f64>,
    ) -> Option<Section> {
        let study = self.from.study;
        let (model, tolerance) = (study.model(), study.protocol.tolerance);
        let [before, after] = [&self.from, &self.to].map(|it| study.case(it.case(0)));
        let point = &attractor.points[(random.next()? * attractor.points.len() as f64) as usize];
        let start = State::at_section(study.base.model(), point);
        if !model.description().has_drive() {
            return Some(self.displaced(&start, random)?.section());
        }
        let section_phase = before.section_phase;
        let phase = section_phase + random.next()? * TAU;
        let here = Case { start, start_phase: section_phase, section_phase: phase, ..before };
        let arc = model.arc(&here, 1, tolerance).ok()?;
        let start = self.displaced(&arc.state(arc.times.len() - 1), random)?;
        let onward = Case { start, start_phase: phase, section_phase, ..after };
        let arc = model.arc(&onward, 1, tolerance).ok()?;
        Some(arc.state(arc.times.len() - 1).section())
    }

    /// A state displaced by a vector in the ball, by random numbers.
    fn displaced(&self, state: &State, random: &mut dyn Iterator<Item = f64>) -> Option<State> {
        let mut displaced = state.clone();
        if self.drawn.ball == 0.0 {
            return Some(displaced);
        }
        let model = self.from.study.model();
        let scales = model.scales(&self.from.setting());
        let vector = in_unit_ball(scales.len(), random)?;
        let coordinates = model.description().section_coordinates();
        for ((coordinate, scale), part) in coordinates.zip(scales.iter()).zip(vector) {
            displaced[coordinate] += self.drawn.ball * part / scale;
        }
        Some(displaced)
    }
}

/// A vector of so many components that is evenly distributed in the unit ball, by random numbers, which do not end.
fn in_unit_ball(components: usize, random: &mut dyn Iterator<Item = f64>) -> Option<Vec<f64>> {
    loop {
        let vector: Vec<f64> = random.take(components).map(|it| 2.0 * it - 1.0).collect();
        if vector.len() < components {
            return None;
        }
        if vector.iter().map(|it| it * it).sum::<f64>() <= 1.0 {
            return Some(vector);
        }
    }
}
