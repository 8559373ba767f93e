//! Where a figure comes from: the program, the study and the time, kept inside its files.

use std::time::{SystemTime, UNIX_EPOCH};

use krilla::metadata::DateTime;

use crate::store::dataset::Dataset;
use crate::store::schema::FINGERPRINT;

/// The variable of the environment that holds a time in place of now, as reproducible builds have it [s since 1970].
const EPOCH: &str = "SOURCE_DATE_EPOCH";
/// Seconds of a day.
const DAY: u64 = 86_400;

/// Where a figure comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// The program and its version.
    pub program: String,
    /// The fingerprint of the study, if the results have one.
    pub study: Option<String>,
    /// When the figure was made [s since 1970].
    seconds: u64,
}

impl Origin {
    /// That of a figure of these results that is made now.
    pub fn of(dataset: &Dataset) -> Origin {
        let given = std::env::var(EPOCH).ok().and_then(|it| it.trim().parse().ok());
        let now = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |it| it.as_secs());
        Origin {
            program: concat!("capsulemap ", env!("CARGO_PKG_VERSION")).to_owned(),
            study: dataset.attributes.get(FINGERPRINT).cloned(),
            seconds: given.unwrap_or_else(now),
        }
    }

    /// The date, year, month and day, and the seconds of the day (UTC).
    fn date(&self) -> ([u64; 3], u64) {
        // Days are counted from 1 March of the year 0, so that a leap day is the last of its year.
        let days = self.seconds / DAY + 719_468;
        let (era, of_era) = (days / 146_097, days % 146_097);
        let year = (of_era - of_era / 1_460 + of_era / 36_524 - of_era / 146_096) / 365;
        let of_year = of_era - (365 * year + year / 4 - year / 100);
        let month = (5 * of_year + 2) / 153;
        let day = of_year - (153 * month + 2) / 5 + 1;
        let (month, next) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
        ([era * 400 + year + next, month, day], self.seconds % DAY)
    }

    /// The time as "2026-11-24T09:30:00Z".
    pub fn time(&self) -> String {
        let ([year, month, day], seconds) = self.date();
        let (hour, minute, second) = (seconds / 3_600, seconds / 60 % 60, seconds % 60);
        format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
    }

    /// The time as a PDF holds it.
    pub fn of_pdf(&self) -> DateTime {
        let ([year, month, day], seconds) = self.date();
        DateTime::new(year as u16)
            .month(month as u8)
            .day(day as u8)
            .hour((seconds / 3_600) as u8)
            .minute((seconds / 60 % 60) as u8)
            .second((seconds % 60) as u8)
            .utc_offset_hour(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_those_of_the_calendar() {
        // Of GNU date: `date -u -d @SECONDS +%FT%TZ`.
        for (seconds, expected) in [
            (0, "1970-01-01T00:00:00Z"),
            (951_782_399, "2000-02-28T23:59:59Z"),
            (951_782_400, "2000-02-29T00:00:00Z"),
            (1_709_251_199, "2024-02-29T23:59:59Z"),
            (4_107_542_400, "2100-03-01T00:00:00Z"),
            (1_795_512_345, "2026-11-24T09:25:45Z"),
        ] {
            let origin = Origin { program: String::new(), study: None, seconds };
            assert_eq!(origin.time(), expected);
        }
    }
}
