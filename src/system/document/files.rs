//! The files that a document names.

use super::{Document, Scatter};
use crate::error::Problem;
use std::path::Path;

impl Document {
    /// Files that the document names and that are not there.
    pub(super) fn missing_files(&self) -> Vec<Problem> {
        let mut files: Vec<(String, &Path)> = Vec::new();
        for (at, geometry) in self.indices.geometry.iter().zip(&self.system.geometry) {
            files.push((format!("geometry[{at}].file"), &geometry.file));
        }
        for (at, change) in self.indices.configure.iter().zip(&self.system.configure) {
            let with = change.replace.iter();
            files.extend(with.map(|with| (format!("configure[{at}].replace.file"), with.file.as_path())));
        }
        for (name, medium) in self.system.media.iter() {
            files.extend(medium.file().map(|file| (format!("media[{name:?}].file"), file)));
        }
        for (name, coating) in self.system.coatings.iter() {
            files.extend(coating.file().map(|file| (format!("coatings[{name:?}].file"), file)));
        }
        for (name, scatter) in self.system.scatter.iter() {
            tables(scatter, &format!("scatter[{name:?}]"), &mut files);
        }
        for (name, sweep) in self.system.sweeps.iter() {
            files.extend(sweep.mask.iter().map(|mask| (format!("sweeps[{name:?}].mask.file"), mask.file.as_path())));
        }
        let missing = files.into_iter().filter(|(_, file)| !self.resolve(file).is_file());
        missing.map(|(path, file)| self.problem(&path, no_file(file, &self.resolve(file)))).collect()
    }
}

/// The tables that a scatter model reads, each with its path in the document.
fn tables<'a>(scatter: &'a Scatter, path: &str, files: &mut Vec<(String, &'a Path)>) {
    match scatter {
        Scatter::Table { file, .. } | Scatter::Klems { file, .. } => files.push((format!("{path}.file"), file)),
        Scatter::Sum(parts) => {
            parts.iter().enumerate().for_each(|(at, part)| tables(part, &format!("{path}[{at}]"), files));
        }
        _ => {}
    }
}

/// That a file is not there.
pub(super) fn no_file(written: &Path, resolved: &Path) -> Problem {
    let what = if resolved.exists() { "is not a file" } else { "does not exist" };
    Problem::error(format!("{:?} {what}", written.display().to_string()))
        .hinting("files are relative to the system file".to_owned())
}
