//! Flows that enter through a section while the simulation runs.
//!
//! Behind its section an inflow is led: its points move at the velocity and have the stress that are given, whatever the grid makes of
//! them in a step, from the moment at which they appear, some cells behind the section, until they have crossed it. So the material in
//! the section has neighbours on both sides, as in the middle of a flow: it has no free surface there, and no wall. What is led takes
//! part in the step as all points do, and what it gives to the material that has entered is booked: its momentum and energy before the
//! step, less after it, are the impulse and the work of the inflow.
//!
//! Points enter at moments that depend on the clock alone: when the flow has travelled by another column of points. Mass, momentum and
//! energy of what has entered are then exact, and the mass is behind that of a continuous flow by less than a column.
//!
//! What is led is a body of its own that nobody sees: points, blocks and stocks of a simulation are those of what has entered.
//!
//! Elsewhere: inflow (inlet) boundary condition with a buffer zone, open boundary, particle generator.

use super::{Simulation, potential};
use crate::body::Particle;
use crate::constitutive::{Law, PointState, Stress};
use crate::seeded::{self, Seed};
use crate::space::{dot, minus, plus, scaled};

/// How far and how fast the flow has travelled: velocities at moments, linear in between.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    /// Moments, s, in order; at least two.
    pub times: Vec<f64>,
    /// Depth-averaged velocity at each of them, m/s, not negative.
    pub speeds: Vec<f64>,
}

impl Way {
    /// When it begins and ends, s.
    pub fn span(&self) -> [f64; 2] {
        [self.times[0], self.times[self.times.len() - 1]]
    }

    /// The velocity at a time, m/s; that of the first and the last moment before and after them.
    pub fn speed(&self, time: f64) -> f64 {
        let last = self.times.len() - 1;
        let k = self.times.partition_point(|t| *t <= time).clamp(1, last);
        let share = ((time - self.times[k - 1]) / (self.times[k] - self.times[k - 1])).clamp(0.0, 1.0);
        self.speeds[k - 1] + share * (self.speeds[k] - self.speeds[k - 1])
    }

    /// Distance travelled since the first moment, m. After the last one it goes on at the last velocity.
    pub fn travel(&self, time: f64) -> f64 {
        let ends = self.times.windows(2).zip(self.speeds.windows(2));
        let mut sum = 0.0;
        for (t, v) in ends {
            let passed = (time.min(t[1]) - t[0]).max(0.0);
            let reached = v[0] + passed / (t[1] - t[0]) * (v[1] - v[0]);
            sum += 0.5 * (v[0] + reached) * passed;
        }
        let [_, end] = self.span();
        sum + (time - end).max(0.0) * self.speeds[self.speeds.len() - 1]
    }
}

/// A point that will enter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coming {
    /// How far behind the section it lies when the inflow begins, m.
    pub behind: f64,
    /// Its height above the foot of the section, m.
    pub height: f64,
    /// Its velocity over the mean of the depth.
    pub pace: f64,
    /// Depth of the flow where it is, m.
    pub depth: f64,
}

/// A flow that enters through a section.
#[derive(Debug, Clone, PartialEq)]
pub struct Inflow {
    /// Index of the body that what has entered belongs to.
    pub body: usize,
    /// Foot of the section, which is normal to x, m.
    pub foot: [f64; 2],
    /// 1 where the flow runs along x, -1 where it runs against it.
    pub direction: f64,
    /// How it travels.
    pub way: Way,
    /// Its points, in the order in which they appear: with (behind - reach) / pace.
    pub points: Vec<Coming>,
    /// Stress at a depth of a metre below its surface, Pa; the stress grows with the depth below that.
    pub stress: Stress,
    /// How far behind the section points appear, m: so many cells that the material in the section sees no end.
    pub reach: f64,
    /// Way after which another column enters, m.
    pub column: f64,
}

