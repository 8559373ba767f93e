//! What a stretch of motion costs and yields: energies, counts, shares and margins.

use serde::Serialize;

use crate::flow::guard::crossings;
use crate::flow::{Event, Observer, Step};
use crate::lane::quadrature::{integral_of_product, values};
use crate::lane::{Series, series};

use super::locomotion::Locomotion;
use super::parameter::Parameter;
use super::parameters::Parameters;
use super::state::{Contact, EventKind, State, StickSlip};

/// A point of the impact section: where contact closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Phase of the drive since the section, 0 to 2 pi [rad].
    pub phase: f64,
    /// Velocity of the mass [m/s].
    pub y1: f64,
    /// Velocity of the capsule [m/s].
    pub y2: f64,
}

/// Energies, summed since a start [J].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Energies {
    /// Work of the drive [J].
    pub work_net: f64,
    /// Its positive part [J].
    pub work_positive: f64,
    /// The integral of its magnitude [J].
    pub work_absolute: f64,
    /// Work of a drive that acts between mass and capsule [J].
    pub work_actuator: f64,
    /// Energy lost to the resistance of the ground [J].
    pub friction_loss: f64,
    /// Energy lost in the damper [J].
    pub damper_loss: f64,
}

/// Sums over the steps that it has seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Account {
    p_d: f64,
    c: f64,
    k2: f64,
    delta: f64,
    omega: f64,
    /// Impacts kept at most.
    points: usize,
    /// Time seen [s].
    pub time: f64,
    /// Work of the drive and losses.
    pub energies: Energies,
    /// Integral of the friction force over time [N s].
    pub friction_impulse: f64,
    /// Time at rest [s].
    pub stick_time: f64,
    /// Largest contact force [N].
    pub peak_contact_force: f64,
    /// Least distance between a local maximum of r and the stop [m]; infinite while there is none.
    pub grazing_margin: f64,
    /// The same of any local extremum: in a minimum, contact that lasts is about to open [m].
    pub touching_margin: f64,
    /// How often contact closed.
    pub impacts: u64,
    /// The first of these impacts, as many as are kept.
    pub impact_points: Vec<Impact>,
    /// How often the capsule began to slide forward, by onset or by reversal.
    pub forward_slips: u64,
    /// How often the capsule began to slide backward.
    pub backward_slips: u64,
    /// How often it turned round without resting.
    pub reversals: u64,
    rate_of_r: f64,
}

impl Account {
    /// Nothing seen yet; of the impacts so many `points` are kept.
    pub fn new(parameters: &Parameters, points: usize) -> Self {
        Account {
            p_d: parameters[Parameter::Pd],
            c: parameters[Parameter::C],
            k2: parameters[Parameter::K2],
            delta: parameters[Parameter::Delta],
            omega: parameters[Parameter::Omega],
            points,
            time: 0.0,
            energies: Energies::default(),
            friction_impulse: 0.0,
            stick_time: 0.0,
            peak_contact_force: 0.0,
            grazing_margin: f64::INFINITY,
            touching_margin: f64::INFINITY,
            impacts: 0,
            impact_points: Vec::new(),
            forward_slips: 0,
            backward_slips: 0,
            reversals: 0,
            rate_of_r: 0.0,
        }
    }

    fn add<S: Locomotion>(&mut self, system: &S, step: &Step<f64, S>) {
        self.time += step.length;
        if step.length > 0.0 {
            self.add_energies(system, step);
            self.add_extremes(system, step);
        }
        self.count(system, step);
    }

