//! The reference of every key of case and study files, made from the doc comments of the structs that read them.
//!
//! A doc comment of a field says what the key means; then, each after its label, what it is when left out (`Default:`), what
//! is allowed (`Allowed:`), and one value (`Example:`). The unit follows from the key's name. From this come a page
//! for people and a JSON schema for editors; [`tests`] compares both with what is committed, and `cargo reference` writes them.

mod markdown;
mod schema;
mod tests;
