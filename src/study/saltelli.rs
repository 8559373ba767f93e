//! Saltelli's design: the draws from which Sobol indices are estimated, and in which order they are cases.

/// Which of the draws of a row a case is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Member {
    /// Row of the matrix A.
    A,
    /// Row of A with the quantity of this place from B.
    Mixed(usize),
    /// Row of the matrix B.
    B,
}

/// Saltelli's design over so many quantities: two independent matrices A and B of N rows, and for each quantity A with the column of that
/// quantity from B.
///
/// # Method
///
/// A row of A and that of B are the halves of one Sobol' point of twice as many coordinates. The cases go row by row: A, the mixed ones
/// in the order of the quantities, B. So a design of more rows begins with one of fewer. It is the order of SALib without second order.
///
/// # Source
///
/// A. Saltelli, P. Annoni, I. Azzini, F. Campolongo, M. Ratto, S. Tarantola, Variance based sensitivity analysis of model output,
/// Comput. Phys. Commun. 181, 259-270, 2010.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Saltelli {
    /// Number of quantities that are drawn.
    pub quantities: usize,
}

impl Saltelli {
    /// Cases of a row.
    pub fn row_length(self) -> usize {
        self.quantities + 2
    }

    /// What case `index` is in its row.
    pub fn member(self, index: usize) -> Member {
        match index % self.row_length() {
            0 => Member::A,
            place if place <= self.quantities => Member::Mixed(place - 1),
            _ => Member::B,
        }
    }

    /// The Sobol' point, and its coordinate, from which case `index` has the quantity at `place`.
    pub fn source(self, index: usize, place: usize) -> [usize; 2] {
        let is_from_b = match self.member(index) {
            Member::A => false,
            Member::Mixed(other) => other == place,
            Member::B => true,
        };
        [index / self.row_length(), place + if is_from_b { self.quantities } else { 0 }]
    }
}
