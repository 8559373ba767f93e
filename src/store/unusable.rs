//! Why the file of a block cannot be used.

use std::io;

/// Why a block file cannot be used.
#[derive(Debug)]
pub enum Unusable {
    /// It is not there.
    Missing,
    /// It is cut short, or has changed since it was written.
    Torn,
    /// Its checksum is valid, but it is of another study, version or block, as the text says.
    Foreign(String),
    /// The operating system refused.
    Refused(io::Error),
}

impl std::fmt::Display for Unusable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Unusable::Missing => write!(f, "it is not there"),
            Unusable::Torn => write!(f, "it is torn: cut short, or changed since it was written"),
            Unusable::Foreign(why) => write!(f, "it is foreign: {why}"),
            Unusable::Refused(said) => write!(f, "it cannot be read: {said}"),
        }
    }
}
