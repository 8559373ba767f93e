//! Cases drawn from ranges, each of them computed from its index alone.

use std::fmt::{self, Debug, Formatter};

use super::axis::Spacing;
use super::sobol_points::sobol;
use super::{Coordinate, Normal, Saltelli};

/// How points are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DrawKind {
    /// Independent and evenly distributed.
    #[default]
    Uniform,
    /// More evenly spread over the ranges than independent points are.
    LowDiscrepancy,
    /// Rows of cases from which Sobol indices are estimated, see [`Saltelli`].
    Saltelli,
}

impl DrawKind {
    /// Each kind by its name in studies and files.
    pub const NAMES: [(&str, DrawKind); 3] = [
        ("uniform", DrawKind::Uniform),
        ("low-discrepancy", DrawKind::LowDiscrepancy),
        ("saltelli", DrawKind::Saltelli),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        DrawKind::NAMES[self as usize].0
    }
}

/// What is drawn and from where (SI).
#[derive(Clone, Copy, PartialEq)]
pub struct Range {
    /// What is drawn.
    pub coordinate: Coordinate,
    /// One end.
    pub from: f64,
    /// The other end.
    pub to: f64,
    /// Whether the value is evenly distributed or its logarithm.
    pub spacing: Spacing,
    /// The distribution of the value, cut at the two ends, where it is not evenly distributed.
    pub normal: Option<Normal>,
}

impl Range {
    /// A range over which a value, or its logarithm, is evenly distributed.
    pub fn even(coordinate: Coordinate, [from, to]: [f64; 2], spacing: Spacing) -> Range {
        Range { coordinate, from, to, spacing, normal: None }
    }

    /// What is to be said of a distribution that is cut; none of an even one.
    pub(super) fn remark(&self) -> Option<String> {
        let Normal { mean, deviation } = self.normal?;
        let (name, unit) = (self.coordinate.name(), self.coordinate.dimension().unit());
        let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
        let left_out = 1.0 - self.normal?.probability(self.from, self.to);
        Some(format!(
            "{name} is drawn from a normal distribution of mean {mean}{unit} and deviation {deviation}{unit}, cut at {}{unit} and {}{unit}, \
             which leaves out {left_out:.1e} of it",
            self.from, self.to
        ))
    }
}

/// As fingerprints of studies have it: an even range as before there were others.
impl Debug for Range {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Range { coordinate, from, to, spacing, normal } = self;
        let mut fields = f.debug_struct("Range");
        fields.field("coordinate", coordinate).field("from", from).field("to", to);
        fields.field("spacing", spacing);
        if let Some(normal) = normal {
            fields.field("normal", normal);
        }
        fields.finish()
    }
}

/// Points drawn from ranges.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Draws {
    /// How they are drawn.
    pub kind: DrawKind,
    /// Number of points, each of which is a case.
    pub count: usize,
    /// Tells sets of points apart that are drawn alike.
    pub seed: u64,
    /// What is drawn, in the order of the study.
    pub ranges: Vec<Range>,
}

/// The odd number next to 2^64 over the golden ratio, by which the states of the generator differ.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Steps of Newton's method, which has converged long before.
const STEPS: usize = 32;

impl Draws {
    /// The dimension of the results.
    pub const DIMENSION: &str = "draw";

    /// The design that the draws are, if they are one.
    pub fn saltelli(&self) -> Option<Saltelli> {
        let is_one = self.kind == DrawKind::Saltelli;
        is_one.then_some(Saltelli { quantities: self.ranges.len() })
    }

    /// Draws that belong together: those of a row of a design.
    pub fn row_length(&self) -> usize {
        self.saltelli().map_or(1, Saltelli::row_length)
    }

    /// Leaves out all but so many of the first draws, or those of whole rows of a design.
    pub fn truncate(&mut self, most: usize) {
        self.count = self.count.min(most.next_multiple_of(self.row_length()));
    }

    /// Value of range number `place` in draw `index`.
    pub fn value(&self, index: usize, place: usize) -> f64 {
        let Range { from, to, spacing, normal, .. } = self.ranges[place];
        let share = self.share(index, place);
        let value = match normal {
            None => spacing.at(from, to, share),
            Some(normal) => normal.quantile(from, to, share),
        };
        value.clamp(from.min(to), from.max(to))
    }

