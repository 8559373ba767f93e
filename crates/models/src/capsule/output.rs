//! The numbers that sum up a case, with units and meanings.

use std::ops::{Index, IndexMut};

use capsulemap_engine::lane::Lane;

use crate::description::Kept;
use crate::quantity::Dimension;

macro_rules! outputs {
    ($($variant:ident $name:literal $dimension:ident $meaning:literal;)*) => {
        /// A number that sums up a case.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Output {
            $(#[doc = $meaning] $variant,)*
        }

        impl Output {
            /// Every output of a capsule over folds: those of one on even ground, then those of the folds.
            pub const OVER_FOLDS: &[Output] = &[$(Output::$variant,)*];

            /// The name used in studies and files.
            pub const fn name(self) -> &'static str {
                match self { $(Output::$variant => $name,)* }
            }
            /// Its name in code.
            pub const fn tag(self) -> &'static str {
                match self { $(Output::$variant => stringify!($variant),)* }
            }
            /// Its dimension.
            pub const fn dimension(self) -> Dimension {
                match self { $(Output::$variant => Dimension::$dimension,)* }
            }
            /// What it is, in a phrase.
            pub const fn meaning(self) -> &'static str {
                match self { $(Output::$variant => $meaning,)* }
            }
        }
    };
}

outputs! {
    ProgressionSpeed "progression_speed" Velocity "average progression speed of the capsule";
    ProgressionPerCycle "progression_per_cycle" Length "progression of the capsule per drive cycle";
    WorkNet "work_net" Energy "work of the drive per cycle";
    WorkPositive "work_positive" Energy "positive work of the drive per cycle, nothing regenerated";
    WorkAbsolute "work_absolute" Energy "magnitude of the work of the drive per cycle, both signs paid";
    WorkActuator "work_actuator" Energy "work per cycle of a drive that acts between mass and capsule";
    FrictionLoss "friction_loss" Energy "energy lost to the resistance of the ground per cycle";
    DamperLoss "damper_loss" Energy "energy lost in the damper per cycle";
    EnergyResidual "energy_residual" Number "work_net less both losses, over work_absolute or the losses, whichever is more";
    MomentumResidual "momentum_residual" Number "mean friction force, relative to the drive and break-away forces";
    CostOfTransport "cost_of_transport" Number "work_positive over weight times progression";
    Power "power" Power "work_positive over time";
    EnergyPerMetre "energy_per_metre" EnergyPerLength "work_positive over the distance of the progression";
    ImpactsPerCycle "impacts_per_cycle" Number "impacts per cycle";
    ForwardSlips "forward_slips_per_cycle" Number "episodes of forward sliding per cycle";
    BackwardSlips "backward_slips_per_cycle" Number "episodes of backward sliding per cycle";
    Reversals "reversals_per_cycle" Number "reversals of the capsule without rest per cycle";
    StickShare "stick_share" Number "share of time at which the capsule rests";
    PeakContactForce "peak_contact_force" Force "largest contact force";
    GrazingMargin "grazing_margin" Length "least distance between a local maximum of x1 - x2 and the stop";
    LyapunovExponent "lyapunov_exponent" Rate "largest Lyapunov exponent";
    LyapunovUncertainty "lyapunov_uncertainty" Rate "standard error of the largest Lyapunov exponent";
    LargestMultiplier "largest_multiplier" Number "largest magnitude of a Floquet multiplier of the period";
    IntegrationDefect "integration_defect" Number "largest defect of a step of the measured cycles, times its length and relative to the motion";
    ExcludedPeriod "excluded_period" Number "longest period in drive cycles that is excluded, with all shorter ones";
    SectionResidual "section_residual" Number "how far the section is from repeating after the period, relative to the motion";
    ProgressionSpeedError "progression_speed_error" Velocity "standard error of the mean that the progression speed is of a motion that does not repeat, over batches of cycles";
    WorkNetError "work_net_error" Energy "standard error of the mean that work_net is of a motion that does not repeat, over batches of cycles";
    WorkPositiveError "work_positive_error" Energy "standard error of the mean that work_positive is of a motion that does not repeat, over batches of cycles";
    WorkAbsoluteError "work_absolute_error" Energy "standard error of the mean that work_absolute is of a motion that does not repeat, over batches of cycles";
    WorkActuatorError "work_actuator_error" Energy "standard error of the mean that work_actuator is of a motion that does not repeat, over batches of cycles";
    FrictionLossError "friction_loss_error" Energy "standard error of the mean that friction_loss is of a motion that does not repeat, over batches of cycles";
    DamperLossError "damper_loss_error" Energy "standard error of the mean that damper_loss is of a motion that does not repeat, over batches of cycles";
    Lyapunov1 "lyapunov_1" Rate "largest of all Lyapunov exponents, over the same cycles as the others";
    Lyapunov1Error "lyapunov_1_error" Rate "standard error of lyapunov_1";
    Lyapunov2 "lyapunov_2" Rate "second Lyapunov exponent";
    Lyapunov2Error "lyapunov_2_error" Rate "standard error of lyapunov_2";
    Lyapunov3 "lyapunov_3" Rate "third Lyapunov exponent";
    Lyapunov3Error "lyapunov_3_error" Rate "standard error of lyapunov_3";
    KaplanYorkeDimension "kaplan_yorke_dimension" Number "dimension of the attractor on the section by all Lyapunov exponents";
    KaplanYorkeDimensionError "kaplan_yorke_dimension_error" Number "standard error of kaplan_yorke_dimension";
    ContactLoss "contact_loss" Energy "energy lost in the damping of the stops per cycle";
    DragLoss "drag_loss" Energy "part of friction_loss that is lost to drag";
    LiftingWork "lifting_work" Energy "work against incline and load per cycle";
    RearImpactsPerCycle "rear_impacts_per_cycle" Number "impacts on the rear stop per cycle";
    RearPeakContactForce "rear_peak_contact_force" Force "largest force of the rear stop";
    RearGrazingMargin "rear_grazing_margin" Length "least distance between a local minimum of x1 - x2 and the rear stop";
    FoldsPerPeriod "folds_per_period" Number "folds that a locked motion passes in its period, backward negative; unknown where it does not repeat";
    Lyapunov4 "lyapunov_4" Rate "fourth Lyapunov exponent";
    Lyapunov4Error "lyapunov_4_error" Rate "standard error of lyapunov_4";
}

