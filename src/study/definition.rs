//! A study: what to compute, as a set of cases over one base case.

use std::hash::Hash;

use siphasher::sip128::{Hash128, Hasher128, SipHasher13};

use super::grid::Chain;
use super::{
    Axis, Boundaries, CaseSet, Continuation, Coordinate, Direction, Drawing, Grid, Inherit, Ramp,
    Refine, Refinement,
};
use crate::description::{Description, Kept, Output, Parameters, State};
use crate::model::Model;
use crate::motion::Case;
use crate::of::{default_model, model_of};
use crate::orbit::{Exponents, Protocol};

/// What to compute.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// Heading.
    pub title: String,
    /// The study as it was written.
    pub text: String,
    /// What was taken where the text leaves it open and the default does not apply, in sentences.
    pub remarks: Vec<String>,
    /// Values of the parameters that do not vary.
    pub base: Parameters,
    /// Start of the cases, where it does not vary.
    pub start: State,
    /// Phase of the drive at the start, where it does not vary [rad].
    pub start_phase: f64,
    /// Phase of the drive at the stroboscopic section, where it does not vary [rad].
    pub section_phase: f64,
    /// The cases.
    pub case_set: CaseSet,
    /// How each case is integrated and judged.
    pub protocol: Protocol,
    /// Whether a case that enters a neighbourhood of an orbit which another start has led to is followed no further; of
    /// studies whose cases differ in their starts alone.
    pub early_decision: bool,
    /// What tells neighbouring cases apart where a grid is computed only between cases that differ, see [`Refinement`]; the
    /// others are inferred.
    pub refine: Option<Refine>,
    /// Whether the manifolds of the saddles between basins are followed, see [`run::manifolds`](crate::run::manifolds).
    pub manifolds: bool,
    /// The outputs to keep.
    pub outputs: Vec<Output>,
    /// The branches of periodic orbits to continue.
    pub branches: Vec<Continuation>,
    /// The motions along which a parameter changes steadily.
    pub ramps: Vec<Ramp>,
    /// How the boundaries between the regions of its map are followed as curves, if they are.
    pub boundaries: Option<Boundaries>,
    /// The figures to draw.
    pub drawings: Vec<Drawing>,
}

/// What a study does not ask for, as it is shown: left out of fingerprints, which stay those of studies before it could be asked for.
const NOT_ASKED: [&str; 2] = [", manifolds: false", ", ramps: [], boundaries: None"];

impl Default for Study {
    /// That of the model where none is named, see [`Study::of`].
    fn default() -> Self {
        Study::of(default_model())
    }
}

impl Study {
    /// One case of a model with its default parameters, from its origin, all of whose outputs are kept.
    pub fn of(model: &'static Description) -> Self {
        Study {
            title: String::new(),
            text: String::new(),
            remarks: Vec::new(),
            base: Parameters::of(model),
            start: State::origin(model),
            start_phase: 0.0,
            section_phase: 0.0,
            case_set: CaseSet::default(),
            protocol: Protocol::default(),
            early_decision: true,
            refine: None,
            manifolds: false,
            outputs: usual_outputs(&Parameters::of(model), &Protocol::default()),
            branches: Vec::new(),
            ramps: Vec::new(),
            boundaries: None,
            drawings: Vec::new(),
        }
    }
}

impl Study {
    /// Number of values along each dimension of the results, slowest first.
    pub fn shape(&self) -> Vec<usize> {
        self.case_set.shape()
    }

    /// The names of the dimensions of the results, slowest first.
    pub fn dimensions(&self) -> Vec<&str> {
        self.case_set.dimensions()
    }

    /// The axes of a grid, slowest first; none for a single case and for draws.
    pub fn axes(&self) -> &[Axis] {
        self.case_set.axes()
    }

    /// Along which axis the cases inherit their start, if any.
    pub fn inherit(&self) -> Option<&Inherit> {
        self.grid()?.inherit.as_ref()
    }

    /// The directions, where there are several and they make a dimension of the results.
    pub fn direction_axis(&self) -> Option<&[Direction]> {
        self.grid()?.direction_axis()
    }

    /// How the grid is refined, if it is.
    pub fn refinement(&self) -> Option<Refinement> {
        self.refine.as_ref().map(|_| Refinement::of(&self.shape()))
    }

