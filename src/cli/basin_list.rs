//! What is told of basins beside their attractors: the test for Wada basins, how fast starts settle, and shares under a distribution.

use std::fmt::Write;

use serde_json::{Value, json};

use super::attractor_list::{numbers, whole};
use crate::campaign::WeightedShares;
use crate::run::{QUANTILES, SettledWithin, SettlingTimes};
use crate::store::Dataset;
use crate::store::catalogue::{
    ATTRACTOR, ATTRACTOR_KIND, BASIN_ENTROPY, WADA_BOUNDARY, WADA_COVERED, WADA_DISTANCE,
    WADA_FARTHER, WADA_FROM, WADA_LEAST_RADIUS, WADA_OF, WADA_RADIUS, WADA_UNKNOWN,
};

/// A radius at which boundaries cover more of the starts than this tells little.
const COVERED: f64 = 0.5;

/// What the boundaries of three or more basins are beside each other, or why that is not told; none where the file has no grid of
/// basins.
pub fn wada(dataset: &Dataset) -> Option<Value> {
    dataset.variable(BASIN_ENTROPY.name)?;
    if dataset.variable(WADA_LEAST_RADIUS.name).is_none() {
        let why = match numbers(dataset, ATTRACTOR_KIND.name).len() {
            count @ 0..3 => {
                format!("{count} attractors, where it compares the boundaries of three or more")
            }
            _ => "an axis has fewer than 16 starts, or a basin no boundary with another".to_owned(),
        };
        return Some(json!({ "applicable": false, "why": why }));
    }
    let [radii, farther, covered] =
        [WADA_RADIUS, WADA_FARTHER, WADA_COVERED].map(|it| numbers(dataset, it.name));
    let scales = radii.iter().zip(&farther).zip(&covered).map(|((radius, farther), covered)| {
        json!({ "radius": *radius as u64, "farther": farther, "covered": covered })
    });
    let [of, from, distances] =
        [WADA_OF, WADA_FROM, WADA_DISTANCE].map(|it| numbers(dataset, it.name));
    let pairs = of.iter().zip(&from).zip(&distances).map(|((of, from), distance)| {
        json!({ "of": *of as u64, "from": *from as u64, "distance": distance })
    });
    let boundary = numbers(dataset, WADA_BOUNDARY.name);
    Some(json!({
        "applicable": true,
        "least_radius": whole(dataset, WADA_LEAST_RADIUS.name).filter(|radius| *radius > 0),
        "unknown_starts": whole(dataset, WADA_UNKNOWN.name),
        "boundary_starts": boundary.iter().map(|it| *it as u64).collect::<Vec<_>>(),
        "scales": scales.collect::<Vec<_>>(),
        "pairs": pairs.collect::<Vec<_>>(),
    }))
}

/// The same as text, with the verdict; empty where there is none.
pub fn wada_text(dataset: &Dataset) -> String {
    let Some(told) = wada(dataset) else { return String::new() };
    if let Some(why) = told["why"].as_str() {
        return format!("\nWada test by merging: not applicable: {why}\n");
    }
    let scales = told["scales"].as_array().map_or(&[][..], Vec::as_slice);
    let percent = |value: &Value| 100.0 * value.as_f64().unwrap_or(f64::NAN);
    let mut text = "\nWada test by merging: boundaries beside each other, Euclidean distances in starts along the axes\n  radius  farther from another  starts within it\n".to_owned();
    for it in scales {
        let (farther, covered) = (percent(&it["farther"]), percent(&it["covered"]));
        let radius = it["radius"].as_u64().unwrap_or(0);
        let _ = writeln!(text, "  {radius:>6}  {farther:>18.2} %  {covered:>14.2} %");
    }
    let pairs = told["pairs"].as_array().map_or(&[][..], Vec::as_slice);
    let largest = pairs.iter().filter_map(|it| it["distance"].as_f64()).fold(0.0, f64::max);
    text.push_str(&verdict(scales, told["least_radius"].as_u64(), largest));
    if let Some(unknown) = told["unknown_starts"].as_u64().filter(|count| *count > 0) {
        let _ =
            writeln!(text, "  starts without a known attractor, which have no boundary: {unknown}");
    }
    text
}

