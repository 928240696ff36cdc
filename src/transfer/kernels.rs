//! The loops over material points.
//!
//! P2G is the scatter, G2P the gather. The share of PIC is also called PIC damping (particle-in-cell damping) or
//! FLIP/PIC blending.

#![expect(clippy::needless_range_loop, reason = "loops over lanes and nodes index several parallel arrays")]

use super::{NodeMap, PointConstants, StressUpdate, VelocityUpdate};
use crate::band::{BandSums, NodeSum};
use crate::body::{Particle, Points};
use crate::constitutive::{AnyLaw, History, Increment, Law, PointState, Stress};
use crate::lanes::{LANES, Lane};
use crate::seeded::{self, Seed};
use crate::shape::stencil::Stencils;
use crate::shape::{STENCIL, Shape1d};
use crate::vector::{Pack4, Pack8, Unit};

/// Blocks by which the scatter, the first to touch them in a step, asks for them ahead; the later passes ask for the next.
const AHEAD: usize = 4;

const ZERO: Lane = [0.0; LANES];

/// What stays the same over a loop: shape function, nodes, and properties of the body.
#[derive(Debug, Clone, Copy)]
pub struct Shaped<'a, S> {
    pub shape: S,
    pub map: &'a NodeMap<'a>,
    pub constants: PointConstants,
}

/// Why a column of a stencil is in the fields of its band.
const WITHIN_REACH: &str =
    "sorting gives a band every node that the stencils of its points can reach until the next sort";

/// The `N` numbers at `first` of a flat nodal field, for the three nodes of a stencil column (and a fourth where `N` is more).
#[inline(always)]
fn at<const N: usize>(field: &[f64], first: usize) -> &[f64; N] {
    field[first..].first_chunk().expect(WITHIN_REACH)
}

#[inline(always)]
fn at_mut<const N: usize>(field: &mut [f64], first: usize) -> &mut [f64; N] {
    field[first..].first_chunk_mut().expect(WITHIN_REACH)
}

/// Four numbers of each of eight points, number by number.
#[inline(always)]
fn columns<U: Unit>(rows: [U::Pack4; LANES], lanes: &mut [Lane; 4]) {
    let columns = U::Pack8::columns(rows);
    for k in 0..4 {
        columns[k].store(&mut lanes[k]);
    }
}

/// Eight numbers of each of eight points, point by point.
#[inline(always)]
fn transpose<U: Unit>(lanes: &[Lane; 8], points: &mut [[f64; 8]; LANES]) {
    let mut packs = [U::Pack8::splat(0.0); LANES];
    for k in 0..LANES {
        packs[k] = U::Pack8::load(&lanes[k]);
    }
    let packs = U::Pack8::transpose(packs);
    for l in 0..LANES {
        packs[l].store(&mut points[l]);
    }
}

/// Particle to grid: mass and momentum (`INERTIA`), internal force (`FORCE`).
#[inline(always)]
pub fn scatter<U: Unit, S: Shape1d, const INERTIA: bool, const FORCE: bool>(
    with: Shaped<'_, S>,
    points: &Points,
    sums: &mut [NodeSum],
) {
    let Shaped { shape, map, constants } = with;
    let m = if INERTIA { constants.mass } else { 0.0 };
    let point_volume = seeded::times(Seed::TransferForce, constants.volume);
    let mut stencil = Stencils::EMPTY;
    // In the layout of NodeSum: gradients along x act on the fifth and sixth number, along y on the last two.
    let mut carried = [ZERO; 8];
    let mut by_point = [[0.0; 8]; LANES];
    for (number, (block, n)) in points.blocks().enumerate() {
        if let Some(soon) = points.block(number + AHEAD) {
            U::prefetch(soon);
        }
        map.stencils(&mut stencil, shape, block);
        for l in 0..LANES {
            let volume = point_volume * block.volume_ratio[l];
            if INERTIA {
                let pressure = if block.stress[2][l] < 0.0 { -block.stress[2][l] } else { 0.0 };
                carried[0][l] = m;
                carried[1][l] = m * block.v[0][l];
                carried[2][l] = m * block.v[1][l];
                carried[3][l] = volume * constants.side_friction * pressure;
            }
            if FORCE {
                carried[4][l] = -volume * block.stress[0][l];
                carried[5][l] = -volume * block.stress[3][l];
                carried[6][l] = carried[5][l];
                carried[7][l] = -volume * block.stress[1][l];
            }
        }
        transpose::<U>(&carried, &mut by_point);
        let mut l = 0;
        while l < n {
            // Sorted points share their stencil with the next few; their sum stays in registers.
            let start = l;
            let mut new = [[U::Pack8::splat(0.0); STENCIL]; STENCIL];
            while l < n && stencil.key[l] == stencil.key[start] {
                let carried = U::Pack8::load(&by_point[l]);
                let mut along_y = [carried; STENCIL];
                for j in 0..STENCIL {
                    let (w, g) = (stencil.w[1][j][l], stencil.g[1][j][l]);
                    along_y[j] = U::Pack8::four_two_two(w, w, g);
                }
                for i in 0..STENCIL {
                    let (w, g) = (stencil.w[0][i][l], stencil.g[0][i][l]);
                    let column = U::Pack8::four_two_two(w, g, w).mul(carried);
                    for j in 0..STENCIL {
                        new[i][j] = new[i][j].add(along_y[j].mul(column));
                    }
                }
                l += 1;
            }
            for i in 0..STENCIL {
                let nodes: &mut [NodeSum; STENCIL] =
                    sums[stencil.first[i][start]..].first_chunk_mut().expect(WITHIN_REACH);
                for j in 0..STENCIL {
                    U::Pack8::load(&nodes[j].0).add(new[i][j]).store(&mut nodes[j].0);
                }
            }
        }
    }
}

