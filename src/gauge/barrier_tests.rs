use super::*;
use crate::boundary::{Boundary, Friction};
use crate::constitutive::{AnyLaw, LinearElastic};
use crate::scaffold::{Brick, THICKNESS, scene};
use nalgebra::Vector2;

const H: f64 = 0.01;
const DENSITY: f64 = 1000.0;
const HEIGHT: f64 = 0.06;

/// A rotation that turns a step's answer into that of the same block before a wall turned by a multiple of 90 degrees or
/// mirrored, and so a test of every sign.
#[derive(Debug, Clone, Copy)]
struct View {
    quarter_turns: usize,
    mirrored: bool,
}

impl View {
    const ALL: [View; 8] = {
        let mut all = [View { quarter_turns: 0, mirrored: false }; 8];
        let mut k = 0;
        while k < 8 {
            all[k] = View { quarter_turns: k % 4, mirrored: k >= 4 };
            k += 1;
        }
        all
    };

    fn of(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let x = if self.mirrored { -x } else { x };
        match self.quarter_turns {
            0 => [x, y],
            1 => [-y, x],
            2 => [-x, -y],
            _ => [y, -x],
        }
    }
}

/// A block of 3 by 4 cells, one cell above the foot of a wall on its right and `gap` (m) away, that moves with `v` against it.
fn impact(view: View, gap: f64, v: [f64; 2], friction: Friction) -> Simulation {
    let brick = Brick::new([-3.0 * H - gap, H], [3, 4], H);
    let law = AnyLaw::LinearElastic(LinearElastic::new(1e5, 0.2));
    let mut points = brick.points();
    for p in &mut points {
        p.x = view.of(p.x);
        p.v = view.of(v);
    }
    let tangent = Vector2::from(view.of([0.0, 1.0]));
    let wall = Boundary::wall("wall", Vector2::zeros(), tangent, HEIGHT, 2.0 * H, friction);
    let wall = if view.mirrored { wall.facing_right() } else { wall };
    Simulation::new(scene(&brick, law, DENSITY, points, vec![wall]))
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * b.abs().max(1e-6)
}

#[test]
fn impulse_is_the_momentum_that_the_wall_stops() {
    for view in View::ALL {
        let mut sim = impact(view, 0.0, [2.0, -0.5], Friction::Coulomb(0.1));
        let mut gauge = BarrierGauge::new(&sim, 0);
        assert_eq!(gauge.boundary(), Some(0));
        let before = sim.stock().momentum;
        for step in 0..5 {
            sim.step().unwrap();
            gauge.after_step(&sim);
            if step == 0 {
                // It slides down and drags the wall down, with friction at its limit.
                let found = gauge.total_impulse();
                assert!(found[0] > 0.0 && close(found[1], -0.1 * found[0]), "{view:?}: {found:?}");
            }
        }
        let after = sim.stock().momentum;
        let lost = [before[0] - after[0], before[1] - after[1]];
        // In the frame of the wall: against its face, and along it towards its crest.
        let (normal, up) = (view.of([1.0, 0.0]), view.of([0.0, 1.0]));
        let expected = [lost[0] * normal[0] + lost[1] * normal[1], lost[0] * up[0] + lost[1] * up[1]];
        let found = gauge.total_impulse();
        assert!(close(found[0], expected[0]) && close(found[1], expected[1]), "{view:?}: {found:?} {expected:?}");
    }
}

