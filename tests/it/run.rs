//! The joined run: from a study to its file and figures.
