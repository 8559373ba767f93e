//! The provenance of a file: program, commit, time and machine.

use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::time::{SystemTime, UNIX_EPOCH};

/// Attribute: when a file was made.
pub const CREATED: &str = "created";

/// The commit that this program is built from.
static COMMIT: OnceLock<&str> = OnceLock::new();

/// Tells which commit this program is built from, which only the program knows: the library is the same after many commits. Of
/// several calls the first counts; without one the commit is "unknown".
pub fn built_from(commit: &'static str) {
    COMMIT.get_or_init(|| commit);
}

/// The provenance of what this program writes now on this machine.
pub fn attributes() -> BTreeMap<String, String> {
    [
        ("source", format!("capsulemap {}", env!("CARGO_PKG_VERSION"))),
        ("commit", COMMIT.get().copied().unwrap_or("unknown").to_owned()),
        (CREATED, now()),
        ("host_architecture", std::env::consts::ARCH.to_owned()),
        ("host_instruction_set", instruction_set()),
    ]
    .into_iter()
    .map(|(key, value)| (key.to_owned(), value))
    .collect()
}

/// Whether a provenance names this version and commit of the program.
pub fn is_ours(provenance: &BTreeMap<String, String>) -> bool {
    let now = attributes();
    ["source", "commit"].iter().all(|&key| provenance.get(key) == now.get(key))
}

/// The program of a provenance: name, version and commit.
pub fn program(provenance: &BTreeMap<String, String>) -> String {
    format!("{} (commit {})", value(provenance, "source"), value(provenance, "commit"))
}

fn value<'a>(provenance: &'a BTreeMap<String, String>, key: &str) -> &'a str {
    provenance.get(key).map_or("unknown", String::as_str)
}

/// A provenance as one name without blanks: program, commit, architecture and the widest vector instructions.
pub fn maker(provenance: &BTreeMap<String, String>) -> String {
    let keys = ["source", "commit", "host_architecture", "host_instruction_set"];
    keys.map(|key| value(provenance, key)).join("@").replace(' ', "-")
}

/// The time as ISO 8601 in UTC, to the second; where files are to be the same byte for byte, as the
/// environment variable SOURCE_DATE_EPOCH has it [s since 1970], which reproducible-builds.org defines.
fn now() -> String {
    iso(given_time().ok().flatten().unwrap_or_else(seconds_since_1970))
}

fn seconds_since_1970() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs())
}

/// The time that the environment gives for files, in the same form, if it gives one.
pub fn fixed_time() -> Option<String> {
    given_time().ok().flatten().map(iso)
}

fn iso(since: u64) -> String {
    let (days, seconds) = (since / 86_400, since % 86_400);
    let (year, month, day) = civil(days);
    let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

/// The time that the environment gives for files [s since 1970], if it gives one; a text that is none is returned as an
/// error.
pub fn given_time() -> Result<Option<u64>, String> {
    match std::env::var_os("SOURCE_DATE_EPOCH") {
        None => Ok(None),
        Some(text) => {
            let text = text.to_string_lossy();
            text.parse().map(Some).map_err(|_| text.into_owned())
        }
    }
}

/// The Gregorian date of a day counted from 1970-01-01.
///
/// Method: the calendar repeats after 400 years of 146 097 days; years are counted from a 1 March, so that the leap day
/// is the last of its year.
fn civil(days: u64) -> (u64, u64, u64) {
    let from_march = days + 719_468;
    let (era, day) = (from_march / 146_097, from_march % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    (400 * era + year + next, month, day)
}

/// The vector instructions that the processor offers.
fn instruction_set() -> String {
    #[cfg(target_arch = "x86_64")]
    let found = [
        ("sse2", is_x86_feature_detected!("sse2")),
        ("avx", is_x86_feature_detected!("avx")),
        ("avx2", is_x86_feature_detected!("avx2")),
        ("fma", is_x86_feature_detected!("fma")),
        ("avx512f", is_x86_feature_detected!("avx512f")),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let found = [("neon", cfg!(target_feature = "neon"))];
    let names: Vec<&str> = found.iter().filter(|(_, has)| *has).map(|&(name, _)| name).collect();
    names.join(" ")
}

#[cfg(test)]
mod tests {
    use super::civil;

    #[test]
    fn dates_follow_the_calendar() {
        assert_eq!(civil(0), (1970, 1, 1));
        assert_eq!(civil(11_016), (2000, 2, 29));
        assert_eq!(civil(20_778), (2026, 11, 21));
        // Day by day over the years in which the rules of leap years meet.
        let (mut date, mut day) = ((1970, 1, 1), 0);
        while date.0 < 2801 {
            assert_eq!(civil(day), date, "day {day}");
            let (year, month, of_month) = date;
            let is_leap: bool = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
            let lengths = [31, 28 + u64::from(is_leap), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
            date = match (of_month < lengths[month as usize - 1], month < 12) {
                (true, _) => (year, month, of_month + 1),
                (false, true) => (year, month + 1, 1),
                (false, false) => (year + 1, 1, 1),
            };
            day += 1;
        }
        // The last second that the environment can name.
        assert_eq!(civil(u64::MAX / 86_400).0, 584_554_051_223);
    }
}
