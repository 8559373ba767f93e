//! The options for the phases of the drive at the start and at the section.

use clap::Args;

use super::arguments::read_quantity;
use crate::description::Description;
use crate::quantity::Dimension;

/// Phases of the drive as they are asked for.
#[derive(Debug, Args)]
pub struct Phases {
    /// Phase of the drive at the start and at the section, as "90 deg"; 0 by default.
    #[arg(long, value_name = "QUANTITY", allow_hyphen_values = true,
        conflicts_with_all = ["start_phase", "section_phase"])]
    phase: Option<String>,
    /// Phase of the drive at the start alone; cycles are counted from the first section.
    #[arg(long, value_name = "QUANTITY", allow_hyphen_values = true)]
    start_phase: Option<String>,
    /// Phase of the drive at the section alone.
    #[arg(long, value_name = "QUANTITY", allow_hyphen_values = true)]
    section_phase: Option<String>,
}

impl Phases {
    /// The phases at the start and at the section [rad]; faults are noted, as where the model has no drive.
    pub fn read(&self, model: &Description, faults: &mut Vec<String>) -> [f64; 2] {
        let all = [
            ("--phase", &self.phase),
            ("--start-phase", &self.start_phase),
            ("--section-phase", &self.section_phase),
        ];
        for (option, _) in all.into_iter().filter(|it| it.1.is_some() && !model.has_drive()) {
            faults.push(format!("{option}: the model {} has no drive", model.name));
        }
        let [both, start, section] = all
            .map(|(option, text)| read_quantity(option, text.as_ref()?, Dimension::Angle, faults));
        [start, section].map(|own| own.or(both).unwrap_or(0.0))
    }
}
