//! Where the results of a study lie, where their blocks lie, and whether a file can be written there.

use std::io;
use std::path::{Path, PathBuf};

use crate::store;

use super::error::CampaignError;

/// The longest name of a file of results: that of its report, which ends in .html for .h5, is longer [bytes].
const LONGEST_NAME: usize = store::LONGEST_NAME - 2;
/// The folder of files of what has been computed so far, beside the file of results.
const PARTIAL: &str = "partial";
/// The extension of the folder of blocks.
const BLOCKS: &str = "blocks";

/// The folder of the blocks that will be joined to the file `output`.
pub fn block_path(output: &Path) -> PathBuf {
    output.with_extension(BLOCKS)
}

/// The file of what has been computed so far of the results that go to `output`.
pub(super) fn partial_path(output: &Path) -> PathBuf {
    let name = output.file_name().unwrap_or_default();
    store::folder(output).join(PARTIAL).join(name)
}

/// The file that the results of the study at the path `study` go to: `output`, or
/// results/NAME/NAME.h5 for a study NAME.toml.
///
/// Fails if it cannot be a file of results, as a folder, a link that leads nowhere, a name that HDF5 does not take, or
/// the study itself.
pub fn output_path(study: &Path, output: Option<&Path>) -> Result<PathBuf, CampaignError> {
    let stem = file_stem(study)?;
    let output = match output {
        Some(output) => output.to_owned(),
        None => Path::new("results").join(&stem).join(format!("{stem}.h5")),
    };
    let whole = std::path::absolute(&output).unwrap_or_else(|_| output.clone());
    if whole.to_str().is_none() {
        return Err(CampaignError::of_path(&whole, store::NO_TEXT));
    }
    let name = output.file_name().map_or(0, |name| name.len());
    if name > LONGEST_NAME {
        let fault = format!("the name has {name} bytes; {LONGEST_NAME} are the most");
        return Err(CampaignError::of_path(&output, fault));
    }
    if output.extension().is_some_and(|extension| extension == BLOCKS) {
        let fault = "that extension is for the folder of blocks";
        return Err(CampaignError::of_path(&output, fault));
    }
    let output = store::place(&output)?;
    let [own, of_study] = [&output, study].map(|path| std::fs::canonicalize(path).ok());
    if own.is_some() && own == of_study {
        return Err(CampaignError::of_path(&output, "is the study itself; name another file"));
    }
    Ok(output)
}

/// The name of a file without its folder and extension.
fn file_stem(path: &Path) -> Result<String, CampaignError> {
    let stem = path.file_stem().and_then(|stem| stem.to_str());
    stem.map(str::to_owned).ok_or_else(|| CampaignError::of_path(path, "names no file"))
}

/// Creates the folder of the results, and checks before a long run that the file can be written there.
pub(super) fn prepare(output: &Path) -> Result<(), CampaignError> {
    let folder = store::folder(output);
    if let Some(file) = folder.ancestors().find(|ancestor| ancestor.is_file()) {
        let (folder, file) = (folder.to_owned(), file.to_owned());
        return Err(CampaignError::NoFolder { folder, file });
    }
    std::fs::create_dir_all(folder).map_err(|said| refused(folder, "cannot be created", said))?;
    store::try_to_begin(output)
        .map_err(|said| refused(folder, "no file can be written there", said))
}

fn refused(folder: &Path, refused: &'static str, said: io::Error) -> CampaignError {
    CampaignError::Refused { folder: folder.to_owned(), refused, said }
}
