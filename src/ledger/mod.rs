//! Ledgers: where momentum and energy went.
//!
//! Momentum is booked by agent, energy by mechanism. Every entry is measured where it happens (at the node, at the point);
//! none is inferred from another, so what does not add up shows as a residual.
//!
//! Elsewhere: energy and momentum budgets.

mod drag;

use crate::boundary::nodes::Tally;
use crate::contact::rule::ContactTally;
use crate::seeded::{self, Seed};

pub use drag::{Distributed, Drag};

/// Sums since the ledger was opened. Impulses act on the material; works are done on the material.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ledger {
    /// Impulse of gravity, N s.
    pub gravity: [f64; 2],
    /// One per boundary.
    pub boundaries: Vec<Tally>,
    /// Energy of the elastic slip on each boundary now, J.
    pub elastic_slip: Vec<f64>,
    /// The same when the ledger was opened.
    pub opening_slip: Vec<f64>,
    /// One per contact of two bodies; their impulses cancel.
    pub contacts: Vec<ContactTally>,
    /// Mass-proportional damping.
    pub damping: Drag,
    /// Side-wall friction.
    pub side_walls: Drag,
    /// A field of accelerations, where one is set.
    pub field: Drag,
    /// Work of the stresses on the strains, J.
    pub internal_work: f64,
    /// Kinetic energy taken by the PIC share of the velocity update, J.
    pub pic_loss: f64,
    /// Momentum carried away by points that left the domain, N s.
    pub departed_momentum: [f64; 2],
    /// Kinetic, gravitational and elastic energy carried away by them, J.
    pub departed_energy: f64,
    /// Mass that left the domain, kg.
    pub departed_mass: f64,
    /// Mass that entered through the sections of inflows, kg.
    pub entered_mass: f64,
    /// The part of it that gravity acts on, kg.
    pub entered_heavy: f64,
    /// Momentum that came in with it, N s.
    pub entered_momentum: [f64; 2],
    /// Kinetic, gravitational and elastic energy that came in with it, J.
    pub entered_energy: f64,
    /// Impulse of what is behind the sections on what has entered, N s: what boundaries and drags do to it before it enters is in this, too.
    pub inflow_impulse: [f64; 2],
    /// Its work, J.
    pub inflow_work: f64,
    /// Sum of the magnitudes along the axes of the impulses of contacts, gravity, boundaries and inflows, N s: the scale on which closure is
    /// judged.
    pub impulse_scale: f64,
}

impl Ledger {
    /// An empty ledger for `boundaries` boundaries and `contacts` pairs of bodies in contact.
    pub fn new(boundaries: usize, contacts: usize) -> Self {
        Self {
            boundaries: vec![Tally::default(); boundaries],
            elastic_slip: vec![0.0; boundaries],
            opening_slip: vec![0.0; boundaries],
            contacts: vec![ContactTally::default(); contacts],
            ..Self::default()
        }
    }

    /// Momentum that everything together has given to the material since the ledger was opened, N s.
    pub fn impulse(&self) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (d, s) in sum.iter_mut().enumerate() {
            *s = self.gravity[d] + self.damping.impulse[d] + self.side_walls.impulse[d] + self.field.impulse[d]
                - self.departed_momentum[d]
                + self.inflow(d)
                + self.boundaries.iter().map(|b| b.impulse[d]).sum::<f64>();
        }
        sum
    }

    /// Momentum along an axis that inflows have given: what came in, and what pushed behind it, N s.
    pub fn inflow(&self, axis: usize) -> f64 {
        self.entered_momentum[axis] + self.inflow_impulse[axis]
    }
}

/// What the material holds at one moment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stock {
    /// Mass, kg.
    pub mass: f64,
    /// The part of it that gravity acts on, kg.
    pub heavy: f64,
    /// Momentum, N s.
    pub momentum: [f64; 2],
    /// Kinetic energy, J.
    pub kinetic: f64,
    /// Gravitational energy above the origin of the coordinates, J.
    pub gravitational: f64,
    /// Elastic energy, J.
    pub elastic: f64,
}

impl Stock {
    /// Adds what something else holds.
    pub fn add(&mut self, other: &Stock) {
        self.mass += other.mass;
        self.heavy += other.heavy;
        for d in 0..2 {
            self.momentum[d] += other.momentum[d];
        }
        self.kinetic += other.kinetic;
        self.gravitational += other.gravitational;
        self.elastic += other.elastic;
    }
}