/// Particle to grid: the force of a field of accelerations. Not in the hot path, so one point at a time.
pub fn scatter_field<S: Shape1d>(
    with: Shaped<'_, S>,
    acceleration: &dyn Fn(&Particle) -> [f64; 2],
    points: &Points,
    force: &mut [[f64; 2]],
) {
    let Shaped { shape, map, constants } = with;
    let mut stencil = Stencils::EMPTY;
    for ((block, n), ids) in points.blocks().zip(points.ids()) {
        map.stencils(&mut stencil, shape, block);
        for l in 0..n {
            let f = acceleration(&block.get(l, ids[l])).map(|a| constants.mass * a);
            for i in 0..STENCIL {
                let nodes = &mut force[stencil.first[i][l]..][..STENCIL];
                for (j, node) in nodes.iter_mut().enumerate() {
                    let w = stencil.w[0][i][l] * stencil.w[1][j][l];
                    *node = [node[0] + w * f[0], node[1] + w * f[1]];
                }
            }
        }
    }
}

/// Grid to particle: velocity (FLIP with a share of PIC) and displacement; maps the new momentum back if asked (`REMAP`).
#[inline(always)]
pub fn gather_velocity<U: Unit, S: Shape1d, const REMAP: bool>(
    with: Shaped<'_, S>,
    update: VelocityUpdate,
    motion: &[[f64; 4]],
    points: &mut Points,
    displacement: &mut [[Lane; 2]],
    momentum: &mut [[f64; 2]],
) -> BandSums {
    let Shaped { shape, map, constants } = with;
    let m = constants.mass;
    let (mut kinetic, mut lost, mut fastest, mut farthest) = (ZERO, ZERO, ZERO, ZERO);
    let (mut stencil, mut seen) = (Stencils::EMPTY, [ZERO; 4]);
    let len = points.len();
    let (blocks, _) = points.blocks_mut();
    for (number, dx) in displacement.iter_mut().enumerate() {
        if let Some(soon) = blocks.get(number + 1) {
            U::prefetch(soon);
        }
        let (block, n) = (&mut blocks[number], LANES.min(len - number * LANES));
        map.stencils(&mut stencil, shape, block);
        let mut rows = [U::Pack4::splat(0.0); LANES];
        for l in 0..LANES {
            let (mut two, mut third) = (U::Pack8::splat(0.0), U::Pack4::splat(0.0));
            for i in 0..STENCIL {
                let column: &[f64; 4 * STENCIL] = at(motion.as_flattened(), 4 * stencil.first[i][l]);
                let w = stencil.w[0][i][l];
                let (nodes, node) = (column.first_chunk().expect("8 of 12"), column.last_chunk().expect("4 of 12"));
                two = two.add(U::Pack8::splat(w).mul(U::Pack8::load(nodes)));
                third = third.add(U::Pack4::splat(w).mul(U::Pack4::load(node)));
            }
            let [first, second] = two.halves();
            let w = &stencil.w[1];
            rows[l] = U::Pack4::splat(w[0][l]).mul(first);
            rows[l] = rows[l].add(U::Pack4::splat(w[1][l]).mul(second));
            rows[l] = rows[l].add(U::Pack4::splat(w[2][l]).mul(third));
        }
        columns::<U>(rows, &mut seen);
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
                dx[d][l] = moved;
                if update.move_now {
                    block.x[d][l] += moved;
                }
            }
        }
        if REMAP {
            let mut l = 0;
            while l < n {
                let start = l;
                let mut new = [U::Pack8::splat(0.0); STENCIL];
                while l < n && stencil.key[l] == stencil.key[start] {
                    let carried = U::Pack8::alternate(m * block.v[0][l], m * block.v[1][l]);
                    let w = &stencil.w[1];
                    let column = U::Pack8::pairs(w[0][l], w[1][l], w[2][l]).mul(carried);
                    for i in 0..STENCIL {
                        new[i] = new[i].add(U::Pack8::splat(stencil.w[0][i][l]).mul(column));
                    }
                    l += 1;
                }
                for i in 0..STENCIL {
                    let nodes = at_mut(momentum.as_flattened_mut(), 2 * stencil.first[i][start]);
                    U::Pack8::load(nodes).add(new[i]).store(nodes);
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
pub fn update_stress<U: Unit, S: Shape1d, L: Law>(
    with: Shaped<'_, S>,
    law: L,
    update: StressUpdate,
    velocity: &[[f64; 2]],
    points: &mut Points,
    displacement: &mut [[Lane; 2]],
) -> BandSums {
    let Shaped { shape, map, constants } = with;
    let half = if seeded::is(Seed::ConstitutiveSpin) { 0.0 } else { 0.5 };
    let mut work = ZERO;
    let mut smallest = [f64::INFINITY; LANES];
    let (mut stencil, mut gradient) = (Stencils::EMPTY, [ZERO; 4]);
    let len = points.len();
    let (blocks, histories) = points.blocks_mut();
    for (number, dx) in displacement.iter().enumerate() {
        if let Some(soon) = blocks.get(number + 1) {
            U::prefetch(soon);
        }
        let (block, n) = (&mut blocks[number], LANES.min(len - number * LANES));
        map.stencils(&mut stencil, shape, block);
        let mut rows = [U::Pack4::splat(0.0); LANES];
        for l in 0..LANES {
            // Weighted and differentiated along x; both velocities of three nodes.
            let (mut values, mut slopes) = (U::Pack8::splat(0.0), U::Pack8::splat(0.0));
            for i in 0..STENCIL {
                let column = U::Pack8::load(at(velocity.as_flattened(), 2 * stencil.first[i][l]));
                values = values.add(U::Pack8::splat(stencil.w[0][i][l]).mul(column));
                slopes = slopes.add(U::Pack8::splat(stencil.g[0][i][l]).mul(column));
            }
            let (w, g) = (&stencil.w[1], &stencil.g[1]);
            let along_x = slopes.mul(U::Pack8::pairs(w[0][l], w[1][l], w[2][l])).halves();
            let along_y = values.mul(U::Pack8::pairs(g[0][l], g[1][l], g[2][l])).halves();
            rows[l] = U::Pack4::fold(along_x[0].add(along_x[1]), along_y[0].add(along_y[1]));
        }
        // dv_x/dx, dv_y/dx, dv_x/dy, dv_y/dy
        columns::<U>(rows, &mut gradient);
        // Loaded and stored whole, so that nothing keeps the loop over the lanes from becoming vectors.
        let own = &mut histories[number * L::HISTORY..(number + 1) * L::HISTORY];
        let mut history = [ZERO; AnyLaw::HISTORY];
        history[..L::HISTORY].copy_from_slice(own);
        for l in 0..LANES {
            let increment = Increment {
                dt: update.dt,
                xx: update.dt * gradient[0][l],
                yy: update.dt * gradient[3][l],
                xy: 0.5 * update.dt * (gradient[2][l] + gradient[1][l]),
                spin: half * update.dt * (gradient[1][l] - gradient[2][l]),
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
                history: History::default(),
            };
            for k in 0..L::HISTORY {
                state.history[k] = history[k][l];
            }
            let density = law.update(&mut state, &increment);
            let before = block.volume_ratio[l];
            let after = law.volume_ratio(&state, before, &increment);
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
            for k in 0..L::HISTORY {
                history[k][l] = state.history[k];
            }
        }
        own.copy_from_slice(&history[..L::HISTORY]);
        if update.move_after {
            for d in 0..2 {
                for l in 0..LANES {
                    block.x[d][l] += dx[d][l];
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
