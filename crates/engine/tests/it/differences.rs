//! Derivatives of a return map by differences: the second method for everything that is linearised.

use capsulemap_engine::flow::{Motion, Step, Stroboscopic};
use capsulemap_engine::lane::Lane;

/// Tight enough that differences of the map see its slope rather than its rounding.
pub const TOLERANCE: f64 = 1e-15;

/// Widths tried, each a quarter of the one before.
const WIDTHS: usize = 11;

/// Where `system` is `k` cycles after a point of the section, in numbers of any kind; each step is shown to
/// `see`.
pub fn followed<L, S, const D: usize>(
    system: &S,
    from: [L; D],
    k: u64,
    mut see: impl FnMut(&Step<L, S>),
) -> [L; D]
where
    L: Lane<Mask = bool>,
    S: Stroboscopic<L, D>,
{
    let mut motion = Motion::new(system, L::splat(0.0), S::state(from));
    let mut step = Step::default();
    let period = system.period();
    for _ in 0..k {
        loop {
            motion.step(system, period, TOLERANCE, &mut step);
            see(&step);
            assert_eq!(motion.breakdown(system, &step, 0), None, "the integration continues");
            if period.le(motion.time) {
                break;
            }
        }
        motion.begin_cycle(system, true);
    }
    S::point(&motion.state)
}

/// A slope, and how far differences at two successive widths disagree about it.
#[derive(Debug, Clone, Copy)]
pub struct Slope<const D: usize> {
    /// The slope.
    pub value: [f64; D],
    /// The least disagreement of successive widths.
    pub doubt: f64,
}

/// The slope of `image` at zero, its coordinates compared after multiplication with `weights`.
///
/// Method: central differences at widths that shrink from `widest`, each pair of them extrapolated after
/// Richardson; of the successive extrapolations those are taken that agree best. The exact slope is not
/// looked at. Where a guard is nearly touched no two widths agree, which `doubt` shows.
pub fn slope<const D: usize>(
    image: impl Fn(f64) -> [f64; D],
    widest: f64,
    weights: &[f64; D],
) -> Slope<D> {
    let widths: [f64; WIDTHS] = std::array::from_fn(|i| widest * 0.25_f64.powi(i as i32));
    let central = widths.map(|h| {
        let (ahead, behind) = (image(h), image(-h));
        std::array::from_fn::<f64, D, _>(|i| (ahead[i] - behind[i]) / (2.0 * h))
    });
    let extrapolated: Vec<[f64; D]> = central
        .windows(2)
        .map(|pair| std::array::from_fn(|i| (16.0 * pair[1][i] - pair[0][i]) / 15.0))
        .collect();
    let doubts = extrapolated
        .windows(2)
        .map(|pair| Slope { value: pair[1], doubt: distance(&pair[0], &pair[1], weights) });
    doubts.min_by(|a, b| a.doubt.total_cmp(&b.doubt)).expect("several widths")
}

/// The largest weighted difference of two points.
pub fn distance<const D: usize>(a: &[f64; D], b: &[f64; D], weights: &[f64; D]) -> f64 {
    (0..D).map(|i| (weights[i] * (a[i] - b[i])).abs()).fold(0.0, f64::max)
}

/// The largest weighted coordinate.
pub fn size<const D: usize>(a: &[f64; D], weights: &[f64; D]) -> f64 {
    distance(a, &[0.0; D], weights)
}
