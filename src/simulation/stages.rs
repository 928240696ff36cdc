//! The stages of a step, each on one band.
//!
//! USF, USL and MUSL are update stress first, last, and modified last.

use super::field::VelocityField;
use super::sweep::On;
use super::{AccelerationField, Scheme, Simulation};
use crate::band::{Band, BandSums, NodeSum, Workspace};
use crate::body::{Body, Particle};
use crate::boundary::Boundary;
use crate::momentum::{self, BodyForces};
use crate::seeded::{self, Seed};
use crate::shape::ShapeFunction;
use crate::transfer::{NodeMap, PointConstants, Scatter, StressUpdate, Transfer, VelocityUpdate};

/// One stage of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// p2g: nodal mass, momentum and internal force.
    PointsToGrid(Scatter),
    /// Nodal velocities of the step's start.
    OldVelocities,
    /// Momentum balance and contact at the nodes.
    Momentum,
    /// g2p: new velocities and displacements; for MUSL also their momentum, back on the grid.
    GridToPoints,
    /// Nodal velocities from the momentum mapped back.
    RemappedVelocities,
    /// Strain increments, stresses and volumes; then the points move, unless they have moved.
    Stress,
}

impl Scheme {
    /// The stages of a step: Ng et al., Appendix A, with contact on the grid as in their Appendix B.
    pub(super) const fn stages(self) -> &'static [(On, Stage)] {
        use {On::Nodes, On::Points, Stage::*};
        match self {
            Scheme::Usf => &[
                (Points, PointsToGrid(Scatter::Inertia)),
                (Nodes, OldVelocities),
                (Points, Stress),
                (Points, PointsToGrid(Scatter::Force)),
                (Nodes, Momentum),
                (Points, GridToPoints),
            ],
            Scheme::Usl => {
                &[(Points, PointsToGrid(Scatter::All)), (Nodes, Momentum), (Points, GridToPoints), (Points, Stress)]
            }
            Scheme::Musl => &[
                (Points, PointsToGrid(Scatter::All)),
                (Nodes, Momentum),
                (Points, GridToPoints),
                (Nodes, RemappedVelocities),
                (Points, Stress),
            ],
        }
    }
}

/// What the stages of one step have in common.
pub(super) struct Step<'a> {
    boundaries: &'a [Boundary],
    shape: ShapeFunction,
    forces: BodyForces,
    field: Option<&'a AccelerationField>,
    side_friction: f64,
    /// Bodies from this one on are led, see `inflow`.
    seen: usize,
    time: f64,
    velocity: VelocityUpdate,
    stress: StressUpdate,
}

impl Simulation {
    /// The step of `dt` seconds that begins now.
    pub(super) fn begin(&self, dt: f64) -> Step<'_> {
        let scheme = self.numerics.scheme;
        Step {
            boundaries: &self.boundaries,
            shape: self.numerics.shape,
            forces: self.forces,
            field: self.field.as_ref(),
            side_friction: self.side_friction,
            seen: self.seen,
            time: self.time,
            velocity: VelocityUpdate {
                dt,
                pic: seeded::times(Seed::TransferPic, self.numerics.pic.fraction(dt)),
                remap: scheme == Scheme::Musl,
                move_now: scheme == Scheme::Usf,
            },
            stress: StressUpdate { dt: seeded::times(Seed::TransferStrain, dt), move_after: scheme != Scheme::Usf },
        }
    }
}

