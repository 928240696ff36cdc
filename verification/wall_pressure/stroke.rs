//! A wall that moves: what it feels, and how the fill gives way.

use crate::scene::{Brick, Material, THICKNESS, points_by_number, scene};
use crate::{Fault, RungFailure};
use checkdam::body::Particle;
use checkdam::boundary::{Boundary, Friction};
use checkdam::constitutive::{AnyLaw, Cone, DruckerPrager};
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::drucker_prager;
use checkdam::theory::elastic::confined_speed;
use nalgebra::Vector2;

/// Friction angle of the fill, rad.
pub const PHI: f64 = 31.0 * std::f64::consts::PI / 180.0;
/// Height of the fill, m.
pub const HEIGHT: f64 = 0.5;
/// Gravity, m/s2.
pub const GRAVITY: f64 = 9.81;

/// A fill, its wall and what the wall does.
#[derive(Debug, Clone, Copy)]
pub struct Setup {
    /// How the cone is matched.
    pub cone: Cone,
    /// Dilatancy angle, rad.
    pub dilatancy: f64,
    /// The fill.
    pub fill: Material,
    /// Friction of the wall.
    pub wall: Friction,
    /// Whether the base is smooth; otherwise it is as strong as the fill in simple shear.
    pub smooth_base: bool,
    /// Cells along the fill.
    pub along: usize,
    /// Cells over the height.
    pub cells: usize,
    /// How far the wall moves into the fill (or out of it, if negative), m.
    pub stroke: f64,
    /// Speed of the wall over the speed of P-waves.
    pub mach: f64,
    /// Damping while the wall moves, over P-wave speed / height.
    pub damping: f64,
}

/// One moment of a stroke. Forces are on the wall, per width.
#[derive(Debug, Clone, Copy, Default)]
pub struct Moment {
    /// Travel of the wall, m.
    pub stroke: f64,
    /// Normal force, N/m.
    pub normal: f64,
    /// Force along the face, N/m, positive upwards.
    pub shear: f64,
    /// Height at which the normal force acts, m.
    pub arm: f64,
}

/// What a stroke shows.
#[derive(Debug, Clone)]
pub struct Stroke {
    /// Means over sixtieths of the stroke; the first is the fill at rest.
    pub moments: Vec<Moment>,
    /// The points at the end by rows from the base, and how far each went along x in the last third of the stroke, m.
    pub rows: Vec<Vec<(Particle, f64)>>,
}

impl Stroke {
    /// Mean over the last sixth.
    pub fn end(&self) -> Moment {
        let last = &self.moments[self.moments.len() - PARTS / 6..];
        let mean = |f: fn(&Moment) -> f64| last.iter().map(f).sum::<f64>() / last.len() as f64;
        Moment { stroke: self.stroke(), normal: mean(|m| m.normal), shear: mean(|m| m.shear), arm: mean(|m| m.arm) }
    }

    /// The extreme normal force in the direction of the stroke, as a mean over a twelfth of it, N/m.
    pub fn extreme(&self) -> f64 {
        let width = PARTS / 12;
        let means = self.moments[1..].windows(width).map(|w| w.iter().map(|m| m.normal).sum::<f64>() / width as f64);
        if self.stroke() < 0.0 { means.fold(f64::INFINITY, f64::min) } else { means.fold(0.0, f64::max) }
    }

    fn stroke(&self) -> f64 {
        self.moments.last().map_or(0.0, |m| m.stroke)
    }

    /// The edge of what moved with the wall in the last third of its stroke: by rows of points, height (m) and distance from
    /// the wall (m) at which the displacement falls below half of the wall's.
    pub fn edge(&self) -> Vec<[f64; 2]> {
        let half = 0.5 * self.stroke().abs() / 3.0;
        let edge = |row: &Vec<(Particle, f64)>| {
            let next = row.iter().position(|p| p.1.abs() < half).filter(|&i| i > 0)?;
            let ((a, da), (b, db)) = (row[next - 1], row[next]);
            let share = (da.abs() - half) / (da.abs() - db.abs());
            Some([a.x[1], a.x[0] + share * (b.x[0] - a.x[0])])
        };
        self.rows.iter().filter_map(edge).collect()
    }

