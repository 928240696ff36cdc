//! The result of one run as a file of its own, which says itself whether it is whole.
//!
//! Elsewhere: a job's output with a checksum.

use super::plan::{PlannedRun, fingerprint};
use super::quantities::QUANTITIES;
use super::table::Row;
use std::fmt::Write;
use std::sync::OnceLock;
use toml::{Table, Value};

/// What the last line begins with.
const CHECKSUM: &str = "# checksum ";

/// Fingerprint of this program: what another build computed may be something else.
pub fn build() -> &'static str {
    static BUILD: OnceLock<String> = OnceLock::new();
    BUILD.get_or_init(|| {
        let bytes = std::env::current_exe().and_then(std::fs::read).unwrap_or_default();
        format!("{:016x}", fingerprint(&bytes))
    })
}

/// The text of a result. Its last line is the checksum of all before it.
pub fn text(run: &PlannedRun, row: &Row) -> String {
    let quoted = |text: &str| Value::String(text.to_string()).to_string();
    let mut text =
        String::from("# A run of a study. The last line is the checksum (FNV-1a, 64 bits) of what stands before it.\n");
    let head = [
        ("key", run.key.as_str()),
        ("build", build()),
        ("what", &run.what),
        ("ended", &row.ended),
        ("trusted", &row.trusted),
    ];
    for (name, value) in head {
        let _ = writeln!(text, "{name} = {}", quoted(value));
    }
    text += "\n[numbers]\n";
    for (quantity, value) in QUANTITIES.iter().zip(&row.values).filter(|(_, value)| !value.is_empty()) {
        let _ = writeln!(text, "{} = {}", quantity.name, quoted(value));
    }
    let sum = fingerprint(text.as_bytes());
    text + &format!("{CHECKSUM}{sum:016x}\n")
}

/// The row that a text holds, if it is that of this run and of this build, and whole.
///
/// # Errors
/// In words, what is wrong with it.
pub fn read(run: &PlannedRun, text: &str) -> Result<Row, String> {
    let (body, sum) = text.rsplit_once(CHECKSUM).ok_or("it has no checksum")?;
    if format!("{:016x}\n", fingerprint(body.as_bytes())) != sum {
        return Err("its checksum is not that of its text".into());
    }
    let table: Table = body.parse().map_err(|_| "it is not TOML")?;
    let word = |name: &str| table.get(name).and_then(Value::as_str).ok_or(format!("it has no `{name}`"));
    if word("key")? != run.key || word("build")? != build() {
        return Err("it is of another run or of another build of the program".into());
    }
    let numbers = table.get("numbers").and_then(Value::as_table).ok_or("it has no numbers")?;
    let mut row = Row {
        ended: word("ended")?.into(),
        trusted: word("trusted")?.into(),
        values: vec![String::new(); QUANTITIES.len()],
    };
    for (name, value) in numbers {
        let place = QUANTITIES.iter().position(|q| q.name == name).ok_or(format!("`{name}` is no quantity"))?;
        let number = value.as_str().filter(|text| text.parse::<f64>().is_ok_and(f64::is_finite));
        row.values[place] = number.ok_or(format!("`{name}` is no number"))?.into();
    }
    Ok(row)
}
