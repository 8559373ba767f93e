//! Where the results of a study lie, where their blocks lie, and whether a file can be written there.

use std::path::{Path, PathBuf};

use super::error::CampaignError;

/// The extension of the folder of blocks.
const BLOCKS: &str = "blocks";

/// The folder of the blocks that will be joined to the file `output`.
pub fn block_path(output: &Path) -> PathBuf {
    output.with_extension(BLOCKS)
}

/// The file that the results of the study at the path `study` go to: `output`, or
/// results/NAME/NAME.h5 for a study NAME.toml.
///
/// Fails if it cannot be a file of results, as a folder, or the study itself.
pub fn output_path(study: &Path, output: Option<&Path>) -> Result<PathBuf, CampaignError> {
    let stem = file_stem(study)?;
    let default = || Path::new("results").join(&stem).join(format!("{stem}.h5"));
    let output = output.map_or_else(default, Path::to_owned);
    let unfit = |path: &Path, fault: &str| {
        Err(CampaignError::Path { path: path.to_owned(), fault: fault.to_owned() })
    };
    if output.exists() && !output.is_file() {
        let what = if output.is_dir() { "a folder" } else { "not a plain file" };
        return unfit(&output, &format!("is {what}; name a file"));
    }
    if output.extension().is_some_and(|extension| extension == BLOCKS) {
        return unfit(&output, "that extension is for the folder of blocks");
    }
    // Where a link leads, so that not the link is replaced.
    let output =
        std::fs::canonicalize(&output).ok().filter(|_| output.is_symlink()).unwrap_or(output);
    let same = |path: &Path| std::fs::canonicalize(path).ok();
    if same(&output).is_some_and(|output| Some(output) == same(study)) {
        return unfit(&output, "is the study itself; name another file");
    }
    Ok(output)
}

/// The name of a file without its folder and extension.
fn file_stem(path: &Path) -> Result<String, CampaignError> {
    let stem = path.file_stem().and_then(|stem| stem.to_str());
    let fault = "names no file".to_owned();
    stem.map(str::to_owned).ok_or(CampaignError::Path { path: path.to_owned(), fault })
}

/// Creates the folder of the results, and checks that a file can be written there before a long run.
pub(super) fn prepare(folder: &Path) -> Result<(), CampaignError> {
    if let Some(file) = folder.ancestors().find(|ancestor| ancestor.is_file()) {
        let (folder, file) = (folder.to_owned(), file.to_owned());
        return Err(CampaignError::NoFolder { folder, file });
    }
    let failed =
        |refused| move |said| CampaignError::Refused { folder: folder.to_owned(), refused, said };
    std::fs::create_dir_all(folder).map_err(failed("cannot be created"))?;
    let probe = tempfile::tempfile_in(folder).map(drop);
    probe.map_err(failed("no file can be written there"))
}
