//! Results for other programs.

use std::fs::{self, OpenOptions, Permissions};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};
use thiserror::Error;

use super::{Panel, Results};

/// A file cannot be written.
#[derive(Debug, Error)]
#[error("cannot write `{}`: {cause}", path.display())]
pub struct ReportError {
    /// The file.
    pub path: PathBuf,
    /// What the system, or the format's writer, says.
    pub cause: String,
}

impl ReportError {
    fn new(path: &Path, cause: impl ToString) -> Self {
        Self { path: path.to_owned(), cause: cause.to_string() }
    }
}

/// Makes sure, before a measurement, that all `outputs` can be written after it, and that no two of
/// them are one file, nor an output one of `inputs`. Changes nothing.
///
/// Errors: a file that cannot be written, or that would overwrite another one.
pub fn check_files(inputs: &[&Path], outputs: &[&Path]) -> Result<(), ReportError> {
    let canonical = |input: &&Path| fs::canonicalize(input).ok();
    let mut taken: Vec<PathBuf> = inputs.iter().filter_map(canonical).collect();
    for output in outputs {
        let target = target(output)?;
        if target.exists() {
            let opened = OpenOptions::new().write(true).open(&target);
            opened.map_err(|cause| ReportError::new(output, cause))?;
        }
        if is_replaced(&target) {
            if taken.contains(&target) {
                return Err(ReportError::new(output, "another file of this run is the same"));
            }
            beside(&target).map_err(|cause| ReportError::new(output, cause))?;
        }
        taken.push(target);
    }
    Ok(())
}

/// Lets `write` fill a new file, and puts it in the place of the one at `path` when it is complete:
/// until then, the old one stays as it is.
///
/// Errors: the file cannot be written.
pub fn replace_file<E: ToString>(
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), ReportError> {
    let target = target(path)?;
    let failed = |cause: String| ReportError::new(path, cause);
    if !is_replaced(&target) {
        return write(&target).map_err(|cause| failed(cause.to_string()));
    }
    let file = beside(&target).map_err(|cause| failed(cause.to_string()))?;
    write(file.path()).map_err(|cause| failed(cause.to_string()))?;
    file.persist(&target).map_err(|cause| failed(cause.to_string()))?;
    Ok(())
}

/// Where a path leads to, symbolic links followed.
fn target(path: &Path) -> Result<PathBuf, ReportError> {
    if let Ok(target) = fs::canonicalize(path) {
        return Ok(target);
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = fs::canonicalize(folder.unwrap_or(Path::new(".")));
    let folder = folder.map_err(|cause| ReportError::new(path, cause))?;
    let name = path.file_name().ok_or_else(|| ReportError::new(path, "it is not a file"))?;
    Ok(folder.join(name))
}

/// Whether a new file can take its place: not that of a device or a pipe.
fn is_replaced(target: &Path) -> bool {
    fs::metadata(target).map_or(true, |old| old.is_file())
}

/// A file of another name in the same folder, with the permissions of the old one.
fn beside(target: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let file = builder.tempfile_in(target.parent().unwrap_or(Path::new("/")))?;
    let old: Option<Permissions> = fs::metadata(target).ok().map(|old| old.permissions());
    old.map(|permissions| file.as_file().set_permissions(permissions)).transpose()?;
    Ok(file)
}

impl Results {
    /// Writes everything as one JSON object.
    ///
    /// Errors: the file cannot be written.
    pub fn write_json(&self, path: &Path) -> Result<(), ReportError> {
        replace_file(path, |path| {
            fs::write(path, serde_json::to_vec_pretty(self)?).map_err(serde_json::Error::io)
        })
    }

    /// Writes all numbers as CSV, one a line: study, scene, contact recycling, backend, quantity,
    /// statistic, value.
    ///
    /// Errors: the file cannot be written.
    pub fn write_csv(&self, path: &Path) -> Result<(), ReportError> {
        replace_file(path, |path| {
            let mut writer = csv::Writer::from_path(path)?;
            for measurement in self.rows.iter().flat_map(|row| row.measurements()) {
                writer.serialize(measurement)?;
            }
            Ok::<_, csv::Error>(writer.flush()?)
        })
    }

    /// Draws the panels, side by side, into an SVG file.
    ///
    /// Errors: the file cannot be written.
    pub fn write_plot(&self, path: &Path) -> Result<(), ReportError> {
        replace_file(path, |path| fs::write(path, Panel::draw_all(&self.panels)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Would catch results that overwrite each other or a mesh, under one name or two, and folders
    /// that only turn out to be missing or a file that turns out to be a folder after the run.
    #[test]
    fn files_that_would_be_lost_are_refused_before_the_run() {
        let folder = tempfile::tempdir().unwrap();
        let [mesh, old, new] = ["mesh.obj", "old.json", "new.csv"].map(|f| folder.path().join(f));
        fs::write(&mesh, "mesh").unwrap();
        fs::write(&old, "old").unwrap();
        check_files(&[&mesh], &[&old, &new]).unwrap();
        let other_name = folder.path().join(".").join("new.csv");
        let missing = folder.path().join("missing/new.csv");
        let refused: [(&[&Path], &[&Path], &Path); 5] = [
            (&[], &[&old, &old], &old),
            (&[], &[&new, &other_name], &other_name),
            (&[&mesh], &[&new, &mesh], &mesh),
            (&[], &[&missing], &missing),
            (&[], &[folder.path()], folder.path()),
        ];
        for (inputs, outputs, named) in refused {
            let error = check_files(inputs, outputs).unwrap_err();
            assert_eq!(error.path, named, "{error}");
        }
        #[cfg(unix)]
        {
            let link = folder.path().join("link.json");
            std::os::unix::fs::symlink(&old, &link).unwrap();
            assert!(check_files(&[], &[&old, &link]).is_err());
            check_files(&[], &[Path::new("/dev/null"), Path::new("/dev/null")]).unwrap();
            replace_file(Path::new("/dev/null"), |path| fs::write(path, "nothing")).unwrap();
            assert!(!fs::metadata("/dev/null").unwrap().is_file());
        }
        assert_eq!(fs::read_to_string(&mesh).unwrap(), "mesh");
        assert_eq!(fs::read_to_string(&old).unwrap(), "old");
        assert!(!new.exists());
        assert!(fs::read_dir(folder.path()).unwrap().count() <= 3, "nothing is left behind");
    }

    /// Would catch an old result that is lost when a new one cannot be completed, and a new one
    /// that is not put in its place.
    #[test]
    fn the_old_file_stays_until_the_new_one_is_complete() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("results.json");
        fs::write(&path, "old").unwrap();
        let error = replace_file(&path, |new| {
            fs::write(new, "half").unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), "old");
            Err("aborted")
        });
        assert_eq!(error.unwrap_err().cause, "aborted");
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        replace_file(&path, |new| fs::write(new, "new")).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
