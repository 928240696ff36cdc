//! An experiment that is data alone: a folder with a study (`study.toml`), its case files and a table (`published.csv`).
//!
//! The study says what is run: the cases as they are, an axis `cell_m` of grids, variants of inputs, replicates. The table says what
//! was published and where ours stands. From these come a comparison, verdicts after ASME V&V 20 (`verdict.rs`), a page and a
//! figure. A disagreement is reported with its size and fails nothing; what fails are runs whose balances do not close.

mod compare;
mod figure;
mod number;
mod page;
mod table;

use crate::balances::{Balances, largest};
use crate::case_run::clear;
use crate::watch::{WordsFn, side_by_side, watched};
use crate::{Failure, data::Datum};
use checkdam::check::{Check, Kind};
use checkdam::output::OutputError;
use checkdam::plot::PlotError;
use checkdam::run::files::run_into;
use checkdam::study::{PlannedRun, Study, StudyError, plan};
use checkdam_verification::Outcome;
use checkdam_verification::report::{files, number, quoted};
use number::Number;
use std::io;
use std::path::Path;

/// The axis of a study that is read as grids.
const CELLS: &str = "cell_m";
/// Energy over E0 that may be unaccounted for: as for the columns, whose rough beds stop nodes anew in every step.
const ENERGY: f64 = 0.05;

/// Why an experiment cannot be run; `Display` is the report for the user.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// The table, or what it asks of the study, is not as it should be.
    #[error("error: {path}{}: {what}\n  fix: {fix}", .line.map_or_else(String::new, |l| format!(", line {l}")))]
    Table {
        /// The file.
        path: String,
        /// Its line, if it is one.
        line: Option<u64>,
        /// What is wrong.
        what: String,
        /// What to do.
        fix: String,
    },
    /// The study or a case is not as it should be.
    #[error(transparent)]
    Study(#[from] StudyError),
}

/// A row of the table.
#[derive(Debug, Clone)]
struct Row {
    datum: Datum,
    /// Where ours stands; none for what nothing of ours stands beside.
    number: Option<Number>,
}

/// An experiment, checked, not run.
#[derive(Debug)]
pub struct Experiment {
    /// Its name: that of its folder, with which the names of its files begin.
    pub name: String,
    /// What it is, in a line.
    pub title: String,
    columns: Vec<String>,
    plan: Vec<PlannedRun>,
    rows: Vec<Row>,
}

/// What came of a run.
struct Ran {
    /// How it ended.
    ended: String,
    /// Ours, row by row of the table; NaN for rows of other cases.
    values: Vec<f64>,
    balances: Balances,
}

impl Experiment {
    /// Reads an experiment from its folder.
    ///
    /// # Errors
    /// The file and line that is not as it should be, and what to do.
    pub fn load(folder: &Path) -> Result<Self, ExperimentError> {
        let whole = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
        let name = whole.file_name().map_or_else(|| "experiment".into(), |n| n.to_string_lossy().into_owned());
        Self::parse(&name, &folder.display().to_string(), &|file| std::fs::read_to_string(folder.join(file)))
    }

