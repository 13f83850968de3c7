//! The names of the files that a run of a writer creates. They begin with the number of the run, which no other run in
//! the folder has, so that no run changes a file of another one.

use crate::manifest::MANIFEST_FILE;
use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Returns the name of the file of a shard by the number of its run and its own number, for programs that remove what
/// an interruption leaves.
#[must_use]
pub fn shard_file(run: u64, number: usize) -> String {
    format!("{run}-{number:05}.p2m")
}

/// Returns the name that the manifest of a run has until the run is finished.
pub(super) fn unfinished_manifest(run: u64) -> String {
    format!("{run}-{MANIFEST_FILE}")
}

/// Parses the number of the run from a file name. Returns `None` if it is not the name of a file of a run.
pub(super) fn run_of(name: &str) -> Option<u64> {
    let (run, rest) = name.split_once('-')?;
    let run = u64::from(run.parse::<u32>().ok()?);
    let number = rest.strip_suffix(".p2m").and_then(|number| number.parse().ok());
    let is_of_run = number.is_some_and(|number| shard_file(run, number) == name) || unfinished_manifest(run) == name;
    is_of_run.then_some(run)
}

/// Returns the names of the files that runs have created in a folder, with the numbers of their runs.
pub(super) fn files_of_runs(folder: &Path) -> io::Result<Vec<(u64, String)>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let name = entry?.file_name();
        files.extend(name.to_str().and_then(|name| Some((run_of(name)?, name.to_owned()))));
    }
    Ok(files)
}

/// Begins a run in a folder by creating the file of its first shard. Returns the number of the run, which is greater
/// than the numbers of all runs with files in the folder.
pub(super) fn begin_run(folder: &Path) -> io::Result<u64> {
    let last = files_of_runs(folder)?.into_iter().map(|(run, _)| run).max();
    let mut run = last.map_or(0, |last| last + 1);
    loop {
        match File::create_new(folder.join(shard_file(run, 0))) {
            Ok(_) => return Ok(run),
            // Another writer has begun this run since the folder was read.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => run += 1,
            Err(error) => return Err(error),
        }
    }
}
