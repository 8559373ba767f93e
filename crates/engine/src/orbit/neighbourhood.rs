//! Neighbourhoods of stable orbits that no motion leaves again: what enters one tends to its orbit.

use crate::flow::{Metric, System};
use crate::lane::Instructions;

use super::matrix::{Matrix, eigenvalues};
use super::passage::{Passage, PlainReturns, ReturnRequest};
use super::passages::passages;
use super::return_map::Cycles;

/// The first radius that is tried, as a share of the size of the orbit.
const WIDEST: f64 = 0.25;
/// A radius is halved at most this often.
const HALVINGS: u32 = 24;
/// The neighbourhood has this share of the radius to which the map has been tested.
const SAFETY: f64 = 0.5;
/// Doublings of a sum, which after so many has more terms than an orbit of multiplier 1 - 1e-9 needs.
const DOUBLINGS: u32 = 40;
/// The longest period of an orbit that is given a neighbourhood, as its map must be followed a thousand times [cycles].
const LONGEST: u64 = 16;
/// A neighbourhood that shall hold a point is wider than the point is far by this factor.
const WIDER: f64 = 1.0 + 1e-6;
/// Where that fails, a radius smaller by this factor is tried, so often.
const SMALLER: f64 = 0.25;
const SMALLER_RADII: u32 = 5;
/// A return map may differ from its linear part by this share of what that shrinks a difference by: where the rest grows
/// as the square, as that of a smooth map does or faster, its own growth within is then below half of it.
const CURVED: f64 = 0.25;

/// An ellipsoid around a section point of a periodic orbit, which its return map leads into itself.
///
/// Method: with the Jacobian J of the return map over the period, the norm |u|^2 = sum |J^n u|^2 (the solution of Stein's
/// equation P - J' P J = I) falls by J by a factor theta < 1 at least, wherever the eigenvectors lie. The map is tried at
/// all points of a lattice on the ellipsoid and on one half as wide, and the radius halved until each of them passes the
/// events of the orbit in their order, comes nearer by (1 + theta)/2 at least, and has a Jacobian that shrinks every
/// difference by as much. Half of that radius is kept. A coordinate that the return map keeps at exactly zero, as the velocity
/// of a body at rest, must be zero in what is inside.
/// Guarantees: as far as the map behaves between the points that were tried as it does at them. There it is analytic, as
/// the order of events is one.
#[derive(Debug, Clone, PartialEq)]
pub struct Neighbourhood<const D: usize> {
    /// The section point of the orbit.
    pub centre: [f64; D],
    /// The quadratic form that is one on the surface.
    form: Matrix<D>,
    /// The coordinates that are exactly zero inside.
    at_rest: [bool; D],
    metric: Metric<D>,
}

impl<const D: usize> Neighbourhood<D> {
    /// Whether a point is inside.
    pub fn contains(&self, point: &[f64; D]) -> bool {
        let away = self.metric.difference(point, &self.centre);
        if (0..D).any(|i| self.at_rest[i] && away[i] != 0.0) {
            return false;
        }
        let product = |row: &[f64; D]| row.iter().zip(&away).map(|(a, x)| a * x).sum::<f64>();
        away.iter().zip(&self.form).map(|(x, row)| x * product(row)).sum::<f64>() <= 1.0
    }

