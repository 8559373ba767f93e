//! One way along a branch, from an orbit to where the branch ends.

use super::arclength::{Equations, Linear, between, dot, norm};
use super::corner::rounded;
use super::orbits::{OrbitStation, Orbits};
use super::special::{Happening, happenings};
use super::walk::{Stride, Walk};

/// Corners that are rounded on one way at most.
const CORNERS: usize = 40;
/// A branch has closed if it comes by its beginning this near, relative to the step.
const CLOSES: f64 = 0.1;
/// A branch merges with the one it left at a doubling that lies no more than so many steps from its end.
const MERGES: f64 = 1.5;

/// A stretch of a branch.
#[derive(Debug, Clone)]
pub struct Way {
    /// Its orbits in order, that at the beginning included.
    pub stations: Vec<OrbitStation>,
    /// What happens, each between the orbit with this index and the next.
    pub happenings: Vec<(usize, Happening)>,
    /// Whether it has come back to its beginning.
    pub closed: bool,
    /// Which of the doublings it ends at.
    pub merged: Option<usize>,
    /// Length of the last step, or of the one that would have passed a merger.
    last_step: f64,
}

impl Way {
    /// A way that has yet to leave these orbits.
    pub fn new(stations: Vec<OrbitStation>) -> Self {
        Way { stations, happenings: Vec::new(), closed: false, merged: None, last_step: 0.0 }
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

    /// Ends at the one of these period doublings of the branch it left that it has run into, if it has.
    pub fn merge(&mut self, orbits: &Orbits, doublings: &[(usize, OrbitStation)]) {
        let Some(last) = self.stations.last() else { return };
        let parent = orbits.with_period(orbits.family.period / 2);
        let ends = doublings.iter().flat_map(|(place, station)| {
            let images = parent.images(&station.at).into_iter();
            images.map(|image| (*place, image, norm(&between(&last.at, &image))))
        });
        let Some((place, image, away)) = ends.min_by(|a, b| a.2.total_cmp(&b.2)) else { return };
        if away <= MERGES * self.last_step
            && let Ok(Linear { rows, seen, .. }) = orbits.at(&image)
        {
            self.merged = Some(place);
            self.stations.push(OrbitStation { at: image, tangent: last.tangent, rows, seen });
        }
    }

    /// Adds the next orbit and what happens before it; whether the branch goes on.
    fn add(&mut self, orbits: &Orbits, from: &OrbitStation, next: OrbitStation) -> bool {
        self.last_step = norm(&between(&from.at, &next.at));
        if crosses(orbits, from, &next) {
            return false;
        }
        let before = self.stations.len() - 1;
        let found = happenings(orbits, from, &next);
        self.happenings.extend(found.into_iter().map(|happening| (before, happening)));
        self.closed =
            before > 2 && self.stations.first().is_some_and(|first| comes_by(from, &next, first));
        self.stations.push(if self.closed { self.stations[0].clone() } else { next });
        !self.closed
    }
}

/// Whether between two orbits of an even period the branch passes one of half the period: what follows are
/// the same orbits, half a period later.
fn crosses(orbits: &Orbits, from: &OrbitStation, to: &OrbitStation) -> bool {
    let sides = [from, to].map(|station| orbits.halfway(&station.at));
    matches!(sides, [Some(before), Some(after)] if dot(&before, &after) < 0.0)
}

/// Whether the step between two orbits passes a third in its direction.
fn comes_by(from: &OrbitStation, to: &OrbitStation, by: &OrbitStation) -> bool {
    let step = norm(&between(&from.at, &to.at));
    let toward = between(&from.at, &by.at);
    let along = dot(&from.tangent, &toward);
    let aside = (dot(&toward, &toward) - along * along).max(0.0).sqrt();
    (0.0..=step).contains(&along) && aside <= CLOSES * step && dot(&from.tangent, &by.tangent) > 0.9
}
