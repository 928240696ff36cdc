//! What a user reads of a run: the numbers of its summary, and its tables, row by row.

use checkdam::case::Case;
use checkdam::output::OutputError;
use checkdam::run::records::{EnergyRow, HistoryRow, MomentumRow, Rows};
use checkdam::run::{Experiment, Recorder, Records, RunError, Summary};

/// Rows of tables, and those that numbers with a name come from, where these are not the same.
#[derive(Debug, Default)]
struct Tables {
    rows: Rows,
    kept: Records,
    written: Records,
}

impl Tables {
    fn each(&mut self, add: impl Fn(&mut Records) -> Result<(), OutputError>) -> Result<(), OutputError> {
        if self.rows.are_kept() {
            add(&mut self.kept)?;
        }
        if self.rows.are_written() { add(&mut self.written) } else { Ok(()) }
    }
}

impl Recorder for Tables {
    fn has_tables(&self) -> bool {
        true
    }
    fn turn(&mut self, rows: Rows) {
        self.rows = rows;
    }
    fn history(&mut self, row: &HistoryRow) -> Result<(), OutputError> {
        self.each(|r| r.history(row))
    }
    fn energy(&mut self, row: &EnergyRow) -> Result<(), OutputError> {
        self.each(|r| r.energy(row))
    }
    fn momentum(&mut self, row: &MomentumRow) -> Result<(), OutputError> {
        self.each(|r| r.momentum(row))
    }
    fn structure(&mut self, time: f64, sample: &checkdam::gauge::StructureSample) -> Result<(), OutputError> {
        self.each(|r| r.structure(time, sample))
    }
}

/// A run as it is read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Reading {
    /// `summary.toml`: names with their tables, and numbers.
    pub summary: Vec<(String, f64)>,
    /// The same, with means and peaks taken of the rows of the tables.
    pub by_rows: Vec<(String, f64)>,
    /// Columns of `history.csv`, `energy.csv`, `momentum.csv` and `barrier.csv`; what stands there for each boundary is summed up.
    pub columns: Vec<(String, Vec<f64>)>,
}

impl Reading {
    /// A number of the summary; not a number where there is none.
    pub fn number(&self, name: &str) -> f64 {
        self.summary.iter().find(|q| q.0 == name).map_or(f64::NAN, |q| q.1)
    }

    /// A column of a table; empty where there is none.
    pub fn column(&self, name: &str) -> &[f64] {
        self.columns.iter().find(|c| c.0 == name).map_or(&[], |c| &c.1)
    }
}

/// Runs a case and reads it.
///
/// # Errors
/// What stopped the run.
pub fn run(case: &Case) -> Result<Reading, RunError> {
    let mut tables = Tables::default();
    let mut experiment = Experiment::new(case);
    let end = experiment.run(&mut tables, &mut |_| true)?;
    let read = |records: &Records| numbers(&Summary::new(case, &experiment, records, end).to_toml());
    Ok(Reading { summary: read(&tables.kept), by_rows: read(&tables.written), columns: columns(&tables.written) })
}

/// The numbers of a summary, without those of its case.
fn numbers(text: &str) -> Vec<(String, f64)> {
    let (mut table, mut count, mut found) = (String::new(), 0, Vec::new());
    for line in text.lines().take_while(|l| !l.starts_with("[case")) {
        if let Some(name) = line.strip_prefix("[[").and_then(|l| l.strip_suffix("]]")) {
            count += 1;
            table = format!("{name} {count}: ");
        } else if let Some(name) = line.strip_prefix('[').and_then(|l| l.strip_suffix(']')) {
            table = format!("{name}: ");
        } else if let Some((key, value)) = line.split_once(" = ") {
            let cells = value.trim_matches(['[', ']']).split(", ");
            let of = |text: &str| match text {
                "true" => Some(1.0),
                "false" => Some(0.0),
                _ => text.parse::<f64>().ok(),
            };
            for (k, x) in cells.enumerate().filter_map(|(k, text)| Some((k, of(text)?))) {
                let before = if k > 0 { format!("{k} of ") } else { String::new() };
                found.push((format!("{table}{before}{key}"), x));
            }
        }
    }
    found
}

