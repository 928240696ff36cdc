//! Mohr-Coulomb plasticity with all its corners, dilatancy, a tension cut-off, and tracking of opened volume.
//!
//! The return is exact: to a face of the pyramid, to one of its two edges that meet the sextant of the trial stress, or to the cut-off,
//! which is at most the apex. In principal stresses all of them are linear and have closed forms (Clausen, Damkilde and Andersen 2006;
//! de Souza Neto, Peric and Owen 2008, section 8.2). The stress across the plane is one of the three.
//!
//! Elsewhere: Tresca, where nothing rubs; return mapping in principal stress space.

use super::elastic::LinearElastic;
use super::opened::{Capped, capped, closed, max};
use super::principal::Principal;
use super::{Increment, Law, PointState};
use crate::seeded::{self, Seed};

/// Mohr-Coulomb with linear elasticity. Yield, with s1 >= s2 >= s3: f = (s1 - s3) + (s1 + s3) sin(phi) - 2 c cos(phi) <= 0; flow: phi
/// replaced by psi.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MohrCoulomb {
    /// The elastic part.
    pub elastic: LinearElastic,
    /// Sine of the friction angle phi.
    pub friction: f64,
    /// Sine of the dilatancy angle psi; 0 keeps the volume.
    pub dilatancy: f64,
    /// Shear strength c cos(phi) of a circle about zero stress, Pa.
    pub cohesion: f64,
    /// Largest mean stress, Pa: at most the apex c cot(phi).
    pub tension_cutoff: f64,
    /// Whether material that came apart must close the opened volume before it builds pressure.
    pub void_tracking: bool,
}

impl MohrCoulomb {
    /// From the friction angle, the dilatancy angle (rad) and the cohesion (Pa).
    ///
    /// `tension_cutoff` (Pa) is lowered to the apex where it lies beyond it.
    pub fn new(
        elastic: LinearElastic,
        friction_angle: f64,
        dilatancy_angle: f64,
        cohesion: f64,
        tension_cutoff: f64,
        void_tracking: bool,
    ) -> Self {
        let (friction, strength) = (libm::sin(friction_angle), cohesion * libm::cos(friction_angle));
        let apex = if friction > 0.0 { strength / friction } else { f64::INFINITY };
        Self {
            elastic,
            friction: seeded::times(Seed::ConstitutivePyramid, friction),
            dilatancy: seeded::times(Seed::ConstitutivePyramidDilatancy, libm::sin(dilatancy_angle)),
            cohesion: strength,
            tension_cutoff: tension_cutoff.min(apex),
            void_tracking,
        }
    }

    /// Twice the yield function of the face on which `a` is the largest and `b` the smallest stress, Pa.
    #[inline(always)]
    fn face(&self, a: f64, b: f64) -> f64 {
        (a - b) + (a + b) * self.friction - 2.0 * self.cohesion
    }

    /// Where the return along the flow ends, as if there were neither apex nor cut-off, and whether it moved.
    #[inline(always)]
    fn returned(&self, [v0, v1, v2]: [f64; 3]) -> ([f64; 3], bool) {
        let (bulk, shear, s, t) = (self.elastic.bulk, self.elastic.shear, self.friction, self.dilatancy);
        // What a unit of flow on a face does to the largest, to the smallest and to the other stress.
        let down = -2.0 * shear * (1.0 + t / 3.0) - 2.0 * bulk * t;
        let up = 2.0 * shear * (1.0 - t / 3.0) - 2.0 * bulk * t;
        let aside = (4.0 / 3.0 * shear - 2.0 * bulk) * t;
        // What it takes off the face itself, and off the other face of an edge: s2 = s3 or s1 = s2.
        let pressed = 4.0 * bulk * s * t;
        let own = 4.0 * shear * (1.0 + s * t / 3.0) + pressed;
        let lower = 2.0 * shear * (1.0 + s + t - s * t / 3.0) + pressed;
        let upper = 2.0 * shear * (1.0 - s - t - s * t / 3.0) + pressed;
        let per_own = 1.0 / own;
        let (per_lower, per_upper) = (1.0 / (own * own - lower * lower), 1.0 / (own * own - upper * upper));

        let over = max(0.0, self.face(v0, v2));
        let slip = over * per_own;
        let (m0, m1, m2) = (v0 + down * slip, v1 + aside * slip, v2 + up * slip);
        let on_edge = m0 < m1 || m1 < m2;
        // Which edge, by the side of the plane on which the flow of the face leads to both.
        let at_lower = (1.0 - t) * v0 - 2.0 * v1 + (1.0 + t) * v2 > 0.0;
        let (second, per) = if at_lower { (lower, per_lower) } else { (upper, per_upper) };
        let other = if at_lower { self.face(v0, v1) } else { self.face(v1, v2) };
        let a = (own * over - second * other) * per;
        let b = (own * other - second * over) * per;
        let (x, y, z) = if at_lower { (down, up, aside) } else { (aside, down, up) };
        let edge = [v0 + down * a + x * b, v1 + aside * a + y * b, v2 + up * a + z * b];
        let pick = |k: usize, face: f64| if on_edge { edge[k] } else { face };
        ([pick(0, m0), pick(1, m1), pick(2, m2)], over > 0.0)
    }
}

