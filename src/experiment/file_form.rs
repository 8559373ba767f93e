//! What a person says of the form of a recording's file: which of its columns are meant, and how far apart its samples are.

use super::recording::Column;
use crate::quantity::printable::excerpt;

/// What is said of a file beside what stands in it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FileForm {
    /// Which columns of the file are meant.
    pub columns: Vec<Named>,
    /// The time between two samples, for a file without times [s].
    pub interval: Option<f64>,
}

/// A column of the file that stands for a known one.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// The name of the known column.
    pub column: String,
    /// What the file calls it, perhaps with a colon and a unit behind it; `#3` is the third column.
    pub in_file: String,
}

impl FileForm {
    /// Adds what a list such as `t=Time (s), x2=Ch1:mm` names; a comma that no `name=` follows is part of a name.
    ///
    /// Fails with what is wrong in the list.
    pub fn name_columns(&mut self, list: &str) -> Result<(), String> {
        let mut named: Vec<Named> = Vec::new();
        for part in list.split(',') {
            match (part.split_once('=').filter(|it| is_name(it.0)), named.last_mut()) {
                (Some((column, in_file)), _) => named.push(Named {
                    column: column.trim().to_owned(),
                    in_file: in_file.trim().to_owned(),
                }),
                (None, Some(last)) => {
                    last.in_file.push(',');
                    last.in_file.push_str(part.trim_end());
                }
                (None, None) => {
                    return Err(format!(
                        "\"{}\": expected NAME=COLUMN, as \"t=Time (s), x2=Ch1:mm\"",
                        excerpt(part)
                    ));
                }
            }
        }
        for it in &named {
            if it.in_file.is_empty() {
                return Err(format!("{}: expected the name of a column of the file", it.column));
            }
        }
        self.columns.extend(named);
        Ok(())
    }

    /// What is wrong with the columns that are named, where these are known.
    pub fn faults(&self, known: &[Column]) -> Vec<String> {
        let names: Vec<&str> = known.iter().map(|it| it.name).collect();
        let mut faults = Vec::new();
        for (i, it) in self.columns.iter().enumerate() {
            let name = excerpt(&it.column);
            if !names.contains(&it.column.as_str()) {
                faults.push(format!("unknown column {name} (allowed: {})", names.join(", ")));
            } else if self.columns[..i].iter().any(|other| other.column == it.column) {
                faults.push(format!("{name} is given twice"));
            }
        }
        faults
    }

    /// What the file calls a known column, where that is said.
    pub(super) fn named(&self, column: &str) -> Option<&str> {
        let named = self.columns.iter().find(|it| it.column == column)?;
        Some(&named.in_file)
    }
}

/// Whether a text may be the name of a known column.
fn is_name(text: &str) -> bool {
    let text = text.trim();
    !text.is_empty() && text.chars().all(|it| it.is_alphanumeric() || it == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_named_in_a_list() {
        let mut form = FileForm::default();
        form.name_columns("t=Time (s), x2=Displacement, laser:mm").expect("a list");
        form.name_columns("r=#3").expect("a list");
        let found = ["t", "x2", "r", "y1"].map(|it| form.named(it));
        assert_eq!(found, [Some("Time (s)"), Some("Displacement, laser:mm"), Some("#3"), None]);
        assert!(form.name_columns("Time (s)").is_err());
        assert!(form.name_columns("t=").is_err());
        assert!(form.name_columns("").is_err());
    }
}
