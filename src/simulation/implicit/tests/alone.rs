//! One body in implicit steps, stage by stage, against the equations written out anew.

use super::reference::{H, POISSON, Reference, YOUNG, apart, wall};
use crate::body::Particle;
use crate::boundary::nodes::Tally;
use crate::constitutive::{AnyLaw, Cone, DruckerPrager, Increment, Law, LinearElastic, NeoHookean, VonMises};
use crate::ledger::Drag;
use crate::momentum::BodyForces;
use crate::scaffold::{Brick, Lcg, scene};
use crate::shape::ShapeFunction;
use crate::simulation::Simulation;
use crate::simulation::field::VelocityField;
use crate::simulation::implicit::{ImplicitBody, Point, THETA};

const SHAPES: [ShapeFunction; 3] = [ShapeFunction::Linear, ShapeFunction::Ugimp, ShapeFunction::Bspline];
/// Round-off of sums and of a linear solve, as a share of the largest value.
const ROUND: f64 = 1e-10;

fn elastic() -> LinearElastic {
    LinearElastic::new(YOUNG, POISSON)
}

#[test]
fn mass_velocity_force_and_stiffness_are_sums_over_points() {
    let plastic = DruckerPrager::new(elastic(), Cone::PlaneStrain, 0.5, 0.0, 0.0, 0.0, false);
    let laws = [
        AnyLaw::LinearElastic(elastic()),
        AnyLaw::DruckerPrager(plastic),
        AnyLaw::NeoHookean(NeoHookean::new(YOUNG, POISSON)),
    ];
    for (shape, law) in SHAPES.into_iter().zip(laws) {
        let sim = wall(shape, law);
        let body = sim.implicit_body();
        let reference = Reference::new(&sim, body);
        let n = 2 * reference.x.len();
        assert!(apart(&body.mass, &reference.mass()) < ROUND);
        assert!((body.mass.iter().sum::<f64>() - sim.mass()).abs() < ROUND * sim.mass(), "every node has a number");
        let mut velocity = reference.velocity();
        assert!(apart(&body.start, &velocity) < ROUND, "{shape:?}");
        (0..n).filter(|i| body.clamped[i / 2]).for_each(|i| velocity[i] = 0.0);
        assert!(apart(&body.velocity, &velocity) < ROUND, "{shape:?}");
        assert!(apart(&body.force, &reference.internal_force(&vec![0.0; n])) < ROUND, "{shape:?}");
        let mut random = Lcg::new(7);
        let u: Vec<f64> = (0..n).map(|_| random.signed()).collect();
        let mut force = vec![0.0; n];
        body.blocks.multiply(&u, &mut force);
        assert!(apart(&force, &reference.stiffness_times(&u)) < ROUND, "{shape:?}");
        let clamp = &sim.boundaries()[0];
        let held: Vec<bool> = reference.x.iter().map(|x| clamp.depth(*x) > -0.5 * H).collect();
        assert!(body.clamped == held && held.contains(&true) && held.contains(&false));
    }
}

#[test]
fn nodes_are_numbered_along_the_body() {
    // Far from the origin, along both axes and both diagonals. A body of two cells has at most five nodes across; a stencil is
    // three nodes long, so the first and the last of its nodes are at most 3 x 5 numbers apart, less one.
    for corner in [[3.0, 5.0], [-4.0, 6.0], [5.0, -7.0], [-3.0, -8.0]] {
        for angle in [0.0, 0.25, 0.5, 0.75].map(|turns: f64| turns * std::f64::consts::PI) {
            let brick = Brick { angle, ..Brick::new(corner, [30, 2], H) };
            let mut scene = scene(&brick, AnyLaw::LinearElastic(elastic()), 1.0, brick.points(), vec![]);
            scene.bodies[0].0.implicit = true;
            let sim = Simulation::new(scene);
            let body = sim.implicit_body();
            let spread = |p: &Point| p.nodes.iter().max().unwrap() - p.nodes.iter().min().unwrap();
            let widest = body.points.iter().map(spread).max().unwrap();
            assert!(widest <= 14, "{corner:?} {angle}: {widest} of {}", body.mass.len());
        }
    }
}

/// A body with its field, taken out of the simulation to be led by hand.
struct Alone {
    body: ImplicitBody,
    field: VelocityField,
    reference: Reference,
    sim: Simulation,
    /// No step has ended yet since the sort.
    first: bool,
    /// Time since then, s.
    since: f64,
}

