//! The loops over material points.

use super::{NodeMap, PointConstants, StressUpdate, VelocityUpdate};
use crate::body::{Block, Points};
use crate::constitutive::{Increment, Law, PointState, Stress};
use crate::lanes::{LANES, Lane, floor_to_int};
use crate::layout::BandSums;
use crate::shape::{STENCIL, Shape1d};

const ZERO: Lane = [0.0; LANES];

/// Stencils of eight points: first node, weights and gradients in each direction.
struct Stencils {
    node: [[i32; LANES]; 2],
    w: [[Lane; STENCIL]; 2],
    g: [[Lane; STENCIL]; 2],
}

impl Stencils {
    #[inline(always)]
    fn new<S: Shape1d>(shape: S, map: &NodeMap, block: &Block) -> Self {
        let mut s = Stencils { node: [[0; LANES]; 2], w: [[ZERO; STENCIL]; 2], g: [[ZERO; STENCIL]; 2] };
        for d in 0..2 {
            for l in 0..LANES {
                let u = (block.x[d][l] - map.corner[d]) * map.inverse_spacing - shape.shift();
                let (node, r) = floor_to_int(u);
                let (w, g) = shape.eval(r);
                s.node[d][l] = node;
                for k in 0..STENCIL {
                    s.w[d][k][l] = w[k];
                    s.g[d][k][l] = g[k] * map.inverse_spacing;
                }
            }
        }
        s
    }

    /// Index of the first of the three nodes in stencil column `i` of lane `l`.
    #[inline(always)]
    fn first(&self, map: &NodeMap, l: usize, i: usize) -> usize {
        map.index(self.node[0][l] + i as i32, self.node[1][l])
    }
}

/// Three nodes of a column, by value of their position in `nodes`.
#[inline(always)]
fn three<T>(nodes: &[T], first: usize) -> &[T; STENCIL] {
    nodes[first..first + STENCIL].try_into().expect("a slice of three")
}

#[inline(always)]
fn three_mut<T>(nodes: &mut [T], first: usize) -> &mut [T; STENCIL] {
    (&mut nodes[first..first + STENCIL]).try_into().expect("a slice of three")
}

/// Particle to grid: mass and momentum (`INERTIA`), internal force (`FORCE`).
#[inline(always)]
pub fn scatter<S: Shape1d, const INERTIA: bool, const FORCE: bool>(
    shape: S,
    map: &NodeMap,
    constants: PointConstants,
    points: &Points,
    first_node: usize,
    inertia: &mut [[f64; 4]],
    force: &mut [[f64; 2]],
) {
    let m = constants.mass;
    for (block, n) in points.blocks() {
        let stencil = Stencils::new(shape, map, block);
        let (mut xx, mut yy, mut xy, mut side) = (ZERO, ZERO, ZERO, ZERO);
        for l in 0..LANES {
            let volume = constants.volume * block.volume_ratio[l];
            xx[l] = -volume * block.stress[0][l];
            yy[l] = -volume * block.stress[1][l];
            xy[l] = -volume * block.stress[3][l];
            let pressure = if block.stress[2][l] < 0.0 { -block.stress[2][l] } else { 0.0 };
            side[l] = volume * constants.side_friction * pressure;
        }
        for l in 0..n {
            let carried = [m, m * block.v[0][l], m * block.v[1][l], side[l]];
            for i in 0..STENCIL {
                let first = stencil.first(map, l, i) - first_node;
                if INERTIA {
                    let wx = stencil.w[0][i][l];
                    for (j, node) in three_mut(inertia, first).iter_mut().enumerate() {
                        let w = wx * stencil.w[1][j][l];
                        for (sum, c) in node.iter_mut().zip(carried) {
                            *sum += w * c;
                        }
                    }
                }
                if FORCE {
                    for (j, node) in three_mut(force, first).iter_mut().enumerate() {
                        let gx = stencil.g[0][i][l] * stencil.w[1][j][l];
                        let gy = stencil.w[0][i][l] * stencil.g[1][j][l];
                        node[0] += gx * xx[l] + gy * xy[l];
                        node[1] += gx * xy[l] + gy * yy[l];
                    }
                }
            }
        }
    }
}

