//! Values that can be run and look like mistakes, mostly of units.

use super::doubts::doubts;
use super::walls::narrow_openings;
use super::{Problem, text, toml_text};
use crate::case::angle::direction;
use crate::case::boundary::{Boundary, Shape};
use crate::case::geometry::penetration_of_rectangle;
use crate::case::grid::Domain;
use crate::case::material::Material;
use crate::case::path::KeyPath;
use crate::case::schema::{Body, Case};

/// An angle in degrees below this and above zero was probably meant in radians.
const RADIANS_UP_TO: f64 = 1.6;

/// Lighter than foamed polystyrene and fresh snow, and as many kg/m3 as the heaviest solids have g/cm3.
const LIGHTEST: f64 = 25.0;
/// Heavier than any solid (osmium, 22590 kg/m3).
const HEAVIEST: f64 = 22_600.0;

struct Warnings(Vec<Problem>);

impl Warnings {
    fn add_if(&mut self, holds: bool, path: &KeyPath, value: f64, expected: &str, fix: &str) {
        if holds {
            self.0.push(Problem {
                path: path.clone(),
                what: format!("{path} = {} looks like a mistake", toml_text(&value)),
                value: toml_text(&value),
                allowed: expected.to_owned(),
                fix: fix.to_owned(),
            });
        }
    }

    fn radians(&mut self, path: &KeyPath, angle: Option<f64>) {
        let Some(angle) = angle else { return };
        let fix = format!("if the angle is in radians, write {} degrees", text(angle.to_degrees()));
        let holds = angle > 0.0 && angle < RADIANS_UP_TO;
        self.add_if(holds, path, angle, "angles are in degrees", &fix);
    }

    fn coefficient(&mut self, at: &KeyPath, friction: f64) {
        let fix = format!("if it is an angle, write its tangent, {}", text(friction.to_radians().tan()));
        let fix = if friction < 90.0 { &fix } else { "write the tangent of the angle of friction" };
        self.add_if(friction > 2.0, &at.key("friction"), friction, "a coefficient, not an angle", fix);
    }

    fn material(&mut self, at: &KeyPath, material: &Material) {
        let young = material.young_pa;
        let fix = format!("if the value is in MPa, write {}", text(young * 1.0e6));
        self.add_if(young < 1.0e3, &at.key("young_pa"), young, "Pa; soils have 1e5 to 1e9", &fix);

        let density = material.density_kg_per_m3;
        let fix = if density < LIGHTEST {
            format!("if the value is in g/cm^3 or t/m^3, write {}", text(density * 1000.0))
        } else {
            "check the unit".to_owned()
        };
        let holds = !(LIGHTEST..=HEAVIEST).contains(&density);
        self.add_if(holds, &at.key("density_kg_per_m3"), density, "kg/m^3; dry sand has about 1500", &fix);

        if let Some(law) = material.frictional() {
            let friction = law.friction_angle_deg;
            let fix = format!("if the angle is in radians, write {} degrees", text(friction.to_degrees()));
            let holds = friction > 0.0 && friction < 1.0;
            self.add_if(holds, &at.key("friction_angle_deg"), friction, "degrees; sand has about 30", &fix);

            let apex = law.cohesion_pa / friction.to_radians().tan();
            let holds = friction > 0.0 && law.tension_cutoff_pa > apex * (1.0 + 1.0e-9);
            let expected = format!("at most the apex of the cone, cohesion / tan(friction angle) = {} Pa", text(apex));
            let fix = "lower it, or raise cohesion_pa: above the apex it has no effect";
            self.add_if(holds, &at.key("tension_cutoff_pa"), law.tension_cutoff_pa, &expected, fix);
        }
    }
}

impl Warnings {
    /// A wall outside the domain meets nothing.
    fn outside(&mut self, at: &KeyPath, case: &Case, boundary: &Boundary) {
        let Some(Shape::Wall(wall) | Shape::Gate(wall, _)) = boundary.shape(&case.grid) else {
            return;
        };
        let Domain { x_m: [left, right], y_m: [low, high] } = case.domain;
        let domain = [[left, low], [right, low], [right, high], [left, high]];
        if penetration_of_rectangle(&wall.corners_m(), &domain).depth_m <= 0.0 {
            self.0.push(Problem {
                path: at.key("foot_m"),
                what: format!("boundary `{}` is outside the domain", boundary.name),
                value: toml_text(&wall.foot_m),
                allowed: "a wall that material can reach".to_owned(),
                fix: "move the wall, or enlarge the domain".to_owned(),
            });
        }
    }
}

