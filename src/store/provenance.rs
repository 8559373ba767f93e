//! The provenance of a file: program, commit, time and machine.

use std::collections::BTreeMap;
use std::time::{SystemTime, UNIX_EPOCH};

/// The provenance of what this program writes now on this machine.
pub fn attributes() -> BTreeMap<String, String> {
    [
        ("source", format!("capsulemap {}", env!("CARGO_PKG_VERSION"))),
        ("commit", env!("CAPSULEMAP_COMMIT").to_owned()),
        ("created", now()),
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
    let value = |key: &str| provenance.get(key).map_or("unknown", String::as_str);
    format!("{} (commit {})", value("source"), value("commit"))
}

/// A provenance as one name without blanks: program, commit, architecture and the widest vector instructions.
pub fn maker(provenance: &BTreeMap<String, String>) -> String {
    let keys = ["source", "commit", "host_architecture", "host_instruction_set"];
    let values = keys.map(|key| provenance.get(key).map_or("unknown", String::as_str));
    values.join("@").replace(' ', "-")
}

/// The time as ISO 8601 in UTC, to the second; where files are to be the same byte for byte, as the
/// environment variable SOURCE_DATE_EPOCH has it [s since 1970], which reproducible-builds.org defines.
fn now() -> String {
    let given = std::env::var("SOURCE_DATE_EPOCH").ok().and_then(|text| text.parse().ok());
    let elapsed = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs());
    let since: u64 = given.unwrap_or_else(elapsed);
    let (days, seconds) = (since / 86_400, since % 86_400);
    let (year, month, day) = civil(days);
    let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

/// The Gregorian date of a day counted from 1970-01-01.
fn civil(mut days: u64) -> (u64, usize, u64) {
    let leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    let mut year = 1970;
    loop {
        let length = if leap(year) { 366 } else { 365 };
        if days < length {
            break;
        }
        days -= length;
        year += 1;
    }
    let february = if leap(year) { 29 } else { 28 };
    let mut month = 1;
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31] {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    (year, month, days + 1)
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
    }
}
