//! The macro that compiles every function of an `impl` block with the instructions of its lanes.

/// Puts `#[inline(always)]` on every function of the `impl` blocks and on the free functions given to it.
///
/// The instructions of AVX2 and AVX-512 are switched on in one function, that which
/// [`Instructions::run`](crate::lane::Instructions::run) enters. What is inlined there, and only that, is
/// compiled with them. One function over lanes that is left out, perhaps a two-line method of a trait, gives
/// the same bits, but every operation in it becomes a call on numbers in memory, and a study on AVX-512 was
/// seen to be thirty times slower. The compiler does not warn of it.
///
/// It takes one or more `impl` blocks, of traits or inherent, and free functions, with whatever stands in
/// them: generics, `where` clauses, associated types and constants, documentation and attributes. The
/// attribute need not be repeated. Functions nested in a function are left as they are; closures too, which
/// the compiler inlines as a rule, but need not: prefer loops where lanes are computed.
///
/// ```
/// use capsulemap_engine::in_lanes;
/// use capsulemap_engine::lane::Lane;
///
/// trait Force<L: Lane> {
///     type Place;
///     fn at(&self, place: &Self::Place) -> L;
/// }
///
/// struct Spring<L> {
///     stiffness: L,
/// }
///
/// in_lanes! {
///     impl<L: Lane> Force<L> for Spring<L> {
///         type Place = [L; 1];
///
///         /// The law of Hooke.
///         fn at(&self, place: &[L; 1]) -> L {
///             -(self.stiffness * place[0])
///         }
///     }
///
///     impl<L: Lane> Spring<L> {
///         pub fn energy(&self, place: &[L; 1]) -> L {
///             half(self.stiffness * place[0] * place[0])
///         }
///     }
///
///     fn half<L: Lane>(x: L) -> L {
///         L::splat(0.5) * x
///     }
/// }
///
/// let spring = Spring { stiffness: 3.0 };
/// assert_eq!((spring.at(&[2.0]), spring.energy(&[2.0])), (-6.0, 6.0));
/// ```
#[macro_export]
macro_rules! in_lanes {
    ($($items:tt)*) => { $crate::__in_lanes!(@top $($items)*); };
}

