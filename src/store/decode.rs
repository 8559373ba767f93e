//! Reads a file of results back into its dataset, and checks all that the file says.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

use hdf5::types::{TypeDescriptor, VarLenUnicode};
use hdf5::{Dataset as Array, File, Hyperslab, SliceOrIndex};
use ndarray::{ArrayD, IxDyn};

use super::attribute::is_of_format;
use super::branches::is_beside_cases;
use super::catalogue::OUTCOME;
use super::names::*;
use super::own_layout;
use super::slab::Slab;
use super::watched::Watched;
use super::words::{has, text, words, words_or};
use super::{Dataset, StoreError, Values, Variable};

/// How often a file is tried that is locked, and the time between two tries.
const LOCK_TRIES: u32 = 100;
const LOCK_PAUSE: Duration = Duration::from_millis(100);
/// What is done when the system is asked about a file.
const LOOKING: &str = "looking whether the file has changed";

/// An open file of results, of which each variable can be read by itself.
#[derive(Debug)]
pub struct Archive {
    path: PathBuf,
    file: File,
    /// The same file as it was checked.
    checked: Watched,
    /// The coordinates, the attributes and the texts.
    frame: Dataset,
    /// The variables without their numbers, by name.
    labels: BTreeMap<String, Variable>,
}

impl Archive {
    /// Opens the HDF5 file at `path`, which was `checked`.
    pub(super) fn decode(path: &Path, checked: Watched) -> Result<Archive, StoreError> {
        let file = opened(path).map_err(StoreError::decoding(path, "opening the file"))?;
        check_format(&file, path)?;
        let mut frame = Dataset::default();
        let mut numbered = Vec::new();
        let mut waiting = Vec::new();
        let arrays = own_layout::arrays(&file)
            .map_err(StoreError::decoding(path, "listing the variables"))?;
        for (name, array) in arrays {
            let found = found(&array, &file, &name);
            match found.map_err(reading(path, &name))? {
                Found::Text(text) => drop(frame.texts.insert(name, text)),
                Found::Coordinate(id, variable) => numbered.push((id, (name, variable))),
                Found::Variable(ids, variable) => waiting.push((name, ids, variable, array)),
            }
        }
        numbered.sort_by_key(|(id, _)| *id);
        frame.coordinates = numbered.into_iter().map(|(_, coordinate)| coordinate).collect();
        let mut labels = BTreeMap::new();
        for (name, ids, mut variable, array) in waiting {
            variable.dimensions =
                dimensions(&frame, &ids, &array.shape()).map_err(reading(path, &name))?;
            labels.insert(name, variable);
        }
        frame.attributes =
            attributes(&file).map_err(StoreError::decoding(path, "reading the attributes"))?;
        // By its path another file may have been opened than the one that was checked.
        if !checked.is_at(path).map_err(StoreError::system(path, LOOKING))? {
            return Err(StoreError::ChangedSince { path: path.to_owned() });
        }
        let archive = Archive { path: path.to_owned(), file, checked, frame, labels };
        archive.check().map(|()| archive)
    }

    /// Fails if the file was changed since it was opened; one that replaces it does not change it. What was read before it
    /// fails may be of both.
    pub fn check(&self) -> Result<(), StoreError> {
        let unchanged = self.checked.is_unchanged();
        match unchanged.map_err(StoreError::system(&self.path, LOOKING))? {
            true => Ok(()),
            false => Err(StoreError::ChangedSince { path: self.path.clone() }),
        }
    }

    /// Where the file is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The coordinates, the attributes and the texts: all but the variables.
    pub fn frame(&self) -> &Dataset {
        &self.frame
    }

    /// Name and dimensions of every variable.
    pub fn variables(&self) -> impl Iterator<Item = (&str, &[String])> {
        self.labels.iter().map(|(name, label)| (name.as_str(), label.dimensions.as_slice()))
    }

    /// The unit of a variable; none if there is none of this name.
    pub fn unit(&self, name: &str) -> Option<&str> {
        self.labels.get(name).map(|label| label.unit.as_str())
    }

