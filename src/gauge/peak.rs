//! A largest value, and when it was.

/// The largest value over all steps so far: of single steps, or of means that end with them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Peak {
    /// The value, in the unit of what is read.
    pub value: f64,
    /// When, s; of a mean, the middle of its time.
    pub time: f64,
}
