//! Reads the distribution of starts that an option gives.

use super::arguments::plain_or_quantity;
use crate::description::Description;
use crate::study::document::unknown;
use crate::study::{Coordinate, Normal};

/// The normal distributions of coordinates of the start that `--density` gives, each as NAME=MEAN,DEVIATION; tells all faults.
pub fn densities(
    given: &[String],
    model: &'static Description,
) -> Result<Vec<(Coordinate, Normal)>, Vec<String>> {
    let (mut found, mut faults): (Vec<(Coordinate, Normal)>, Vec<String>) = Default::default();
    for text in given {
        match density(text, model) {
            Ok((coordinate, _)) if found.iter().any(|(it, _)| *it == coordinate) => {
                faults.push(format!("--density {text}: {} is given twice", coordinate.name()));
            }
            Ok(density) => found.push(density),
            Err(fault) => faults.push(format!("--density {text}: {fault}")),
        }
    }
    if faults.is_empty() { Ok(found) } else { Err(faults) }
}

fn density(text: &str, model: &'static Description) -> Result<(Coordinate, Normal), String> {
    let parts = text.split_once('=').and_then(|(name, numbers)| {
        let (mean, deviation) = numbers.split_once(',')?;
        Some((name.trim(), [mean, deviation]))
    });
    let (name, numbers) = parts.ok_or("expected NAME=MEAN,DEVIATION, as start_y1=0,\"0.5 m/s\"")?;
    let starts: Vec<Coordinate> = Coordinate::all(model).filter(|it| it.is_start()).collect();
    let coordinate = starts.iter().find(|it| it.name() == name).copied();
    let names = starts.iter().map(|it| it.name());
    let coordinate = coordinate.ok_or_else(|| unknown("coordinate of the start", name, names))?;
    let [mean, deviation] = numbers.map(|it| plain_or_quantity(it, coordinate.dimension()));
    let (mean, deviation) = (mean?, deviation?);
    match deviation > 0.0 {
        true => Ok((coordinate, Normal { mean, deviation })),
        false => Err(format!("the deviation is {deviation}; expected a number above zero")),
    }
}
