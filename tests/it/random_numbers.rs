//! Random numbers and texts of which studies and figures are made in tests.

use capsulemap::quantity::Allowed;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

/// Draws whatever a study may hold.
pub struct Random(ChaCha8Rng);

impl Random {
    /// Those of a seed.
    pub fn new(seed: u64) -> Self {
        Random(ChaCha8Rng::seed_from_u64(seed))
    }

    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    pub fn is_so(&mut self) -> bool {
        self.below(2) == 0
    }

    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// Some of `all`, in any order.
    pub fn some<T: Clone>(&mut self, all: &[T]) -> Vec<T> {
        let mut left = all.to_vec();
        let count = self.below(all.len() + 1);
        (0..count).map(|_| left.swap_remove(self.below(left.len()))).collect()
    }

    /// A number over many magnitudes.
    pub fn number(&mut self, allowed: Allowed) -> f64 {
        let size = libm::exp(self.uniform(-12.0, 12.0));
        match allowed {
            Allowed::Positive => size,
            Allowed::NonNegative => [0.0, size][usize::from(self.below(8) > 0)],
            Allowed::Share => self.uniform(0.001, 0.999),
            Allowed::UpToOne => self.uniform(0.0, 1.0),
            Allowed::UpToTen => self.uniform(0.0, 10.0),
            Allowed::Slope => self.uniform(-1.5, 1.5),
            Allowed::Finite => size * self.one(&[-1.0, 1.0]),
            Allowed::Within(_) => loop {
                let number = self.number(Allowed::Finite);
                if allowed.admits(number) {
                    return number;
                }
            },
        }
    }

    /// Two numbers that differ.
    pub fn ends(&mut self, allowed: Allowed) -> [f64; 2] {
        loop {
            let [from, to] = [(); 2].map(|()| self.number(allowed));
            if from != to {
                return [from, to];
            }
        }
    }

    /// A text that is hard to quote.
    pub fn text(&mut self, more: &[char]) -> String {
        let all: Vec<char> = "abz 09.,\"\\'#=[]{}äω\u{2028}".chars().collect();
        let length = self.below(8);
        (0..length).map(|_| self.one(&[&all[..], more].concat())).collect()
    }
}
