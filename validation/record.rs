//! Recorded runs of a study: made anew when asked for, read otherwise.
//!
//! Elsewhere: regression baselines.

use super::{Context, Failure};
use checkdam::case::{Case, Integration};
use checkdam::output::{OutputError, Table};
use checkdam::study::{PlannedRun, Runs, Study, StudyError, TRUSTED, one, plan, work_off};
use checkdam_verification::report::quoted;
use std::num::NonZero;

/// A study of the project and the record of its runs.
#[derive(Debug, Clone, Copy)]
pub struct Record {
    /// Name of the study, of its folder and of its record.
    pub name: &'static str,
    /// The text of the study.
    pub study: &'static str,
    /// Gives the text of a case that it names.
    pub read: fn(&str) -> std::io::Result<String>,
    /// The recorded table.
    pub runs: &'static str,
}

impl Record {
    /// The runs that the study asks for.
    ///
    /// # Errors
    /// The study or a case is not as it should be.
    pub fn plan(&self) -> Result<(Study, Vec<PlannedRun>), StudyError> {
        let study = Study::parse(self.study, self.name)?;
        let plan = plan(&study, self.name, &self.read)?;
        Ok((study, plan))
    }

    /// The table of the runs: recorded, or made anew in the context's folder if studies are asked for.
    ///
    /// # Errors
    /// The record does not belong to the study, or the study fails or is stopped.
    pub fn table(&self, context: &mut Context) -> Result<Table, Failure> {
        let (study, plan) = self.plan()?;
        let text = if context.studies { self.run(&study, &plan, context)? } else { self.runs.to_string() };
        let table = Table::parse(&text, format!("{}/runs.csv", self.name))?;
        if !table.cells("key")?.iter().eq(plan.iter().map(|r| &r.key)) {
            return Err(Failure::Record(format!(
                "the recorded runs are not those of the study `{}`: one of them, or a case, has changed since; make the record \
                 anew with `checkdam validate --studies {}` and put its runs.csv in its place",
                self.name, self.name
            )));
        }
        Ok(table)
    }

    /// Its runs one by one, to make some of them anew.
    ///
    /// # Errors
    /// The study or a case is not as it should be.
    pub fn rows(&self) -> Result<Vec<RecordedRun>, Failure> {
        let (study, plan) = self.plan()?;
        let columns: Vec<String> = study.columns().into_iter().map(String::from).collect();
        let mut lines = self.runs.lines();
        let header = lines.next().unwrap_or_default();
        let ends = Table::parse(self.runs, self.name)?.column("end_s")?.to_vec();
        let rows = plan.into_iter().zip(lines).zip(ends).map(|((planned, line), end)| {
            let columns = columns.clone();
            let (what, recorded, cost) = (planned.what.clone(), line.to_string(), cost(&planned.case, end));
            let anew = move || {
                let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
                let mut runs = Runs::new(&columns);
                runs.insert(&planned, one(&planned, &mut |_| true));
                as_in(header, &runs.csv(std::slice::from_ref(&planned)))
            };
            RecordedRun { what, recorded, cost, anew: Box::new(anew) }
        });
        Ok(rows.collect())
    }

    fn run(&self, study: &Study, plan: &[PlannedRun], context: &mut Context) -> Result<String, Failure> {
        let folder = context.folder.join(self.name);
        let progress = &mut *context.progress;
        let start = std::time::Instant::now();
        let mut notes = Vec::new();
        let (runs, finished) = work_off(
            plan,
            (study, self.study),
            &folder,
            processors(),
            &mut |p| {
                // Often, so that a stop is noticed; in words, only when a run has ended.
                if p.ended.is_none() {
                    return progress("");
                }
                let done = (p.finished - p.earlier).max(1) as f64;
                let left = start.elapsed().as_secs_f64() / done * (p.total - p.finished) as f64;
                progress(&format!("{} of {} runs, about {:.0} min left", p.finished, p.total, (left / 60.0).ceil()))
            },
            &mut notes,
        )?;
        for note in notes {
            progress(&note);
        }
        if !finished.is_complete() {
            return Err(Failure::Stopped);
        }
        Ok(runs.csv(plan))
    }
}