impl Law for MohrCoulomb {
    #[inline(always)]
    fn update(&self, state: &mut PointState, d: &Increment) -> f64 {
        let (bulk, shear) = (self.elastic.bulk, self.elastic.shear);
        let half = d.half_turn();
        let before = state.stress.turned(half);
        // Opened material closes without resistance first.
        let (closing, still_open) = closed(state.opened, d);
        let trial = self.elastic.strain(&before, d, d.volumetric() + closing);

        let principal = Principal::of(&trial);
        let tried = principal.values;
        let mean_of = |v: [f64; 3]| (v[0] + v[1] + v[2]) * (1.0 / 3.0);
        let (returned, yields) = self.returned(tried);
        let (mean_tried, mean_returned) = (mean_of(tried), mean_of(returned));
        let Capped { uncapped, mean, opened } =
            capped(mean_returned, still_open, bulk, self.tension_cutoff, self.void_tracking);

        // At the cut-off, and where dilatancy has filled what was open, the deviator shrinks to the pyramid as it is.
        let cut = mean < uncapped;
        let (from, about) = if cut { (tried, mean_tried) } else { (returned, mean_returned) };
        let [s0, s1, s2] = from.map(|v| v - about);
        let (size, room) = ((s0 - s2) + (s0 + s2) * self.friction, 2.0 * (self.cohesion - mean * self.friction));
        let fits = if size > room { room / size } else { 1.0 };
        let scale = if room > 0.0 { fits } else { 0.0 };
        let [s0, s1, s2] = [scale * s0, scale * s1, scale * s2];
        let rebuilt = principal.with([mean + s0, mean + s1, mean + s2]);
        let touched = yields || mean != mean_returned;
        let pick = |new: f64, old: f64| if touched { new } else { old };
        let after = rebuilt.zip(&trial, pick);

        // sqrt(2/3 e:e) with the deviator e of the plastic strain.
        let [e0, e1, e2] = [tried[0] - mean_tried - s0, tried[1] - mean_tried - s1, tried[2] - mean_tried - s2];
        let sheared = (e0 * e0 + e1 * e1 + e2 * e2).sqrt() * (1.0 / (shear * 6f64.sqrt()));
        state.plastic_shear += if touched { sheared } else { 0.0 };
        state.opened = opened;
        state.stress = after.turned(half);
        d.midpoint_work(&before, &after)
    }

    fn stored_energy(&self, state: &PointState) -> f64 {
        self.elastic.energy(&state.stress)
    }

    fn lame(&self) -> [f64; 2] {
        self.elastic.lame()
    }

