//! The file of a block of cases, which has a checksum and names the study and the program that wrote it.
//!
//! After a line that names the format comes one of JSON, then each column deflated, lowest byte first, and
//! at the end the checksum of all bytes.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use flate2::read::ZlibDecoder;
use serde::{Deserialize, Serialize};

use super::block_column::pack;
pub use super::block_column::{Column, Numbers};
use super::block_source::BlockSource;
use super::checksum::{self, Checksum};
use super::provenance;
pub use super::unusable::Unusable;
use super::{StoreError, file};

/// The first line of every block file; the number is increased with every change of the layout.
const FORMAT: &str = "capsulemap shard 2";
/// No head is longer [bytes].
const LONGEST_HEAD: u64 = 1 << 20;

/// The head of a block file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// Fingerprint of the study.
    pub fingerprint: String,
    /// The block.
    pub block: Summary,
    /// Program, time and machine that wrote it, see [`provenance::attributes`].
    #[serde(rename = "made")]
    pub provenance: BTreeMap<String, String>,
    columns: Vec<Place>,
}

/// A block in a few numbers.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Summary {
    /// Its number.
    pub number: usize,
    /// Cases in it.
    pub cases: usize,
    /// Cases that its columns have: those of the block, and of a tile of a refined study those that it has needed, the ones on
    /// all of its boundary among them.
    pub computed: usize,
    /// Cases by outcome, those that occur.
    pub outcomes: BTreeMap<String, usize>,
    /// Drive cycles that were computed for them.
    pub cycles: u64,
}

/// Where the numbers of a column are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Place {
    name: String,
    /// The least and the greatest number of a column of integers; none for reals.
    range: Option<[i64; 2]>,
    /// Bytes in the file, behind those of the columns before.
    bytes: u64,
}

/// A block file whose checksum is valid.
#[derive(Debug)]
pub struct BlockFile {
    /// Its head.
    pub head: Head,
    source: BlockSource,
    /// Where the first column begins.
    begin: u64,
}

/// The file of block `number` in `folder`.
pub fn path(folder: &Path, number: usize) -> PathBuf {
    folder.join(format!("block-{number:07}"))
}

/// Whether a file of this name is one of a block.
pub fn is_block(name: &str) -> bool {
    let number = name.strip_prefix("block-").and_then(|number| number.parse().ok());
    number.is_some_and(|number| path(Path::new(""), number) == Path::new(name))
}

/// How a block came to its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Written {
    /// It was written now.
    Now,
    /// Another process has written it meanwhile, with the same numbers to the bit, and that one stays.
    Before,
}

/// Writes the columns of a block to its file in `folder`, completely or not at all; a usable block that is there stays.
///
/// Fails if the system refuses, if the block that is there has other numbers, or if it has been removed meanwhile, as all are when
/// they are joined.
pub fn write(
    folder: &Path,
    fingerprint: &str,
    block: Summary,
    columns: &[Column],
) -> Result<Written, StoreError> {
    let number = block.number;
    let path = path(folder, number);
    let image = image(fingerprint, block, columns);
    let image = image.map_err(StoreError::system(&path, "packing"))?;
    if file::put_new(&path, &image)? {
        return Ok(Written::Now);
    }
    match open(folder, fingerprint, number) {
        Ok(there) => {
            let own = of_image(image.clone().into()).map_err(|_| there.damaged())?;
            match (there.has_the_numbers_of(&own), there.head.block == own.head.block) {
                (true, true) => Ok(Written::Before),
                // What it says of its numbers is wrong.
                (true, false) => file::put(&path, &image).map(|()| Written::Now),
                (false, _) => Err(StoreError::Contradicted { path }),
            }
        }
        Err(Unusable::Missing) => Err(StoreError::NoBlocks { folder: folder.to_owned() }),
        // It is damaged or foreign.
        Err(_) => file::put(&path, &image).map(|()| Written::Now),
    }
}

/// The bytes of a block file.
pub fn image(fingerprint: &str, block: Summary, columns: &[Column]) -> io::Result<Vec<u8>> {
    let packed: Vec<Vec<u8>> =
        columns.iter().map(|column| pack(&column.numbers)).collect::<io::Result<_>>()?;
    let places = columns.iter().zip(&packed).map(|(column, packed)| Place {
        name: column.name.clone(),
        range: column.numbers.range(),
        bytes: packed.len() as u64,
    });
    let head = Head {
        fingerprint: fingerprint.to_owned(),
        block,
        provenance: provenance::attributes(),
        columns: places.collect(),
    };
    let mut image = format!("{FORMAT}\n{}\n", serde_json::to_string(&head)?).into_bytes();
    packed.iter().for_each(|column| image.extend_from_slice(column));
    checksum::append(&mut image);
    Ok(image)
}

