//! Watches a run: plastic work by region, and the ledger beside it.

use super::regions::{Cells, Region};
use super::{INTERVAL, ROW, THRESHOLDS, work};
use crate::barrier::close_up::releases::Arrival;
use checkdam::constitutive::PointState;
use checkdam::ledger::{EnergyBalance, Stock};
use checkdam::simulation::Simulation;

/// The ledger and the plastic work by region, from the release to a time.
#[derive(Debug, Clone, PartialEq)]
pub(in super::super) struct Row {
    /// s after release.
    pub time: f64,
    /// The ledger.
    pub balance: EnergyBalance,
    /// What the barrier holds.
    pub barrier: Stock,
    /// Plastic work in the deposit, at the slip surface on the deposit's and on the flow's side, and in the flow, J.
    pub work: [f64; 4],
    /// Mass of the deposit, kg.
    pub deposit: f64,
}

/// Sums up the plastic work of the sand.
pub(in super::super) struct Observer {
    sand: usize,
    barrier: usize,
    arrival: Arrival,
    /// Level at which gravitational energy is zero, m.
    datum: [f64; 2],
    cells: Cells,
    /// By number of the point: its state, its position at the start of the interval, its work since then.
    states: Vec<PointState>,
    starts: Vec<[f64; 2]>,
    works: Vec<f64>,
    /// Number of the interval, from the arrival on.
    interval: i64,
    began: f64,
    /// Work since the release by threshold and region, J.
    sums: [[f64; 4]; THRESHOLDS.len()],
    at_arrival: Option<[[f64; 4]; THRESHOLDS.len()]>,
    deposit: f64,
    rows: Vec<Row>,
}

impl Observer {
    /// Of these two bodies; `simulation` is at the release.
    pub fn new(simulation: &Simulation, sand: usize, barrier: usize, arrival: Arrival, datum: [f64; 2]) -> Self {
        let count = simulation.points_of(sand).map(|p| p.id as usize + 1).max().unwrap_or(0);
        let mut states = vec![PointState::default(); count];
        let mut starts = vec![[0.0; 2]; count];
        for p in simulation.points_of(sand) {
            (states[p.id as usize], starts[p.id as usize]) = (p.state, p.x);
        }
        Self {
            sand,
            barrier,
            arrival,
            datum,
            cells: Cells::new(simulation.spacing(), simulation.domain()),
            states,
            starts,
            works: vec![0.0; count],
            interval: ((simulation.time() - arrival.time) / INTERVAL).floor() as i64,
            began: simulation.time(),
            sums: Default::default(),
            at_arrival: None,
            deposit: 0.0,
            rows: vec![Row {
                time: simulation.time(),
                balance: simulation.energy_balance(&simulation.stock(), datum),
                barrier: simulation.stock_of(|b| b == barrier),
                work: [0.0; 4],
                deposit: 0.0,
            }],
        }
    }

    /// After a step.
    pub fn step(&mut self, simulation: &Simulation) {
        let volume = simulation.bodies()[self.sand].point_volume;
        for p in simulation.points_of(self.sand) {
            let k = p.id as usize;
            self.works[k] += volume * p.volume_ratio * work::density(&self.states[k], &p.state);
            self.states[k] = p.state;
        }
        // The arrival is the time of a step, and must not be missed by the last bit.
        let interval = ((simulation.time() - self.arrival.time) / INTERVAL + 1e-6).floor() as i64;
        if interval == self.interval {
            return;
        }
        self.end_interval(simulation);
        if self.interval < 0 && interval >= 0 {
            self.at_arrival = Some(self.sums);
        }
        let rows = |interval: i64| interval.div_euclid(ROW as i64);
        if rows(interval) != rows(self.interval) {
            self.row(simulation);
        }
        self.interval = interval;
    }

    /// Ends the run: the rows, and the plastic work after the arrival by threshold and region, J.
    pub fn finish(mut self, simulation: &Simulation) -> (Vec<Row>, [[f64; 4]; THRESHOLDS.len()]) {
        self.end_interval(simulation);
        self.row(simulation);
        let before = self.at_arrival.unwrap_or(self.sums);
        let mut after = self.sums;
        after.iter_mut().flatten().zip(before.iter().flatten()).for_each(|(a, b)| *a -= b);
        (self.rows, after)
    }

    fn end_interval(&mut self, simulation: &Simulation) {
        if simulation.time() <= self.began {
            return;
        }
        self.cells.clear();
        for p in simulation.points_of(self.sand) {
            let (from, at) = (self.starts[p.id as usize], self.cells.index(p.x));
            self.cells.add_sand(at, [p.x[0] - from[0], p.x[1] - from[1]]);
        }
        for p in simulation.points_of(self.barrier) {
            let at = self.cells.index(p.x);
            self.cells.add_barrier(at);
        }
        let travelled = self.arrival.velocity * (simulation.time() - self.began);
        for (sums, threshold) in self.sums.iter_mut().zip(THRESHOLDS) {
            let deposit = self.cells.deposit(threshold.rest * travelled);
            let regions = self.cells.regions(&deposit, threshold.cells);
            let mut mass = 0.0;
            for p in simulation.points_of(self.sand) {
                let region = regions[self.cells.index(p.x)];
                sums[region as usize] += self.works[p.id as usize];
                if matches!(region, Region::Deposit | Region::SlipDeposit) {
                    mass += simulation.bodies()[self.sand].point_mass;
                }
            }
            if threshold == THRESHOLDS[0] {
                self.deposit = mass;
            }
        }
        for p in simulation.points_of(self.sand) {
            (self.starts[p.id as usize], self.works[p.id as usize]) = (p.x, 0.0);
        }
        self.began = simulation.time();
    }

    fn row(&mut self, simulation: &Simulation) {
        if self.rows.last().is_some_and(|row| row.time == simulation.time()) {
            return;
        }
        self.rows.push(Row {
            time: simulation.time(),
            balance: simulation.energy_balance(&simulation.stock(), self.datum),
            barrier: simulation.stock_of(|b| b == self.barrier),
            work: self.sums[0],
            deposit: self.deposit,
        });
    }
}