    fn p_wave_modulus(&self) -> f64 {
        self.elastic.p_wave_modulus()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constitutive::tests::{near, same};
    use crate::constitutive::{HalfTurn, Stress, Symmetric};
    use crate::scaffold::Lcg;
    use crate::theory::mohr_coulomb as theory;

    const PHI: f64 = 0.55;

    fn elastic(poisson: f64) -> LinearElastic {
        LinearElastic::new(1e6, poisson)
    }

    /// Without a cut-off below the apex.
    fn law(psi: f64, cohesion: f64) -> MohrCoulomb {
        MohrCoulomb::new(elastic(0.3), PHI, psi, cohesion, f64::INFINITY, true)
    }

    fn pressed(p: f64) -> PointState {
        PointState { stress: Stress { xx: -p, yy: -p, zz: -p, xy: 0.0 }, ..PointState::default() }
    }

    fn strain(xx: f64, yy: f64, xy: f64) -> Increment {
        Increment { xx, yy, xy, ..Increment::default() }
    }

    /// Three numbers, from the largest to the smallest.
    fn sorted(mut of: [f64; 3]) -> [f64; 3] {
        of.sort_by(|a, b| b.total_cmp(a));
        of
    }

    /// Plastic strain that takes the first principal stress to the second.
    fn plastic(law: &MohrCoulomb, from: [f64; 3], to: [f64; 3]) -> [f64; 3] {
        let d = [0, 1, 2].map(|k| from[k] - to[k]);
        let mean = (d[0] + d[1] + d[2]) / 3.0;
        d.map(|s| (s - mean) / (2.0 * law.elastic.shear) + mean / (3.0 * law.elastic.bulk))
    }

    /// What becomes of principal stresses, none of them across the plane by preference.
    fn returned(law: &MohrCoulomb, trial: [f64; 3], turn: usize) -> [f64; 3] {
        let [xx, yy, zz] = [0, 1, 2].map(|k| trial[(k + turn) % 3]);
        let mut state = PointState { stress: Stress { xx, yy, zz, xy: 0.0 }, ..PointState::default() };
        // What is tracked is torn beyond the apex.
        MohrCoulomb { void_tracking: false, ..*law }.update(&mut state, &Increment::default());
        let s = state.stress;
        assert_eq!(s.xy, 0.0);
        sorted([s.xx, s.yy, s.zz])
    }

    /// Associated flow is the closest admissible stress in the norm of the elastic energy, at faces, edges and the apex: no other
    /// admissible stress would dissipate more.
    #[test]
    fn associated_flow_dissipates_most() {
        let mut random = Lcg::new(5);
        let law = law(PHI, 500.0);
        let admissible: Vec<[f64; 3]> = std::iter::repeat_with(|| [0; 3].map(|_| 4e3 * random.signed() - 1e3))
            .map(sorted)
            .filter(|s| law.face(s[0], s[2]) <= 0.0)
            .take(300)
            .chain([[theory::apex(PHI, 500.0); 3]])
            .collect();
        let mut kinds = [0; 4];
        for k in 0..400 {
            let trial = sorted([0; 3].map(|_| 5e3 * random.signed()));
            let end = returned(&law, trial, k);
            assert!(law.face(end[0], end[2]) < 1e-9, "{trial:?} {end:?}");
            let flow = plastic(&law, trial, end);
            for other in &admissible {
                let more: f64 = (0..3).map(|k| flow[k] * (end[k] - other[k])).sum();
                assert!(more > -1e-9, "{trial:?} to {end:?} loses against {other:?} by {more}");
            }
            let apex = end[0] - end[2] < 1e-6;
            let kind = if apex {
                3
            } else if end[1] - end[2] < 1e-6 {
                2
            } else {
                usize::from(end[0] - end[1] < 1e-6)
            };
            kinds[kind] += usize::from(law.face(trial[0], trial[2]) > 0.0);
        }
        assert!(kinds.iter().all(|n| *n > 5), "face, edges and apex: {kinds:?}");
    }

    /// A sum of flows on faces gains as much volume as sin(psi) says of its shear, with the signs of its sextant; nothing is negative.
    #[test]
    fn flow_on_faces_and_edges_is_that_of_the_potential() {
        let mut random = Lcg::new(6);
        for (k, psi) in [0.0, 0.2, PHI, 0.0, 0.2, PHI].into_iter().enumerate() {
            let law = law(psi, 500.0);
            let mut seen = 0;
            for _ in 0..200 {
                let trial = sorted([0; 3].map(|_| 5e3 * random.signed() - 3e3));
                let end = returned(&law, trial, k);
                let flow = plastic(&law, trial, end);
                assert!(law.face(end[0], end[2]) < 1e-9);
                let worth: f64 = (0..3).map(|k| flow[k] * end[k]).sum();
                assert!(worth > -1e-9, "energy from nothing: {trial:?} {end:?}");
                if law.face(trial[0], trial[2]) <= 0.0 {
                    assert!((0..3).all(|k| (end[k] - trial[k]).abs() < 1e-9), "{trial:?} {end:?}");
                } else if end[0] > end[2] + 1e-6 {
                    let size: f64 = flow.iter().map(|e| e.abs()).sum();
                    let volume: f64 = flow.iter().sum();
                    assert!((volume - law.dilatancy * size).abs() < 1e-12, "{trial:?} {end:?} {flow:?}");
                    assert!(flow[0] > 0.0 && flow[2] < 0.0);
                    seen += 1;
                }
            }
            assert!(seen > 50);
        }
    }

    #[test]
    fn strength_is_the_same_on_both_meridians_and_in_the_plane() {
        let (p, cohesion) = (1e4, 700.0);
        // Pure shear at constant volume: half the difference is p sin(phi) + c cos(phi).
        let flat = law(0.0, cohesion);
        let mut state = pressed(p);
        flat.update(&mut state, &strain(0.0, 0.0, 0.05));
        near(state.stress.xy, p * libm::sin(PHI) + cohesion * libm::cos(PHI));
        near(state.stress.mean(), -p);
        // Equivalent plastic shear of simple shear is gamma / sqrt(3).
        near(state.plastic_shear, (0.1 - state.stress.xy / flat.elastic.shear) / 3f64.sqrt());
        // Confined compression has two equal least pressures, and unloading two equal greatest.
        let soft = MohrCoulomb::new(elastic(0.1), PHI, 0.0, 0.0, 0.0, true);
        let mut state = PointState::default();
        (0..20).for_each(|_| {
            soft.update(&mut state, &strain(0.0, -1e-3, 0.0));
        });
        let ratio = theory::passive_ratio(PHI);
        near(state.stress.yy / state.stress.xx, ratio);
        near(state.stress.zz / state.stress.xx, 1.0);
        near(state.stress.xx / state.stress.yy, theory::oedometric_ratio(0.1, PHI));
        (0..17).for_each(|_| {
            soft.update(&mut state, &strain(0.0, 1e-3, 0.0));
        });
        near(state.stress.xx / state.stress.yy, ratio);
        near(state.stress.zz / state.stress.xx, 1.0);
        // Pressed from both sides, the least pressure is the one across the plane.
        let mut state = PointState::default();
        soft.update(&mut state, &strain(-1e-3, -1e-3, 0.0));
        near(state.stress.xx / state.stress.zz, ratio);
    }

    #[test]
    fn tension_ends_at_the_apex_or_the_cut_off() {
        let (cohesion, apex) = (700.0, theory::apex(PHI, 700.0));
        let solid = MohrCoulomb { void_tracking: false, ..law(0.1, cohesion) };
        near(solid.tension_cutoff, apex);
        let mut state = PointState::default();
        solid.update(&mut state, &strain(0.01, 0.01, 0.02));
        same(state.stress, Stress { xx: apex, yy: apex, zz: apex, xy: 0.0 });
        assert_eq!(state.opened, 0.0);
        // Below the apex the deviator at the cut-off has the strength there.
        let cut = MohrCoulomb::new(elastic(0.3), PHI, 0.1, cohesion, 300.0, false);
        let mut state = PointState::default();
        cut.update(&mut state, &strain(0.01, 0.01, 0.02));
        near(state.stress.mean(), 300.0);
        let s = Principal::of(&state.stress).values;
        assert!(cut.face(s[0], s[2]).abs() < 1e-9 && s[0] - s[2] > 100.0, "{s:?}");
        let tresca = MohrCoulomb::new(elastic(0.3), 0.0, 0.0, cohesion, f64::INFINITY, false);
        let mut state = PointState::default();
        tresca.update(&mut state, &strain(0.01, 0.01, 0.02));
        near(state.stress.xy, cohesion);
        near(state.stress.mean(), tresca.elastic.bulk * 0.02);
    }

    #[test]
    fn what_opens_must_close() {
        let sand = law(0.0, 0.0);
        let mut state = pressed(1e3);
        sand.update(&mut state, &strain(0.01, 0.0, 0.0));
        same(state.stress, Stress::default());
        near(state.opened, 0.01 - 1e3 / sand.elastic.bulk);
        let before = state.opened;
        assert_eq!(sand.update(&mut state, &strain(-0.004, 0.0, 0.003)), 0.0);
        near(state.opened, before - 0.004);
        same(state.stress, Stress::default());
        // Dilatancy fills what is open: sheared by as much as it takes, it does not press.
        let dense = law(0.2, 0.0);
        let (bulk, shear) = (dense.elastic.bulk, dense.elastic.shear);
        let slip = 4.0 * shear * 0.01
            / (4.0 * shear * (1.0 + dense.friction * dense.dilatancy / 3.0)
                + 4.0 * bulk * dense.friction * dense.dilatancy);
        let gained = 2.0 * dense.dilatancy * slip;
        let mut wide = PointState { opened: 2.0 * gained, ..PointState::default() };
        dense.update(&mut wide, &strain(0.0, 0.0, 0.01));
        near(wide.opened / gained, 1.0);
        same(wide.stress, Stress::default());
        let mut narrow = PointState { opened: 0.25 * gained, ..PointState::default() };
        dense.update(&mut narrow, &strain(0.0, 0.0, 0.01));
        assert_eq!(narrow.opened, 0.0);
        near(narrow.stress.mean() / (-0.75 * bulk * gained), 1.0);
        let s = Principal::of(&narrow.stress).values;
        assert!(dense.face(s[0], s[2]).abs() < 1e-9 * bulk * gained, "{s:?}");
    }

    #[test]
    fn it_has_no_directions_of_its_own() {
        let mut random = Lcg::new(9);
        let law = law(0.15, 300.0);
        let turn = HalfTurn { cos2: 0.28, sin2: 0.96 };
        let [mut a, mut b] = [pressed(2e3); 2];
        for _ in 0..200 {
            let e = Symmetric { xx: random.signed(), yy: random.signed() - 0.1, zz: 0.0, xy: random.signed() + 0.5 }
                .times(2e-3);
            let t = e.turned(turn);
            let spin = 0.01 * random.signed();
            let work = law.update(&mut a, &Increment { dt: 0.0, xx: e.xx, yy: e.yy, xy: e.xy, spin });
            let turned = law.update(&mut b, &Increment { dt: 0.0, xx: t.xx, yy: t.yy, xy: t.xy, spin });
            same(a.stress.turned(turn), b.stress);
            near(work, turned);
            near(a.opened, b.opened);
            near(a.plastic_shear, b.plastic_shear);
        }
        assert!(a.plastic_shear > 0.05);
    }

    #[test]
    fn inside_the_pyramid_it_is_elastic_to_the_bit() {
        let law = law(0.1, 0.0);
        let d = Increment { dt: 1.0, xx: -1e-4, yy: 2e-4, xy: 1e-4, spin: 0.01 };
        let (mut state, mut free) = (pressed(1e4), pressed(1e4));
        assert_eq!(law.update(&mut state, &d), law.elastic.update(&mut free, &d));
        assert_eq!(state, free);
        near(law.stored_energy(&state), law.elastic.stored_energy(&state));
        assert_eq!((law.lame(), law.p_wave_modulus()), (law.elastic.lame(), law.elastic.p_wave_modulus()));
        // Nothing changes without strain, once it has returned.
        let mut flown = pressed(1e4);
        law.update(&mut flown, &Increment { xy: 0.03, ..d });
        let mut again = flown;
        law.update(&mut again, &Increment::default());
        same(again.stress, flown.stress);
        near(again.plastic_shear, flown.plastic_shear);
    }
}
