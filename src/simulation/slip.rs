//! The memory of boundaries whose friction needs slip: it travels on the material points.
//!
//! A crossing knows the mean of what the points that its nodes see remember. What slips there in a step, these points add to their
//! own. A memory on the grid would be left behind by sliding material, and with it a part of the friction.
//!
//! Elsewhere: history variables of contact, transferred to the slave points; a Lagrangian interface state.

use super::field::VelocityField;
use crate::body::Slip;
use crate::boundary::Boundary;
use crate::boundary::slip::{SlipLaw, Slipped};
use crate::boundary::surface::Site;
use crate::lanes::LANES;
use crate::shape::ShapeFunction;
use crate::shape::stencil::Stencil;
use crate::space::{clockwise, dot, plus, scaled};

/// Distance from a surface within which points are watched until the next sort, cells: a stencil, a crossing, and the drift.
const WATCHED: f64 = 4.0;
/// Tangents whose scalar product is larger belong to one surface; others meet in a corner.
const SMOOTH: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Most surfaces that a point touches at once.
const SURFACES: usize = 3;

/// What a node gives to a crossing: velocity field and node, then number and share.
type Seen = (usize, u32, usize, f64);

/// Points that may touch a boundary whose friction needs slip.
#[derive(Debug, Clone, Copy)]
struct Watched {
    field: usize,
    band: usize,
    body: usize,
    block: usize,
}

/// What the points around a crossing remember, by weight.
#[derive(Debug, Clone, Copy, Default)]
struct Remembered {
    weight: f64,
    elastic: f64,
    worn: f64,
}

/// A surface that a point touches.
#[derive(Debug, Clone, Copy)]
struct Touched {
    law: SlipLaw,
    tangent: [f64; 2],
    /// Weight of the crossings that press, and slip by it.
    weight: f64,
    moved: [f64; 2],
}

/// Which crossings see which points.
#[derive(Debug, Clone, Default)]
pub(super) struct Slips {
    /// In order.
    seen: Vec<Seen>,
    /// For each field, where the crossings of each of its nodes begin in the list above.
    first: Vec<Vec<u32>>,
    watched: Vec<Watched>,
    sums: Vec<Remembered>,
}

impl Slips {
    /// Forgets the crossings of an old layout of so many fields.
    pub fn clear(&mut self, fields: usize) {
        self.seen.clear();
        self.first.resize_with(fields, Vec::new);
    }

    /// Notes a crossing by its number; its nodes are still those of the field.
    pub fn add(&mut self, field: usize, number: usize, site: &Site) {
        if site.slip_law().is_some() {
            self.seen.extend(site.weights().map(|(node, share)| (field, node, number, share)));
        }
    }

    /// Finds the points near the surfaces; all others forget.
    pub fn find(&mut self, fields: &mut [VelocityField], boundaries: &[Boundary], sites: usize) {
        self.watched.clear();
        self.sums.clear();
        self.sums.resize(if self.seen.is_empty() { 0 } else { sites }, Remembered::default());
        let surfaces: Vec<&Boundary> = boundaries.iter().filter(|b| b.slip.is_some()).collect();
        if surfaces.is_empty() {
            return;
        }
        self.seen.sort_unstable_by_key(|&(field, node, number, _)| (field, node, number));
        for (f, field) in fields.iter_mut().enumerate() {
            let first = &mut self.first[f];
            first.clear();
            if self.seen.iter().any(|s| s.0 == f) {
                let begin = |node: u32| self.seen.partition_point(|s| (s.0, s.1) < (f, node)) as u32;
                first.extend((0..=field.grid.len() as u32).map(begin));
            }
            let reach = WATCHED * field.grid.spacing;
            let near = |x: [f64; 2]| surfaces.iter().any(|b| b.depth(x) > -reach);
            for (band, b) in field.bands.iter_mut().enumerate() {
                for (body, points) in b.points.iter_mut().enumerate() {
                    for block in 0..points.block_count() {
                        if (0..points.points_in(block)).any(|l| near(points.position(block * LANES + l))) {
                            self.watched.push(Watched { field: f, band, body, block });
                        } else if !points.is_unslipped() {
                            points.slips_mut()[block] = Default::default();
                        }
                    }
                }
            }
        }
    }

