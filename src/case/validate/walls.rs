//! Walls, plates and openings that a grid cannot carry.

use super::{Checker, Problem, text, text_down, toml_text};
use crate::boundary::BoundaryContact;
use crate::case::angle::direction;
use crate::case::boundary::{Boundary, BoundaryKind, ContactKind, Wall};
use crate::case::path::KeyPath;
use crate::case::schema::Case;

/// A wall that acts at the nodes inside it needs so many cells of thickness: two rows that hold what comes from its face, and one for
/// its back. A gate has no back.
const WALL_CELLS: (f64, &str) = (3.0, "three cells");
const GATE_CELLS: (f64, &str) = (1.0, "one cell");
/// A wall lower than this is not seen by the flow.
const LEAST_HEIGHT_CELLS: f64 = 1.0;
/// A wall higher than this has no use: no domain is as large.
const LARGEST_HEIGHT_CELLS: f64 = 1.0e6;
/// Openings narrower than so many cells let through another share of the material on another grid.
const OPENING_CELLS: f64 = 12.0;

impl Checker<'_> {
    /// Refuses walls and gates that hold nothing.
    pub(super) fn walls(&mut self) {
        let h = self.case.grid.spacing_m;
        let at_nodes = self.case.numerics.boundary_contact == BoundaryContact::Nodes;
        for (index, boundary) in self.case.boundaries.iter().enumerate() {
            let at = KeyPath::top("boundaries").index(index);
            if [BoundaryKind::Plane, BoundaryKind::Polyline].contains(&boundary.kind) {
                continue;
            }
            let path = at.key("thickness_m");
            if let Some(thickness) = boundary.thickness_m
                && boundary.contact != ContactKind::Bonded
                && at_nodes
            {
                let (cells, words) = if boundary.kind == BoundaryKind::Gate { GATE_CELLS } else { WALL_CELLS };
                let least = cells * h;
                let allowed = format!("{} m or more, {words}: this contact acts at the nodes inside", text(least));
                let fix = "use numerics.boundary_contact = \"surface\", a thicker wall, or a finer grid";
                self.require(&path, thickness, thickness >= least * (1.0 - 1e-9), &allowed, fix);
            } else {
                self.not_negative(&path, boundary.thickness_m.unwrap_or(0.1), 0.1);
            }
            if let Some(height) = boundary.height_m {
                let least = LEAST_HEIGHT_CELLS * h;
                let allowed = format!("{} m or more, one cell: the flow does not see a lower wall", text(least));
                let fix = "refine the grid, or leave the wall out";
                self.require(&at.key("height_m"), height, height <= 0.0 || height >= least, &allowed, fix);
                let most = LARGEST_HEIGHT_CELLS * h;
                let allowed =
                    format!("at most {} m, {LARGEST_HEIGHT_CELLS:e} cells: pressures are kept for each", text(most));
                let fix = format!("use height_m = {} or less, or a plane", text_down(most));
                self.require(&at.key("height_m"), height, h <= 0.0 || height <= most, &allowed, &fix);
            }
        }
    }
}

/// Openings that are narrow for the grid: below a gate that is raised, and below a wall that hangs.
pub(super) fn narrow_openings(case: &Case) -> Vec<Problem> {
    let h = case.grid.spacing_m;
    let problem = |path: KeyPath, value: String, of: &str, open: f64| Problem {
        what: format!("{path} = {value} leaves {} m open below {of}: {} cells", text(open), text(open / h)),
        path,
        value,
        allowed: format!(
            "{} cells or more: through fewer, the flow that passes depends on the grid",
            text(OPENING_CELLS)
        ),
        fix: format!("use cells of {} m or less, and compare two grids", text_down(open / OPENING_CELLS)),
    };
    let narrow = |open: f64| open > 0.0 && open < OPENING_CELLS * h * (1.0 - 1e-9);
    let mut found = Vec::new();
    for (index, boundary) in case.boundaries.iter().enumerate() {
        let at = KeyPath::top("boundaries").index(index);
        if let Some(open) = boundary.opening_m.filter(|open| narrow(*open)) {
            found.push(problem(at.key("opening_m"), toml_text(&open), &format!("gate `{}`", boundary.name), open));
        }
        let Some(wall) = boundary.wall(&case.grid).filter(|_| boundary.kind != BoundaryKind::Plane) else { continue };
        let clear = case.boundaries.iter().filter_map(|plane| clearance(&wall, plane)).fold(f64::INFINITY, f64::min);
        if narrow(clear) {
            found.push(problem(at.key("foot_m"), toml_text(&wall.foot_m), &format!("`{}`", boundary.name), clear));
        }
    }
    found
}

/// How far the foot of a wall lies above a plane, along the wall, m; `None` for other boundaries and planes that it does not point
/// at.
fn clearance(wall: &Wall, plane: &Boundary) -> Option<f64> {
    let (point, normal) = (plane.point_m?, direction(plane.normal_deg?));
    let along = direction(wall.inclination_deg);
    let toward = along[0] * normal[0] + along[1] * normal[1];
    let above = (wall.foot_m[0] - point[0]) * normal[0] + (wall.foot_m[1] - point[1]) * normal[1];
    (toward > 0.1).then(|| above / toward)
}
