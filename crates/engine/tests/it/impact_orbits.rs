//! Orbits with one rigid impact, and their multipliers, in closed form.

use std::f64::consts::PI;

use capsulemap_engine::flow::System;
use capsulemap_engine::lane::Dual;

use super::oscillators::{Impact, mapped, repeated};

/// An orbit of one impact per n drive periods of x'' + c x' + x = cos(wt) with a stop at x = 0.
///
/// With time t since the impact, x = p(t) + h(t): the forced part p = a cos(w t + phi - psi) repeats, so
/// the free part h makes good the jump of the velocity, h(P) = h(0) and h'(P) = h'(0) + (1 + e) u at an
/// impact of speed u (Shaw and Holmes 1983).
pub(super) struct OneImpact {
    pub(super) oscillator: Impact<f64>,
    pub(super) n: u64,
    /// Duration, P.
    duration: f64,
    /// Free motion at the impact, h(0) and h'(0).
    free: [f64; 2],
    /// Amplitude a of the forced part, its lag psi, and the phase phi of the drive at the impact.
    forced: [f64; 3],
    /// Speed at which the stop is met, u.
    pub(super) speed: f64,
}

/// The free motion over t as a matrix: e^(-ct/2) times a turn by sqrt(1 - c^2/4) t.
fn free_motion(c: f64, t: f64) -> [[f64; 2]; 2] {
    let rate = (1.0 - 0.25 * c * c).sqrt();
    let decay = libm::exp(-0.5 * c * t);
    let (sin, cos) = (decay * libm::sin(rate * t) / rate, decay * libm::cos(rate * t));
    [[cos + 0.5 * c * sin, sin], [-sin, cos - 0.5 * c * sin]]
}

impl OneImpact {
    pub(super) fn new(n: u64, omega: f64, restitution: f64, c: f64) -> Self {
        let oscillator =
            Impact { k: 1.0, c, drive: 1.0, omega, gravity: 0.0, stop: 0.0, restitution };
        let duration = n as f64 * 2.0 * PI / omega;
        let [[a, b], [g, d]] = free_motion(c, duration);
        // (free motion - 1) h = (0, 1 + e) for a speed of one.
        let determinant = (a - 1.0) * (d - 1.0) - b * g;
        let jump = 1.0 + restitution;
        let [h, rate] = [-b * jump / determinant, (a - 1.0) * jump / determinant];
        // At the impact p = -u h and p' = -u (e + h'), which fixes the speed and the phase.
        let amplitude = 1.0 / libm::hypot(1.0 - omega * omega, c * omega);
        let lag = libm::atan2(c * omega, 1.0 - omega * omega);
        let away = (restitution + rate) / omega;
        let speed = amplitude / libm::hypot(h, away);
        let phase = (libm::atan2(away, -h) + lag).rem_euclid(2.0 * PI);
        let free = [speed * h, speed * rate];
        OneImpact { oscillator, n, duration, free, forced: [amplitude, lag, phase], speed }
    }

    /// Place and velocity at time `t` after the impact.
    fn at(&self, t: f64) -> [f64; 2] {
        let [amplitude, lag, phase] = self.forced;
        let omega = self.oscillator.omega;
        let angle = omega * t + phase - lag;
        let [[a, b], [g, d]] = free_motion(self.oscillator.c, t);
        let [h, rate] = self.free;
        let forced = [amplitude * libm::cos(angle), -amplitude * omega * libm::sin(angle)];
        [forced[0] + a * h + b * rate, forced[1] + g * h + d * rate]
    }

    /// Whether the mass stays clear of the stop until the next impact.
    pub(super) fn is_possible(&self) -> bool {
        (1..2000).all(|i| self.at(self.duration * f64::from(i) / 2000.0)[0] < 0.0)
    }

    /// Where the section, the drive at phase zero, is met first.
    pub(super) fn section(&self) -> [f64; 2] {
        self.at((2.0 * PI - self.forced[2]) / self.oscillator.omega)
    }

    /// The sum of the multipliers: the trace of the free motion after the jump [[-e, 0], [(1 + e) A / u,
    /// -e]], with A the force at the impact but for damping.
    fn trace(&self) -> f64 {
        let e = self.oscillator.restitution;
        let [[a, b], [_, d]] = free_motion(self.oscillator.c, self.duration);
        let force = libm::cos(self.forced[2]);
        -e * (a + d) + b * (1.0 + e) * force / self.speed
    }
}

