//! Numbers that claims are judged by.

use super::releases::{Arrival, BARRIERS, RELEASES, Release, arrival, table};
use super::slip::shares::{Shares, shares};
use super::{tables, wave};
use crate::{Context, Failure};
use checkdam::output::Table;

/// What is read from the tables of the four barriers under one release.
pub struct Numbers {
    /// Barrier and celerity of the wave, m/s.
    celerities: Vec<(String, f64)>,
    /// Barrier, time (s), share dissipated, share held by the barrier, kinetic share.
    energy: Vec<(String, [f64; 4])>,
    /// Barrier and when the flow meets it.
    arrivals: Vec<(&'static str, Arrival)>,
    /// Barrier and where its dissipation is done.
    slip: Vec<(&'static str, Shares)>,
}

/// Reads them: literal, calibrated.
///
/// # Errors
/// The record is not as it should be, or the runs are stopped.
pub fn numbers(context: &mut Context) -> Result<Vec<Numbers>, Failure> {
    let tables = tables(context)?;
    RELEASES.iter().zip(&tables).map(|(release, tables)| Numbers::of(release, tables)).collect()
}

impl Numbers {
    fn of(release: &Release, tables: &[(String, String)]) -> Result<Self, Failure> {
        let text = wave::CELERITIES.to_string() + &wave::celerities(release.name, &table(tables, "wave.csv")?)?;
        let celerities = Table::parse(&text, "celerities.csv")?;
        let speeds = celerities.column("celerity_m_per_s")?;
        let celerities = celerities.cells("barrier")?.into_iter().zip(speeds.iter().copied()).collect();
        let energy = table(tables, "energy.csv")?;
        let columns = [
            energy.column("time_s")?,
            energy.column("dissipated_1")?,
            energy.column("barrier_1")?,
            energy.column("kinetic_1")?,
        ];
        let rows = energy.cells("barrier")?.into_iter().enumerate();
        let energy = rows.map(|(k, name)| (name, columns.map(|c| c[k]))).collect();
        let slip = table(tables, "slip.csv")?;
        let (mut arrivals, mut all) = (Vec::new(), Vec::new());
        for (barrier, _) in BARRIERS {
            let arrival = arrival(release, barrier)?;
            arrivals.push((barrier, arrival));
            all.push((barrier, shares(&slip, barrier, arrival.time)?));
        }
        Ok(Self { celerities, energy, arrivals, slip: all })
    }

    /// Celerity of the wave at a barrier, m/s.
    pub fn celerity(&self, barrier: &str) -> f64 {
        self.celerities.iter().find(|c| c.0 == barrier).map_or(f64::NAN, |c| c.1)
    }

    /// Largest share of the energy at release that the barrier ever holds.
    pub fn held_by_barrier(&self, barrier: &str) -> f64 {
        self.energy.iter().filter(|e| e.0 == barrier).map(|e| e.1[2]).fold(0.0, f64::max)
    }

    /// When the kinetic energy is largest, s.
    pub fn fastest(&self, barrier: &str) -> f64 {
        let own = self.energy.iter().filter(|e| e.0 == barrier);
        own.fold((f64::NAN, 0.0), |a, e| if e.1[3] > a.1 { (e.1[0], e.1[3]) } else { a }).0
    }

    /// When it last exceeds a hundredth of the energy at release, s.
    pub fn at_rest(&self, barrier: &str) -> f64 {
        self.energy.iter().rfind(|e| e.0 == barrier && e.1[3] > 0.01).map_or(f64::NAN, |e| e.1[0])
    }

    /// Share of what is dissipated that is dissipated after the arrival.
    pub fn pile_up(&self, barrier: &str) -> f64 {
        let (own, [before, end], _) = self.dissipated(barrier);
        if own.is_empty() { f64::NAN } else { 1.0 - before / end }
    }

    /// Time from the arrival until nine tenths of what is dissipated after it are, s.
    pub fn levelling(&self, barrier: &str) -> f64 {
        let (own, [before, end], arrival) = self.dissipated(barrier);
        let level = before + 0.9 * (end - before);
        own.iter().find(|e| e[1] >= level).map_or(f64::NAN, |e| e[0] - arrival)
    }

    /// Where the dissipation is done.
    pub fn slip(&self, barrier: &str) -> Option<&Shares> {
        self.slip.iter().find(|s| s.0 == barrier).map(|s| &s.1)
    }

    /// Rows of a barrier, what is dissipated up to the arrival and to the end, and the time of the arrival.
    fn dissipated(&self, barrier: &str) -> (Vec<&[f64; 4]>, [f64; 2], f64) {
        let own: Vec<&[f64; 4]> = self.energy.iter().filter(|e| e.0 == barrier).map(|e| &e.1).collect();
        let arrival = self.arrivals.iter().find(|a| a.0 == barrier).map_or(f64::NAN, |a| a.1.time);
        // One of the rows is that of the first step at or after the arrival.
        let before = own.iter().find(|e| e[0] >= arrival - 1e-4).map_or(f64::NAN, |e| e[1]);
        let end = own.last().map_or(f64::NAN, |e| e[1]);
        (own, [before, end], arrival)
    }
}
