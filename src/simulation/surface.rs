//! Contact on the surfaces of boundaries: gathers the crossings that share nodes, and finds their impulses together.
//!
//! A crossing moves two nodes, which may belong to two bands. So the momentum balance leaves these nodes open, and they are closed
//! here, one group after the other in the order of the nodes, whatever thread did what.
//!
//! Elsewhere: block Gauss-Seidel on the connected components of the constraint graph.

use super::VelocityField;
use super::slip::Slips;
use crate::band::with_before;
use crate::body::Block;
use crate::boundary::Boundary;
use crate::boundary::nodes::{self, Tally};
use crate::boundary::surface::{Site, SiteNode};
use crate::momentum;
use crate::shape::ShapeFunction;
use crate::space::{dot, mean, minus, moment, plus, scaled};
use std::ops::Range;

/// Distance from a surface at which a point is put that would have crossed it, cells.
const ON_SURFACE: f64 = 1e-9;
/// Most visits to the crossings and nodes of a group.
const SWEEPS: usize = 24;

/// A node of a group: where to find it.
#[derive(Debug, Clone)]
struct Place {
    field: usize,
    band: usize,
    /// Counted from the band's first node.
    node: usize,
    /// Among the band's open nodes.
    index: usize,
    /// Among the band's holds.
    holds: Range<usize>,
    /// Whether bodies in contact also meet there.
    met: bool,
}

/// Crossings that share nodes.
#[derive(Debug, Clone)]
struct Group {
    nodes: Range<usize>,
    sites: Range<usize>,
}

/// Some points of a body, near a plate or an end of a side.
#[derive(Debug, Clone, Copy)]
struct Near {
    site: usize,
    field: usize,
    band: usize,
    body: usize,
    block: usize,
    /// The points before the surface when the step began, a bit each.
    before: u8,
}

/// All crossings of a simulation.
#[derive(Debug, Clone, Default)]
pub(super) struct Surface {
    groups: Vec<Group>,
    nodes: Vec<Place>,
    /// Their nodes are numbered within the group.
    sites: Vec<Site>,
    states: Vec<SiteNode>,
    near: Vec<Near>,
    slips: Slips,
    /// What the crossings with each boundary did in the last step, field by field.
    tallies: Vec<Vec<Tally>>,
}

