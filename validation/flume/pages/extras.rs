//! What stands on single pages: speeds in the window, closed forms, and what nothing of ours stands beside.

use super::super::compare;
use super::digits::{published, three};
use super::{Figure, LINES};
use crate::data;
use checkdam::output::{OutputError, Table};

/// Speeds in the camera's window.
pub fn speeds(window: &Table) -> Result<String, OutputError> {
    let mut text = String::from(
        "## Speed in the camera's window, the last half metre before the barrier\n\n\
         | | quantity | measured | the authors' computation | ours, 0 s: the front meets the barrier | ours, 0 s: the gate opens |\n\
         |---|---|---|---|---|---|\n",
    );
    let (cases, quantities, kinds) = (window.cells("case")?, window.cells("quantity")?, window.cells("kind")?);
    let (values, widths) = (window.column("published")?, window.column("half_width")?);
    let (fast, times) = (window.column("speed_p95_m_per_s")?, window.column("time_s")?);
    // Two rows a number: one a clock.
    for k in (0..window.rows().saturating_sub(1)).step_by(2) {
        let stated = published(values[k], widths[k], "");
        let (measured, authors) = match kinds[k] == "measured" {
            true => (stated, three(f64::NAN)),
            false => (three(f64::NAN), stated),
        };
        let ours = [k, k + 1].map(|j| format!("{} (at {} s)", three(fast[j]), three(times[j])));
        let [angle, quantity] = [cases[k].replace("deg", "\u{b0}"), format!("{}, m/s", quantities[k])];
        text += &format!("| {angle} | {quantity} | {measured} | {authors} | {} | {} |\n", ours[0], ours[1]);
    }
    Ok(text
        + "\nOurs is the speed that 95 % of the material in the window stays below, in one run; times in brackets count from the opening \
           of the gate. The paper's clock starts \"when the flow just approaches the barrier\". Not judged: no scatter of ours is on record.\n\n")
}

/// Forces that are drawn as lines and bands.
pub fn closed_forms(references: &[(&str, Table)]) -> Result<String, OutputError> {
    let mut text = String::from("## Lines and bands of the figure\n\n| | force | N |\n|---|---|---|\n");
    for (case, table) in references {
        let (values, widths) = (table.column("value_n")?, table.column("half_width_n")?);
        for (label, (value, width)) in table.cells("label")?.iter().zip(values.iter().zip(widths)) {
            let band = if *width > 0.0 { format!(" \u{b1} {}", three(*width)) } else { String::new() };
            text += &format!("| {} | {label} | {}{band} |\n", case.replace("deg", "\u{b0}"), three(*value));
        }
    }
    Ok(text + "\n")
}

/// What the paper says of the figure and nothing of ours stands beside.
pub fn not_compared(figure: &Figure) -> String {
    let shown = |id: &String| LINES.iter().any(|l| l.stated.contains(id));
    let of_it = |place: &str| {
        let last = place.rsplit("Fig. ").next().unwrap_or_default();
        place.contains("Fig. ") && last.trim_end_matches(char::is_alphabetic) == figure.number
    };
    let rest = (data::rows(compare::PUBLISHED).into_iter())
        .filter(|d| of_it(&d.place) && !shown(&d.id) && !d.quantity.starts_with("largest velocity at "));
    let lines: Vec<String> = rest
        .map(|d| {
            let unit = if d.unit == "1" { String::new() } else { format!(" {}", d.unit) };
            let note = if d.note.is_empty() { String::new() } else { format!("; {}", d.note) };
            let value = published(d.value, d.uncertainty, "");
            format!("- {}, {}: {value}{unit} ({}){note}.\n", d.case.replace("deg", "\u{b0}"), d.quantity, d.kind)
        })
        .collect();
    if lines.is_empty() {
        return String::new();
    }
    format!("## Stated, and nothing of ours beside it\n\n{}", lines.concat())
}
