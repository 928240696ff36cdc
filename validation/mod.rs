//! Are we solving the right equations? Experiments, with the uncertainty of their numbers and of ours.

pub mod data;
#[cfg(test)]
mod errata;
