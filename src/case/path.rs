//! Where in a case file: `bodies[0].x_m`.

use std::fmt;

/// One step into a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PathSegment {
    /// A key of a table.
    Key(String),
    /// An element of an array, from 0.
    Index(usize),
}

/// Keys and indices from the top of a document; the empty path is the document itself.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct KeyPath(pub Vec<PathSegment>);

impl KeyPath {
    /// The path of a key at the top of the document.
    pub fn top(key: &str) -> Self {
        Self::default().key(key)
    }

    /// The path of a key in the table at this path.
    #[must_use]
    pub fn key(&self, key: &str) -> Self {
        self.with(PathSegment::Key(key.to_owned()))
    }

    /// The path of an element of the array at this path.
    #[must_use]
    pub fn index(&self, index: usize) -> Self {
        self.with(PathSegment::Index(index))
    }

    /// The path of another key in the table that holds this one.
    #[must_use]
    pub fn beside(&self, key: &str) -> Self {
        let parent = self.0.split_last().map_or(&[][..], |(_, parent)| parent);
        KeyPath(parent.to_vec()).key(key)
    }

    /// Whether this path is `prefix` or lies inside it.
    pub fn is_in(&self, prefix: &KeyPath) -> bool {
        self.0.starts_with(&prefix.0)
    }

    /// The last key of the path, empty if there is none.
    pub fn last_key(&self) -> &str {
        let key = |segment: &'_ PathSegment| matches!(segment, PathSegment::Key(_));
        match self.0.iter().rfind(|segment| key(segment)) {
            Some(PathSegment::Key(key)) => key,
            _ => "",
        }
    }

    fn with(&self, segment: PathSegment) -> Self {
        let mut segments = self.0.clone();
        segments.push(segment);
        KeyPath(segments)
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return f.write_str("the file");
        }
        for (position, segment) in self.0.iter().enumerate() {
            match segment {
                PathSegment::Index(index) => write!(f, "[{index}]")?,
                PathSegment::Key(key) => {
                    let dot = if position == 0 { "" } else { "." };
                    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c));
                    if bare { write!(f, "{dot}{key}")? } else { write!(f, "{dot}{key:?}")? }
                }
            }
        }
        Ok(())
    }
}