    /// Where draw `index` lies in range number `place`, from 0 to below 1.
    ///
    /// # Method
    ///
    /// Every range has a number s of its own, output `place` of SplitMix64 from the seed. Uniform: output `index`
    /// of SplitMix64 from s. Low discrepancy: the fraction of s / 2^64 + (index + 1) a^(-place - 1), the
    /// additive recurrence R_d over d ranges, where a is the root above one of x^(d + 1) = x + 1; in integers
    /// modulo 2^64, so that no digit is lost at large indices. Saltelli: the coordinate of a Sobol' point that [`Saltelli::source`]
    /// tells, with the bits of the number s of that coordinate by exclusive or: a digital shift, which keeps the points as even as they are.
    ///
    /// # Source
    ///
    /// G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators, OOPSLA 2014, with
    /// the constants of S. Vigna's splitmix64.c. M. Roberts, The unreasonable effectiveness of quasirandom
    /// sequences, 2018. The shift by s: R. Cranley, T. N. L. Patterson, SIAM J. Numer. Anal. 13, 1976; in digits: P. L'Ecuyer,
    /// C. Lemieux, Recent advances in randomized quasi-Monte Carlo methods, 2002.
    ///
    /// # Guarantees
    ///
    /// The same on every machine, and for each draw whatever the number of draws is: a longer study begins
    /// with the draws of a shorter one.
    ///
    /// # Breaks
    ///
    /// The recurrence is evenly spread for up to some eight ranges; for more, uniform draws are as good.
    pub fn share(&self, index: usize, place: usize) -> f64 {
        let own = splitmix(self.seed, place as u64);
        let bits = match self.kind {
            DrawKind::Uniform => splitmix(own, index as u64),
            DrawKind::LowDiscrepancy => {
                let step = recurrence_step(self.ranges.len(), place);
                own.wrapping_add(step.wrapping_mul(index as u64 + 1))
            }
            DrawKind::Saltelli => {
                let [row, column] = Saltelli { quantities: self.ranges.len() }.source(index, place);
                sobol(row as u64, column) ^ splitmix(self.seed, column as u64)
            }
        };
        (bits >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Output `index` of the generator SplitMix64 from `seed`.
fn splitmix(seed: u64, index: u64) -> u64 {
    let mut z = seed.wrapping_add(GOLDEN.wrapping_mul(index.wrapping_add(1)));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The step of the recurrence in range number `place` of `ranges`, in parts of 2^64.
fn recurrence_step(ranges: usize, place: usize) -> u64 {
    let power = ranges as i32 + 1;
    let mut root = 2.0_f64;
    for _ in 0..STEPS {
        let below = whole_power(root, power - 1);
        root -= (below * root - root - 1.0) / (f64::from(power) * below - 1.0);
    }
    // Below one, so that the product is below 2^64.
    let share = 1.0 / whole_power(root, place as i32 + 1);
    (share * 18_446_744_073_709_551_616.0) as u64
}

/// `x` to a whole power, by the same products on every machine.
fn whole_power(x: f64, power: i32) -> f64 {
    (0..power).fold(1.0, |product, _| product * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_generator_is_splitmix64() {
        // The first outputs of splitmix64.c from the seed 1234567.
        let known =
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
        for (index, expected) in known.into_iter().enumerate() {
            assert_eq!(splitmix(1_234_567, index as u64), expected);
        }
    }

    #[test]
    fn the_recurrence_has_the_golden_and_the_plastic_number() {
        let share = |ranges, place| recurrence_step(ranges, place) as f64 / 2.0_f64.powi(64);
        assert!((share(1, 0) - 0.618_033_988_749_894_9).abs() < 1e-15);
        assert!((share(2, 0) - 0.754_877_666_246_692_8).abs() < 1e-15);
        assert!((share(2, 1) - 0.569_840_290_998_053_3).abs() < 1e-15);
        for ranges in 1..20 {
            let root = 1.0 / share(ranges, 0);
            let rest = libm::pow(root, ranges as f64 + 1.0) - root - 1.0;
            assert!(rest.abs() < 1e-13, "{ranges}: {rest:e}");
        }
    }
}