    /// Inclination of that edge against the horizontal, degrees, by least squares between 0.15 and 0.85 of the height.
    pub fn wedge_angle(&self) -> f64 {
        let edge: Vec<_> = self.edge().into_iter().filter(|e| (0.15..0.85).contains(&(e[0] / HEIGHT))).collect();
        let n = edge.len() as f64;
        let mean = [0, 1].map(|d| edge.iter().map(|e| e[d]).sum::<f64>() / n);
        let sum = |f: fn(f64, f64) -> f64| edge.iter().map(|e| f(e[0] - mean[0], e[1] - mean[1])).sum::<f64>();
        libm::atan2(sum(|y, _| y * y), sum(|y, x| y * x)).to_degrees()
    }
}

/// Parts into which a stroke is divided.
pub const PARTS: usize = 60;

impl Setup {
    /// Lets the fill settle, then moves the wall.
    pub fn run(&self, fault: &Fault) -> Result<Stroke, RungFailure> {
        let h = HEIGHT / self.cells as f64;
        let brick = Brick::new([0.0, 0.0], [self.along, self.cells], h);
        let mut law =
            DruckerPrager::new(self.fill.linear_elastic(fault), self.cone, PHI, self.dilatancy, 0.0, 0.0, true);
        law.friction *= fault.friction;
        let at = Vector2::new;
        let wall = match self.wall {
            Friction::Coulomb(mu) => Friction::Coulomb(mu * fault.friction),
            other => other,
        };
        let shear = drucker_prager::simple_shear_ratio(law.friction, law.dilatancy);
        let base = if self.smooth_base { Friction::Smooth } else { Friction::Coulomb(shear) };
        let length = h * self.along as f64;
        let boundaries = vec![
            Boundary::plane("wall", at(0.0, 0.0), at(1.0, 0.0), wall),
            Boundary::plane("far end", at(length, 0.0), at(-1.0, 0.0), Friction::Smooth),
            Boundary::plane("base", at(0.0, 0.0), at(0.0, 1.0), base),
        ];
        let law = AnyLaw::DruckerPrager(law);
        let mut scene = scene(&brick, law, self.fill.density * fault.density, brick.points(), boundaries);
        scene.numerics.pic = PicShare::Fraction(0.01);
        let mut sim = Simulation::new(scene);
        let speed = confined_speed(&self.fill.elastic, self.fill.density);
        let crossing = HEIGHT / speed;
        sim.set_damping(2.0 / crossing);
        let (raised, still) = (20.0 * crossing, 30.0 * crossing);
        while sim.time() < still {
            let share = (sim.time() / raised).min(1.0);
            sim.set_gravity([0.0, -GRAVITY * fault.gravity * share]);
            sim.step()?;
        }
        let mut moments = vec![part(&mut sim, 2.0 * crossing, fault)?];
        let v = self.mach * speed * self.stroke.signum();
        sim.set_damping(self.damping / crossing);
        sim.set_boundary_velocity(0, [v, 0.0]);
        let mut before = Vec::new();
        for k in 0..PARTS {
            if 3 * k == 2 * PARTS {
                before = points_by_number(&sim);
            }
            moments.push(part(&mut sim, (self.stroke / v) / PARTS as f64, fault)?);
        }
        let points: Vec<_> =
            points_by_number(&sim).into_iter().zip(before).map(|(p, b)| (p, p.x[0] - b.x[0])).collect();
        let rows = points.chunks(brick.cells[0] * brick.per_cell).map(<[_]>::to_vec).collect();
        Ok(Stroke { moments, rows })
    }
}

/// Runs for a while and returns the means of what the wall felt.
fn part(sim: &mut Simulation, duration: f64, fault: &Fault) -> Result<Moment, RungFailure> {
    let (mut time, mut impulse, mut moment) = (0.0, [0.0; 2], 0.0);
    while time < duration {
        sim.step()?;
        let tally = sim.step_tallies()[0];
        time += sim.time_step().dt;
        impulse = [impulse[0] + tally.impulse[0], impulse[1] + tally.impulse[1]];
        moment += tally.moment;
    }
    let per = fault.contact_force / (time * THICKNESS);
    Ok(Moment {
        stroke: sim.boundaries()[0].travel.x,
        normal: impulse[0] * per,
        shear: -impulse[1] * per,
        arm: -moment / impulse[0],
    })
}
