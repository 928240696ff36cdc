//! checkdam for Python: the part in Rust. What a user sees is in `checkdam/`, which says shapes and units.
//!
//! Nothing is computed here: cases are read, runs made and tables read by the library that the command uses.

mod case;
mod failure;
mod run;
mod simulation;
mod study;
mod table;
mod value;

/// The part of checkdam in Rust; use the package `checkdam`.
#[pyo3::pymodule]
mod _checkdam {
    #[pymodule_export]
    use super::case::{Case, load};
    #[pymodule_export]
    use super::run::run;
    #[pymodule_export]
    use super::simulation::Simulation;
    #[pymodule_export]
    use super::study::study;
    #[pymodule_export]
    use super::table::read_table;
    #[pymodule_export]
    use super::value::read_toml;
    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
