//! Whether an orbit is stationary: the slope that bounds, limits and surfaces leave there, and which of them hold the orbit.

use super::goal::{Measured, Multipliers, Objective};
use super::hold::{Hold, Side};
use super::quadratic::Vector;
use super::slope;
use super::surface::Surface;
use crate::orbit::matrix::{Complex, norm};

/// The relative slope at which an orbit counts as stationary.
pub const STATIONARY: f64 = 1e-8;
/// Where no step gains any more, a slope above this is that of an edge of the family, and a lesser one rounding.
const AT_EDGE: f64 = 1e-4;
/// A surface this near holds an orbit, in shares of the ranges.
const TOUCHES: f64 = 1e-9;

/// The slope at an orbit.
pub struct Slope {
    /// The largest relative slope that is left, as [`Best`](super::Best) has it.
    pub left: f64,
    /// The multipliers of the limits; zero of those that are not reached.
    pub limits: Multipliers,
    /// The bounds, limits and surfaces that hold the orbit, a budget aside.
    pub held_by: Vec<Hold>,
    /// The places of near surfaces beyond which it is better.
    pub passes: Vec<usize>,
}

/// What may hold an orbit.
#[derive(Clone, Copy)]
struct Constraint {
    /// Its name; none of a budget.
    hold: Option<Hold>,
    /// Its normal, outward.
    normal: Vector,
}

impl Slope {
    /// The slope that bounds, limits and surfaces leave which touch an orbit, or are so near [shares].
    pub fn at(objective: &Objective, here: &Measured, surfaces: &[Surface], near: f64) -> Slope {
        let limits = near_limits(here, near);
        let of_limits = limits.iter().map(|&place| Constraint {
            hold: objective.hold(place),
            normal: here.limits[place].gradient,
        });
        let mut fixed: Vec<Constraint> = of_limits.collect();
        fixed.extend(near_bounds(&here.orbit.shares[..objective.count], near));
        let (mut touching, mut passes) = (near_surfaces(surfaces, near), Vec::new());
        loop {
            let of_surfaces = touching.iter().map(|&place: &usize| Constraint {
                hold: Some(surfaces[place].hold),
                normal: surfaces[place].normal,
            });
            let constraints: Vec<Constraint> = fixed.iter().copied().chain(of_surfaces).collect();
            let normals: Vec<Vector> = constraints.iter().map(|it| it.normal).collect();
            let (slope, multipliers) = slope::left(&here.goal.gradient, &normals);
            let mut of_limits = Multipliers::default();
            limits.iter().zip(&multipliers).for_each(|(&place, &by)| of_limits[place] = by);
            let count = passes.len();
            passes.extend(touching.iter().filter(|&&i| surfaces[i].lets_pass(&of_limits)));
            if passes.len() > count {
                touching.retain(|place| !passes.contains(place));
                continue;
            }
            let left = slope.iter().fold(here.most_excess(), |most, part| most.max(part.abs()));
            let holding = constraints.iter().zip(&multipliers);
            let holding = holding.filter(|(_, multiplier)| **multiplier > STATIONARY);
            let held_by = holding.filter_map(|(constraint, _)| constraint.hold).collect();
            return Slope { left, limits: of_limits, held_by, passes };
        }
    }

    /// What holds the orbit, whose Floquet multipliers tell of which edge a slope is that is left.
    pub fn holds(&self, multipliers: &[Complex]) -> Vec<Hold> {
        let mut holds = self.held_by.clone();
        if self.left > AT_EDGE {
            holds.push(Hold::edge(multipliers));
        } else if self.left > STATIONARY {
            holds.push(Hold::Steps);
        }
        if holds.is_empty() {
            holds.push(Hold::Interior);
        }
        holds
    }

    /// Whether a surface holds the orbit, at which the outputs have a kink.
    pub fn is_at_kink(&self) -> bool {
        self.held_by.iter().any(|it| matches!(it, Hold::Grazing | Hold::EventSequence))
    }
}

/// The places of the limits that an orbit touches or that are so near [shares].
fn near_limits(here: &Measured, near: f64) -> Vec<usize> {
    let places = (0..here.limits.len()).filter(|&place| {
        let limit = &here.limits[place];
        -limit.value <= STATIONARY + near * norm(&limit.gradient)
    });
    places.collect()
}

/// The bounds of free parameters, at these shares of their ranges, that are so near [shares].
fn near_bounds(shares: &[f64], near: f64) -> Vec<Constraint> {
    let mut bounds = Vec::new();
    for (place, share) in shares.iter().enumerate() {
        if *share <= near {
            bounds.push(Constraint::bound(place, Side::Lower));
        }
        if *share >= 1.0 - near {
            bounds.push(Constraint::bound(place, Side::Upper));
        }
    }
    bounds
}

/// The places of the surfaces, located, that an orbit touches or that are so near [shares].
fn near_surfaces(surfaces: &[Surface], near: f64) -> Vec<usize> {
    let places = (0..surfaces.len())
        .filter(|&i| surfaces[i].distance <= TOUCHES + near && surfaces[i].is_located());
    places.collect()
}

impl Constraint {
    /// A bound of a free parameter.
    fn bound(place: usize, side: Side) -> Constraint {
        let mut normal = Vector::default();
        normal[place] = if side == Side::Lower { -1.0 } else { 1.0 };
        Constraint { hold: Some(Hold::Bound(place, side)), normal }
    }
}
