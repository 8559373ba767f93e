//! Short parts of a motion follow each other as one motion, and tell the friction where sliding ends.

use std::f64::consts::TAU;

use capsulemap_models::capsule::{Forces, Parameters, State, arc, simulate};

#[test]
fn arcs_follow_each_other_as_one_motion() {
    let parameters = Parameters::default();
    let simulation = simulate(&parameters, 0.3, State::default(), 3, 1e-12);
    let parts = 40;
    let (mut state, mut events) = (State::default(), 0);
    for part in 0..3 * parts {
        let phases = [part, part + 1].map(|it| 0.3 + TAU * f64::from(it) / f64::from(parts));
        let points = arc(&parameters, state, phases, 5, 1e-12).expect("it can be followed");
        assert!(points.is_sorted_by(|a, b| a.time <= b.time));
        events +=
            points.len() - 5 - points.windows(2).filter(|it| it[0].time == it[1].time).count();
        state = points[points.len() - 1].state;
    }
    let end = simulation.section[3];
    assert!((state.r - end.r).abs() < 1e-11 && (state.x2 - end.x2).abs() < 1e-11);
    assert!((state.y1 - end.y1).abs() < 1e-9 && (state.y2 - end.y2).abs() < 1e-9);
    // An event at the end of an arc may be met there, or at the beginning of the next.
    assert!(events.abs_diff(simulation.events.len()) <= 1, "{events}");
    assert!(simulation.events.len() > 8);
}

#[test]
fn friction_where_sliding_ends_is_that_of_sliding() {
    let parameters = Parameters::default();
    let (mut state, mut ends) = (State::default(), 0);
    for part in 0..400 {
        let phases = [part, part + 1].map(|it| TAU * f64::from(it) / 40.0);
        let points = arc(&parameters, state, phases, 5, 1e-12).expect("it can be followed");
        for pair in points.windows(2) {
            let [before, here] = [pair[0].state.y2, pair[1].state.y2];
            let friction = Forces::of(&parameters, &pair[1].state).friction;
            // What is left of a velocity that is zero but for rounding has the sign of the sliding that ends.
            if here.abs() == f64::MIN_POSITIVE {
                ends += 1;
                assert!(before * here >= 0.0 && friction * here > 0.0, "{before} {here}");
            } else {
                assert!(here == 0.0 || here.abs() > 1e-13, "{here}");
            }
        }
        state = points[points.len() - 1].state;
    }
    assert!(ends > 10, "{ends}");
}
