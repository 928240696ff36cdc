//! A barrier that stands, and material laid beside it by hand: what is seen must not depend on which way the barrier faces.

use super::*;
use crate::body::{Body, Particle};
use crate::constitutive::{AnyLaw, Finger, LinearElastic, Stress};
use crate::gauge::barrier::BarrierGauge;
use crate::simulation::Scene;

/// Cell size, distance of the barrier's points, and how many of them lie across and along it, m.
const CELL: f64 = 0.1;
const SPACING: f64 = 0.05;
const COUNTS: [usize; 2] = [6, 12];
/// How far it reaches below its foot, m.
const BURIED: f64 = 0.1;
const FOOT: [f64; 2] = [0.7, -0.4];
/// Mass (kg), volume (m3) and distance (m) of the points of two materials.
const MATERIALS: [(f64, f64, f64); 2] = [(1.0, SPACING * SPACING * THICKNESS, SPACING), (2.0, 5e-5, 0.025)];

/// A barrier's frame: how far it leans, and whether the material is on its right.
#[derive(Debug, Clone, Copy)]
struct View {
    angle: f64,
    right: bool,
}

const VIEWS: [View; 5] = [
    View { angle: 0.0, right: false },
    View { angle: 0.0, right: true },
    View { angle: 0.3, right: false },
    View { angle: -0.5, right: true },
    View { angle: -0.5, right: false },
];

impl View {
    fn face(self) -> Boundary {
        let (tangent, foot) = (Vector2::new(-libm::sin(self.angle), libm::cos(self.angle)), Vector2::from(FOOT));
        let wall = Boundary::wall("face", foot, tangent, 0.5, 0.2, Friction::Smooth);
        if self.right { wall.facing_right() } else { wall }
    }

    /// A vector from its components out of the face and up along it.
    fn vector(self, [out, up]: [f64; 2]) -> [f64; 2] {
        let (c, s) = (libm::cos(self.angle), libm::sin(self.angle));
        let out = if self.right { out } else { -out };
        [c * out - s * up, s * out + c * up]
    }

    fn at(self, x: [f64; 2]) -> [f64; 2] {
        let x = self.vector(x);
        [FOOT[0] + x[0], FOOT[1] + x[1]]
    }

    /// A point of a material in front of the face, under stresses out of the face, along it, and in shear, Pa.
    fn grain(self, x: [f64; 2], [oo, uu, ou]: [f64; 3]) -> Particle {
        let mut p = Particle { volume_ratio: 1.25, ..Particle::at_rest(0, self.at(x)) };
        let (o, u) = (self.vector([1.0, 0.0]), self.vector([0.0, 1.0]));
        let part = |i: usize, j: usize| oo * o[i] * o[j] + uu * u[i] * u[j] + ou * (o[i] * u[j] + u[i] * o[j]);
        p.state.stress = Stress { xx: part(0, 0), yy: part(1, 1), zz: 9e9, xy: part(0, 1) };
        p
    }

    /// The barrier with two materials.
    fn scene(self, materials: [Vec<Particle>; 2]) -> Scene {
        let law = AnyLaw::LinearElastic(LinearElastic::new(1e6, 0.2));
        let brick = Brick::new([0.0; 2], [1, 1], CELL);
        let points = (0..COUNTS[0] * COUNTS[1]).map(|id| {
            let [across, along] = [id / COUNTS[1], id % COUNTS[1]].map(|k| (k as f64 + 0.5) * SPACING);
            Particle::at_rest(id as u32, self.at([-across, along - BURIED]))
        });
        let mut scene = scene(&brick, law, 2000.0, points.collect(), vec![]);
        for (points, (point_mass, point_volume, point_spacing)) in materials.into_iter().zip(MATERIALS) {
            scene.bodies.push((Body { point_mass, point_volume, point_spacing, ..brick.body(law, 1.0) }, points));
        }
        scene
    }

    fn gauge(self, sim: &Simulation) -> StructureGauge {
        StructureGauge::new(sim, 0, self.face(), COUNTS, self.angle)
    }

    fn survey(self, materials: [Vec<Particle>; 2]) -> Survey {
        let sim = Simulation::new(self.scene(materials));
        self.gauge(&sim).survey(&sim)
    }
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * b.abs().max(1e-3)
}

