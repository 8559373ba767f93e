//! The paths of a study in its results: dimensions along which several quantities vary together.

use super::catalogue::named;
use super::{Archive, Dataset};
use crate::description::Description;
use crate::study::Coordinate;

/// A path of results.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Path {
    /// The name of its dimension.
    pub name: String,
    /// What varies along it, in the order of the model: the names of variables over the dimension alone.
    pub quantities: Vec<String>,
}

/// The paths of a dataset.
pub fn paths(dataset: &Dataset) -> Vec<Path> {
    let dimensions = dataset.coordinates.iter().map(|(name, _)| name.as_str());
    let over = |name: &str| dataset.variable(name).map(|it| &it.dimensions[..]);
    of_dimensions(dimensions, over, dataset.model())
}

/// The paths of a file.
pub fn paths_of(archive: &Archive) -> Vec<Path> {
    let dimensions = archive.frame().coordinates.iter().map(|(name, _)| name.as_str());
    let over = |wanted: &str| archive.variables().find(|it| it.0 == wanted).map(|it| it.1);
    of_dimensions(dimensions, over, archive.frame().model())
}

fn of_dimensions<'a>(
    dimensions: impl Iterator<Item = &'a str>,
    over: impl Fn(&str) -> Option<&'a [String]>,
    model: &'static Description,
) -> Vec<Path> {
    let mut paths = Vec::new();
    // A path is called as nothing else is.
    for name in dimensions.filter(|name| named(name, model).is_none()) {
        let all = Coordinate::all(model).map(Coordinate::name);
        let own = all.filter(|it| over(it).is_some_and(|over| over == [name]));
        let quantities: Vec<String> = own.map(str::to_owned).collect();
        if !quantities.is_empty() {
            paths.push(Path { name: name.to_owned(), quantities });
        }
    }
    paths
}

/// What varies along those of some paths that are among the dimensions of a variable, in the words of CF; nothing of what varies itself.
pub fn auxiliary(paths: &[Path], name: &str, dimensions: &[String]) -> String {
    let along = paths.iter().filter(|path| dimensions.contains(&path.name));
    let names: Vec<&str> =
        along.flat_map(|path| path.quantities.iter().map(String::as_str)).collect();
    if names.contains(&name) { String::new() } else { names.join(" ") }
}