impl Alone {
    /// The first of every three nodes of a band is shared with a field that is not there.
    fn new(shared: bool) -> Self {
        // Its points flow, in a time that matters; its nodes are moved as if it were elastic.
        let law = VonMises { elastic: elastic(), strength: 200.0, hardening: 1e5, viscosity: 2e3 };
        let sim = wall(ShapeFunction::Ugimp, AnyLaw::VonMises(law));
        let (mut body, mut field) = (sim.implicit_body().clone(), sim.fields[0].clone());
        let reference = Reference::new(&sim, &body);
        field.bands.iter_mut().for_each(crate::band::Band::make_room);
        if shared {
            for band in &mut field.bands {
                band.shared = (0..band.owned as u32).step_by(3).collect();
                band.open = vec![Default::default(); band.shared.len()];
            }
        }
        body.follow(&field);
        Self { body, field, reference, sim, first: true, since: 0.0 }
    }

    /// Ends a step that began with these velocities and displacements, and checks everything that it leaves behind. `impulses`
    /// are those of contact at the nodes.
    fn finish(&mut self, old: [Vec<f64>; 2], impulses: &[f64], forces: BodyForces, dt: f64) {
        self.since += dt;
        let Self { body, field, reference, sim, since, .. } = self;
        let [velocity, displacement] = old;
        let before = Books::of(body, field);
        body.finish(field, sim.boundaries(), forces, dt);
        let after = Books::of(body, field);

        // The equation of motion; what is missing at a clamped node comes from the clamp.
        let n = velocity.len();
        let start = reference.velocity();
        let [f0, f1] = [&displacement, &body.displacement].map(|d| reference.internal_force(d));
        let mut drag = Drag::default();
        let mut missing = vec![0.0; n];
        let (mut work_of_gravity, mut work_of_contact, mut work_of_clamps) = (0.0, 0.0, 0.0);
        for i in 0..n {
            let (m, w0, w1) = (body.mass[i / 2], velocity[i], body.velocity[i]);
            let damped = -dt * forces.damping * m * w0;
            let weight = dt * m * forces.gravity[i % 2];
            let force = THETA * f1[i] + (1.0 - THETA) * f0[i];
            let caught = if self.first && body.clamped[i / 2] { m * start[i] } else { 0.0 };
            missing[i] = m * (w1 - w0) - caught - weight + dt * force - damped - impulses[i];
            let mean = 0.5 * (w0 + w1);
            drag.impulse[i % 2] += damped;
            drag.work += damped * mean;
            work_of_gravity += weight * mean;
            work_of_contact += impulses[i] * mean;
            work_of_clamps += missing[i] * mean;
        }
        let scale = missing.iter().fold(0.0f64, |s, p| s.max(p.abs()));
        let (mut impulse, mut moment) = ([0.0; 2], 0.0);
        let foot = sim.boundaries()[0].foot();
        for (k, x) in reference.x.iter().enumerate() {
            let p = [missing[2 * k], missing[2 * k + 1]];
            if body.clamped[k] {
                for i in [2 * k, 2 * k + 1] {
                    assert_eq!((velocity[i], body.velocity[i], body.displacement[i]), (0.0, 0.0, 0.0));
                }
                (0..2).for_each(|d| impulse[d] += p[d]);
                moment += (x[0] - foot.x) * p[1] - (x[1] - foot.y) * p[0];
            } else {
                assert!(p[0].hypot(p[1]) < 1e-9 * scale, "{k}: {p:?} of {scale}");
            }
        }
        let mut tally = Tally::default();
        field.bands.iter().for_each(|b| tally.add(&b.tallies[0]));
        assert!(apart(&tally.impulse, &impulse) < 1e-9 && (tally.moment / moment - 1.0).abs() < 1e-9, "{tally:?}");
        assert_eq!((tally.friction_work, tally.normal_work), (0.0, 0.0));
        let mut booked = Drag::default();
        field.bands.iter().for_each(|b| booked.merge(&b.distributed.damping));
        let off = [booked.impulse[0] - drag.impulse[0], booked.impulse[1] - drag.impulse[1], booked.work - drag.work];
        assert!(
            off.iter().all(|x| x.abs() <= 1e-12 * (drag.impulse[0].abs() + drag.work.abs())),
            "{booked:?} {drag:?}"
        );

        // Displacements and points.
        let travelled: Vec<f64> =
            velocity.iter().zip(&body.velocity).map(|(old, new)| dt * (THETA * new + (1.0 - THETA) * old)).collect();
        let moved: Vec<f64> = displacement.iter().zip(&travelled).map(|(d, v)| d + v).collect();
        assert!(apart(&body.displacement, &moved) < ROUND);
        assert_eq!(field.drift, 2.0 * moved.iter().fold(0.0f64, |a, d| a.max(d.abs())));
        let gained: Vec<f64> = body.velocity.iter().zip(&start).map(|(v, s)| v - s).collect();
        let points: Vec<Particle> = field.bands.iter().flat_map(|b| b.points[0].iter()).collect();
        for (k, (p, base)) in points.iter().zip(&reference.points).enumerate() {
            let (d, v) = (reference.at(k, &moved), reference.at(k, &gained));
            assert!(
                (0..2).all(|e| (p.x[e] - base.x[e] - d[e]).abs() < 1e-12 && (p.v[e] - base.v[e] - v[e]).abs() < 1e-9)
            );
            let increment = Increment { dt: *since, ..reference.increment(k, &moved) };
            let (law, mut state) = (reference.body.law, base.state);
            law.update(&mut state, &increment);
            let (s, t) = (p.state.stress, state.stress);
            let off = (s.xx - t.xx).abs() + (s.yy - t.yy).abs() + (s.zz - t.zz).abs() + (s.xy - t.xy).abs();
            let ratio = law.volume_ratio(&state, base.volume_ratio, &increment);
            assert!(p.id == base.id && off < 1e-6 && (p.volume_ratio - ratio).abs() < 1e-12, "{off} Pa");
        }

        // Energy: the sums of the bands against each other, and against the work of all impulses.
        let stored: f64 = (0..n).map(|i| travelled[i] * 0.5 * (f0[i] + f1[i])).sum();
        assert!((after.work / stored - 1.0).abs() < 1e-9, "{} {stored}", after.work);
        let given = work_of_gravity + work_of_contact + work_of_clamps + drag.work;
        let kept = after.kinetic - before.kinetic + after.work + after.pic_loss;
        let scale = before.kinetic + after.work.abs() + given.abs();
        assert!((kept - given).abs() < 1e-9 * scale, "{kept} {given}");
        assert!(after.pic_loss.abs() > 1e-6 * scale);
        let largest = |of: &dyn Fn(&Particle) -> f64| points.iter().map(of).fold(0.0f64, f64::max);
        assert_eq!(after.max_speed, largest(&|p| p.v[0].abs().max(p.v[1].abs())));
        let mut next = points.iter();
        for band in &field.bands {
            let own = next.by_ref().take(band.len());
            assert_eq!(band.sums.min_volume_ratio, own.map(|p| p.volume_ratio).fold(f64::INFINITY, f64::min));
        }
        self.first = false;
    }
}

