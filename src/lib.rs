//! checkdam: skeleton.
pub mod case;
pub mod output;
pub mod plot;
