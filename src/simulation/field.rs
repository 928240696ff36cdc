//! Bodies that move as one on the grid: their points, and the nodes they reach.

use crate::band::Band;
use crate::body::{Block, Body, Particle, Points};
use crate::boundary::Boundary;
use crate::boundary::BoundaryContact;
use crate::boundary::search::{self, Found};
use crate::boundary::surface::Site;
use crate::grid::ActiveGrid;
use crate::lanes::LANES;
use crate::layout::{Departed, SortRules, Sorter};
use crate::momentum::{self, BodyForces};

/// A velocity field of the grid. Bodies that share one stick together where they meet.
#[derive(Debug, Clone, Default)]
pub(super) struct VelocityField {
    /// Index of each of its bodies in the simulation.
    pub members: Vec<usize>,
    /// The bodies.
    pub bodies: Vec<Body>,
    /// Points and nodes, from left to right.
    pub bands: Vec<Band>,
    /// Which nodes there are.
    pub grid: ActiveGrid,
    found: Found,
    sorter: Sorter,
    /// Points that left the domain at the last sort, with the index of their body in the simulation.
    pub departed: Vec<Departed>,
    /// Farthest that any point can have moved since the last sort, m.
    pub drift: f64,
}

impl VelocityField {
    /// Adds a body with its index in the simulation.
    pub fn add(&mut self, index: usize, body: Body, particles: &[Particle]) {
        if self.bands.is_empty() {
            self.bands.push(Band::default());
        }
        let mut points = Points::for_law(&body.law);
        particles.iter().for_each(|p| points.push(p));
        self.bands[1..].iter_mut().for_each(|band| band.points.push(Points::for_law(&body.law)));
        self.bands[0].points.push(points);
        self.bodies.push(body);
        self.members.push(index);
    }

    /// Sorts the points into bands anew and finds what holds the nodes. `rules` lacks the bodies.
    pub fn sort(&mut self, rules: &SortRules, boundaries: &[Boundary], contact: BoundaryContact) {
        let rules = SortRules { bodies: &self.bodies, ..*rules };
        self.departed.clear();
        self.sorter.sort(&rules, &mut self.bands, &mut self.grid, &mut self.departed);
        for departed in &mut self.departed {
            departed.body = self.members[departed.body];
        }
        self.find_holds(boundaries, contact);
        self.drift = 0.0;
    }

    /// Finds what holds each node.
    pub fn find_holds(&mut self, boundaries: &[Boundary], contact: BoundaryContact) {
        // Bodies in implicit steps know of boundaries what acts at their nodes.
        let implicit = self.bodies.iter().any(|b| b.implicit);
        let contact = if implicit { BoundaryContact::Nodes } else { contact };
        // Clamps hold the nodes of a mesh, and nothing else acts on a body with one but other bodies.
        let acting = if self.bodies.iter().any(|b| b.mesh.is_some()) { &[] } else { boundaries };
        search::find_holds(acting, &self.members, &self.grid, contact, &mut self.found);
        momentum::distribute_holds(&self.found.holds, boundaries.len(), &mut self.bands);
    }

    /// Where surfaces of boundaries cross the lines of its grid.
    pub fn sites(&self) -> &[Site] {
        &self.found.sites
    }

    /// What acts on every one of its nodes, of what acts on all fields.
    pub fn forces(&self, common: BodyForces) -> BodyForces {
        let weightless = self.bodies.iter().all(|b| b.weightless);
        BodyForces { gravity: if weightless { [0.0; 2] } else { common.gravity }, ..common }
    }

    /// All points with the index of their body in the simulation.
    pub fn particles(&self) -> impl Iterator<Item = (usize, Particle)> {
        self.bands.iter().flat_map(|band| {
            self.members.iter().zip(&band.points).flat_map(|(&body, points)| points.iter().map(move |p| (body, p)))
        })
    }

    /// The blocks of points in the order of [`Self::particles`]: index of the body in the simulation, block, number of real points.
    pub fn blocks(&self) -> impl Iterator<Item = (usize, &Block, usize)> {
        self.numbered_blocks().map(|(body, block, _, n)| (body, block, n))
    }

    /// The same with the numbers of the points within their body.
    pub fn numbered_blocks(&self) -> impl Iterator<Item = (usize, &Block, &[u32; LANES], usize)> {
        self.bands.iter().flat_map(|band| {
            let bodies = self.members.iter().zip(&band.points);
            bodies.flat_map(|(&body, points)| {
                points.blocks().zip(points.ids()).map(move |((block, n), ids)| (body, block, ids, n))
            })
        })
    }
}
