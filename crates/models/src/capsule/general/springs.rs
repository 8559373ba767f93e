//! What acts between mass and capsule: a preloaded spring with its damper, and a stop on either side.

use capsulemap_engine::lane::{Lane, Series, series, side_by_side};

use crate::capsule::parameter::Parameter;
use crate::capsule::shape::Shape;
use crate::capsule::state::{EventKind, State, is_event};

/// A stop, by the displacement r at which the mass meets it.
#[derive(Debug, Clone, Copy)]
pub struct Stop<L> {
    /// Where it is: delta in front, -delta_3 in the rear [m].
    pub at: L,
    /// Its stiffness [N/m].
    pub stiffness: L,
    /// Its damping in contact [N s/m].
    pub damping: L,
}

side_by_side!(Stop { at, stiffness, damping });

/// The spring between mass and capsule, its damper, and the stops.
#[derive(Debug, Clone, Copy)]
pub struct Springs<L> {
    k1: L,
    /// The damper [N s/m].
    pub c: L,
    k1_cubic: L,
    k2_cubic: L,
    /// k1 G, the force of the spring where r = 0 [N].
    preload: L,
    /// The front stop.
    pub front: Stop<L>,
    /// The rear stop; one without stiffness and damping where there is none.
    pub rear: Stop<L>,
    /// The coefficient of restitution of a front stop that is rigid.
    pub restitution: L,
    has_cubic_terms: bool,
    /// Whether a stop may damp, so that the force jumps where it is met.
    pub has_damped_stops: bool,
    /// Whether the front stop is rigid: it has no stiffness and no damping.
    pub is_rigid: bool,
    /// Whether the mass leaves a stop where its force falls to zero.
    pub release_by_force: bool,
}

side_by_side!(Springs { k1, c, k1_cubic, k2_cubic, preload, restitution } with { front, rear } alike {
    has_cubic_terms, has_damped_stops, is_rigid, release_by_force
});

/// The stops that the mass touches.
#[derive(Debug, Clone, Copy)]
pub struct Touched<L: Lane> {
    /// The front stop.
    pub front: L::Mask,
    /// The rear stop.
    pub rear: L::Mask,
}

/// The series of which the cubic terms are made: r - delta, and the squares of r and of that.
#[derive(Debug, Clone)]
pub struct Squares<L> {
    depth: Series<L>,
    of_r: Series<L>,
    of_depth: Series<L>,
}

side_by_side!(Squares {} with { depth, of_r, of_depth });

impl<L: Lane> Default for Squares<L> {
    #[inline(always)]
    fn default() -> Self {
        Squares { depth: series::zero(), of_r: series::zero(), of_depth: series::zero() }
    }
}

impl<L: Lane> Springs<L> {
    /// Those of these parameters.
    pub fn new(of: impl Fn(Parameter) -> L, shape: Shape) -> Self {
        let zero = L::splat(0.0);
        // A prescribed motion leaves nothing to springs and stops.
        let of = |it| if shape.drive.is_prescribed() { zero } else { of(it) };
        let given = |it| if shape.has(it) { of(it) } else { zero };
        let k1 = of(Parameter::K1);
        let elastic = |value: L| if shape.is_rigid() { zero } else { value };
        let front = Stop {
            at: of(Parameter::Delta),
            stiffness: elastic(of(Parameter::K2)),
            damping: elastic(given(Parameter::K2Damping)),
        };
        let rear = Stop {
            at: -given(Parameter::Delta3),
            stiffness: given(Parameter::K3),
            damping: given(Parameter::K3Damping),
        };
        Springs {
            k1,
            c: of(Parameter::C),
            k1_cubic: given(Parameter::K1Cubic),
            k2_cubic: elastic(given(Parameter::K2Cubic)),
            preload: k1 * given(Parameter::PreloadGap),
            front,
            rear,
            has_cubic_terms: shape.has_cubic_terms(),
            restitution: of(Parameter::Restitution),
            has_damped_stops: shape.has_damped_stops(),
            is_rigid: shape.is_rigid(),
            release_by_force: shape.releases_by_force(),
        }
    }

    /// Where there is a rear stop: one without stiffness and damping is none.
    #[inline(always)]
    pub fn has_rear(&self) -> L::Mask {
        let zero = L::splat(0.0);
        zero.lt(self.rear.stiffness) | zero.lt(self.rear.damping)
    }

    /// The force of the mass on the capsule, F [N].
    #[inline(always)]
    pub fn force(&self, touched: &Touched<L>, state: &State<L>) -> L {
        // In the order in which the paper's capsule has them, whose bits are so the same.
        let of_stops = self.of_front(touched, state) + self.of_rear(touched, state);
        let own = self.k1 * state.r + of_stops;
        let force = own + self.c * (state.y1 - state.y2) + self.preload;
        if !self.has_cubic_terms {
            return force;
        }
        force + self.k1_cubic * (state.r * state.r * state.r)
    }

    /// The force of the front stop on the mass, and so of the mass on it; zero apart from it [N].
    #[inline(always)]
    pub fn of_front(&self, touched: &Touched<L>, state: &State<L>) -> L {
        let depth = state.r - self.front.at;
        let mut force = self.front.force(state);
        if self.has_cubic_terms {
            force = force + self.k2_cubic * (depth * depth * depth);
        }
        L::select(touched.front, force, L::splat(0.0))
    }

