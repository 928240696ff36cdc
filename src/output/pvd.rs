//! ParaView collection: the time of every frame of a series.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::vtk::escape;
use super::{OutputError, write_text};
use crate::seeded::{self, Seed};

/// Writes a `.pvd` collection and rewrites it, whole, at every frame, so that it can be opened while the run goes on.
#[derive(Debug)]
pub struct PvdWriter {
    path: PathBuf,
    entries: String,
}

impl PvdWriter {
    /// Starts a collection without frames at `path`.
    ///
    /// # Errors
    /// [`OutputError::Create`] or [`OutputError::Write`].
    pub fn create(path: impl AsRef<Path>) -> Result<Self, OutputError> {
        let writer = Self { path: path.as_ref().to_path_buf(), entries: String::new() };
        writer.rewrite()?;
        Ok(writer)
    }

    /// Adds the frame stored in `file`, a path relative to the collection with `/` between its parts, at `time_s` (s).
    ///
    /// Files of the same time need different `part` numbers; a series of single files takes 0.
    ///
    /// # Errors
    /// [`OutputError::Name`] if `file` is empty or absolute, [`OutputError::Create`] or [`OutputError::Write`].
    pub fn frame(&mut self, time_s: f64, part: u32, file: &str) -> Result<(), OutputError> {
        if file.is_empty() || file.contains('\\') || Path::new(file).has_root() {
            let reason = "a frame is given relative to its collection, with / between the parts";
            return Err(OutputError::Name { path: self.path.clone(), name: file.to_owned(), reason });
        }
        let file = escape(file);
        let time_s = seeded::times(Seed::OutputCollection, time_s);
        let _ =
            writeln!(self.entries, "    <DataSet timestep=\"{time_s}\" group=\"\" part=\"{part}\" file=\"{file}\"/>");
        self.rewrite()
    }

    fn rewrite(&self) -> Result<(), OutputError> {
        let text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  \
             <Collection>\n{}  </Collection>\n</VTKFile>\n",
            self.entries
        );
        write_text(&self.path, &text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_is_whole_after_every_frame() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("run.pvd");
        let mut writer = PvdWriter::create(&path).unwrap();
        for k in 0..3u32 {
            let text = std::fs::read_to_string(&path).unwrap();
            assert_eq!(text.matches("<DataSet").count(), k as usize);
            assert!(text.ends_with("</VTKFile>\n"));
            writer.frame(f64::from(k) * 0.02, 0, &format!("vtk/points_{k:04}.vtp")).unwrap();
        }
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains("timestep=\"0.02\" group=\"\" part=\"0\" file=\"vtk/points_0001.vtp\""));
    }

    #[test]
    fn an_absolute_frame_is_refused() {
        let directory = tempfile::tempdir().unwrap();
        let mut writer = PvdWriter::create(directory.path().join("run.pvd")).unwrap();
        assert!(matches!(writer.frame(0.0, 0, "/points.vtp"), Err(OutputError::Name { .. })));
    }
}
