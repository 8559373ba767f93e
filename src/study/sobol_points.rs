//! Points of Sobol's sequence, each computed from its index alone.
//!
//! No crate does it: `sobol` walks from point to point and has had no release since 2020, `sobol_burley` has 65 536 points in single
//! precision.

use super::direction_numbers::DIRECTION_NUMBERS;

/// Coordinates that a point has at most.
pub const MOST_DIMENSIONS: usize = DIRECTION_NUMBERS.len() + 1;

/// Bits of an index.
const BITS: usize = u64::BITS as usize;

/// Coordinate `dimension` of point `index`, in parts of 2^64.
///
/// # Method
///
/// The direction numbers of the bits of the index, combined by exclusive or. Other programs go through the same points in the order of
/// Gray's code: their point i is this one of index i ^ (i >> 1).
///
/// # Source
///
/// I. M. Sobol', USSR Comput. Math. Math. Phys. 7, 86-112, 1967. P. Bratley, B. L. Fox, Algorithm 659, ACM Trans. Math. Softw. 14, 88-100,
/// 1988. The direction numbers: see `direction_numbers.rs`.
///
/// # Guarantees
///
/// Of the first 2^m points each interval of length 2^-m along each coordinate holds one.
///
/// # Breaks
///
/// There are [`MOST_DIMENSIONS`] coordinates.
pub(super) fn sobol(index: u64, dimension: usize) -> u64 {
    let bits = BITS - index.leading_zeros() as usize;
    let mut numbers = [0_u64; BITS];
    let mut found = 0;
    for bit in 0..bits {
        numbers[bit] = match dimension.checked_sub(1) {
            None => 1,
            Some(row) => direction_number(row, bit, &numbers),
        };
        if index >> bit & 1 == 1 {
            found ^= numbers[bit] << (BITS - 1 - bit);
        }
    }
    found
}

/// Direction number m of a bit, by those before it.
fn direction_number(row: usize, bit: usize, before: &[u64; BITS]) -> u64 {
    let (coefficients, first) = DIRECTION_NUMBERS[row];
    let degree = first.len();
    if bit < degree {
        return first[bit];
    }
    let last = before[bit - degree];
    (1..degree).fold(last ^ (last << degree), |number, step| {
        let coefficient = coefficients >> (degree - 1 - step) & 1;
        number ^ ((coefficient * before[bit - step]) << step)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_dimension_is_even_in_every_power_of_two() {
        for dimension in 0..MOST_DIMENSIONS {
            for power in 0..10 {
                let mut seen = vec![false; 1 << power];
                for index in 0..1 << power {
                    // Shifts by all 64 bits are none.
                    let interval = (sobol(index, dimension) >> 1) >> (BITS - 1 - power);
                    assert!(!std::mem::replace(&mut seen[interval as usize], true));
                }
            }
        }
    }

    #[test]
    fn any_two_dimensions_of_1024_points_are_even_in_a_net_of_few_points_a_box() {
        // A (t, m, 2)-net with t below 5 at most: boxes of 2^5 points hold as many each (Joe and Kuo, Table 2, for 2^10 points).
        for [a, b] in [[0, 1], [1, 2], [2, 5], [3, 7], [4, 6]] {
            let mut counts = [0; 32];
            for index in 0..1024 {
                let [x, y] = [a, b].map(|it| sobol(index, it));
                counts[((x >> 62) << 3 | y >> 61) as usize] += 1;
            }
            assert!(counts.iter().all(|count| *count == 32), "{a} {b}: {counts:?}");
        }
    }
}
