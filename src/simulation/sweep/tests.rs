//! Every stage is done once, and in order.

use super::*;
use crate::body::Points;
use std::sync::Mutex;

const STAGES: &[(On, usize)] =
    &[(On::Points, 0), (On::Nodes, 1), (On::Points, 2), (On::Nodes, 3), (On::Points, 4), (On::Points, 5)];

/// Runs one sweep, or several with a part of the stages each, on fields of so many bands, in so many parts on so many threads, and
/// checks that every stage finds done what it needs. `load` gives the points of a band, of so many in all.
fn check(fields: &[usize], [threads, parts]: [usize; 2], sweeps: &[&[(On, usize)]], load: fn(usize, usize) -> usize) {
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
            let mut all_done = done.lock().expect("no panic before");
            let done_here = &mut all_done[field];
            let around =
                if STAGES[stage].0 == On::Nodes { k.saturating_sub(1)..k + 1 } else { k..(k + 2).min(done_here.len()) };
            for j in around {
                let earlier = if STAGES[stage].0 == On::Points && j > k {
                    // Of the next band, the node stages only.
                    (0..stage).filter(|&s| STAGES[s].0 == On::Nodes).all(|s| done_here[j][s])
                } else {
                    (0..stage).all(|s| done_here[j][s])
                };
                assert!(earlier, "stage {stage} on band {k} of field {field} comes before band {j} is ready");
            }
            assert!(!done_here[k][stage], "stage {stage} twice on band {k} of field {field}");
            // Other threads get on with theirs meanwhile, by now more and by now less.
            drop(all_done);
            let salt = (k * 7 + stage * 13 + field * 5 + parts) as u32;
            (0..salt.wrapping_mul(2_654_435_761) >> 22).for_each(|_| std::hint::spin_loop());
            done.lock().expect("no panic before")[field][k][stage] = true;
        };
        let mut pools = Vec::new();
        for stages in sweeps {
            let pools = (sweeps.len() == 1).then_some(&mut pools);
            Plan { stages, work: &work }.sweep(&mut all, pools, parts);
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
fn parts_have_four_bands_and_seams_five() {
    let of = |bands, threads| parts(STAGES, bands, threads);
    for (bands, most) in
        [(0, 1), (7, 1), (8, 2), (11, 2), (12, 3), (15, 3), (16, 4), (24, 5), (36, 8), (1000, MAX_PARTS)]
    {
        assert_eq!(of(bands, 100), most, "{bands} bands");
        assert_eq!([1, 2].map(|threads| of(bands, threads)), [1, most.min(2)]);
    }
    // A sweep up to the first stage on nodes has seams of three bands.
    assert_eq!(parts(&STAGES[..2], 24, 100), 6);
}

#[test]
fn every_stage_is_done_once_and_in_order() {
    let sweeps: Vec<_> = STAGES.split_inclusive(|(on, _)| *on == On::Nodes).collect();
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
        // More parts than threads: no thread may wait for a part that has yet to begin.
        for (threads, parts) in [(1, 1), (2, 2), (3, 3), (4, 4), (5, 5), (1, 2), (1, 5), (2, 5)] {
            // No points, as many in each band, all at one end.
            for load in [|_, _| 0, |_, _| 9, |k, _| if k == 0 { 99 } else { 0 }, |k, n| if k + 1 == n { 99 } else { 0 }]
            {
                check(fields, [threads, parts], &[STAGES], load);
                check(fields, [threads, parts], &sweeps, load);
            }
        }
    }
}
