//! Laws that flow, in the solver: the same bits in every vector unit, and a heap that dissipates.

use super::*;
use crate::boundary::Friction;
use crate::constitutive::{Cone, DruckerPrager, Law, MohrCoulomb, MuI, Softening, VonMises};
use crate::scaffold::points_by_number;
use crate::transfer::{VectorUnit, limit_vector_unit};
use nalgebra::Vector2;

/// One of each; grains are so large, mud so thick and softening so soon that a heap of centimetres shows it.
fn flowing() -> [AnyLaw; 5] {
    let elastic = LinearElastic::new(1e6, 0.3);
    let cone = DruckerPrager::new(elastic, Cone::PlaneStrain, 0.6, 0.2, 50.0, 20.0, true);
    let pyramid = MohrCoulomb::new(elastic, 0.6, 0.2, 50.0, 20.0, true);
    [
        AnyLaw::MohrCoulomb(pyramid),
        AnyLaw::SofteningDruckerPrager(Softening { peak: cone, critical: 0.4, over: 0.05 }),
        AnyLaw::SofteningMohrCoulomb(Softening { peak: pyramid, critical: 0.4, over: 0.05 }),
        AnyLaw::VonMises(VonMises { elastic, strength: 200.0, hardening: 100.0, viscosity: 5.0 }),
        AnyLaw::MuI(MuI::new(elastic, [0.3, 0.6], 0.3, 5e-3, 2500.0, true)),
    ]
}

/// A heap that is thrown on a rough plane and turns.
fn heap(law: AnyLaw) -> Simulation {
    let brick = Brick::new([0.0, 0.0], [13, 7], 0.01);
    let base = Boundary::plane("base", Vector2::zeros(), Vector2::new(-0.03, 1.0), Friction::Coulomb(0.4));
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v = [5.0 * p.x[1], 0.2 - 5.0 * p.x[0]]);
    let mut scene = scene(&brick, law, 1500.0, points, vec![base]);
    scene.gravity = [3.0, -9.81];
    let mut sim = Simulation::new(scene);
    (0..150).for_each(|_| {
        sim.step().expect("a step");
    });
    sim
}

#[test]
fn every_vector_unit_gives_the_same_bits() {
    for law in flowing() {
        let bits = |unit: VectorUnit| -> Vec<u64> {
            limit_vector_unit(unit);
            let points = points_by_number(&heap(law));
            let state = |p: &crate::body::Particle| {
                let s = p.state.stress;
                [p.x[0], p.x[1], p.v[0], p.v[1], s.xx, s.yy, s.zz, s.xy, p.state.opened, p.state.plastic_shear]
            };
            points.iter().flat_map(state).chain(points.iter().flat_map(|p| p.state.history)).map(f64::to_bits).collect()
        };
        let [plain, narrow, wide] = [VectorUnit::Plain, VectorUnit::Avx2, VectorUnit::Avx512].map(bits);
        assert!(plain == narrow && plain == wide, "{law:?}");
    }
}

#[test]
fn a_heap_shears_and_loses_energy() {
    for law in flowing() {
        let sim = heap(law);
        let points = points_by_number(&sim);
        let sheared = points.iter().filter(|p| p.state.plastic_shear > 1e-3).count();
        assert!(3 * sheared > points.len(), "{law:?}: {sheared} of {}", points.len());
        // What was done on the material is more than what it has stored.
        let stored: f64 =
            points.iter().map(|p| law.stored_energy(&p.state) * p.volume_ratio * sim.bodies()[0].point_volume).sum();
        let work = sim.ledger().internal_work;
        assert!(stored >= 0.0 && work > 1.5 * stored, "{law:?}: {work} {stored}");
        assert!(points.iter().all(|p| p.state.stress.mean().is_finite() && p.state.opened >= 0.0));
    }
}
