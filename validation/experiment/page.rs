//! The page of an experiment, as Markdown, from its table of comparisons.

use super::Experiment;
use checkdam::check::significant;
use checkdam::output::{OutputError, Table};
use std::path::Path;

/// The page.
///
/// # Errors
/// The comparison cannot be read.
pub fn text(experiment: &Experiment, comparison: &Path) -> Result<String, OutputError> {
    let table = Table::load(comparison)?;
    let name = &experiment.name;
    let words = table.cells("word")?;
    let ended = Table::load(comparison.with_file_name(format!("{name}_runs.csv")))?.cells("ended")?;
    let at_rest = ended.iter().filter(|e| *e == "at rest").count();
    let count = |word: &str| words.iter().filter(|w| *w == word).count();
    let mut text = format!("# {}\n\n", experiment.title);
    text += &format!(
        "{} runs, of which {} were at rest at their end; of {} published numbers that ours stands beside, {} agree, {} are not \
         resolved, {} disagree.\n\n",
        experiment.runs(),
        at_rest,
        table.rows(),
        count("agrees"),
        count("not resolved"),
        count("disagrees")
    );
    text += &format!("![published and computed]({name}_plot.svg)\n\n");
    text += "| | case | quantity | published | ours | difference | numerical | inputs | verdict |\n|---|---|---|---|---|---|---|---|---|\n";
    let [ids, cases, quantities, units, kinds, largest] =
        ["id", "case", "quantity", "unit", "kind", "largest_input"].map(|c| table.cells(c));
    let (ids, cases, quantities, units, kinds) = (ids?, cases?, quantities?, units?, kinds?);
    let largest = largest?;
    let number = |column: &str, k: usize| -> Result<f64, OutputError> { Ok(table.column(column)?[k]) };
    for k in 0..table.rows() {
        let unit = if units[k] == "1" { String::new() } else { format!(", {}", units[k]) };
        let kind = if kinds[k] == "measured" { String::new() } else { format!(" ({})", kinds[k]) };
        let percent = number("error_percent", k)?;
        let percent = if percent.is_finite() { format!(" ({percent:+.1} %)") } else { String::new() };
        let input = match largest[k].as_str() {
            "" => "\u{2013}".to_string(),
            input => format!("\u{b1} {} ({input})", short(number("u_input", k)?, 2)),
        };
        let word = if words[k] == "disagrees" { "**disagrees**" } else { &words[k] };
        let cells = [
            ids[k].clone(),
            cases[k].clone(),
            quantities[k].clone() + &unit,
            format!("{} \u{b1} {}{kind}", short(number("published", k)?, 3), short(number("half_width", k)?, 2)),
            short(number("ours", k)?, 3),
            short(number("error", k)?, 2) + &percent,
            format!("\u{b1} {}", short(number("u_num", k)?, 2)),
            input,
            format!("{word} (\u{b1} {})", short(2.0 * number("u_val", k)?, 2)),
        ];
        text += &format!("| {} |\n", cells.join(" | "));
    }
    text += &format!(
        "\n\
- *Published*: with the half width of the interval in which the number lies.\n\
- *Ours*: the mean on the finest grid that was run; run by run in [`{name}_runs.csv`]({name}_runs.csv).\n\
- *Numerical*: standard uncertainty, from the distance to cells of no size where grids were run, and from repetitions where there are some.\n\
- *Inputs*: standard uncertainty, from inputs changed one at a time, and the one with the largest share.\n\
- *Verdict* (ASME V&V 20): *agrees* within two standard uncertainties of numerics and data; *not resolved* within two of these and of the\n  \
  inputs together, which stand in brackets; **disagrees** beyond. All numbers: [`{name}_comparison.csv`]({name}_comparison.csv).\n\n"
    );
    text += "## Where the numbers are from\n\n";
    let mut sources: Vec<(String, Vec<&str>)> = Vec::new();
    for row in &experiment.rows {
        let source = format!("{}: {}", row.datum.place, row.datum.how);
        match sources.iter_mut().find(|s| s.0 == source) {
            Some(known) => known.1.push(&row.datum.id),
            None => sources.push((source, vec![&row.datum.id])),
        }
    }
    text.extend(sources.iter().map(|(source, ids)| format!("- {}: {source}.\n", ids.join(", "))));
    let rest: Vec<_> = experiment.rows.iter().map(|r| (&r.datum, r.number.is_none())).filter(|r| r.1).collect();
    if !rest.is_empty() {
        text += "\n## Stated, and nothing of ours beside it\n\n";
    }
    for (d, _) in rest {
        let unit = if d.unit == "1" { String::new() } else { format!(" {}", d.unit) };
        let note = if d.note.is_empty() { String::new() } else { format!("; {}", d.note) };
        let value = format!("{} \u{b1} {}{unit}", short(d.value, 3), short(d.uncertainty, 2));
        text += &format!("- {}, {}, {}: {value} ({}){note}.\n", d.id, d.case, d.quantity, d.kind);
    }
    Ok(text)
}

/// A few digits; a dash where there is no number.
fn short(x: f64, digits: usize) -> String {
    if x.is_finite() { significant(x, digits) } else { "\u{2013}".into() }
}
