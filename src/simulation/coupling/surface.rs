//! The surface between two bodies: where it is in reach of the grid, which way it faces, whether they touch.

use super::faces::Batch;
use super::scan::{Marks, Near};
use super::{Pending, SharedNode, SharedSide, VelocityField};
use crate::contact::normal::{Sample, from_difference, from_larger, from_positions};
use crate::contact::outline::{Nearest, Outline, Surface};
use crate::contact::rule::{ContactRule, ContactTally, GapRule, NormalRule};
use crate::contact::{Vector, regression, separation};
use crate::seeded::{self, Seed};
use crate::shape::ShapeFunction;
use crate::space::{direction, dot, minus, norm, plus, scaled};

/// Points of either body that a node has room for in a regression.
const CLOUD: usize = 64;

/// A node where two bodies may meet, and what is seen of them there in a step.
#[derive(Debug, Clone, Default)]
struct View {
    /// Which shared node, and which two of its sides.
    node: usize,
    sides: [usize; 2],
    /// Column and row in the grid of either field.
    places: [[i32; 2]; 2],
    samples: [Sample; 2],
    clouds: [Vec<Vector>; 2],
    normal: Option<Vector>,
    /// Sum of the normals at the points of the other body, by their weight.
    faces: Vector,
    /// How far either body reaches along the normal, from the node, m.
    extents: [f64; 2],
}

/// The contact of two bodies.
#[derive(Debug, Clone)]
pub(super) struct Interface {
    /// Its place among all contacts.
    number: u32,
    pub rule: ContactRule,
    /// What the bodies did to each other in the last step.
    pub tally: ContactTally,
    fields: [usize; 2],
    views: Vec<View>,
    active: Vec<usize>,
    marks: [Marks; 2],
    outline: Outline,
    /// Numbers of its points, ascending, and where each is now: its band and its place there.
    numbers: Vec<u32>,
    found: Vec<Option<(usize, usize)>>,
    surfaces: Vec<Surface>,
    /// The same for each point along the rings.
    places: Vec<(usize, usize)>,
    /// Points whose nearest face is looked for.
    batch: Batch,
    /// Positions at the start by number, m, where displacements count.
    starts: [Vec<Vector>; 2],
}

impl Interface {
    pub fn new(number: usize, rule: ContactRule, fields: &[VelocityField]) -> Self {
        let of = |body: usize| {
            let own = fields.iter().position(|f| f.members == [body]);
            own.expect("the simulation gives each body that a contact names a field of its own")
        };
        let pair = rule.bodies.map(of);
        let points = |f: usize| fields[f].particles().map(|(_, p)| (p.id, p.x)).collect::<Vec<_>>();
        let (mut outline, mut surfaces) = (Outline::default(), Vec::new());
        if let NormalRule::NearestFace(k) = rule.normal {
            let spacing = fields[pair[k]].bodies[0].point_spacing;
            let points = points(pair[k]);
            outline = Outline::trace(&points, spacing, lattice_angle(&points, spacing));
            surfaces = vec![Surface::new(0.5 * spacing); outline.rings.len()];
        }
        let starts = pair.map(|f| {
            let mut starts = Vec::new();
            if rule.gap == GapRule::Displacements {
                for (id, x) in points(f) {
                    starts.resize(starts.len().max(id as usize + 1), x);
                    starts[id as usize] = x;
                }
            }
            starts
        });
        Self {
            number: number as u32,
            rule,
            tally: ContactTally::default(),
            fields: pair,
            views: Vec::new(),
            active: Vec::new(),
            marks: Default::default(),
            numbers: outline.points(),
            found: Vec::new(),
            outline,
            surfaces,
            places: Vec::new(),
            batch: Batch::default(),
            starts,
        }
    }

    /// Number of nodes where the bodies may meet.
    pub fn len(&self) -> usize {
        self.views.len()
    }

    /// Friction coefficient.
    pub fn friction(&self) -> f64 {
        self.rule.friction
    }

    /// Changes the friction coefficient.
    pub fn set_friction(&mut self, friction: f64) {
        self.rule.friction = friction;
    }

    pub fn rebuild(&mut self, fields: &[VelocityField], nodes: &[SharedNode], sides: &[SharedSide]) {
        self.views.clear();
        for (node, shared) in nodes.iter().enumerate() {
            let own = &sides[shared.sides.clone()];
            let [Some(a), Some(b)] = self.fields.map(|f| own.iter().position(|s| s.field == f)) else { continue };
            let places = [a, b].map(|k| {
                let grid = &fields[own[k].field].grid;
                let place = grid.place(fields[own[k].field].bands[own[k].band].first_node + own[k].node);
                [(place[0] - grid.first[0]) as i32, (place[1] - grid.first[1]) as i32]
            });
            let mut view = View { node, sides: [a, b], places, ..View::default() };
            if self.rule.normal == NormalRule::Regression {
                view.clouds = [Vec::with_capacity(CLOUD), Vec::with_capacity(CLOUD)];
            }
            self.views.push(view);
        }
        self.active.clear();
        self.active.reserve(self.views.len());
        for (marks, &f) in self.marks.iter_mut().zip(&self.fields) {
            marks.rebuild(&fields[f].grid, self.views.len());
        }
        if let NormalRule::NearestFace(k) = self.rule.normal {
            self.find_outline(&fields[self.fields[k]]);
            self.batch.reserve();
        }
    }

