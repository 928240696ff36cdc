//! Implicit steps of a body that moves by its mesh: the theta method, whose equation Newton's method solves.
//!
//! `M (v1 - v0) = dt (M g + theta f(u1) + (1 - theta) f(u0)) + J + R` with `u1 - u0 = dt (theta v1 + (1 - theta) v0)`,
//!
//! as for bodies of points in implicit steps ([`THETA`], and why), but for all of the force f of the stresses, in the reference configuration.
//! With the tangent K of the law at some displacement of the nodes, corrections of v1 are those of `M + theta^2 dt^2 K`. Its Cholesky factor
//! is kept from step to step and made anew where corrections shrink slowly, or where the step changes its length: a stiff body hardly
//! turns, so its factor lasts.
//!
//! Contact is solved together with it: the answers of mesh nodes to impulses are columns of the inverse of the same matrix, those of
//! background nodes are their sums with the weights c of both. Whenever impulses no longer change, the equation is corrected once more with
//! them, until neither changes anything.
//!
//! Elsewhere: generalised trapezoidal rule, modified Newton iteration, condensed compliance (Delassus operator) of the contact nodes.

use super::{Acting, LagrangianBody};
use crate::boundary::Boundary;
use crate::mesh::Mesh;
use crate::momentum::BodyForces;
use crate::seeded::{self, Seed};
use crate::simulation::implicit::THETA;
use crate::simulation::implicit::banded::Banded;
use crate::space::{dot, mean, minus, plus, scaled};

/// Most corrections of a step, and the share of the velocities at which they end.
const MOST: usize = 60;
const SOLVED: f64 = 1e-12;
/// Share of the last correction above which corrections shrink slowly.
const SLOW: f64 = 0.2;
/// Corrections that do not shrink are round-off below this share of the velocities, or of the displacement since the start over the step.
const NOISE: f64 = 1e-10;

/// What implicit steps need besides the body.
#[derive(Debug, Clone, Default)]
pub(super) struct Solver {
    /// Place of each node in the matrix, counted along the longer side of the mesh.
    order: Vec<u32>,
    /// Of the matrix of corrections.
    factor: Banded,
    /// Step for which it holds, s; 0 where there is none.
    pub(super) dt: f64,
    /// All that is known of M v1 at the start of a step, N s.
    given: Vec<[f64; 2]>,
    /// Contact impulses on nodes that no clamp holds, N s.
    pub(super) pushed: Vec<[f64; 2]>,
    /// Displacement at the end of the step as it is known, m, and the force of the stresses there, N.
    end: Vec<[f64; 2]>,
    after: Vec<[f64; 2]>,
    /// A right-hand side, and what solves it.
    work: Vec<f64>,
    /// Mesh nodes whose answers are known, and the place of each node among them.
    known: Vec<u32>,
    places: Vec<u32>,
    /// Velocity of the one per impulse at the other, row by row: xx, xy, yx, yy in 1/kg.
    compliance: Vec<Vec<[f64; 4]>>,
    /// The same of touched background nodes.
    pub(super) answers: Vec<[f64; 4]>,
    pub(super) touched: Vec<usize>,
    /// Largest correction of the last time in this step that impulses had settled, m/s.
    last: f64,
    /// Whether the velocities at the end of the step were corrected under impulses in this step.
    corrected: bool,
    /// Whether a step found no solution.
    lost: bool,
}