    /// An experiment from its texts, which `read` gives by the names of the files; `place` is where these are said to lie.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn parse(name: &str, place: &str, read: &dyn Fn(&str) -> io::Result<String>) -> Result<Self, ExperimentError> {
        let path = |file: &str| format!("{place}/{file}");
        let [study, published] = ["study.toml", "published.csv"].map(|file| {
            read(file).map_err(|source| ExperimentError::Table {
                path: path(file),
                line: None,
                what: format!("cannot be read: {source}"),
                fix: "an experiment is a folder with study.toml, the case files that it names, and published.csv"
                    .into(),
            })
        });
        let study = Study::parse(&study?, &path("study.toml"))?;
        let fail = |what: &str, fix: &str| {
            Err(ExperimentError::Table { path: path("study.toml"), line: None, what: what.into(), fix: fix.into() })
        };
        if study.sample.is_some() {
            return fail("an experiment takes no sample", "vary one input at a time, each as a [[variant]]");
        }
        if study.axes.iter().any(|a| a.name != CELLS) {
            return fail(
                "an experiment takes one axis, cell_m, with the cell sizes of its grids",
                "name the axis cell_m, with fields = [\"grid.spacing_m\"]; vary other inputs as [[variant]]s",
            );
        }
        let plan = plan(&study, &path("study.toml"), read)?;
        let rows = table::rows(&published?, &path("published.csv"), &plan)?;
        let columns = study.columns().into_iter().map(String::from).collect();
        Ok(Self { name: name.into(), title: study.title, columns, plan, rows })
    }

    /// How many runs it takes.
    pub fn runs(&self) -> usize {
        self.plan.len()
    }

    /// Runs it: the folders of the runs are left in `folder`; the comparison is in the outcome.
    ///
    /// # Errors
    /// A run fails or is stopped, or a table of a run has not what is asked of it.
    pub fn run(&self, folder: &Path, words: &mut WordsFn) -> Result<Outcome, Failure> {
        let ran = side_by_side(&self.plan, words, |planned, words| self.one(planned, folder, words))?;
        let mut outcome = Outcome::default();
        let worst = |of: fn(&Balances) -> f64| largest(ran.iter().map(|r| of(&r.balances)));
        for (what, measured, limit, reason) in [
            ("momentum not accounted for over the sum of impulses", worst(|b| b.momentum), 1e-10, "round-off of sums"),
            (
                "energy not accounted for over E0",
                worst(|b| b.energy),
                ENERGY,
                "second-order terms of the transfers; a rough bed stops its nodes anew in every step, and what is of second order in that is booked nowhere",
            ),
            (
                "deepest penetration / cell size",
                worst(|b| b.penetration),
                1.0,
                "walls act on nodes; a point within a cell of the face is pushed back",
            ),
        ] {
            let check = Check::at_most(format!("{what}, largest of all runs"), measured, limit, "1").because(reason);
            outcome.check(check.from(Kind::Conservation, "ledgers and gauges of all runs"));
        }
        let compared = compare::compared(self, &ran);
        let given = compared.iter().filter(|c| c.ours.is_finite()).count();
        outcome.check(
            Check::value("comparisons whose numbers are all there", given as f64, compared.len() as f64, "1")
                .because("a published number that has a counterpart here must not drop out")
                .from(Kind::Published, "published.csv"),
        );
        outcome.tables.push((format!("{}_runs", self.name), self.runs_csv(&ran)));
        outcome.tables.push((format!("{}_comparison", self.name), compare::csv(&compared)));
        Ok(outcome)
    }

    /// Writes tables, figure and page of an outcome into `folder`, which is created; returns their names.
    ///
    /// # Errors
    /// The first file that could not be written.
    pub fn write(&self, outcome: &Outcome, folder: &Path) -> Result<Vec<String>, PlotError> {
        std::fs::create_dir_all(folder).map_err(|source| OutputError::Create { path: folder.to_path_buf(), source })?;
        let mut written = Vec::new();
        for (stem, text) in files(&self.name, outcome) {
            written.push(format!("{stem}.csv"));
            checkdam::output::write_text(folder.join(format!("{stem}.csv")), &text)?;
        }
        let comparison = folder.join(format!("{}_comparison.csv", self.name));
        let (plot, page) = (format!("{}_plot.svg", self.name), format!("{}_page.md", self.name));
        figure::draw(&comparison, &folder.join(&plot))?;
        checkdam::output::write_text(folder.join(&page), &page::text(self, &comparison)?)?;
        written.extend([plot, page]);
        Ok(written)
    }

    fn one(&self, planned: &PlannedRun, folder: &Path, words: &mut WordsFn) -> Result<Ran, Failure> {
        let own = folder.join(format!("{}_runs", self.name)).join(format!("{:03}", planned.number));
        clear(&own)?;
        let (_, _, summary) = watched(&planned.what, words, |p| run_into(&planned.case, &own, p))?;
        let value = |row: &Row| match &row.number {
            Some(number) if row.datum.case == planned.case_name => number.of(&summary, &own),
            _ => Ok(f64::NAN),
        };
        let values = self.rows.iter().map(value).collect::<Result<_, OutputError>>()?;
        let ended = summary.status.trim_start_matches("completed: ").to_string();
        Ok(Ran { ended, values, balances: Balances::of(&summary, None) })
    }

    /// All runs, with ours for every row of the table.
    fn runs_csv(&self, ran: &[Ran]) -> String {
        let own: Vec<usize> = (0..self.rows.len()).filter(|&k| self.rows[k].number.is_some()).collect();
        let mut text = String::from("case,factor,label,replicate");
        text.extend(self.columns.iter().map(|c| format!(",{c}")));
        text.push_str(",ended");
        text.extend(own.iter().map(|&k| format!(",{}", quoted(&self.rows[k].datum.id))));
        text.push('\n');
        for (planned, ran) in self.plan.iter().zip(ran) {
            let head = [&planned.case_name, &planned.factor, &planned.label].map(|s| quoted(s)).join(",");
            text += &format!("{head},{}", planned.replicate);
            text.extend(planned.values.iter().map(|v| format!(",{v}")));
            text += &format!(",{}", quoted(&ran.ended));
            let cell = |x: f64| if x.is_finite() { number(x) } else { String::new() };
            text.extend(own.iter().map(|&k| format!(",{}", cell(ran.values[k]))));
            text.push('\n');
        }
        text
    }
}

#[cfg(test)]
mod tests;
