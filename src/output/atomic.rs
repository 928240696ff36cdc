//! Files that appear only when they are complete: written beside their place, synced, then renamed over it.
//!
//! Elsewhere: atomic (crash-safe) writes.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::OutputError;

/// A file under construction as `<name>.tmp`, renamed to `<name>` by [`commit`](Self::commit).
///
/// Dropped without a commit, it removes what it wrote. A reader therefore sees the earlier version or the new one, whole.
#[derive(Debug)]
pub struct AtomicFile {
    path: PathBuf,
    temporary: PathBuf,
    writer: Option<BufWriter<File>>,
}

impl AtomicFile {
    /// Starts a file that will stand at `path`.
    ///
    /// # Errors
    /// [`OutputError::Create`] if the directory is missing or not writable.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, OutputError> {
        let path = path.as_ref().to_path_buf();
        let fail = |source| OutputError::Create { path: path.clone(), source };
        let mut name = match path.file_name() {
            Some(name) => OsString::from(name),
            None => {
                return Err(fail(io::Error::new(io::ErrorKind::InvalidInput, "the path names no file")));
            }
        };
        name.push(".tmp");
        let temporary = path.with_file_name(name);
        let file = File::create(&temporary).map_err(fail)?;
        Ok(Self { path, temporary, writer: Some(BufWriter::with_capacity(1 << 16, file)) })
    }

    /// Puts the finished file in its place.
    ///
    /// # Errors
    /// [`OutputError::Write`] if the last bytes, the sync or the rename fail; the temporary file is then removed.
    pub fn commit(mut self) -> Result<(), OutputError> {
        self.settle().map_err(|source| self.failure(source))
    }

    /// The error for a failed write to this file.
    pub(crate) fn failure(&self, source: io::Error) -> OutputError {
        OutputError::Write { path: self.path.clone(), source }
    }

    fn settle(&mut self) -> io::Result<()> {
        self.writer()?.flush()?;
        if let Some(writer) = &self.writer {
            writer.get_ref().sync_all()?;
        }
        fs::rename(&self.temporary, &self.path)?;
        self.writer = None;
        Ok(())
    }

    fn writer(&mut self) -> io::Result<&mut BufWriter<File>> {
        self.writer.as_mut().ok_or_else(|| io::Error::other("the file is already in its place"))
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer()?.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer()?.flush()
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        if let Some(writer) = self.writer.take() {
            // Not `drop(writer)`: that would push the rest of the buffer into a file about to be removed.
            let _unwritten = writer.into_parts();
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// Writes a small text file so that a reader never meets half of it.
///
/// # Errors
/// [`OutputError::Create`] or [`OutputError::Write`]; an earlier version of the file is then unchanged.
pub fn write_text(path: impl AsRef<Path>, text: &str) -> Result<(), OutputError> {
    write_bytes(path, text.as_bytes())
}

/// As [`write_text`], for what may be no text.
///
/// # Errors
/// As [`write_text`].
pub fn write_bytes(path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), OutputError> {
    let mut file = AtomicFile::create(path)?;
    file.write_all(bytes).map_err(|source| file.failure(source))?;
    file.commit()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_the_earlier_version_and_leaves_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("summary.txt");
        write_text(&path, "first, and longer\n").unwrap();
        write_text(&path, "second\n").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "second\n");
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[test]
    fn an_abandoned_file_changes_nothing() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("summary.txt");
        write_text(&path, "kept\n").unwrap();
        let mut file = AtomicFile::create(&path).unwrap();
        file.write_all(b"half of the new").unwrap();
        drop(file);
        assert_eq!(fs::read_to_string(&path).unwrap(), "kept\n");
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_missing_directory_is_named() {
        let message = write_text("no/such/directory/summary.txt", "").unwrap_err().to_string();
        assert!(message.contains("no/such/directory/summary.txt"), "{message}");
        assert!(message.contains("check that the path exists"), "{message}");
    }
}