impl Solver {
    /// For a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        let [columns, rows] = mesh.counts();
        let n = columns * rows;
        let order = (0..n).map(|k| if columns >= rows { k } else { (k % rows) * columns + k / rows });
        // Nodes of an element are at most two columns and two rows apart.
        let reach = 2 * (2 * columns.min(rows) + 2) + 1;
        Self {
            order: order.map(|k| k as u32).collect(),
            factor: Banded::new(2 * n, reach),
            given: vec![[0.0; 2]; n],
            pushed: vec![[0.0; 2]; n],
            end: vec![[0.0; 2]; n],
            after: vec![[0.0; 2]; n],
            work: vec![0.0; 2 * n],
            places: vec![u32::MAX; n],
            ..Self::default()
        }
    }

    /// Places of a node's two components in the matrix.
    fn rows(&self, node: usize) -> [usize; 2] {
        let first = 2 * self.order[node] as usize;
        [first, first + 1]
    }

    /// Whether contact gives no impulse.
    fn is_free(&self) -> bool {
        self.pushed.iter().all(|p| *p == [0.0; 2])
    }

    /// Forgets the answers of nodes.
    fn forget(&mut self) {
        self.known.iter().for_each(|n| self.places[*n as usize] = u32::MAX);
        self.known.clear();
        self.compliance.clear();
    }

    /// Finds how a node answers, and how those known by now answer impulses at it.
    fn learn(&mut self, node: usize) {
        let columns = self.rows(node).map(|row| {
            self.work.fill(0.0);
            self.work[row] = 1.0;
            self.factor.solve_from(row, &mut self.work);
            let at = |n: usize| self.rows(n).map(|k| self.work[k]);
            let mut column: Vec<[f64; 2]> = self.known.iter().map(|n| at(*n as usize)).collect();
            column.push(at(node));
            column
        });
        self.places[node] = self.known.len() as u32;
        self.known.push(node as u32);
        let [x, y] = columns;
        for (row, (x, y)) in self.compliance.iter_mut().zip(x.iter().zip(&y)) {
            row.push([x[0], y[0], x[1], y[1]]);
        }
        // The inverse of a symmetric matrix is symmetric.
        self.compliance.push(x.iter().zip(&y).map(|(x, y)| [x[0], x[1], y[0], y[1]]).collect());
    }

    /// Velocities of the nodes under the contact impulses, for a body at rest without them, added to `velocity` with a sign.
    pub(super) fn push(&mut self, velocity: &mut [[f64; 2]], sign: f64) {
        for (node, p) in self.pushed.iter().enumerate() {
            let [i, j] = self.rows(node);
            (self.work[i], self.work[j]) = (p[0], p[1]);
        }
        self.factor.solve(&mut self.work);
        for (node, v) in velocity.iter_mut().enumerate() {
            *v = plus(*v, self.rows(node).map(|k| sign * self.work[k]));
        }
    }
}

impl LagrangianBody {
    /// Whether a step found no solution.
    pub fn is_lost(&self) -> bool {
        self.solver.as_ref().is_some_and(|s| s.lost)
    }

    /// Finds the velocities at the end of a step without contact.
    pub(super) fn solve_free(&mut self, acting: &Acting, forces: BodyForces) {
        let Some(mut s) = self.solver.take() else { return };
        let dt = acting.dt;
        if s.dt != dt {
            s.dt = dt;
            s.end.clone_from(&self.displacement);
            self.factorise(&mut s);
        }
        s.pushed.fill([0.0; 2]);
        for (node, (&m, &v)) in self.mass.iter().zip(&self.velocity).enumerate() {
            let old = scaled(plus(v, scaled(forces.gravity, dt)), m);
            let pulled = scaled(self.internal[node], (1.0 - THETA) * dt);
            s.given[node] = plus(plus(old, pulled), plus(self.damped[node], self.driven[node]));
            self.next[node] = v;
        }
        self.hold_next(acting.boundaries);
        self.solve(&mut s);
        self.solver = Some(s);
    }

    /// Gives held nodes the velocities of their clamps.
    pub(super) fn hold_next(&mut self, boundaries: &[Boundary]) {
        for c in &self.clamped {
            self.next[c.node] = boundaries[c.boundary].velocity.into();
        }
    }

    /// Factorises the matrix of corrections at the displacement that is known of the end of the step.
    fn factorise(&self, s: &mut Solver) {
        s.forget();
        s.factor.clear();
        let (Some(law), Solver { order, factor, end, dt, .. }) = (&self.law, &mut *s) else { return };
        let by = (THETA * *dt) * (THETA * *dt);
        self.elements.stiffen(law, end, |n, m, block| {
            let [i, j] = [n, m].map(|n| 2 * order[n as usize] as usize);
            for (k, c) in block.iter().enumerate() {
                let (i, j) = (i + k / 2, j + k % 2);
                if j <= i {
                    factor.add(i, j, by * c);
                }
            }
        });
        for (node, &m) in self.mass.iter().enumerate() {
            for i in s.rows(node) {
                if self.held[node] {
                    s.factor.isolate(i, 1.0);
                } else {
                    s.factor.add(i, i, m);
                }
            }
        }
        s.lost |= !s.factor.factor();
    }

