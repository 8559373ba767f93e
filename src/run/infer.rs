//! The attractors of the starts of a refined study that have not been computed.

use crate::attractor::Label;
use crate::study::{Refine, Refining, Study};

use super::FinalMotions;

/// Notes in `of_case` the attractors of the cases of a refined study that have not been computed, as far as they can be
/// inferred.
pub(super) fn infer(study: &Study, final_motions: &FinalMotions, of_case: &mut [Option<u32>]) {
    let (Some(refinement), Some(Refine::Attractors)) = (study.refinement(), &study.refine) else {
        return;
    };
    let mut refining = Refining::whole(&refinement, are_alike);
    for (case, _) in final_motions.known() {
        refining.note(case, label(of_case[case]));
    }
    refining.inferred(|case, corners| {
        if let Some((_, Label::Attractor(number))) = corners.first() {
            of_case[case] = Some(*number);
        }
    });
}

/// The label of a case that has been computed.
pub(super) fn label(attractor: Option<u32>) -> Label {
    attractor.map_or(Label::Undecided, Label::Attractor)
}

/// Whether two starts lead to the same attractor; of one that is not known this cannot be said.
pub(super) fn are_alike(a: &Label, b: &Label) -> bool {
    a == b && *a != Label::Undecided
}
