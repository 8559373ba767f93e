//! What is chosen beside the values of parameters.

/// One of several laws or readings, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choice {
    /// Its name in studies and files.
    pub name: &'static str,
    /// What it is called where one that is unknown is refused.
    pub noun: &'static str,
    /// What it is called in reports.
    pub title: &'static str,
    /// What is chosen, in a phrase.
    pub meaning: &'static str,
    /// What may be chosen, by name; the first is chosen where nothing is said.
    pub options: &'static [&'static str],
    /// What fingerprints of studies know it by.
    pub tag: &'static str,
    /// The same of each of the options.
    pub option_tags: &'static [&'static str],
    /// Whether it is told of only where another than the first option is chosen.
    pub is_optional: bool,
}