/// Grid to particle: velocity (FLIP with a share of PIC) and displacement; maps the new momentum back if asked (`REMAP`).
#[inline(always)]
pub fn gather_velocity<S: Shape1d, const REMAP: bool>(
    shape: S,
    map: &NodeMap,
    constants: PointConstants,
    update: VelocityUpdate,
    motion: &[[f64; 4]],
    points: &mut Points,
    first_node: usize,
    momentum: &mut [[f64; 2]],
) -> BandSums {
    let m = constants.mass;
    let (mut kinetic, mut lost, mut fastest, mut farthest) = (ZERO, ZERO, ZERO, ZERO);
    for (block, n) in points.blocks_mut() {
        let stencil = Stencils::new(shape, map, block);
        let mut seen = [ZERO; 4];
        for l in 0..n {
            let mut sum = [0.0; 4];
            for i in 0..STENCIL {
                let wx = stencil.w[0][i][l];
                for (j, node) in three(motion, stencil.first(map, l, i)).iter().enumerate() {
                    let w = wx * stencil.w[1][j][l];
                    for (s, c) in sum.iter_mut().zip(node) {
                        *s += w * c;
                    }
                }
            }
            for (lane, s) in seen.iter_mut().zip(sum) {
                lane[l] = s;
            }
        }
        for d in 0..2 {
            for l in 0..LANES {
                let flip = block.v[d][l] + seen[d + 2][l];
                let new = flip + update.pic * (seen[d][l] - flip);
                let used = if l < n { 1.0 } else { 0.0 };
                kinetic[l] += used * (new * new);
                lost[l] += used * (flip * flip - new * new);
                let size = new.abs();
                fastest[l] = if size > fastest[l] { size } else { fastest[l] };
                block.v[d][l] = new;
                let moved = update.dt * seen[d][l];
                let size = moved.abs();
                farthest[l] = if size > farthest[l] { size } else { farthest[l] };
                block.dx[d][l] = moved;
                if update.move_now {
                    block.x[d][l] += moved;
                }
            }
        }
        if REMAP {
            for l in 0..n {
                let p = [m * block.v[0][l], m * block.v[1][l]];
                for i in 0..STENCIL {
                    let wx = stencil.w[0][i][l];
                    let first = stencil.first(map, l, i) - first_node;
                    for (j, node) in three_mut(momentum, first).iter_mut().enumerate() {
                        let w = wx * stencil.w[1][j][l];
                        node[0] += w * p[0];
                        node[1] += w * p[1];
                    }
                }
            }
        }
    }
    BandSums {
        kinetic: 0.5 * m * total(&kinetic),
        pic_loss: 0.5 * m * total(&lost),
        max_speed: largest(&fastest),
        max_displacement: largest(&farthest),
        ..BandSums::default()
    }
}

/// Grid to particle: velocity gradient, stress update and volume, then the displacement of the step.
#[inline(always)]
pub fn update_stress<S: Shape1d, L: Law>(
    shape: S,
    law: L,
    map: &NodeMap,
    constants: PointConstants,
    update: StressUpdate,
    velocity: &[[f64; 2]],
    points: &mut Points,
) -> BandSums {
    let mut work = ZERO;
    let mut smallest = [f64::INFINITY; LANES];
    for (block, n) in points.blocks_mut() {
        let stencil = Stencils::new(shape, map, block);
        // dv_x/dx, dv_y/dx, dv_x/dy, dv_y/dy
        let mut gradient = [ZERO; 4];
        for l in 0..n {
            let mut sum = [0.0; 4];
            for i in 0..STENCIL {
                for (j, v) in three(velocity, stencil.first(map, l, i)).iter().enumerate() {
                    let gx = stencil.g[0][i][l] * stencil.w[1][j][l];
                    let gy = stencil.w[0][i][l] * stencil.g[1][j][l];
                    sum[0] += gx * v[0];
                    sum[1] += gx * v[1];
                    sum[2] += gy * v[0];
                    sum[3] += gy * v[1];
                }
            }
            for (lane, s) in gradient.iter_mut().zip(sum) {
                lane[l] = s;
            }
        }
        for l in 0..LANES {
            let increment = Increment {
                xx: update.dt * gradient[0][l],
                yy: update.dt * gradient[3][l],
                xy: 0.5 * update.dt * (gradient[2][l] + gradient[1][l]),
                spin: 0.5 * update.dt * (gradient[1][l] - gradient[2][l]),
            };
            let mut state = PointState {
                stress: Stress {
                    xx: block.stress[0][l],
                    yy: block.stress[1][l],
                    zz: block.stress[2][l],
                    xy: block.stress[3][l],
                },
                opened: block.opened[l],
                plastic_shear: block.plastic_shear[l],
            };
            let density = law.update(&mut state, &increment);
            // exp of the volumetric strain to third order, without leaving the positive side for |strain| < 2.
            let half = 0.5 * increment.volumetric();
            let growth = (1.0 + half) / (1.0 - half);
            let before = block.volume_ratio[l];
            let after = before * growth;
            let used = if l < n { constants.volume } else { 0.0 };
            work[l] += used * (0.5 * (before + after)) * density;
            smallest[l] = if after < smallest[l] { after } else { smallest[l] };
            block.volume_ratio[l] = after;
            block.stress[0][l] = state.stress.xx;
            block.stress[1][l] = state.stress.yy;
            block.stress[2][l] = state.stress.zz;
            block.stress[3][l] = state.stress.xy;
            block.opened[l] = state.opened;
            block.plastic_shear[l] = state.plastic_shear;
        }
        if update.move_after {
            for d in 0..2 {
                for l in 0..LANES {
                    block.x[d][l] += block.dx[d][l];
                }
            }
        }
    }
    BandSums {
        internal_work: total(&work),
        min_volume_ratio: smallest.iter().fold(f64::INFINITY, |a, &b| if b < a { b } else { a }),
        ..BandSums::default()
    }
}

/// Sum of a lane in a fixed order.
#[inline(always)]
fn total(lane: &Lane) -> f64 {
    lane.iter().sum()
}

#[inline(always)]
fn largest(lane: &Lane) -> f64 {
    lane.iter().fold(0.0, |a, &b| if b > a { b } else { a })
}
