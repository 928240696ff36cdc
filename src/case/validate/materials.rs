//! Materials.

use super::{Checker, text, toml_text};
use crate::case::material::{Law, Material};
use crate::case::path::KeyPath;
use crate::constitutive::Cone;

impl Checker<'_> {
    pub(super) fn materials(&mut self) {
        for (name, material) in &self.case.materials {
            let at = KeyPath::top("materials").key(name);
            self.positive(&at.key("density_kg_per_m3"), material.density_kg_per_m3, 1500.0);
            self.positive(&at.key("young_pa"), material.young_pa, 1.0e6);
            self.poisson(&at.key("poisson"), material.poisson);
            self.unused(&at, material);
            match material.law {
                Law::DruckerPrager | Law::MohrCoulomb => self.frictional(&at, material),
                Law::MuI => self.mu_i(&at, material),
                Law::VonMises => self.von_mises(&at, material),
                Law::LinearElastic | Law::NeoHookean => {}
            }
        }
    }

    fn poisson(&mut self, path: &KeyPath, poisson: f64) {
        let (why, fix) = if poisson >= 0.5 {
            (" (0.5 is incompressible: the P-wave speed, and with it the time step, has no bound)", "0.49")
        } else {
            (" (at -1 the shear modulus is infinite)", "0.3")
        };
        let allowed = format!("-1 < poisson < 0.5{why}");
        let holds = poisson > -1.0 && poisson < 0.5;
        self.require(path, poisson, holds, &allowed, &format!("use a value such as {fix}"));
    }

    /// A number without which a law is none.
    fn required(&mut self, at: &KeyPath, key: &str, number: Option<f64>, law: Law, example: &str) -> Option<f64> {
        if number.is_none() {
            let path = at.key(key);
            let what = format!("{path} is missing");
            let fix = format!("add a line such as {key} = {example}");
            self.problem(&path, what, &"", &format!("required by law = {}", toml_text(&law)), &fix);
        }
        number
    }

    fn frictional(&mut self, at: &KeyPath, material: &Material) {
        let zero_or_more = [("cohesion_pa", material.cohesion_pa), ("tension_cutoff_pa", material.tension_cutoff_pa)];
        for (key, number) in zero_or_more {
            self.not_negative(&at.key(key), number.unwrap_or(0.0), 0.0);
        }
        let path = at.key("friction_angle_deg");
        let given = self.required(at, "friction_angle_deg", material.friction_angle_deg, material.law, "31");
        let Some(friction) = given else { return };
        let holds = (0.0..90.0).contains(&friction);
        let allowed = "0 <= friction_angle_deg < 90, in degrees";
        self.require(&path, friction, holds, allowed, "use a value such as 31");

        let limit = largest_friction_angle_deg(material.cone.unwrap_or_default());
        if holds && friction >= limit {
            let allowed = format!(
                "below {limit:.1} degrees with cone = \"triaxial_compression\": above it no compressive stress \
                 reaches the cone when the material flows in plane strain, so that it cannot yield"
            );
            let fix = "use cone = \"plane_strain\", or a smaller angle";
            self.not_allowed(&path, &friction, &allowed, fix);
        }
        if let Some(dilatancy) = material.dilatancy_angle_deg {
            let allowed = format!("0 <= dilatancy_angle_deg <= friction_angle_deg = {}", text(friction));
            let holds = dilatancy >= 0.0 && (dilatancy <= friction || !friction.is_finite());
            let fix = "use 0 for flow at constant volume";
            self.require(&at.key("dilatancy_angle_deg"), dilatancy, holds, &allowed, fix);
        }
        if let Some(ratio) = material.pore_pressure_ratio {
            let allowed = "0 <= pore_pressure_ratio < 1: at 1 the fluid carries everything, and nothing rubs";
            let path = at.key("pore_pressure_ratio");
            self.require(&path, ratio, (0.0..1.0).contains(&ratio), allowed, "use a value such as 0.4");
        }
        self.softening(at, material, friction);
    }

    /// Both numbers of softening or none; the critical state is not stronger than the peak.
    fn softening(&mut self, at: &KeyPath, material: &Material, peak: f64) {
        let given = [
            ("critical_friction_angle_deg", material.critical_friction_angle_deg),
            ("softening_strain", material.softening_strain),
        ];
        let [critical, over] = given.map(|(_, number)| number);
        if critical.is_some() != over.is_some() {
            let [(missing, _), (there, _)] = if critical.is_none() { given } else { [given[1], given[0]] };
            let path = at.key(missing);
            let fix = format!("give both, or remove {there}");
            self.problem(&path, format!("{path} is missing"), &"", &format!("required by {there}"), &fix);
        }
        if let Some(critical) = critical {
            let allowed = format!("0 <= critical_friction_angle_deg <= friction_angle_deg = {}", text(peak));
            let holds = critical >= 0.0 && (critical <= peak || !peak.is_finite());
            let path = at.key("critical_friction_angle_deg");
            self.require(&path, critical, holds, &allowed, "use the smaller angle here: friction falls from the peak");
            if material.cone == Some(Cone::AsPrinted) {
                let allowed =
                    "not with cone = \"as_printed\", whose strength without pressure is no cohesion that could fall";
                self.not_allowed(&path, &critical, allowed, "use another cone, or remove the line");
            }
        }
        if let Some(over) = over {
            self.positive(&at.key("softening_strain"), over, 0.1);
        }
    }

    fn von_mises(&mut self, at: &KeyPath, material: &Material) {
        if let Some(strength) = self.required(at, "shear_strength_pa", material.shear_strength_pa, material.law, "2000")
        {
            self.positive(&at.key("shear_strength_pa"), strength, 2000.0);
        }
        for (key, number) in [("hardening_pa", material.hardening_pa), ("viscosity_pa_s", material.viscosity_pa_s)] {
            self.not_negative(&at.key(key), number.unwrap_or(0.0), 0.0);
        }
    }

    fn mu_i(&mut self, at: &KeyPath, material: &Material) {
        let law = material.law;
        let least = self.required(at, "mu_s", material.mu_s, law, "0.38");
        if let Some(least) = least {
            self.not_negative(&at.key("mu_s"), least, 0.38);
        }
        if let Some(most) = self.required(at, "mu_2", material.mu_2, law, "0.64") {
            let least = least.unwrap_or(0.0);
            let allowed = format!(
                "mu_s = {} <= mu_2 < 1: at 1 no compressive stress reaches the cone when the material flows in plane strain",
                text(least)
            );
            self.require(&at.key("mu_2"), most, most >= least && most < 1.0, &allowed, "use a value such as 0.64");
        }
        let above_zero =
            [("i_0", material.i_0, "0.279", 0.279), ("grain_diameter_m", material.grain_diameter_m, "5.3e-4", 5.3e-4)];
        for (key, number, example, such_as) in above_zero {
            if let Some(number) = self.required(at, key, number, law, example) {
                self.positive(&at.key(key), number, such_as);
            }
        }
        let key = "grain_density_kg_per_m3";
        if let Some(grains) = self.required(at, key, material.grain_density_kg_per_m3, law, "2450") {
            let bulk = material.density_kg_per_m3;
            let allowed =
                format!("density_kg_per_m3 = {} or more: grains and voids are lighter than grains", text(bulk));
            self.require(
                &at.key(key),
                grains,
                grains >= bulk && grains > 0.0,
                &allowed,
                "use the density of the grains, such as 2450",
            );
        }
    }

    /// Keys that the law does not use.
    fn unused(&mut self, at: &KeyPath, m: &Material) {
        const FRICTIONAL: &[Law] = &[Law::DruckerPrager, Law::MohrCoulomb];
        const GRANULAR: &[Law] = &[Law::DruckerPrager, Law::MohrCoulomb, Law::MuI];
        let given: [(&str, bool, &[Law]); 17] = [
            ("friction_angle_deg", m.friction_angle_deg.is_some(), FRICTIONAL),
            ("cohesion_pa", m.cohesion_pa.is_some(), FRICTIONAL),
            ("dilatancy_angle_deg", m.dilatancy_angle_deg.is_some(), FRICTIONAL),
            ("cone", m.cone.is_some(), &[Law::DruckerPrager]),
            ("tension_cutoff_pa", m.tension_cutoff_pa.is_some(), FRICTIONAL),
            ("void_tracking", m.void_tracking.is_some(), GRANULAR),
            ("critical_friction_angle_deg", m.critical_friction_angle_deg.is_some(), FRICTIONAL),
            ("pore_pressure_ratio", m.pore_pressure_ratio.is_some(), &[Law::DruckerPrager]),
            ("softening_strain", m.softening_strain.is_some(), FRICTIONAL),
            ("shear_strength_pa", m.shear_strength_pa.is_some(), &[Law::VonMises]),
            ("hardening_pa", m.hardening_pa.is_some(), &[Law::VonMises]),
            ("viscosity_pa_s", m.viscosity_pa_s.is_some(), &[Law::VonMises]),
            ("mu_s", m.mu_s.is_some(), &[Law::MuI]),
            ("mu_2", m.mu_2.is_some(), &[Law::MuI]),
            ("i_0", m.i_0.is_some(), &[Law::MuI]),
            ("grain_diameter_m", m.grain_diameter_m.is_some(), &[Law::MuI]),
            ("grain_density_kg_per_m3", m.grain_density_kg_per_m3.is_some(), &[Law::MuI]),
        ];
        for (key, _, laws) in given.into_iter().filter(|(_, given, laws)| *given && !laws.contains(&m.law)) {
            let path = at.key(key);
            let what = format!("{path} is not used by law = {}", toml_text(&m.law));
            let names: Vec<String> = laws.iter().map(toml_text).collect();
            let fix = format!("remove the line, or use law = {}", names[0]);
            self.problem(&path, what, &"", &format!("only with law = {}", names.join(" or ")), &fix);
        }
    }
}

/// The Mohr-Coulomb friction angle from which a cone no longer limits isochoric plane flow, degrees.
///
/// A cone q = M p has, in plane strain without dilatancy, sin(phi) = M / sqrt(3). Through the compression corners,
/// M = 6 sin(phi) / (3 - sin(phi)), which reaches sqrt(3) at sin(phi) = 3 sqrt(3) / (6 + sqrt(3)), 42.2 degrees. The other
/// cones stay below.
fn largest_friction_angle_deg(cone: Cone) -> f64 {
    let root = 3.0_f64.sqrt();
    match cone {
        Cone::TriaxialCompression => (3.0 * root / (6.0 + root)).asin().to_degrees(),
        Cone::TriaxialExtension | Cone::PlaneStrain | Cone::AsPrinted => 90.0,
    }
}