    /// A variable without its numbers; none if there is none of this name.
    pub(super) fn label(&self, name: &str) -> Option<&Variable> {
        self.labels.get(name)
    }

    /// How many numbers a variable has along each dimension; none if there is none of this name.
    pub(super) fn shape(&self, name: &str) -> Result<Option<Vec<usize>>, StoreError> {
        let array = self.labels.get(name).map(|_| self.file.dataset(name)).transpose();
        Ok(array.map_err(reading(&self.path, name))?.map(|array| array.shape()))
    }

    /// A variable with its numbers; none if there is none of this name.
    pub fn variable(&self, name: &str) -> Result<Option<Variable>, StoreError> {
        self.numbers(name, |array| values(&array))
    }

    /// What some cases, given by their positions along the axes, have of a variable; nothing if there is none
    /// of this name.
    pub fn rows(&self, name: &str, at: &[Vec<usize>]) -> Result<Vec<Values>, StoreError> {
        if !self.labels.contains_key(name) {
            return Ok(Vec::new());
        }
        self.check()?;
        let rows = self.file.dataset(name).and_then(|array| rows_of(&array, at));
        let rows = rows.map_err(reading(&self.path, name))?;
        self.check().map(|()| rows)
    }

    /// A variable at the cases of a slab, with what each has several of.
    pub(super) fn slab(&self, name: &str, slab: &Slab) -> Result<Option<Variable>, StoreError> {
        self.numbers(name, |array| values_of(&array, slab))
    }

    fn numbers(
        &self,
        name: &str,
        read: impl Fn(Array) -> hdf5::Result<Values>,
    ) -> Result<Option<Variable>, StoreError> {
        let Some(label) = self.labels.get(name) else { return Ok(None) };
        self.check()?;
        let values = self.file.dataset(name).and_then(read).map_err(reading(&self.path, name))?;
        self.check()?;
        Ok(Some(Variable { values, ..label.clone() }))
    }

    /// Whether it holds what `capsulemap sweep` finds.
    pub fn has_cases(&self) -> bool {
        self.labels.contains_key(OUTCOME.name)
    }

    /// The branches that `capsulemap continue` has found.
    pub fn branches(&self) -> Result<Dataset, StoreError> {
        self.dataset(|_, dimensions| dimensions.iter().any(|it| is_beside_cases(it)))
    }

    /// The dataset with those variables that are `wanted`, by name; the others have their labels, but no
    /// numbers.
    pub fn labelled(&self, wanted: impl Fn(&str) -> bool) -> Result<Dataset, StoreError> {
        let mut dataset = self.dataset(|name, _| wanted(name))?;
        for (name, label) in &self.labels {
            dataset.variables.entry(name.clone()).or_insert_with(|| label.clone());
        }
        Ok(dataset)
    }

    /// The same of the cases at these places along some axes alone, each of which has one value then.
    pub fn labelled_at(
        &self,
        held: &BTreeMap<String, usize>,
        wanted: impl Fn(&str) -> bool,
    ) -> Result<Dataset, StoreError> {
        let mut dataset = self.frame.clone();
        for (name, axis) in &mut dataset.coordinates {
            if let Some(&place) = held.get(name) {
                axis.values = axis.values.at(place);
            }
        }
        for (name, label) in &self.labels {
            // Of what is not wanted, which is most, not even the shape is read.
            let shape = if wanted(name) { self.shape(name)? } else { None };
            let variable = match shape {
                Some(shape) => self.slab(name, &Slab::at(&label.dimensions, &shape, held))?,
                None => None,
            };
            dataset.variables.insert(name.clone(), variable.unwrap_or_else(|| label.clone()));
        }
        Ok(dataset)
    }

    /// The dataset with those variables that are `wanted`, by name and dimensions.
    pub fn dataset(&self, wanted: impl Fn(&str, &[String]) -> bool) -> Result<Dataset, StoreError> {
        let mut dataset = self.frame.clone();
        for (name, _) in self.variables().filter(|(name, dimensions)| wanted(name, dimensions)) {
            let variable = self.variable(name)?;
            dataset.variables.extend(variable.map(|variable| (name.to_owned(), variable)));
        }
        Ok(dataset)
    }
}

