//! The curves of the page: columns of the tables over time, thinned where there are many rows.

use super::design::barriers;
use super::number::{Kind, Numbers};
use checkdam::check::significant;
use checkdam::output::Table;
use serde_json::{Value, json};

/// Rows of a table that are drawn at most, shared by the barriers.
const ROWS: usize = 3000;
/// Digits of the values.
const DIGITS: usize = 6;

/// A chart: a title, what it measures, its table, its columns with what to call them.
struct Chart {
    title: String,
    kind: Kind,
    file: String,
    columns: Vec<(String, String)>,
}

/// The charts of a run as the page needs them.
pub fn charts(numbers: &Numbers) -> Value {
    let several = barriers(numbers).len() > 1;
    let mut charts = Vec::new();
    for barrier in barriers(numbers) {
        let of = if several { format!(" on \u{201c}{}\u{201d}", barrier.name) } else { String::new() };
        of_barrier(&of, &barrier.suffix, &mut charts);
    }
    if barriers(numbers).is_empty() {
        of_flow(&mut charts);
    }
    of_energy(numbers, &mut charts);
    let others = ["base_", "window_"];
    for (name, table) in numbers.tables().iter().filter(|(name, _)| others.iter().any(|start| name.starts_with(start)))
    {
        let columns =
            table.names().iter().filter(|column| *column != "time_s").map(|column| (column.clone(), column.clone()));
        let kind = if name.starts_with("base_") { Kind::Force } else { Kind::Velocity };
        charts.push(Chart {
            title: name.trim_end_matches(".csv").replace('_', " "),
            kind,
            file: name.clone(),
            columns: columns.collect(),
        });
    }
    let rows = ROWS / barriers(numbers).len().max(1);
    json!(charts.iter().filter_map(|chart| draw(numbers, chart, rows)).collect::<Vec<_>>())
}

fn chart(title: impl Into<String>, kind: Kind, file: &str, columns: &[(&str, &str)]) -> Chart {
    let columns = columns.iter().map(|(column, label)| ((*column).to_owned(), (*label).to_owned())).collect();
    Chart { title: title.into(), kind, file: file.to_owned(), columns }
}

fn of_barrier(of: &str, suffix: &str, charts: &mut Vec<Chart>) {
    let history = format!("history{suffix}.csv");
    let history = history.as_str();
    charts.push(chart(
        format!("Normal force{of}"),
        Kind::Force,
        history,
        &[
            ("force_normal_n", "mean of the sample"),
            ("force_normal_max_n", "largest step in it"),
            ("force_layer2_n", "from the stress of two layers"),
        ],
    ));
    charts.push(chart(
        format!("Overturning moment{of}"),
        Kind::Moment,
        history,
        &[("overturning_moment_n_m", "about the foot")],
    ));
    charts.push(chart(
        format!("Force along the face{of}"),
        Kind::Force,
        history,
        &[("force_tangential_n", "towards the crest")],
    ));
    let bends = format!("barrier{suffix}.csv");
    charts.push(chart(
        format!("Forces of the structure{of}"),
        Kind::Force,
        &bends,
        &[
            ("contact_normal_n", "contact with the flow"),
            ("clamp_normal_n", "clamp"),
            ("inertia_normal_n", "rate of momentum"),
        ],
    ));
    charts.push(chart(
        format!("Deflection{of}"),
        Kind::Length,
        &bends,
        &[("tip_deflection_m", "tip"), ("largest_deflection_m", "largest of the face")],
    ));
    charts.push(chart(
        format!("Run-up{of}"),
        Kind::Length,
        history,
        &[("run_up_p95_m", "95 % of the points at the face"), ("run_up_m", "highest point")],
    ));
    charts.push(chart(
        format!("Mass that passed{of}"),
        Kind::Mass,
        history,
        &[("overtopped_kg", "over the crest"), ("passed_under_kg", "under"), ("passed_kg", "on whatever way")],
    ));
    if suffix.is_empty() {
        of_flow(charts);
    }
}