/// The line of a table of one run, with the columns of a header. A table has the quantities that one of its runs has: what the run
/// lacks is an empty cell, and what the header lacks is added to the line, which then differs from any on record. Whether a run is to be
/// trusted is no number of it: records that were made before that was said go without.
fn as_in(header: &str, one: &str) -> Result<String, Failure> {
    let table = Table::parse(one, "a run")?;
    let wanted: Vec<&str> = header.split(',').collect();
    let more = table.names().iter().map(String::as_str).filter(|name| !wanted.contains(name) && *name != TRUSTED);
    let cells = wanted.iter().copied().chain(more).map(|name| {
        let cell = if table.names().iter().any(|n| n == name) { table.cells(name)?.remove(0) } else { String::new() };
        Ok(quoted(&cell))
    });
    Ok(cells.collect::<Result<Vec<_>, OutputError>>()?.join(","))
}

/// A run that is on record.
pub struct RecordedRun {
    /// What it is, in a line.
    pub what: String,
    /// Its line in the record.
    pub recorded: String,
    /// About how many particle-steps it takes.
    pub cost: f64,
    /// Runs it again; its line.
    pub anew: Box<dyn Fn() -> Result<String, Failure> + Send + Sync>,
}

/// About how many particle-steps a case takes that ended at `end` (s), or at its end time; it settles and tilts for a second before.
fn cost(case: &Case, end: f64) -> f64 {
    let time = 1.0 + if end.is_finite() { end } else { case.stages.run.end_time_s };
    let explicit = case.bodies.iter().filter(|b| b.integration == Integration::Explicit);
    let material = explicit.filter_map(|b| case.materials.get(&b.material));
    let stiffest = material.map(|m| m.young_pa / m.density_kg_per_m3).fold(0.0, f64::max);
    let step = case.numerics.cfl * case.grid.spacing_m / stiffest.sqrt();
    case.particle_count_estimate() * time / step
}

/// A spread-out choice of runs that costs about `budget`: down the list the share budget / (number of runs * cost) is added up, at
/// most one a run, and a run is chosen whenever the sum passes a half, one and a half, two and a half. So cheap runs are chosen often
/// and dear ones seldom, none is left out for ever by kind, and each kind costs the same.
pub fn spread_out(costs: &[f64], budget: f64) -> Vec<usize> {
    let mut sum = 0.5;
    let mut chosen = Vec::new();
    for (k, cost) in costs.iter().enumerate() {
        let before = f64::floor(sum);
        sum += (budget / (costs.len() as f64 * cost)).min(1.0);
        if f64::floor(sum) > before {
            chosen.push(k);
        }
    }
    chosen
}

