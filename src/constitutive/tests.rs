//! The laws in rate form at one point, against closed forms.

use super::*;
use crate::theory::drucker_prager as theory;
use crate::theory::elastic::Elastic;

const MATERIAL: Elastic = Elastic { young: 1e6, poisson: 0.3 };
const PHI: f64 = 0.55;
const PSI: f64 = 0.15;

fn elastic() -> LinearElastic {
    LinearElastic::new(MATERIAL.young, MATERIAL.poisson)
}

/// A cone with dilatancy, cohesion (Pa) and a tension cut-off (Pa).
fn plastic(cone: Cone, cohesion: f64, cutoff: f64, void_tracking: bool) -> DruckerPrager {
    DruckerPrager::new(elastic(), cone, PHI, PSI, cohesion, cutoff, void_tracking)
}

fn pressure(p: f64) -> Stress {
    Stress { xx: -p, yy: -p, zz: -p, xy: 0.0 }
}

fn at(stress: Stress, opened: f64) -> PointState {
    PointState { stress, opened, ..PointState::default() }
}

pub(super) fn near(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-12 * b.abs().max(1.0), "{a} instead of {b}");
}

pub(super) fn same(a: Stress, b: Stress) {
    for (x, y) in [(a.xx, b.xx), (a.yy, b.yy), (a.zz, b.zz), (a.xy, b.xy)] {
        assert!((x - y).abs() <= 1e-9 * (1.0 + y.abs()), "{a:?} instead of {b:?}");
    }
}

#[test]
fn confined_compression_and_shear_are_hookes() {
    let (law, e) = (elastic(), -1e-3);
    near(law.p_wave_modulus(), MATERIAL.confined());
    let lame = law.p_wave_modulus() - 2.0 * law.shear;
    near(law.shear, 1e6 / 2.6);
    let mut state = PointState::default();
    let work = law.update(&mut state, &Increment { xx: e, ..Increment::default() });
    same(state.stress, Stress { xx: MATERIAL.confined() * e, yy: lame * e, zz: lame * e, xy: 0.0 });
    near(work, 0.5 * MATERIAL.confined() * e * e);
    near(law.stored_energy(&state), work);
    let mut state = PointState::default();
    let work = law.update(&mut state, &Increment { yy: e, xy: 2e-3, ..Increment::default() });
    let shear = 2.0 * law.shear * 2e-3;
    same(state.stress, Stress { xx: lame * e, yy: MATERIAL.confined() * e, zz: lame * e, xy: shear });
    near(work, 0.5 * MATERIAL.confined() * e * e + shear * 2e-3);
    near(law.stored_energy(&state), work);
}

#[test]
fn half_of_the_spin_comes_before_the_strain_and_half_after() {
    let (law, e, w) = (elastic(), 1e-3, 0.3);
    let d = Increment { xx: e, spin: w, ..Increment::default() };
    let half = d.half_turn();
    let start = Stress { xx: 500.0, yy: -300.0, zz: 70.0, xy: 200.0 };
    let mut strained = at(start.turned(half), 0.0);
    let work = law.update(&mut strained, &Increment { spin: 0.0, ..d });
    let expected = strained.stress.turned(half);
    let strong = AnyLaw::DruckerPrager(plastic(Cone::PlaneStrain, 1e6, 1e9, false));
    for law in [AnyLaw::LinearElastic(law), strong] {
        let mut state = at(start, 0.0);
        near(law.update(&mut state, &d), work);
        same(state.stress, expected);
    }
}