    /// That of the point at which an orbit of a system begins; none where the orbit is not stable, its period is longer than
    /// 16 cycles, no ellipsoid passes, or the point is the origin, which has no size to begin the search with.
    pub fn of<M: System<D>>(
        system: &M,
        (centre, period): ([f64; D], u64),
        instructions: Instructions,
        tolerance: f64,
    ) -> Option<Self> {
        let metric = system.metric();
        if period > LONGEST || metric.size(&centre) == 0.0 {
            return None;
        }
        let cycles = Cycles { count: period, tolerance };
        let request = |point: [f64; D]| ReturnRequest {
            system: system.clone(),
            along: None,
            point,
            units: [1.0; D],
            cycles,
            watched: true,
            directions: None,
        };
        let followed = |points: Vec<[f64; D]>| {
            let requests: Vec<_> = points.into_iter().map(request).collect();
            let requests: Vec<_> = requests.iter().collect();
            passages(instructions, &requests)
        };
        let own = followed(vec![centre]).pop()?.ok()?;
        let at_rest: [bool; D] =
            std::array::from_fn(|i| centre[i] == 0.0 && own.jacobian[i] == [0.0; D]);
        let own_map = scaled(&own.jacobian, &metric, &at_rest);
        let norm = Norm::of(&own_map)?;
        let lattice = lattice(&at_rest);
        let allowed = 0.5 * (1.0 + norm.theta);
        let point = |direction: &[f64; D], radius: f64| -> [f64; D] {
            let along = norm.unit(direction);
            std::array::from_fn(|i| centre[i] + radius * along[i] / metric.scales[i])
        };
        let is_drawn_in = |passage: &Passage<M::Event, D>, radius: f64| {
            let away = metric.scaled(&metric.difference(&passage.end, &centre));
            let rests = (0..D).all(|i| !at_rest[i] || passage.end[i] == 0.0);
            rests
                && passage.events == own.events
                && norm.size(&away) <= allowed * radius
                && norm.growth(&scaled(&passage.jacobian, &metric, &at_rest)) <= allowed
        };
        let mut radius = WIDEST * metric.size(&centre);
        for _ in 0..HALVINGS {
            let radii = [radius, 0.5 * radius];
            let points = radii.iter().flat_map(|&it| lattice.iter().map(move |d| (d, it)));
            let passed = followed(points.map(|(direction, it)| point(direction, it)).collect());
            let of_radius = |number: usize| radii[number / lattice.len()];
            let is_passed = |(number, passage): (usize, &Result<Passage<M::Event, D>, _>)| {
                passage.as_ref().is_ok_and(|it| is_drawn_in(it, of_radius(number)))
            };
            if passed.iter().enumerate().all(is_passed) {
                let kept = SAFETY * radius;
                let scales = &metric.scales;
                let form = std::array::from_fn(|i| {
                    std::array::from_fn(|j| norm.form[i][j] * scales[i] * scales[j] / (kept * kept))
                });
                return Some(Neighbourhood { centre, form, at_rest, metric });
            }
            radius *= 0.5;
        }
        None
    }
}

/// A point of a periodic orbit with the derivative of the return map over its period there.
#[derive(Debug, Clone, Copy)]
pub struct OrbitPoint<const D: usize> {
    /// The section point.
    pub point: [f64; D],
    /// The derivative.
    pub jacobian: Matrix<D>,
}

impl<const D: usize> Neighbourhood<D> {
    /// A neighbourhood of a point of an orbit that holds another point, or the widest of some smaller ones; none where no
    /// ellipsoid passes.
    ///
    /// Method: as [`Neighbourhood::of`], by returns without derivatives, a sixth of the work: at the points of the lattice the
    /// events are those of the orbit, and the image differs from that of the linear map by a quarter of (1 - theta) times the
    /// distance at most, `theta` the factor by which that shrinks every difference. `returns_of` tells where points return to
    /// over the period.
    /// Guarantees: as [`Neighbourhood::of`]; between the points the rest beside the linear part is taken to grow as the
    /// square of the distance or faster.
    pub fn holding<E: PartialEq>(
        orbit: &OrbitPoint<D>,
        metric: &Metric<D>,
        held: &[f64; D],
        mut returns_of: impl FnMut(Vec<[f64; D]>) -> PlainReturns<E, D>,
    ) -> Option<Self> {
        let linear = LinearMap::of(orbit, metric)?;
        let lattice = lattice(&linear.at_rest);
        let mut radius = WIDER * linear.norm.size(&linear.away(held)) / SAFETY;
        for _ in 0..=SMALLER_RADII {
            let mut points = vec![orbit.point];
            for radius in [radius, 0.5 * radius] {
                points.extend(lattice.iter().map(|it| linear.point(it, radius)));
            }
            let returns = returns_of(points.clone());
            let own = returns.first()?.as_ref()?;
            let passes = points.iter().zip(&returns).all(|(point, back)| {
                let back = back.as_ref().filter(|back| back.events == own.events);
                back.is_some_and(|back| linear.leads(point, &back.end, &own.end))
            });
            if passes {
                return Some(linear.neighbourhood(SAFETY * radius));
            }
            radius *= SMALLER;
        }
        None
    }
}