    /// Finds displacement and force that belong to the velocities at the end of the step.
    fn reach_end(&self, s: &mut Solver) {
        for (node, end) in s.end.iter_mut().enumerate() {
            let between = plus(scaled(self.next[node], THETA), scaled(self.velocity[node], 1.0 - THETA));
            *end = plus(self.displacement[node], scaled(between, s.dt));
        }
        if let Some(law) = &self.law {
            self.elements.strain(law, &s.end, &mut s.after);
        }
    }

    /// Corrects the velocities at the end of the step once; the largest correction, m/s.
    fn correct(&mut self, s: &mut Solver) -> f64 {
        self.reach_end(s);
        let share = seeded::times(Seed::SimulationEndForce, THETA * s.dt);
        for (node, &m) in self.mass.iter().enumerate() {
            let due = plus(plus(s.given[node], s.pushed[node]), scaled(s.after[node], share));
            let over = if self.held[node] { [0.0; 2] } else { minus(scaled(self.next[node], m), due) };
            let [i, j] = s.rows(node);
            (s.work[i], s.work[j]) = (over[0], over[1]);
        }
        s.factor.solve(&mut s.work);
        let mut largest = 0.0f64;
        for (node, v) in self.next.iter_mut().enumerate() {
            let change = s.rows(node).map(|k| s.work[k]);
            *v = minus(*v, change);
            largest =
                change.iter().fold(largest, |a, x| if a.is_nan() || x.is_nan() { f64::NAN } else { a.max(x.abs()) });
        }
        largest
    }

    /// Whether a correction is next to nothing: a small share of the velocities, or round-off that shrinks no more.
    fn is_solved(&self, s: &Solver, size: f64, last: f64) -> bool {
        let most = |values: &[[f64; 2]]| values.iter().flatten().fold(0.0f64, |a, x| a.max(x.abs()));
        let speed = most(&self.next).max(most(&self.velocity));
        size <= SOLVED * speed || (size > SLOW * last && size <= NOISE * speed.max(most(&s.end) / s.dt))
    }

    /// Corrects the velocities at the end of the step until the momentum balance is closed.
    fn solve(&mut self, s: &mut Solver) {
        let mut last = f64::INFINITY;
        for _ in 0..MOST {
            let size = self.correct(s);
            if self.is_solved(s, size, last) {
                return;
            }
            if size > SLOW * last {
                self.reach_end(s);
                self.factorise(s);
            }
            if s.lost || !size.is_finite() {
                break;
            }
            last = size;
        }
        s.lost = true;
    }

    /// Finds how touched nodes answer impulses at each other.
    pub(super) fn respond(&mut self) {
        let Some(mut s) = self.solver.take() else { return };
        s.last = f64::INFINITY;
        s.corrected = false;
        self.find_answers(&mut s);
        self.solver = Some(s);
    }

