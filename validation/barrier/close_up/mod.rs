//! Four of the barriers looked into: pressure through time, the wave that runs up the flow, how the barrier moves and bends, stress and
//! shear in the sand, what rests on the wall at the end, and where the energy is (Figs. 5 and 7 to 14 of the paper).
//!
//! The runs take some minutes; what the figures need of them is on record in `tables`.

use super::PUBLISHED;
use super::records::RIGIDITY;
use crate::case::Case;
use crate::check::{Check, Kind};
use crate::output::{Table, write_text};
use crate::plot::curves::{self, Curve, Curves, Panel};
use crate::plot::flow_snapshots::{self, Shown};
use crate::plot::{PlotError, energy_shares};
use crate::theory::earth_pressure::{Wall, jaky, rankine_active, rankine_passive};
use crate::validation::{Context, Failure, Validation, data};
use crate::verification::Outcome;
use crate::verification::report::number;
use std::path::Path;

mod record;

/// The figures.
pub const VALIDATION: Validation = Validation {
    name: "barrier_close_up",
    title: "Four barriers looked into: pressure, wave, velocity, deflection, stress, shear, energy",
    study: "4 runs, about 4 minutes",
    run,
    draw,
    covers: &[],
};

/// Name and row of the study of the barriers shown: their normalised stiffness as it stands there.
pub const BARRIERS: [(&str, &str); 4] =
    [("plastic", "2.5e-6"), ("fibre glass", "1e-5"), ("steel", "0.0001"), ("concrete", "1")];
/// Of these two, the fields are shown: soft above stiff.
const FIELDS: [&str; 2] = ["plastic", "concrete"];
/// When, s after release.
const INSTANTS: [f64; 4] = [0.49, 0.6, 1.0, 2.4];
/// When the pressure up the flow is read, s after release: from the arrival on.
const WAVE: [f64; 2] = [0.474, 0.53];
/// Every so often, s.
const WAVE_STEP: f64 = 0.002;
/// Correlation below which distances and times do not make a wave.
const STRAIGHT: f64 = 0.85;
/// Height of the row of cells in which it is read, m above the bed: half the depth of the flow that arrives.
const WAVE_ROW: f64 = 0.055;
/// How far up the flow, m.
const WAVE_REACH: f64 = 0.3;

/// Tables of the record: file, text.
const RECORD: [(&str, &str); 12] = [
    ("pressure.csv", include_str!("tables/pressure.csv")),
    ("wave.csv", include_str!("tables/wave.csv")),
    ("at_peak.csv", include_str!("tables/at_peak.csv")),
    ("at_rest.csv", include_str!("tables/at_rest.csv")),
    ("energy.csv", include_str!("tables/energy.csv")),
    ("geometry.csv", include_str!("tables/geometry.csv")),
    ("field_plastic.csv", include_str!("tables/field_plastic.csv")),
    ("field_concrete.csv", include_str!("tables/field_concrete.csv")),
    ("outline_plastic.csv", include_str!("tables/outline_plastic.csv")),
    ("outline_concrete.csv", include_str!("tables/outline_concrete.csv")),
    ("mechanisms_plastic.csv", include_str!("tables/mechanisms_plastic.csv")),
    ("mechanisms_concrete.csv", include_str!("tables/mechanisms_concrete.csv")),
];
/// Folder of these tables.
const FOLDER: &str = "barrier_close_up";

/// The case of a barrier: that of the study, with the gauges that the figures need.
fn case_of(stiffness: &str) -> Result<Case, Failure> {
    let plan = RIGIDITY.record.plan()?.1;
    let found = plan.into_iter().find(|r| r.case_name == super::rigidity::LITERAL && r.values[0] == stiffness);
    let mut case = found.ok_or_else(|| Failure::Record(format!("the study has no barrier of {stiffness}")))?.case;
    let frames = ((WAVE[1] - WAVE[0]) / WAVE_STEP).round() as usize;
    let mut times: Vec<f64> = (0..=frames).map(|k| WAVE[0] + k as f64 * WAVE_STEP).chain(INSTANTS).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    case.gauges.field_times_s = times;
    case.output.vtk_interval_s = 0.02;
    Ok(case)
}