    fn add_energies<S: Locomotion>(&mut self, system: &S, step: &Step<f64, S>) {
        let h = step.length;
        let jet = system.jet(&step.jet);
        let (cos, y1) = (values(&jet.cos, h), values(&jet.y1, h));
        let work = self.p_d * integral_of_product(&cos, &y1, h);
        self.energies.work_net += work;
        self.add_signed_work(&jet.cos, &jet.y1, work, h);

        let y2 = values(&jet.y2, h);
        let relative = std::array::from_fn(|i| y1[i] - y2[i]);
        self.energies.damper_loss += self.c * integral_of_product(&relative, &relative, h);
        let friction = system.friction(&step.mode, &step.jet);
        self.friction_impulse += series::integral(&friction, h);
        if system.stick_slip(&step.mode) == StickSlip::Stick {
            self.stick_time += h;
            self.energies.work_actuator += work;
        } else {
            let slip = values(&system.slip_rate(&step.mode, &step.jet), h);
            self.energies.friction_loss += integral_of_product(&values(&friction, h), &slip, h);
            let carried = self.p_d * integral_of_product(&cos, &slip, h);
            self.energies.work_actuator += work - carried;
        }
    }

    /// Splits the work where the power changes sign.
    fn add_signed_work(&mut self, cos: &Series<f64>, y1: &Series<f64>, work: f64, h: f64) {
        let mut cuts = Vec::new();
        crossings(cos, h, |t, _| cuts.push(t));
        crossings(y1, h, |t, _| cuts.push(t));
        cuts.sort_by(f64::total_cmp);
        let work_until =
            |&t: &f64| self.p_d * integral_of_product(&values(cos, t), &values(y1, t), t);
        let mut before = 0.0;
        for until in cuts.iter().map(work_until).chain([work]) {
            let piece: f64 = until - before;
            self.energies.work_positive += piece.max(0.0);
            self.energies.work_absolute += piece.abs();
            before = until;
        }
    }

    /// Looks at the local extrema of r, which hold the margins, and the maxima the peak force.
    fn add_extremes<S: Locomotion>(&mut self, system: &S, step: &Step<f64, S>) {
        let r = &system.jet(&step.jet).r;
        let rate = series::derivative(r);
        // The printed equation lets r turn with a corner, between two steps.
        if self.rate_of_r * rate[0] < 0.0 {
            self.meet_extremum(r[0], rate[0] < 0.0);
        }
        crossings(&rate, step.length, |t, falls| self.meet_extremum(series::value(r, t), falls));
        self.rate_of_r = series::value(&rate, step.length);
        if system.contact(&step.mode) == Contact::Closed {
            self.meet_contact(r[0]);
        }
    }

    fn meet_extremum(&mut self, r: f64, is_maximum: bool) {
        let margin = (self.delta - r).abs();
        self.touching_margin = self.touching_margin.min(margin);
        if is_maximum {
            self.grazing_margin = self.grazing_margin.min(margin);
            self.meet_contact(r);
        }
    }

    fn meet_contact(&mut self, r: f64) {
        self.peak_contact_force = self.peak_contact_force.max(self.k2 * (r - self.delta));
    }

    fn count<S: Locomotion>(&mut self, system: &S, step: &Step<f64, S>) {
        match EventKind::from_code(step.event) {
            Some(EventKind::ContactClosed) => {
                self.impacts += 1;
                if self.impact_points.len() < self.points {
                    let State { y1, y2, .. } = system.at(&step.jet, step.length);
                    let phase = self.omega * (step.start + step.length);
                    self.impact_points.push(Impact { phase, y1, y2 });
                }
            }
            Some(EventKind::SlipForward) => self.forward_slips += 1,
            Some(EventKind::SlipBackward) => self.backward_slips += 1,
            Some(EventKind::Reversal) => {
                self.reversals += 1;
                if system.stick_slip(&step.mode) == StickSlip::Forward {
                    self.backward_slips += 1;
                } else {
                    self.forward_slips += 1;
                }
            }
            Some(EventKind::ContactOpened | EventKind::Stick) | None => {}
        }
    }
}

impl<S: Locomotion> Observer<f64, S> for Account {
    fn see(&mut self, system: &S, step: &Step<f64, S>) {
        self.add(system, step);
    }

    fn touching_margin(&self) -> f64 {
        self.touching_margin
    }
}