    /// Whether it asks for branches, ramps or the boundaries of its map, which are computed beside its cases.
    pub fn has_more_than_cases(&self) -> bool {
        !(self.branches.is_empty() && self.ramps.is_empty()) || self.boundaries.is_some()
    }

    fn grid(&self) -> Option<&Grid> {
        match &self.case_set {
            CaseSet::Grid(grid) => Some(grid),
            CaseSet::Draws(_) => None,
        }
    }

    /// Differs between studies whose cases or records differ in anything; titles, figures, branches, ramps, boundaries
    /// and the form in which a study is written make no difference.
    pub fn fingerprint(&self) -> String {
        let computed = Study {
            title: String::new(),
            text: String::new(),
            remarks: Vec::new(),
            branches: Vec::new(),
            ramps: Vec::new(),
            boundaries: None,
            drawings: Vec::new(),
            ..self.clone()
        };
        let mut hasher = SipHasher13::new();
        // Numbers are shown with all the digits that distinguish them.
        let shown =
            NOT_ASKED.iter().fold(format!("{computed:?}"), |shown, part| shown.replace(part, ""));
        shown.hash(&mut hasher);
        if let Some(equations) = self.base.model().equations {
            equations.tables.hash(&mut hasher);
        }
        if let Some(own) = self.base.model().own {
            own.table.hash(&mut hasher);
        }
        let Hash128 { h1, h2 } = hasher.finish128();
        format!("{h1:016x}{h2:016x}")
    }

    /// The model that it asks about, with the parts that belong to what varies.
    pub fn model(&self) -> &'static dyn Model {
        model_of(&self.with_parts())
    }

    /// The parameters of the study, with the parts of the equations that belong to those that vary.
    pub fn with_parts(&self) -> Parameters {
        with_parts(&self.base, &self.case_set.varied())
    }

    /// Number of cases.
    pub fn cases(&self) -> usize {
        self.shape().iter().product()
    }

    /// Case `index` with the start that the study gives it, counted with the last dimension fastest.
    pub fn case(&self, index: usize) -> Case {
        let mut case = Case {
            parameters: self.base.clone(),
            start: self.start.clone(),
            start_phase: self.start_phase,
            section_phase: self.section_phase,
        };
        self.case_set.vary(index, &mut case);
        case
    }

    /// Number of chains, which can be run in any order.
    pub fn chains(&self) -> usize {
        self.cases() / self.cases_of_group() * self.chains_of_group()
    }

    /// Chains of a group of cases: all that must be computed together, see [`Grid`].
    pub(super) fn chains_of_group(&self) -> usize {
        self.grid().map_or(1, Grid::chains_of_group)
    }

    /// Cases of such a group.
    pub(super) fn cases_of_group(&self) -> usize {
        self.grid().map_or(1, Grid::cases_of_group)
    }

    /// The cases of chain `number`, to be run in order; a chain is one case where no start is inherited.
    pub fn chain(&self, number: usize) -> Chain {
        self.grid().map_or(Chain::one(number), |grid| grid.chain(number))
    }

    /// Position of case `index` along each dimension of the results.
    pub fn position(&self, index: usize) -> Vec<usize> {
        self.case_set.position(index)
    }
}

/// These parameters with the parts of the equations that belong to those among some coordinates.
pub(super) fn with_parts(base: &Parameters, varied: &[Coordinate]) -> Parameters {
    let parameters = varied.iter().filter_map(|it| match it {
        Coordinate::Parameter(parameter) => Some(*parameter),
        _ => None,
    });
    parameters.fold(base.clone(), Parameters::with_part)
}

/// The outputs of studies that name none: those that tell more than zero of motions with these parameters, and what the protocol
/// asks for.
pub(super) fn usual_outputs(parameters: &Parameters, protocol: &Protocol) -> Vec<Output> {
    let has_parts = parameters.have_optional_parts();
    let is_kept = |output: &Output| match output.kept() {
        Kept::Always => true,
        Kept::WithParts => has_parts,
        Kept::WithExponents => protocol.exponents == Exponents::All,
        Kept::WithMeanError => protocol.mean_error.is_some(),
    };
    parameters.model().outputs().filter(is_kept).collect()
}
