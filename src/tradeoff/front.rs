//! The Pareto front of speed over energy: the cases that no other beats in speed without taking more energy.

/// The places of the cases on the Pareto front, by rising energy, of cases with these energies and speeds.
///
/// Where any case moves forward, those that do not are no gain at any price and are left out.
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
/// Energy and speed both rise strictly along the front. No case considered has more speed than a case of the
/// front for the same energy or less, or the same speed for less; and every case considered that is not on the
/// front is matched by one that is: it has no less speed and takes no more energy. Of cases that agree in both
/// numbers the first given is on the front. The front of no cases is empty, that of others is not.
///
/// # Panics
///
/// If there are not as many speeds as energies.
pub fn front(energies: &[f64], speeds: &[f64]) -> Vec<usize> {
    assert_eq!(energies.len(), speeds.len(), "each case has an energy and a speed");
    let forward = speeds.iter().any(|speed| *speed > 0.0);
    let mut order: Vec<usize> =
        (0..speeds.len()).filter(|case| speeds[*case] > 0.0 || !forward).collect();
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