#[test]
fn one_impact_orbits_and_their_multipliers_are_in_closed_form() {
    let mut met = [0; 4];
    for n in 1..=4_u32 {
        for c in [0.0, 0.1] {
            for (e, share) in [0.3, 0.6, 0.8, 0.95]
                .into_iter()
                .flat_map(|e| [0.72, 0.85, 0.93, 1.04, 1.15, 1.3, 1.45].map(|share| (e, share)))
            {
                // Alone between impacts the mass takes half a turn of its free motion, n periods at w = 2n.
                let orbit = OneImpact::new(u64::from(n), 2.0 * f64::from(n) * share, e, c);
                if !orbit.is_possible() {
                    continue;
                }
                met[n as usize - 1] += 1;
                check(&orbit);
            }
        }
    }
    assert!(met.iter().all(|&met| met >= 8), "{met:?}");
}

/// Follows an orbit from its section through n periods, with derivatives.
fn check(orbit: &OneImpact) {
    let point = orbit.section();
    let system = orbit.oscillator.constant::<Dual<f64, 2>>();
    let (image, [[a, b], [c, d]]) = mapped(&system, point, orbit.n);
    let scale = orbit.speed.max(1e-3);
    let miss = (image[0] - point[0]).abs().max((image[1] - point[1]).abs()) / scale;
    let about = format!("n {} {:?}", orbit.n, orbit.oscillator);
    let e = orbit.oscillator.restitution;
    let product = e * e * libm::exp(-orbit.oscillator.c * orbit.duration);
    let largest = [a, b, c, d].into_iter().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    let determinant = (a * d - b * c - product).abs() / largest.max(1.0).powi(2);
    let trace = (a + d - orbit.trace()).abs() / largest.max(1.0);
    assert!(
        miss < 1e-10 && determinant < 1e-10 && trace < 1e-10,
        "{about}: {miss:e} {determinant:e} {trace:e}"
    );
}

/// A ball on a table that moves by A cos(wt), seen from the table: the height h obeys h'' = A w^2 cos(wt) -
/// g.
///
/// The drive is G = A w^2 / g, the table's greatest acceleration over gravity, with g = w = 1. The ball that
/// bounces once a period leaves and meets the table at the same height, so its speeds there are -+ pi/w g
/// exactly, however far the table moves; restitution then asks for the table's velocity -G sin(phi) =
/// pi (1 - r)/(1 + r) = G1, and the flip happens where G cos(phi) = 2 (1 + r^2)/(1 + r)^2.
struct Bounce {
    system: Impact<f64>,
    point: [f64; 2],
}

impl Bounce {
    /// The bounce of period one in closed form, x being minus the height.
    fn new(drive: f64, r: f64) -> Self {
        let system = Impact {
            k: 0.0,
            c: 0.0,
            drive: -drive,
            omega: 1.0,
            gravity: 1.0,
            stop: 0.0,
            restitution: r,
        };
        let least = PI * (1.0 - r) / (1.0 + r);
        // The impact falls at the phase -angle; the section is met at time angle after it.
        let angle = libm::asin(least / drive);
        let height = drive * libm::cos(angle) + PI * angle - 0.5 * angle * angle - drive;
        let rate = PI - angle;
        Bounce { system, point: [-height, -rate] }
    }

    /// How far the trace is above that of a multiplier -1, and how far the orbit is from its closed form.
    fn above_flip(drive: f64, r: f64) -> (f64, f64) {
        let Bounce { system, point } = Bounce::new(drive, r);
        let guess = [point[0] * (1.0 + 1e-3), point[1] * (1.0 - 1e-3)];
        let (found, [[a, b], [c, d]]) = repeated(&system.constant::<Dual<f64, 2>>(), guess, 1);
        let miss = (found[0] - point[0]).abs().max((found[1] - point[1]).abs());
        let product = a * d - b * c;
        assert!((product - r * r).abs() < 1e-12, "r {r}: {product}");
        (1.0 + (a + d) + product, miss)
    }
}

#[test]
fn a_bouncing_ball_doubles_its_period_where_theory_says() {
    for r in [0.1, 0.3, 0.5, 0.7, 0.9] {
        let least = PI * (1.0 - r) / (1.0 + r);
        let exact = libm::hypot(least, 2.0 * (1.0 + r * r) / ((1.0 + r) * (1.0 + r)));
        let (mut low, mut high) = (least + 0.3 * (exact - least), 1.2 * exact);
        let worst = [low, exact, high].map(|drive| Bounce::above_flip(drive, r).1);
        assert!(worst.iter().all(|&miss| miss < 1e-10), "r {r}: {worst:?}");
        while high - low > 1e-13 {
            let middle = 0.5 * (low + high);
            if Bounce::above_flip(middle, r).0 > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        assert!((low - exact).abs() < 1e-10 * exact, "r {r}: {low} {exact}");
    }
}
