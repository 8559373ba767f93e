//! What lanes hold side by side: arrays of numbers, and structs by a macro.

use super::Lane;

/// What lanes hold side by side, one of `One` in each.
///
/// Arrays of numbers over lanes, as a state of several coordinates, and `()`, as the mode of a system with one
/// mode only, have it; [`side_by_side!`](crate::side_by_side) gives it to a struct.
///
/// ```
/// use capsulemap_engine::lane::{Lane, SideBySide};
///
/// fn second_lane<L: Lane>(point: &[L; 2]) -> [f64; 2] {
///     point.lane(1 % L::WIDTH)
/// }
/// assert_eq!(second_lane(&[3.0, 4.0]), [3.0, 4.0]);
/// ```
pub trait SideBySide {
    /// What a single lane holds.
    type One;
    /// The same in every lane.
    fn splat(one: &Self::One) -> Self;
    /// What lane `index` holds.
    fn lane(&self, index: usize) -> Self::One;
    /// Puts `one` into lane `index`; the others keep theirs.
    fn put(&mut self, index: usize, one: &Self::One);
    /// Takes what `other` holds in lane `index`, derivatives included; the other lanes keep theirs.
    fn take_lane(&mut self, index: usize, other: &Self);
}

impl<L: Lane, const N: usize> SideBySide for [L; N] {
    type One = [f64; N];

    #[inline(always)]
    fn splat(one: &[f64; N]) -> Self {
        let mut lanes = const { [L::ZERO; N] };
        for (lanes, one) in lanes.iter_mut().zip(one) {
            *lanes = L::splat(*one);
        }
        lanes
    }
    #[inline(always)]
    fn lane(&self, index: usize) -> [f64; N] {
        let mut one = [0.0; N];
        for (one, lanes) in one.iter_mut().zip(self) {
            *one = Lane::lane(*lanes, index);
        }
        one
    }
    #[inline(always)]
    fn put(&mut self, index: usize, one: &[f64; N]) {
        for (lanes, one) in self.iter_mut().zip(one) {
            *lanes = lanes.with_lane(index, *one);
        }
    }
    #[inline(always)]
    fn take_lane(&mut self, index: usize, other: &Self) {
        for (lanes, other) in self.iter_mut().zip(other) {
            *lanes = lanes.with_lane_of(index, *other);
        }
    }
}

/// Nothing in each lane: the mode of a system that has only one.
impl SideBySide for () {
    type One = ();

    #[inline(always)]
    fn splat(_one: &()) -> Self {}
    #[inline(always)]
    fn lane(&self, _index: usize) -> Self::One {}
    #[inline(always)]
    fn put(&mut self, _index: usize, _one: &()) {}
    #[inline(always)]
    fn take_lane(&mut self, _index: usize, _other: &Self) {}
}

