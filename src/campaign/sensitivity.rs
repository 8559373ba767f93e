//! Sobol indices of the outputs in a file of results whose cases are Saltelli's design.

use std::collections::BTreeMap;
use std::path::Path;

use super::error::CampaignError;
use super::sobol_indices::{NoIndices, Resampling, SobolIndices, sobol_indices};
use crate::description::Output;
use crate::orbit::Outcome;
use crate::run::on_all_threads;
use crate::store::catalogue::OUTCOME;
use crate::store::{Archive, CaseTable, Column, Design, outcome_name, takes_part};

/// What is said of cases from which no Sobol indices can be estimated.
pub const NO_DESIGN: &str = "its cases are no design from which Sobol indices are estimated: a study needs `[draws]` with `kind = \"saltelli\"`";

/// What Sobol indices are asked for.
#[derive(Debug, Clone, Copy)]
pub struct Sensitivity<'a> {
    /// The results.
    pub archive: &'a Archive,
    /// Their file, for messages.
    pub file: &'a Path,
    /// The outputs.
    pub outputs: &'a [Output],
    /// How intervals are found.
    pub resampling: Resampling,
    /// Worker threads; one per core if none is given.
    pub threads: Option<usize>,
}

/// Sobol indices of outputs.
#[derive(Debug, Clone, PartialEq)]
pub struct SensitivityAnswer {
    /// The design of the cases.
    pub design: Design,
    /// The outputs with what was found of each.
    pub outputs: Vec<(Output, OutputSensitivity)>,
}

/// What was found of an output.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputSensitivity {
    /// Base samples all of whose cases have a value, which alone take part.
    pub rows: usize,
    /// The others.
    pub rows_left_out: usize,
    /// How many cases have no value, by the reason in a few words.
    pub left_out: BTreeMap<String, usize>,
    /// Cases of the rows that take part which do not repeat: their values are means, with standard errors.
    pub aperiodic: usize,
    /// The indices.
    pub indices: Result<SobolIndices, NoIndices>,
}

impl Sensitivity<'_> {
    /// The indices of each output.
    ///
    /// Fails if the file cannot be read, holds no such design, or lacks an output.
    pub fn answer(&self) -> Result<SensitivityAnswer, CampaignError> {
        let table = CaseTable::of(self.archive)?;
        let design = Design::of(self.archive.frame());
        let (Some(table), Some(design)) = (table, design) else {
            return Err(CampaignError::of_path(self.file, NO_DESIGN));
        };
        let outcomes = self.column(&table, OUTCOME.name)?;
        let columns = self.outputs.iter().map(|output| self.column(&table, output.name()));
        let columns = columns.collect::<Result<Vec<Column>, CampaignError>>()?;
        let found = on_all_threads(self.threads, columns.len(), |place| {
            output_sensitivity(&columns[place].values, &outcomes, &design, self.resampling)
        })?;
        let outputs = self.outputs.iter().copied().zip(found).collect();
        Ok(SensitivityAnswer { design, outputs })
    }

    fn column(&self, table: &CaseTable<'_>, name: &str) -> Result<Column, CampaignError> {
        let column = table.column(name)?;
        column.ok_or_else(|| {
            CampaignError::of_path(self.file, format!("has no `{name}` of each case"))
        })
    }
}

/// The indices of an output by its value and its outcome in each case of a design.
///
/// A case takes part as in a trade-off: one that failed, is undecided or missing does not, nor does one whose value is not finite. A row with
/// such a case is left out as a whole.
pub fn output_sensitivity(
    values: &[f64],
    outcomes: &Column,
    design: &Design,
    resampling: Resampling,
) -> OutputSensitivity {
    let length = design.rows().row_length();
    let mut left_out: BTreeMap<String, usize> = BTreeMap::new();
    let (mut whole, mut aperiodic) = (Vec::new(), 0);
    for row in 0..design.base_samples {
        let cases = row * length..(row + 1) * length;
        let reasons: Vec<&str> = cases
            .clone()
            .filter_map(|case| match outcome_name(outcomes, case) {
                name if !takes_part(name) => Some(name),
                _ if !values[case].is_finite() => Some("without a finite value"),
                _ => None,
            })
            .collect();
        if reasons.is_empty() {
            let periodic = Outcome::Periodic.name();
            let others = cases.clone().filter(|case| outcome_name(outcomes, *case) != periodic);
            aperiodic += others.count();
            whole.extend_from_slice(&values[cases]);
        }
        for reason in reasons {
            *left_out.entry(reason.to_owned()).or_default() += 1;
        }
    }
    let rows = whole.len() / length;
    let indices = sobol_indices(&whole, design.rows(), resampling);
    OutputSensitivity {
        rows,
        rows_left_out: design.base_samples - rows,
        left_out,
        aperiodic,
        indices,
    }
}