impl Inflow {
    /// Point of number `id` when the mean of the flow has travelled so far (m) and moves at `speed` (m/s).
    fn point(&self, id: u32, travel: f64, speed: f64) -> Particle {
        let coming = &self.points[id as usize];
        let x = self.foot[0] + self.direction * (coming.pace * travel - coming.behind);
        let below = (coming.depth - coming.height).max(0.0);
        let below = if seeded::is(Seed::SimulationInflowStress) { 0.0 } else { below };
        let s = &self.stress;
        let stress = Stress { xx: below * s.xx, yy: below * s.yy, zz: below * s.zz, xy: below * s.xy };
        Particle {
            v: [self.direction * coming.pace * speed, 0.0],
            state: PointState { stress, ..PointState::default() },
            ..Particle::at_rest(id, [x, self.foot[1] + coming.height])
        }
    }
}

/// An inflow, and how far it is.
#[derive(Debug, Clone)]
pub(super) struct Entering {
    inflow: Inflow,
    /// Index of the body that is led.
    led: usize,
    /// The next point that appears.
    next: usize,
    /// Columns that have entered, as whole distances travelled; none before it begins.
    columns: Option<f64>,
    /// Whether all has entered.
    done: bool,
}

impl Entering {
    /// Whether columns are due at a time (s).
    fn is_due(&mut self, time: f64) -> bool {
        let [start, end] = self.inflow.way.span();
        if self.done || time < start {
            return false;
        }
        let columns = (self.inflow.way.travel(time) / self.inflow.column).floor();
        let due = time >= end || self.columns.is_none_or(|before| columns > before);
        self.columns = Some(columns);
        due
    }
}

impl Simulation {
    /// Adds flows that enter, each with points of a body that is there and has none yet. They wait for
    /// [`open_inflows`](Self::open_inflows).
    pub fn set_inflows(&mut self, inflows: Vec<Inflow>) {
        for inflow in inflows {
            let mut led = self.bodies[inflow.body].clone();
            led.name += " behind its section";
            let index = self.bodies.len();
            if let Some(field) = self.fields.iter_mut().find(|f| f.members.contains(&inflow.body)) {
                field.add(index, led.clone(), &[]);
            }
            self.bodies.push(led);
            self.speeds.push(0.0);
            self.inflows.push(Entering { inflow, led: index, next: 0, columns: None, done: false });
        }
        (0..self.fields.len()).for_each(|k| self.sort(k));
    }

    /// From now on inflows enter, by the clock of the simulation.
    pub fn open_inflows(&mut self) {
        self.entering = !self.inflows.is_empty();
    }

    /// The inflows.
    pub fn inflows(&self) -> impl Iterator<Item = &Inflow> {
        self.inflows.iter().map(|e| &e.inflow)
    }

    /// The bodies of inflows that have not ended, by index.
    pub fn unfinished_inflows(&self) -> impl Iterator<Item = usize> {
        self.inflows.iter().filter(|e| !e.done).map(|e| e.inflow.body)
    }

    /// Whether an inflow has not ended yet.
    pub fn is_entering(&self) -> bool {
        self.entering && self.inflows.iter().any(|e| !e.done)
    }

    /// Lets enter what is due now, and appear what comes behind it.
    pub(super) fn admit(&mut self) {
        for k in 0..self.inflows.len() {
            let time = self.time;
            if !self.inflows[k].is_due(time) {
                continue;
            }
            let Entering { inflow, led, next, columns, done } = &mut self.inflows[k];
            let (own, led) = (inflow.body, *led);
            let Some(f) = self.fields.iter().position(|f| f.members.contains(&led)) else { continue };
            let place = |body: usize| self.fields[f].members.iter().position(|m| *m == body);
            let (Some(own_at), Some(led_at)) = (place(own), place(led)) else { continue };
            let (travel, speed) = (inflow.way.travel(time), inflow.way.speed(time));
            // Columns that have wholly passed the section; at the end, all that is left.
            *done = time >= inflow.way.span()[1];
            let passed = if *done { f64::INFINITY } else { columns.unwrap_or(0.0) * inflow.column };
            let field = &mut self.fields[f];
            let mut behind: Vec<Particle> = field.bands.iter().flat_map(|b| b.points[led_at].iter()).collect();
            field.bands.iter_mut().for_each(|band| band.points[led_at].clear());
            while let Some(coming) = inflow.points.get(*next) {
                if !*done && coming.behind - coming.pace * travel > inflow.reach {
                    break;
                }
                let lost =
                    seeded::is(Seed::SimulationInflowColumn) && (coming.behind / inflow.column) as usize % 32 == 16;
                if !lost {
                    behind.push(inflow.point(*next as u32, travel, speed));
                }
                *next += 1;
            }
            let fastest = inflow.points.iter().map(|c| c.pace).fold(0.0, f64::max) * speed;
            self.speeds[led] = self.speeds[led].max(fastest);
            let has_passed = |p: &Particle| {
                let coming = &inflow.points[p.id as usize];
                coming.behind <= coming.pace * passed
            };
            let (entered, still): (Vec<_>, Vec<_>) = behind.into_iter().partition(has_passed);
            if let Some(band) = field.bands.first_mut() {
                entered.iter().for_each(|p| band.points[own_at].push(p));
                still.iter().for_each(|p| band.points[led_at].push(p));
            }
            entered.iter().for_each(|p| self.book_entry(own, p));
            self.sort(f);
        }
    }

