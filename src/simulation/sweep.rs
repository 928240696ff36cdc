//! Runs the stages of a step over the bands in one sweep, so that a band's points stay in cache from stage to stage.
//!
//! A point stage needs the nodes that a band reaches, so the node stage before it must be done here and in the next band; a node
//! stage needs the sums of this band and the one before. A stage therefore follows the first at a lag of as many bands as there
//! are node-to-point turns before it, and one sweep from left to right does the whole step.
//!
//! Several threads take a part each, and sweep it as far as it does not depend on a neighbouring part; what is left around the
//! seams follows. Which band is worked on when makes no difference to the numbers, so neither does the number of parts.
//!
//! The bands of several fields are swept as one list, so that the fields do not wait for each other. Bands that meet in the list
//! and belong to different fields do not depend on each other; that a seam there waits all the same does no harm.
//!
//! Where one sweep does all of a step, each part has a pool of workspaces, which a band takes from as the sweep reaches it and
//! gives back to when its last stage is done. A few serve all bands and stay in cache; the one given back last is taken first.

use super::stretch::Stretch;
use crate::band::{Band, Workspace};
use std::mem::take;
use std::sync::atomic::{AtomicBool, Ordering};

/// Looks at a flag before a thread that waits for another may fall asleep: a tenth of a millisecond.
const LOOKS: u32 = 10_000;
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

/// Bands by which a stage follows the first.
fn lag<S>(stages: &[(On, S)], stage: usize) -> usize {
    stages[..=stage].windows(2).filter(|w| w[0].0 == On::Nodes && w[1].0 == On::Points).count()
}

/// Bands before a seam that what is left around it needs: those by which stages lag, and for a node stage the band before.
fn left_of_seam<S>(stages: &[(On, S)]) -> usize {
    (0..stages.len()).map(|k| lag(stages, k) + usize::from(stages[k].0 == On::Nodes)).max().unwrap_or(0)
}

/// Does all stages on all bands of all fields; `work` does one of them on one band, and is told the number of the field. Node
/// stages are given the band before it as well. Bands are lent workspaces from `pools`, if there are any, or have their own.
pub fn sweep<S: Sync>(
    stages: &[(On, S)],
    fields: &mut [Vec<Band>],
    mut pools: Option<&mut Vec<Pool>>,
    work: &(impl Fn(&S, usize, Option<&mut Band>, &mut Band) + Sync),
) {
    let threads = rayon::current_num_threads();
    let longest = left_of_seam(stages);
    let bands: usize = fields.iter().map(Vec::len).sum();
    let parts = threads.min(bands / PART_BANDS.max(2 * longest)).min(MAX_PARTS);
    if let Some(pools) = &mut pools
        && pools.len() < parts.max(1)
    {
        pools.resize_with(parts.max(1), Pool::new);
    }
    let pools = pools.map_or(&mut [][..], |pools| &mut pools[..]);
    if parts < 2 {
        return part(stages, &mut Stretch::new(fields), pools.first_mut(), [false; 2], work);
    }
    // Parts of about as many points each.
    let loads = || fields.iter().flatten().map(Band::len);
    let (points, mut loads) = (loads().sum::<usize>(), loads());
    let mut seams = [0; MAX_PARTS];
    let (mut seen, mut band) = (0, 0);
    for (k, seam) in seams[..parts - 1].iter_mut().enumerate() {
        let least = band + 2 * longest;
        let most = bands - (parts - 1 - k) * 2 * longest;
        while band < most && (band < least || seen * parts < points * (k + 1)) {
            seen += loads.next().unwrap_or(0);
            band += 1;
        }
        *seam = band;
    }
    let (seams, mut all) = (&seams[..parts - 1], Stretch::new(fields));
    parts_between(stages, &mut all, pools, seams, 0, [false; 2], work);
    around_seams(stages, &mut all, seams, 0, longest, work);
    for (k, &seam) in seams.iter().enumerate() {
        for (pool, bands) in pools.iter_mut().skip(k).zip([seam - longest..seam, seam..seam + longest]) {
            bands.for_each(|band| pool.push(take(&mut all.at(band).2.work)));
        }
    }
}

/// Sweeps the parts between seams side by side. `first` is the number of the first of `bands`; `open` says whether other parts
/// lie before and after them.
fn parts_between<S: Sync>(
    stages: &[(On, S)],
    bands: &mut Stretch,
    pools: &mut [Pool],
    seams: &[usize],
    first: usize,
    open: [bool; 2],
    work: &(impl Fn(&S, usize, Option<&mut Band>, &mut Band) + Sync),
) {
    let Some(&seam) = seams.get(seams.len() / 2) else {
        return part(stages, bands, pools.first_mut(), open, work);
    };
    let (mut before, mut after) = bands.split_at(seam - first);
    let (pools_before, pools_after) = pools.split_at_mut(pools.len().min(seams.len() / 2 + 1));
    let (seams_before, seams_after) = (&seams[..seams.len() / 2], &seams[seams.len() / 2 + 1..]);
    together(
        || parts_between(stages, &mut before, pools_before, seams_before, first, [open[0], true], work),
        || parts_between(stages, &mut after, pools_after, seams_after, seam, [true, open[1]], work),
    );
}