#[test]
fn layers_carry_the_normal_stress_at_the_face() {
    // The pressure is 1, 2, 3, 4 kPa from the face on; what pulls along the face does not count.
    for view in VIEWS {
        let layer = |k: usize| move |j: usize| ([k, j].map(|k| (k as f64 + 0.5) * SPACING), k as f64);
        let places = (0..4).flat_map(|k| (0..8).map(layer(k)));
        let grains = |shift: [f64; 2]| -> Vec<Particle> {
            let at = |[d, s]: [f64; 2]| [d + shift[0], s + shift[1]];
            places.clone().map(|(x, k)| view.grain(at(x), [-1e3 * (k + 1.0), 700.0, 400.0])).collect()
        };
        let found = view.survey([grains([0.0; 2]), vec![]]);
        let area = 8.0 * SPACING * THICKNESS * 1.25;
        assert!((0..3).all(|k| near(found.layers[k], [1e3, 1.5e3, 2e3][k] * area)), "{view:?} {found:?}");
        assert!(near(found.run_up, 7.5 * SPACING) && found.behind == 0.0 && found.penetration <= 1e-12, "{found:?}");
        // Half of it below the foot; and a little too far away.
        let found = view.survey([grains([0.0, -4.0 * SPACING]), vec![]]);
        assert!((0..3).all(|k| near(found.layers[k], [1e3, 1.5e3, 2e3][k] * 0.5 * area)), "{view:?} {found:?}");
        let found = view.survey([grains([CELL, 0.0]), vec![]]);
        assert!(found.layers == [0.0; 3] && near(found.run_up, 7.5 * SPACING), "{view:?} {found:?}");
        // The nearest points are sought anew in each cell's height: the first layer is missing in the lower half, where the
        // pressure is five times that of the upper half.
        let low = |s: f64| s < 4.0 * SPACING;
        let grain = |x: [f64; 2]| view.grain(x, [if low(x[1]) { -5e3 } else { -1e3 }, 0.0, 0.0]);
        let some = places.clone().map(|(x, _)| x).filter(|x| !low(x[1]) || x[0] > SPACING);
        let found = view.survey([some.map(grain).collect(), vec![]]);
        assert!(found.layers.iter().all(|f| near(*f, 3e3 * area)), "{view:?} {found:?}");
        // What lies on the crest does not push against the face, nor does what is deep inside.
        let elsewhere = [[-0.1, 0.55], [-0.13, 0.25]].map(|x| view.grain(x, [-1e3, -1e3, 1e3]));
        assert_eq!(view.survey([elsewhere.to_vec(), vec![]]).layers, [0.0; 3]);
        // The second material is finer: two of its layers make one.
        let fine = |k: usize| move |j: usize| [k, j].map(|k| (k as f64 + 0.5) * MATERIALS[1].2);
        let fine = (0..6).flat_map(|k| (0..16).map(fine(k))).map(|x| view.grain(x, [-2e3, 0.0, 0.0])).collect();
        let found = view.survey([vec![], fine]);
        let force = 2e3 * MATERIALS[1].1 * 1.25 / MATERIALS[1].2 * 16.0;
        assert!(found.layers.iter().all(|f| near(*f, force)), "{view:?} {found:?} {force}");
    }
}

#[test]
fn run_up_overtopping_and_penetration_are_told_apart() {
    for view in VIEWS {
        let seen = |light: &[[f64; 2]], heavy: &[[f64; 2]]| {
            view.survey([light, heavy].map(|x| x.iter().map(|x| view.grain(*x, [0.0; 3])).collect()))
        };
        // At the face and no farther than a cell and a half.
        let found = seen(&[[0.149, 0.31], [0.151, 0.42]], &[[0.05, 0.2]]);
        assert!(near(found.run_up, 0.31) && found.behind == 0.0, "{view:?} {found:?}");
        // On the crest: neither before nor behind.
        let found = seen(&[[-0.1, 0.56]], &[]);
        assert!(near(found.run_up, 0.56) && found.behind == 0.0, "{view:?} {found:?}");
        // High above it.
        assert_eq!(seen(&[[-0.1, 1.5]], &[[0.2, 2.0]]), Survey::default());
        // Behind it, near and far.
        let found = seen(&[[-0.33, 0.2], [-0.55, 0.3], [-0.4, 0.1], [0.5, 0.1]], &[[-3.0, 0.2]]);
        assert!(found.run_up == 0.0 && found.behind == 5.0, "{view:?} {found:?}");
        // A point reaches as far as half the distance to its neighbours.
        let found = seen(&[[0.01, 0.2]], &[[-0.02, 0.3]]);
        assert!(near(found.penetration, 0.0325) && near(found.run_up, 0.3), "{view:?} {found:?}");
        let found = seen(&[[0.01, 0.2]], &[[0.02, 0.3]]);
        assert!(near(found.penetration, 0.015), "{view:?} {found:?}");
        assert_eq!(seen(&[[0.1, -0.05]], &[]).penetration, 0.0);
    }
}

