//! Branches of orbits with rigid impacts against their closed form: through folds, grazings, and impacts on the instant
//! of the section, at which the section point jumps.

use std::f64::consts::PI;

use capsulemap_engine::branch::{BranchOf, End, Request, SpecialKind, follow};
use capsulemap_engine::flow::System;
use capsulemap_engine::orbit::matrix::Complex;
use capsulemap_engine::orbit::{Case, Outcome, Protocol, settle};

use super::draws::Random;

// Of the example only its system is used here, not its program.
#[path = "../../examples/impact_oscillator.rs"]
#[allow(dead_code)]
pub mod impact_oscillator;

use impact_oscillator::Impactor;

/// The orbits of one impact in n cycles.
///
/// With the time t since the impact, x is the steady answer to the force, p and p' at the impact, and the free
/// vibration e^(-c t/2) (a cos(s t) + b sin(s t)). It is back at the wall after n cycles with the velocity u and leaves
/// it with -r u: so b, p' and u are multiples of a = wall - p, and p^2 + (p'/w)^2 is the square of the amplitude.
struct OneImpact {
    system: Impactor<f64>,
    /// Frequency of the free vibration.
    s: f64,
    /// What b and p' are, over a.
    b: f64,
    rate: f64,
}

impl OneImpact {
    fn new(system: Impactor<f64>, n: u64) -> Self {
        let Impactor { c, w, r, .. } = system;
        let duration = 2.0 * PI * n as f64 / w;
        let s = (1.0 - 0.25 * c * c).sqrt();
        let decay = libm::exp(-0.5 * c * duration);
        let (sin, cos) = (decay * libm::sin(s * duration), decay * libm::cos(s * duration));
        let b = (1.0 - cos) / sin;
        let impact = s * ((cos - 1.0) * b - sin) / (1.0 + r);
        OneImpact { system, s, b, rate: 0.5 * c - s * b - r * impact }
    }

    /// Square of the amplitude of the steady answer, and how far it lags behind the force.
    fn answer(&self) -> (f64, f64) {
        let Impactor { c, f, w, .. } = self.system;
        let stiffness = 1.0 - w * w;
        (f * f / (stiffness * stiffness + c * c * w * w), libm::atan2(c * w, stiffness))
    }

    /// Half the sum of the two values of a, and the square of half their difference: negative where there is no orbit.
    fn roots(&self) -> (f64, f64) {
        let Impactor { w, wall, .. } = self.system;
        let square = 1.0 + (self.rate / w).powi(2);
        let middle = wall / square;
        (middle, middle * middle - (wall * wall - self.answer().0) / square)
    }

    /// The section points of the two orbits.
    fn sections(&self) -> Vec<[f64; 2]> {
        let (middle, apart) = self.roots();
        let signs = if apart < 0.0 { vec![] } else { vec![1.0, -1.0] };
        signs.iter().map(|sign| self.section(middle + sign * apart.sqrt())).collect()
    }

    /// The section point at the first instant of the section after the impact.
    fn section(&self, a: f64) -> [f64; 2] {
        let Impactor { c, w, wall, .. } = self.system;
        let (square, lag) = self.answer();
        let phase = libm::atan2(-self.rate * a / w, wall - a) + lag;
        let t = 2.0 * PI / w - (phase / w).rem_euclid(2.0 * PI / w);
        let decay = libm::exp(-0.5 * c * t);
        let (sin, cos) = (decay * libm::sin(self.s * t), decay * libm::cos(self.s * t));
        let free = a * (cos + self.b * sin);
        let free_rate = a * self.s * (self.b * cos - sin) - 0.5 * c * free;
        let amplitude = square.sqrt();
        [amplitude * libm::cos(lag) + free, w * amplitude * libm::sin(lag) + free_rate]
    }
}

/// What was met on branches.
#[derive(Debug, Default)]
struct Met {
    branches: usize,
    orbits: usize,
    jumps: usize,
    folds: usize,
    grazings: usize,
    ends: [usize; End::NAMES.len()],
    worst: f64,
}

/// Impacts in the period of an orbit: areas of the section shrink by e^(-c T) in its duration T and by r^2 at each.
/// None where the determinant is lost in rounding, as that of many impacts is.
fn impacts(system: &Impactor<f64>, n: u64, multipliers: &[Complex]) -> Option<u32> {
    let [a, b] = [0, 1].map(|at| multipliers[at].abs());
    let duration = 2.0 * PI * n as f64 / system.w;
    let number = (libm::log(a * b) + system.c * duration) / (2.0 * libm::log(system.r));
    ((number - number.round()).abs() < 1e-5).then_some(number.round() as u32)
}