    /// The force of the rear stop, below zero where it pushes the mass forward; zero apart from it [N].
    #[inline(always)]
    pub fn of_rear(&self, touched: &Touched<L>, state: &State<L>) -> L {
        L::select(touched.rear, self.rear.force(state), L::splat(0.0))
    }

    /// The energy that is left in the springs of the stops where they let go of the mass beyond their place, and minus what they have where
    /// they push it again there; zero at any other event [J].
    #[inline(always)]
    pub fn left_in_stops(&self, event: L, state: &State<L>) -> L {
        let (zero, half) = (L::splat(0.0), L::splat(0.5));
        if !self.release_by_force {
            return zero;
        }
        let front = self.front.deformation(state.r);
        let square = front * front;
        let cubic = half * half * self.k2_cubic * square;
        let in_front = (half * self.front.stiffness + cubic) * square;
        let rear = self.rear.deformation(state.r);
        let in_rear = half * self.rear.stiffness * rear * rear;
        let mut left = zero;
        for (kind, energy) in [
            (EventKind::ContactOpened, in_front),
            (EventKind::ContactClosed, -in_front),
            (EventKind::RearContactOpened, in_rear),
            (EventKind::RearContactClosed, -in_rear),
        ] {
            left = L::select(is_event(event, kind), energy, left);
        }
        left
    }

    /// What of the force changes in proportion to r, and to the relative velocity [N/m, N s/m].
    #[inline(always)]
    pub fn slopes(&self, touched: &Touched<L>) -> (L, L) {
        let zero = L::splat(0.0);
        let of_front = L::select(touched.front, self.front.stiffness, zero);
        let of_rear = L::select(touched.rear, self.rear.stiffness, zero);
        (self.k1 + of_front + of_rear, self.c + self.contact_damping(touched))
    }

    /// The damping of the stops that are touched [N s/m].
    #[inline(always)]
    pub fn contact_damping(&self, touched: &Touched<L>) -> L {
        let zero = L::splat(0.0);
        let front = L::select(touched.front, self.front.damping, zero);
        front + L::select(touched.rear, self.rear.damping, zero)
    }

    /// The series of the forces in contact of the front stop and of the rear stop against the mass, from those of r and of the relative
    /// velocity; zero apart from them [N].
    #[inline(always)]
    pub fn stop_forces(&self, touched: &Touched<L>, motion: [&Series<L>; 2]) -> [Series<L>; 2] {
        let mut front = self.front.linear(touched.front, motion);
        if self.has_cubic_terms {
            let mut depth = *motion[0];
            depth[0] = depth[0] - self.front.at;
            let mut square = series::zero();
            for (k, term) in front.iter_mut().enumerate() {
                square[k] = series::product_term(&depth, &depth, k);
                let cubic = self.k2_cubic * series::product_term(&square, &depth, k);
                *term = *term + L::select(touched.front, cubic, L::splat(0.0));
            }
        }
        let mut rear = self.rear.linear(touched.rear, motion);
        for term in &mut rear {
            *term = -*term;
        }
        [front, rear]
    }

    /// Begins the squares of a step.
    #[inline(always)]
    pub fn begin_squares(&self, r: L, squares: &mut Squares<L>) {
        if self.has_cubic_terms {
            let depth = r - self.front.at;
            (squares.depth[0], squares.of_r[0], squares.of_depth[0]) =
                (depth, r * r, depth * depth);
        }
    }

    /// Coefficient `k` > 0 of the cubic terms of the force, from those of r up to `k`; writes the squares up to there.
    #[inline(always)]
    pub fn cubic_term(
        &self,
        touched: &Touched<L>,
        r: &Series<L>,
        squares: &mut Squares<L>,
        k: usize,
    ) -> L {
        let zero = L::splat(0.0);
        if !self.has_cubic_terms {
            return zero;
        }
        squares.depth[k] = r[k];
        squares.of_r[k] = series::product_term(r, r, k);
        squares.of_depth[k] = series::product_term(&squares.depth, &squares.depth, k);
        let of_spring = self.k1_cubic * series::product_term(&squares.of_r, r, k);
        let of_stop = self.k2_cubic * series::product_term(&squares.of_depth, &squares.depth, k);
        of_spring + L::select(touched.front, of_stop, zero)
    }
}

impl<L: Lane> Stop<L> {
    /// How far the mass is beyond the place of the stop, forward positive [m].
    #[inline(always)]
    fn deformation(&self, r: L) -> L {
        r - self.at
    }

    /// The linear force of the stop on the mass in contact [N].
    #[inline(always)]
    fn force(&self, state: &State<L>) -> L {
        self.stiffness * (state.r - self.at) + self.damping * (state.y1 - state.y2)
    }

    /// The series of that force where the stop is touched, else of zero [N].
    #[inline(always)]
    fn linear(&self, touched: L::Mask, [r, relative]: [&Series<L>; 2]) -> Series<L> {
        let zero = L::splat(0.0);
        let mut force = series::zero();
        for (k, term) in force.iter_mut().enumerate() {
            let own = if k == 0 { r[0] - self.at } else { r[k] };
            *term = L::select(touched, self.stiffness * own + self.damping * relative[k], zero);
        }
        force
    }
}