/// The columns of tables.
fn columns(records: &Records) -> Vec<(String, Vec<f64>)> {
    let history: &[Column<HistoryRow>] = &[
        ("time_s", |r| r.time),
        ("force_normal_n", |r| r.normal),
        ("force_tangential_n", |r| r.tangential),
        ("overturning_moment_n_m", |r| r.moment),
        ("force_normal_max_n", |r| r.normal_max),
        ("force_layer1_n", |r| r.layers[0]),
        ("force_layer2_n", |r| r.layers[1]),
        ("force_layer3_n", |r| r.layers[2]),
        ("base_normal_n", |r| r.base.normal),
        ("base_friction_n", |r| r.base.friction),
        ("front_x_m", |r| r.front.x),
        ("front_edge_x_m", |r| r.front.edge),
        ("front_velocity_m_per_s", |r| r.front.velocity),
        ("front_depth_m", |r| r.front.depth),
        ("run_up_m", |r| r.run_up),
        ("run_up_p95_m", |r| r.run_up_p95),
        ("overtopped_kg", |r| r.passage.over),
        ("passed_kg", |r| r.passage.past),
        ("window_speed_mean_m_per_s", |r| r.window.mean),
        ("window_speed_p95_m_per_s", |r| r.window.p95),
        ("kinetic_j", |r| r.kinetic),
        ("penetration_m", |r| r.penetration),
        ("time_step_s", |r| r.time_step),
    ];
    let energy: &[Column<EnergyRow>] = &[
        ("kinetic_j", |r| r.balance.kinetic),
        ("gravitational_j", |r| r.balance.gravitational),
        ("elastic_j", |r| r.balance.elastic),
        ("plastic_j", |r| r.balance.plastic),
        ("friction_j", |r| r.balance.friction.iter().sum()),
        ("contact_j", |r| r.balance.contact.iter().sum()),
        ("boundaries_j", |r| r.balance.friction.iter().chain(&r.balance.contact).sum()),
        ("pic_j", |r| r.balance.pic),
        ("residual_j", |r| r.balance.residual),
    ];
    let momentum: &[Column<MomentumRow>] = &[
        ("gained_x_n_s", |r| r.gained[0]),
        ("gained_y_n_s", |r| r.gained[1]),
        ("gravity_x_n_s", |r| r.ledger.gravity[0]),
        ("gravity_y_n_s", |r| r.ledger.gravity[1]),
    ];
    type Sample = (f64, checkdam::gauge::StructureSample);
    let barrier: &[Column<Sample>] = &[
        ("clamp_normal_n", |r| r.1.clamp.normal),
        ("clamp_tangential_n", |r| r.1.clamp.tangential),
        ("clamp_moment_n_m", |r| r.1.clamp_moment),
        ("inertia_normal_n", |r| r.1.inertia.normal),
        ("tip_deflection_m", |r| r.1.bend.tip),
        ("tip_velocity_m_per_s", |r| r.1.bend.tip_velocity),
        ("largest_deflection_m", |r| r.1.bend.largest),
        ("gap_cells", |r| r.1.bend.gap),
        ("behind_kg", |r| r.1.survey.behind),
    ];
    let mut all = of_rows("history.csv", history, &records.history);
    all.extend(of_rows("energy.csv", energy, &records.energy));
    all.extend(of_rows("momentum.csv", momentum, &records.momentum));
    if !records.structure.is_empty() {
        all.extend(of_rows("barrier.csv", barrier, &records.structure));
    }
    all
}

/// Name of a column of rows of a type, and its number.
type Column<R> = (&'static str, fn(&R) -> f64);

fn of_rows<R>(file: &str, columns: &[Column<R>], rows: &[R]) -> Vec<(String, Vec<f64>)> {
    columns.iter().map(|(name, value)| (format!("{file}: {name}"), rows.iter().map(value).collect())).collect()
}