#[test]
fn volumes_follow_the_volumetric_strain() {
    let d = Increment { dt: 1.0, xx: 0.03, yy: -0.01, xy: 0.7, spin: 0.5 };
    for law in [AnyLaw::LinearElastic(elastic()), AnyLaw::DruckerPrager(plastic(Cone::PlaneStrain, 0.0, 0.0, true))] {
        let ratio = law.volume_ratio(&PointState::default(), 1.2, &d);
        assert!((ratio / (1.2 * libm::exp(0.02)) - 1.0).abs() < 1e-6, "{ratio}");
        assert_eq!((law.history(), law.deformation(&PointState::default())), (0, None));
        near(law.lame()[0] + 2.0 * law.lame()[1], MATERIAL.confined());
        near(law.p_wave_modulus(), MATERIAL.confined());
        let state = at(Stress { xx: 100.0, yy: -50.0, zz: 20.0, xy: 30.0 }, 0.0);
        near(law.stored_energy(&state), elastic().stored_energy(&state));
    }
    let neo = AnyLaw::NeoHookean(NeoHookean::new(MATERIAL.young, MATERIAL.poisson));
    near(neo.lame()[0] + 2.0 * neo.lame()[1], MATERIAL.confined());
    near(neo.lame()[1], elastic().lame()[1]);
    near(neo.p_wave_modulus(), MATERIAL.confined());
    // Uniaxial stretch: J is the stretch itself; what is stored per current volume is the work done at the mean volume.
    let mut state = PointState::default();
    let work = neo.update(&mut state, &Increment { xx: 0.25, ..Increment::default() });
    let ratio = neo.volume_ratio(&state, 7.0, &d);
    near(ratio, 1.25);
    assert_eq!(neo.history(), 3);
    near(neo.deformation(&state).expect("a tensor").xx, 1.25 * 1.25 - 1.0);
    near(neo.stored_energy(&state) * ratio, work * 0.5 * (1.0 + ratio));
    assert!(work > 0.0);
    // Half of the way back gives back the difference.
    let stored = neo.stored_energy(&state) * 1.25;
    let back = neo.update(&mut state, &Increment { xx: -0.1, ..Increment::default() });
    let left = neo.stored_energy(&state) * 1.125;
    near(back * 0.5 * (1.25 + 1.125), left - stored);
    assert!(back < 0.0 && left > 0.0);
}

#[test]
fn cones_have_the_slopes_and_strengths_of_their_angles() {
    let cohesion = 700.0;
    let apex = cohesion * libm::cos(PHI) / libm::sin(PHI);
    let potential = theory::plane_strain_potential(PSI);
    let outer = theory::outer_slope(PHI);
    for (cone, q, q_psi) in [
        (Cone::TriaxialCompression, outer, theory::outer_slope(PSI)),
        (Cone::TriaxialExtension, theory::inner_slope(PHI), theory::inner_slope(PSI)),
        (Cone::PlaneStrain, theory::plane_strain_slope(PHI, potential), potential),
    ] {
        let law = plastic(cone, cohesion, 1e9, true);
        near(law.friction, q);
        near(law.dilatancy, q_psi);
        // Every cone has the apex of Mohr-Coulomb, and no cut-off beyond it.
        near(law.cohesion / law.friction, apex);
        near(law.tension_cutoff, apex);
        assert_eq!(plastic(cone, cohesion, 3.0, true).tension_cutoff, 3.0);
    }
    let printed = plastic(Cone::AsPrinted, cohesion, 0.0, true);
    near(printed.friction, outer / 3.0);
    near(printed.dilatancy, theory::outer_slope(PSI) / 3.0);
    near(printed.cohesion, 2.0 * 3f64.sqrt() * libm::cos(PHI) / (3.0 - libm::sin(PHI)));
    // Without friction the strength itself is that of Tresca, and there is no apex.
    for (cone, k) in [
        (Cone::PlaneStrain, cohesion),
        (Cone::TriaxialCompression, 2.0 / 3f64.sqrt() * cohesion),
        (Cone::TriaxialExtension, 2.0 / 3f64.sqrt() * cohesion),
    ] {
        let clay = DruckerPrager::new(elastic(), cone, 0.0, 0.0, cohesion, 1e9, false);
        near(clay.cohesion, k);
        assert_eq!((clay.friction, clay.dilatancy, clay.tension_cutoff), (0.0, 0.0, 1e9));
    }
}

