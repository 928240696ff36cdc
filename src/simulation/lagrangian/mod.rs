//! A structure in total-Lagrangian kinematics: it moves by the nodes of its own mesh, and its points go with them.
//!
//! The unknowns are displacement u and velocity v of the nodes of the body's [`Mesh`]. Everything about the mesh is found once:
//!
//! `m_i a_i = m_i g - sum_q V_q P(F_q) grad0 N_i(X_q) + J_i + R_i`, with `F_q = I + sum_i u_i grad0 N_i(X_q)`,
//!
//! at the Gauss points q of its elements, with the nominal stress P, the impulses of contact J and those of clamps R. So no point ever
//! leaves a cell, nodes see all that points do, and the deformation is the one of the reference configuration whatever the way there.
//! Nothing tears, and the energy stays but for the time steps (Zienkiewicz and Taylor 2000; for material points de Vaucorbeil, Nguyen and
//! Hutchinson 2020). Steps are those of everything else, symplectic Euler.
//!
//! Clamps hold the nodes at their plane and behind it. Other bodies are met on the background grid: the material points, which lie in
//! the mesh with weights N_i(X_p), show the body there, and what happens to them happens to the nodes. With the weights w_Ip of the
//! background node I a body has the velocity
//!
//! `v_I = sum_i c_Ii v_i` with `c_Ii = sum_p w_Ip m_p N_i(X_p) / sum_p w_Ip m_p`,
//!
//! and an impulse J_I there is the impulse `c_Ii J_I` on node i. As the c of a background node add up to one, so do impulses; and since
//! both have the same weights, the work of contact is the energy that the nodes get. Contact is told the mass `1 / sum_i (c_Ii^2 / m_i)`
//! that the body shows at the background node. It is repeated from node to node until it no longer changes what the body does (block
//! Gauss-Seidel iteration, Jean 1999), as for bodies in implicit steps.
//!
//! Elsewhere: explicit finite elements with lumped masses, coupled to material points by contact on the background grid (Lian, Zhang and Liu
//! 2011); the points are embedded particles.

mod elements;
mod motion;
mod newton;
#[cfg(test)]
mod tests;
mod touch;

use super::field::VelocityField;
use crate::body::{Body, Particle};
use crate::boundary::{Boundary, Friction};
use crate::constitutive::{AnyLaw, Gradient, NeoHookean};
use crate::ledger::Stock;
use crate::mesh::{Element, NODES, Place};
use crate::space::{dot, minus, plus, scaled};
use elements::Elements;
pub(in crate::simulation) use motion::Acting;
use newton::Solver;
use touch::Touching;

/// Share of the time step at which the highest mode of an element would grow that is used at most.
const STABLE: f64 = 0.9;
/// Rounds in which nodal velocities approach those of the points at the start.
const ROUNDS: usize = 50;

/// A point with its place in the mesh.
#[derive(Debug, Clone)]
struct Embedded {
    id: u32,
    /// Position in the reference configuration, m.
    start: [f64; 2],
    place: Place,
}

/// A node that a clamp holds.
#[derive(Debug, Clone, Copy)]
struct Clamped {
    node: usize,
    boundary: usize,
}

/// A body that moves by the nodes of its mesh.
#[derive(Debug, Clone, Default)]
pub(in crate::simulation) struct LagrangianBody {
    /// Its velocity field.
    pub field: usize,
    /// That field, while all others are swept.
    pub own: VelocityField,
    /// Largest number of sweeps over the touched nodes in a step.
    pub passes: usize,
    law: Option<NeoHookean>,
    /// Nodes in the reference configuration, m.
    start: Vec<[f64; 2]>,
    /// kg.
    mass: Vec<f64>,
    clamped: Vec<Clamped>,
    /// Whether a clamp holds a node.
    held: Vec<bool>,
    elements: Elements,
    /// Points by their numbers, ascending.
    points: Vec<Embedded>,
    /// Which of them there is at each place of the field, band after band.
    order: Vec<u32>,
    /// Displacement, m, and velocity, m/s, of the nodes.
    displacement: Vec<[f64; 2]>,
    velocity: Vec<[f64; 2]>,
    /// Force of the stresses on the nodes, N.
    internal: Vec<[f64; 2]>,
    /// Elastic energy, J.
    elastic: f64,
    /// Longest stable time step, s.
    longest: f64,
    /// Smallest volume ratio of an element's points.
    smallest: f64,
    /// Velocity at the end of the step under all impulses found so far, m/s.
    next: Vec<[f64; 2]>,
    /// Impulses of damping and of a field of accelerations, N s.
    damped: Vec<[f64; 2]>,
    driven: Vec<[f64; 2]>,
    touching: Touching,
    /// For implicit steps; none in explicit ones.
    solver: Option<Box<Solver>>,
}

