//! One way along a branch, from an orbit to where the branch ends.

use super::SpecialKind;
use super::arc::Arc;
use super::arclength::{between, dot, norm};
use super::corner::rounded;
use super::orbits::{OrbitStation, Orbits};
use super::special::{Happening, happenings};
use super::walk::{Stride, Walk};

/// Corners that are rounded on one way at most.
const CORNERS: usize = 40;
/// A branch has closed if it comes by its beginning this near, relative to the step.
const CLOSES: f64 = 0.1;
/// Orbits nearer to the one of half the period than this share of the step are it.
const MERGED: f64 = 1e-3;

/// A stretch of a branch.
#[derive(Debug, Clone)]
pub struct Way {
    /// Its orbits in order, that at the beginning included.
    pub stations: Vec<OrbitStation>,
    /// What happens, each between the orbit with this index and the next.
    pub happenings: Vec<(usize, Happening)>,
    /// Whether it has come back to its beginning.
    pub closed: bool,
}

impl Way {
    /// A way that has yet to leave these orbits.
    pub fn new(stations: Vec<OrbitStation>) -> Self {
        Way { stations, happenings: Vec::new(), closed: false }
    }

    /// Follows the branch on until it ends, closes or has `most` orbits.
    ///
    /// It ends at a bound, where it merges with a branch of half its period, and where no step leads on: at a
    /// discontinuity of the return map, say.
    pub fn follow(&mut self, orbits: &Orbits, walk: &mut Walk<4>, most: usize) {
        let mut corners_left = CORNERS;
        while self.stations.len() < most
            && let Some(last) = self.stations.last()
        {
            let (from, stride) = match walk.stride(orbits, last) {
                Stride::Nowhere if corners_left > 0 => match rounded(orbits, walk, last) {
                    Some(goes_on) => goes_on,
                    None => return,
                },
                stride => (last.clone(), stride),
            };
            corners_left -= usize::from(from.tangent != last.tangent);
            match stride {
                Stride::Inside(next) => {
                    if !self.add(orbits, &from, next) {
                        return;
                    }
                }
                Stride::AtBound(next) => {
                    self.add(orbits, &from, next);
                    return;
                }
                Stride::Nowhere => return,
            }
        }
    }

    /// Adds the next orbit and what happens before it; whether the branch goes on.
    fn add(&mut self, orbits: &Orbits, from: &OrbitStation, next: OrbitStation) -> bool {
        let before = self.stations.len() - 1;
        let merged = merger(orbits, from, &next);
        let mut found = happenings(orbits, from, &next);
        if let Some((distance, _)) = &merged {
            // The branch turns back there only because its other half is the same orbits a half period later.
            found.retain(|happening| {
                happening.distance < *distance && happening.kind != SpecialKind::Fold
            });
        }
        self.happenings.extend(found.into_iter().map(|happening| (before, happening)));
        if let Some((_, last)) = merged {
            self.stations.push(last);
            return false;
        }
        self.closed = before > 2 && self.stations.first().is_some_and(|first| {
            comes_by(from, &next, first)
        });
        self.stations.push(if self.closed { self.stations[0].clone() } else { next });
        !self.closed
    }
}

/// Whether the step between two orbits passes a third in its direction.
fn comes_by(from: &OrbitStation, to: &OrbitStation, by: &OrbitStation) -> bool {
    let step = norm(&between(&from.at, &to.at));
    let toward = between(&from.at, &by.at);
    let along = dot(&from.tangent, &toward);
    let aside = (dot(&toward, &toward) - along * along).max(0.0).sqrt();
    (0.0..=step).contains(&along) && aside <= CLOSES * step && dot(&from.tangent, &by.tangent) > 0.9
}

/// Where between two orbits of an even period the branch meets that of half the period.
fn merger(orbits: &Orbits, from: &OrbitStation, to: &OrbitStation) -> Option<(f64, OrbitStation)> {
    let before = halfway(orbits, from)?;
    let after = halfway(orbits, to)?;
    let step = norm(&between(&from.at, &to.at));
    if dot(&before, &after) >= 0.0 || norm(&before) <= MERGED * step {
        return None;
    }
    let arc = Arc::from(orbits, from);
    let ends = [arc.place(from), arc.place(to)];
    let apart = |station: &OrbitStation| {
        halfway(orbits, station).map_or(f64::NAN, |apart| dot(&before, &apart))
    };
    arc.zero([&ends[0], &ends[1]], apart)
}

/// How far the orbit moves in half its period, in units of the section; none for an odd period.
pub fn halfway(orbits: &Orbits, station: &OrbitStation) -> Option<[f64; 3]> {
    if orbits.family.period % 2 != 0 {
        return None;
    }
    let half = orbits.with_period(orbits.family.period / 2);
    half.displacement(&station.at)
}