/// What the bands hold and have counted.
struct Books {
    kinetic: f64,
    work: f64,
    pic_loss: f64,
    max_speed: f64,
}

impl Books {
    fn of(body: &ImplicitBody, field: &VelocityField) -> Self {
        let sum = |of: fn(&crate::band::BandSums) -> f64| field.bands.iter().map(|b| of(&b.sums)).sum::<f64>();
        let points = field.bands.iter().flat_map(|b| b.points[0].iter());
        let kinetic: f64 = points.map(|p| 0.5 * field.bodies[0].point_mass * p.speed() * p.speed()).sum();
        if body.dt > 0.0 && sum(|s| s.kinetic) != 0.0 {
            assert!((sum(|s| s.kinetic) / kinetic - 1.0).abs() < 1e-12);
        }
        let max_speed = field.bands.iter().map(|b| b.sums.max_speed).fold(0.0, f64::max);
        Self { kinetic, work: sum(|s| s.internal_work), pic_loss: sum(|s| s.pic_loss), max_speed }
    }
}

#[test]
fn a_step_obeys_the_equation_of_motion_and_books_what_it_does() {
    let mut alone = Alone::new(false);
    let n = alone.body.velocity.len();
    for (dt, gravity, damping) in [(3e-3, [0.4, -9.81], 0.0), (3e-3, [0.4, -9.81], 30.0), (5e-3, [-2.0, 3.0], 7.0)] {
        let forces = BodyForces { gravity, damping };
        let old = [alone.body.velocity.clone(), alone.body.displacement.clone()];
        alone.body.predict(&mut alone.field, forces, dt);
        alone.finish(old, &vec![0.0; n], forces, dt);
    }
}

