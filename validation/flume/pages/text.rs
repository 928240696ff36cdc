//! The pages, as Markdown, from the tables.

use super::super::CASES;
use super::digits::{published, three, two};
use super::extras::{closed_forms, not_compared, speeds};
use super::table::{ROWS, WINDOW};
use super::{FIGURES, Figure};
use checkdam::output::{OutputError, Table, write_text};
use std::path::Path;

/// First words of the verdicts.
const VERDICTS: [&str; 3] = ["agrees", "not resolved", "disagrees"];

/// Writes the pages into the folder of their tables and figures; their names.
///
/// # Errors
/// A table that is not there, or a page that cannot be written.
pub fn write(folder: &Path) -> Result<Vec<String>, OutputError> {
    let load = |stem: &str| Table::load(folder.join(format!("{stem}.csv")));
    let (rows, window) = (load(ROWS)?, load(WINDOW)?);
    let references = CASES.map(|(case, _)| Ok((case, load(&format!("flume_{case}_references"))?)));
    let references = references.into_iter().collect::<Result<Vec<_>, OutputError>>()?;
    let mut names = Vec::new();
    for figure in &FIGURES {
        let mut page = head(figure);
        page += &summary(&rows, figure)?;
        page += &main_table(&rows, figure)?;
        page += &grids(&rows, figure)?;
        if figure.number == "2" {
            page += &speeds(&window)?;
        }
        if figure.number == "4" {
            page += &closed_forms(&references)?;
        }
        page += &not_compared(figure);
        let name = format!("{}.md", figure.stem());
        write_text(folder.join(&name), &page)?;
        names.push(name);
    }
    Ok(names)
}

/// "40 degrees".
fn angle(case: &str) -> String {
    format!("{} degrees", case.trim_end_matches("deg"))
}

/// Title, the way to the other pages, figures at both angles, what they show.
fn head(figure: &Figure) -> String {
    let mut text = format!("# Fig. {}: {}\n\n", figure.number, figure.title);
    let others = FIGURES.iter().map(|f| match f.number == figure.number {
        true => format!("**Fig. {}**", f.number),
        false => format!("[Fig. {}]({}.md)", f.number, f.stem()),
    });
    text += &format!("{} of the paper. {}\n\n", others.collect::<Vec<_>>().join(" \u{b7} "), figure.shows);
    for (case, _) in CASES {
        text += &format!("## {}\n\n", angle(case));
        for (stem, what) in figure.drawn {
            text += &format!("![{}: {what}](flume_{case}_{stem}.svg)\n\n", angle(case));
        }
    }
    text
}

/// Rows of a figure and case.
fn own(rows: &Table, figure: &Figure, case: &str) -> Result<Vec<usize>, OutputError> {
    let (figures, cases) = (rows.cells("figure")?, rows.cells("case")?);
    Ok((0..rows.rows()).filter(|&k| figures[k] == figure.number && cases[k] == case).collect())
}

/// What the verdicts of the literal reading add up to.
fn summary(rows: &Table, figure: &Figure) -> Result<String, OutputError> {
    let mut text = String::from("## In short\n\n");
    let (names, units, ours) = (rows.cells("quantity")?, rows.cells("unit")?, rows.column("ours_10mm")?);
    for (case, _) in CASES {
        let mut parts = Vec::new();
        for word in VERDICTS {
            let mut said = Vec::new();
            for k in own(rows, figure, case)? {
                let unit = if units[k] == "1" { String::new() } else { format!(" {}", units[k]) };
                for (column, verdict) in [("measured", "verdict_measured"), ("authors", "verdict_authors")] {
                    let numbers = format!("{} for {}{unit}", three(ours[k]), three(rows.column(column)?[k]));
                    let words = format!("{}, {numbers}", names[k]);
                    if rows.cells(verdict)?[k].starts_with(word) && !said.contains(&words) {
                        said.push(words);
                    }
                }
            }
            if !said.is_empty() {
                parts.push(format!("*{word}*: {}", said.join("; ")));
            }
        }
        text += &match parts.is_empty() {
            true => format!("- At {} the paper states nothing that could be judged.\n", angle(case)),
            false => format!("- At {}, ours for the paper's: {}.\n", angle(case), parts.join(". ")),
        };
    }
    Ok(text + "\n")
}

/// The first words of a verdict; what disagrees stands out.
fn short(verdict: &str) -> String {
    let word = VERDICTS.into_iter().find(|w| verdict.starts_with(w)).unwrap_or("\u{2013}");
    if word == "disagrees" { "**disagrees**".into() } else { word.into() }
}