/// Share of the distance of points by which a clamp may miss a node of the mesh and still holds it: drawings are typed to some digits.
pub const HELD_WITHIN: f64 = 1e-3;

/// The bodies in total-Lagrangian kinematics, each of which has a velocity field of its own.
///
/// # Panics
/// If one of them is not neo-Hookean.
pub(in crate::simulation) fn bodies(fields: &[VelocityField], boundaries: &[Boundary]) -> Vec<LagrangianBody> {
    let alone = fields.iter().enumerate().filter(|(_, f)| f.bodies.len() == 1 && f.bodies[0].mesh.is_some());
    alone.map(|(number, field)| LagrangianBody::new(number, field, boundaries)).collect()
}

impl LagrangianBody {
    fn new(number: usize, field: &VelocityField, boundaries: &[Boundary]) -> Self {
        let body = &field.bodies[0];
        let AnyLaw::NeoHookean(law) = body.law else {
            // A case with such a body is refused; a scene made in code can have one.
            panic!("body `{}` moves by its mesh, which only neo-Hookean bodies do", body.name)
        };
        let mut found = Self { field: number, law: Some(law), ..Self::default() };
        let Some(mesh) = &body.mesh else { return found };
        let mut particles: Vec<Particle> = field.particles().map(|(_, p)| p).collect();
        particles.sort_unstable_by_key(|p| p.id);
        found.points = particles.iter().map(|p| Embedded { id: p.id, start: p.x, place: mesh.at(p.x) }).collect();
        found.start = mesh.nodes();
        let n = found.start.len();
        let area: f64 = mesh.elements().map(|e| e.size[0] * e.size[1]).sum();
        let (mass, volume) = [body.point_mass, body.point_volume].map(|m| m * particles.len() as f64 / area).into();
        found.mass = vec![0.0; n];
        for element in mesh.elements() {
            for (node, share) in element.nodes.iter().zip(Element::shares()) {
                found.mass[*node as usize] += share * element.size[0] * element.size[1] * mass;
            }
        }
        found.hold(field, boundaries);
        found.elements = Elements::new(mesh, volume, mass, &found.held);
        for values in [
            &mut found.displacement,
            &mut found.velocity,
            &mut found.internal,
            &mut found.next,
            &mut found.damped,
            &mut found.driven,
        ] {
            values.resize(n, [0.0; 2]);
        }
        found.solver = body.implicit.then(|| Box::new(Solver::new(mesh)));
        found.set_velocities(body, &particles, boundaries);
        found.strain();
        found
    }

    /// Finds the nodes that clamps hold: those on their surface and inside.
    fn hold(&mut self, field: &VelocityField, boundaries: &[Boundary]) {
        self.held = vec![false; self.start.len()];
        let near = HELD_WITHIN * field.bodies[0].point_spacing;
        for (boundary, b) in boundaries.iter().enumerate() {
            if b.friction != Friction::Bonded || !b.acts_on(&field.members) {
                continue;
            }
            for (node, _) in self.start.iter().enumerate().filter(|(_, x)| b.depth(**x) >= -near) {
                if !std::mem::replace(&mut self.held[node], true) {
                    self.clamped.push(Clamped { node, boundary });
                }
            }
        }
    }

    /// Smallest volume ratio at an element's own points.
    pub fn smallest(&self) -> f64 {
        self.smallest
    }

    /// Gives the nodes the velocities of the points, by least squares: what is linear in space first, then the rest.
    fn set_velocities(&mut self, body: &Body, particles: &[Particle], boundaries: &[Boundary]) {
        let (centre, mean, slope) = linear_fit(particles);
        for (v, x) in self.velocity.iter_mut().zip(&self.start) {
            let r = minus(*x, centre);
            *v = plus(mean, slope.map(|s| dot(s, r)));
        }
        for _ in 0..ROUNDS {
            let mut missing = vec![[0.0; 2]; self.mass.len()];
            for (point, p) in self.points.iter().zip(particles) {
                let left = minus(p.v, interpolated(&point.place, &self.velocity));
                for (node, w) in point.place.nodes.iter().zip(point.place.weight) {
                    let sum = &mut missing[*node as usize];
                    *sum = plus(*sum, scaled(left, w * body.point_mass));
                }
            }
            for ((v, m), left) in self.velocity.iter_mut().zip(&self.mass).zip(missing) {
                *v = plus(*v, scaled(left, 1.0 / m));
            }
        }
        for c in &self.clamped {
            self.velocity[c.node] = boundaries[c.boundary].velocity.into();
        }
    }

