//! Cases that can be run and whose numbers would mean little: nothing holds the material, a barrier is loose or too thin for the
//! grid, PIC takes the motion.

use super::bodies::MASS_TOLERANCE;
use super::shapes::has_geometry;
use super::walls::narrow_openings;
use super::{Problem, text, text_down, toml_text};
use crate::case::boundary::{Boundary, ContactKind};
use crate::case::path::KeyPath;
use crate::case::schema::{Body, Case, Kinematics};
use crate::simulation::PicShare;

/// A structure needs so many cells through its depth (`docs/limits.md`, rung `cantilever`).
const STRUCTURE_CELLS: f64 = 6.0;
/// The same of one that moves by a mesh of its own.
const MESH_CELLS: f64 = 2.0;
/// Half of a motion's energy is gone after this many times of decay.
const HALF: f64 = std::f64::consts::LN_2;

/// All of them.
pub(super) fn doubts(case: &Case) -> Vec<Problem> {
    let mut found = Vec::new();
    found.extend(unsupported(case));
    found.extend(pic(case));
    for (index, body) in case.bodies.iter().enumerate().filter(|(_, b)| has_geometry(b)) {
        let at = KeyPath::top("bodies").index(index);
        found.extend(loose(case, &at, body));
        found.extend(thin(case, &at, body));
        found.extend(filled_beside(case, &at, body));
    }
    found
}

/// Openings and structures of too few cells, a sentence each.
pub fn too_few_cells(case: &Case) -> Vec<String> {
    let bodies = case.bodies.iter().enumerate().filter(|(_, body)| has_geometry(body));
    let structures = bodies.filter_map(|(k, body)| thin(case, &KeyPath::top("bodies").index(k), body));
    narrow_openings(case).into_iter().chain(structures).map(|problem| problem.what).collect()
}

/// Gravity and not one boundary.
fn unsupported(case: &Case) -> Option<Problem> {
    let falls = case.gravity.magnitude_m_per_s2 > 0.0 && case.bodies.iter().any(|b| !b.weightless);
    (case.boundaries.is_empty() && falls).then(|| Problem {
        path: KeyPath::top("bodies"),
        what: "the case has no boundary: everything falls out of the domain".to_owned(),
        value: String::new(),
        allowed: "at least one of [[boundaries]] where gravity acts".to_owned(),
        fix: "add [[boundaries]] with a base: kind = \"plane\"".to_owned(),
    })
}

/// Whether a body is a barrier whose force is measured.
fn is_barrier(case: &Case, body: &Body) -> bool {
    case.gauges.barrier_names().any(|name| name == body.name)
}

/// A barrier that is a body and that nothing holds.
fn loose(case: &Case, at: &KeyPath, body: &Body) -> Option<Problem> {
    let touches = |b: &Boundary| {
        // Points lie up to half a cell inside the edge.
        Some(b.penetration(body, &case.grid)?.depth_m > -0.5 * case.grid.spacing_m)
    };
    let clamps = |b: &&Boundary| b.acts_on(&body.name) && b.contact == ContactKind::Bonded;
    let held = case.boundaries.iter().filter(clamps).any(|b| touches(b).unwrap_or(true));
    (is_barrier(case, body) && !held).then(|| Problem {
        path: at.key("name"),
        what: format!("no clamp holds the barrier `{}`", body.name),
        value: String::new(),
        allowed: "a boundary with contact = \"bonded\" that reaches a barrier, unless it may slide away".to_owned(),
        fix: format!("add [[boundaries]] with contact = \"bonded\" and bodies = [\"{}\"]", body.name),
    })
}

/// A square lattice that carries another mass than the body, by more than `mass_kg` may be off.
fn filled_beside(case: &Case, at: &KeyPath, body: &Body) -> Option<Problem> {
    body.rectangle()?;
    let ([length, height], lattice) = (body.size_m(), body.lattice(&case.grid));
    let filled: f64 = (0..2).map(|d| lattice.counts[d] * lattice.spacing_m[d]).product();
    let share = filled / (length * height);
    ((share - 1.0).abs() > MASS_TOLERANCE).then(|| Problem {
        path: at.key("name"),
        what: format!("the particles of `{}` carry {} times its mass", body.name, text(share)),
        value: String::new(),
        allowed: "cells that divide both sides, or grid.filling = \"fitted\"".to_owned(),
        fix: "use grid.filling = \"fitted\"".to_owned(),
    })
}

