//! Ours beside the published numbers, with the uncertainty of both.

use super::{CELLS, Experiment, Ran};
use crate::data::Datum;
use crate::scatter::Scatter;
use crate::verdict::{Uncertainty, Verdict, even, of_grids, of_inputs};
use checkdam::theory::order::Study as Order;
use checkdam_verification::report::{number, quoted};

/// What leaves a number unresolved.
const NOT_RESOLVED: &str = "not resolved: the inputs that were varied do not determine this number";

/// A published number with ours beside it.
pub struct Compared<'a> {
    pub datum: &'a Datum,
    /// Mean on the finest grid.
    pub ours: f64,
    pub uncertainty: Uncertainty,
    /// Means on the grids, cell sizes descending; empty where one was run.
    grids: Vec<f64>,
    /// Deviation of one run on the finest grid; NaN where it was run once.
    scatter: f64,
    /// The input with the largest share; empty where none was varied.
    largest: String,
}

/// All of an experiment that has a counterpart.
pub fn compared<'a>(experiment: &'a Experiment, ran: &[Ran]) -> Vec<Compared<'a>> {
    let rows = experiment.rows.iter().enumerate().filter(|(_, r)| r.number.is_some());
    rows.map(|(k, row)| one(experiment, ran, k, &row.datum)).collect()
}

fn one<'a>(experiment: &'a Experiment, ran: &[Ran], k: usize, datum: &'a Datum) -> Compared<'a> {
    let own = || experiment.plan.iter().zip(ran).filter(|(p, _)| p.case_name == datum.case);
    let mean = |factor: &str, label: &str| {
        let runs = own().filter(|(p, _)| p.factor == factor && p.label == label);
        Scatter::of(runs.map(|(_, r)| r.values[k]))
    };
    let base = mean("base", "");
    // Grids, coarse to fine: each with its repetitions.
    let cell = |values: &[String]| {
        let column = experiment.columns.iter().position(|c| c == CELLS);
        column.and_then(|c| values[c].parse::<f64>().ok())
    };
    let mut cells: Vec<f64> = own().filter(|(p, _)| p.factor == "axis").filter_map(|(p, _)| cell(&p.values)).collect();
    cells.sort_by(|a, b| b.total_cmp(a));
    cells.dedup();
    let grids = cells.iter().map(|h| {
        let on = own().filter(|(p, _)| p.factor == "axis" && cell(&p.values) == Some(*h));
        Scatter::of(on.map(|(_, r)| r.values[k]))
    });
    let grids: Vec<Scatter> = grids.collect();
    let finest = grids.last().copied().unwrap_or(base);
    let means: Vec<f64> = grids.iter().map(|s| s.mean).collect();
    let grid = match (&cells[..], &means[..]) {
        (&[a, b, c], &[x, y, z]) => of_grids(&cells, &means, Order::new([x, y, z], [a, b, c]).order),
        (cells, means) if cells.len() > 1 => of_grids(cells, means, f64::NAN),
        _ => 0.0,
    };
    let scatter = if finest.deviation.is_finite() { finest.deviation } else { 0.0 };
    let mut factors: Vec<&str> = own().map(|(p, _)| p.factor.as_str()).collect();
    factors.retain(|f| !["base", "axis"].contains(f));
    factors.dedup();
    let values = |factor: &str| {
        let mut labels: Vec<&str> = own().filter(|(p, _)| p.factor == factor).map(|(p, _)| p.label.as_str()).collect();
        labels.dedup();
        labels.into_iter().map(|label| mean(factor, label).mean).collect::<Vec<_>>()
    };
    let (input, largest) = of_inputs(base.mean, factors.iter().map(|f| (*f, values(f))));
    Compared {
        datum,
        ours: finest.mean,
        uncertainty: Uncertainty { numerical: grid.hypot(scatter), input, data: even(datum.uncertainty) },
        grids: if means.len() > 1 { means } else { Vec::new() },
        scatter: finest.deviation,
        largest: largest.to_string(),
    }
}

/// The comparison as a table.
pub fn csv(compared: &[Compared]) -> String {
    let mut text = String::from(
        "id,case,quantity,unit,kind,published,half_width,ours,error,error_percent,grids,scatter,u_num,u_input,u_data,u_val,error_over_2_u_val,largest_input,word,verdict\n",
    );
    let cell = |x: f64| if x.is_finite() { number(x) } else { String::new() };
    for c in compared {
        let (datum, u) = (c.datum, &c.uncertainty);
        let error = c.ours - datum.value;
        let verdict = Verdict::of(error, u);
        let head = [&datum.id, &datum.case, &datum.quantity, &datum.unit, &datum.kind].map(|s| quoted(s)).join(",");
        let numbers = [datum.value, datum.uncertainty, c.ours, error, 100.0 * error / datum.value].map(cell).join(",");
        let grids = c.grids.iter().map(|x| cell(*x)).collect::<Vec<_>>().join(" ");
        let over = error.abs() / (2.0 * u.validation());
        let tail = [c.scatter, u.numerical, u.input, u.data, u.validation(), over].map(cell).join(",");
        let said = verdict.sentence(NOT_RESOLVED);
        text += &format!("{head},{numbers},{grids},{tail},{},{},{said}\n", quoted(&c.largest), verdict.word());
    }
    text
}