impl Surface {
    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.sites.is_empty()
    }

    /// The crossings, with what they did in the last step.
    pub fn sites(&self) -> &[Site] {
        &self.sites
    }

    /// What the crossings of a field did in the last step, by boundary.
    pub fn tallies(&self, field: usize) -> &[Tally] {
        self.tallies.get(field).map_or(&[], Vec::as_slice)
    }

    /// Energy of the elastic slip on each boundary, added to `sums`, J.
    pub fn slip_energy(&self, sums: &mut [f64]) {
        let slipping = self.sites.iter().filter(|s| s.slip_law().is_some());
        slipping.for_each(|s| sums[s.boundary as usize] += s.slip_energy());
    }

    /// Follows a new layout of the fields, and tells their bands which nodes to leave open.
    pub fn list(&mut self, fields: &mut [VelocityField], boundaries: usize) {
        self.groups.clear();
        self.nodes.clear();
        self.sites.clear();
        self.slips.clear(fields.len());
        self.tallies.resize_with(fields.len(), Vec::new);
        for (f, field) in fields.iter_mut().enumerate() {
            self.tallies[f].clear();
            self.tallies[f].resize(boundaries, Tally::default());
            self.group(f, field);
        }
        self.states.resize(self.nodes.len(), SiteNode::default());
    }

    /// Groups the crossings of one field.
    fn group(&mut self, f: usize, field: &mut VelocityField) {
        let crossings = field.sites();
        // For each node a crossing that is known to share it with others, up to the first one of all.
        let mut root: Vec<usize> = (0..crossings.len()).collect();
        let mut owners: Vec<(u32, usize)> =
            crossings.iter().enumerate().flat_map(|(k, s)| s.nodes.map(|n| (n, k))).collect();
        owners.sort_unstable();
        let find = |root: &[usize], mut k: usize| {
            while root[k] != k {
                k = root[k];
            }
            k
        };
        for same in owners.chunk_by(|a, b| a.0 == b.0) {
            for two in same.windows(2) {
                let [a, b] = [find(&root, two[0].1), find(&root, two[1].1)];
                root[a.max(b)] = a.min(b);
            }
        }
        let mut members: Vec<(usize, usize)> = (0..crossings.len()).map(|k| (find(&root, k), k)).collect();
        members.sort_unstable();
        for group in members.chunk_by(|a, b| a.0 == b.0) {
            let (first_node, first_site) = (self.nodes.len(), self.sites.len());
            let mut own: Vec<u32> = group.iter().flat_map(|&(_, k)| crossings[k].nodes).collect();
            own.sort_unstable();
            own.dedup();
            for &(_, k) in group {
                let mut site = crossings[k];
                self.slips.add(f, self.sites.len(), &site);
                site.nodes = site.nodes.map(|n| own.partition_point(|&o| o < n) as u32);
                self.sites.push(site);
            }
            for &node in &own {
                let node = node as usize;
                let band = field.bands.partition_point(|b| b.first_node <= node) - 1;
                let held = &field.bands[band].holds;
                let holds = held.partition_point(|h| (h.node as usize) < node)
                    ..held.partition_point(|h| h.node as usize <= node);
                let node = node - field.bands[band].first_node;
                self.nodes.push(Place { field: f, band, node, index: 0, holds, met: false });
            }
            self.groups.push(Group { nodes: first_node..self.nodes.len(), sites: first_site..self.sites.len() });
        }
        for place in self.nodes.iter_mut().filter(|p| p.field == f) {
            let shared = &mut field.bands[place.band].shared;
            place.met = shared.contains(&(place.node as u32));
            if !place.met {
                shared.push(place.node as u32);
            }
        }
    }

    /// Finds the nodes among those that the bands leave open, once these are sorted, and the points near plates and ends.
    pub fn find(&mut self, fields: &mut [VelocityField], boundaries: &[Boundary], spacing: f64) {
        for place in &mut self.nodes {
            let shared = &fields[place.field].bands[place.band].shared;
            place.index = shared.partition_point(|&n| (n as usize) < place.node);
        }
        self.slips.find(fields, boundaries, self.sites.len());
        self.near.clear();
        for group in &self.groups {
            for site in group.sites.clone().filter(|&s| self.sites[s].is_watched()) {
                let field = self.nodes[group.nodes.start].field;
                // Points move by no more than a cell until the next sort.
                let behind = if self.sites[site].plate {
                    boundaries[self.sites[site].boundary as usize].thickness()
                } else {
                    0.0
                };
                let reach = 3.0 * spacing + behind;
                for (band, b) in fields[field].bands.iter().enumerate() {
                    for (body, points) in b.points.iter().enumerate() {
                        for (block, (points, n)) in points.blocks().enumerate() {
                            if (0..n).any(|l| is_near(points, l, self.sites[site].x, reach)) {
                                self.near.push(Near { site, field, band, body, block, before: 0 });
                            }
                        }
                    }
                }
            }
        }
    }

    /// How far the material is from plates, as the speed at which it may still approach in a step of `dt` seconds.
    fn look(&mut self, fields: &[VelocityField], boundaries: &[Boundary], dt: f64) {
        let Self { sites, near, .. } = self;
        sites.iter_mut().filter(|s| s.plate).for_each(|s| s.free = f64::INFINITY);
        for at in near.iter_mut() {
            let field = &fields[at.field];
            let site = &mut sites[at.site];
            let half = 0.5 * boundaries[site.boundary as usize].thickness();
            let [nx, ny] = site.normal;
            let size = 0.5 * field.bodies[at.body].point_spacing * (nx.abs() + ny.abs());
            let points = &field.bands[at.band].points[at.body];
            let Some(block) = points.block(at.block) else { continue };
            at.before = 0;
            for l in 0..points.points_in(at.block) {
                let r = minus([block.x[0][l], block.x[1][l]], site.x);
                let (d, along) = (dot(r, site.normal), dot(r, [ny, -nx]));
                at.before |= u8::from(d >= 0.0) << l;
                // Behind the middle of the plate it belongs to the other side.
                if site.plate && d >= -half && along.abs() <= field.grid.spacing {
                    site.free = site.free.min((d - size).max(0.0) / dt);
                }
            }
        }
    }

    /// Closes the momentum balance of the nodes: the impulses of all that holds them.
    pub fn solve(&mut self, fields: &mut [VelocityField], boundaries: &[Boundary], shape: ShapeFunction, dt: f64) {
        self.look(fields, boundaries, dt);
        self.slips.recall(fields, shape, &mut self.sites, dt);
        let Self { groups, nodes, sites, states, tallies, .. } = self;
        tallies.iter_mut().for_each(|t| t.fill(Tally::default()));
        for group in groups.iter() {
            let (places, sites) = (&nodes[group.nodes.clone()], &mut sites[group.sites.clone()]);
            let states = &mut states[group.nodes.clone()];
            for (place, state) in places.iter().zip(states.iter_mut()) {
                let band = &mut fields[place.field].bands[place.band];
                let open = &band.open[place.index];
                let v = if place.met && open.mass > 0.0 { band.velocity(place.node) } else { open.free };
                *state = SiteNode { mass: open.mass, old: open.old, v, ..SiteNode::default() };
                if !place.met {
                    nodes::reset(&mut band.holds[place.holds.clone()]);
                }
            }
            sites.iter_mut().for_each(|s| s.reset(boundaries));
            let held = places.iter().any(|p| !p.met && !p.holds.is_empty());
            let single = sites.len() == 1 && !held;
            // In a corner, friction finds what sliding the normal impulses leave; see `nodes::solve`.
            for with_friction in if single { &[true][..] } else { &[false, true] } {
                for _ in 0..if single { 1 } else { SWEEPS } {
                    // Further sweeps would not change a bit.
                    if !visit(places, states, sites, fields, boundaries, *with_friction) {
                        break;
                    }
                }
            }
            book(places, states, sites, fields, tallies);
        }
        self.slips.remember(fields, shape, sites);
    }

    /// Keeps single points before the plates and ends of walls that they were before: between the crossings, the velocity of the grid
    /// may lead a point into them. Such a point is put back on the surface, and loses the speed at which it approached.
    pub fn keep(&mut self, fields: &mut [VelocityField], boundaries: &[Boundary]) {
        let Self { sites, near, tallies, .. } = self;
        for at in near.iter().filter(|at| at.before != 0) {
            let (site, b) = (&sites[at.site], &boundaries[sites[at.site].boundary as usize]);
            let VelocityField { grid, bodies, bands, .. } = &mut fields[at.field];
            let (points, mass) = (&mut bands[at.band].points[at.body], bodies[at.body].point_mass);
            let n = points.points_in(at.block);
            let Some(block) = points.blocks_mut().0.get_mut(at.block) else { continue };
            for l in (0..n).filter(|l| at.before >> l & 1 == 1) {
                let x = [block.x[0][l], block.x[1][l]];
                let d = dot(minus(x, site.x), site.normal);
                if d >= 0.0 || !site.is_beside(x, b) {
                    continue;
                }
                let x = plus(x, scaled(site.normal, ON_SURFACE * grid.spacing - d));
                let v = [block.v[0][l], block.v[1][l]];
                let stop = scaled(site.normal, (-dot(v, site.normal)).max(0.0));
                let after = plus(v, stop);
                for k in 0..2 {
                    (block.x[k][l], block.v[k][l]) = (x[k], after[k]);
                }
                let impulse = scaled(stop, mass);
                tallies[at.field][site.boundary as usize].add(&Tally {
                    impulse,
                    moment: moment(minus(x, b.foot().into()), impulse),
                    friction_work: 0.0,
                    normal_work: dot(impulse, mean(v, after)),
                });
            }
        }
    }

    /// Applies what was decided to the velocities that strain the material. `remapped` is the length of the step (s) where these are
    /// of the points' new momentum (MUSL): then it books what boundaries take of them, see [`nodes::Remapped`].
    pub fn project(&mut self, fields: &mut [VelocityField], remapped: Option<f64>) {
        let Self { groups, nodes, sites, states, tallies, .. } = self;
        for group in groups.iter() {
            let (places, sites) = (&nodes[group.nodes.clone()], &sites[group.sites.clone()]);
            let states = &mut states[group.nodes.clone()];
            for (place, state) in places.iter().zip(states.iter_mut()) {
                let (before, band) = with_before(&mut fields[place.field].bands, place.band);
                let work = &band.work;
                (state.mass, state.v) = (work.mass[place.node], work.strain_velocity[place.node]);
                state.balance = band.velocity(place.node);
                state.internal = remapped
                    .map_or([0.0; 2], |dt| scaled(momentum::internal_force(before.as_deref(), band, place.node), dt));
            }
            let mut book = |site: &Site, [normal, friction]: [f64; 2]| {
                let field = places.first().map_or(0, |p| p.field);
                let tally = &mut tallies[field][site.boundary as usize];
                tally.normal_work += normal;
                tally.friction_work += friction;
            };
            if remapped.is_some() {
                for site in sites {
                    book(site, site.remapped_work(|k| states[k].balance, |k| states[k].v));
                }
            }
            for _ in 0..if sites.len() > 1 { 4 } else { 1 } {
                for site in sites {
                    let taken = site.project(states);
                    book(site, site.taken_work(|k| states[k].internal, taken));
                }
                for (place, state) in places.iter().zip(states.iter_mut()) {
                    let holds = &fields[place.field].bands[place.band].holds[place.holds.clone()];
                    nodes::project(holds, &mut state.v, |_, _| {});
                }
            }
            for (place, state) in places.iter().zip(states.iter()) {
                let (before, band) = with_before(&mut fields[place.field].bands, place.band);
                momentum::set_strain_velocity(before, band, place.node, state.v);
            }
        }
    }
}