impl Step<'_> {
    /// Does one stage on one band of a velocity field, given the band before it.
    pub(super) fn run(&self, stage: Stage, of: &VelocityField, before: Option<&mut Band>, band: &mut Band) {
        match stage {
            Stage::PointsToGrid(what) => self.points_to_grid(what, of, band),
            Stage::OldVelocities => momentum::old_velocities(before, band),
            Stage::Momentum => {
                momentum::balance(before, band, self.boundaries, of.forces(self.forces), self.velocity.dt);
            }
            Stage::GridToPoints => self.grid_to_points(of, band),
            Stage::RemappedVelocities => momentum::remapped_velocities(before, band, self.velocity.dt),
            Stage::Stress => self.update_stress(of, band),
        }
    }

    fn points_to_grid(&self, what: Scatter, of: &VelocityField, band: &mut Band) {
        let map = NodeMap::new(&of.grid, band.first_node);
        if what != Scatter::Force {
            band.make_room();
            band.work.sums.fill(NodeSum::default());
        }
        for (body, points) in of.bodies.iter().zip(&band.points) {
            self.transfer(map, body).scatter(what, points, &mut band.work.sums);
        }
        let Some(AccelerationField(field)) = self.field.filter(|_| what != Scatter::Inertia) else { return };
        band.field_force.clear();
        band.field_force.resize(band.reach, [0.0; 2]);
        for (body, points) in of.bodies.iter().zip(&band.points) {
            let at = |p: &Particle| field(p, self.time);
            self.transfer(map, body).scatter_field(&at, points, &mut band.field_force);
        }
    }

    fn grid_to_points(&self, of: &VelocityField, band: &mut Band) {
        let map = NodeMap::new(&of.grid, band.first_node);
        let Workspace { motion, remapped, moved, .. } = &mut band.work;
        if self.velocity.remap {
            remapped.fill([0.0; 2]);
        }
        let (mut sums, mut led, mut moved) = (BandSums::default(), 0.0, &mut moved[..]);
        for ((body, member), points) in of.bodies.iter().zip(&of.members).zip(&mut band.points) {
            let (displacement, rest) = moved.split_at_mut(points.block_count());
            moved = rest;
            let transfer = self.transfer(map, body);
            let part = transfer.gather_velocity(self.velocity, motion, points, displacement, remapped);
            sums.kinetic += part.kinetic;
            *if *member < self.seen { &mut sums.pic_loss } else { &mut led } += part.pic_loss;
            sums.max_speed = sums.max_speed.max(part.max_speed);
            sums.max_displacement = sums.max_displacement.max(part.max_displacement);
        }
        sums.led_work = led + if self.velocity.move_now { band.sums.led_work } else { 0.0 };
        sums.internal_work = band.sums.internal_work;
        sums.min_volume_ratio = band.sums.min_volume_ratio;
        band.sums = sums;
    }

    fn update_stress(&self, of: &VelocityField, band: &mut Band) {
        let map = NodeMap::new(&of.grid, band.first_node);
        let Workspace { strain_velocity: velocity, moved, .. } = &mut band.work;
        let mut moved = &mut moved[..];
        let (mut work, mut led, mut smallest) = (0.0, 0.0, f64::INFINITY);
        for ((body, member), points) in of.bodies.iter().zip(&of.members).zip(&mut band.points) {
            let (displacement, rest) = moved.split_at_mut(points.block_count());
            moved = rest;
            let transfer = self.transfer(map, body);
            let part = transfer.update_stress(body.law, self.stress, velocity, points, displacement);
            *if *member < self.seen { &mut work } else { &mut led } += part.internal_work;
            smallest = smallest.min(part.min_volume_ratio);
        }
        band.sums.internal_work = work;
        // With the stress first, the velocities come after it, and add to it; else before.
        band.sums.led_work = led + if self.stress.move_after { band.sums.led_work } else { 0.0 };
        band.sums.min_volume_ratio = smallest;
    }

    fn transfer<'a>(&self, map: NodeMap<'a>, body: &Body) -> Transfer<'a> {
        let side_friction = if body.between_side_walls { self.side_friction } else { 0.0 };
        let side_friction = seeded::times(Seed::TransferSides, side_friction);
        let constants = PointConstants { mass: body.point_mass, volume: body.point_volume, side_friction };
        Transfer { half_width: self.shape.half_width(body.points_per_direction), map, constants }
    }
}
