//! The elements of a mesh: forces at the nodes, energy, and what bounds the time step.

use super::gradient;
use crate::constitutive::NeoHookean;
use crate::mesh::{Element, Gauss, Mesh, NODES, POINTS};
use crate::space::dot;

/// An element with its Gauss points, which elements of one size share.
#[derive(Debug, Clone)]
struct Part {
    nodes: [u32; NODES],
    shape: usize,
    /// Largest ratio of the squared gradient of a function to its square, over the density: 1/m2 per kg/m3; 0 where a clamp holds all
    /// nodes.
    steepest: f64,
}

/// All of them.
#[derive(Debug, Clone, Default)]
pub(super) struct Elements {
    parts: Vec<Part>,
    shapes: Vec<[Gauss; POINTS]>,
    /// Volume per area, m.
    depth: f64,
}

/// What a configuration is found to be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Strained {
    /// Elastic energy, J.
    pub energy: f64,
    /// Smallest volume ratio.
    pub smallest: f64,
    /// No mode has a larger square of its angular frequency, 1/s2.
    pub fastest: f64,
}

impl Elements {
    /// Of a mesh of this volume and mass per area (m, kg/m2), some of whose nodes are held.
    pub fn new(mesh: &Mesh, volume: f64, mass: f64, held: &[bool]) -> Self {
        let mut found = Self { depth: volume, ..Self::default() };
        let mut sizes: Vec<[f64; 2]> = Vec::new();
        for element in mesh.elements() {
            let Element { nodes, size } = element;
            let near = |s: &[f64; 2]| (0..2).all(|d| (s[d] - size[d]).abs() <= 1e-12 * size[d]);
            let shape = sizes.iter().position(near).unwrap_or_else(|| {
                sizes.push(size);
                found.shapes.push(mesh.gauss(size));
                sizes.len() - 1
            });
            let moves = nodes.iter().any(|n| !held[*n as usize]);
            let steepest = if moves { element.steepest() * volume / mass } else { 0.0 };
            found.parts.push(Part { nodes, shape, steepest });
        }
        found
    }

    /// Hands out the stiffness under a displacement (m), element by element: for each two of its nodes how the force of the stresses at the
    /// first falls with the displacement of the second, xx, xy, yx, yy in N/m.
    pub fn stiffen(&self, law: &NeoHookean, displacement: &[[f64; 2]], mut each: impl FnMut(u32, u32, [f64; 4])) {
        for part in &self.parts {
            let u = part.nodes.map(|n| displacement[n as usize]);
            let mut blocks = [[[0.0; 4]; NODES]; NODES];
            for point in &self.shapes[part.shape] {
                let volume = point.area * self.depth;
                let tangent = law.tangent(&gradient(&u, &point.gradient)).map(|row| row.map(|c| volume * c));
                for (row, g) in blocks.iter_mut().zip(&point.gradient) {
                    // Along the gradient of the first function: rows of x and y.
                    let along: [[f64; 4]; 2] = [0, 1]
                        .map(|d| std::array::from_fn(|l| g[0] * tangent[2 * d][l] + g[1] * tangent[2 * d + 1][l]));
                    for (block, h) in row.iter_mut().zip(&point.gradient) {
                        for (k, sum) in block.iter_mut().enumerate() {
                            let [d, e] = [k / 2, k % 2];
                            *sum += along[d][2 * e] * h[0] + along[d][2 * e + 1] * h[1];
                        }
                    }
                }
            }
            for (n, row) in part.nodes.iter().zip(&blocks) {
                for (m, block) in part.nodes.iter().zip(row) {
                    each(*n, *m, *block);
                }
            }
        }
    }

    /// Puts the forces of the stresses under a displacement (m) into `forces` (N).
    pub fn strain(&self, law: &NeoHookean, displacement: &[[f64; 2]], forces: &mut [[f64; 2]]) -> Strained {
        forces.fill([0.0; 2]);
        let mut found = Strained { energy: 0.0, smallest: f64::INFINITY, fastest: 0.0 };
        for part in &self.parts {
            let u = part.nodes.map(|n| displacement[n as usize]);
            let mut f = [[0.0; 2]; NODES];
            let mut stiffest = 0.0f64;
            for point in &self.shapes[part.shape] {
                let volume = point.area * self.depth;
                let at = law.nominal(&gradient(&u, &point.gradient));
                found.energy += volume * at.energy;
                found.smallest = found.smallest.min(at.volume_ratio);
                stiffest = stiffest.max(at.stiffness);
                let [xx, xy, yx, yy] = at.stress.map(|p| volume * p);
                for (f, g) in f.iter_mut().zip(&point.gradient) {
                    f[0] -= dot([xx, xy], *g);
                    f[1] -= dot([yx, yy], *g);
                }
            }
            for (n, f) in part.nodes.iter().zip(f) {
                let sum = &mut forces[*n as usize];
                (sum[0], sum[1]) = (sum[0] + f[0], sum[1] + f[1]);
            }
            found.fastest = found.fastest.max(stiffest * part.steepest);
        }
        found
    }
}