/// Does both, side by side if a thread is free. The one that is done first waits for the other with open eyes for a while: a thread
/// that falls asleep takes as long to wake up as a small sweep takes.
pub fn together(a: impl FnOnce() + Send, b: impl FnOnce() + Send) {
    let [a_done, b_begun, b_done] = [const { AtomicBool::new(false) }; 3];
    rayon::join(
        || {
            a();
            a_done.store(true, Ordering::Release);
            // What no other thread has taken up yet is done by this one, after this.
            wait(|| is(&b_begun) && !is(&b_done));
        },
        || {
            b_begun.store(true, Ordering::Release);
            b();
            b_done.store(true, Ordering::Release);
            wait(|| !is(&a_done));
        },
    );
}

/// Does what only one thread can, while another stays awake.
pub fn alone(work: impl FnOnce() + Send) {
    together(work, || {});
}

/// Does a sweep and something else at its side. Either may use several threads: the one that is done first helps the other.
pub fn beside(sweep: impl FnOnce() + Send, work: impl FnOnce() + Send) {
    let [begun, done] = [const { AtomicBool::new(false) }; 2];
    rayon::join(
        || {
            sweep();
            wait(|| {
                rayon::yield_now();
                is(&begun) && !is(&done)
            });
        },
        || {
            begun.store(true, Ordering::Release);
            work();
            done.store(true, Ordering::Release);
        },
    );
}

fn is(flag: &AtomicBool) -> bool {
    flag.load(Ordering::Acquire)
}

fn wait(go_on: impl Fn() -> bool) {
    (0..LOOKS).take_while(|_| go_on()).for_each(|_| std::hint::spin_loop());
}

/// Sweeps one part as far as it does not depend on what lies beyond its open ends. Bands beside those keep the workspace that they
/// are lent.
fn part<S>(
    stages: &[(On, S)],
    bands: &mut Stretch,
    mut pool: Option<&mut Pool>,
    open: [bool; 2],
    work: &impl Fn(&S, usize, Option<&mut Band>, &mut Band),
) {
    let count = bands.len();
    let longest = left_of_seam(stages);
    let [keep_first, keep_last] = open.map(|open| if open { longest } else { 0 });
    for front in 0..count + longest {
        if let Some(pool) = pool.as_mut().filter(|_| front < count) {
            bands.at(front).2.work = pool.pop().unwrap_or_default();
        }
        for (number, (on, stage)) in stages.iter().enumerate() {
            let lag = lag(stages, number);
            let low = match (open[0], on) {
                (false, _) => 0,
                (true, On::Points) => lag,
                (true, On::Nodes) => lag + 1,
            };
            let high = if open[1] { count - lag } else { count };
            if let Some(k) = front.checked_sub(lag).filter(|k| (low..high).contains(k)) {
                at(bands, k, stage, work);
            }
        }
        // Nothing looks back at this one any more.
        let done = front.checked_sub(longest).filter(|k| (keep_first..count - keep_last).contains(k));
        if let (Some(pool), Some(done)) = (pool.as_mut(), done) {
            pool.push(take(&mut bands.at(done).2.work));
        }
    }
}

/// Does what the parts have left on either side of each seam.
fn around_seams<S: Sync>(
    stages: &[(On, S)],
    bands: &mut Stretch,
    seams: &[usize],
    first: usize,
    longest: usize,
    work: &(impl Fn(&S, usize, Option<&mut Band>, &mut Band) + Sync),
) {
    let middle = seams.len() / 2;
    let Some(&seam) = seams.get(middle) else { return };
    if seams.len() > 1 {
        let start = seam - longest;
        let (mut before, mut after) = bands.split_at(start - first);
        together(
            || around_seams(stages, &mut before, &seams[..middle], first, longest, work),
            || around_seams(stages, &mut after, &seams[middle..], start, longest, work),
        );
        return;
    }
    let seam = seam - first;
    for (number, (on, stage)) in stages.iter().enumerate() {
        let lag = lag(stages, number);
        match on {
            On::Nodes => (seam - lag..=seam + lag).for_each(|k| at(bands, k, stage, work)),
            On::Points if lag > 0 => {
                let (mut before, mut after) = bands.split_at(seam);
                // In two halves although it is little, so that no thread falls asleep in between.
                together(
                    || (seam - lag..seam).for_each(|k| at(&mut before, k, stage, work)),
                    || (0..lag).for_each(|k| at(&mut after, k, stage, work)),
                );
            }
            On::Points => {}
        }
    }
}

