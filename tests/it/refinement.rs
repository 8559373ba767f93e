//! A refined grid has the labels of the full one outside what is flagged as inferred, for less.

use capsulemap::study::{Refinement, Refining};

/// The label of every case of a refined grid, tile by tile and then as a whole, and which of them were computed.
fn refined(shape: &[usize], label: impl Fn(usize) -> u32) -> (Vec<u32>, Vec<bool>) {
    let (refinement, cases) = (Refinement::of(shape), shape.iter().product());
    let mut computed = vec![false; cases];
    let alike: fn(&u32, &u32) -> bool = |a, b| a == b;
    for tile in 0..refinement.tiles() {
        let mut refining = Refining::tile(&refinement, tile, alike);
        complete(&mut refining, &label, &mut computed);
    }
    let mut whole = Refining::whole(&refinement, alike);
    for case in (0..cases).filter(|case| computed[*case]) {
        whole.note(case, label(case));
    }
    complete(&mut whole, &label, &mut computed);
    let mut labels: Vec<Option<u32>> = vec![None; cases];
    for case in (0..cases).filter(|case| computed[*case]) {
        labels[case] = Some(label(case));
    }
    whole.inferred(|case, corners| {
        let (_, inferred) = corners[0];
        assert!(!computed[case] && corners.iter().all(|(_, label)| *label == inferred));
        assert!(
            labels[case].is_none_or(|other| other == *inferred),
            "{case} is inferred in two ways"
        );
        labels[case] = Some(*inferred);
    });
    let labels = labels.into_iter().map(|it| it.expect("every case is computed or inferred"));
    (labels.collect(), computed)
}

fn complete(refining: &mut Refining<u32>, label: impl Fn(usize) -> u32, computed: &mut [bool]) {
    loop {
        let wanted = refining.wanted();
        assert!(wanted.is_sorted());
        if wanted.is_empty() {
            return;
        }
        for case in wanted {
            refining.note(case, label(case));
            computed[case] = true;
        }
    }
}

/// Where a case lies, from -1 to 1 along each axis.
fn place(case: usize, shape: &[usize]) -> Vec<f64> {
    let mut rest = case;
    let mut place: Vec<f64> = shape
        .iter()
        .rev()
        .map(|&length| {
            let at = rest % length;
            rest /= length;
            if length > 1 { 2.0 * at as f64 / (length - 1) as f64 - 1.0 } else { 0.0 }
        })
        .collect();
    place.reverse();
    place
}

fn share(computed: &[bool]) -> f64 {
    computed.iter().filter(|it| **it).count() as f64 / computed.len() as f64
}

#[test]
fn a_smooth_boundary_is_found_in_any_grid() {
    let shapes: [&[usize]; 9] = [
        &[1],
        &[2],
        &[5000],
        &[200, 200],
        &[257, 513],
        &[700, 333],
        &[1, 900],
        &[40, 50, 33],
        &[20, 17, 23, 19],
    ];
    for shape in shapes {
        let inside = |case: usize| {
            let square: f64 = place(case, shape).iter().map(|x| (x - 0.1) * (x - 0.1)).sum();
            u32::from(square < 0.4)
        };
        let (labels, computed) = refined(shape, inside);
        let wrong = (0..labels.len()).filter(|case| labels[*case] != inside(*case)).count();
        assert_eq!(wrong, 0, "{shape:?}");
        let most = if shape.iter().all(|length| *length >= 128) { 0.5 } else { 1.0 };
        assert!(share(&computed) <= most, "{shape:?}: {}", share(&computed));
    }
}

#[test]
fn a_fine_grid_is_computed_along_its_boundary_alone() {
    let shape = [2048, 2048];
    let spiral = |case: usize| {
        let at = place(case, &shape);
        let turns = at[1].atan2(at[0]) / std::f64::consts::TAU + 3.0 * at[0].hypot(at[1]);
        (turns.rem_euclid(1.0) * 3.0) as u32
    };
    let (labels, computed) = refined(&shape, spiral);
    assert!((0..labels.len()).all(|case| labels[case] == spiral(case)));
    assert!(share(&computed) < 0.06, "{}", share(&computed));
}