fn main_table(rows: &Table, figure: &Figure) -> Result<String, OutputError> {
    let mut text = String::from(
        "## The numbers\n\n\
         | | quantity | measured | the authors' computation | ours | numerical error | unstated inputs: from, to | calibrated | verdict |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    let number = |column: &str, k: usize| -> Result<f64, OutputError> { Ok(rows.column(column)?[k]) };
    let word = |column: &str, k: usize| -> Result<String, OutputError> { Ok(rows.cells(column)?[k].clone()) };
    for (case, _) in CASES {
        for k in own(rows, figure, case)? {
            let kind = word("authors_kind", k)?;
            let both = if kind.ends_with("or measured") { kind.as_str() } else { "" };
            let unit = word("unit", k)?;
            let unit = if unit == "1" { String::new() } else { format!(", {unit}") };
            let verdict = |of: &str| -> Result<String, OutputError> {
                let (said, wide) = (short(&word(&format!("verdict_{of}"), k)?), number(&format!("two_u_val_{of}"), k)?);
                Ok(if wide.is_finite() { format!("{said} (\u{b1} {})", two(wide)) } else { String::new() })
            };
            let verdict = match [verdict("measured")?, verdict("authors")?] {
                [a, b] if a.is_empty() && b.is_empty() => three(f64::NAN),
                [a, b] if a.is_empty() || a == b => b,
                [a, b] if b.is_empty() => a,
                [a, b] => format!("measured: {a}; authors': {b}"),
            };
            let calibrated = match short(&word("verdict_calibrated", k)?) {
                dash if dash == "\u{2013}" => three(number("calibrated", k)?),
                said => format!("{} ({said})", three(number("calibrated", k)?)),
            };
            let cells = [
                case.replace("deg", "\u{b0}"),
                word("quantity", k)? + &unit,
                published(number("measured", k)?, number("measured_half_width", k)?, both),
                published(number("authors", k)?, number("authors_half_width", k)?, &kind),
                three(number("ours_10mm", k)?),
                format!("\u{b1} {}", two(number("u_num", k)?)),
                format!(
                    "{} ({}), {} ({})",
                    three(number("least", k)?),
                    word("least_with", k)?,
                    three(number("greatest", k)?),
                    word("greatest_with", k)?
                ),
                calibrated,
                verdict,
            ];
            text += &format!("| {} |\n", cells.join(" | "));
        }
    }
    Ok(text
        + "\n\
- *Measured*, *the authors' computation*: as the paper states them, with the half width of the interval in which the number lies by what\n  \
  it says; sentence by sentence in `validation/flume/published.csv`.\n\
- *Ours*: the release read literally (gate gone at once, no side walls), cells of 10 mm, mean of nine runs on moved grids and with other\n  \
  packings.\n\
- *Numerical error*: standard uncertainty of one run, from its scatter and from the distance to cells of no size (next table).\n\
- *Unstated inputs*: least and greatest of the runs that come to rest when one thing that the paper leaves open is changed, and which; single\n  \
  runs, each with the scatter of one.\n\
- *Calibrated*: the set of open inputs that fits both angles best, frozen; its verdict in brackets, without input uncertainty.\n\
- *Verdict* on the literal reading (ASME V&V 20): *agrees* within two standard uncertainties of numerics and data; *not resolved* within\n  \
  two of these and of the unstated inputs together, which stand in brackets; **disagrees** beyond. Agreement within a large share of\n  \
  the number says little. Numbers: [`flume_pages.csv`](flume_pages.csv).\n\n")
}

/// Where the numerical error comes from.
fn grids(rows: &Table, figure: &Figure) -> Result<String, OutputError> {
    let mut text = String::from(
        "## Our numerical error\n\n\
         | | quantity | 20 mm | 10 mm | 5 mm | 2.5 mm, one run | observed order | grid convergence index, 10 mm | scatter of one run, 10 mm |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    let names = rows.cells("quantity")?;
    for (case, _) in CASES {
        for k in own(rows, figure, case)? {
            let number = |column: &str| -> Result<f64, OutputError> { Ok(rows.column(column)?[k]) };
            let index = number("index_10mm_percent")?;
            let cells = [
                case.replace("deg", "\u{b0}"),
                names[k].clone(),
                three(number("ours_20mm")?),
                three(number("ours_10mm")?),
                three(number("ours_5mm")?),
                three(number("one_run_2.5mm")?),
                if index.is_finite() { two(number("order")?) } else { "none".into() },
                if index.is_finite() { format!("{} %", two(index)) } else { "\u{2013}".into() },
                two(number("deviation_10mm")?),
            ];
            text += &format!("| {} |\n", cells.join(" | "));
        }
    }
    Ok(text
        + "\nMeans of nine runs, and one run at 2.5 mm, whose scatter is not known. Where the means have no order of a half or more, half of their range stands for the error of the grid; an order \
           beyond two is more than the scheme has, and comes from the scatter of the means. Tables: \
           [`flume_baseline_grids.csv`](flume_baseline_grids.csv), [`flume_baseline_scatter.csv`](flume_baseline_scatter.csv).\n\n")
}
