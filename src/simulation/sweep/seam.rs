//! Bands around the seam between two parts of a sweep, which threads of both work on.
//!
//! A part sweeps those on its side as far as they do not depend on the other part. The thread that is done first takes what can
//! be done next, whosever it would have been, and so does the other. The order of the stages on a band, and what each needs, is kept;
//! nothing else matters to the numbers.
//!
//! Elsewhere: work sharing at the halo between two subdomains.

use super::stretch::Stretch;
use super::together::LOOKS;
use super::{Plan, Work};
use crate::band::Band;
use std::array::from_fn;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Most bands that belong to a seam.
const MAX_PLACES: usize = 2 * 2 + 1;

/// The bands around a seam.
pub(super) struct Seam<'f> {
    places: [Option<Place<'f>>; MAX_PLACES],
    /// Number of the first band.
    first: usize,
    /// Number of the first band behind the seam.
    seam: usize,
    /// Whether no band follows the last one.
    at_end: bool,
    /// Parts that have begun.
    begun: AtomicUsize,
}

/// A band that several threads work on, one at a time; a cache line, so that looking at one does not hold up work on another.
#[repr(align(64))]
pub(super) struct Place<'f> {
    field: usize,
    band: Mutex<&'f mut Band>,
    /// Stages done.
    done: AtomicUsize,
}

/// A band that only this thread works on for now.
pub(super) struct Held<'a, 'f> {
    field: usize,
    band: MutexGuard<'a, &'f mut Band>,
}

impl Held<'_, '_> {
    /// The number of its field, and the band.
    pub fn band(&mut self) -> (usize, &mut Band) {
        (self.field, &mut self.band)
    }
}

impl<'f> Place<'f> {
    /// Waits until no other thread works on it.
    pub fn lock(&self) -> Held<'_, 'f> {
        // A thread that panics ends the sweep all the same.
        Held { field: self.field, band: self.band.lock().unwrap_or_else(PoisonError::into_inner) }
    }

    fn try_lock(&self) -> Option<Held<'_, 'f>> {
        Some(Held { field: self.field, band: self.band.try_lock().ok()? })
    }

    fn done(&self) -> usize {
        self.done.load(Ordering::Acquire)
    }

    /// Does a stage on it, given the band before it, unless another thread has done so.
    pub fn run<S: Sync, W: Work<S>>(&self, plan: &Plan<S, W>, stage: usize, before: Option<(usize, &mut Band)>) {
        self.run_held(&mut self.lock(), plan, stage, before);
    }

    fn run_held<S: Sync, W: Work<S>>(
        &self,
        held: &mut Held,
        plan: &Plan<S, W>,
        stage: usize,
        before: Option<(usize, &mut Band)>,
    ) -> bool {
        let done = self.done();
        debug_assert!(done >= stage, "stage {stage} after {done} stages");
        let next = done == stage;
        if next {
            plan.run(stage, before, held.band());
            self.done.store(stage + 1, Ordering::Release);
        }
        next
    }
}

/// What a thread found to do.
enum Found {
    Work,
    /// Others have to go on first.
    Nothing,
    /// All is done.
    End,
}

impl<'f> Seam<'f> {
    /// Around the band `seam`, with the first of `bands` being that of number `first`.
    pub fn new(bands: Stretch<'f>, first: usize, seam: usize, at_end: bool) -> Self {
        assert!(bands.len() <= MAX_PLACES, "{} bands", bands.len());
        let mut bands = bands.into_bands();
        let place = |(field, band)| Place { field, band: Mutex::new(band), done: AtomicUsize::new(0) };
        Self { places: from_fn(|_| bands.next().map(place)), first, seam, at_end, begun: AtomicUsize::new(0) }
    }

    /// The place of a band, if it belongs here.
    pub fn place(&self, band: usize) -> Option<&Place<'f>> {
        self.places.get(band.checked_sub(self.first)?)?.as_ref()
    }

    /// A band that belongs here.
    pub fn band(&mut self, band: usize) -> &mut Band {
        let place = self.places[band - self.first]
            .as_mut()
            .expect("the sweep asks a seam only for the bands that it has put there");
        place.band.get_mut().unwrap_or_else(PoisonError::into_inner)
    }

    /// Number of the first band behind the seam.
    pub fn seam(&self) -> usize {
        self.seam
    }

    /// A part beside it has begun.
    pub fn arrive(&self) {
        self.begun.fetch_add(1, Ordering::Release);
    }

    /// Whether both parts have begun.
    fn both_begun(&self) -> bool {
        self.begun.load(Ordering::Acquire) == 2
    }

    /// Does one stage on one band, if there is one that can be done now: the earliest, and of several bands the one furthest into
    /// the part of this thread, which has it in cache; `before` says whether that is the part before the seam.
    fn step<S: Sync, W: Work<S>>(&self, plan: &Plan<S, W>, before: bool) -> Found {
        let places = || self.places.iter().flatten();
        let count = places().count();
        for stage in 0..plan.stages.len() {
            let band = |k| if before { k } else { count - 1 - k };
            if (0..count).any(|k| self.try_stage(band(k), stage, plan)) {
                return Found::Work;
            }
        }
        if places().all(|p| p.done() == plan.stages.len()) { Found::End } else { Found::Nothing }
    }

    /// Does a stage on a band if it is the next one there, all it needs is done, and no other thread is at it.
    fn try_stage<S: Sync, W: Work<S>>(&self, k: usize, stage: usize, plan: &Plan<S, W>) -> bool {
        let Some(here) = &self.places[k] else { return false };
        if here.done() != stage {
            return false;
        }
        let beside = |k: Option<usize>| self.places.get(k?)?.as_ref();
        if plan.looks_back(stage) == 0 {
            let nodes = (0..stage).rfind(|&s| plan.looks_back(s) == 1).map_or(0, |s| s + 1);
            let next = beside(Some(k + 1));
            let ready = next.map_or(self.at_end, |next| next.field != here.field || next.done() >= nodes);
            let held = if ready { here.try_lock() } else { None };
            return held.is_some_and(|mut held| here.run_held(&mut held, plan, stage, None));
        }
        let Some(before) = beside(k.checked_sub(1)) else { return false };
        if before.field == here.field && before.done() < stage {
            return false;
        }
        let (Some(mut before), Some(mut held)) = (before.try_lock(), here.try_lock()) else { return false };
        here.run_held(&mut held, plan, stage, Some(before.band()))
    }

    /// Does all that is left.
    pub fn finish<S: Sync, W: Work<S>>(&self, plan: &Plan<S, W>) {
        while let Found::Work = self.step(plan, true) {}
        assert!(matches!(self.step(plan, true), Found::End), "the parts beside a seam are done");
    }
}

/// Does what is left around the seams at the ends of a part, until all is done, a part beside them has yet to begin (it
/// may be waiting for this thread), or there has been nothing to do for too long.
pub(super) fn help<S: Sync, W: Work<S>>(ends: [Option<&Seam>; 2], plan: &Plan<S, W>) {
    let mut looks = 0;
    while looks < LOOKS {
        let (mut worked, mut wait) = (false, false);
        for (end, seam) in ends.into_iter().enumerate() {
            let Some(seam) = seam else { continue };
            match seam.step(plan, end == 1) {
                Found::Work => worked = true,
                Found::Nothing => wait |= seam.both_begun(),
                Found::End => {}
            }
        }
        match (worked, wait) {
            (true, _) => looks = 0,
            (false, true) => looks += 1,
            (false, false) => return,
        }
        std::hint::spin_loop();
    }
}