/// How many runs go side by side: as many as there are threads.
pub fn processors() -> NonZero<usize> {
    NonZero::new(rayon::current_num_threads()).unwrap_or(NonZero::<usize>::MIN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use checkdam::study::{Folder, attempt};
    use checkdam_verification::Fault;

    const CASE: &str = r#"
        title = "drop"
        gravity = { inclination_deg = 0 }
        grid = { spacing_m = 0.05, thickness_m = 0.1 }
        domain = { x_m = [-0.5, 0.5], y_m = [-0.2, 0.6] }
        materials.rubber = { law = "linear_elastic", density_kg_per_m3 = 1000, young_pa = 1e5, poisson = 0.2 }
        bodies = [{ name = "block", material = "rubber", x_m = [-0.1, 0.1], y_m = [0.0, 0.2] }]
        stages.run = { end_time_s = 0.1 }
        gauges = { barrier = "floor" }
        [[boundaries]]
        name = "floor"
        kind = "plane"
        point_m = [0.0, 0.0]
        normal_deg = 90
        contact = "smooth"
    "#;
    const STUDY: &str = r#"
        title = "stiffness"
        cases = ["drop.toml"]
        [[axis]]
        name = "young_pa"
        fields = ["materials.rubber.young_pa"]
        values = [1.0e5, 2.0e5]
    "#;

    fn record(runs: &str) -> Record {
        let runs = String::leak(runs.to_string());
        Record { name: "drop", study: STUDY, read: |_| Ok(CASE.to_string()), runs }
    }

    /// Lines of a record that a new run does not give.
    fn wrong(record: &Record) -> Vec<String> {
        let rows = record.rows().expect("a study");
        assert_eq!(rows.len(), 2);
        rows.into_iter().filter(|r| (r.anew)().expect("a run") != r.recorded).map(|r| r.recorded).collect()
    }

    #[test]
    fn a_digit_that_is_wrong_is_seen() {
        let planned = record("").plan().expect("a study").1;
        let mut runs = Runs::new(&["young_pa"]);
        for run in &planned {
            runs.insert(run, one(run, &mut |_| true));
        }
        let text = runs.csv(&planned);
        assert!(text.lines().count() == 3 && !text.contains("failed"), "{text}");
        assert_eq!(wrong(&record(&text)), Vec::<String>::new());
        // The last digit of the last number of the second run but two.
        let (place, digit) = text.char_indices().filter(|c| c.1.is_ascii_digit()).nth_back(20).expect("a digit");
        let mut changed = text.clone();
        changed.replace_range(place..=place, if digit == '7' { "3" } else { "7" });
        assert_eq!(wrong(&record(&changed)), [changed.lines().nth(2).expect("two runs")]);
    }

    /// A record that is made anew goes on with runs that other processes have made in its folder.
    #[test]
    fn a_record_is_made_of_runs_that_others_made() {
        let folder = std::env::temp_dir().join(format!("checkdam-record-{}", std::process::id()));
        let record = record("");
        let (study, planned) = record.plan().expect("a study");
        let at = folder.join("drop");
        {
            let shared = Folder::shared(&at).expect("a folder");
            attempt(&planned[1], Some(&shared), &mut |_| true).expect("a result");
        }
        let mut made = Vec::new();
        let mut progress = |text: &str| {
            made.extend((!text.is_empty()).then(|| text.to_string()));
            true
        };
        let mut context = Context { fault: Fault::NONE, folder: &folder, studies: true, progress: &mut progress };
        let table = record.table(&mut context).expect("a table");
        assert_eq!(table.cells("key").expect("keys"), [planned[0].key.as_str(), planned[1].key.as_str()]);
        assert!(made.len() == 1 && made[0].starts_with("2 of 2 runs"), "{made:?}");
        let mut alone = Runs::new(&study.columns());
        planned.iter().for_each(|run| alone.insert(run, one(run, &mut |_| true)));
        assert_eq!(std::fs::read_to_string(at.join("runs.csv")).expect("a table"), alone.csv(&planned));
        std::fs::remove_dir_all(&folder).expect("a folder");
    }

    #[test]
    fn a_line_has_the_columns_of_its_record() {
        let one = "case,label,key,a\nsteep,\"0.2 x 0.5 m, dense\",f00,1.5\n";
        let line = |header| as_in(header, one).expect("a line");
        assert_eq!(line("case,label,key,a"), "steep,\"0.2 x 0.5 m, dense\",f00,1.5");
        assert_eq!(line("case,key,a,b"), "steep,f00,1.5,,\"0.2 x 0.5 m, dense\"");
    }

    #[test]
    fn cheap_runs_are_chosen_often_and_dear_ones_seldom() {
        let costs: Vec<f64> = (0..300).map(|k| if k % 3 == 0 { 100.0 } else { 1.0 }).collect();
        let chosen = spread_out(&costs, 600.0);
        let dear = chosen.iter().filter(|k| *k % 3 == 0).count();
        // Two units a run: every cheap one, one dear one in fifty.
        assert_eq!((dear, chosen.len() - dear), (2, 200));
        assert_eq!(spread_out(&costs, 1e9).len(), 300);
        let few = spread_out(&costs, 30.0);
        assert!((15..25).contains(&few.len()) && few.windows(2).all(|w| w[1] - w[0] < 60), "{few:?}");
        assert!(spread_out(&[1e3; 2], 1.0).is_empty());
    }
}
