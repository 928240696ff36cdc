//! Rows of a table of runs.

use crate::counterpart::Counterpart;
use checkdam::output::{OutputError, Table};
use checkdam::study::quantities::QUANTITIES;
use std::collections::BTreeMap;

/// A row: one run of a study.
#[derive(Debug, Clone)]
pub struct Run {
    /// Case.
    pub case: String,
    /// What was varied.
    pub factor: String,
    /// To what.
    pub label: String,
    /// Which repetition.
    pub replicate: String,
    /// How it ended.
    pub ended: String,
    /// Values of what varied, by column.
    pub set: BTreeMap<String, String>,
    numbers: BTreeMap<&'static str, f64>,
}

impl Run {
    /// A quantity; NaN where the run has none.
    pub fn get(&self, quantity: &str) -> f64 {
        self.numbers.get(quantity).copied().unwrap_or(f64::NAN)
    }

    /// What stands beside a published number.
    pub fn value(&self, of: &Counterpart) -> f64 {
        of.of(&|quantity| self.get(quantity))
    }
}

/// All rows of a table, with these columns of what varied.
///
/// # Errors
/// A column is missing.
pub fn rows(table: &Table, columns: &[&str]) -> Result<Vec<Run>, OutputError> {
    let texts = |name: &str| table.cells(name);
    let (cases, factors, labels) = (texts("case")?, texts("factor")?, texts("label")?);
    let (replicates, ended) = (texts("replicate")?, texts("ended")?);
    let sets = columns.iter().map(|c| Ok((*c, texts(c)?))).collect::<Result<Vec<_>, OutputError>>()?;
    let known = QUANTITIES.iter().filter(|q| table.names().iter().any(|name| name == q.name));
    let numbers = known.map(|q| Ok((q.name, table.column(q.name)?))).collect::<Result<Vec<_>, OutputError>>()?;
    let run = |k: usize| Run {
        case: cases[k].clone(),
        factor: factors[k].clone(),
        label: labels[k].clone(),
        replicate: replicates[k].clone(),
        ended: ended[k].clone(),
        set: sets.iter().map(|(c, cells)| (c.to_string(), cells[k].clone())).collect(),
        numbers: numbers.iter().map(|(q, values)| (*q, values[k])).collect(),
    };
    Ok((0..table.rows()).map(run).collect())
}

#[cfg(test)]
impl Run {
    /// A run at rest with these quantities.
    pub fn with(case: &str, factor: &str, label: &str, numbers: &[(&'static str, f64)]) -> Self {
        let text = str::to_string;
        Self {
            case: text(case),
            factor: text(factor),
            label: text(label),
            replicate: text("0"),
            ended: text("at rest"),
            set: BTreeMap::new(),
            numbers: numbers.iter().copied().collect(),
        }
    }
}
