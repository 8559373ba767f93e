//! Where a figure comes from: the program, the study and the time of its results, kept inside its files.

use krilla::metadata::DateTime;

use crate::store::dataset::Dataset;
use crate::store::provenance;
use crate::store::schema::FINGERPRINT;

/// Where a figure comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// The program and its version.
    pub program: String,
    /// The fingerprint of the study, if the results have one.
    pub study: Option<String>,
    /// When the results were made, or what SOURCE_DATE_EPOCH says, as "2026-11-24T09:30:00Z"; not when they were drawn, so that
    /// the same results give the same bytes.
    pub time: Option<String>,
}

impl Origin {
    /// That of a figure of these results.
    pub fn of(dataset: &Dataset) -> Origin {
        let created = dataset.attributes.get(provenance::CREATED);
        Origin {
            study: dataset.attributes.get(FINGERPRINT).cloned(),
            time: provenance::fixed_time().or_else(|| created.cloned()),
            ..Origin::of_recordings()
        }
    }

    /// That of a figure of recordings: it tells no time of its own, so that the same recordings give the same bytes.
    pub fn of_recordings() -> Origin {
        let program = concat!("capsulemap ", env!("CARGO_PKG_VERSION")).to_owned();
        Origin { program, study: None, time: provenance::fixed_time() }
    }

    /// The time as a PDF holds it.
    pub fn of_pdf(&self) -> Option<DateTime> {
        let mut parts = self.time.as_deref()?.split(['-', 'T', ':', 'Z']).map(str::parse::<u16>);
        let mut next = || parts.next()?.ok();
        let time = DateTime::new(next()?).month(next()? as u8).day(next()? as u8);
        let time = time.hour(next()? as u8).minute(next()? as u8).second(next()? as u8);
        Some(time.utc_offset_hour(0))
    }
}