    /// Lets the crossings know what the points remember at the beginning of a step of `dt` (s).
    pub fn recall(&mut self, fields: &[VelocityField], shape: ShapeFunction, sites: &mut [Site], dt: f64) {
        if self.seen.is_empty() {
            return;
        }
        let Self { seen, first, watched, sums } = self;
        sums.fill(Remembered::default());
        for at in watched.iter() {
            let field = &fields[at.field];
            let mass = field.bodies[at.body].point_mass;
            let points = &field.bands[at.band].points[at.body];
            let memory = points.slip(at.block);
            for (l, slip) in memory.iter().enumerate().take(points.points_in(at.block)) {
                let x = points.position(at.block * LANES + l);
                for_each(field, &first[at.field], seen, shape, at.body, x, |site, weight| {
                    let tangent = clockwise(sites[site].normal);
                    let (sum, weight) = (&mut sums[site], mass * weight);
                    sum.weight += weight;
                    sum.elastic += weight * dot(slip.elastic, tangent);
                    sum.worn += weight * slip.worn;
                });
            }
        }
        for (site, sum) in sites.iter_mut().zip(sums.iter()) {
            let per = if sum.weight > 0.0 { 1.0 / sum.weight } else { 0.0 };
            site.recall(Slipped { elastic: sum.elastic * per, worn: sum.worn * per }, dt);
        }
    }

    /// Lets the points remember what slipped. What touches no surface any more forgets.
    pub fn remember(&self, fields: &mut [VelocityField], shape: ShapeFunction, sites: &[Site]) {
        if self.seen.is_empty() {
            return;
        }
        for at in &self.watched {
            let points = &fields[at.field].bands[at.band].points[at.body];
            let mut memory = points.slip(at.block);
            for (l, slip) in memory.iter_mut().enumerate().take(points.points_in(at.block)) {
                let x = points.position(at.block * LANES + l);
                let mut touched = [None; SURFACES];
                for_each(&fields[at.field], &self.first[at.field], &self.seen, shape, at.body, x, |site, weight| {
                    touch(&mut touched, &sites[site], weight);
                });
                *slip = after(*slip, &touched);
            }
            let points = &mut fields[at.field].bands[at.band].points[at.body];
            if !points.is_unslipped() || memory.iter().any(|m| *m != Slip::default()) {
                points.slips_mut()[at.block] = memory;
            }
        }
    }
}

/// Calls `visit` with each crossing that sees a point of a body at `x`, and its weight there.
fn for_each(
    field: &VelocityField,
    first: &[u32],
    seen: &[Seen],
    shape: ShapeFunction,
    body: usize,
    x: [f64; 2],
    mut visit: impl FnMut(usize, f64),
) {
    let grid = &field.grid;
    if first.is_empty() {
        return;
    }
    let half_width = shape.half_width(field.bodies[body].points_per_direction);
    let stencil = Stencil::new(x, grid.corner, grid.inverse_spacing, half_width);
    let [column, row] = stencil.start;
    stencil.nodes(|[a, b], weight, _| {
        let node = grid.node(column as usize + a, row + b as i32) as usize;
        let Some(&[from, to]) = first.get(node..node + 2) else { return };
        for &(_, _, site, share) in &seen[from as usize..to as usize] {
            visit(site, share * weight);
        }
    });
}

/// Adds a crossing to the surfaces that a point touches.
fn touch(touched: &mut [Option<Touched>; SURFACES], site: &Site, weight: f64) {
    let Some(law) = site.slip_law() else { return };
    let tangent = clockwise(site.normal);
    let same = |t: &Touched| dot(t.tangent, tangent).abs() > SMOOTH;
    let Some(place) = touched.iter_mut().find(|t| t.as_ref().is_none_or(same)) else { return };
    let place = place.get_or_insert(Touched { law: *law, tangent, weight: 0.0, moved: [0.0; 2] });
    if let Some(moved) = site.slip_moved() {
        (place.law, place.tangent) = (*law, tangent);
        place.weight += weight;
        place.moved = plus(place.moved, scaled(moved, weight));
    }
}

/// The slip of a point after a step on these surfaces.
fn after(slip: Slip, touched: &[Option<Touched>; SURFACES]) -> Slip {
    let mut now = slip;
    for t in touched.iter().flatten() {
        let along = dot(now.elastic, t.tangent);
        let moved = if t.weight > 0.0 { dot(t.moved, t.tangent) / t.weight } else { 0.0 };
        let next = t.law.after(Slipped { elastic: along, worn: now.worn }, moved);
        now = Slip { elastic: plus(now.elastic, scaled(t.tangent, next.elastic - along)), worn: next.worn };
    }
    match touched {
        [None, ..] => Slip::default(),
        // On one surface, slip is along it.
        [Some(t), None, _] => Slip { elastic: scaled(t.tangent, dot(now.elastic, t.tangent)), ..now },
        _ => now,
    }
}