/// Opens a file, and waits for a lock on it: HDF5 takes one for a writer, and a process that is being started beside it
/// holds that lock on.
fn opened(path: &Path) -> hdf5::Result<File> {
    for _ in 0..LOCK_TRIES {
        match File::open(path) {
            Err(said) if said.to_string().contains("unable to lock file") => sleep(LOCK_PAUSE),
            opened => return opened,
        }
    }
    File::open(path)
}

fn reading(path: &Path, name: &str) -> impl FnOnce(hdf5::Error) -> StoreError {
    StoreError::decoding(path, format!("reading {name}"))
}

/// What the cases at some positions along the axes have of an array.
fn rows_of(array: &Array, at: &[Vec<usize>]) -> hdf5::Result<Vec<Values>> {
    let slabs = at.iter().map(|it| Slab { start: it.clone(), count: vec![1; it.len()] });
    slabs.map(|slab| values_of(array, &slab)).collect()
}

/// What the cases of a slab have of an array.
fn values_of(array: &Array, slab: &Slab) -> hdf5::Result<Values> {
    let shape = array.shape();
    let ends = slab.start.iter().zip(&slab.count).map(|(start, count)| start + count);
    if slab.start.len() > shape.len() || ends.zip(&shape).any(|(end, length)| end > *length) {
        return Err("it has not the cases of the study in the file".into());
    }
    let Some(part) = hyperslab(slab, &shape) else { return values(array) };
    match array.dtype()?.to_descriptor()? {
        TypeDescriptor::Float(_) => Ok(Values::Real(array.read_slice::<f64, _, IxDyn>(part)?)),
        _ => Ok(Values::Integer(array.read_slice::<i64, _, IxDyn>(part)?)),
    }
}

/// The part of an array that a slab of a study covers, with all that each case has several of; none where
/// that is the whole array.
pub fn hyperslab(slab: &Slab, shape: &[usize]) -> Option<Hyperslab> {
    let axes = slab.start.len();
    if slab.count == shape[..axes] {
        return None;
    }
    let axes = slab.start.iter().zip(&slab.count).map(|(start, count)| *start..start + count);
    let inner = shape[slab.start.len()..].iter().map(|length| 0..*length);
    Some(axes.chain(inner).map(SliceOrIndex::from).collect::<Vec<_>>().into())
}

/// What a name in the file stands for; the numbers are positions among the coordinates.
enum Found {
    Text(String),
    Coordinate(i32, Variable),
    /// A variable without its numbers and dimensions.
    Variable(Vec<i32>, Variable),
}

fn check_format(file: &File, path: &Path) -> Result<(), StoreError> {
    let why = match words(file, FORMAT) {
        Ok(format) if format == FORMAT_WRITTEN => return Ok(()),
        Ok(format) => {
            format!("its layout is {format:?} and this version reads {FORMAT_WRITTEN:?}")
        }
        Err(_) => format!("it has no attribute {FORMAT}"),
    };
    Err(StoreError::Foreign { path: path.to_owned(), why })
}

fn found(array: &Array, file: &File, name: &str) -> hdf5::Result<Found> {
    let is_words = matches!(array.dtype()?.to_descriptor()?, TypeDescriptor::VarLenUnicode);
    if is_words && array.ndim() == 0 {
        return Ok(Found::Text(text(array.read_scalar::<VarLenUnicode>()?)?));
    }
    // Another program may have added a variable without them.
    let labels = [words_or(array, UNITS, "1")?, words_or(array, LONG_NAME, name)?];
    let mut variable =
        Variable::labelled(Vec::new(), labels, nothing(array)?).with_flags(flags(array, file)?);
    // netCDF-4 numbers the first dimension of other variables, too, that are no scale of one.
    if has(array, DIMENSION_ID)? && has(array, CLASS)? {
        variable.values = match is_words {
            true => codes(array, &variable.flags)?,
            false => values(array)?,
        };
        variable.dimensions.push(name.to_owned());
        return Ok(Found::Coordinate(array.attr(DIMENSION_ID)?.read_scalar()?, variable));
    }
    let ids = match has(array, DIMENSION_IDS)? {
        true => own_layout::attribute(array, DIMENSION_IDS, file)?,
        false => Vec::new(),
    };
    Ok(Found::Variable(ids, variable))
}

