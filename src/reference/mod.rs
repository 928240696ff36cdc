//! The reference of every key of case and study files, made from the doc comments of the structs that read them, and of what a run
//! leaves, made from the table of columns and from the summary.
//!
//! A doc comment of a field says what the key means; then, each after its label, what it is when left out (`Default:`), what
//! is allowed (`Allowed:`), and one value (`Example:`). The unit follows from the key's name. From this come a page
//! for people and a JSON schema for editors; [`tests`] compares all with what is committed, and `cargo reference` writes them.
//! `shipped_tests` holds every case and study of the project against the schemas.

mod markdown;
mod results;
mod results_tests;
mod schema;
mod shipped_tests;
mod tests;
mod valid;