#[test]
fn a_tongue_is_followed_through_tiles_where_it_touches_no_corner() {
    // Narrower than a coarse cell, and seen at its foot only, where it is broad.
    let shape = [1024, 1024];
    let tongue = |case: usize| {
        let at = place(case, &shape);
        let middle = 0.03 + 0.2 * (2.0 * at[0]).sin();
        u32::from(at[0] < -0.95 || (at[1] - middle).abs() < 0.004)
    };
    let (labels, computed) = refined(&shape, tongue);
    assert!((0..labels.len()).all(|case| labels[case] == tongue(case)));
    assert!(share(&computed) < 0.12, "{}", share(&computed));
}

#[test]
fn what_cannot_be_told_is_computed() {
    let (shape, cases) = ([256, 256], 256 * 256);
    let refinement = Refinement::of(&shape);
    let never: fn(&u32, &u32) -> bool = |_, _| false;
    let mut refining = Refining::whole(&refinement, never);
    let mut computed = vec![false; cases];
    complete(&mut refining, |_| 0, &mut computed);
    assert!(computed.iter().all(|it| *it));
}

#[test]
fn every_case_belongs_to_one_tile() {
    let shapes: [&[usize]; 6] = [&[], &[1], &[300, 129], &[257, 257], &[65, 33, 34], &[1, 400]];
    for shape in shapes {
        let refinement = Refinement::of(shape);
        let mut seen = vec![0; shape.iter().product()];
        for tile in 0..refinement.tiles() {
            let cases = refinement.cases(tile);
            assert!(cases.is_sorted() && cases.len() == refinement.count(tile));
            cases.into_iter().for_each(|case| seen[case] += 1);
        }
        assert!(seen.iter().all(|count| *count == 1), "{shape:?}");
    }
}

/// A field that is linear along each axis is interpolated without error, and one that is not within its spread in a cell.
#[test]
fn inferred_values_are_interpolated_between_the_corners() {
    for shape in [vec![300, 260], vec![70, 70, 40]] {
        let (refinement, cases) = (Refinement::of(&shape), shape.iter().product());
        let linear = |at: &[f64]| at.iter().map(|x| 3.0 + 2.0 * x).product::<f64>();
        let bent = |at: &[f64]| 2.0 * (4.0 * at[0]).sin() * at[1].exp() + at.iter().sum::<f64>();
        let labels = |case: usize| {
            let at = place(case, &shape);
            [linear(&at), bent(&at)]
        };
        let alike: fn(&[f64; 2], &[f64; 2]) -> bool = |a, b| (a[1] - b[1]).abs() <= 0.5;
        let mut refining = Refining::whole(&refinement, alike);
        let (mut computed, mut inferred) = (0, 0);
        loop {
            let wanted = refining.wanted();
            if wanted.is_empty() {
                break;
            }
            computed += wanted.len();
            wanted.into_iter().for_each(|case| refining.note(case, labels(case)));
        }
        refining.inferred(|case, corners| {
            let weights: f64 = corners.iter().map(|(weight, _)| weight).sum();
            let value = |of: usize| corners.iter().map(|(weight, it)| weight * it[of]).sum::<f64>();
            let truth = labels(case);
            assert!((weights - 1.0).abs() < 1e-12);
            assert!((value(0) - truth[0]).abs() < 1e-10, "{} {}", value(0), truth[0]);
            assert!((value(1) - truth[1]).abs() <= 1.0, "{} {}", value(1), truth[1]);
            inferred += 1;
        });
        assert!(inferred > cases / 10 && inferred + computed >= cases, "{inferred} {computed}");
    }
}