#[test]
fn samples_are_means_and_largest_values_of_their_interval() {
    for view in View::ALL {
        let mut sim = impact(view, 0.7 * H, [2.0, -0.5], Friction::Coulomb(0.1));
        let (mut fine, mut coarse) = (BarrierGauge::new(&sim, 0), BarrierGauge::new(&sim, 0));
        assert_eq!(fine.sample(), ForceSample::default());
        let mut sums = [0.0; 4];
        let mut peaks = [Peak::default(); 2];
        let mut forces = Vec::new();
        for _ in 0..40 {
            sim.step().unwrap();
            fine.after_step(&sim);
            coarse.after_step(&sim);
            let s = fine.sample();
            let tally = &sim.step_tallies()[0];
            let up = view.of([0.0, 1.0]);
            assert!(close(s.tangential * s.duration, -(tally.impulse[0] * up[0] + tally.impulse[1] * up[1])));
            assert!(close(s.moment.abs() * s.duration, tally.moment.abs()));
            assert_eq!(s.duration, sim.time_step().dt);
            assert!(close(s.normal_max, s.normal.max(0.0)));
            let values = [s.normal, s.tangential, s.moment, 1.0];
            sums.iter_mut().zip(values).for_each(|(sum, x)| *sum += x * s.duration);
            for (peak, value) in peaks.iter_mut().zip([s.normal, s.moment]) {
                if value > peak.value {
                    *peak = Peak { value, time: sim.time() };
                }
            }
            forces.push(s.normal);
        }
        let all = coarse.sample();
        let found = [all.normal, all.tangential, all.moment, 1.0];
        for (found, sum) in found.into_iter().zip(sums) {
            assert!(close(found * all.duration, sum), "{view:?}: {found} {sum}");
        }
        assert!(close(all.duration, sim.time()));
        let (rise, fall) = (peaks[0].value > forces[0], peaks[0].value > *forces.last().unwrap());
        assert!(rise && fall, "the peak lies between: {forces:?}");
        assert!(close(all.normal_max, peaks[0].value));
        for (found, peak) in [(coarse.peak_force(), peaks[0]), (coarse.peak_moment(), peaks[1])] {
            assert!(close(found.value, peak.value) && found.time == peak.time, "{found:?} {peak:?}");
        }
        assert_eq!(coarse.sample(), ForceSample::default());
    }
}

#[test]
fn a_wall_that_is_not_reached_feels_nothing() {
    let mut sim = impact(View::ALL[0], 3.0 * H, [0.0, 0.0], Friction::Rough);
    let mut gauge = BarrierGauge::new(&sim, 0);
    sim.step().unwrap();
    gauge.after_step(&sim);
    assert_eq!((gauge.peak_force(), gauge.peak_moment()), (Peak::default(), Peak::default()));
    assert_eq!(gauge.sample(), ForceSample { duration: sim.time(), ..ForceSample::default() });
}

#[test]
fn moment_turns_the_wall_over_by_the_lever_arm_of_the_block() {
    for view in View::ALL {
        let mut sim = impact(view, 0.0, [2.0, 0.0], Friction::Smooth);
        let mut gauge = BarrierGauge::new(&sim, 0);
        sim.step().unwrap();
        gauge.after_step(&sim);
        let sample = gauge.sample();
        // In the first step the block is free of stress and uniform: it pushes with its middle, 3 cells above the foot.
        assert!(close(sample.moment, 3.0 * H * sample.normal), "{view:?}: {sample:?}");
        assert!(sample.tangential.abs() <= 1e-9 * sample.normal);
    }
}

#[test]
fn pressure_integrates_to_force_and_moment() {
    for view in View::ALL {
        let mut sim = impact(view, 0.0, [2.0, 0.3], Friction::Smooth);
        let mut gauge = BarrierGauge::new(&sim, 0);
        assert!(gauge.profile(THICKNESS).iter().all(|row| row.1 == 0.0));
        for _ in 0..3 {
            sim.step().unwrap();
            gauge.after_step(&sim);
        }
        let sample = gauge.sample();
        let rows = gauge.profile(THICKNESS);
        assert_eq!(rows.len(), 7);
        let width = |k: usize| if k == 0 || k == 6 { 0.5 * H } else { H };
        let force: f64 = rows.iter().enumerate().map(|(k, row)| row.1 * width(k) * THICKNESS).sum();
        let moment: f64 = rows.iter().enumerate().map(|(k, row)| row.1 * width(k) * THICKNESS * row.0).sum();
        assert!(close(force, sample.normal), "{view:?}: {force} {sample:?}");
        assert!(close(moment, sample.moment), "{view:?}: {moment} {sample:?}");
        for (k, row) in rows.iter().enumerate() {
            assert!(close(row.0, k as f64 * H));
            // Points reach 5/4 of a cell: the block from 1 to 5 cells above the foot touches the nodes at 0 and 6 lightly.
            assert!(row.1 >= 0.0 && ((1..=5).contains(&k) || row.1 < 0.1 * rows[3].1), "{view:?}: {rows:?}");
        }
        assert!(rows[3].1 > 0.0);
        assert!(gauge.profile(THICKNESS).iter().all(|row| row.1 == 0.0), "the profile starts anew");
    }
}

