//! How much room a basin has where it is widest.

use super::distance::squares_of_distances;
use super::share::Label;

/// How much room the basin of an attractor has, by a grid of starts.
///
/// Distances are Euclidean, in the units of the positions that are given. Source: Rega and Lenci (2005), here as a radius that
/// is not divided by one of reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Integrity {
    /// The radius of the largest ball of starts that all lead to the attractor, anywhere on the grid; zero where it has none.
    pub factor: f64,
    /// The starts are so far apart at most, the diagonal of a cell: the boundary may be nearer by so much.
    pub error: f64,
}

/// The room of the basin of attractor `number` on a grid of starts with these positions along its `axes`, the last axis fastest.
///
/// Method: the exact distance of every start from the nearest that leads elsewhere, axis by axis (Felzenszwalb and
/// Huttenlocher 2012), and from the ends of the grid, beyond which nothing is known.
/// Starts that have not been computed lead elsewhere.
pub fn integrity(axes: &[Vec<f64>], label: impl Fn(usize) -> Label, number: u32) -> Integrity {
    let gaps = axes.iter().map(|axis| largest_gap(axis));
    let error = gaps.map(|gap| gap * gap).sum::<f64>().sqrt();
    let factor = largest_ball(axes, |start| label(start) == Label::Attractor(number));
    Integrity { factor, error }
}

fn largest_gap(axis: &[f64]) -> f64 {
    axis.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max)
}

fn largest_ball(axes: &[Vec<f64>], own: impl Fn(usize) -> bool) -> f64 {
    let squares = squares_of_distances(axes, |start| !own(start));
    let ends: Vec<[f64; 2]> = axes.iter().map(|axis| ends_of(axis)).collect();
    let mut largest: f64 = 0.0;
    each_start(axes, |start, at| {
        let to_ends = at.iter().zip(&ends).flat_map(|(x, ends)| ends.map(|end| (x - end).abs()));
        let radius = squares[start].sqrt().min(to_ends.fold(f64::INFINITY, f64::min));
        if radius.is_finite() {
            largest = largest.max(radius);
        }
    });
    largest
}

fn ends_of(axis: &[f64]) -> [f64; 2] {
    match axis.len() {
        // An axis of one start has no extent.
        1 => [f64::NEG_INFINITY, f64::INFINITY],
        _ => [f64::min, f64::max].map(|it| axis.iter().copied().fold(axis[0], it)),
    }
}

/// Calls a function with each start and its position, the last axis fastest.
fn each_start(axes: &[Vec<f64>], mut call: impl FnMut(usize, &[f64])) {
    let starts = axes.iter().map(Vec::len).product();
    let mut position = vec![0; axes.len()];
    let mut at: Vec<f64> = axes.iter().map(|axis| axis[0]).collect();
    for start in 0..starts {
        call(start, &at);
        for (place, axis) in axes.iter().enumerate().rev() {
            position[place] = (position[place] + 1) % axis.len();
            at[place] = axis[position[place]];
            if position[place] > 0 {
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Positions along an axis that are not even, so that indices could not stand for them.
    fn axis(ends: [f64; 2], count: usize) -> Vec<f64> {
        let at = |i: usize| i as f64 / (count - 1) as f64;
        let uneven = |i: usize| at(i) + 0.1 * (at(i) * std::f64::consts::PI).sin();
        (0..count).map(|i| ends[0] + (ends[1] - ends[0]) * uneven(i)).collect()
    }

    #[test]
    fn the_room_of_a_disc_is_its_radius() {
        let axes = [axis([-1.0, 2.0], 301), axis([1.5, -1.2], 281)];
        let disc = |start: usize| {
            let (x, y) = (axes[0][start / 281] - 0.3, axes[1][start % 281] + 0.1);
            Label::Attractor(u32::from(x.hypot(y) < 0.7))
        };
        let room = integrity(&axes, disc, 1);
        assert!((room.factor - 0.7).abs() < room.error && room.error < 0.03, "{room:?}");
        assert_eq!(integrity(&axes, disc, 2).factor, 0.0);
    }

    #[test]
    fn distances_are_those_of_looking_at_every_pair() {
        let mut random = fastrand::Rng::with_seed(5);
        for _ in 0..20 {
            let axes = [axis([0.0, 1.0], 9), axis([0.0, 2.0], 7), axis([-1.0, 0.0], 5)];
            let own: Vec<bool> = (0..9 * 7 * 5).map(|_| random.f64() < 0.8).collect();
            let mut places = Vec::new();
            each_start(&axes, |_, at| places.push(at.to_vec()));
            let apart = |a: &[f64], b: &[f64]| {
                a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
            };
            let room = |start: &usize| {
                let others = (0..own.len()).filter(|other| !own[*other]);
                let nearest = others.map(|it| apart(&places[*start], &places[it]));
                let ends = places[*start].iter().zip(&axes);
                let ends = ends.flat_map(|(x, axis)| {
                    [axis[0], axis[axis.len() - 1]].map(|end| (x - end).abs())
                });
                nearest.chain(ends).fold(f64::INFINITY, f64::min)
            };
            let expected =
                (0..own.len()).filter(|it| own[*it]).map(|it| room(&it)).fold(0.0, f64::max);
            assert!((largest_ball(&axes, |start| own[start]) - expected).abs() < 1e-12);
        }
    }
}
