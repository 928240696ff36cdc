//! `checkdam check`.

use super::progress::remaining;
use super::{ENDED_EARLY, load, say, tell, use_threads};
use checkdam::case::{Case, Inflow, Law, Material};
use checkdam::constitutive::{Cone, DruckerPrager, LinearElastic};
use checkdam::run::inflow;
use checkdam::theory::drucker_prager::plane_strain_angle;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// How long the speed of this machine is measured.
const TRIAL: Duration = Duration::from_millis(400);

pub fn check(path: &Path, threads: Option<u16>) -> ExitCode {
    let case = match load(path) {
        Ok(case) => case,
        Err(code) => return code,
    };
    use_threads(threads);
    let mut sim = inflow::simulation(&case);
    let mut step = sim.time_step();
    // What enters is not there yet.
    step.dt = if case.inflows.is_empty() { step.dt } else { step.dt.min(case.time_step_estimate_s()) };
    let stages = &case.stages;
    let tilt = stages.tilt.as_ref().map_or(0.0, |t| t.duration_s);
    let steps = (stages.run.end_time_s + tilt) / step.dt;

    say!("{}: {} is valid", path.display(), case.title);
    let (there, entering) = (sim.particle_count() as f64, case.entering_count_estimate());
    if there > 0.0 {
        say!(
            "  {there} material points of {:.4e} kg, {:.3} kg in all; {} grid nodes active of cell size {} m",
            sim.mass() / there,
            sim.mass(),
            sim.node_count(),
            sim.spacing()
        );
    }
    case.inflows.iter().filter_map(|inflow| enters(&case, inflow)).for_each(|line| say!("  {line}"));
    say!("  time step {:.3e} s, limited by {}", step.dt, sim.describe_limit(&step));
    say!(
        "  at most {steps:.3e} steps for {} s of tilting and {} s of flow, besides settling",
        tilt,
        stages.run.end_time_s
    );
    say!("  memory {:.1} MB", sim.bytes() as f64 / 1e6);
    case.materials.iter().filter_map(|(name, material)| strength(name, material)).for_each(|note| say!("  {note}"));

    if let Some(first) = sim.inflows().map(|i| i.way.span()[0]).reduce(f64::min) {
        // As they begin.
        sim.set_time(first);
        sim.open_inflows();
    }
    let start = Instant::now();
    let (mut trial, mut worked) = (0u32, 0.0);
    let failure = rayon::scope(|_| {
        while start.elapsed() < TRIAL {
            if let Err(failure) = sim.step() {
                return Some(failure);
            }
            trial += 1;
            worked += sim.particle_count() as f64;
        }
        None
    });
    if let Some(failure) = failure {
        tell!("error: a run would fail: {failure}");
        return ExitCode::from(ENDED_EARLY);
    }
    let elapsed = start.elapsed().as_secs_f64();
    // With inflows, as if all of it were there from the start.
    let grows = if entering > 0.0 && worked > 0.0 { (there + entering) * f64::from(trial) / worked } else { 1.0 };
    let per_step = elapsed / f64::from(trial.max(1)) * grows;
    say!(
        "  expected time: at most {} ({:.1} million particle-steps per second, measured over {trial} steps on {} threads)",
        remaining(per_step * steps),
        worked / elapsed / 1e6,
        rayon::current_num_threads()
    );
    ExitCode::SUCCESS
}

/// What an inflow brings: a line. None for one that is refused.
fn enters(case: &Case, inflow: &Inflow) -> Option<String> {
    let [times, ..] = inflow.hydrograph(case)?;
    let (first, last) = (times.first()?, times.last()?);
    let density = case.materials.get(&inflow.material)?.density_kg_per_m3;
    let mass = density * inflow.area_m2(case) * case.grid.thickness_m;
    let count = inflow.particle_count_estimate(case);
    let name = &inflow.name;
    Some(format!("inflow `{name}`: about {count:.0} material points, {mass:.4e} kg, enter from {first} to {last} s"))
}

/// What the cone of a granular material makes of its friction angle in plane flow: a note, and no warning. None for other materials.
fn strength(name: &str, material: &Material) -> Option<String> {
    let given = material.frictional().filter(|_| material.law == Law::DruckerPrager)?;
    let [phi, psi] = [given.friction_angle_deg, given.dilatancy_angle_deg].map(f64::to_radians);
    let elastic = LinearElastic::new(material.young_pa, material.poisson);
    let law = DruckerPrager::new(elastic, given.cone, phi, psi, given.cohesion_pa, given.tension_cutoff_pa, true);
    let effective = (1.0 - given.pore_pressure_ratio) * law.friction;
    let acts = plane_strain_angle(effective, law.dilatancy).to_degrees();
    let acts = if acts.is_finite() { format!("as {acts:.1} degrees") } else { "without limit".to_owned() };
    let cone = match given.cone {
        Cone::TriaxialCompression => "triaxial_compression\"",
        Cone::TriaxialExtension => "triaxial_extension\"",
        Cone::PlaneStrain => "plane_strain\", the default",
        Cone::AsPrinted => "as_printed\"",
    };
    let angle = given.friction_angle_deg;
    Some(format!("note: {angle} degrees of `{name}` act {acts} in plane strain (cone = \"{cone})"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_says_what_the_cone_makes_of_the_angle() {
        let of = |keys: &str| {
            let text =
                format!("law = \"drucker_prager\"\ndensity_kg_per_m3 = 1500\nyoung_pa = 1e6\npoisson = 0.3\n{keys}");
            strength("sand", &toml::from_str(&text).expect("a material")).expect("granular")
        };
        let default = of("friction_angle_deg = 31");
        assert_eq!(
            default,
            "note: 31 degrees of `sand` act as 31.0 degrees in plane strain (cone = \"plane_strain\", the default)"
        );
        assert!(of("friction_angle_deg = 31\ncone = \"triaxial_compression\"").contains("act as 45.9 degrees"));
        // Associated flow of the outer cone has no limit in plane strain from 36.9 degrees on.
        let steep = "friction_angle_deg = 40\ndilatancy_angle_deg = 40\ncone = \"triaxial_compression\"";
        assert!(of(steep).contains("act without limit"));
    }
}
