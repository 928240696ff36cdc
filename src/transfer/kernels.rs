//! The loops over material points.

use super::{NodeMap, PointConstants, StressUpdate, VelocityUpdate};
use crate::body::{Block, Particle, Points};
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

    /// Whether two lanes touch the same nodes.
    #[inline(always)]
    fn same(&self, a: usize, b: usize) -> bool {
        self.node[0][a] == self.node[0][b] && self.node[1][a] == self.node[1][b]
    }

    /// Index of the first of the three nodes in stencil column `i` of lane `l`.
    #[inline(always)]
    fn first(&self, map: &NodeMap, l: usize, i: usize) -> usize {
        map.index(self.node[0][l] + i as i32, self.node[1][l])
    }
}

/// The stencil is a product of two one-dimensional ones, so sums over its nine nodes are taken along each column first and
/// then over the three columns, four components at a time.
#[inline(always)]
fn add_scaled<const N: usize>(sum: &mut [f64; N], w: f64, v: &[f64; N]) {
    for k in 0..N {
        sum[k] += w * v[k];
    }
}

#[inline(always)]
fn scaled<const N: usize>(w: f64, v: [f64; N]) -> [f64; N] {
    v.map(|x| w * x)
}

#[inline(always)]
fn add_three<const N: usize>(nodes: &mut [[f64; N]; STENCIL], sums: &[[f64; N]; STENCIL]) {
    for j in 0..STENCIL {
        for k in 0..N {
            nodes[j][k] += sums[j][k];
        }
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
        let mut l = 0;
        while l < n {
            // Sorted points share their stencil with the next few; their sum stays in registers.
            let start = l;
            let mut new_inertia = [[[0.0; 4]; STENCIL]; STENCIL];
            let mut new_force = [[[0.0; 2]; STENCIL]; STENCIL];
            while l < n && stencil.same(start, l) {
                let carried = [m, m * block.v[0][l], m * block.v[1][l], side[l]];
                for i in 0..STENCIL {
                    let (wx, gx) = (stencil.w[0][i][l], stencil.g[0][i][l]);
                    let column = scaled(wx, carried);
                    let along = scaled(gx, [xx[l], xy[l]]);
                    let across = scaled(wx, [xy[l], yy[l]]);
                    for j in 0..STENCIL {
                        let (w, g) = (stencil.w[1][j][l], stencil.g[1][j][l]);
                        if INERTIA {
                            add_scaled(&mut new_inertia[i][j], w, &column);
                        }
                        if FORCE {
                            add_scaled(&mut new_force[i][j], w, &along);
                            add_scaled(&mut new_force[i][j], g, &across);
                        }
                    }
                }
                l += 1;
            }
            for i in 0..STENCIL {
                let first = stencil.first(map, start, i) - first_node;
                if INERTIA {
                    add_three(three_mut(inertia, first), &new_inertia[i]);
                }
                if FORCE {
                    add_three(three_mut(force, first), &new_force[i]);
                }
            }
        }
    }
}

/// Particle to grid: the force of a field of accelerations. Not in the hot path, so one point at a time.
pub fn scatter_field<S: Shape1d>(
    shape: S,
    map: &NodeMap,
    mass: f64,
    acceleration: &dyn Fn(&Particle) -> [f64; 2],
    points: &Points,
    first_node: usize,
    force: &mut [[f64; 2]],
) {
    for (block, n) in points.blocks() {
        let stencil = Stencils::new(shape, map, block);
        for l in 0..n {
            let f = acceleration(&block.get(l)).map(|a| mass * a);
            for i in 0..STENCIL {
                let column = scaled(stencil.w[0][i][l], f);
                let first = stencil.first(map, l, i) - first_node;
                for (j, node) in three_mut(force, first).iter_mut().enumerate() {
                    add_scaled(node, stencil.w[1][j][l], &column);
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
        let mut seen = [[0.0; 4]; LANES];
        for l in 0..n {
            let mut sum = [0.0; 4];
            for i in 0..STENCIL {
                let nodes = three(motion, stencil.first(map, l, i));
                let mut column = scaled(stencil.w[1][0][l], nodes[0]);
                add_scaled(&mut column, stencil.w[1][1][l], &nodes[1]);
                add_scaled(&mut column, stencil.w[1][2][l], &nodes[2]);
                add_scaled(&mut sum, stencil.w[0][i][l], &column);
            }
            seen[l] = sum;
        }
        for d in 0..2 {
            for l in 0..LANES {
                let flip = block.v[d][l] + seen[l][d + 2];
                let new = flip + update.pic * (seen[l][d] - flip);
                let used = if l < n { 1.0 } else { 0.0 };
                kinetic[l] += used * (new * new);
                lost[l] += used * (flip * flip - new * new);
                let size = new.abs();
                fastest[l] = if size > fastest[l] { size } else { fastest[l] };
                block.v[d][l] = new;
                let moved = update.dt * seen[l][d];
                let size = moved.abs();
                farthest[l] = if size > farthest[l] { size } else { farthest[l] };
                block.dx[d][l] = moved;
                if update.move_now {
                    block.x[d][l] += moved;
                }
            }
        }
        if REMAP {
            let mut l = 0;
            while l < n {
                let start = l;
                let mut new_momentum = [[[0.0; 2]; STENCIL]; STENCIL];
                while l < n && stencil.same(start, l) {
                    let p = [m * block.v[0][l], m * block.v[1][l]];
                    for i in 0..STENCIL {
                        let column = scaled(stencil.w[0][i][l], p);
                        for j in 0..STENCIL {
                            add_scaled(&mut new_momentum[i][j], stencil.w[1][j][l], &column);
                        }
                    }
                    l += 1;
                }
                for i in 0..STENCIL {
                    let first = stencil.first(map, start, i) - first_node;
                    add_three(three_mut(momentum, first), &new_momentum[i]);
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
        let mut gradient = [[0.0; 4]; LANES];
        for l in 0..n {
            let along_y: [[f64; 4]; STENCIL] = std::array::from_fn(|j| {
                let (w, g) = (stencil.w[1][j][l], stencil.g[1][j][l]);
                [w, w, g, g]
            });
            let mut sum = [0.0; 4];
            for i in 0..STENCIL {
                let nodes = three(velocity, stencil.first(map, l, i));
                let mut column = [0.0; 4];
                for k in 0..4 {
                    column[k] = along_y[0][k] * nodes[0][k % 2]
                        + along_y[1][k] * nodes[1][k % 2]
                        + along_y[2][k] * nodes[2][k % 2];
                }
                let (w, g) = (stencil.w[0][i][l], stencil.g[0][i][l]);
                for (k, along_x) in [g, g, w, w].into_iter().enumerate() {
                    sum[k] += along_x * column[k];
                }
            }
            gradient[l] = sum;
        }
        for l in 0..LANES {
            let increment = Increment {
                xx: update.dt * gradient[l][0],
                yy: update.dt * gradient[l][3],
                xy: 0.5 * update.dt * (gradient[l][2] + gradient[l][1]),
                spin: 0.5 * update.dt * (gradient[l][1] - gradient[l][2]),
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
