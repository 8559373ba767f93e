//! Samples of a motion in numbers with derivatives, a few directions at a time, of any model.

use capsulemap_engine::flow::Reason;
use capsulemap_engine::lane::{Dual, Lane};

/// Directions that are differentiated at a time.
const AT_ONCE: usize = 4;

/// Values of a motion at given times, with their slopes.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// The values, by column and time (SI).
    pub values: Vec<Vec<f64>>,
    /// Their derivatives, by column, time and direction (SI).
    pub slopes: Vec<Vec<Vec<f64>>>,
}

/// A motion that can be read at given times in numbers of any kind.
pub trait Sampled<D> {
    /// What the motion starts from, or depends on, in a direction.
    fn value(&self, direction: D) -> f64;

    /// What is read, by column and time, in the motion whose values are those `of` directions.
    ///
    /// Fails where the motion cannot be followed.
    fn followed<L: Lane>(&self, of: impl Fn(D) -> L) -> Result<Vec<Vec<L>>, Reason>;
}

/// What is read of a motion, and its derivatives in `directions`: the motion is followed once for four of them, in dual numbers.
///
/// Fails where the motion cannot be followed.
pub fn samples<D: Copy + PartialEq>(
    motion: &impl Sampled<D>,
    directions: &[D],
) -> Result<Samples, Reason> {
    let mut samples = Samples { values: Vec::new(), slopes: Vec::new() };
    if directions.is_empty() {
        samples.values = motion.followed(|it| motion.value(it))?;
        samples.slopes = of_each(&samples.values, |_| Vec::new());
        return Ok(samples);
    }
    for some in directions.chunks(AT_ONCE) {
        let found = motion.followed(|it| seeded(motion.value(it), it, some))?;
        if samples.values.is_empty() {
            samples.values = of_each(&found, |number| number.value);
            samples.slopes = of_each(&found, |_| Vec::with_capacity(directions.len()));
        }
        for (slopes, found) in samples.slopes.iter_mut().zip(&found) {
            for (slopes, number) in slopes.iter_mut().zip(found) {
                slopes.extend(&number.gradient[..some.len()]);
            }
        }
    }
    Ok(samples)
}

/// A value in a direction, with the derivatives in some directions.
fn seeded<D: PartialEq>(value: f64, direction: D, some: &[D]) -> Dual<f64, AT_ONCE> {
    match some.iter().position(|it| *it == direction) {
        Some(place) => Dual::variable(value, place),
        None => Dual::constant(value),
    }
}

fn of_each<T, U>(columns: &[Vec<T>], of: impl Fn(&T) -> U) -> Vec<Vec<U>> {
    columns.iter().map(|column| column.iter().map(&of).collect()).collect()
}