fn at<S>(bands: &mut Stretch, k: usize, stage: &S, work: &impl Fn(&S, usize, Option<&mut Band>, &mut Band)) {
    let (field, before, band) = bands.at(k);
    work(stage, field, before, band);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Points;
    use std::sync::Mutex;

    const STAGES: &[(On, usize)] =
        &[(On::Points, 0), (On::Nodes, 1), (On::Points, 2), (On::Nodes, 3), (On::Points, 4), (On::Points, 5)];

    /// Runs one sweep, or several with a part of the stages each, on fields of so many bands with `threads` threads and checks
    /// that every stage finds done what it needs. `load` gives the points of a band, of so many in all.
    fn check(fields: &[usize], threads: usize, sweeps: &[&[(On, usize)]], load: fn(usize, usize) -> usize) {
        let (mut number, count) = (0, fields.iter().sum());
        let mut band = |k: usize| {
            let mut points = Points::default();
            points.resize(load(number, count));
            number += 1;
            Band { first_node: k, points: vec![points], ..Band::default() }
        };
        let mut all: Vec<Vec<Band>> = fields.iter().map(|&bands| (0..bands).map(&mut band).collect()).collect();
        let done = Mutex::new(fields.iter().map(|&bands| vec![[false; 6]; bands]).collect::<Vec<_>>());
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let work = |&stage: &usize, field: usize, before: Option<&mut Band>, band: &mut Band| {
                let k = band.first_node;
                // Each has its workspace to itself, from its first stage to the last that looks at it.
                if stage == 0 {
                    band.work.mass = vec![k as f64];
                }
                assert_eq!(band.work.mass, [k as f64]);
                if STAGES[stage].0 == On::Nodes {
                    assert_eq!(before.as_ref().map(|b| b.first_node), k.checked_sub(1), "the band before {k}");
                    assert!(before.is_none_or(|b| b.work.mass == [k as f64 - 1.0]), "the workspace before {k}");
                }
                let done = &mut done.lock().expect("no panic before")[field];
                let around =
                    if STAGES[stage].0 == On::Nodes { k.saturating_sub(1)..k + 1 } else { k..(k + 2).min(done.len()) };
                for j in around {
                    let earlier = if STAGES[stage].0 == On::Points && j > k {
                        // Of the next band, the node stages only.
                        (0..stage).filter(|&s| STAGES[s].0 == On::Nodes).all(|s| done[j][s])
                    } else {
                        (0..stage).all(|s| done[j][s])
                    };
                    assert!(earlier, "stage {stage} on band {k} of field {field} comes before band {j} is ready");
                }
                assert!(!done[k][stage], "stage {stage} twice on band {k} of field {field}");
                done[k][stage] = true;
            };
            let mut pools = Vec::new();
            for stages in sweeps {
                sweep(stages, &mut all, (sweeps.len() == 1).then_some(&mut pools), &work);
            }
            if sweeps.len() == 1 {
                assert!(all.iter().flatten().all(|band| band.work.mass.is_empty()), "workspaces are given back");
                let lent = pools.iter().map(Vec::len).max().unwrap_or(0);
                assert!(lent <= 10, "{lent} workspaces");
            }
        });
        let done = done.into_inner().expect("no panic");
        assert!(done.iter().flatten().flatten().all(|&d| d), "{fields:?} bands, {threads} threads");
    }

    #[test]
    fn every_stage_is_done_once_and_in_order() {
        let parts: Vec<_> = STAGES.split_inclusive(|(on, _)| *on == On::Nodes).collect();
        let single = [0, 1, 2, 3, 5, 11, 12, 13, 30, 47].map(|bands| vec![bands]);
        let several: [&[usize]; 10] = [
            &[0, 0],
            &[1, 1],
            &[20, 11],
            &[0, 30, 0],
            &[1, 40, 1],
            &[24, 0, 24],
            &[9, 1, 0, 1, 9],
            &[1; 24],
            &[7, 5, 13, 2, 30],
            &[],
        ];
        for fields in single.iter().map(Vec::as_slice).chain(several) {
            for threads in 1..=5 {
                // No points, as many in each band, all at one end.
                for load in
                    [|_, _| 0, |_, _| 9, |k, _| if k == 0 { 99 } else { 0 }, |k, n| if k + 1 == n { 99 } else { 0 }]
                {
                    check(fields, threads, &[STAGES], load);
                    check(fields, threads, &parts, load);
                }
            }
        }
    }
}