fn run(context: &mut Context) -> Result<Outcome, Failure> {
    let tables = tables(context)?;
    let folder = context.folder.join(FOLDER);
    std::fs::create_dir_all(&folder)
        .map_err(|source| crate::output::OutputError::Create { path: folder.clone(), source })?;
    for (name, text) in &tables {
        write_text(folder.join(name), text)?;
    }
    let table = |name: &str| parsed(&tables, name);
    let mut outcome = Outcome { checks: checks(&table("energy.csv")?)?, ..Outcome::default() };
    outcome.tables.push(("barrier_close_up_celerity".into(), celerities(&table("wave.csv")?)?));
    write_text(folder.join("wave_shown.csv"), &shown(&table("wave.csv")?)?)?;
    write_text(folder.join("at_rest_lines.csv"), &with_theory(&table("at_rest.csv")?)?)?;
    Ok(outcome)
}

/// Numbers that are read from the tables of the four barriers.
pub struct Numbers {
    /// Barrier and celerity of the wave, m/s.
    celerities: Vec<(String, f64)>,
    /// Barrier, time (s), share dissipated, share held by the barrier, kinetic share.
    energy: Vec<(String, [f64; 4])>,
}

/// Reads them.
///
/// # Errors
/// The record is not as it should be, or the runs are stopped.
pub fn numbers(context: &mut Context) -> Result<Numbers, Failure> {
    let tables = tables(context)?;
    let celerities = Table::parse(&celerities(&parsed(&tables, "wave.csv")?)?, "celerities.csv")?;
    let speeds = celerities.column("celerity_m_per_s")?;
    let celerities = celerities.cells("barrier")?.into_iter().zip(speeds.iter().copied()).collect();
    let energy = parsed(&tables, "energy.csv")?;
    let columns = [
        energy.column("time_s")?,
        energy.column("dissipated_1")?,
        energy.column("barrier_1")?,
        energy.column("kinetic_1")?,
    ];
    let rows = energy.cells("barrier")?.into_iter().enumerate();
    let energy = rows.map(|(k, name)| (name, columns.map(|c| c[k]))).collect();
    Ok(Numbers { celerities, energy })
}

impl Numbers {
    /// Celerity of the wave at a barrier, m/s.
    pub fn celerity(&self, barrier: &str) -> f64 {
        self.celerities.iter().find(|c| c.0 == barrier).map_or(f64::NAN, |c| c.1)
    }

    /// Largest share of the energy at release that the barrier ever holds.
    pub fn held_by_barrier(&self, barrier: &str) -> f64 {
        self.energy.iter().filter(|e| e.0 == barrier).map(|e| e.1[2]).fold(0.0, f64::max)
    }

    /// When the kinetic energy is largest, s.
    pub fn fastest(&self, barrier: &str) -> f64 {
        let own = self.energy.iter().filter(|e| e.0 == barrier);
        own.fold((f64::NAN, 0.0), |a, e| if e.1[3] > a.1 { (e.1[0], e.1[3]) } else { a }).0
    }

    /// When it last exceeds a hundredth of the energy at release, s.
    pub fn at_rest(&self, barrier: &str) -> f64 {
        self.energy.iter().rfind(|e| e.0 == barrier && e.1[3] > 0.01).map_or(f64::NAN, |e| e.1[0])
    }

    /// Share of what is dissipated that is dissipated after the arrival.
    pub fn pile_up(&self, barrier: &str) -> f64 {
        let own: Vec<&[f64; 4]> = self.energy.iter().filter(|e| e.0 == barrier).map(|e| &e.1).collect();
        let before = own.iter().rfind(|e| e[0] <= WAVE[0]).map_or(f64::NAN, |e| e[1]);
        own.last().map_or(f64::NAN, |end| 1.0 - before / end[1])
    }

    /// Time from the arrival until nine tenths of what is dissipated after it are, s.
    pub fn levelling(&self, barrier: &str) -> f64 {
        let own: Vec<&[f64; 4]> = self.energy.iter().filter(|e| e.0 == barrier).map(|e| &e.1).collect();
        let Some(end) = own.last() else { return f64::NAN };
        let before = own.iter().rfind(|e| e[0] <= WAVE[0]).map_or(0.0, |e| e[1]);
        let level = before + 0.9 * (end[1] - before);
        own.iter().find(|e| e[1] >= level).map_or(f64::NAN, |e| e[0] - WAVE[0])
    }
}