/// Energy by mechanism since the ledger was opened, in J. Dissipation is positive.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EnergyBalance {
    /// Kinetic energy now.
    pub kinetic: f64,
    /// Gravitational energy now, above the datum.
    pub gravitational: f64,
    /// Elastic energy now, of the material and of elastic slip on boundaries.
    pub elastic: f64,
    /// Work of the stresses that was not stored: plastic dissipation.
    pub plastic: f64,
    /// Friction on each boundary, less what its elastic slip stores; then in each contact of two bodies.
    pub friction: Vec<f64>,
    /// Loss of normal motion at each boundary, negative where a moving boundary does work; then in each contact of two bodies.
    pub contact: Vec<f64>,
    /// PIC share of the velocity update.
    pub pic: f64,
    /// Damping.
    pub damping: f64,
    /// Side-wall friction.
    pub side_walls: f64,
    /// Carried out of the domain.
    pub outflow: f64,
    /// Given to a field of accelerations; negative where it drives the material.
    pub field: f64,
    /// Given by inflows: what came in above the datum, and the work of what pushed behind it. It adds to what was there.
    pub inflow: f64,
    /// What was there when the ledger was opened and what inflows gave, less all of the above.
    pub residual: f64,
    /// Total when the ledger was opened.
    pub initial: f64,
}

impl EnergyBalance {
    /// Balances what was there when the ledger was opened against what is there now. `datum` (J) is the gravitational energy of
    /// the mass at the level counted as zero: opening, now, and of what has entered.
    pub fn new(ledger: &Ledger, opening: &Stock, now: &Stock, datum: [f64; 3]) -> Self {
        let slip = [&ledger.opening_slip, &ledger.elastic_slip].map(|s| s.iter().sum::<f64>());
        let initial = opening.kinetic + opening.gravitational - datum[0] + (opening.elastic + slip[0]);
        let pairs = || ledger.contacts.iter().map(|c| &c.exchange);
        // What the elastic slip holds of the work against friction is not lost.
        let kept = if seeded::is(Seed::LedgerSlip) { 0.0 } else { 1.0 };
        let stored = |k: usize| kept * (ledger.elastic_slip[k] - ledger.opening_slip[k]);
        let boundaries = ledger.boundaries.iter().enumerate();
        let friction: Vec<f64> =
            boundaries.map(|(k, b)| -b.friction_work - stored(k)).chain(pairs().map(|c| -c.friction_work)).collect();
        let contact: Vec<f64> =
            ledger.boundaries.iter().map(|b| -b.normal_work).chain(pairs().map(|c| -c.normal_work)).collect();
        let mut balance = Self {
            kinetic: now.kinetic,
            gravitational: now.gravitational - datum[1],
            elastic: now.elastic + slip[1],
            plastic: ledger.internal_work
                - (now.elastic - if seeded::is(Seed::LedgerPlastic) { 0.0 } else { opening.elastic }),
            friction,
            contact,
            pic: seeded::times(Seed::LedgerPic, ledger.pic_loss),
            damping: -ledger.damping.work,
            side_walls: -ledger.side_walls.work,
            outflow: ledger.departed_energy - (datum[0] + datum[2] - datum[1]),
            field: -ledger.field.work,
            inflow: ledger.entered_energy - datum[2] + ledger.inflow_work,
            residual: 0.0,
            initial,
        };
        balance.residual = balance.given() - balance.accounted();
        balance
    }

    /// What has been released by now, J: the kinetic and elastic energy at the opening, and what gravity has given since. It does not
    /// depend on the level at which gravitational energy is zero. What left the domain took its share along. Of what has entered, its
    /// kinetic and elastic energy count, and what gravity and those behind it have given to it.
    pub fn released(&self) -> f64 {
        self.given() - self.gravitational - self.outflow
    }

    /// What was there when the ledger was opened, and what inflows have given since, J.
    pub fn given(&self) -> f64 {
        self.initial + self.inflow
    }

    /// Sum of everything but the residual, J.
    pub fn accounted(&self) -> f64 {
        self.kinetic
            + self.gravitational
            + self.elastic
            + self.plastic
            + self.friction.iter().sum::<f64>()
            + self.contact.iter().sum::<f64>()
            + self.pic
            + self.damping
            + self.side_walls
            + self.outflow
            + self.field
    }
}

#[cfg(test)]
mod tests;