#[test]
fn impulses_of_contact_move_all_nodes_at_once() {
    let mut alone = Alone::new(true);
    let forces = BodyForces { gravity: [0.4, -9.81], damping: 5.0 };
    let n = alone.body.velocity.len();
    let mut random = Lcg::new(11);
    for (step, dt) in [3e-3, 3e-3, 2e-3].into_iter().enumerate() {
        let old = [alone.body.velocity.clone(), alone.body.displacement.clone()];
        let Alone { body, field, reference, .. } = &mut alone;
        if step == 1 {
            // Other fields have moved: other nodes are shared, some of them still.
            for band in &mut field.bands {
                band.shared = (0..band.owned as u32).step_by(2).collect();
                band.open = vec![Default::default(); band.shared.len()];
            }
            body.follow(field);
        }
        body.predict(field, forces, dt);
        let shared = body.shared.clone();
        let fullest = body.mass.iter().fold(0.0f64, |a, m| a.max(*m));
        let next_to_none = shared.iter().filter(|s| s.node < n / 2 && body.mass[s.node] < 1e-3 * fullest).count();
        assert!(next_to_none > 0, "contact leaves nothing out");
        for (k, s) in shared.iter().enumerate() {
            assert_eq!(body.slot(s.band, s.index), k);
            let open = field.bands[s.band].open[s.index];
            if s.node < n / 2 && body.mass[s.node] >= 1e-3 * fullest {
                let two = |values: &[f64]| [values[2 * s.node], values[2 * s.node + 1]];
                assert_eq!((open.mass, open.old, open.free), (body.mass[s.node], two(&old[0]), two(&body.free)));
            } else {
                assert_eq!(open, Default::default());
            }
        }
        // Others in every step, clamped ones among them.
        let touched: Vec<usize> =
            (0..shared.len()).filter(|k| shared[*k].node < n / 2 && (k + step) % 4 == 0).collect();
        assert!(touched.iter().any(|&k| body.clamped[shared[k].node]));
        touched.iter().for_each(|&k| body.touch(k));
        body.weigh();
        assert_eq!(body.touched, touched);
        assert!(body.shared.iter().all(|s| s.touched || s.impulse == [0.0; 2]));
        // How all nodes answer a unit impulse: M r + (theta dt)^2 K r = e, and nothing where they are clamped.
        for s in touched.iter().map(|&k| &shared[k]).filter(|s| !body.clamped[s.node]) {
            for (d, response) in body.responses[s.node].iter().enumerate() {
                let force = reference.stiffness_times(response);
                for i in 0..n {
                    let unit = if i == 2 * s.node + d { 1.0 } else { 0.0 };
                    let push = body.mass[i / 2] * response[i] + (THETA * dt).powi(2) * force[i];
                    let expected = if body.clamped[i / 2] { push } else { unit };
                    assert!((push - expected).abs() < 1e-9, "{i} {push}");
                    assert!(!body.clamped[i / 2] || response[i] == 0.0);
                }
            }
        }
        for sweep in 0..3 {
            let (mut change, mut largest) = (0.0f64, 0.0f64);
            for &k in &touched {
                // Velocity under the latest impulses at all nodes, and what the node is told.
                let mut velocity = body.free.clone();
                for s in &body.shared {
                    for (d, p) in s.impulse.into_iter().enumerate() {
                        velocity.iter_mut().zip(body.response(s.node, d)).for_each(|(v, r)| *v += r * p);
                    }
                }
                body.offer(k, field);
                let s = body.shared[k].clone();
                let open = field.bands[s.band].open[s.index];
                let told = if body.clamped[s.node] {
                    assert_eq!(s.mobility, 0.0);
                    open.free
                } else {
                    // Frobenius's norm of how the node answers impulses on itself.
                    let own = body.responses[s.node].iter().flat_map(|r| &r[2 * s.node..2 * s.node + 2]);
                    let mobility = own.map(|x| x * x).sum::<f64>().sqrt();
                    assert!((s.mobility / mobility - 1.0).abs() < 1e-12 && open.mass == 1.0 / s.mobility);
                    [0, 1].map(|d| open.free[d] + s.mobility * s.impulse[d])
                };
                let expected = [velocity[2 * s.node], velocity[2 * s.node + 1]];
                assert!(told == expected || apart(&told, &expected) < 1e-9, "{told:?} {expected:?}");
                let found = [0.2 * random.signed(), 0.2 * random.signed()];
                body.take(k, found);
                assert!(body.shared[k].impulse == found);
                for (new, old) in found.iter().zip(s.impulse) {
                    change = change.max(s.mobility * (new - old).abs());
                    largest = largest.max(s.mobility * new.abs());
                }
            }
            let settled = body.settle();
            assert!(apart(&settled, &[change, largest]) < 1e-12, "{sweep}: {settled:?} {change} {largest}");
        }
        let impulses = impulses(body, n);
        alone.finish(old, &impulses, forces, dt);
        let Alone { body, field, .. } = &alone;
        for s in body.shared.iter().filter(|s| s.node < n / 2) {
            let band = &field.bands[s.band];
            let shown = band.work.strain_velocity[band.shared[s.index] as usize];
            assert_eq!(shown, [body.velocity[2 * s.node], body.velocity[2 * s.node + 1]]);
        }
    }
}

/// Contact impulses by node.
fn impulses(body: &ImplicitBody, n: usize) -> Vec<f64> {
    let mut sums = vec![0.0; n];
    for s in body.shared.iter().filter(|s| s.node < n / 2) {
        (0..2).for_each(|d| sums[2 * s.node + d] += s.impulse[d]);
    }
    sums
}