impl Met {
    /// Holds each orbit of one impact against the closed form, and the special points against where they must lie.
    fn check(
        &mut self,
        system: Impactor<f64>,
        along: &'static str,
        branch: &BranchOf<Impactor<f64>, 2>,
    ) {
        let n = branch.period;
        let at = |value: f64| OneImpact::new(system.with(along, value), n);
        self.branches += 1;
        for end in branch.ends {
            self.ends[end as usize] += 1;
        }
        let mut before: Option<[f64; 2]> = None;
        for point in &branch.points {
            let orbit = at(point.parameter);
            if impacts(&orbit.system, n, &point.multipliers) != Some(1) {
                before = None;
                continue;
            }
            let away = |[x, v]: [f64; 2]| {
                let apart = |[a, b]: &[f64; 2]| (x - a).abs().max((v - b).abs());
                point.section.iter().map(apart).fold(f64::INFINITY, f64::min)
            };
            let nearest = orbit.sections().into_iter().map(away).fold(f64::INFINITY, f64::min);
            // Two orbits that are about to be one at a fold are known to half the digits.
            let known = 1e-13 / orbit.roots().1.abs().sqrt();
            let value = point.parameter;
            assert!(nearest < 1e-9 + known, "{nearest:e} at {along} = {value}: {system:?}");
            self.orbits += 1;
            self.worst = self.worst.max(nearest);
            let [x, v] = point.section[0];
            let reversed = |[y, u]: [f64; 2]| {
                let least = (v + system.r * u).abs().min((u + system.r * v).abs());
                (x - y).abs() < 1e-3 && v * u < 0.0 && least < 1e-2
            };
            self.jumps += usize::from(before.is_some_and(reversed));
            before = Some([x, v]);
        }
        for special in &branch.special {
            let orbit = at(special.point.parameter);
            let count = impacts(&orbit.system, n, &special.point.multipliers);
            if special.kind == SpecialKind::Fold && count == Some(1) {
                let (_, apart) = orbit.roots();
                assert!(apart.abs() < 1e-9 * orbit.answer().0, "{apart:e}: {special:?}");
                self.folds += 1;
            }
            if special.kind == SpecialKind::Grazing && count == Some(0) {
                let away = orbit.answer().0.sqrt() - orbit.system.wall;
                assert!(away.abs() < 1e-10, "{away:e}: {special:?}");
                self.grazings += 1;
            }
        }
    }
}

/// Impactors from the whole box, each pushed and settled, and its attractor followed in one parameter.
#[test]
fn branches_of_one_impact_are_those_of_the_closed_form() {
    let mut random = Random::new(17);
    let mut met = Met::default();
    let count = std::env::var("CASES").map_or(40, |it| it.parse().expect("a number"));
    for case in 0..count {
        let system = Impactor {
            c: random.logarithmic(0.02, 0.5),
            f: random.logarithmic(0.2, 3.0),
            w: random.logarithmic(0.4, 4.0),
            r: random.uniform(0.3, 0.95),
            wall: random.uniform(0.0, 2.0),
            phase: 0.0,
        };
        let start = [system.wall - random.uniform(0.0, 1.0), random.uniform(-3.0, 3.0)];
        let orbit = settle(&Case::new(system, start), &Protocol::default());
        if orbit.outcome != Outcome::Periodic {
            continue;
        }
        let (along, range) = match case % 4 {
            0 => ("w", [0.4, 4.0]),
            1 => ("f", [0.2, 3.0]),
            2 => ("wall", [0.0, 2.0]),
            _ => ("r", [0.3, 0.95]),
        };
        let request = Request {
            system,
            section: orbit.section[0],
            period: orbit.period,
            along,
            range,
            doublings: 0,
            second: None,
            curve_range: None,
            longest_step: 0.02,
            most_points: 300,
            tolerance: 1e-12,
        };
        let found = follow(&request).unwrap_or_else(|why| panic!("{why:?}: {request:?}"));
        met.check(system, along, &found.branches[0]);
    }
    println!("{met:?}");
    assert!(met.branches > count / 2 && met.orbits > 50 * count, "{met:?}");
    assert!([met.jumps, met.folds, met.grazings].iter().all(|met| *met > count / 8), "{met:?}");
    let [stopped, neither] = [End::Stopped, End::Vanishes].map(|end| met.ends[end as usize]);
    assert!(stopped + neither <= count / 100, "{met:?}");
}
