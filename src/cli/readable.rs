//! Times, rates and sizes as text for people.

pub use crate::campaign::count::{count, counted};
use crate::run::Estimate;

/// A time as text: "37 s", "12 min", "3 h 20 min", "2 d 4 h".
pub fn time(seconds: f64) -> String {
    let [minute, hour, day] = [60, 3600, 86_400];
    if seconds < 9.95 {
        return format!("{seconds:.1} s");
    }
    // More than a century is shown as one.
    let whole = seconds.min(3.2e9).round() as u64;
    match whole {
        _ if whole < 2 * minute => format!("{whole} s"),
        _ if whole < 2 * hour => format!("{} min", (whole + minute / 2) / minute),
        _ if whole < 2 * day => format!("{} h {} min", whole / hour, whole % hour / minute),
        _ => format!("{} d {} h", whole / day, whole % day / hour),
    }
}

/// A time that is not known well, with how far off it may be: two standard errors.
pub fn estimated(Estimate { value, error }: Estimate) -> String {
    match 2.0 * error {
        off if off.is_nan() => format!("perhaps {}", time(value)),
        off if off > 0.05 * value && off > 1.0 => format!("{} ± {}", time(value), time(off)),
        _ => time(value),
    }
}

/// How many blocks of all are kept in a folder, and how to resume.
pub fn blocks_kept([done, all]: [usize; 2], folder: &str) -> String {
    let (done, all) = (count(done), count(all));
    format!(
        "{done} of {all} blocks are done and kept in {folder}; the same command resumes from there"
    )
}

/// A rate as text.
pub fn rate(per_second: f64) -> String {
    if per_second < 10.0 { format!("{per_second:.2}") } else { count(per_second.round() as usize) }
}

/// A size as text: "512 B", "3.4 MB", "12 GB".
pub fn size(bytes: f64) -> String {
    let units = ["B", "kB", "MB", "GB", "TB"];
    let place = (0..units.len() - 1).find(|&place| bytes < 1000_f64.powi(place as i32 + 1));
    let place = place.unwrap_or(units.len() - 1);
    let number = bytes / 1000_f64.powi(place as i32);
    let decimals = usize::from(place > 0 && number < 9.95);
    format!("{number:.decimals$} {}", units[place])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_in_units_that_fit() {
        let times = [0.25, 9.96, 119.0, 121.0, 7300.0, 200_000.0, f64::INFINITY].map(time);
        assert_eq!(times[..6], ["0.2 s", "10 s", "119 s", "2 min", "2 h 1 min", "2 d 7 h"]);
        assert_eq!(estimated(Estimate { value: 100.0, error: 10.0 }), "100 s ± 20 s");
        assert_eq!(estimated(Estimate { value: 100.0, error: 0.5 }), "100 s");
        assert_eq!(estimated(Estimate { value: 30.0, error: f64::NAN }), "perhaps 30 s");
        assert_eq!([0.5, 5230.4].map(rate), ["0.50", "5 230"]);
        assert_eq!([10.0, 3.4e6, 1.2e10].map(size), ["10 B", "3.4 MB", "12 GB"]);
    }
}
