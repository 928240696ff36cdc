//! The part of a sweep that one thread takes.

use super::seam::{self, Held, Place, Seam};
use super::stretch::Stretch;
use super::{Plan, Pool, Work};
use std::mem::take;

/// Bands that one thread sweeps.
pub(super) struct Part<'a, 'f, S, W> {
    pub plan: &'a Plan<'a, S, W>,
    /// Its bands but for those that belong to the seams at its ends.
    pub bands: Stretch<'f>,
    /// Number of the first of them.
    pub first: usize,
    /// Seams to the parts before and after it.
    pub ends: [Option<&'a Seam<'f>>; 2],
}

impl<'a, 'f, S: Sync, W: Work<S>> Part<'a, 'f, S, W> {
    /// Sweeps it as far as it does not depend on other parts, then does what else can be done at its ends. Its bands are lent
    /// workspaces from the pool.
    pub fn sweep(mut self, mut pool: Option<&mut Pool>) {
        self.ends.iter().flatten().for_each(|seam| seam.arrive());
        let own = self.first..self.first + self.bands.len();
        let begin = self.ends[0].map_or(own.start, |seam| seam.seam());
        let end = self.ends[1].map_or(own.end, |seam| seam.seam());
        let (plan, margin) = (self.plan, self.plan.margin());
        for front in begin..end + margin {
            if let Some(pool) = pool.as_mut().filter(|_| own.contains(&front)) {
                self.bands.at(front - self.first).2.work = pool.pop().unwrap_or_default();
            }
            for stage in 0..plan.stages.len() {
                let lag = plan.lag(stage);
                let low = if self.ends[0].is_some() { begin + lag + plan.looks_back(stage) } else { begin };
                let high = if self.ends[1].is_some() { end - lag } else { end };
                if let Some(band) = front.checked_sub(lag).filter(|k| (low..high).contains(k)) {
                    self.work(band, stage);
                }
            }
            // Nothing looks back at this one any more.
            let done = front.checked_sub(margin).filter(|k| own.contains(k));
            if let (Some(pool), Some(done)) = (pool.as_mut(), done) {
                pool.push(take(&mut self.bands.at(done - self.first).2.work));
            }
        }
        seam::help(self.ends, plan);
    }

    /// The place of a band in a seam, if it has one.
    fn place(&self, band: usize) -> Option<&'a Place<'f>> {
        self.ends.into_iter().flatten().find_map(|seam| seam.place(band))
    }

    /// Does a stage on a band, its own or one of a seam.
    fn work(&mut self, band: usize, stage: usize) {
        let (plan, here, looks_back) = (self.plan, self.place(band), self.plan.looks_back(stage) == 1);
        let before = band.checked_sub(1).filter(|_| looks_back).and_then(|k| self.place(k));
        let mut before = before.map(Place::lock);
        let before = before.as_mut().map(Held::band);
        if let Some(here) = here {
            let last = self.bands.len().checked_sub(1).filter(|_| looks_back).map(|k| self.bands.at(k));
            let own = last.map(|(field, _, band)| (field, band));
            here.run(plan, stage, before.or(own));
        } else {
            let (field, own, band) = self.bands.at(band - self.first);
            plan.run(stage, before.or_else(|| own.map(|b| (field, b))), (field, band));
        }
    }
}
