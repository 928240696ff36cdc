//! What a law keeps of its own goes with its point, through the loops and from sort to sort.

use super::*;
use crate::band::Band;
use crate::body::{Body, Particle, Points};
use crate::constitutive::{AnyLaw, Increment, Law, LinearElastic, NeoHookean, PointState, VonMises};
use crate::grid::Lattice;
use crate::layout::{SortRules, Sorter};
use crate::scaffold::{Brick, Lcg};
use crate::shape::ShapeFunction;

const H: f64 = 0.1;
const DT: f64 = 1e-3;
/// Velocity gradient dvx/dx, dvx/dy, dvy/dx, dvy/dy, 1/s.
const GRADIENT: [f64; 4] = [12.0, -25.0, 10.0, -15.0];
const POINTS: u32 = 1200;

/// No history, one number, three numbers.
fn laws(hardening: f64, viscosity: f64) -> [AnyLaw; 3] {
    let elastic = LinearElastic::new(1e6, 0.3);
    [
        AnyLaw::LinearElastic(elastic),
        AnyLaw::VonMises(VonMises { elastic, strength: 2e3, hardening: 5e4 * hardening, viscosity: 1e3 * viscosity }),
        AnyLaw::NeoHookean(NeoHookean::new(1e6, 0.3)),
    ]
}

/// A body's points, no two alike, in any order.
fn points(law: &AnyLaw, random: &mut Lcg) -> Points {
    let mut points = Points::for_law(law);
    for id in 0..POINTS {
        let mut p = Particle::at_rest(id, [1.5 * random.unit(), 0.4 * random.unit()]);
        let s = &mut p.state.stress;
        (s.xx, s.yy, s.xy) = (1e3 * random.signed(), 1e3 * random.signed(), 1e3 * random.signed());
        p.state.history[..law.history()].iter_mut().for_each(|value| *value = 0.02 * random.unit());
        points.push(&p);
    }
    points
}

/// Largest difference to `reference` laws at a point by itself, as a part of 10 kPa or of 1.
fn difference(p: &Particle, expected: &PointState) -> f64 {
    let (a, b) = (&p.state, expected);
    let (s, t) = (a.stress, b.stress);
    let stress = (s.xx - t.xx).abs() + (s.yy - t.yy).abs() + (s.zz - t.zz).abs() + (s.xy - t.xy).abs();
    let pairs = a.history.iter().zip(&b.history).map(|(x, y)| (x - y).abs());
    pairs.fold(1e-4 * stress, f64::max)
}

/// Moves points through ten steps and five sorts in an affine velocity, and compares each with a law at a point by itself: largest
/// difference, and number of points that left with a history of steps.
fn worst(reference: &[AnyLaw; 3]) -> (f64, usize) {
    let mut random = Lcg::new(11);
    let bodies: Vec<Body> = laws(1.0, 1.0).map(|law| Brick::new([0.0; 2], [1, 1], H).body(law, 1000.0)).into();
    let mut bands =
        vec![Band { points: bodies.iter().map(|b| points(&b.law, &mut random)).collect(), ..Band::default() }];
    let mut expected: Vec<Vec<Option<PointState>>> =
        bands[0].points.iter().map(|points| points.iter().map(|p| Some(p.state)).collect()).collect();
    let [xx, xy, yx, yy] = GRADIENT.map(|g| DT * g);
    let increment = Increment { dt: DT, xx, yy, xy: 0.5 * (yx + xy), spin: 0.5 * (yx - xy) };
    let rules = SortRules {
        lattice: Lattice { spacing: H, origin: [0.003, -0.001] },
        shape: ShapeFunction::Ugimp,
        bodies: &bodies,
        domain: [[-1.0, 1.4], [-1.0, 1.0]],
    };
    let (mut sorter, mut grid, mut departed) = (Sorter::default(), ActiveGrid::default(), Vec::new());
    let (mut worst, mut left) = (0.0f64, 0);
    for step in 0..10 {
        if step % 2 == 0 {
            departed.clear();
            sorter.sort(&rules, &mut bands, &mut grid, &mut departed);
            bands.iter_mut().for_each(Band::make_room);
            for gone in &departed {
                let state = expected[gone.body][gone.particle.id as usize].take().expect("it leaves once");
                worst = worst.max(difference(&gone.particle, &state));
                left += usize::from(step > 0 && gone.particle.state.history[0] != 0.0);
            }
        }
        for (law, states) in reference.iter().zip(&mut expected) {
            for state in states.iter_mut().flatten() {
                law.update(state, &increment);
            }
        }
        let velocities: Vec<[f64; 2]> = grid
            .nodes()
            .map(|(_, x)| [GRADIENT[0] * x[0] + GRADIENT[1] * x[1], GRADIENT[2] * x[0] + GRADIENT[3] * x[1]])
            .collect();
        for band in &mut bands {
            let work = &mut band.work;
            for (k, v) in velocities[band.first_node..][..band.reach].iter().enumerate() {
                (work.motion[k], work.strain_velocity[k]) = ([v[0], v[1], 0.0, 0.0], *v);
            }
            let mut moved = &mut work.moved[..];
            for (body, points) in bodies.iter().zip(&mut band.points) {
                let (displacement, rest) = moved.split_at_mut(points.block_count());
                moved = rest;
                let transfer = Transfer {
                    half_width: rules.shape.half_width(body.points_per_direction),
                    map: NodeMap::new(&grid, band.first_node),
                    constants: PointConstants { mass: body.point_mass, volume: body.point_volume, side_friction: 0.0 },
                };
                let velocity = VelocityUpdate { dt: DT, pic: 1.0, remap: false, move_now: false };
                transfer.gather_velocity(velocity, &work.motion, points, displacement, &mut work.remapped);
                let stress = StressUpdate { dt: DT, move_after: true };
                transfer.update_stress(body.law, stress, &work.strain_velocity, points, displacement);
            }
        }
        let mut seen = 0;
        for (body, p) in
            bands.iter().flat_map(|b| b.points.iter().enumerate().flat_map(|(k, p)| p.iter().map(move |p| (k, p))))
        {
            let state = expected[body][p.id as usize].as_ref().expect("it has not left");
            worst = worst.max(difference(&p, state));
            seen += 1;
        }
        assert_eq!(seen, expected.iter().flatten().flatten().count());
    }
    assert!(bands.len() > 2, "points wander between bands");
    (worst, left)
}

#[test]
fn a_history_goes_with_its_point() {
    // Other tests may run meanwhile: their numbers do not depend on it.
    for unit in [VectorUnit::Plain, VectorUnit::Avx2, VectorUnit::Avx512] {
        limit_vector_unit(unit);
        let (worst, left) = worst(&laws(1.0, 1.0));
        println!("{unit:?}: {worst:e}, {left} left");
        assert!(worst < 1e-11, "{unit:?}: {worst}");
        assert!(left > 50, "{left}");
    }
}

#[test]
fn three_percent_of_hardening_or_viscosity_are_noticed_in_the_loops() {
    for [hardening, viscosity] in [[0.97, 1.0], [1.03, 1.0], [1.0, 0.97], [1.0, 1.03]] {
        let (worst, _) = worst(&laws(hardening, viscosity));
        println!("{hardening} {viscosity}: {worst:e}");
        assert!(worst > 1e-4, "{hardening} {viscosity}: {worst}");
    }
}