#[test]
fn planes_have_no_profile_and_each_boundary_its_own_gauge() {
    let brick = Brick::new([0.0, 0.0], [4, 4], H);
    let law = AnyLaw::LinearElastic(LinearElastic::new(1e5, 0.2));
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v = [-1.0, -2.0]);
    let base = Boundary::plane("base", Vector2::zeros(), Vector2::new(0.0, 1.0), Friction::Smooth);
    let wall = Boundary::wall("wall", Vector2::zeros(), Vector2::new(0.0, 1.0), 4.0 * H, H, Friction::Smooth);
    let mut sim = Simulation::new(scene(&brick, law, DENSITY, points, vec![base, wall.facing_right()]));
    let mut gauges = [BarrierGauge::new(&sim, 0), BarrierGauge::new(&sim, 1)];
    let before = sim.stock().momentum;
    sim.step().unwrap();
    gauges.iter_mut().for_each(|g| g.after_step(&sim));
    let after = sim.stock().momentum;
    assert!(close(gauges[0].total_impulse()[0], after[1] - before[1]));
    assert!(close(gauges[1].total_impulse()[0], after[0] - before[0]));
    assert!(gauges[0].profile(THICKNESS).is_empty());
    assert_eq!(gauges.each_ref().map(BarrierGauge::boundary), [Some(0), Some(1)]);
    let rows = gauges[1].profile(THICKNESS);
    let sum: f64 = rows.iter().enumerate().map(|(k, r)| r.1 * if k % 4 == 0 { 0.5 * H } else { H }).sum();
    assert!(close(sum * THICKNESS, gauges[1].sample().normal));
}

/// The foot and the crest anywhere between two nodes, and a wall that leans: force and moment of the profile are those of the forces.
#[test]
fn the_moment_of_the_profile_is_that_of_the_forces_wherever_the_foot_lies() {
    for lean in [0.0, 0.2] {
        for k in 0..8 {
            let foot = Vector2::new(0.003, (0.125 * f64::from(k) - 0.5) * H);
            let brick = Brick::new([-3.0 * H, H], [3, 4], H);
            let law = AnyLaw::LinearElastic(LinearElastic::new(1e5, 0.2));
            let mut points = brick.points();
            points.iter_mut().for_each(|p| p.v = [2.0, 0.3]);
            let tangent = Vector2::new(libm::sin(lean), libm::cos(lean));
            let wall = Boundary::wall("wall", foot, tangent, HEIGHT + 0.3 * H, 4.0 * H, Friction::Smooth);
            let mut sim = Simulation::new(scene(&brick, law, DENSITY, points, vec![wall]));
            let mut gauge = BarrierGauge::new(&sim, 0);
            for _ in 0..20 {
                sim.step().unwrap();
                gauge.after_step(&sim);
            }
            let sample = gauge.sample();
            let rows = gauge.profile(THICKNESS);
            let last = rows.len() - 1;
            let force = |k: usize| rows[k].1 * if k == 0 || k == last { 0.5 * H } else { H } * THICKNESS;
            let sum: f64 = (0..=last).map(force).sum();
            let moment: f64 = (0..=last).map(|k| force(k) * rows[k].0).sum();
            assert!(sample.normal > 10.0 && close(sum, sample.normal), "{lean} {k}: {sum} {sample:?}");
            // Nodes behind the face, which shape functions barely reach, have an arm of their own.
            assert!((moment / sample.moment - 1.0).abs() < 0.005, "{lean} {k}: {moment} {sample:?}");
        }
    }
}

/// Forces anywhere on a face, whose foot lies at eight places between nodes and which stands upright or leans: the bins keep their sum
/// and their moment about the foot. The crest is no multiple of a cell above it.
#[test]
fn bins_keep_force_and_moment_to_round_off() {
    for lean in [0.0, 0.2, 0.7] {
        for k in 0..8 {
            let foot = 0.125 * f64::from(k);
            let height = 6.3;
            let bins = (height - NEAR).ceil() as usize + 1;
            let mut profile = vec![0.0; bins];
            let (mut force, mut moment) = (0.0, 0.0);
            for node in 1..8 {
                // Where a row of nodes meets the face, cells along it.
                let along = (f64::from(node) - foot) / libm::cos(lean);
                if along > height {
                    continue;
                }
                let f = 1.0 + libm::sin(f64::from(node));
                (force, moment) = (force + f, moment + f * along);
                let mut parts = 0;
                for (bin, share) in shares(along, bins) {
                    profile[bin] += share * f;
                    parts += 1;
                }
                assert!(parts == 2 || (along - along.round()).abs() < NEAR, "{lean} {k} {along}: {parts} bins");
            }
            let sum: f64 = profile.iter().sum();
            let turn: f64 = profile.iter().enumerate().map(|(bin, f)| bin as f64 * f).sum();
            assert!((sum / force - 1.0).abs() < 1e-12, "{lean} {k}: {sum} {force}");
            assert!((turn / moment - 1.0).abs() < 1e-12, "{lean} {k}: {turn} {moment}");
        }
    }
}