/// The file of block `number` in `folder`, after a check of its checksum.
pub fn open(folder: &Path, fingerprint: &str, number: usize) -> Result<BlockFile, Unusable> {
    let path = path(folder, number);
    let mut file = opened(&path)?;
    if checksum::check(&file).map_err(Unusable::Refused)? != Checksum::Valid {
        return Err(Unusable::Torn);
    }
    file.rewind().map_err(Unusable::Refused)?;
    let (head, begin) = read_head(file)?;
    match foreign(&head, fingerprint, number) {
        None => Ok(BlockFile { head, source: BlockSource::File(path), begin }),
        Some(why) => Err(Unusable::Foreign(why)),
    }
}

/// The block of an [image] that is held in memory.
///
/// Fails if the bytes are those of no block.
pub fn of_image(image: Arc<[u8]>) -> Result<BlockFile, Unusable> {
    let (head, begin) = read_head(&image[..])?;
    Ok(BlockFile { head, source: BlockSource::Memory(image), begin })
}

/// The head of the file of block `number` in `folder`; its columns are not read, but they are all there.
pub fn read_head_of(folder: &Path, fingerprint: &str, number: usize) -> Result<Head, Unusable> {
    let file = opened(&path(folder, number))?;
    let length = file.metadata().map_err(Unusable::Refused)?.len();
    let (head, begin) = read_head(file)?;
    let columns = head.columns.iter().map(|column| column.bytes);
    let expected = columns.fold(begin + checksum::CHECKSUM_BYTES as u64, u64::saturating_add);
    if length != expected {
        return Err(Unusable::Torn);
    }
    foreign(&head, fingerprint, number).map_or(Ok(head), |why| Err(Unusable::Foreign(why)))
}

/// A file, which must be a plain one: a pipe would be waited for.
fn opened(path: &Path) -> Result<File, Unusable> {
    if !std::fs::metadata(path).map_err(refused)?.is_file() {
        return Err(Unusable::Refused(io::Error::other("it is not a plain file")));
    }
    File::open(path).map_err(refused)
}

fn refused(error: io::Error) -> Unusable {
    match error.kind() {
        io::ErrorKind::NotFound => Unusable::Missing,
        _ => Unusable::Refused(error),
    }
}

/// The head of a block file, and where the first column begins.
fn read_head(file: impl Read) -> Result<(Head, u64), Unusable> {
    let mut reader = BufReader::new(file);
    let format = read_line(&mut reader)?;
    if format.strip_suffix(b"\n") != Some(FORMAT.as_bytes()) {
        return Err(Unusable::Torn);
    }
    let line = read_line(&mut reader)?;
    let head = serde_json::from_slice(&line).map_err(|_| Unusable::Torn)?;
    Ok((head, (format.len() + line.len()) as u64))
}

/// A line of a head, with its end.
fn read_line(reader: &mut BufReader<impl Read>) -> Result<Vec<u8>, Unusable> {
    let mut line = Vec::new();
    let read = reader.take(LONGEST_HEAD).read_until(b'\n', &mut line);
    read.map(|_| line).map_err(Unusable::Refused)
}

/// Why a block file is not of this study, version and number, if it is not.
fn foreign(head: &Head, fingerprint: &str, number: usize) -> Option<String> {
    if !provenance::is_ours(&head.provenance) {
        return Some(format!("made by another version, {}", provenance::program(&head.provenance)));
    }
    if head.fingerprint != fingerprint {
        return Some("made for another study".to_owned());
    }
    let other = head.block.number;
    (other != number).then(|| format!("it is block {other} under another name"))
}

impl BlockFile {
    /// The numbers of a column, of which each case has so many; none if there is none of this name.
    ///
    /// Fails if the file cannot be read, or holds another count of numbers; no more memory is taken than for those asked.
    pub fn column(&self, name: &str, width: usize) -> Result<Option<Numbers>, StoreError> {
        let Some(at) = self.head.columns.iter().position(|column| column.name == name) else {
            return Ok(None);
        };
        let count = self.head.block.computed.saturating_mul(width);
        match self.unpack(at, count).map_err(StoreError::system(self.source.path(), "reading"))? {
            None => Err(self.damaged()),
            numbers => Ok(numbers),
        }
    }

    /// So many numbers of the column at a place; none if there is another count.
    fn unpack(&self, at: usize, count: usize) -> io::Result<Option<Numbers>> {
        let columns = &self.head.columns;
        let before = columns[..at].iter().map(|column| column.bytes);
        let source = self.source.from(before.fold(self.begin, u64::saturating_add))?;
        let mut bytes = Vec::new();
        let most = (count as u64).saturating_mul(8);
        let packed = source.take(columns[at].bytes);
        ZlibDecoder::new(packed).take(most.saturating_add(1)).read_to_end(&mut bytes)?;
        if bytes.len() as u64 != most {
            return Ok(None);
        }
        let (numbers, _) = bytes.as_chunks::<8>();
        Ok(Some(match columns[at].range {
            None => Numbers::Real(numbers.iter().map(|it| f64::from_le_bytes(*it)).collect()),
            Some(_) => Numbers::Integer(numbers.iter().map(|it| i64::from_le_bytes(*it)).collect()),
        }))
    }

