//! The numbers of the pages, side by side.

use super::super::baseline::{CASE_CELLS, CELLS};
use super::super::compare;
use super::super::judge::{Basis, Reading};
use super::{FIGURES, Line};
use crate::Failure;
use crate::case_run::CaseRun;
use crate::data::{self, Datum};
use checkdam_verification::report::{number, quoted};

/// Table of all rows of all pages.
pub const ROWS: &str = "flume_pages";
/// Table of the speeds in the camera's window.
pub const WINDOW: &str = "flume_pages_window";

/// Both tables.
///
/// # Errors
/// A record is not as it should be.
pub fn tables(flumes: &[CaseRun]) -> Result<Vec<(String, String)>, Failure> {
    let basis = Basis::read()?;
    let mut text = String::from(
        "figure,case,quantity,unit,measured,measured_half_width,authors,authors_half_width,authors_kind,\
         ours_20mm,ours_10mm,ours_5mm,one_run_2.5mm,deviation_10mm,order,index_10mm_percent,u_num,\
         least,least_with,greatest,greatest_with,calibrated,verdict_measured,two_u_val_measured,verdict_authors,two_u_val_authors,verdict_calibrated\n",
    );
    for figure in &FIGURES {
        for flume in flumes {
            for line in figure.lines() {
                let cells = row(&basis, flume.name, line).join(",");
                text += &format!("{},{},{},{},{cells}\n", figure.number, flume.name, quoted(&line.quantity), line.unit);
            }
        }
    }
    Ok(vec![(ROWS.into(), text), (WINDOW.into(), window(flumes))])
}

/// A number, or an empty cell.
fn cell(x: f64) -> String {
    if x.is_finite() { number(x) } else { String::new() }
}

fn row(basis: &Basis, case: &str, line: &Line) -> Vec<String> {
    let stated: Vec<Datum> = (data::rows(compare::PUBLISHED).into_iter())
        .filter(|d| line.stated.contains(&d.id) && [case, "unstated"].contains(&d.case.as_str()))
        .collect();
    // One of which the paper does not say which it is stands in both columns.
    let measured = stated.iter().find(|d| d.kind.ends_with("measured"));
    let authors = stated.iter().find(|d| d.kind != "measured");
    let two = |d: Option<&Datum>| [d.map_or(f64::NAN, |d| d.value), d.map_or(f64::NAN, |d| d.uncertainty)].map(cell);
    let numerical = basis.numerical(case, &line.of);
    let ours = numerical.scatter;
    debug_assert_eq!(ours.len(), CELLS.len());
    let index = 100.0 * numerical.order.index[0];
    let ends = ends(basis, case, line, ours[CASE_CELLS].mean);
    let judged = |reading: Reading, d: Option<&Datum>| {
        let judged = d.filter(|d| d.kind != "theory").map(|d| basis.judge(reading, case, d, &line.of));
        judged.map_or([String::new(), String::new()], |j| [j.said.to_string(), cell(2.0 * j.uncertainty.validation())])
    };
    let mut cells: Vec<String> = two(measured).into_iter().chain(two(authors)).collect();
    cells.push(authors.map_or_else(String::new, |d| d.kind.clone()));
    cells.extend(ours.map(|s| cell(s.mean)));
    cells.push(cell(basis.finest(case, &line.of)));
    cells.extend([ours[CASE_CELLS].deviation, numerical.order.order, index, numerical.uncertainty()].map(cell));
    cells.extend(ends.into_iter().flat_map(|(value, with)| [cell(value), quoted(&with)]));
    cells.push(cell(basis.calibrated(case, &line.of)));
    cells.extend([measured, authors].into_iter().flat_map(|d| judged(Reading::Literal, d)));
    cells.extend(judged(Reading::Calibrated, authors.or(measured)).into_iter().take(1));
    cells
}

/// Least and greatest of the runs with one unstated input changed, and with what; the literal reading among them.
fn ends(basis: &Basis, case: &str, line: &Line, literal: f64) -> [(f64, String); 2] {
    let changed = basis.open(case).map(|r| (r.value(&line.of), format!("{}: {}", r.factor, r.label)));
    let all: Vec<(f64, String)> =
        changed.chain([(literal, "literal reading".to_string())]).filter(|c| c.0.is_finite()).collect();
    let end = |sign: f64| all.iter().min_by(|a, b| (sign * a.0).total_cmp(&(sign * b.0))).cloned();
    [1.0, -1.0].map(|sign| end(sign).unwrap_or((f64::NAN, String::new())))
}

/// Speeds in the camera's window at the instants of the paper, on both clocks: 95th percentile and mean over the material.
fn window(flumes: &[CaseRun]) -> String {
    let mut text =
        String::from("case,quantity,kind,published,half_width,clock,time_s,speed_p95_m_per_s,speed_mean_m_per_s\n");
    for flume in flumes {
        let own = data::rows(compare::PUBLISHED).into_iter().filter(|d| d.case == flume.name);
        for datum in own.filter(|d| d.quantity.starts_with("largest velocity at ")) {
            let instant = datum.quantity.split_whitespace().find_map(|word| word.parse::<f64>().ok());
            let Some(instant) = instant else { continue };
            for (clock, zero) in [("front at the barrier", flume.get("arrival_s")), ("gate opens", 0.0)] {
                let row = flume.records.history.iter().find(|r| r.time >= zero + instant);
                let speeds = row.map_or([f64::NAN; 2], |r| [r.window.p95, r.window.mean]).map(cell);
                let numbers = [datum.value, datum.uncertainty].map(number).join(",");
                let (name, quantity, kind) = (flume.name, quoted(&datum.quantity), &datum.kind);
                let time = number((1000.0 * (zero + instant)).round() / 1000.0);
                text += &format!("{name},{quantity},{kind},{numbers},{clock},{time},{}\n", speeds.join(","));
            }
        }
    }
    text
}