/// The linear part of a return map at a point of an orbit, in the units of a metric.
struct LinearMap<'a, const D: usize> {
    centre: [f64; D],
    metric: &'a Metric<D>,
    /// The coordinates that are exactly zero and stay so.
    at_rest: [bool; D],
    map: Matrix<D>,
    norm: Norm<D>,
}

impl<'a, const D: usize> LinearMap<'a, D> {
    /// That of an orbit's point; none where it does not shrink every difference.
    fn of(orbit: &OrbitPoint<D>, metric: &'a Metric<D>) -> Option<Self> {
        let OrbitPoint { point: centre, jacobian } = *orbit;
        let at_rest = std::array::from_fn(|i| centre[i] == 0.0 && jacobian[i] == [0.0; D]);
        let map = scaled(&jacobian, metric, &at_rest);
        let norm = Norm::of(&map)?;
        Some(LinearMap { centre, metric, at_rest, map, norm })
    }

    /// How far a point is from the orbit's, in the units of the metric.
    fn away(&self, point: &[f64; D]) -> [f64; D] {
        self.metric.scaled(&self.metric.difference(point, &self.centre))
    }

    /// The point in a direction on the ellipsoid of a radius.
    fn point(&self, direction: &[f64; D], radius: f64) -> [f64; D] {
        let along = self.norm.unit(direction);
        std::array::from_fn(|i| self.centre[i] + radius * along[i] / self.metric.scales[i])
    }

    /// Whether a point is led to its image nearly as the linear map leads it from the orbit's point, whose image is known,
    /// too.
    fn leads(&self, point: &[f64; D], image: &[f64; D], own: &[f64; D]) -> bool {
        let from = self.away(point);
        let to = self.metric.scaled(&self.metric.difference(image, own));
        let rest = std::array::from_fn(|i| {
            to[i] - self.map[i].iter().zip(&from).map(|(a, x)| a * x).sum::<f64>()
        });
        let allowed = CURVED * (1.0 - self.norm.theta) * self.norm.size(&from);
        let rests = (0..D).all(|i| !self.at_rest[i] || image[i] == 0.0);
        rests && self.norm.size(&rest) <= allowed
    }

    /// The ellipsoid of a radius.
    fn neighbourhood(&self, radius: f64) -> Neighbourhood<D> {
        let scales = &self.metric.scales;
        let form = std::array::from_fn(|i| {
            let of = |j: usize| self.norm.form[i][j] * scales[i] * scales[j] / (radius * radius);
            std::array::from_fn(of)
        });
        let (centre, at_rest) = (self.centre, self.at_rest);
        Neighbourhood { centre, form, at_rest, metric: *self.metric }
    }
}

/// A norm in which a linear map shrinks every vector.
struct Norm<const D: usize> {
    form: Matrix<D>,
    /// The lower factor of the form by Cholesky.
    factor: Matrix<D>,
    /// The map shrinks by this factor at least.
    theta: f64,
}

impl<const D: usize> Norm<D> {
    /// That of a map; none where its powers do not die out.
    fn of(map: &Matrix<D>) -> Option<Self> {
        let mut form: Matrix<D> =
            std::array::from_fn(|i| std::array::from_fn(|j| f64::from(i == j)));
        let mut power = *map;
        // Each turn adds as many terms as there are.
        for _ in 0..DOUBLINGS {
            let more = product(&transposed(&power), &product(&form, &power));
            let before = form;
            for (row, more) in form.iter_mut().zip(&more) {
                row.iter_mut().zip(more).for_each(|(x, more)| *x += more);
            }
            if form == before {
                break;
            }
            power = product(&power, &power);
        }
        let trace: f64 = (0..D).map(|i| form[i][i]).sum();
        // The largest eigenvalue of the form is below its trace.
        let theta = (1.0 - 1.0 / trace).sqrt();
        let factor = cholesky(&form)?;
        (theta < 1.0).then_some(Norm { form, factor, theta })
    }