/// A structure of few cells, which bends too easily or tears.
fn thin(case: &Case, at: &KeyPath, body: &Body) -> Option<Problem> {
    let [length, height] = body.size_m();
    let depth = length.min(height);
    let cells = depth / case.grid.spacing_m;
    let elastic = case.materials.get(&body.material).is_some_and(|m| !m.law.flows());
    let key = match (body.foot_m, length <= height) {
        (None, true) => "x_m",
        (None, false) => "y_m",
        (Some(_), true) => "thickness_m",
        (Some(_), false) => "height_m",
    };
    let value =
        body.x_m.zip(body.y_m).map_or(toml_text(&depth), |(x, y)| toml_text(&if length <= height { x } else { y }));
    let least = if body.kinematics == Kinematics::TotalLagrangian { MESH_CELLS } else { STRUCTURE_CELLS };
    let few = is_barrier(case, body) && elastic && cells < least * (1.0 - 1.0e-9);
    few.then(|| Problem {
        path: at.key(key),
        what: format!("the barrier `{}` is {} cells thick", body.name, text(cells)),
        value,
        allowed: format!("{} cells or more through a body that bends", text(least)),
        fix: format!("use grid.spacing_m = {} or less, or read only whether it holds", text_down(depth / least)),
    })
}

/// A share of PIC that brakes the flow as a whole. A share a in each step is a viscosity C a h^2 / dt, with
/// C = 1/6 + 1/(12 n^2) for n points a cell and direction ([`theory::pic`](crate::theory::pic)). The energy of a motion with the wave
/// number k = pi / D decays by the exponent 2 nu k^2 t. Where half of it is gone in the time t = sqrt(D / g) in which a depth D falls
/// through itself, it is PIC that moves the material.
fn pic(case: &Case) -> Option<Problem> {
    let (h, g, dt) = (case.grid.spacing_m, case.gravity.magnitude_m_per_s2, case.time_step_estimate_s());
    let (key, value, rate) = match case.numerics.pic() {
        PicShare::Fraction(share) => ("pic_fraction", share, share / dt),
        PicShare::Rate(rate) => ("pic_rate_per_s", rate, rate),
    };
    let loss = |body: &Body| {
        let n = f64::from(body.particles_per_cell(&case.grid)).sqrt();
        let [length, height] = body.size_m();
        let depth = length.min(height);
        let viscosity = (1.0 / 6.0 + 1.0 / (12.0 * n * n)) * rate * h * h;
        2.0 * viscosity * (std::f64::consts::PI / depth).powi(2) * (depth / g).sqrt()
    };
    let flows = |b: &&Body| case.materials.get(&b.material).is_some_and(|m| m.law.flows());
    // Flows that enter are long.
    let entering = case.inflows.iter().map(|i| (i.deepest_m(), i.behind(&case.grid)));
    let entering = entering.map(|(deep, behind)| loss(&Body { x_m: Some([0.0, 10.0 * deep]), ..behind }));
    let bodies = case.bodies.iter().filter(|b| has_geometry(b)).filter(flows).map(loss);
    let largest = bodies.chain(entering).fold(0.0, f64::max);
    (largest > HALF && g > 0.0).then(|| {
        let path = KeyPath::top("numerics").key(key);
        Problem {
            what: format!("{path} = {} brakes the flow by itself", toml_text(&value)),
            path,
            value: toml_text(&value),
            allowed: format!(
                "at most {} here, which takes half of the motion while the material falls through its own depth",
                text_down(value * HALF / largest)
            ),
            fix: format!("use {key} = {} or less", text_down(0.01 * value * HALF / largest)),
        }
    })
}
