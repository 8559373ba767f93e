//! The harmonic drive of the internal mass, p_d cos(omega t + phase).

use capsulemap_engine::lane::{
    Lane, Series,
    elementary::{sin_cos, sin_cos_of_a_turn},
    series, side_by_side,
};

use super::parameter::Parameter;
use super::shape::Shape;

/// Amplitude, frequency and phase at t = 0.
#[derive(Debug, Clone, Copy)]
pub struct Drive<L> {
    /// Amplitude [N].
    pub amplitude: L,
    /// Frequency [rad/s].
    pub omega: L,
    sin_phase: L,
    cos_phase: L,
}

side_by_side!(Drive { amplitude, omega, sin_phase, cos_phase });

impl<L: Lane> Drive<L> {
    /// The drive of these parameters, started at `phase` within 0..2 pi [rad].
    pub fn new(of: impl Fn(Parameter) -> L, shape: Shape, phase: L) -> Self {
        let (sin_phase, cos_phase) = sin_cos_of_a_turn(phase);
        let omega = shape.frequency(&of);
        Drive { amplitude: of(Parameter::Pd), omega, sin_phase, cos_phase }
    }

    /// A harmonic of this amplitude [N] and frequency [rad/s], started at any `phase` [rad].
    pub fn harmonic(amplitude: L, omega: L, phase: L) -> Self {
        let (sin_phase, cos_phase) = sin_cos(phase);
        Drive { amplitude, omega, sin_phase, cos_phase }
    }

    /// The period, 2 pi / omega [s].
    #[inline(always)]
    pub fn period(&self) -> L {
        L::splat(2.0 * std::f64::consts::PI) / self.omega
    }

    /// Writes the series of `cos(omega t + phase)` from `time` since the start of the drive's cycle [s].
    #[inline(always)]
    pub fn cos(&self, time: L, c: &mut Series<L>) {
        self.write_cos(sin_cos_of_a_turn(self.omega * time), c);
    }

    /// The same of a harmonic that turns more than once in a cycle.
    #[inline(always)]
    pub fn any_cos(&self, time: L, c: &mut Series<L>) {
        self.write_cos(sin_cos(self.omega * time), c);
    }

    /// The harmonic at a time, and minus its sine, each times the amplitude.
    #[inline(always)]
    pub fn turned(&self, time: L) -> [L; 2] {
        let (sin, cos) = sin_cos(self.omega * time);
        let cosine = cos * self.cos_phase - sin * self.sin_phase;
        let sine = sin * self.cos_phase + cos * self.sin_phase;
        [self.amplitude * cosine, -(self.amplitude * sine)]
    }

    /// Writes the series from where the harmonic has turned by an angle with this sine and cosine.
    #[inline(always)]
    fn write_cos(&self, (sin, cos): (L, L), c: &mut Series<L>) {
        let mut s = sin * self.cos_phase + cos * self.sin_phase;
        c[0] = cos * self.cos_phase - sin * self.sin_phase;
        for k in 0..series::ORDER {
            let rate = self.omega.scaled(L::Plain::splat(series::INVERSE[k + 1]));
            c[k + 1] = -(rate * s);
            s = rate * c[k];
        }
    }
}

impl Drive<f64> {
    /// The force of the drive at `time` since the start of its cycle, by a library's functions [N].
    pub fn force(&self, time: f64) -> f64 {
        let (sin, cos) = libm::sincos(self.omega * time);
        self.amplitude * (cos * self.cos_phase - sin * self.sin_phase)
    }
}