    /// Finds the points of the outline after a sort.
    fn find_outline(&mut self, field: &VelocityField) {
        let Self { outline, numbers, found, places, .. } = self;
        found.clear();
        found.resize(numbers.len(), None);
        for (b, band) in field.bands.iter().enumerate() {
            for (i, p) in band.points[0].iter().enumerate() {
                if let Ok(k) = numbers.binary_search(&p.id) {
                    found[k] = Some((b, i));
                }
            }
        }
        // Points that left the domain leave the ring.
        for ring in &mut outline.rings {
            ring.retain(|id| numbers.binary_search(id).is_ok_and(|k| found[k].is_some()));
        }
        places.clear();
        let place = |id: &u32| numbers.binary_search(id).ok().and_then(|k| found[k]);
        places.extend(outline.rings.iter().flatten().filter_map(place));
    }

    /// Finds where the bodies touch in this step; `mass` gives the mass of a side of a shared node.
    pub fn find_touches(
        &mut self,
        fields: &[VelocityField],
        shape: ShapeFunction,
        dt: f64,
        nodes: &[SharedNode],
        mass: impl Fn(usize, usize) -> f64,
        pending: &mut Vec<Pending>,
    ) {
        self.tally = ContactTally::default();
        self.active.clear();
        for (k, view) in self.views.iter_mut().enumerate() {
            if view.sides.iter().all(|&s| mass(view.node, s) > 0.0) {
                self.active.push(k);
                view.samples = Default::default();
                view.clouds.iter_mut().for_each(Vec::clear);
                view.extents = [f64::NEG_INFINITY; 2];
                view.faces = [0.0; 2];
                for ((marks, &f), place) in self.marks.iter_mut().zip(&self.fields).zip(view.places) {
                    marks.set(&fields[f].grid, place, k);
                }
            }
        }
        if self.active.is_empty() {
            return;
        }
        let h = fields[self.fields[0]].grid.spacing;
        self.sample(fields, shape, nodes);
        if let NormalRule::NearestFace(structure) = self.rule.normal {
            self.find_faces(structure, fields, shape);
        }
        self.find_normals(nodes, h);
        self.measure_extents(fields, shape, nodes);
        self.marks.iter_mut().for_each(Marks::clear);
        let early = if seeded::is(Seed::ContactExtents) { 0.05 * h } else { 0.0 };
        for &k in &self.active {
            let view = &self.views[k];
            let Some(normal) = view.normal else { continue };
            let [a, b] = &view.samples;
            let (touching, slack) = match self.rule.gap {
                GapRule::Approach => (true, 0.0),
                GapRule::Positions { offset } => (separation::from_positions(a, b, normal, offset, h) <= 0.0, 0.0),
                GapRule::Displacements => (separation::from_displacements(a, b, normal) <= 0.0, 0.0),
                GapRule::Extents => (
                    view.extents.iter().all(|e| e.is_finite()),
                    separation::slack(-view.extents[0] - view.extents[1] - early, dt),
                ),
            };
            if touching {
                let sides = view.sides.map(|s| s as u8);
                pending.push(Pending { node: view.node as u32, contact: self.number, sides, normal, slack });
            }
        }
    }

    /// Adds up what the nodes see of either body, where a rule needs it.
    fn sample(&mut self, fields: &[VelocityField], shape: ShapeFunction, nodes: &[SharedNode]) {
        let gradients = matches!(self.rule.normal, NormalRule::LargerBody | NormalRule::Average);
        let means = matches!(self.rule.gap, GapRule::Positions { .. } | GapRule::Displacements);
        let clouds = self.rule.normal == NormalRule::Regression;
        if !gradients && !means && !clouds {
            return;
        }
        for side in 0..2 {
            let field = &fields[self.fields[side]];
            let body = &field.bodies[0];
            let (views, starts) = (&mut self.views, &self.starts[side]);
            let marks = &self.marks[side];
            marks.points(field, shape, |point, id, volume_ratio| {
                let volume = body.point_volume * volume_ratio;
                marks.nodes(&field.grid, point, |k, seen| {
                    let view = &mut views[k];
                    let from = starts.get(id as usize).copied().unwrap_or(nodes[view.node].x);
                    let x = minus(point.x, from);
                    view.samples[side].add(body.point_mass, volume, x, seen.weight, seen.gradient);
                    if clouds {
                        view.clouds[side].push(point.x);
                    }
                });
            });
        }
    }