/// The steps of [`in_lanes!`](crate::in_lanes): `@top` takes an item, `@head` seeks the braces of an `impl`
/// block, `@body` takes its items one by one.
#[doc(hidden)]
#[macro_export]
macro_rules! __in_lanes {
    (@top) => {};
    (@top $(#[$attribute:meta])* $scope:vis fn $($rest:tt)*) => {
        $crate::__in_lanes!(@free $(#[$attribute])* $scope fn $($rest)*);
    };
    (@top $($rest:tt)*) => { $crate::__in_lanes!(@head [] $($rest)*); };

    (@free $function:item $($rest:tt)*) => {
        #[inline(always)]
        $function
        $crate::__in_lanes!(@top $($rest)*);
    };

    // Braces before the end of the input, an attribute, `impl` or `fn` are those of a block, not those of an
    // expression among the generics.
    (@head [$($head:tt)*] { $($body:tt)* }) => {
        $crate::__in_lanes!(@body [$($head)*] [] $($body)*);
    };
    (@head [$($head:tt)*] { $($body:tt)* } # $($rest:tt)*) => {
        $crate::__in_lanes!(@body [$($head)*] [] $($body)*);
        $crate::__in_lanes!(@top # $($rest)*);
    };
    (@head [$($head:tt)*] { $($body:tt)* } impl $($rest:tt)*) => {
        $crate::__in_lanes!(@body [$($head)*] [] $($body)*);
        $crate::__in_lanes!(@top impl $($rest)*);
    };
    (@head [$($head:tt)*] { $($body:tt)* } $scope:vis fn $($rest:tt)*) => {
        $crate::__in_lanes!(@body [$($head)*] [] $($body)*);
        $crate::__in_lanes!(@top $scope fn $($rest)*);
    };
    // Several tokens at once, so that a long head stays within the compiler's limit of nested macros.
    (@head [$($head:tt)*] $a:ident < $b:ident > $($rest:tt)+) => {
        $crate::__in_lanes!(@head [$($head)* $a < $b >] $($rest)+);
    };
    (@head [$($head:tt)*] $a:ident : $b:ident $($rest:tt)+) => {
        $crate::__in_lanes!(@head [$($head)* $a : $b] $($rest)+);
    };
    (@head [$($head:tt)*] $next:tt $($rest:tt)+) => {
        $crate::__in_lanes!(@head [$($head)* $next] $($rest)+);
    };

    (@body [$($head:tt)*] [$($done:tt)*]) => { $($head)* { $($done)* } };
    (@body $head:tt $done:tt $(#[$attribute:meta])* $scope:vis fn $($rest:tt)*) => {
        $crate::__in_lanes!(@fn $head $done $(#[$attribute])* $scope fn $($rest)*);
    };
    (@body $head:tt $done:tt $(#[$attribute:meta])* $scope:vis const fn $($rest:tt)*) => {
        $crate::__in_lanes!(@fn $head $done $(#[$attribute])* $scope const fn $($rest)*);
    };
    (@body $head:tt [$($done:tt)*] $other:item $($rest:tt)*) => {
        $crate::__in_lanes!(@body $head [$($done)* $other] $($rest)*);
    };

    (@fn $head:tt [$($done:tt)*] $function:item $($rest:tt)*) => {
        $crate::__in_lanes!(@body $head [$($done)* #[inline(always)] $function] $($rest)*);
    };
}

#[cfg(test)]
mod tests {
    use std::ops::Add;

    /// Something with every kind of item.
    trait Everything<'a, T, const N: usize> {
        /// A constant.
        const COUNT: usize;
        /// A type.
        type Sum;
        /// A type with a parameter.
        type Held<'b>
        where
            Self: 'b;
        fn make() -> Self;
        fn sum(&self) -> Self::Sum;
        fn held<'b>(&'b self) -> Self::Held<'b>;
        fn change(&mut self, by: fn(T) -> T);
        fn mapped<F, R>(self, f: F) -> [R; N]
        where
            F: Fn(T) -> R,
            Self: Sized;
    }

    struct Numbers<T, const N: usize>([T; N]);

    in_lanes! {
        /// A comment on the block.
        #[allow(clippy::needless_lifetimes)]
        impl<'a, T, const N: usize> Everything<'a, T, { N }> for Numbers<T, { N }>
        where
            T: Copy + Default + Add<Output = T> + 'a,
            [T; N]: Sized,
        {
            /// A comment on an item.
            const COUNT: usize = N;
            type Sum = T;
            type Held<'b> = &'b [T; N] where Self: 'b;

            /// A comment on a function.
            #[allow(clippy::needless_return)]
            fn make() -> Self {
                return Numbers([T::default(); N]);
            }
            fn sum(&self) -> T {
                self.0.iter().fold(T::default(), |sum, &x| sum + x)
            }
            fn held<'b>(&'b self) -> &'b [T; N] {
                &self.0
            }
            fn change(&mut self, by: fn(T) -> T) {
                for x in &mut self.0 {
                    *x = by(*x);
                }
            }
            fn mapped<F, R>(self, f: F) -> [R; N]
            where
                F: Fn(T) -> R,
            {
                self.0.map(f)
            }
        }

        #[allow(dead_code)]
        impl<T: Copy, const N: usize> Numbers<T, N> {
            const FIRST: usize = 0;
            pub fn first(&self) -> T {
                self.0[Self::FIRST]
            }
            pub(crate) const fn count() -> usize {
                N
            }
            fn pair<'b>(&'b self, other: &'b Self) -> [&'b [T; N]; 2] {
                [&self.0, &other.0]
            }
        }

        impl<T, const N: usize> Default for Numbers<T, N> where T: Default + Copy {
            fn default() -> Self { Numbers([T::default(); N]) }
        }

        fn twice(x: u32) -> u32 { 2 * x }

        /// A comment on a free function.
        pub(crate) fn thrice<T>(x: T) -> T where T: Copy + Add<Output = T> { x + x + x }

        impl Numbers<u8, 0> {}
    }

    #[test]
    fn blocks_of_every_form_keep_their_meaning() {
        let mut numbers: Numbers<u32, 3> = Everything::make();
        numbers.0 = [1, 2, 3];
        numbers.change(twice);
        assert_eq!((numbers.sum(), *numbers.held()), (12, [2, 4, 6]));
        assert_eq!(numbers.pair(&Numbers::default()), [&[2, 4, 6], &[0, 0, 0]]);
        assert_eq!((numbers.first(), Numbers::<u32, 3>::count()), (2, 3));
        assert_eq!(<Numbers<u32, 3> as Everything<u32, 3>>::COUNT, 3);
        assert_eq!(numbers.mapped(thrice::<u32>), [6, 12, 18]);
    }
}
