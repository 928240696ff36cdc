//! A study from a file or a text: read, checked, or refused in words.
//!
//! Elsewhere: parsing, deserialisation.

use super::check::check;
use super::file::{Study, StudyError};
use crate::case::{self, CaseError};
use std::path::Path;

impl Study {
    /// Reads a study file.
    ///
    /// # Errors
    /// The file cannot be read, or [`Study::parse`] refuses it.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        let text = case::read_as(&case::STUDY, path).map_err(|e| StudyError::Unreadable(e.to_string()))?;
        Self::parse(&text, &path.display().to_string())
    }

    /// Reads the text of a study file; `name` stands for it in reports.
    ///
    /// # Errors
    /// [`StudyError::Malformed`] and [`StudyError::Invalid`], with the line, what is allowed and what to do.
    pub fn parse(text: &str, name: &str) -> Result<Self, StudyError> {
        let (study, _) = case::parse_as(&case::STUDY, text, name, check).map_err(|error| match error {
            CaseError::Unreadable(report) => StudyError::Unreadable(report),
            CaseError::Malformed(report) => StudyError::Malformed(report),
            CaseError::Invalid { report, .. } => StudyError::Invalid(report),
        })?;
        Ok(study)
    }
}