/// The tables: recorded, or made anew if studies are asked for.
fn tables(context: &mut Context) -> Result<Vec<(String, String)>, Failure> {
    if context.studies {
        record::make(context)
    } else {
        Ok(RECORD.iter().map(|(name, text)| (name.to_string(), text.to_string())).collect())
    }
}

fn parsed(tables: &[(String, String)], name: &str) -> Result<Table, Failure> {
    let text = tables.iter().find(|t| t.0 == name).map_or("", |t| &t.1);
    Ok(Table::parse(text, format!("close_up/{name}"))?)
}

/// Rows of a table of a barrier.
fn rows_of(table: &Table, barrier: &str) -> Result<Vec<usize>, Failure> {
    Ok(table.cells("barrier")?.iter().enumerate().filter(|(_, b)| *b == barrier).map(|(k, _)| k).collect())
}

/// The energies of every barrier add up.
fn checks(energy: &Table) -> Result<Vec<Check>, Failure> {
    let residual = energy.column("residual_1")?;
    let one = |barrier: &str| {
        let own = rows_of(energy, barrier)?.into_iter().map(|k| residual[k].abs());
        let worst = own.fold(0.0, |a: f64, x| if x.is_nan() { x } else { a.max(x) });
        Ok(Check::at_most(format!("{barrier}: energy not accounted for over E0, largest"), worst, 0.02, "1")
            .because("second-order terms of the transfers; 2 % is where forces would begin to suffer")
            .from(Kind::Conservation, "the ledger of the run"))
    };
    BARRIERS.iter().map(|(barrier, _)| one(barrier)).collect()
}

/// Every eighth instant, with its name: 16 ms apart.
fn shown(wave: &Table) -> Result<String, Failure> {
    let (time, distance, pressure) = (wave.column("time_s")?, wave.column("distance_m")?, wave.column("pressure_pa")?);
    let barrier = wave.cells("barrier")?;
    let mut text = String::from("barrier,shown,distance_m,pressure_pa\n");
    for k in 0..wave.rows() {
        let frame = ((time[k] - WAVE[0]) / WAVE_STEP).floor() as usize;
        if frame.is_multiple_of(8) {
            let at = WAVE[0] + frame as f64 * WAVE_STEP;
            text += &format!("{},{at:.3} s,{},{}\n", barrier[k], number(distance[k]), number(pressure[k]));
        }
    }
    Ok(text)
}

/// How fast the wave runs up the flow: at each distance, when the pressure first reaches half of the largest next to the face; a straight
/// line through distance over time by least squares, and its correlation; no celerity where that is poor.
fn celerities(wave: &Table) -> Result<String, Failure> {
    let (time, distance, pressure) = (wave.column("time_s")?, wave.column("distance_m")?, wave.column("pressure_pa")?);
    let paper = |barrier: &str| match barrier {
        "steel" => number(data::row(PUBLISHED, "B28").value),
        "plastic" => number(data::row(PUBLISHED, "B29").value),
        _ => String::new(),
    };
    let mut text =
        String::from("barrier,largest_pressure_pa,celerity_m_per_s,correlation,distances,farthest_m,paper_m_per_s\n");
    for (barrier, _) in BARRIERS {
        let mut rows = rows_of(wave, barrier)?;
        rows.retain(|&k| distance[k] >= 0.0);
        let nearest = rows.iter().map(|&k| distance[k]).fold(f64::INFINITY, f64::min);
        let largest =
            rows.iter().filter(|&&k| distance[k] <= nearest + 0.011).map(|&k| pressure[k]).fold(0.0, f64::max);
        let mut places: Vec<f64> = rows.iter().map(|&k| distance[k]).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        let reached: Vec<(f64, f64)> = places
            .iter()
            .filter_map(|&d| {
                let own = rows.iter().filter(|&&k| distance[k] == d && pressure[k] >= 0.5 * largest);
                own.map(|&k| time[k]).reduce(f64::min).map(|t| (t, d))
            })
            .collect();
        let (slope, correlation) = line(&reached);
        let slope = if correlation >= STRAIGHT { slope } else { f64::NAN };
        let farthest = reached.iter().map(|p| p.1).fold(0.0, f64::max);
        let numbers = [largest, slope, correlation].map(|x| if x.is_finite() { number(x) } else { String::new() });
        text += &format!("{barrier},{},{},{},{}\n", numbers.join(","), reached.len(), number(farthest), paper(barrier));
    }
    Ok(text)
}

