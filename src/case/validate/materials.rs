//! Materials.

use super::{Checker, text};
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
            match material.law {
                Law::DruckerPrager => self.drucker_prager(&at, material),
                Law::LinearElastic => self.only_elastic(&at, material, "linear_elastic"),
                Law::NeoHookean => self.only_elastic(&at, material, "neo_hookean"),
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

    fn drucker_prager(&mut self, at: &KeyPath, material: &Material) {
        let zero_or_more = [("cohesion_pa", material.cohesion_pa), ("tension_cutoff_pa", material.tension_cutoff_pa)];
        for (key, number) in zero_or_more {
            self.not_negative(&at.key(key), number.unwrap_or(0.0), 0.0);
        }
        let path = at.key("friction_angle_deg");
        let Some(friction) = material.friction_angle_deg else {
            let what = format!("{path} is missing");
            let fix = "add a line such as friction_angle_deg = 31";
            return self.problem(&path, what, &"", "required by law = \"drucker_prager\"", fix);
        };
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
    }

    fn only_elastic(&mut self, at: &KeyPath, material: &Material, law: &str) {
        let given = [
            ("friction_angle_deg", material.friction_angle_deg.is_some()),
            ("cohesion_pa", material.cohesion_pa.is_some()),
            ("dilatancy_angle_deg", material.dilatancy_angle_deg.is_some()),
            ("cone", material.cone.is_some()),
            ("tension_cutoff_pa", material.tension_cutoff_pa.is_some()),
            ("void_tracking", material.void_tracking.is_some()),
        ];
        for (key, _) in given.into_iter().filter(|(_, given)| *given) {
            let path = at.key(key);
            let what = format!("{path} is not used by law = \"{law}\"");
            let fix = "remove the line, or use law = \"drucker_prager\"";
            self.problem(&path, what, &"", "only with law = \"drucker_prager\"", fix);
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
