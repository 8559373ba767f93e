//! What a stretch of motion costs and yields: energies, counts, shares and margins.

use capsulemap_engine::flow::guard::Crossings;
use capsulemap_engine::flow::{Observer, Step};
use capsulemap_engine::lane::quadrature::{Values, integral_of_product, values};
use capsulemap_engine::lane::{Lane, Mask, series, side_by_side};

use super::beside::Beside;
use super::energies::Energies;
use super::impacts::{Impact, Impacts};
use super::locomotion::{DriveSeries, Jump, Locomotion, Parts};
use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
use super::shape::Shape;
use super::state::{EventKind, State, is_event};
use crate::description::Parameters;

/// The constants of the capsules that are observed.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Constants<L> {
    c: L,
    k2: L,
    delta: L,
    omega: L,
}

side_by_side!(Constants { c, k2, delta, omega });

/// Sums over the steps of a motion, in each lane; in numbers with derivatives, with the derivatives of the
/// sums.
///
/// Counts and shares change at events only, so that their derivatives are zero. Assumes: the steps follow each
/// other without a gap; in lanes of which one has ended its stretch, the others' sums alone are to be read.
#[derive(Debug, Clone, PartialEq)]
pub struct Account<L: Lane> {
    of: Constants<L>,
    /// Impacts kept at most.
    points: usize,
    /// Time seen [s].
    pub time: L,
    /// Work of the drive and losses.
    pub energies: Energies<L>,
    /// What members of the family have beside.
    pub beside: Beside<L>,
    /// How far the capsule has advanced [m], summed step by step with what each sum rounds away: wherever x2
    /// began, it has the same bits.
    pub advance: L,
    /// What the last sum of the advance rounded away [m].
    rounded_away: L,
    /// Integral of the friction force over time [N s].
    pub friction_impulse: L,
    /// Time at rest [s].
    pub stick_time: L,
    /// Largest contact force [N].
    pub peak_contact_force: L,
    /// Least distance between a local maximum of r and the stop [m]; infinite while there is none.
    pub grazing_margin: L,
    /// The same of any local extremum: in a minimum, contact that lasts is about to open [m].
    pub touching_margin: L,
    /// How often contact closed.
    pub impacts: L,
    /// The first of these impacts, as many as are kept, and in which lanes they were.
    pub impact_points: Impacts<L>,
    /// How often the capsule began to slide forward, by onset or by reversal.
    pub forward_slips: L,
    /// How often the capsule began to slide backward.
    pub backward_slips: L,
    /// How often it turned round without resting.
    pub reversals: L,
    rate_of_r: L,
}

side_by_side!(Account {
    time, advance, rounded_away, friction_impulse, stick_time, peak_contact_force, grazing_margin, touching_margin,
    impacts, forward_slips, backward_slips, reversals, rate_of_r
} with { of, energies, beside, impact_points } alike { points });

impl Account<f64> {
    /// Nothing seen yet; of the impacts so many `points` are kept.
    pub fn single(parameters: &Parameters, points: usize) -> Self {
        Account::new(|parameter| parameters[parameter], parameters.shape(), points)
    }
}

impl<L: Lane> Account<L> {
    /// Nothing seen yet of capsules of one shape; of the impacts so many `points` are kept.
    pub fn new(of: impl Fn(Parameter) -> L, shape: Shape, points: usize) -> Self {
        let (zero, far) = (L::splat(0.0), L::splat(f64::INFINITY));
        let is_prescribed = shape.drive.is_prescribed();
        Account {
            of: Constants {
                c: if is_prescribed { zero } else { of(Parameter::C) },
                k2: of(Parameter::K2),
                delta: if is_prescribed { far } else { of(Parameter::Delta) },
                omega: shape.frequency(&of),
            },
            points,
            time: zero,
            energies: Energies::none(),
            beside: Beside::none(),
            advance: zero,
            rounded_away: zero,
            friction_impulse: zero,
            stick_time: zero,
            peak_contact_force: zero,
            grazing_margin: far,
            touching_margin: far,
            impacts: zero,
            impact_points: Impacts(Vec::new()),
            forward_slips: zero,
            backward_slips: zero,
            reversals: zero,
            rate_of_r: zero,
        }
    }

    /// Adds how far the capsule advances in a step, by Kahan's compensated sum.
    #[inline(always)]
    fn add_advance<S: Locomotion<L>>(&mut self, system: &S, step: &Step<L, S>) {
        let part = series::change(&system.jet(&step.jet).x2, step.length) - self.rounded_away;
        let sum = self.advance + part;
        // A lane whose step has no length keeps its bits.
        let passes = L::splat(0.0).lt(step.length);
        self.rounded_away = L::select(passes, (sum - self.advance) - part, self.rounded_away);
        self.advance = L::select(passes, sum, self.advance);
    }