#[test]
fn inside_the_cone_it_is_elastic() {
    let law = plastic(Cone::PlaneStrain, 0.0, 0.0, true);
    let d = Increment { dt: 1.0, xx: -1e-4, yy: 2e-4, xy: 1e-4, spin: 0.01 };
    let (mut state, mut free) = (at(pressure(1e4), 0.0), at(pressure(1e4), 0.0));
    near(law.update(&mut state, &d), elastic().update(&mut free, &d));
    same(state.stress, free.stress);
    assert_eq!((state.opened, state.plastic_shear), (0.0, 0.0));
}

#[test]
fn shear_beyond_the_cone_returns_along_the_flow() {
    let (p, cohesion) = (1e4, 500.0);
    for cone in [Cone::TriaxialCompression, Cone::PlaneStrain] {
        let law = plastic(cone, cohesion, 0.0, true);
        let (bulk, shear, q, flow) = (law.elastic.bulk, law.elastic.shear, law.friction, law.dilatancy);
        let mut state = at(pressure(p), 0.0);
        let d = Increment { xy: 0.02, ..Increment::default() };
        let work = law.update(&mut state, &d);
        let (trial, s) = (2.0 * shear * 0.02, state.stress);
        // Plastic strain: shear that takes off stress, and volume that adds pressure, in the ratio of the flow.
        let slipped = (trial - s.xy) / shear;
        near(s.mean() / (-p - bulk * flow * slipped), 1.0);
        near(s.xy / (law.cohesion - q * s.mean()), 1.0);
        assert!(s.xy < 0.9 * trial && s.xx == s.yy && s.yy == s.zz);
        near(state.plastic_shear, slipped / 3f64.sqrt());
        near(work, (0.0 + s.xy) * 0.02);
        assert_eq!(state.opened, 0.0);
    }
}

#[test]
fn deviators_shrink_together() {
    let law = plastic(Cone::PlaneStrain, 0.0, 0.0, false);
    let mut state = at(Stress { xx: -9e3, yy: -2e3, zz: -4e3, xy: 1e3 }, 0.0);
    law.update(&mut state, &Increment::default());
    let s = state.stress;
    let deviators = [s.xx - s.mean(), s.yy - s.mean(), s.zz - s.mean(), s.xy];
    let scale = s.xy / 1e3;
    for (d, trial) in deviators.into_iter().zip([-4e3, 3e3, 1e3, 1e3]) {
        near(d, scale * trial);
    }
    near(s.j2().sqrt(), -law.friction * s.mean());
    assert!(scale > 0.1 && scale < 0.9 && s.mean() < -5e3, "{s:?}");
}

