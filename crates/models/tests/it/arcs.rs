//! Short parts of a motion follow each other as one motion, and tell the friction where sliding ends.

use std::f64::consts::TAU;

use capsulemap_models::capsule::{Case, Parameters, State, simulate};
use capsulemap_models::motion::Stretch;
use capsulemap_models::of::model_of;

/// The motion from a state while the phase of the drive goes from the first of `phases` to the second [rad].
fn arc(start: State<f64>, [start_phase, section_phase]: [f64; 2]) -> Stretch {
    let parameters = Parameters::default();
    let case = Case { parameters, start: start.into(), start_phase, section_phase };
    model_of(&case.parameters).arc(&case, 5, 1e-12).expect("it can be followed")
}

/// Where it ends.
fn end(arc: &Stretch) -> State<f64> {
    (&arc.state(arc.times.len() - 1)).into()
}

#[test]
fn arcs_follow_each_other_as_one_motion() {
    let simulation = simulate(&Parameters::default(), 0.3, State::default(), 3, 1e-12);
    let parts = 40;
    let (mut state, mut events) = (State::default(), 0);
    for part in 0..3 * parts {
        let phases = [part, part + 1].map(|it| 0.3 + TAU * f64::from(it) / f64::from(parts));
        let arc = arc(state, phases);
        assert!(arc.times.is_sorted());
        assert_eq!(arc.times[0], 0.0);
        let beside = arc.times.windows(2).filter(|it| it[0] == it[1]).count();
        // Both ends and four even times are no events.
        events += arc.times.len() - 6 - beside;
        state = end(&arc);
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
    let friction = parameters.model().signal("history_friction").expect("a signal");
    let (mut state, mut ends) = (State::default(), 0);
    for part in 0..400 {
        let phases = [part, part + 1].map(|it| TAU * f64::from(it) / 40.0);
        let arc = arc(state, phases);
        let (speeds, forces) = (&arc.histories[3], friction.values(&parameters, &arc.histories));
        for place in 1..speeds.len() {
            let [before, here] = [speeds[place - 1], speeds[place]];
            // What is left of a velocity that is zero but for rounding has the sign of the sliding that ends.
            if here.abs() == f64::MIN_POSITIVE {
                ends += 1;
                assert!(before * here >= 0.0 && forces[place] * here > 0.0, "{before} {here}");
            } else {
                assert!(here == 0.0 || here.abs() > 1e-13, "{here}");
            }
        }
        state = end(&arc);
    }
    assert!(ends > 10, "{ends}");
}
