//! A study beside the one that its text says.

use std::fmt::Debug;

use super::{Coordinate, Fault, Refine, Study};

impl Study {
    /// What is not the same in the study that was `read` back, in these words.
    pub(super) fn differences(&self, read: &Study, words: Words) -> Vec<Fault> {
        // Named one by one, so that no field of a study is forgotten here.
        let Study {
            title,
            text: _,
            remarks: _,
            base,
            start,
            start_phase,
            section_phase,
            case_set,
            protocol,
            early_decision,
            refine,
            manifolds,
            outputs,
            branches,
            ramps,
            boundaries,
            drawings,
        } = &self.with_varied_of(read);
        let mut compared = Compared { words, faults: Vec::new() };
        compared.part("title", title, &read.title);
        compared.part("outputs", outputs, &read.outputs);
        compared.part("parameters", base, &read.base);
        compared.part("start", start, &read.start);
        compared.part("start.start_phase", start_phase, &read.start_phase);
        compared.part("start.section_phase", section_phase, &read.section_phase);
        compared.part("axes", case_set, &read.case_set);
        compared.part("protocol", protocol, &read.protocol);
        compared.part("basin.early_decision", early_decision, &read.early_decision);
        let refined_by =
            if let Some(Refine::Outputs(_)) = refine { "map.refine" } else { "basin.refine" };
        compared.part(refined_by, refine, &read.refine);
        compared.part("basin.manifolds", manifolds, &read.manifolds);
        compared.each("branches", branches, &read.branches);
        compared.each("ramps", ramps, &read.ramps);
        compared.part("map.boundaries", boundaries, &read.boundaries);
        compared.each("figures", drawings, &read.drawings);
        compared.faults
    }

    /// The same with what another holds constant of the coordinates that vary, which does not count.
    fn with_varied_of(&self, other: &Study) -> Study {
        let mut study = self.clone();
        for coordinate in self.case_set.varied() {
            match coordinate {
                Coordinate::Parameter(parameter) => study.base.take(parameter, &other.base),
                Coordinate::Start(coordinate) => study.start[coordinate] = other.start[coordinate],
                Coordinate::StartPhase => study.start_phase = other.start_phase,
                Coordinate::SectionPhase => study.section_phase = other.section_phase,
            }
        }
        study
    }
}

/// What is said before a part of a study, and before what its text has of it.
pub(super) type Words = [&'static str; 2];
/// Of what no text can say.
pub(super) const UNWRITTEN: Words = ["a study file cannot hold", "it would be read as"];
/// Of what has changed since the text was written.
pub(super) const OUTDATED: Words = ["the study has", "its text has"];

/// Parts of a study that are compared with those that its text has.
struct Compared {
    words: Words,
    faults: Vec<Fault>,
}

impl Compared {
    /// Notes a part that its text has in another way.
    fn part<T: PartialEq + Debug>(&mut self, key: &str, own: &T, read: &T) {
        if own != read {
            self.fault(key, format!("{own:?}"), format!("{read:?}"));
        }
    }

    /// Notes each part of a list that its text has in another way, and that it has more or fewer.
    fn each<T: PartialEq + Debug>(&mut self, key: &str, own: &[T], read: &[T]) {
        for (i, (own, read)) in own.iter().zip(read).enumerate() {
            self.part(&format!("{key}[{}]", i + 1), own, read);
        }
        if own.len() != read.len() {
            self.fault(key, format!("these {}", own.len()), read.len().to_string());
        }
    }

    fn fault(&mut self, key: &str, own: String, read: String) {
        let [before, then] = self.words;
        let message = format!("{before} {own}; {then} {read}");
        self.faults.push(Fault { line: None, key: key.to_owned(), message });
    }
}