fn of_flow(charts: &mut Vec<Chart>) {
    let history = "history.csv";
    charts.push(chart("Velocity of the front", Kind::Velocity, history, &[("front_velocity_m_per_s", "front")]));
    charts.push(chart("Depth of the front", Kind::Length, history, &[("front_depth_m", "front")]));
    charts.push(chart(
        "Forces of the first base on the material",
        Kind::Force,
        history,
        &[("base_normal_n", "normal"), ("base_friction_n", "friction, where the flow runs")],
    ));
}

/// Energies by what they are; those that are zero all the time are left out.
fn of_energy(numbers: &Numbers, charts: &mut Vec<Chart>) {
    let Some(table) = numbers.tables().get("energy.csv") else { return };
    let moves = |name: &&String| {
        table.column(name).is_ok_and(|values| values.iter().any(|value| *value != 0.0 && value.is_finite()))
    };
    let names = table.names().iter().filter(|name| name.ends_with("_j")).filter(moves);
    let columns = names.map(|name| (name.clone(), name.trim_end_matches("_j").replace('_', " "))).collect();
    charts.push(Chart { title: "Energy".into(), kind: Kind::Energy, file: "energy.csv".into(), columns });
}

/// A chart with its data; none if the table or all of its columns are not there, or nothing in them is other than zero.
fn draw(numbers: &Numbers, chart: &Chart, most: usize) -> Option<Value> {
    let table = numbers.tables().get(&chart.file).filter(|table| table.rows() > 1)?;
    let there: Vec<(&[f64], &(String, String))> =
        chart.columns.iter().filter_map(|c| Some((table.column(&c.0).ok()?, c))).collect();
    let largest = there
        .iter()
        .flat_map(|(values, _)| *values)
        .copied()
        .filter(|v| v.is_finite())
        .map(f64::abs)
        .fold(0.0, f64::max);
    if largest == 0.0 {
        return None;
    }
    let (unit, size) = chart.kind.unit(largest);
    let rows = thinned(table, there[0].0, most);
    let text = |value: f64| significant(value, DIGITS).parse::<f64>().ok().filter(|value| value.is_finite());
    let column = |values: &[f64], size: f64| rows.iter().map(|k| text(values[*k] / size)).collect::<Vec<_>>();
    let series = there
        .iter()
        .map(|(values, (name, label))| json!({"column": name, "label": label, "values": column(values, size)}));
    Some(json!({
        "title": chart.title, "unit": unit, "file": chart.file, "of": table.rows(),
        "time": column(table.column("time_s").ok()?, 1.0), "series": series.collect::<Vec<_>>(),
    }))
}

/// The rows that are drawn: all, or of each interval the rows in which `values` are least and largest, with the first and the last row.
fn thinned(table: &Table, values: &[f64], most: usize) -> Vec<usize> {
    let count = table.rows();
    if count <= most {
        return (0..count).collect();
    }
    let parts = (most / 2).saturating_sub(1).max(1);
    let mut rows = vec![0, count - 1];
    for part in 0..parts {
        let range = part * count / parts..(part + 1) * count / parts;
        rows.extend(range.clone().max_by(|a, b| values[*a].total_cmp(&values[*b])));
        rows.extend(range.min_by(|a, b| values[*a].total_cmp(&values[*b])));
    }
    rows.sort_unstable();
    rows.dedup();
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_rows_are_all_drawn_and_of_many_the_extremes_stay() {
        let table = |count: usize| {
            let row = |k: usize| format!("{k},{}\n", if k == count / 3 { 900.0 } else { (k % 7) as f64 });
            let text = format!("time_s,f_n\n{}", (0..count).map(row).collect::<String>());
            Table::parse(&text, "history.csv").expect("a table")
        };
        let few = table(100);
        assert_eq!(thinned(&few, few.column("f_n").expect("f"), ROWS).len(), 100);
        let many = table(50_000);
        let rows = thinned(&many, many.column("f_n").expect("f"), ROWS);
        assert!(rows.len() <= ROWS && rows.len() > ROWS / 2, "{}", rows.len());
        assert!(rows.contains(&(50_000 / 3)) && rows[0] == 0 && rows.last() == Some(&49_999));
        assert!(rows.windows(2).all(|pair| pair[0] < pair[1]));
    }
}
