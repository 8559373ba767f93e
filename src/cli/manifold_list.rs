//! What is told of the manifolds of the saddles between basins: the curves of the boundary, and how much of it they make up.

use std::fmt::Write;

use serde_json::{Value, json};

use super::attractor_list::{numbers, whole};
use crate::store::Dataset;
use crate::store::catalogue::{
    BOUNDARY_CROSSINGS, BOUNDARY_FAILED, BOUNDARY_SEEDS, BOUNDARY_STOPPED, BOUNDARY_UNCOVERED,
    Entry, STABLE_BEGIN, STABLE_EDGE, STABLE_END, STABLE_ERROR, STABLE_LEFT, STABLE_LENGTH,
    STABLE_POINT_CURVE, STABLE_POINT_DIVIDED, STABLE_RIGHT, UNSTABLE_ATTRACTOR, UNSTABLE_CYCLE,
    UNSTABLE_EDGE, UNSTABLE_END, UNSTABLE_POINT_BRANCH, UNSTABLE_TEARS,
};

/// Curves that are told one by one, the longest first.
const LISTED: usize = 12;

/// The manifolds as an object; none where the file has none.
pub fn manifolds(dataset: &Dataset) -> Option<Value> {
    let crossings = whole(dataset, BOUNDARY_CROSSINGS.name)?;
    let once = |entry: Entry| whole(dataset, entry.name).unwrap_or(0);
    Some(json!({
        "crossings": crossings,
        "uncovered": once(BOUNDARY_UNCOVERED),
        "seeds": once(BOUNDARY_SEEDS),
        "failed": once(BOUNDARY_FAILED),
        "stopped": once(BOUNDARY_STOPPED) > 0,
        "curves": curves(dataset),
        "unstable": unstable(dataset),
    }))
}

fn curves(dataset: &Dataset) -> Vec<Value> {
    let [edges, left, right] =
        [STABLE_EDGE, STABLE_LEFT, STABLE_RIGHT].map(|it| numbers(dataset, it.name));
    let [begins, ends] = [STABLE_BEGIN, STABLE_END].map(|it| names(dataset, it));
    let [lengths, errors] = [STABLE_LENGTH, STABLE_ERROR].map(|it| numbers(dataset, it.name));
    let [of_points, divided] =
        [STABLE_POINT_CURVE, STABLE_POINT_DIVIDED].map(|it| numbers(dataset, it.name));
    let curves = (0..edges.len()).map(|place| {
        let own = of_points.iter().zip(&divided).filter(|(curve, _)| **curve as usize == place);
        let divided = own.clone().filter(|(_, divided)| **divided > 0.0).count();
        json!({
            "saddle": (edges[place] >= 0.0).then_some(edges[place] as u64),
            "between": [left[place] as u64, right[place] as u64],
            "ends": [begins[place], ends[place]],
            "length": lengths[place],
            "points": own.count(),
            "divided": divided,
            "error": errors[place],
        })
    });
    curves.collect()
}

fn unstable(dataset: &Dataset) -> Vec<Value> {
    let columns = [UNSTABLE_EDGE, UNSTABLE_CYCLE, UNSTABLE_ATTRACTOR, UNSTABLE_TEARS];
    let [edges, cycles, attractors, tears] = columns.map(|it| numbers(dataset, it.name));
    let ends = names(dataset, UNSTABLE_END);
    let of_points = numbers(dataset, UNSTABLE_POINT_BRANCH.name);
    let halves = (0..edges.len()).map(|place| {
        json!({
            "saddle": edges[place] as u64,
            "cycle": cycles[place] as u64,
            "attractor": attractors[place] as u64,
            "end": ends[place],
            "tears": tears[place] as u64,
            "points": of_points.iter().filter(|it| **it as usize == place).count(),
        })
    });
    halves.collect()
}

/// The names of a category.
fn names(dataset: &Dataset, entry: Entry) -> Vec<String> {
    let flags = entry.flags();
    let name = |code: f64| flags.iter().find(|(it, _)| *it as f64 == code).map(|it| it.1.clone());
    numbers(dataset, entry.name).into_iter().map(|it| name(it).unwrap_or_default()).collect()
}

/// The same as text; empty where there are none.
pub fn manifolds_text(dataset: &Dataset) -> String {
    let Some(told) = manifolds(dataset) else { return String::new() };
    let curves = told["curves"].as_array().map_or(&[][..], Vec::as_slice);
    let unstable = told["unstable"].as_array().map_or(&[][..], Vec::as_slice);
    let length: f64 = curves.iter().filter_map(|it| it["length"].as_f64()).sum();
    let mut text = format!(
        "\nboundary as curves: {}, {length:.3} sides of the plane long\n",
        counted(curves.len(), "curve")
    );
    let (all, uncovered) = (&told["crossings"], told["uncovered"].as_u64().unwrap_or(0));
    let _ = match uncovered {
        0 => writeln!(
            text,
            "  beside all {all} pairs of neighbouring starts that lead to two attractors"
        ),
        _ => writeln!(
            text,
            "  boundary not resolved as curves: {uncovered} of {all} pairs of neighbouring starts that lead to two attractors; of {} tries {} gave no curve{}",
            told["seeds"],
            told["failed"],
            if told["stopped"] == true { "; the search stopped at its limits" } else { "" }
        ),
    };
    let mut longest: Vec<&Value> = curves.iter().collect();
    longest.sort_by(|a, b| length_of(b).total_cmp(&length_of(a)));
    for it in longest.iter().take(LISTED) {
        let [left, right] = [0, 1].map(|side| &it["between"][side]);
        let [begin, end] = [0, 1].map(|end| it["ends"][end].as_str().unwrap_or("-"));
        let of = match it["saddle"].as_u64() {
            Some(place) => format!("stable manifold of saddle {place}"),
            None => "followed by division".to_owned(),
        };
        let _ = writeln!(
            text,
            "  between {left} and {right}: {of}, {:.3} long, {} points, {} of them by division, ends: {begin}, {end}",
            length_of(it),
            it["points"],
            it["divided"]
        );
    }
    if longest.len() > LISTED {
        let _ = writeln!(text, "  and {} shorter ones", longest.len() - LISTED);
    }
    for it in unstable {
        let tears = it["tears"].as_u64().unwrap_or(0) as usize;
        let torn = if tears > 0 {
            format!(", torn at {}", counted(tears, "place"))
        } else {
            String::new()
        };
        let _ = writeln!(
            text,
            "  unstable manifold of saddle {}, cycle {}, to attractor {}: {} points, end: {}{torn}",
            it["saddle"],
            it["cycle"],
            it["attractor"],
            it["points"],
            it["end"].as_str().unwrap_or("-")
        );
    }
    text
}

fn length_of(curve: &Value) -> f64 {
    curve["length"].as_f64().unwrap_or(0.0)
}

/// A number of things.
fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}
