//! A polynomial fitted to samples, as a sum of polynomials that are orthogonal over them.

/// A polynomial as a sum of polynomials `P` that are orthogonal over the samples that it was fitted to:
/// `P[k+1](u) = (u - shift[k]) P[k](u) - weight[k] P[k-1](u)`, with times `u` from -1 to 1.
#[derive(Debug, Clone)]
pub(super) struct Polynomial {
    centre: f64,
    scale: f64,
    shifts: Vec<f64>,
    weights: Vec<f64>,
    coefficients: Vec<f64>,
    /// Sums of the squares of the `P` over the samples.
    squares: Vec<f64>,
}

impl Polynomial {
    /// That of this order with the least squares of what is left of the values.
    pub fn fit(times: &[f64], values: &[f64], order: usize) -> Self {
        let ends = [times[0], times[times.len() - 1]];
        let centre = 0.5 * (ends[0] + ends[1]);
        let scale = if ends[1] > ends[0] { 2.0 / (ends[1] - ends[0]) } else { 1.0 };
        let at: Vec<f64> = times.iter().map(|time| (time - centre) * scale).collect();
        let (mut before, mut this) = (vec![0.0; at.len()], vec![1.0; at.len()]);
        let mut rest = values.to_vec();
        let mut square_before = 1.0;
        let mut polynomial = Polynomial {
            centre,
            scale,
            shifts: Vec::new(),
            weights: Vec::new(),
            coefficients: Vec::new(),
            squares: Vec::new(),
        };
        for k in 0..=order {
            let square = sum(&this, &this);
            // What is left after the lower orders, rather than the values, loses fewer digits.
            let coefficient = sum(&rest, &this) / square;
            let shift = (0..at.len()).map(|i| at[i] * this[i] * this[i]).sum::<f64>() / square;
            let weight = if k == 0 { 0.0 } else { square / square_before };
            for i in 0..at.len() {
                rest[i] -= coefficient * this[i];
                let next = (at[i] - shift) * this[i] - weight * before[i];
                (before[i], this[i]) = (this[i], next);
            }
            square_before = square;
            polynomial.coefficients.push(coefficient);
            polynomial.shifts.push(shift);
            polynomial.weights.push(weight);
            polynomial.squares.push(square);
        }
        polynomial
    }

    /// Writes the values of the `P` at `time`, each over the root of its sum of squares; returns what is left there of `value`.
    pub fn basis(&self, time: f64, value: f64, basis: &mut [f64]) -> f64 {
        let u = (time - self.centre) * self.scale;
        let (mut before, mut this, mut rest) = (0.0, 1.0, value);
        for (k, coefficient) in self.coefficients.iter().enumerate() {
            basis[k] = this / self.squares[k].sqrt();
            rest -= coefficient * this;
            let next = (u - self.shifts[k]) * this - self.weights[k] * before;
            (before, this) = (this, next);
        }
        rest
    }

    /// The sum of it and of the polynomial that has these coefficients in the basis.
    pub fn plus(&self, more: &[f64]) -> Polynomial {
        let mut sum = self.clone();
        for (k, more) in more.iter().enumerate() {
            sum.coefficients[k] += more / self.squares[k].sqrt();
        }
        sum
    }

    /// Its derivative of this order (0 is its value) at `time`.
    pub fn derivative(&self, order: usize, time: f64) -> f64 {
        let u = (time - self.centre) * self.scale;
        // The derivatives of two neighbouring polynomials, from order zero up.
        let mut before = vec![0.0; order + 1];
        let mut this = before.clone();
        this[0] = 1.0;
        let mut total = 0.0;
        for (k, coefficient) in self.coefficients.iter().enumerate() {
            total += coefficient * this[order];
            // From the highest order down, as each needs the one below of the polynomial before it.
            for d in (0..=order).rev() {
                let lower = if d == 0 { 0.0 } else { d as f64 * this[d - 1] };
                let next = lower + (u - self.shifts[k]) * this[d] - self.weights[k] * before[d];
                (before[d], this[d]) = (this[d], next);
            }
        }
        total * self.scale.powi(order as i32)
    }
}

fn sum(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