/// The numbers of a category whose values are stored by their names.
fn codes(array: &Array, flags: &[(i64, String)]) -> hdf5::Result<Values> {
    let mut codes = Vec::new();
    for name in array.read_raw::<VarLenUnicode>()? {
        let name = text(name)?;
        let flag = flags.iter().find(|(_, other)| *other == name);
        codes.push(flag.ok_or_else(|| format!("\"{name}\" is none of its values"))?.0);
    }
    Ok(Values::integers(codes))
}

/// No numbers, of the kind that the array has.
fn nothing(array: &Array) -> hdf5::Result<Values> {
    let none = IxDyn(&[0]);
    Ok(match array.dtype()?.to_descriptor()? {
        TypeDescriptor::Integer(_) => Values::Integer(ArrayD::zeros(none)),
        _ => Values::Real(ArrayD::zeros(none)),
    })
}

fn values(array: &Array) -> hdf5::Result<Values> {
    match array.dtype()?.to_descriptor()? {
        TypeDescriptor::Float(_) => Ok(Values::Real(array.read_dyn()?)),
        TypeDescriptor::Integer(_) => Ok(Values::Integer(array.read_dyn()?)),
        other => Err(format!("its type is {other}, neither a number nor a text").into()),
    }
}

fn flags(array: &Array, file: &File) -> hdf5::Result<Vec<(i64, String)>> {
    if !has(array, FLAG_VALUES)? {
        return Ok(Vec::new());
    }
    let values = own_layout::attribute::<i64>(array, FLAG_VALUES, file)?;
    let meanings = words(array, FLAG_MEANINGS)?;
    let meanings: Vec<&str> = meanings.split(' ').collect();
    if values.len() != meanings.len() {
        let (values, meanings) = (values.len(), meanings.len());
        return Err(format!("{values} flags with {meanings} meanings").into());
    }
    Ok(values.into_iter().zip(meanings.into_iter().map(String::from)).collect())
}

/// The names of a variable's dimensions, checked against the lengths of those coordinates.
fn dimensions(dataset: &Dataset, ids: &[i32], lengths: &[usize]) -> hdf5::Result<Vec<String>> {
    if lengths.len() != ids.len() {
        return Err(format!("{} dimensions, {} of them named", lengths.len(), ids.len()).into());
    }
    let mut names = Vec::new();
    for (id, length) in ids.iter().zip(lengths) {
        let coordinate = usize::try_from(*id).ok().and_then(|id| dataset.coordinates.get(id));
        match coordinate {
            Some((name, axis)) if axis.values.shape() == [*length] => names.push(name.clone()),
            _ => return Err(format!("no coordinate {id} of length {length}").into()),
        }
    }
    Ok(names)
}

fn attributes(file: &File) -> hdf5::Result<BTreeMap<String, String>> {
    let names = file.attr_names()?.into_iter();
    names
        .filter(|name| !is_of_format(name))
        .map(|name| number_or_words(file, &name).map(|words| (name, words)))
        .collect()
}

/// An attribute as words, which are those of a number where it holds one.
fn number_or_words(file: &File, name: &str) -> hdf5::Result<String> {
    let attribute = file.attr(name)?;
    match attribute.dtype()?.to_descriptor()? {
        TypeDescriptor::Integer(_) => Ok(attribute.read_scalar::<i64>()?.to_string()),
        TypeDescriptor::Float(_) => Ok(format!("{:e}", attribute.read_scalar::<f64>()?)),
        _ => words(file, name),
    }
}
