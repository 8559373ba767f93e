//! Where the boundary of two basins crosses a line or a circle in a plane of starts, by the attractors that starts lead to.

use std::f64::consts::PI;

use super::start_plane::StartPlane;

/// Parts into which what the boundary crosses is divided at a time: the starts between are followed side by side.
const PARTS: usize = 17;
/// The ends are brought this close together, the sides of the plane being one.
const CLOSEST: f64 = 1e-10;
/// Starts on a circle or a line ahead of a curve.
const STARTS: usize = 48;
/// Angles from the direction in which a curve goes on within which it is sought on a circle [rad].
const FORWARD: f64 = 0.8 * PI;

/// Two starts that lead to two attractors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Crossing {
    /// The starts.
    pub starts: [[f64; 2]; 2],
    /// The attractors.
    pub attractors: [u32; 2],
}

impl Crossing {
    /// The start between.
    pub fn at(&self) -> [f64; 2] {
        let [a, b] = self.starts;
        [0, 1].map(|side| 0.5 * (a[side] + b[side]))
    }

    /// How far the two are apart.
    pub fn width(&self) -> f64 {
        let [a, b] = self.starts;
        libm::hypot(b[0] - a[0], b[1] - a[1])
    }

    /// The direction from the first to the second.
    pub fn across(&self) -> [f64; 2] {
        let ([a, b], width) = (self.starts, self.width());
        [0, 1].map(|side| (b[side] - a[side]) / width)
    }

    /// The direction across that on whose left the first is.
    pub fn along(&self) -> [f64; 2] {
        let [x, y] = self.across();
        [-y, x]
    }

    /// The same with its starts so much closer together, or as close as they may be; its second attractor may be another one,
    /// whose basin lies between. None where it is not known what one of the starts between leads to.
    pub fn closer<const D: usize>(self, plane: &StartPlane<'_, D>, width: f64) -> Option<Crossing> {
        let mut crossing = self;
        while crossing.width() > width.max(CLOSEST) {
            let [a, b] = crossing.starts;
            let shares = (1..PARTS).map(|number| number as f64 / PARTS as f64);
            let inner = shares.map(|share| [0, 1].map(|i| a[i] + share * (b[i] - a[i])));
            let inner: Vec<[f64; 2]> = inner.collect();
            let leads = plane.leads(&inner);
            let first = crossing.attractors[0];
            let other = leads.iter().position(|it| *it != Some(first)).unwrap_or(inner.len());
            let before = if other > 0 { inner[other - 1] } else { a };
            if let Some(leads) = leads.get(other) {
                crossing.attractors[1] = (*leads)?;
            }
            let narrower = [before, inner.get(other).copied().unwrap_or(b)];
            if narrower == crossing.starts {
                break;
            }
            crossing.starts = narrower;
        }
        Some(crossing)
    }
}

/// Starts from the right of a curve to its left, ahead of one of its points.
#[derive(Debug, Clone, Copy)]
pub(super) enum Ahead {
    /// On a circle.
    Circle {
        /// Its centre, a point of the curve.
        centre: [f64; 2],
        /// The direction in which the curve goes on there.
        tangent: [f64; 2],
        /// The radius.
        radius: f64,
    },
    /// On a line.
    Line {
        /// Where it begins, on the right.
        from: [f64; 2],
        /// Where it ends, on the left.
        to: [f64; 2],
    },
}

impl Ahead {
    /// Where a curve that has these attractors on its left and on its right comes: the starts on the left and on the right there;
    /// none where it does not come exactly once, where a start leads elsewhere, or where one is outside the plane.
    pub fn crossing<const D: usize>(
        &self,
        plane: &StartPlane<'_, D>,
        sides: [u32; 2],
    ) -> Option<Crossing> {
        let shares: Vec<f64> =
            (0..STARTS).map(|number| number as f64 / (STARTS - 1) as f64).collect();
        let starts: Vec<[f64; 2]> = shares.iter().map(|share| self.at(*share)).collect();
        if starts.iter().flatten().any(|it| !(0.0..=1.0).contains(it)) {
            return None;
        }
        let leads = plane.leads(&starts);
        let left = leads.iter().position(|it| *it == Some(sides[0]))?;
        let is_once = left > 0
            && leads[..left].iter().all(|it| *it == Some(sides[1]))
            && leads[left..].iter().all(|it| *it == Some(sides[0]));
        let starts = is_once.then(|| [self.at(shares[left]), self.at(shares[left - 1])])?;
        Crossing { starts, attractors: sides }.closer(plane, CLOSEST)
    }

    /// The start at a share of them.
    fn at(&self, share: f64) -> [f64; 2] {
        match self {
            Ahead::Circle { centre, tangent: [x, y], radius } => {
                let angle = FORWARD * (2.0 * share - 1.0);
                let (sin, cos) = (libm::sin(angle), libm::cos(angle));
                [centre[0] + radius * (cos * x - sin * y), centre[1] + radius * (sin * x + cos * y)]
            }
            Ahead::Line { from, to } => [0, 1].map(|i| from[i] + share * (to[i] - from[i])),
        }
    }
}
