//! The macro by which a struct of numbers becomes a system by its parameters.

/// Makes a struct of numbers the system of its own parameters: implements
/// [`SideBySide`](crate::lane::SideBySide) and [`System`](crate::flow::System) for it.
///
/// The struct has one parameter, the kind of lane, and no fields but those listed, each of which is a
/// parameter of the system under its own name. `section` says how many coordinates the section has, `state`
/// and `mode` name the types of [`Switched`](crate::flow::Switched) over `L`, `event` its events, and `scales`
/// what the coordinates of the section are multiplied with to be compared. A page that uses it is
/// `examples/impact_oscillator.rs`. A second parameter of the struct, a constant, is given its value after the name:
/// `examples/relief_valve.rs` has one that chooses between two sections.
///
/// # Panics
/// The system does where it is asked for the value of a parameter that it does not have; what is asked for by a request, as
/// that of [`branch::follow`](crate::branch::follow()), is an error there ([`System::has`](crate::flow::System::has)).
#[macro_export]
macro_rules! own_system {
    (
        $name:ident $(<$constant:literal>)? { $($parameter:ident),* $(,)? }
        section $coordinates:literal
        state $state:ty,
        mode $mode:ty,
        event $event:ty,
        scales $scales:expr
    ) => {
        impl<L: $crate::lane::Lane> $crate::lane::SideBySide for $name<L $(, $constant)?> {
            type One = $name<f64 $(, $constant)?>;

            #[inline(always)]
            fn splat(one: &Self::One) -> Self {
                $name { $($parameter: <L as $crate::lane::Lane>::splat(one.$parameter)),* }
            }
            #[inline(always)]
            fn lane(&self, index: usize) -> Self::One {
                $name { $($parameter: $crate::lane::Lane::lane(self.$parameter, index)),* }
            }
            #[inline(always)]
            fn put(&mut self, index: usize, one: &Self::One) {
                $(
                    let lanes = &mut self.$parameter;
                    *lanes = $crate::lane::Lane::with_lane(*lanes, index, one.$parameter);
                )*
            }
            #[inline(always)]
            fn take_lane(&mut self, index: usize, other: &Self) {
                $(
                    let lanes = &mut self.$parameter;
                    *lanes = $crate::lane::Lane::with_lane_of(*lanes, index, other.$parameter);
                )*
            }
        }

        impl $crate::flow::System<$coordinates> for $name<f64 $(, $constant)?> {
            type Parameter = &'static str;
            type Event = $event;
            type State<L: $crate::lane::Lane> = $state;
            type Mode<L: $crate::lane::Lane> = $mode;
            type Single = Self;
            type In<L: $crate::lane::Lane> = $name<L $(, $constant)?>;
            type Observer = ();
            type Observers<L: $crate::lane::Lane> = ();

            fn single(&self) -> Self {
                *self
            }
            fn system<L: $crate::lane::Lane>(
                &self,
                of: impl Fn(&'static str) -> L,
            ) -> $name<L $(, $constant)?> {
                $name { $($parameter: of(stringify!($parameter))),* }
            }
            fn has(&self, parameter: &'static str) -> bool {
                [$(stringify!($parameter)),*].contains(&parameter)
            }
            fn value(&self, parameter: &'static str) -> f64 {
                $(if parameter == stringify!($parameter) {
                    return self.$parameter;
                })*
                panic!(
                    "{} has no parameter {parameter}; it has {}",
                    stringify!($name),
                    [$(stringify!($parameter)),*].join(", ")
                )
            }
            fn with(&self, parameter: &'static str, value: f64) -> Self {
                let mut other = *self;
                $(if parameter == stringify!($parameter) {
                    other.$parameter = value;
                    return other;
                })*
                panic!(
                    "{} has no parameter {parameter}; it has {}",
                    stringify!($name),
                    [$(stringify!($parameter)),*].join(", ")
                )
            }
            fn metric(&self) -> $crate::flow::Metric<$coordinates> {
                let scales: fn(&Self) -> [f64; $coordinates] = $scales;
                $crate::flow::Metric::new(scales(self))
            }
            fn observer(&self, _points: usize) {}
        }
    };
}