    /// Finds the forces of the stresses in the present configuration.
    fn strain(&mut self) {
        let Some(law) = &self.law else { return };
        let now = self.elements.strain(law, &self.displacement, &mut self.internal);
        (self.elastic, self.smallest) = (now.energy, now.smallest);
        self.longest = STABLE * 2.0 / now.fastest.sqrt();
    }

    /// Whether its steps are implicit.
    pub fn is_implicit(&self) -> bool {
        self.solver.is_some()
    }

    /// Longest time step that is stable in the present configuration, s: for an element of the mesh by itself, which none of the body's modes
    /// is faster than (Irons and Treharne 1971). Implicit steps have no such limit.
    pub fn longest_step(&self) -> f64 {
        if self.is_implicit() { f64::INFINITY } else { self.longest }
    }

    /// Follows a sort of its field.
    pub fn rebuild(&mut self, field: &VelocityField) {
        self.order.clear();
        for id in field.bands.iter().flat_map(|b| b.points[0].iter()).map(|p| p.id) {
            let found = self.points.binary_search_by_key(&id, |p| p.id);
            self.order.extend(found.map(|k| k as u32));
        }
    }

    /// What it holds now, by its nodes, where gravity is `gravity` (m/s2), of which `heavy` says whether it acts, and steps are `dt` (s).
    ///
    /// Velocities are those of the middle of the last step. The kinetic energy is half the product of the momenta with velocities half a step before
    /// and after now: with it and the elastic energy now, the energy of a linear body stays to round-off. Where a body comes to rest it may be
    /// less than zero by next to nothing.
    pub fn stock(&self, gravity: [f64; 2], heavy: bool, dt: f64) -> Stock {
        let mut s = Stock { elastic: self.elastic, ..Stock::default() };
        for (node, (&m, &v)) in self.mass.iter().zip(&self.velocity).enumerate() {
            let x = plus(self.start[node], self.displacement[node]);
            s.mass += m;
            s.momentum = plus(s.momentum, scaled(v, m));
            let mut force = self.internal[node];
            if heavy {
                s.heavy += m;
                s.gravitational -= m * dot(gravity, x);
                force = plus(force, scaled(gravity, m));
            }
            // In implicit steps velocities are those of now.
            let after = if self.held[node] || self.is_implicit() { v } else { plus(v, scaled(force, dt / m)) };
            s.kinetic += 0.5 * m * dot(v, after);
        }
        s
    }
}

/// Mean position (m) and velocity (m/s) of particles, and the gradients of both components of the velocity that fit them best, 1/s.
fn linear_fit(particles: &[Particle]) -> ([f64; 2], [f64; 2], [[f64; 2]; 2]) {
    let per = 1.0 / particles.len().max(1) as f64;
    let mean = |of: fn(&Particle) -> [f64; 2]| scaled(particles.iter().fold([0.0; 2], |s, p| plus(s, of(p))), per);
    let (x, v) = (mean(|p| p.x), mean(|p| p.v));
    let (mut square, mut product) = ([0.0; 3], [[0.0; 2]; 2]);
    for p in particles {
        let (r, w) = (minus(p.x, x), minus(p.v, v));
        square = plus(square, [r[0] * r[0], r[0] * r[1], r[1] * r[1]]);
        product = [0, 1].map(|d| plus(product[d], scaled(r, w[d])));
    }
    let [a, b, c] = square;
    let determinant = a * c - b * b;
    // A single row of points says nothing of what is across it.
    if determinant <= 1e-12 * (a + c) * (a + c) {
        return (x, v, [[0.0; 2]; 2]);
    }
    (x, v, product.map(|[p, q]| [(c * p - b * q) / determinant, (a * q - b * p) / determinant]))
}

/// A field given at the nodes, at a place.
fn interpolated(place: &Place, values: &[[f64; 2]]) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for (node, w) in place.nodes.iter().zip(place.weight) {
        sum = plus(sum, scaled(values[*node as usize], w));
    }
    sum
}

/// The gradient of a field given at the nodes.
fn gradient(values: &[[f64; 2]; NODES], gradients: &[[f64; 2]; NODES]) -> Gradient {
    let mut h = [0.0; 4];
    for (u, g) in values.iter().zip(gradients) {
        for k in 0..4 {
            h[k] += u[k / 2] * g[k % 2];
        }
    }
    h
}