    #[inline(always)]
    fn add_energies<S: Locomotion<L>>(&mut self, system: &S, step: &Step<L, S>) {
        let (zero, h) = (L::splat(0.0), step.length);
        let jet = system.jet(&step.jet);
        let drive = system.drive(&step.jet);
        let (force, rate) = (values(drive.force, h), values(drive.rate, h));
        let work = drive.unit * integral_of_product(&force, &rate, h);
        self.energies.work_net = self.energies.work_net + work;
        self.add_signed_work(&drive, work, h);

        let y2 = values(&jet.y2, h);
        let mut relative: Values<L> = if drive.reacts { values(&jet.y1, h) } else { rate };
        for (relative, y2) in relative.iter_mut().zip(&y2) {
            *relative = *relative - *y2;
        }
        let damped = self.of.c * integral_of_product(&relative, &relative, h);
        self.energies.damper_loss = self.energies.damper_loss + damped;
        let friction = system.friction(&step.mode, &step.jet);
        self.friction_impulse = self.friction_impulse + series::integral(&friction, h);
        let direction = system.direction(&step.mode);
        let slides = zero.lt(direction * direction);
        self.stick_time = self.stick_time + L::select(slides, zero, h);
        let mut actuated = work;
        if slides.any() {
            let slip = values(&system.slip_rate(&step.mode, &step.jet), h);
            let lost = integral_of_product(&values(&friction, h), &slip, h);
            if !drive.reacts {
                let carried = drive.unit * integral_of_product(&force, &slip, h);
                actuated = L::select(slides, work - carried, work);
            }
            let friction_loss = self.energies.friction_loss;
            self.energies.friction_loss = L::select(slides, friction_loss + lost, friction_loss);
        }
        self.energies.work_actuator = self.energies.work_actuator + actuated;
    }

    /// Splits the work where the power changes sign: where the drive does, or the velocity at which it works.
    #[inline(always)]
    fn add_signed_work(&mut self, drive: &DriveSeries<'_, L>, work: L, h: L) {
        let zero = L::splat(0.0);
        let all = L::Mask::splat(true);
        let end = h.plain();
        let mut turns = [
            Crossings::new(&series::plain(drive.force), end, all),
            Crossings::new(&series::plain(drive.rate), end, all),
        ];
        let mut next = [end; 2];
        for (turns, next) in turns.iter_mut().zip(&mut next) {
            *next = turns.next(all).time;
        }
        let mut before = zero;
        let mut open = all;
        while open.any() {
            let until = next[0].min(next[1]);
            let last = open & end.le(until);
            let mut done = L::select(last, work, before);
            let inner = open & !last;
            if inner.any() {
                let t = L::from_plain(until);
                let (force, rate) = (values(drive.force, t), values(drive.rate, t));
                let product = integral_of_product(&force, &rate, t);
                done = L::select(inner, drive.unit * product, done);
            }
            let part = done - before;
            let Energies { work_positive, work_absolute, .. } = &mut self.energies;
            *work_positive = *work_positive + L::select(open, part.max(zero), zero);
            *work_absolute = *work_absolute + L::select(open, part.abs(), zero);
            before = done;
            open = inner;
            for (turns, next) in turns.iter_mut().zip(&mut next) {
                let passed = open & next.le(until);
                if passed.any() {
                    *next = L::Plain::select(passed, turns.next(passed).time, *next);
                }
            }
        }
    }

    /// Looks at the local extrema of r, which hold the margins, and the maxima the peak force.
    #[inline(always)]
    fn add_extremes<S: Locomotion<L>>(
        &mut self,
        system: &S,
        step: &Step<L, S>,
        parts: Option<&Parts<L>>,
    ) {
        let zero = L::splat(0.0);
        let all = L::Mask::splat(true);
        let r = &system.jet(&step.jet).r;
        let rate = series::derivative(r);
        let passes = zero.lt(step.length);
        // The printed equation lets r turn with a corner, between two steps.
        let turns = passes & (self.rate_of_r * rate[0]).lt(zero);
        if turns.any() {
            self.meet_extremum(turns, r[0], rate[0].lt(zero), parts);
        }
        let mut extrema = Crossings::new(&series::plain(&rate), step.length.plain(), passes);
        loop {
            let extremum = extrema.next(all);
            if !extremum.found.any() {
                break;
            }
            // At an extremum the derivatives at fixed time are those of the extremum.
            let there = series::value(r, L::from_plain(extremum.time));
            self.meet_extremum(extremum.found, there, extremum.falls, parts);
        }
        let rate_at_end = series::value(&rate, step.length);
        self.rate_of_r = L::select(passes, rate_at_end, self.rate_of_r);
        if parts.is_none() {
            self.meet_contact(passes & system.closed(&step.mode), r[0]);
        }
    }

