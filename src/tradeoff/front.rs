//! The Pareto front of a gain over its price, as of speed over energy: the cases that no other beats in gain without taking more.

/// A capsule slower than this share of the fastest is at rest beside it, and so with any gain.
pub const REST: f64 = 1e-6;
/// A section repeats no more closely than that a capsule at rest seems to move so fast [m/s].
pub const NOISE: f64 = 1e-10;

/// The speed up to which a case counts as at rest among cases with these speeds [m/s].
///
/// A front that goes on below it would follow rounding.
pub fn speed_at_rest(speeds: impl IntoIterator<Item = f64>) -> f64 {
    let fastest = speeds.into_iter().fold(0.0, |fastest: f64, speed| fastest.max(speed.abs()));
    (REST * fastest).max(NOISE)
}

/// The places of the cases on the Pareto front, by rising energy, of cases with these energies and speeds.
///
/// Cases that move in one direction have a front of their own: those of the other, and those at rest
/// ([`speed_at_rest`]), are no gain at any price and not to be given. Backward speeds are given by their magnitude.
///
/// # Method
///
/// The cases are sorted by energy, those of the same energy by falling speed, and each is kept whose speed
/// exceeds that of the last one kept.
///
/// # Assumes
///
/// The numbers are finite. Units do not matter, as only comparisons are made.
///
/// # Guarantees
///
/// Energy and speed both rise strictly along the front. No case has more speed than a case of the front for the same
/// energy or less, or the same speed for less; and every case that is not on the front is matched by one that is: it
/// has no less speed and takes no more energy. Of cases that agree in both numbers the first given is on the front.
/// The front of no cases is empty, that of others is not.
///
/// # Panics
///
/// If there are not as many speeds as energies.
pub fn front(energies: &[f64], speeds: &[f64]) -> Vec<usize> {
    assert_eq!(energies.len(), speeds.len(), "each case has an energy and a speed");
    let mut order: Vec<usize> = (0..speeds.len()).collect();
    order.sort_by(|&a, &b| {
        let (cheaper, faster) =
            (energies[a].total_cmp(&energies[b]), speeds[b].total_cmp(&speeds[a]));
        cheaper.then(faster)
    });
    let mut front: Vec<usize> = Vec::new();
    for case in order {
        if front.last().is_none_or(|&last| speeds[case] > speeds[last]) {
            front.push(case);
        }
    }
    front
}
