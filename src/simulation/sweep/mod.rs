//! Runs the stages of a step over the bands in one sweep, so that a band's points stay in cache from stage to stage.
//!
//! A point stage needs the nodes that a band reaches, so the node stage before it must be done here and in the next band; a node
//! stage needs the sums of this band and the one before. A stage therefore follows the first at a lag of as many bands as there
//! are node-to-point turns before it, and one sweep from left to right does the whole step.
//!
//! Several threads take a [`Part`] each, and sweep it as far as it does not depend on a neighbouring part. What is left around
//! the [`Seam`] between two parts is done by whichever of their threads is free. Which band is worked on when makes no difference to
//! the numbers, so neither does the number of parts.
//!
//! The bands of several fields are swept as one list, so that the fields do not wait for each other. Bands that meet in the list
//! and belong to different fields do not depend on each other.
//!
//! Where one sweep does all of a step, each part has a pool of workspaces, which a band takes from as the sweep reaches it and
//! gives back to when its last stage is done. A few serve all bands and stay in cache; the one given back last is taken first.
//!
//! Elsewhere: loop fusion with cache blocking, a wavefront or pipelined (skewed) schedule.

mod part;
mod seam;
mod stretch;
#[cfg(test)]
mod tests;
mod together;

use crate::band::{Band, Workspace};
use part::Part;
use seam::Seam;
use std::mem::take;
use stretch::Stretch;

pub use together::{alone, beside, together};

/// Most parts a sweep is divided into.
const MAX_PARTS: usize = 64;
/// Bands that make a part worth a thread.
const PART_BANDS: usize = 4;

/// Workspaces that serve the bands of a part.
pub type Pool = Vec<Workspace>;

/// What a stage works on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum On {
    /// The points of a band: needs the nodal fields within its reach.
    Points,
    /// The nodes that a band owns: needs what this band and the one before it have added up.
    Nodes,
}

/// Does a stage on a band: is told the number of its field and, for a stage on nodes, given the band before it in that field.
trait Work<S>: Fn(&S, usize, Option<&mut Band>, &mut Band) + Sync {}
impl<S, W: Fn(&S, usize, Option<&mut Band>, &mut Band) + Sync> Work<S> for W {}

/// What a sweep does.
struct Plan<'a, S, W> {
    /// Stages: each needs those before it.
    stages: &'a [(On, S)],
    work: &'a W,
}

/// Does all stages on all bands of all fields; `work` does one of them on one band, is told the number of the field, and for a stage
/// on nodes given the band before it as well. Bands are lent workspaces from `pools`, if there are any, or have their own.
pub fn sweep<S: Sync>(
    stages: &[(On, S)],
    fields: &mut [Vec<Band>],
    pools: Option<&mut Vec<Pool>>,
    work: &(impl Fn(&S, usize, Option<&mut Band>, &mut Band) + Sync),
) {
    Plan { stages, work }.sweep(fields, pools, rayon::current_num_threads());
}

/// Parts into which so many threads divide a sweep of these stages over so many bands.
pub fn parts<S>(stages: &[(On, S)], bands: usize, threads: usize) -> usize {
    Plan { stages, work: &() }.parts(bands, threads)
}

impl<S, W> Plan<'_, S, W> {
    /// Bands by which a stage follows the first.
    fn lag(&self, stage: usize) -> usize {
        self.stages[..=stage].windows(2).filter(|w| w[0].0 == On::Nodes && w[1].0 == On::Points).count()
    }

    /// 1 for a stage on nodes, which looks at the band before, or 0.
    fn looks_back(&self, stage: usize) -> usize {
        usize::from(self.stages[stage].0 == On::Nodes)
    }

    /// Most bands beside a seam that a stage has to leave. So many on either side, and the next one behind, belong to the seam.
    fn margin(&self) -> usize {
        (0..self.stages.len()).map(|k| self.lag(k) + self.looks_back(k)).max().unwrap_or(0)
    }

    /// Bands that belong to a seam, at most.
    fn around(&self) -> usize {
        2 * self.margin() + 1
    }

    /// So many parts, if there are enough bands.
    fn parts(&self, bands: usize, wanted: usize) -> usize {
        wanted.min(bands / PART_BANDS).min(bands / self.around() + 1).clamp(1, MAX_PARTS)
    }
}