    /// Lets every point of the other body find the nearest face of the structure: its normal counts for the nodes that see the
    /// point, and its distance for how far the point is from touching. What nodes lie nearest to does not matter: beside a corner
    /// that is a face the other body does not touch.
    fn find_faces(&mut self, structure: usize, fields: &[VelocityField], shape: ShapeFunction) {
        let field = &fields[self.fields[structure]];
        let mut places = self.places.iter();
        for (surface, ring) in self.surfaces.iter_mut().zip(&self.outline.rings) {
            surface.follow(places.by_ref().take(ring.len()).map(|&(b, i)| field.bands[b].points[0].position(i)));
        }
        let other = 1 - structure;
        let field = &fields[self.fields[other]];
        let radius = 0.5 * field.bodies[0].point_spacing;
        let Self { views, surfaces, marks, batch, .. } = self;
        let marks = &marks[other];
        let mut face_of = |point: &Near, face: &Nearest| {
            marks.nodes(&field.grid, point, |k, seen| {
                let view = &mut views[k];
                view.faces = plus(view.faces, scaled(face.normal, seen.weight));
                view.extents[other] = view.extents[other].max(radius - face.distance);
                view.extents[structure] = 0.0;
            });
        };
        marks.points(field, shape, |point, _, _| {
            if batch.push(*point) {
                batch.answer(surfaces, &mut face_of);
            }
        });
        batch.answer(surfaces, &mut face_of);
    }

    fn find_normals(&mut self, nodes: &[SharedNode], h: f64) {
        for &k in &self.active {
            let view = &mut self.views[k];
            let x = nodes[view.node].x;
            let [a, b] = &view.samples;
            let least = 1e-9 * (a.volume + b.volume) / h;
            view.normal = match self.rule.normal {
                NormalRule::LargerBody => from_larger(a, b, least).or_else(|| from_positions(a, b)),
                NormalRule::Average => from_difference(a, b, least).or_else(|| from_positions(a, b)),
                NormalRule::Regression => regression::normal(&view.clouds[0], &view.clouds[1], x, h),
                NormalRule::Prescribed(n) => Some(n),
                NormalRule::NearestFace(0) => direction(view.faces, 0.0),
                NormalRule::NearestFace(_) => direction(view.faces.map(|n| -n), 0.0),
            };
        }
    }

    /// How far the points of either body reach along the normal towards the other, counted from the node.
    fn measure_extents(&mut self, fields: &[VelocityField], shape: ShapeFunction, nodes: &[SharedNode]) {
        if self.rule.gap != GapRule::Extents || matches!(self.rule.normal, NormalRule::NearestFace(_)) {
            return;
        }
        for side in 0..2 {
            let field = &fields[self.fields[side]];
            let radius = 0.5 * field.bodies[0].point_spacing;
            let sign = if side == 0 { 1.0 } else { -1.0 };
            let views = &mut self.views;
            let marks = &self.marks[side];
            marks.points(field, shape, |point, _, _| {
                marks.nodes(&field.grid, point, |k, _| {
                    let view = &mut views[k];
                    if let Some(n) = view.normal {
                        let x = nodes[view.node].x;
                        let reach = sign * dot(minus(point.x, x), n) + radius;
                        view.extents[side] = view.extents[side].max(reach);
                    }
                });
            });
        }
    }
}

/// Angle of the rows of a lattice of points: from the first point to a neighbour of it, rad.
fn lattice_angle(points: &[(u32, Vector)], spacing: f64) -> f64 {
    let Some(&(_, first)) = points.first() else { return 0.0 };
    let away = |x: Vector| (norm(minus(x, first)) - spacing).abs();
    let neighbour = points.iter().skip(1).find(|p| away(p.1) < 1e-6 * spacing);
    neighbour.map_or(0.0, |&(_, x)| libm::atan2(x[1] - first[1], x[0] - first[0]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scaffold::Brick;

    #[test]
    fn the_angle_of_a_lattice_is_that_of_its_rows_or_columns() {
        for angle in [0.0, 0.4, -1.2] {
            let brick = Brick { angle, ..Brick::new([3.0, -2.0], [4, 3], 0.1) };
            let mut points: Vec<_> = brick.points().iter().map(|p| (p.id, p.x)).collect();
            // The neighbour of the first need not come next.
            points.swap(1, 20);
            for _ in 0..2 {
                let found = lattice_angle(&points, 0.05);
                assert!(libm::cos(4.0 * (found - angle)) > 1.0 - 1e-12, "{angle}: {found}");
                points.reverse();
            }
        }
        assert_eq!(lattice_angle(&[], 0.05), 0.0);
    }
}
