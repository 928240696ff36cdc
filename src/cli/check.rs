//! `checkdam check`.

use super::progress::remaining;
use super::{ENDED_EARLY, load, say, tell, use_threads};
use checkdam::case::{Law, Material};
use checkdam::constitutive::{Cone, DruckerPrager, LinearElastic};
use checkdam::run::scene;
use checkdam::simulation::Simulation;
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
    let mut sim = Simulation::new(scene::build(&case));
    let step = sim.time_step();
    let stages = &case.stages;
    let tilt = stages.tilt.as_ref().map_or(0.0, |t| t.duration_s);
    let steps = (stages.run.end_time_s + tilt) / step.dt;

    say!("{}: {} is valid", path.display(), case.title);
    say!(
        "  {} material points of {:.4e} kg, {:.3} kg in all; {} grid nodes active of cell size {} m",
        sim.particle_count(),
        sim.mass() / sim.particle_count() as f64,
        sim.mass(),
        sim.node_count(),
        sim.spacing()
    );
    say!("  time step {:.3e} s, limited by {}", step.dt, sim.describe_limit(&step));
    say!(
        "  at most {steps:.3e} steps for {} s of tilting and {} s of flow, besides settling",
        tilt,
        stages.run.end_time_s
    );
    say!("  memory {:.1} MB", sim.bytes() as f64 / 1e6);
    case.materials.iter().filter_map(|(name, material)| strength(name, material)).for_each(|note| say!("  {note}"));

    let start = Instant::now();
    let mut trial = 0u32;
    let failure = rayon::scope(|_| {
        while start.elapsed() < TRIAL {
            if let Err(failure) = sim.step() {
                return Some(failure);
            }
            trial += 1;
        }
        None
    });
    if let Some(failure) = failure {
        tell!("error: a run would fail: {failure}");
        return ExitCode::from(ENDED_EARLY);
    }
    let per_step = start.elapsed().as_secs_f64() / f64::from(trial.max(1));
    say!(
        "  expected time: at most {} ({:.1} million particle-steps per second, measured over {trial} steps on {} threads)",
        remaining(per_step * steps),
        sim.particle_count() as f64 / per_step / 1e6,
        rayon::current_num_threads()
    );
    ExitCode::SUCCESS
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
