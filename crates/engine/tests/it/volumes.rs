//! What becomes of a volume of motions: the divergence of the field, by differences of its equations, and what events do to it.

use capsulemap_engine::flow::{Field, Motion, Step, Stroboscopic};
use capsulemap_engine::lane::{quadrature, series};

/// What an event, or the mode that it has led to, makes of a volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Share {
    /// It stays.
    Stays,
    /// It is multiplied.
    Times(f64),
    /// It is multiplied with the rate of a coordinate after the event over that before.
    Turns(usize),
    /// Nothing is left of it.
    Lost,
}

/// The time at which a tolerance leaves nothing to be seen.
pub const TOLERANCE: f64 = 1e-13;

/// The logarithm of what so many cycles from a point make of a volume around it; minus infinity where nothing is left.
///
/// `mode` tells what a step in a mode makes of it beside the divergence, `event` what the event at the end of a step does. No derivative
/// of the engine is used: the equations are evaluated beside the motion.
pub fn volume<S: Field + Stroboscopic<f64, D>, const D: usize>(
    system: &S,
    from: [f64; D],
    cycles: usize,
    mode: impl Fn(&Step<f64, S>) -> Share,
    event: impl Fn(&Step<f64, S>, &S::State) -> Share,
) -> f64 {
    let period = system.period();
    let mut motion = Motion::new(system, 0.0, S::state(from));
    let (mut step, mut log, mut done) = (Step::default(), 0.0, 0);
    let mut turning: Option<(usize, f64)> = None;
    while done < cycles {
        motion.step(system, period, TOLERANCE, &mut step);
        assert_eq!(motion.breakdown(system, &step, 0), None, "the integration continues");
        if step.length > 0.0 {
            if mode(&step) == Share::Lost {
                return f64::NEG_INFINITY;
            }
            if let Some((coordinate, before)) = turning.take() {
                let after: f64 = rates(system, &step, 0.0)[coordinate];
                log += (after / before).abs().ln();
            }
            log += shrinkage(system, &step);
        }
        match event(&step, &motion.state) {
            Share::Stays => {}
            Share::Times(factor) => log += factor.ln(),
            Share::Turns(coordinate) => {
                turning = Some((coordinate, rates(system, &step, step.length)[coordinate]));
            }
            Share::Lost => return f64::NEG_INFINITY,
        }
        if step.arrives {
            motion.begin_cycle(system, true);
            done += 1;
        }
    }
    log
}

/// The rates of the coordinates so long after the start of a step.
fn rates<S: Field + Stroboscopic<f64, D>, const D: usize>(
    system: &S,
    step: &Step<f64, S>,
    h: f64,
) -> [f64; D] {
    S::point(&system.rates(&step.mode, step.start + h, &system.at(&step.jet, h)))
}

/// The integral of the divergence over a step, in halves of halves until these agree: friction beside rest has a slope that changes
/// faster than the motion.
fn shrinkage<S: Field + Stroboscopic<f64, D>, const D: usize>(
    system: &S,
    step: &Step<f64, S>,
) -> f64 {
    let whole = over(system, step, [0.0, step.length]);
    halved(system, step, [0.0, step.length], whole)
}

fn halved<S: Field + Stroboscopic<f64, D>, const D: usize>(
    system: &S,
    step: &Step<f64, S>,
    [from, to]: [f64; 2],
    whole: f64,
) -> f64 {
    let middle = 0.5 * (from + to);
    let halves = [[from, middle], [middle, to]].map(|it| (it, over(system, step, it)));
    let sum = halves[0].1 + halves[1].1;
    if (sum - whole).abs() <= 1e-8 * (1.0 + whole.abs()) || to - from < 1e-9 * step.length {
        return sum;
    }
    halves.into_iter().map(|(it, whole)| halved(system, step, it, whole)).sum()
}

/// The integral of the divergence between two times after the start of a step.
fn over<S: Field + Stroboscopic<f64, D>, const D: usize>(
    system: &S,
    step: &Step<f64, S>,
    [from, to]: [f64; 2],
) -> f64 {
    let mut time = series::zero();
    (time[0], time[1]) = (from, 1.0);
    let divergence = quadrature::values(&time, to - from).map(|h| divergence(system, step, h));
    quadrature::integral_of_product(&divergence, &[1.0; quadrature::NODES], to - from)
}

/// The divergence of the field so long after the start of a step, by central differences.
fn divergence<S: Field + Stroboscopic<f64, D>, const D: usize>(
    system: &S,
    step: &Step<f64, S>,
    h: f64,
) -> f64 {
    let state = system.at(&step.jet, h);
    let point: [f64; D] = S::point(&state);
    let along = |i: usize| {
        let width = 1e-6 * point[i].abs().max(1e-2);
        let beside = |side: f64| {
            let mut moved = point;
            moved[i] += side * width;
            let state = S::moved_to(state, moved);
            S::point(&system.rates(&step.mode, step.start + h, &state))[i]
        };
        (beside(1.0) - beside(-1.0)) / (2.0 * width)
    };
    (0..D).map(along).sum()
}