/// One visit to the crossings of a group and to what else holds its nodes; whether it changed anything.
fn visit(
    places: &[Place],
    states: &mut [SiteNode],
    sites: &mut [Site],
    fields: &mut [VelocityField],
    boundaries: &[Boundary],
    with_friction: bool,
) -> bool {
    let bits = |v: [f64; 2]| v.map(f64::to_bits);
    let mut changed = false;
    for site in sites {
        let before = site.vector_impulse();
        site.relax(states, with_friction);
        changed |= bits(before) != bits(site.vector_impulse());
    }
    for (place, state) in places.iter().zip(states) {
        if place.met || place.holds.is_empty() || state.mass <= 0.0 {
            continue;
        }
        let before = state.v;
        let holds = &mut fields[place.field].bands[place.band].holds[place.holds.clone()];
        nodes::visit(holds, boundaries, state.mass, &mut state.v, with_friction);
        changed |= bits(before) != bits(state.v);
    }
    changed
}

/// Books what the crossings and nodes of a group did, and lets the bands see how the nodes move.
fn book(
    places: &[Place],
    states: &[SiteNode],
    sites: &mut [Site],
    fields: &mut [VelocityField],
    tallies: &mut [Vec<Tally>],
) {
    let Some(first) = places.first() else { return };
    let tallies = &mut tallies[first.field];
    for site in sites.iter_mut() {
        site.follow_slip(states);
        if let Some(tally) = site.tally(states) {
            tallies[site.boundary as usize].add(&tally);
        }
    }
    for (place, state) in places.iter().zip(states).filter(|(_, s)| s.mass > 0.0) {
        let (mut before, band) = with_before(&mut fields[place.field].bands, place.band);
        if place.met {
            // Contact of bodies was booked with the velocity it left: works are those of the velocity after all impulses.
            let open = band.open[place.index];
            let left = band.velocity(place.node);
            let impulse = minus(left, open.free).map(|v| state.mass * v);
            let [x, y] = minus(state.v, left);
            let more = 0.5 * (impulse[0] * x + impulse[1] * y);
            if let Some(site) = sites.first() {
                tallies[site.boundary as usize].normal_work += more;
            }
            momentum::amend(before.as_deref_mut(), band, place.node, place.index, state.v);
        } else {
            nodes::book(&band.holds[place.holds.clone()], mean(state.old, state.v), &mut band.tallies);
            momentum::close(before.as_deref_mut(), band, place.node, place.index, state.v);
        }
        momentum::set_strain_velocity(before, band, place.node, state.v);
    }
}

fn is_near(block: &Block, lane: usize, x: [f64; 2], reach: f64) -> bool {
    (block.x[0][lane] - x[0]).abs() <= reach && (block.x[1][lane] - x[1]).abs() <= reach
}