impl Output {
    /// Every output of a capsule on even ground, in the order of files and tables.
    pub const ALL: &[Output] = Output::OVER_FOLDS.split_at(Output::FoldsPerPeriod as usize).0;

    /// Whether it is one of folds.
    pub const fn is_of_folds(self) -> bool {
        self as usize >= Output::ALL.len()
    }

    /// The output called `name`, if there is one.
    pub fn named(name: &str) -> Option<Output> {
        Output::ALL.iter().copied().find(|output| output.name() == name)
    }

    /// Whether it changes smoothly along a family of orbits with the same events, so that it has derivatives in the parameters.
    pub const fn is_smooth(self) -> bool {
        matches!(
            self,
            Output::ProgressionSpeed
                | Output::ProgressionPerCycle
                | Output::WorkNet
                | Output::WorkPositive
                | Output::WorkAbsolute
                | Output::WorkActuator
                | Output::FrictionLoss
                | Output::DamperLoss
                | Output::CostOfTransport
                | Output::Power
                | Output::EnergyPerMetre
                | Output::StickShare
                | Output::PeakContactForce
                | Output::GrazingMargin
                | Output::ContactLoss
                | Output::DragLoss
                | Output::LiftingWork
                | Output::RearPeakContactForce
                | Output::RearGrazingMargin
        )
    }

    /// Which studies keep it where they name none; only members of the family have more to tell by some than zero.
    pub const fn kept(self) -> Kept {
        match self {
            Output::Lyapunov1
            | Output::Lyapunov1Error
            | Output::Lyapunov2
            | Output::Lyapunov2Error
            | Output::Lyapunov3
            | Output::Lyapunov3Error
            | Output::Lyapunov4
            | Output::Lyapunov4Error
            | Output::KaplanYorkeDimension
            | Output::KaplanYorkeDimensionError => Kept::WithExponents,
            Output::ContactLoss
            | Output::DragLoss
            | Output::LiftingWork
            | Output::RearImpactsPerCycle
            | Output::RearPeakContactForce
            | Output::RearGrazingMargin => Kept::WithParts,
            _ => Kept::Always,
        }
    }

    /// Whether not all of these keep it.
    pub const fn is_optional(self) -> bool {
        !matches!(self.kept(), Kept::Always)
    }

    /// Its unit; "1" where it has none.
    pub const fn unit(self) -> &'static str {
        self.dimension().unit()
    }
}

/// A value for every output (SI), in numbers of any kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outputs<L = f64>([L; Output::OVER_FOLDS.len()]);

impl<L: Lane> Outputs<L> {
    /// Nothing known: NaN everywhere.
    pub fn unknown() -> Self {
        Outputs([L::splat(f64::NAN); Output::OVER_FOLDS.len()])
    }

    /// The values, in the order of [`Output::OVER_FOLDS`].
    pub fn values(&self) -> &[L] {
        &self.0
    }

    /// The same outputs in other numbers.
    pub fn map<T>(&self, each: impl Fn(L) -> T) -> Outputs<T> {
        Outputs(self.0.map(each))
    }
}

impl<L> Index<Output> for Outputs<L> {
    type Output = L;
    fn index(&self, output: Output) -> &L {
        &self.0[output as usize]
    }
}

impl<L> IndexMut<Output> for Outputs<L> {
    fn index_mut(&mut self, output: Output) -> &mut L {
        &mut self.0[output as usize]
    }
}
