//! Files a run leaves behind: CSV tables, VTK frames, small text files.
//!
//! Every writer here leaves a readable file at any moment: tables end in a whole row, everything else appears by rename.

mod atomic;
mod error;
mod lock;
mod number;
mod pvd;
mod table;
mod vtk;

pub use atomic::{AtomicFile, write_bytes, write_text};
pub use error::OutputError;
pub use lock::{LOCK, Lock};
pub use pvd::PvdWriter;
pub use table::{Table, TableWriter};
pub use vtk::{Field, Polyline, Values, write_points, write_polylines};