    fn find_answers(&mut self, s: &mut Solver) {
        let t = &mut self.touching;
        s.touched.clear();
        s.touched.extend((0..t.shared.len()).filter(|k| t.shared[*k].touched));
        for at in t.shared.iter().filter(|at| at.touched) {
            for node in t.shares[at.own.clone()].iter().map(|(n, _)| *n as usize) {
                if !self.held[node] && s.places[node] == u32::MAX {
                    s.learn(node);
                }
            }
        }
        s.answers.clear();
        let mut row = Vec::new();
        for (rank, &k) in s.touched.iter().enumerate() {
            row.clear();
            row.resize(s.known.len(), [0.0; 4]);
            for &(node, c) in &t.shares[t.shared[k].own.clone()] {
                let Some(own) = s.compliance.get(s.places[node as usize] as usize) else { continue };
                row.iter_mut().zip(own).for_each(|(sum, a)| *sum = plus(*sum, scaled(*a, c)));
            }
            for &j in &s.touched {
                let shares = t.shares[t.shared[j].own.clone()].iter();
                let answers = shares.filter_map(|(n, c)| Some(scaled(*row.get(s.places[*n as usize] as usize)?, *c)));
                s.answers.push(answers.fold([0.0; 4], plus));
            }
            let own = s.answers[rank * s.touched.len() + rank];
            let at = &mut t.shared[k];
            // Frobenius's norm, no less than the largest eigenvalue: no sweep then overshoots.
            at.mobility = at.held + dot(own, own).sqrt();
            at.rank = rank;
        }
    }

    /// Velocity at the end of the step, of the touched node of this rank, that contact impulses give.
    pub(super) fn answer(&self, rank: usize) -> [f64; 2] {
        let (Some(s), t) = (&self.solver, &self.touching) else { return [0.0; 2] };
        let row = s.answers.chunks_exact(s.touched.len().max(1)).nth(rank).unwrap_or(&[]);
        row.iter().zip(&s.touched).fold([0.0; 2], |v, (a, k)| {
            let p = t.shared[*k].impulse;
            plus(v, [a[0] * p[0] + a[1] * p[1], a[2] * p[0] + a[3] * p[1]])
        })
    }

    /// Corrects the equation of motion under impulses that have settled; whether by no more than `allowed` (m/s).
    pub(super) fn agree(&mut self, allowed: f64) -> bool {
        let Some(mut s) = self.solver.take() else { return true };
        self.gather_contact(&mut s);
        // Without impulses it is solved, or will be at the end of the step.
        let settled = s.is_free() || {
            s.push(&mut self.next, 1.0);
            s.corrected = true;
            let size = self.correct(&mut s);
            let settled = size <= allowed || self.is_solved(&s, size, s.last) || !size.is_finite();
            if size > SLOW * s.last && !settled {
                self.reach_end(&mut s);
                self.factorise(&mut s);
                self.find_answers(&mut s);
            }
            s.push(&mut self.next, -1.0);
            s.last = size;
            settled || s.lost
        };
        self.solver = Some(s);
        settled
    }

    /// Sums up contact impulses on nodes that no clamp holds.
    fn gather_contact(&self, s: &mut Solver) {
        s.pushed.fill([0.0; 2]);
        self.add_contact(false, &mut s.pushed);
    }

    /// Ends a step under the impulses of contact: the force of the stresses that acted in it, N, and what the method takes of the energy,
    /// but for what the stresses store, J.
    pub(super) fn solve_touched(&mut self, gravity: [f64; 2]) -> Option<(Vec<[f64; 2]>, f64)> {
        let mut s = self.solver.take()?;
        self.gather_contact(&mut s);
        if !s.is_free() {
            s.push(&mut self.next, 1.0);
            self.solve(&mut s);
        } else if s.corrected {
            // What was corrected under impulses that are gone again.
            self.solve(&mut s);
        }
        s.corrected = false;
        self.reach_end(&mut s);
        let mut taken = 0.0;
        let mut force = Vec::with_capacity(self.mass.len());
        for (node, &m) in self.mass.iter().enumerate() {
            let acted = plus(scaled(s.after[node], THETA), scaled(self.internal[node], 1.0 - THETA));
            let mean = mean(self.velocity[node], self.next[node]);
            let way = minus(s.end[node], self.displacement[node]);
            // Gravity and stresses are paid for the way of a node, and give motion by its mean velocity.
            taken += m * dot(gravity, minus(way, scaled(mean, s.dt))) - s.dt * dot(acted, mean);
            force.push(acted);
        }
        self.solver = Some(s);
        Some((force, taken))
    }

    /// Displacements of the nodes at the end of the step that was solved.
    pub(super) fn take_end(&mut self) {
        if let Some(s) = &mut self.solver {
            std::mem::swap(&mut self.displacement, &mut s.end);
        }
    }
}