#[test]
fn what_has_left_the_domain_behind_it_has_passed() {
    for view in VIEWS {
        let thrown = |x: [f64; 2], v: [f64; 2]| Particle { v: view.vector(v), ..view.grain(x, [0.0; 3]) };
        // Both materials are thrown out of the domain behind the barrier, the lighter one before it, too.
        let light = vec![thrown([-0.5, 0.2], [-10.0, 0.0]), Particle { id: 1, ..thrown([0.5, 0.2], [10.0, 0.0]) }];
        let mut scene = view.scene([light, vec![thrown([-0.5, 0.3], [-10.0, 0.0])]]);
        scene.domain = FOOT.map(|x| [x - 1.2, x + 1.2]);
        let mut sim = Simulation::new(scene);
        let mut gauge = view.gauge(&sim);
        while sim.time() < 0.2 {
            sim.step().expect("a step");
            gauge.after_step(&sim);
        }
        assert!(near(sim.ledger().departed_mass, 4.0), "{view:?} {:?}", sim.ledger());
        let found = gauge.sample(&sim).survey;
        assert!(near(found.behind, 3.0) && gauge.passage(&found).past == 0.0, "{view:?} {found:?}");
        assert_eq!(gauge.behind(&sim), 0.0);
        // Without a step in between there are no forces.
        let sample = gauge.sample(&sim);
        assert_eq!((sample.contact, sample.clamp, sample.inertia), Default::default());
        assert_eq!((sample.clamp_moment, sample.imbalance), (0.0, 0.0));
    }
}

#[test]
fn deflection_is_that_of_the_points_at_the_face() {
    // Columns are numbered from the face on, or from the back.
    for (view, from_back) in VIEWS.into_iter().flat_map(|view| [(view, false), (view, true)]) {
        let column = |id: usize| if from_back { COUNTS[0] - 1 - id / COUNTS[1] } else { id / COUNTS[1] };
        let mut scene = view.scene([vec![], vec![]]);
        for p in &mut scene.bodies[0].1 {
            p.id = (column(p.id as usize) * COUNTS[1] + p.id as usize % COUNTS[1]) as u32;
        }
        let sim = Simulation::new(scene);
        let mut gauge = view.gauge(&sim);
        assert!((gauge.body(), gauge.face().foot().x) == (0, FOOT[0]) && gauge.outline().len() == 2 * (6 + 12) - 4);
        // Bulging most at 0.225 m: w = 0.04 - (s - 0.225)^2 at the face, moving back with s m/s; the back bulges twice as far.
        for (id, place) in gauge.points.iter_mut().enumerate() {
            let s = (id % COUNTS[1]) as f64 * SPACING + 0.5 * SPACING - BURIED;
            let w = (0.04 - (s - 0.225) * (s - 0.225)) * if column(id) == 0 { 1.0 } else { 2.0 };
            let (dx, v) = (view.vector([-w, 0.01]), view.vector([-s, 5.0]));
            let place = place.as_mut().expect("a point");
            (place.x, place.v) = ([place.x[0] + dx[0], place.x[1] + dx[1]], v);
        }
        let profile = gauge.profile();
        assert_eq!(profile.len(), 10, "above the foot");
        for (k, p) in profile.iter().enumerate() {
            let s = (k as f64 + 0.5) * SPACING;
            assert!(
                near(p.height, s) && near(p.velocity, s) && near(p.deflection, 0.04 - (s - 0.225).powi(2)),
                "{p:?}"
            );
        }
        let bend = gauge.bend(&sim);
        assert!(near(bend.tip, 0.04 - 0.0625) && near(bend.tip_velocity, 0.475), "{bend:?}");
        assert!(near(bend.largest, 0.04) && near(bend.largest_at, 0.225), "{bend:?}");
    }
}