/// For which radii basins are Wada.
fn verdict(scales: &[Value], least: Option<u64>, largest: f64) -> String {
    let Some(radius) = least else {
        let last = scales.last().map_or(0, |it| it["radius"].as_u64().unwrap_or(0));
        return format!(
            "  not Wada at these radii: some starts on a boundary are farther than {last} from another one, {largest:.1} at most\n"
        );
    };
    let mut text = format!(
        "  Wada to within {radius} or more: each start on a boundary is at most {largest:.1} from every other boundary; what a finer grid shows is not known\n"
    );
    let covered = scales.iter().find(|it| it["radius"].as_u64() == Some(radius));
    if let Some(covered) = covered.and_then(|it| it["covered"].as_f64()).filter(|it| *it > COVERED)
    {
        let _ = writeln!(
            text,
            "  a weak test: within that radius of one boundary lie {:.0} % of all starts",
            100.0 * covered
        );
    }
    text
}

/// How fast starts settle, with the shares that have settled within these cycles, and how many starts were inferred instead.
pub fn settling(times: &SettlingTimes, inferred: usize, within: &[SettledWithin]) -> Value {
    let attractors = (0..times.attractors()).map(|number| {
        let settling = times.settling(number);
        json!({
            ATTRACTOR.name: number,
            "quantiles": settling.map(|it| it.quantiles),
            "most": settling.map(|it| it.most),
            "mean": settling.map(|it| it.mean),
        })
    });
    let within = within.iter().map(|it| json!({ "within": it.cycles, "shares": it.shares }));
    json!({
        "followed": times.followed(),
        "inferred": inferred,
        "unsettled": times.unsettled(),
        "quantiles_of": QUANTILES,
        "attractors": attractors.collect::<Vec<_>>(),
        "settled": within.collect::<Vec<_>>(),
    })
}

/// The same as a table.
pub fn settling_text(times: &SettlingTimes, inferred: usize, within: &[SettledWithin]) -> String {
    let mut text = format!(
        "\ncycles until it was decided where a start leads, measuring included\n  {:>3}  {:>8} {:>8} {:>8} {:>8} {:>10}\n",
        "", "median", "90 %", "99 %", "most", "mean"
    );
    for number in 0..times.attractors() {
        let Some(it) = times.settling(number) else { continue };
        let [median, most_of_ten, most_of_hundred] = it.quantiles;
        let _ = writeln!(
            text,
            "  {number:>3}  {median:>8} {most_of_ten:>8} {most_of_hundred:>8} {:>8} {:>10.1}",
            it.most, it.mean
        );
    }
    if !within.is_empty() {
        let heads = (0..times.attractors()).map(|number| format!("{number:>9}"));
        let _ = writeln!(
            text,
            "\nshare of the starts that have settled within so many cycles, by attractor\n    cycles {} {:>9}",
            heads.collect::<Vec<_>>().join(" "),
            "not yet"
        );
    }
    for SettledWithin { cycles, shares } in within {
        let not_yet = (1.0 - shares.iter().sum::<f64>()).max(0.0);
        let shares = shares.iter().map(|share| format!("{share:>9.6}"));
        let shares = shares.collect::<Vec<_>>().join(" ");
        let _ = writeln!(text, "  {cycles:>8} {shares} {not_yet:>9.6}");
    }
    if times.unsettled() > 0 {
        let _ = writeln!(
            text,
            "  of {} starts, {} lead to no known attractor and never count as settled",
            times.followed(),
            times.unsettled()
        );
    }
    if inferred > 0 {
        let _ = writeln!(
            text,
            "  of the {} starts that were followed alone: {inferred} others were inferred, and those followed lie near the boundaries, where starts settle late",
            times.followed()
        );
    }
    text
}

/// Shares under a distribution of starts.
pub fn weighted(found: &WeightedShares) -> Value {
    let shares = found.shares.iter().enumerate().map(|(number, it)| {
        json!({ ATTRACTOR.name: number, "starts": it.starts, "share": it.value, "share_error": it.error })
    });
    json!({
        "shares": shares.collect::<Vec<_>>(),
        "unknown": found.unknown,
        "inside": found.inside,
        "coarse": found.coarse,
    })
}

/// The same as a table.
pub fn weighted_text(found: &WeightedShares) -> String {
    let mut text = "\nshares of starts that are drawn from the distribution\n".to_owned();
    for (number, it) in found.shares.iter().enumerate() {
        let error = match it.error.is_nan() {
            true => "of those computed, others are missing".to_owned(),
            false => format!("± {:.6}", it.error),
        };
        let _ = writeln!(text, "  {number:>3}  {:.6} {error}", it.value);
    }
    if found.unknown > 0.0 {
        let _ = writeln!(text, "  attractor unknown: {:.6}", found.unknown);
    }
    let _ = writeln!(
        text,
        "  cut at the ends of the grid, which holds {:.4} % of the distribution",
        100.0 * found.inside
    );
    for name in &found.coarse {
        let _ = writeln!(
            text,
            "  starts along {name} are farther apart than the deviation: the error is too small"
        );
    }
    text
}