    #[inline(always)]
    fn meet_extremum(
        &mut self,
        here: L::Mask,
        r: L,
        is_maximum: L::Mask,
        parts: Option<&Parts<L>>,
    ) {
        let mut margin = (self.of.delta - r).abs();
        let [touching, grazing] = [self.touching_margin, self.grazing_margin];
        self.grazing_margin = L::select(here & is_maximum, grazing.min(margin), grazing);
        match parts {
            Some(parts) => {
                if parts.is_rigid {
                    margin = L::select(is_maximum, margin, L::splat(f64::INFINITY));
                }
                margin = margin.min(self.beside.meet_extremum(here & !is_maximum, r, parts))
            }
            None => self.meet_contact(here & is_maximum, r),
        }
        self.touching_margin = L::select(here, touching.min(margin), touching);
    }

    #[inline(always)]
    fn meet_contact(&mut self, here: L::Mask, r: L) {
        let force = self.peak_contact_force.max(self.of.k2 * (r - self.of.delta));
        self.peak_contact_force = L::select(here, force, self.peak_contact_force);
    }

    #[inline(always)]
    fn count<S: Locomotion<L>>(&mut self, system: &S, step: &Step<L, S>) {
        let zero = L::splat(0.0);
        if !zero.lt(step.event).any() {
            return;
        }
        let impacts = is_event(step.event, EventKind::ContactClosed);
        let kept = impacts & self.impacts.lt(L::splat(self.points as f64));
        self.impacts = one_more(self.impacts, impacts);
        if kept.any() {
            let State { y1, y2, .. } = system.at(&step.jet, step.length);
            let phase = self.of.omega * (step.start + step.length);
            self.impact_points.0.push((kept.bits(), Impact { phase, y1, y2 }));
        }
        if S::HAS_PARTS {
            let rear = is_event(step.event, EventKind::RearContactClosed);
            self.beside.rear_impacts = one_more(self.beside.rear_impacts, rear);
        }
        let reverses = is_event(step.event, EventKind::Reversal);
        let was_forward = zero.lt(system.direction(&step.mode));
        self.reversals = one_more(self.reversals, reverses);
        let begins_forward = is_event(step.event, EventKind::SlipForward);
        let begins_backward = is_event(step.event, EventKind::SlipBackward);
        let forward = begins_forward | (reverses & !was_forward);
        let backward = begins_backward | (reverses & was_forward);
        let [forward, backward] = match system.jump(step) {
            Some(jump) => self.see_jump(&jump, system.direction(&step.mode), [forward, backward]),
            None => [forward, backward],
        };
        self.forward_slips = one_more(self.forward_slips, forward);
        self.backward_slips = one_more(self.backward_slips, backward);
    }
}

impl<L: Lane> Account<L> {
    /// Adds what a jump of the velocities costs; returns where sliding begins forward and backward, with what begins it by a jump.
    #[inline(always)]
    fn see_jump(
        &mut self,
        jump: &Jump<L>,
        before: L,
        [forward, backward]: [L::Mask; 2],
    ) -> [L::Mask; 2] {
        let zero = L::splat(0.0);
        let lost = L::select(jump.here, jump.lost, zero);
        self.beside.contact_loss = self.beside.contact_loss + lost;
        let taken = L::select(jump.here, jump.driven[0], zero);
        let given = L::select(jump.here, jump.driven[1], zero);
        let energies = &mut self.energies;
        energies.work_net = energies.work_net + (given - taken);
        energies.work_actuator = energies.work_actuator + (given - taken);
        energies.work_positive = energies.work_positive + given;
        energies.work_absolute = energies.work_absolute + (given + taken);
        // A rate of r that jumps has no zero there.
        self.rate_of_r = L::select(jump.here, zero, self.rate_of_r);
        let begins_forward = jump.here & zero.lt(jump.y2) & before.le(zero);
        let begins_backward = jump.here & jump.y2.lt(zero) & zero.le(before);
        self.reversals = one_more(
            self.reversals,
            (begins_forward & before.lt(zero)) | (begins_backward & zero.lt(before)),
        );
        [forward | begins_forward, backward | begins_backward]
    }
}

/// A count that is one more here.
#[inline(always)]
fn one_more<L: Lane>(count: L, here: L::Mask) -> L {
    count + L::select(here, L::splat(1.0), L::splat(0.0))
}

impl<L: Lane, S: Locomotion<L>> Observer<L, S> for Account<L> {
    #[inline(always)]
    fn see(&mut self, system: &S, step: &Step<L, S>) {
        self.time = self.time + step.length;
        if L::splat(0.0).lt(step.length).any() {
            self.add_advance(system, step);
            self.add_energies(system, step);
            let parts = system.parts(step);
            self.add_extremes(system, step, parts.as_ref());
            if let Some(parts) = parts {
                let peak = self.beside.see(system.jet(&step.jet), &parts, step.length);
                self.peak_contact_force = self.peak_contact_force.max(peak);
            }
        }
        self.count(system, step);
    }

    fn touching_margin(&self) -> L {
        self.touching_margin
    }
}