#[test]
fn gaps_are_what_stretch_does_not_explain() {
    let view = VIEWS[3];
    let sim = Simulation::new(view.scene([vec![], vec![]]));
    let whole = view.gauge(&sim);
    assert!(whole.bend(&sim).gap < 1e-12);
    let moved = |stretch: f64, shift: &dyn Fn(usize, usize) -> [f64; 2]| {
        let mut gauge = whole.clone();
        for (id, place) in gauge.points.iter_mut().enumerate() {
            let place = place.as_mut().expect("a point");
            let dx = view.vector(shift(id / COUNTS[1], id % COUNTS[1]));
            (place.x, place.stretch) = ([place.x[0] + dx[0], place.x[1] + dx[1]], stretch);
        }
        gauge.bend(&sim)
    };
    // Torn along its length: two columns from the other two, by a quarter of a cell at one height.
    let bend = moved(1.0, &|column, row| if column >= 2 && row == 7 { [-0.025, 0.0] } else { [0.0; 2] });
    assert!(near(bend.gap, 0.25) && near(bend.gap_at, 0.275), "{bend:?}");
    // Torn across: the top by a fifth of a cell.
    let bend = moved(1.0, &|_, row| if row >= 9 { [0.0, 0.02] } else { [0.0; 2] });
    assert!(near(bend.gap, 0.2) && near(bend.gap_at, 0.325), "{bend:?}");
    // The last point of a column is no neighbour of the first of the next.
    let bend = moved(1.0, &|_, row| [0.0, 0.005 * row as f64]);
    assert!(near(bend.gap, 0.05), "{bend:?}");
    // All of that lengthening is stretch of the material; half of it.
    assert!(moved(1.1, &|_, row| [0.0, 0.005 * row as f64]).gap < 1e-12);
    assert!(near(moved(1.05, &|_, row| [0.0, 0.005 * row as f64]).gap, 0.025));
}

#[test]
fn the_stretch_of_a_point_is_the_largest_of_its_deformation() {
    // F = R diag(a, b): b = F F^T has the eigenvalues a^2 and b^2.
    for (a, b) in [(1.3, 0.8), (0.7, 1.2), (0.9, 0.6), (1.1, 1.1)] {
        for angle in [0.0, 0.4, 2.0, -1.1] {
            let (c, s) = (libm::cos(angle), libm::sin(angle));
            let finger = Finger {
                xx: a * a * c * c + b * b * s * s - 1.0,
                yy: a * a * s * s + b * b * c * c - 1.0,
                xy: (a * a - b * b) * c * s,
            };
            let mut scene = VIEWS[0].scene([vec![], vec![]]);
            scene.bodies[0].0.law = AnyLaw::NeoHookean(crate::constitutive::NeoHookean::new(1e6, 0.2));
            scene.bodies[0].1.iter_mut().for_each(|p| finger.keep_in(&mut p.state.history));
            let sim = Simulation::new(scene);
            let gauge = VIEWS[0].gauge(&sim);
            assert!(gauge.points.iter().flatten().all(|p| near(p.stretch, f64::max(a, b))), "{a} {b} {angle}");
        }
    }
}

#[test]
fn a_clamp_that_holds_all_takes_momentum_and_weight_about_the_foot() {
    // All nodes are clamped: in the first step the clamp stops the body and carries its weight.
    for view in VIEWS {
        for weightless in [false, true] {
            let mut scene = view.scene([vec![], vec![]]);
            let v = view.vector([-0.3, 0.2]);
            scene.bodies.truncate(1);
            scene.bodies[0].1.iter_mut().for_each(|p| p.v = v);
            scene.bodies[0].0.weightless = weightless;
            let clamp = Boundary::plane("clamp", Vector2::new(3.0, 7.0), Vector2::new(0.6, 0.8), Friction::Bonded);
            (scene.boundaries, scene.gravity) = (vec![clamp], [2.0, -9.81]);
            let mut sim = Simulation::new(scene);
            let mut gauge = view.gauge(&sim);
            let count = (COUNTS[0] * COUNTS[1]) as f64;
            let mass = count * sim.bodies()[0].point_mass;
            for step in 0..2 {
                sim.step().expect("a step");
                gauge.after_step(&sim);
                let sample = gauge.sample(&sim);
                let dt = sim.time_step().dt;
                let stopped = if step == 0 { v.map(|v| mass * v / dt) } else { [0.0; 2] };
                let weight = sim.gravity().map(|g| if weightless { 0.0 } else { mass * g });
                let force = [stopped[0] + weight[0], stopped[1] + weight[1]];
                let (out, up) = (view.vector([1.0, 0.0]), view.vector([0.0, 1.0]));
                let along = |f: [f64; 2], n: [f64; 2]| f[0] * n[0] + f[1] * n[1];
                let expected = Components { normal: -along(force, out), tangential: along(force, up) };
                let close = |a: f64, b: f64| (a - b).abs() < 1e-9 * mass / dt;
                let same =
                    |a: Components, b: Components| close(a.normal, b.normal) && close(a.tangential, b.tangential);
                assert!(same(sample.clamp, expected), "{view:?}: {sample:?} {expected:?}");
                let inertia = Components { normal: along(stopped, out), tangential: -along(stopped, up) };
                assert!(same(sample.inertia, inertia), "{view:?}: {sample:?} {inertia:?}");
                assert_eq!(sample.contact, Components::default());
                assert!(sample.imbalance < 1e-12, "{sample:?}");
                // Its middle lies three points behind the face and six above its lower end.
                let moment = expected.normal * (6.0 * SPACING - BURIED) + expected.tangential * (-3.0 * SPACING);
                assert!(close(sample.clamp_moment, moment), "{view:?}: {} {moment}", sample.clamp_moment);
                if step == 0 {
                    let peak = gauge.peak_clamp_force();
                    assert!(close(peak.value, force[0].hypot(force[1])) && peak.time == sim.time());
                }
            }
        }
    }
}