#[test]
fn a_bin_takes_all_that_acts_on_it_and_the_ends_what_lies_beyond() {
    let of = |height: f64, bins: usize| shares(height, bins).collect::<Vec<_>>();
    assert_eq!(of(2.0, 7), [(2, 1.0)]);
    assert_eq!(of(2.0 + 0.9 * NEAR, 7), [(2, 1.0)]);
    assert_eq!(of(2.0 - 0.9 * NEAR, 7), [(2, 1.0)]);
    assert_eq!(of(2.25, 7), [(2, 0.75), (3, 0.25)]);
    assert_eq!(of(-1.5, 7), [(0, 1.0)]);
    assert_eq!(of(9.5, 7), [(6, 1.0)]);
    assert!(of(1.0, 0).is_empty());
}

/// A wall that stands in a base, whose first row of nodes lies below the foot: what acts there counts at the foot, so the moment of the
/// profile is the larger by what that has about the foot, and by nothing else. Here that is 0.9 %,
/// and 2.4 % where the wall leans (seen, not derived).
#[test]
fn on_a_base_the_moment_lacks_only_what_acts_below_the_foot() {
    for (lean, most) in [(0.0, 0.01), (0.2, 0.03)] {
        for k in 0..8 {
            let foot = Vector2::new(0.003, (0.125 * f64::from(k) - 0.5) * H);
            let brick = Brick::new([-3.0 * H, foot.y], [3, 4], H);
            let law = AnyLaw::LinearElastic(LinearElastic::new(1e5, 0.2));
            let mut points = brick.points();
            points.iter_mut().for_each(|p| p.v = [2.0, 0.0]);
            let tangent = Vector2::new(libm::sin(lean), libm::cos(lean));
            let wall = Boundary::wall("wall", foot, tangent, HEIGHT + 0.3 * H, 4.0 * H, Friction::Smooth);
            let base = Boundary::plane("base", foot, Vector2::y(), Friction::Smooth);
            let mut scene = scene(&brick, law, DENSITY, points, vec![wall, base]);
            scene.gravity = [0.0, -9.81];
            let mut sim = Simulation::new(scene);
            let mut gauge = BarrierGauge::new(&sim, 0);
            let mut below = 0.0;
            for _ in 0..40 {
                sim.step().unwrap();
                gauge.after_step(&sim);
                let holds = sim.holds().filter(|h| h.boundary == 0).map(|h| (h.along, h.vector_impulse()));
                let sites = sim.sites().iter().filter(|s| s.boundary == 0).map(|s| (s.along, s.vector_impulse()));
                let normal = sim.boundaries()[0].normal;
                for (along, p) in holds.chain(sites).filter(|(along, p)| *along < 0.0 && *p != [0.0; 2]) {
                    assert!(along > -2.0 * H, "{lean} {k}: {along}");
                    below += Vector2::from(p).dot(&normal) * along;
                }
            }
            let sample = gauge.sample();
            let rows = gauge.profile(THICKNESS);
            let last = rows.len() - 1;
            let force = |k: usize| rows[k].1 * if k == 0 || k == last { 0.5 * H } else { H } * THICKNESS;
            let sum: f64 = (0..=last).map(force).sum();
            let moment: f64 = (0..=last).map(|k| force(k) * rows[k].0).sum();
            let below = below / sample.duration;
            assert!(sample.normal > 10.0 && close(sum, sample.normal), "{lean} {k}: {sum} {sample:?}");
            assert!(close(moment + below, sample.moment), "{lean} {k}: {moment} {below} {sample:?}");
            assert!((moment / sample.moment - 1.0).abs() < most, "{lean} {k}: {moment} {sample:?}");
        }
    }
}