    /// The size of a vector.
    fn size(&self, vector: &[f64; D]) -> f64 {
        let upper = transposed(&self.factor);
        let sum = |row: &[f64; D]| row.iter().zip(vector).map(|(a, x)| a * x).sum::<f64>();
        upper.iter().map(sum).map(|it| it * it).sum::<f64>().sqrt()
    }

    /// The vector of size one that a unit vector of the plain norm is led to.
    fn unit(&self, direction: &[f64; D]) -> [f64; D] {
        // The transposed factor is upper triangular.
        let mut vector = *direction;
        for i in (0..D).rev() {
            let known: f64 = (i + 1..D).map(|j| self.factor[j][i] * vector[j]).sum();
            vector[i] = (vector[i] - known) / self.factor[i][i];
        }
        vector
    }

    /// By how much a map makes vectors longer at most.
    fn growth(&self, map: &Matrix<D>) -> f64 {
        // L' A (L')^-1, column by column.
        let mut columns = [[0.0; D]; D];
        for (j, column) in columns.iter_mut().enumerate() {
            let unit = self.unit(&std::array::from_fn(|i| f64::from(i == j)));
            let image: [f64; D] =
                std::array::from_fn(|i| (0..D).map(|k| map[i][k] * unit[k]).sum::<f64>());
            *column = std::array::from_fn(|i| (i..D).map(|k| self.factor[k][i] * image[k]).sum());
        }
        // The columns as rows are the transpose, whose product with its own transpose has the same eigenvalues.
        let square = product(&columns, &transposed(&columns));
        eigenvalues(&square)[0].abs().sqrt()
    }
}

/// The directions whose coordinates are -1, 0 and 1 up to a factor, but for those at rest.
fn lattice<const D: usize>(at_rest: &[bool; D]) -> Vec<[f64; D]> {
    let mut directions = vec![[0.0; D]];
    for i in (0..D).filter(|i| !at_rest[*i]) {
        let longer = |value: f64| {
            move |mut direction: [f64; D]| {
                direction[i] = value;
                direction
            }
        };
        directions = [-1.0, 0.0, 1.0]
            .into_iter()
            .flat_map(|value| directions.iter().copied().map(longer(value)).collect::<Vec<_>>())
            .collect();
    }
    let length = |it: &[f64; D]| it.iter().map(|x| x * x).sum::<f64>().sqrt();
    directions.retain(|it| length(it) > 0.0);
    directions.iter().map(|it| it.map(|x| x / length(it))).collect()
}

/// A Jacobian in the units of a metric, without what is at rest.
fn scaled<const D: usize>(
    jacobian: &Matrix<D>,
    metric: &Metric<D>,
    at_rest: &[bool; D],
) -> Matrix<D> {
    let scales = &metric.scales;
    std::array::from_fn(|i| {
        std::array::from_fn(|j| match at_rest[i] || at_rest[j] {
            true => 0.0,
            false => jacobian[i][j] * scales[i] / scales[j],
        })
    })
}

fn transposed<const D: usize>(a: &Matrix<D>) -> Matrix<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

fn product<const D: usize>(a: &Matrix<D>, b: &Matrix<D>) -> Matrix<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..D).map(|k| a[i][k] * b[k][j]).sum()))
}

/// The lower factor L of a positive definite matrix L L'; none where it is not.
fn cholesky<const D: usize>(a: &Matrix<D>) -> Option<Matrix<D>> {
    let mut lower = [[0.0; D]; D];
    for i in 0..D {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let rest = a[i][j] - known;
            lower[i][j] = if i == j { rest.sqrt() } else { rest / lower[j][j] };
            if !lower[i][j].is_finite() || (i == j && lower[i][j] <= 0.0) {
                return None;
            }
        }
    }
    Some(lower)
}