/// Slope of a straight line by least squares, and the correlation.
fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let sum = |of: &dyn Fn(f64, f64) -> f64| points.iter().map(|p| of(p.0 - x, p.1 - y)).sum::<f64>();
    let (xx, yy, xy) = (sum(&|a, _| a * a), sum(&|_, b| b * b), sum(&|a, b| a * b));
    (xy / xx, xy / (xx * yy).sqrt())
}

/// The pressure at rest, averaged over five cells as single nodes alternate, with the lines of the earth pressure theories beside it:
/// K rho g times the depth below the highest material at the wall.
fn with_theory(at_rest: &Table) -> Result<String, Failure> {
    let case = RIGIDITY.first_case()?;
    let sand = &case.materials["sand"];
    let phi = sand.friction_angle_deg.unwrap_or(f64::NAN).to_radians();
    let delta = libm::atan(case.contacts.iter().map(|c| c.friction).next().unwrap_or(f64::NAN));
    let wall = Wall { friction_angle: phi, wall_friction_angle: delta, batter: 0.0, surface_slope: 0.0 };
    let unit_weight = sand.density_kg_per_m3 * case.gravity.magnitude_m_per_s2;
    let coefficients = [
        jaky(phi),
        rankine_active(phi),
        rankine_passive(phi),
        wall.coulomb_active() * libm::cos(delta),
        wall.coulomb_passive() * libm::cos(delta),
    ];
    let (height, top) = (at_rest.column("height_m")?, at_rest.column("run_up_m")?);
    let (barrier, pressure) = (at_rest.cells("barrier")?, at_rest.column("pressure_pa")?);
    let mut text = String::from(
        "barrier,height_m,pressure_kpa,at_rest_kpa,rankine_active_kpa,rankine_passive_kpa,coulomb_active_kpa,coulomb_passive_kpa\n",
    );
    let smooth = |k: usize| {
        let near = k.saturating_sub(2)..(k + 3).min(at_rest.rows());
        let own = near.filter(|&j| barrier[j] == barrier[k]).map(|j| pressure[j]);
        let (sum, count) = own.fold((0.0, 0.0), |(s, n), p| (s + p, n + 1.0));
        sum / count
    };
    for k in 0..at_rest.rows() {
        let weight = 1e-3 * unit_weight * (top[k] - height[k]).max(0.0);
        let lines = coefficients.map(|c| number(c * weight)).join(",");
        text += &format!("{},{},{},{lines}\n", barrier[k], number(height[k]), number(1e-3 * smooth(k)));
    }
    Ok(text)
}

const fn curve(column: &'static str, label: &'static str, exact: bool) -> Curve<'static> {
    Curve { column, label, exact }
}

const EACH: &[Panel<'static>] = &[
    Panel { title: "plastic, n = 2.5e-6", only: &[("barrier", "plastic")] },
    Panel { title: "fibre glass, n = 1e-5", only: &[("barrier", "fibre glass")] },
    Panel { title: "steel, n = 1e-4", only: &[("barrier", "steel")] },
    Panel { title: "concrete, n = 1", only: &[("barrier", "concrete")] },
];
const SPLIT: &[(&str, &str)] = &[("barrier", "")];

