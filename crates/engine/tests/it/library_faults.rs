//! What a user of the library may get wrong in a system of their own: a failure that is recorded or an error, never a panic
//! and never a periodic motion.

use std::f64::consts::PI;

use capsulemap_engine::branch::{Along, NotFollowed, Request, follow, linearised, segment};
use capsulemap_engine::flow::{Field, NoEvent, Reason, Stroboscopic, Switched, System, Taylor};
use capsulemap_engine::lane::elementary::{not_finite, sin_cos};
use capsulemap_engine::lane::{Instructions, Lane, ORDER, Series, series};
use capsulemap_engine::orbit::passage::OneByOne;
use capsulemap_engine::orbit::{Case, Machine, Outcome, Protocol, Varied, settle, settle_all};
use capsulemap_engine::{in_lanes, own_system};

/// x'' + c x' + x = f cos(w t) with a guard that no motion meets, unless it is no number.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Guarded<L> {
    c: L,
    f: L,
    w: L,
    /// Where the guard falls.
    wall: L,
    /// The slope of the guard is not a number where x is below minus this.
    depth: L,
}

own_system!(Guarded { c, f, w, wall, depth }
    section 2 state [L; 2], mode (), event NoEvent, scales |it| [it.w, 1.0]);

in_lanes! {
    impl<L: Lane> Switched<L> for Guarded<L> {
        type State = [L; 2];
        type Mode = ();
        type Jet = Taylor<L, 2>;
        type Event = NoEvent;
        const GUARDS: usize = 1;

        fn period(&self) -> L {
            L::splat(2.0 * PI) / self.w
        }

        fn expand(&self, _: &(), time: L, state: &[L; 2], jet: &mut Taylor<L, 2>) {
            let (mut sin, mut cos) = sin_cos(self.w * time);
            jet.begin(state);
            for k in 0..ORDER {
                let per = L::splat(series::INVERSE[k + 1]);
                let force = self.f * cos - jet[0][k] - self.c * jet[1][k];
                jet[0][k + 1] = jet[1][k] * per;
                jet[1][k + 1] = force * per;
                (sin, cos) = (self.w * cos * per, -(self.w * sin * per));
            }
        }

        fn pace<'a>(&self, jet: &'a Taylor<L, 2>) -> [&'a Series<L>; 2] {
            [&jet[0], &jet[1]]
        }

        fn guard(&self, _: usize, _: &(), jet: &Taylor<L, 2>, guard: &mut Series<L>) {
            *guard = jet[0].map(|term| -term);
            guard[0] = self.wall - jet[0][0];
            guard[1] = guard[1] + L::splat(0.0) * (self.depth + jet[0][0]).sqrt();
        }

        fn at(&self, jet: &Taylor<L, 2>, h: L) -> [L; 2] {
            jet.at(h)
        }

        fn motion(&self, jet: &Taylor<L, 2>, h: L) -> ([L; 2], [L; 2]) {
            jet.motion(h)
        }

        fn lost(&self, [x, v]: &[L; 2]) -> L::Mask {
            not_finite(*x + *v)
        }
    }

    impl<L: Lane> Stroboscopic<L, 2> for Guarded<L> {
        fn point(state: &[L; 2]) -> [L; 2] {
            *state
        }

        fn state(point: [L; 2]) -> [L; 2] {
            point
        }
    }
}

impl Field for Guarded<f64> {
    type Coordinates = [f64; 2];

    fn coordinates(state: &[f64; 2]) -> [f64; 2] {
        *state
    }

    fn rates(&self, _: &(), time: f64, [x, v]: &[f64; 2]) -> [f64; 2] {
        [*v, self.f * libm::cos(self.w * time) - x - self.c * v]
    }

    fn weights(&self) -> [f64; 2] {
        [self.w, 1.0]
    }
}

/// Its steady answer has an amplitude of 0.8.
const SOUND: Guarded<f64> = Guarded { c: 0.1, f: 1.0, w: 1.5, wall: 100.0, depth: 100.0 };

/// Eight starts, by their distance from rest.
fn starts() -> Vec<[f64; 2]> {
    (0..8).map(|i| [0.2 * f64::from(i) - 0.7, 0.1 * f64::from(i)]).collect()
}

#[test]
fn a_guard_that_is_not_finite_is_a_failure_and_no_periodic_motion() {
    let never = [
        Guarded { wall: f64::NAN, ..SOUND },
        Guarded { wall: f64::INFINITY, ..SOUND },
        Guarded { depth: -100.0, ..SOUND },
        // The steady answer goes as far as that.
        Guarded { depth: 0.6, ..SOUND },
    ];
    let protocol = Protocol::default();
    for instructions in Instructions::available() {
        let machine = Machine { instructions: Some(instructions), ..Machine::default() };
        let all = |system: Guarded<f64>| {
            let cases: Vec<_> =
                starts().into_iter().map(|start| Case::new(system, start)).collect();
            settle_all(&cases, &protocol, machine)
        };
        assert!(all(SOUND).iter().all(|orbit| orbit.outcome == Outcome::Periodic));
        for system in never {
            for (orbit, start) in all(system).iter().zip(starts()) {
                let name = instructions.name();
                assert_ne!(orbit.outcome, Outcome::Periodic, "{name} {system:?} {start:?}");
                let reason = orbit.failure.as_ref().map(|it| it.reason);
                assert_eq!(reason, Some(Reason::NotFinite), "{name} {system:?} {start:?}");
                let alone = settle(&Case::new(system, start), &protocol);
                assert_eq!(alone.failure, orbit.failure, "{name} {system:?} {start:?}");
            }
        }
    }
}

#[test]
fn a_parameter_that_a_system_does_not_have_is_an_error() {
    let orbit = settle(&Case::new(SOUND, [0.0, 0.0]), &Protocol::default());
    let request = |along, second| Request {
        system: SOUND,
        section: orbit.section[0],
        period: 1,
        along,
        range: [1.4, 1.6],
        doublings: 0,
        second,
        curve_range: None,
        longest_step: 0.2,
        most_points: 20,
        tolerance: 1e-12,
    };
    assert!(follow(&request("w", Some(("f", [0.5, 1.5])))).is_ok());
    for wrong in [request("omega", None), request("", None), request("w", Some(("F", [0.5, 1.5])))]
    {
        assert_eq!(follow(&wrong).err(), Some(NotFollowed::NoParameter), "{wrong:?}");
    }
    assert!(SOUND.has("w") && !SOUND.has("omega"));
    let known = |parameter| {
        let along = Along { system: SOUND, varied: Varied::One(parameter), tolerance: 1e-12 };
        let points = &orbit.section[..1];
        [
            segment(&OneByOne, &along, (1.5, points), 1.55).is_some(),
            linearised(&OneByOne, &along, 1.5, points).is_some(),
        ]
    };
    assert_eq!([known("w"), known("omega")], [[true; 2], [false; 2]]);
}