#[test]
fn tension_is_cut_off_and_what_opens_must_close() {
    let bulk = elastic().bulk;
    let stretch = |v: f64| Increment { xx: 0.5 * v, yy: 0.5 * v, ..Increment::default() };
    // In-plane stretch shears as well: the deviator at the cut-off is that of the cone.
    let solid = plastic(Cone::PlaneStrain, 1e4, 2e3, false);
    let mut state = PointState::default();
    solid.update(&mut state, &stretch(0.03));
    near(state.stress.mean(), 2e3);
    near(
        state.stress.j2().sqrt(),
        f64::min(solid.cohesion - solid.friction * 2e3, elastic().shear * 0.03 / 3f64.sqrt()),
    );
    assert_eq!(state.opened, 0.0, "nothing is tracked");

    // Sand opens by the stretch less what its dilatancy takes up, and closes by it before it presses.
    let sand = plastic(Cone::PlaneStrain, 0.0, 0.0, true);
    let (shear, q, flow) = (sand.elastic.shear, sand.friction, sand.dilatancy);
    let mut state = at(Stress::default(), 1e-3);
    assert_eq!(sand.update(&mut state, &stretch(0.03)), 0.0);
    same(state.stress, Stress::default());
    let slip = (shear * 0.03 / 3f64.sqrt() + q * bulk * 0.03) / (shear + bulk * q * flow);
    near(state.opened, 1e-3 + 0.03 - flow * slip);
    let mut state = at(Stress::default(), 0.01);
    assert_eq!(sand.update(&mut state, &stretch(-0.004)), 0.0);
    assert!(state.opened <= 0.006 && state.opened > 0.0 && state.stress == Stress::default(), "{state:?}");
    let mut closed = PointState::default();
    let rigid = DruckerPrager { dilatancy: 0.0, ..sand };
    rigid.update(&mut closed, &stretch(-0.006));
    let mut state = at(Stress::default(), 0.01);
    rigid.update(&mut state, &stretch(-0.016));
    near(state.stress.mean() / (-bulk * 0.006), 1.0);
    assert_eq!(state.opened, 0.0);

    // Cemented sand that tears has lost its tensile strength.
    let cemented = plastic(Cone::PlaneStrain, 1e4, 2e3, true);
    let mut whole = PointState::default();
    let still = 1.8e3 / bulk;
    cemented.update(&mut whole, &stretch(still));
    near(whole.stress.mean(), bulk * still);
    assert_eq!(whole.opened, 0.0);
    let mut torn = PointState::default();
    cemented.update(&mut torn, &stretch(0.03));
    assert!(torn.stress.mean().abs() < 1e-9);
    assert!(torn.opened > 0.02);
    cemented.update(&mut torn, &stretch(1e-4));
    assert!(torn.stress.mean().abs() < 1e-9);
    // A cut-off below zero demands pressure.
    let pressed = DruckerPrager { tension_cutoff: -100.0, ..sand };
    let mut state = at(pressure(1e3), 0.0);
    pressed.update(&mut state, &stretch(0.01));
    near(state.stress.mean(), -100.0);
}

#[test]
fn dilatancy_fills_what_is_open_before_it_presses() {
    let law = plastic(Cone::PlaneStrain, 0.0, 0.0, true);
    let (bulk, shear) = (law.elastic.bulk, law.elastic.shear);
    let d = Increment { xy: 0.01, ..Increment::default() };
    let gained = law.dilatancy * 2.0 * shear * 0.01 / (shear + bulk * law.friction * law.dilatancy);
    let mut wide = at(Stress::default(), 2.0 * gained);
    law.update(&mut wide, &d);
    near(wide.opened / gained, 1.0);
    same(wide.stress, Stress::default());
    let mut narrow = at(Stress::default(), 0.25 * gained);
    law.update(&mut narrow, &d);
    assert_eq!(narrow.opened, 0.0);
    near(narrow.stress.mean() / (-0.75 * bulk * gained), 1.0);
    near(narrow.stress.xy / (0.75 * law.friction * bulk * gained), 1.0);
    near(narrow.plastic_shear, (2.0 * shear * 0.01 - narrow.stress.xy) / (shear * 3f64.sqrt()));
}

#[test]
fn open_cemented_material_shears_without_tension() {
    let law = plastic(Cone::PlaneStrain, 1e4, 2e3, true);
    let (bulk, shear) = (law.elastic.bulk, law.elastic.shear);
    let d = Increment { xy: 0.02, ..Increment::default() };
    let multiplier = (2.0 * shear * 0.02 - law.cohesion) / (shear + bulk * law.friction * law.dilatancy);
    let gained = law.dilatancy * multiplier;
    // What stays open would close under less tension than the cut-off.
    let opened = gained + 1e3 / bulk;
    let mut state = at(Stress::default(), opened);
    law.update(&mut state, &d);
    near(state.opened / (opened - gained), 1.0);
    assert!(state.stress.mean().abs() < 1e-9, "{state:?}");
    near(state.stress.xy / law.cohesion, 1.0);
}

#[test]
fn pressure_without_shear_stays() {
    let law = plastic(Cone::PlaneStrain, 0.0, 0.0, true);
    for p in [0.0, 1e3] {
        let mut state = at(pressure(p), 0.0);
        assert_eq!(law.update(&mut state, &Increment::default()), 0.0);
        assert_eq!(state, at(pressure(p), 0.0));
    }
}