const PRESSURE: Curves = Curves {
    x: "time_s",
    x_title: "time after release (s)",
    y_title: "mean pressure on the barrier (kPa)",
    curves: &[curve("pressure_kpa", "", false)],
    split: SPLIT,
    ..Curves::LINEAR
};
const WAVES: Curves = Curves {
    x: "distance_m",
    x_title: "distance up the flow from the face (m)",
    y_title: "pressure (Pa)",
    curves: &[curve("pressure_pa", "", false)],
    panels: EACH,
    split: &[("shown", "t = ")],
    ..Curves::LINEAR
};
const VELOCITY: Curves = Curves {
    x: "velocity_over_front_1",
    x_title: "velocity of the barrier over that of the front",
    y_title: "height over the depth of the flow",
    curves: &[curve("height_over_depth_1", "", false)],
    split: SPLIT,
    ..Curves::LINEAR
};
const BENT: Curves = Curves {
    x: "deflection_percent",
    x_title: "deflection over the height of the barrier (%)",
    y_title: "height over the depth of the flow",
    curves: &[curve("height_over_depth_1", "", false)],
    split: SPLIT,
    ..Curves::LINEAR
};
const AT_REST: Curves = Curves {
    x: "height_m",
    x_title: "height above the foot (m)",
    y_title: "pressure (kPa)",
    curves: &[
        curve("pressure_kpa", "mean over the last 0.3 s and 50 mm", false),
        curve("at_rest_kpa", "at rest, Jaky", true),
        curve("rankine_active_kpa", "Rankine, active", true),
        curve("rankine_passive_kpa", "Rankine, passive", true),
        curve("coulomb_active_kpa", "Coulomb, active", true),
    ],
    panels: EACH,
    ..Curves::LINEAR
};
const ENERGY: Curves = Curves {
    x: "time_s",
    x_title: "time after release (s)",
    y_title: "share of the energy at release",
    curves: &[
        curve("kinetic_1", "kinetic", false),
        curve("dissipated_1", "dissipated", false),
        curve("barrier_1", "kinetic and elastic, of the barrier", false),
        curve("residual_1", "not accounted for", true),
    ],
    panels: EACH,
    ..Curves::LINEAR
};
const STRESS: Shown = Shown { column: "pressure_pa", title: "pressure (Pa)", top: None, logarithmic_from: Some(100.0) };
const SHEAR: Shown = Shown { column: "plastic_shear_strain", title: "plastic shear strain", top: Some(4.0), logarithmic_from: None };

fn draw(folder: &Path) -> Result<Vec<String>, PlotError> {
    let tables = folder.join(FOLDER);
    let mut names = Vec::new();
    let mut at = |name: &str| {
        names.push(format!("barrier_close_up_{name}.svg"));
        folder.join(format!("barrier_close_up_{name}.svg"))
    };
    let curves: [(&str, &Curves, &str); 6] = [
        ("pressure.csv", &PRESSURE, "pressure"),
        ("wave_shown.csv", &WAVES, "wave"),
        ("at_peak.csv", &VELOCITY, "velocity"),
        ("at_peak.csv", &BENT, "deflection"),
        ("at_rest_lines.csv", &AT_REST, "at_rest"),
        ("energy.csv", &ENERGY, "energy"),
    ];
    for (table, what, name) in curves {
        curves::draw(tables.join(table), what, at(name))?;
    }
    for barrier in FIELDS {
        let (field, outline) =
            (tables.join(format!("field_{barrier}.csv")), tables.join(format!("outline_{barrier}.csv")));
        for (shown, name) in [(&STRESS, "stress"), (&SHEAR, "shear")] {
            let out = at(&format!("{name}_{barrier}"));
            flow_snapshots::draw_with_barrier(&field, shown, tables.join("geometry.csv"), Some(&outline), 60.0, out)?;
        }
        let mechanisms = tables.join(format!("mechanisms_{barrier}.csv"));
        energy_shares::draw(mechanisms, at(&format!("mechanisms_{barrier}")))?;
    }
    Ok(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_front_that_moves_steadily_has_its_celerity() {
        let mut text = String::from("barrier,time_s,distance_m,pressure_pa\n");
        for step in 0..20 {
            for cell in 0..10 {
                let (t, d) = (0.002 * f64::from(step), 0.01 * f64::from(cell));
                let p = if d <= 2.5 * t { 1000.0 } else { 10.0 };
                text += &format!("steel,{t},{d},{p}\n");
            }
        }
        let table = Table::parse(&text, "wave.csv").expect("a table");
        let csv = celerities(&table).expect("celerities");
        let row = csv.lines().find(|l| l.starts_with("steel")).expect("steel");
        assert_eq!(row.split(',').collect::<Vec<_>>()[..3], ["steel", "1000", "2.5"]);
    }
}