    fn book_entry(&mut self, body: usize, p: &Particle) {
        let body = &self.bodies[body];
        let m = body.point_mass;
        let heavy = if body.weightless { 0.0 } else { m };
        let elastic = body.point_volume * p.volume_ratio * body.law.stored_energy(&p.state);
        self.mass += m;
        self.heavy += heavy;
        let ledger = &mut self.ledger;
        ledger.entered_mass += seeded::times(Seed::LedgerInflowMass, m);
        ledger.entered_heavy += heavy;
        let energy = 0.5 * m * p.speed() * p.speed() + elastic + heavy * potential(self.forces.gravity, p.x);
        ledger.entered_energy += seeded::times(Seed::LedgerInflow, energy);
        // The elastic energy comes into the stock without work of the stresses.
        ledger.internal_work += elastic;
        let momentum = scaled(p.v, seeded::times(Seed::LedgerInflowMomentum, m));
        ledger.entered_momentum = plus(ledger.entered_momentum, momentum);
        ledger.impulse_scale += momentum[0].abs() + momentum[1].abs();
    }

    /// Leads what is behind the sections through the step of `dt` seconds that has been done, and books what it gave to the others.
    pub(super) fn lead(&mut self, dt: f64) {
        let Self { inflows, fields, bodies, ledger, forces, time, .. } = self;
        let times = [*time, *time + dt];
        for Entering { inflow, led, .. } in inflows.iter().filter(|e| e.columns.is_some()) {
            let Some(field) = fields.iter_mut().find(|f| f.members.contains(led)) else { continue };
            let Some(at) = field.members.iter().position(|m| m == led) else { continue };
            let body = &bodies[*led];
            let (m, heavy) = (body.point_mass, if body.weightless { 0.0 } else { body.point_mass });
            let [before, now] = times.map(|t| (inflow.way.travel(t), inflow.way.speed(t)));
            let (mut impulse, mut work, mut moved) = ([0.0; 2], 0.0, 0.0f64);
            let mut lead = |p: &mut Particle| {
                let was = inflow.point(p.id, before.0, before.1);
                let is = inflow.point(p.id, now.0, now.1);
                // What it has lost in the step, all others have gained.
                let weight = scaled(forces.gravity, heavy * dt);
                impulse = plus(impulse, minus(weight, scaled(minus(p.v, was.v), m)));
                let kinetic = 0.5 * m * (dot(p.v, p.v) - dot(was.v, was.v));
                work -= kinetic + heavy * (potential(forces.gravity, p.x) - potential(forces.gravity, was.x));
                moved = moved.max((is.x[0] - p.x[0]).abs()).max((is.x[1] - p.x[1]).abs());
                *p = Particle { slip: p.slip, ..is };
            };
            field.bands.iter_mut().for_each(|band| band.points[at].for_each_mut(&mut lead));
            field.drift += moved;
            ledger.inflow_impulse = plus(ledger.inflow_impulse, impulse);
            ledger.impulse_scale += impulse[0].abs() + impulse[1].abs();
            ledger.inflow_work += work;
        }
    }
}
