//! The options that say what form a recording's file has.

use std::path::Path;

use clap::Args;

use super::failure::Failure;
use super::files;
use crate::description::Description;
use crate::experiment::{Column, FileForm, Recording, columns_of_motion};
use crate::quantity::Dimension;

/// Rows that a recording of a motion must have.
const LEAST_ROWS: usize = 16;

/// What is said of the form of the files.
#[derive(Debug, Args)]
pub struct RecordingForm {
    /// Columns of the file that stand for known ones, as "t=Time (s), x2=Ch1:mm": the known name, what the header has, and a unit where
    /// that has none. #3 is the third column; "x2=Ch1:2.5 mm" says what a 1 in the file stands for.
    #[arg(long, value_name = "NAME=COLUMN:UNIT,...")]
    columns: Vec<String>,
    /// The time between two samples, as "1 ms", where the file has no times, or rounded ones.
    #[arg(long, value_name = "TIME")]
    interval: Option<String>,
}

impl RecordingForm {
    /// What is said of a file that may have these columns.
    pub fn of(&self, known: &[Column]) -> Result<FileForm, Failure> {
        let mut faults = Vec::new();
        let form = self.read(&mut faults);
        faults.extend(form.faults(known).into_iter().map(|fault| format!("--columns: {fault}")));
        if form.interval.is_some() && !known.iter().any(Column::is_times) {
            faults.push("--interval: the recording has no times".to_owned());
        }
        if faults.is_empty() { Ok(form) } else { Err(Failure::requests(&faults)) }
    }

    /// What is said, of files that may have any of these columns each; what is for others is left out of each.
    pub fn of_each(&self, all: &[Vec<Column>]) -> Result<Vec<FileForm>, Failure> {
        let form = self.of(&all.concat())?;
        let each = all.iter().map(|known| {
            let mut own = form.clone();
            own.columns.retain(|it| known.iter().any(|column| column.name == it.column));
            own.interval = own.interval.filter(|_| known.iter().any(Column::is_times));
            own
        });
        Ok(each.collect())
    }

    /// The recording of a motion, with the columns that one of this model may have.
    pub fn motion(&self, path: &Path, model: &'static Description) -> Result<Recording, Failure> {
        let known = columns_of_motion(model);
        files::recording_as(path, &known, LEAST_ROWS, &self.of(&known)?)
    }

    fn read(&self, faults: &mut Vec<String>) -> FileForm {
        let mut form = FileForm::default();
        for list in &self.columns {
            if let Err(fault) = form.name_columns(list) {
                faults.push(format!("--columns: {fault}"));
            }
        }
        let Some(text) = &self.interval else { return form };
        match files::quantity("--interval", text, Dimension::Time) {
            Ok(value) if value > 0.0 => form.interval = Some(value),
            Ok(_) => faults.push(format!("--interval: {text} must be above zero")),
            Err(fault) => faults.push(fault),
        }
        form
    }
}
