//! Repetition without a loop.

/// Does `$body` for `$i` from 0 to `$count`, a constant, one time after the other up to the eighth.
///
/// The compiler would unroll a loop, too. But what is inlined into a function over lanes has thousands of them, and for each that it
/// unrolls it looks through the whole function: that was half of the time of a build.
macro_rules! unrolled {
    ($i:ident < $count:expr, $body:block) => {
        unrolled!(@ $i, $count, $body, 0 1 2 3 4 5 6 7);
        if const { 8 < $count } {
            for $i in 8..$count $body
        }
    };
    (@ $i:ident, $count:expr, $body:block, $($place:literal)*) => {$(
        if const { $place < $count } {
            let $i = $place;
            $body
        }
    )*};
}

pub(super) use unrolled;