/// Implements [`SideBySide`](crate::lane::SideBySide) for a struct over lanes.
///
/// The struct has one parameter, the kind of lane. All its fields are listed: first those of type `L`, then
/// after `masks` those of type `L::Mask`, after `with` those that are side by side themselves (structs over
/// lanes, arrays of numbers), and after `alike` those that have one value for all lanes and are `Copy`.
///
/// ```
/// use capsulemap_engine::lane::{Lane, SideBySide};
/// use capsulemap_engine::side_by_side;
///
/// #[derive(Debug, Clone, Copy, PartialEq)]
/// struct Oscillator<L: Lane> {
///     stiffness: L,
///     damping: L,
///     preloaded: L::Mask,
///     stops: [L; 2],
///     harmonics: usize,
/// }
///
/// side_by_side!(Oscillator { stiffness, damping } masks { preloaded } with { stops } alike { harmonics });
///
/// let one = Oscillator {
///     stiffness: 2.0, damping: 0.1, preloaded: true, stops: [-1.0, 1.0], harmonics: 3,
/// };
/// let mut lanes = Oscillator::<f64>::splat(&one);
/// lanes.put(0, &Oscillator { damping: 0.2, ..one });
/// assert_eq!(lanes.lane(0), Oscillator { damping: 0.2, ..one });
/// ```
#[macro_export]
macro_rules! side_by_side {
    (
        $name:ident $(<const $constant:ident: $kind:ty>)? { $($number:ident),* $(,)? }
        $(masks { $($mask:ident),* $(,)? })?
        $(with { $($part:ident),* $(,)? })?
        $(alike { $($alike:ident),* $(,)? })?
    ) => {
        impl<L: $crate::lane::Lane $(, const $constant: $kind)?> $crate::lane::SideBySide
            for $name<L $(, $constant)?>
        {
            type One = $name<f64 $(, $constant)?>;

            #[inline(always)]
            fn splat(one: &$name<f64 $(, $constant)?>) -> Self {
                $name {
                    $($number: <L as $crate::lane::Lane>::splat(one.$number),)*
                    $($($mask: $crate::lane::Mask::splat(one.$mask),)*)?
                    $($($part: $crate::lane::SideBySide::splat(&one.$part),)*)?
                    $($($alike: one.$alike,)*)?
                }
            }
            #[inline(always)]
            fn lane(&self, index: usize) -> $name<f64 $(, $constant)?> {
                $name {
                    $($number: $crate::lane::Lane::lane(self.$number, index),)*
                    $($($mask: $crate::lane::Mask::lane(self.$mask, index),)*)?
                    $($($part: $crate::lane::SideBySide::lane(&self.$part, index),)*)?
                    $($($alike: self.$alike,)*)?
                }
            }
            #[inline(always)]
            fn put(&mut self, index: usize, one: &$name<f64 $(, $constant)?>) {
                $(self.$number = $crate::lane::Lane::with_lane(self.$number, index, one.$number);)*
                $($(self.$mask = $crate::lane::Mask::with_lane(self.$mask, index, one.$mask);)*)?
                $($($crate::lane::SideBySide::put(&mut self.$part, index, &one.$part);)*)?
                $($(self.$alike = one.$alike;)*)?
            }
            #[inline(always)]
            fn take_lane(&mut self, index: usize, other: &Self) {
                $(
                    let lanes = &mut self.$number;
                    *lanes = $crate::lane::Lane::with_lane_of(*lanes, index, other.$number);
                )*
                $($(
                    let lane = $crate::lane::Mask::lane(other.$mask, index);
                    self.$mask = $crate::lane::Mask::with_lane(self.$mask, index, lane);
                )*)?
                $($($crate::lane::SideBySide::take_lane(&mut self.$part, index, &other.$part);)*)?
                $($(self.$alike = other.$alike;)*)?
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::SideBySide;
    use crate::lane::{Instructions, Lane, Mask, Work};

    #[derive(Debug, Clone, Copy, PartialEq)]
    struct Mode<L: Lane> {
        slip: L,
        closed: L::Mask,
        jumps: [L; 3],
        kind: u8,
        nothing: (),
    }

    side_by_side!(Mode { slip } masks { closed } with { jumps, nothing } alike { kind });

    fn one(number: usize) -> Mode<f64> {
        let slip = number as f64;
        let (jumps, closed) = ([slip + 0.1, slip + 0.2, -slip], number % 3 == 1);
        Mode { slip, closed, jumps, kind: 7, nothing: () }
    }

    struct PutAndTaken;

    impl Work for PutAndTaken {
        type Output = ();

        #[inline(always)]
        fn run<L: Lane>(self) {
            let mut lanes = Mode::<L>::splat(&one(1));
            assert!((0..L::WIDTH).all(|lane| lanes.lane(lane) == one(1)));
            for lane in (0..L::WIDTH).rev() {
                lanes.put(lane, &one(lane));
            }
            assert!((0..L::WIDTH).all(|lane| lanes.lane(lane) == one(lane)));
            assert_eq!((L::Mask::WIDTH, lanes.kind), (L::WIDTH, 7));
        }
    }

    #[test]
    fn what_is_put_into_a_lane_is_taken_from_it() {
        Instructions::available().for_each(|instructions| instructions.run(PutAndTaken));
    }
}