#[test]
fn a_gauge_on_a_body_reads_what_the_contacts_give_to_it() {
    // The material strikes with and across the face, and is named first or second in the rule.
    for view in VIEWS {
        for structure in [0, 1] {
            let block = (0..4).flat_map(|k| (0..6).map(move |j| [k, j].map(|k| (k as f64 + 0.5) * SPACING)));
            let block: Vec<Particle> =
                block.map(|x| Particle { v: view.vector([-2.0, 0.7]), ..Particle::at_rest(0, view.at(x)) }).collect();
            let mut scene = view.scene([block, vec![]]);
            scene.bodies.truncate(2);
            let mut rule = ContactRule::with_structure(0, 1, 0.3);
            if structure == 1 {
                scene.bodies.swap(0, 1);
                rule.bodies = [0, 1];
                rule.normal = crate::contact::rule::NormalRule::NearestFace(1);
            }
            scene.contacts = vec![rule];
            let mut sim = Simulation::new(scene);
            let mut gauge = BarrierGauge::on_body(&sim, structure, view.face());
            let mut other = StructureGauge::new(&sim, structure, view.face(), COUNTS, view.angle);
            assert_eq!(other.body(), structure);
            assert!(gauge.boundary().is_none() && gauge.face(&sim).foot().x == FOOT[0]);
            let before = sim.stock_of(|b| b != structure).momentum;
            let (mut profile, mut moment, mut time) = ([0.0; 6], 0.0, 0.0);
            let (out, up) = (view.vector([1.0, 0.0]), view.vector([0.0, 1.0]));
            for _ in 0..12 {
                sim.step().expect("a step");
                gauge.after_step(&sim);
                other.after_step(&sim);
                time += sim.time_step().dt;
                let mut force = 0.0;
                for at in sim.contact_points() {
                    let onto = at.impulse.map(|p| if structure == 1 { p } else { -p });
                    let from_foot = [at.x[0] - FOOT[0], at.x[1] - FOOT[1]];
                    let [d, s] = [out, up].map(|n| from_foot[0] * n[0] + from_foot[1] * n[1]);
                    let [p, q] = [out, up].map(|n| onto[0] * n[0] + onto[1] * n[1]);
                    moment += s * -p + d * q;
                    force -= p / sim.time_step().dt;
                    // Linear between two bins, so that the moment is kept.
                    let height = (s / CELL).clamp(0.0, (profile.len() - 1) as f64);
                    for (bin, sum) in profile.iter_mut().enumerate() {
                        *sum -= p * (1.0 - (height - bin as f64).abs()).max(0.0);
                    }
                }
                assert!(near(gauge.step_force(&sim), force), "{view:?}");
            }
            let sample = gauge.sample();
            let after = sim.stock_of(|b| b != structure).momentum;
            let lost = [before[0] - after[0], before[1] - after[1]];
            let expected = [out, up].map(|n| (lost[0] * n[0] + lost[1] * n[1]) / time);
            assert!(sample.normal > 0.0 && sample.tangential > 0.0, "{sample:?}");
            assert!(near(sample.normal, -expected[0]) && near(sample.tangential, expected[1]), "{view:?}: {sample:?}");
            let contact = other.sample(&sim).contact;
            assert!(near(contact.normal, sample.normal) && near(contact.tangential, sample.tangential), "{contact:?}");
            assert!(near(sample.moment * time, moment) && moment != 0.0, "{view:?}: {sample:?} {moment}");
            let rows = gauge.profile(THICKNESS);
            assert_eq!(rows.len(), 6);
            for (k, ((height, pressure), impulse)) in rows.into_iter().zip(profile).enumerate() {
                let width = if k == 0 || k == 5 { 0.5 * CELL } else { CELL };
                assert!(
                    near(height, k as f64 * CELL) && near(pressure * width * THICKNESS * time, impulse),
                    "{view:?} {k}"
                );
            }
            assert!(profile.iter().filter(|p| **p > 0.0).count() > 2);
        }
    }
}