/// A fill may reach up to a gate's crest that lies on a grid line, and to one cell below any other.
const BELOW_CREST_CELLS: f64 = 1.0;

impl Warnings {
    /// A gate whose crest lies between two rows of nodes: sand that reaches up to it creeps over it, and may not come to rest, since the
    /// row above the crest is held by nothing.
    fn brim(&mut self, at: &KeyPath, case: &Case, boundary: &Boundary) {
        let Some(Shape::Gate(gate, _)) = boundary.shape(&case.grid) else { return };
        let h = case.grid.spacing_m;
        let (along, normal) = (direction(gate.inclination_deg), gate.normal());
        let on_line = (0..2).any(|d| {
            let crest = gate.foot_m[d] + gate.height_m * along[d];
            let cells = (crest - case.grid.origin_m[d]) / h;
            along[d].abs() == 1.0 && (cells - cells.round()).abs() < 1.0e-6
        });
        let sand = |body: &Body| case.materials.get(&body.material).is_some_and(|m| m.law.flows());
        for body in case.bodies.iter().filter(|b| !on_line && boundary.acts_on(&b.name) && sand(b)) {
            let Some(drawing) = body.drawing() else { continue };
            let least = |way: [f64; 2]| {
                let nearest = drawing.farthest_m(way.map(|x| -x));
                (nearest[0] - gate.foot_m[0]) * way[0] + (nearest[1] - gate.foot_m[1]) * way[1]
            };
            let (gap, low, top) = (least(normal), least(along), -least([-along[0], -along[1]]));
            let brim = gate.height_m - BELOW_CREST_CELLS * h;
            if gap.abs() < h && low < gate.height_m && top > brim + 1.0e-6 * h {
                let height = text(((top + BELOW_CREST_CELLS * h) * 1000.0).ceil() / 1000.0);
                self.0.push(Problem {
                    path: at.key("height_m"),
                    what: format!(
                        "{} = {} looks like a mistake: `{}` reaches up to {} m along the gate, and would run over its crest",
                        at.key("height_m"),
                        toml_text(&gate.height_m),
                        body.name,
                        text(top)
                    ),
                    value: toml_text(&gate.height_m),
                    allowed: "a crest on a grid line, or one cell above the material: nothing holds the row of nodes above it".to_owned(),
                    fix: format!("raise the gate: height_m = {height}"),
                });
            }
        }
    }
}

/// All of them; those that need a case that makes sense only for one.
pub(super) fn warnings(case: &Case, valid: bool) -> Vec<Problem> {
    let mut warnings = Warnings(Vec::new());
    let gravity = KeyPath::top("gravity");
    warnings.radians(&gravity.key("inclination_deg"), Some(case.gravity.inclination_deg));
    warnings.radians(&gravity.key("settle_inclination_deg"), case.gravity.settle_inclination_deg);
    for (name, material) in &case.materials {
        warnings.material(&KeyPath::top("materials").key(name), material);
    }
    for (index, boundary) in case.boundaries.iter().enumerate() {
        let at = KeyPath::top("boundaries").index(index);
        warnings.radians(&at.key("normal_deg"), boundary.normal_deg);
        warnings.radians(&at.key("inclination_deg"), boundary.inclination_deg);
        warnings.coefficient(&at, boundary.friction.unwrap_or(0.0));
        if valid {
            warnings.outside(&at, case, boundary);
            warnings.brim(&at, case, boundary);
        }
    }
    for (index, contact) in case.contacts.iter().enumerate() {
        warnings.coefficient(&KeyPath::top("contacts").index(index), contact.friction);
    }
    warnings.coefficient(&KeyPath::top("side_walls"), case.side_walls.friction);
    if valid {
        warnings.0.extend(narrow_openings(case));
        warnings.0.extend(doubts(case));
    }
    if let Some(tilt) = &case.stages.tilt {
        let turn = case.gravity.inclination_deg - case.gravity.settle_inclination_or_default_deg();
        let path = KeyPath::top("stages").key("tilt").key("duration_s");
        let expected = "a tilt from gravity.settle_inclination_deg to another gravity.inclination_deg";
        let fix = "give settle_inclination_deg, or leave [stages.tilt] out";
        warnings.add_if(turn == 0.0, &path, tilt.duration_s, expected, fix);
    }
    warnings.0
}