    /// The numbers of a column of reals, of which each case has so many.
    pub fn reals(&self, name: &str, width: usize) -> Result<Vec<f64>, StoreError> {
        match self.column(name, width)? {
            Some(Numbers::Real(all)) => Ok(all),
            _ => Err(self.damaged()),
        }
    }

    /// The numbers of a column of integers, of which each case has so many.
    pub fn integers(&self, name: &str, width: usize) -> Result<Vec<i64>, StoreError> {
        match self.column(name, width)? {
            Some(Numbers::Integer(all)) => Ok(all),
            _ => Err(self.damaged()),
        }
    }

    /// The numbers of a column of rising indices, of which there are so many.
    ///
    /// Fails if the file cannot be read, or holds others.
    pub fn cases(&self, name: &str, count: usize) -> Result<Vec<usize>, StoreError> {
        let numbers = self.integers(name, 1)?;
        let rises = numbers.is_sorted_by(|a, b| a < b);
        match numbers.iter().all(|it| (0..count as i64).contains(it)) && rises {
            true => Ok(numbers.into_iter().map(|it| it as usize).collect()),
            false => Err(self.damaged()),
        }
    }

    /// Whether another block has the same numbers, to the bit; not if one of the two cannot be read.
    fn has_the_numbers_of(&self, other: &BlockFile) -> bool {
        let both = self.packed().and_then(|own| Ok(own == other.packed()?));
        self.head.columns == other.head.columns && both.unwrap_or(false)
    }

    /// The bytes of all columns.
    fn packed(&self) -> io::Result<Vec<u8>> {
        let count = self.head.columns.iter().map(|column| column.bytes).sum();
        let mut bytes = Vec::new();
        self.source.from(self.begin)?.take(count).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    fn damaged(&self) -> StoreError {
        StoreError::Damaged { path: self.source.path().to_owned() }
    }

    /// The least and the greatest number of a column of integers, if it is one and has any.
    pub fn range(&self, name: &str) -> Option<[i64; 2]> {
        let column = self.head.columns.iter().find(|column| column.name == name)?;
        column.range.filter(|[low, high]| low <= high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns() -> Vec<Column> {
        let reals = vec![1.5, f64::NAN, -0.0, f64::INFINITY, 1e-300, 2.0];
        let column = |name: &str, numbers| Column { name: name.to_owned(), numbers };
        vec![
            column("speed", Numbers::Real(reals)),
            column("period", Numbers::Integer(vec![1, -7, i64::MAX])),
        ]
    }

    fn block(number: usize) -> Summary {
        let outcomes = BTreeMap::from([("periodic".to_owned(), 3)]);
        Summary { number, cases: 3, computed: 3, outcomes, cycles: 90 }
    }

    #[test]
    fn every_number_comes_back_bit_for_bit() {
        let folder = tempfile::tempdir().expect("a folder");
        write(folder.path(), "a", block(12), &columns()).expect("it is written");
        let file = open(folder.path(), "a", 12).expect("it is whole");
        assert_eq!(file.head.block, block(12));
        assert_eq!(read_head_of(folder.path(), "a", 12).expect("a head"), file.head);
        assert_eq!((file.range("period"), file.range("speed")), (Some([-7, i64::MAX]), None));
        assert!(file.head.provenance.contains_key("commit"));
        let Ok(Some(Numbers::Real(reals))) = file.column("speed", 2) else { panic!("reals") };
        let Numbers::Real(expected) = &columns()[0].numbers else { panic!("reals") };
        let bits = |reals: &[f64]| reals.iter().map(|it| it.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&reals), bits(expected));
        let period = file.column("period", 1).expect("it is read");
        assert_eq!(period, Some(columns()[1].numbers.clone()));
        assert!(file.column("nothing", 1).expect("it is read").is_none());
    }

    #[test]
    fn damaged_and_foreign_blocks_are_never_opened() {
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path();
        assert!(matches!(open(place, "a", 0), Err(Unusable::Missing)));
        write(place, "a", block(0), &columns()).expect("it is written");
        let whole = std::fs::read(path(place, 0)).expect("bytes");
        for length in (0..whole.len()).step_by(7) {
            std::fs::write(path(place, 0), &whole[..length]).expect("it is cut");
            assert!(matches!(open(place, "a", 0), Err(Unusable::Torn)), "{length}");
        }
        for byte in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[byte] ^= 1 << (byte % 8);
            std::fs::write(path(place, 0), bytes).expect("it is flipped");
            assert!(matches!(open(place, "a", 0), Err(Unusable::Torn)), "{byte}");
        }
        std::fs::write(path(place, 0), &whole).expect("it is whole");
        assert!(open(place, "a", 0).is_ok());
        assert!(matches!(open(place, "b", 0), Err(Unusable::Foreign(_))));
        std::fs::rename(path(place, 0), path(place, 1)).expect("it is renamed");
        assert!(matches!(open(place, "a", 1), Err(Unusable::Foreign(_))));
    }
}