impl<S: Sync, W: Work<S>> Plan<'_, S, W> {
    /// Does a stage on a band, given the field of either and the band before it, which may be of another field.
    fn run(&self, stage: usize, before: Option<(usize, &mut Band)>, (field, band): (usize, &mut Band)) {
        let before = before.filter(|(other, _)| *other == field).map(|(_, before)| before);
        (self.work)(&self.stages[stage].1, field, before, band);
    }

    /// Sweeps in so many parts, if there are enough bands.
    fn sweep(&self, fields: &mut [Vec<Band>], mut pools: Option<&mut Vec<Pool>>, parts: usize) {
        let bands: usize = fields.iter().map(Vec::len).sum();
        let (margin, around, parts) = (self.margin(), self.around(), self.parts(bands, parts));
        if let Some(pools) = &mut pools
            && pools.len() < parts
        {
            pools.resize_with(parts, Pool::new);
        }
        // Parts of about as many points each.
        let loads = || fields.iter().flatten().map(Band::len);
        let (points, mut loads) = (loads().sum::<usize>(), loads());
        let mut seams = [0; MAX_PARTS];
        let (mut seen, mut band) = (0, 0);
        for (k, seam) in seams[..parts - 1].iter_mut().enumerate() {
            let least = if k == 0 { margin } else { band + around };
            let most = bands - margin - (parts - 2 - k) * around;
            while band < most && (band < least || seen * parts < points * (k + 1)) {
                seen += loads.next().unwrap_or(0);
                band += 1;
            }
            *seam = band;
        }
        let pools = pools.map_or(&mut [][..], |pools| &mut pools[..]);
        self.divide(Stretch::new(fields), pools, &seams[..parts - 1], 0, [None; 2]);
    }

    /// Sweeps the parts between seams side by side. `first` is the number of the first of `bands`; `ends` are the seams to other
    /// parts before and after them.
    fn divide<'f>(
        &self,
        bands: Stretch<'f>,
        pools: &mut [Pool],
        seams: &[usize],
        first: usize,
        ends: [Option<&Seam<'f>>; 2],
    ) {
        let middle = seams.len() / 2;
        let Some(&seam) = seams.get(middle) else {
            return Part { plan: self, bands, first, ends }.sweep(pools.first_mut());
        };
        let start = seam - self.margin();
        let (before, rest) = bands.split_at(start - first);
        let places = self.around().min(rest.len());
        let (around, after) = rest.split_at(places);
        let end = start + around.len();
        let (pools_before, pools_after) = pools.split_at_mut(pools.len().min(middle + 1));
        let at_end = after.len() == 0 && ends[1].is_none();
        let mut around = Seam::new(around, start, seam, at_end);
        for band in start..end {
            let pool = if band < seam { pools_before.last_mut() } else { pools_after.first_mut() };
            pool.into_iter().for_each(|pool| around.band(band).work = pool.pop().unwrap_or_default());
        }
        together(
            || self.divide(before, pools_before, &seams[..middle], first, [ends[0], Some(&around)]),
            || self.divide(after, pools_after, &seams[middle + 1..], end, [Some(&around), ends[1]]),
        );
        around.finish(self);
        // Backwards, so that each gets its own back in the next step.
        for band in (start..end).rev() {
            let pool = if band < seam { pools_before.last_mut() } else { pools_after.first_mut() };
            pool.into_iter().for_each(|pool| pool.push(take(&mut around.band(band).work)));
        }
    }
}
