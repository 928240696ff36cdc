//! Boundaries between the nodes of the grid: what must not matter does not, and the books balance.

use super::*;
use crate::boundary::{Boundary, BoundaryContact, Friction, Opening};
use crate::constitutive::{AnyLaw, Cone, DruckerPrager, LinearElastic};
use crate::contact::rule::ContactRule;
use crate::scaffold::{Lcg, centre, points_by_number, run_until};
use nalgebra::Vector2;

/// A block of 4 by 3 cells on a plane at `angle` (rad) to the grid, its corner on the plane at `corner` (m), with gravity towards
/// the plane and `along` (m/s2) down it.
fn on_plane(angle: f64, corner: [f64; 2], friction: Friction, along: f64) -> Scene {
    let brick = Brick { angle, ..Brick::new(corner, [4, 3], H) };
    let normal = Vector2::new(-libm::sin(angle), libm::cos(angle));
    let tangent = Vector2::new(normal.y, -normal.x);
    let plane = Boundary::plane("base", corner.into(), normal, friction);
    let mut scene = scene(&brick, law(), DENSITY, brick.points(), vec![plane]);
    scene.numerics.max_time_step = DT;
    scene.gravity = (tangent * along - normal * 10.0).into();
    scene
}

#[test]
fn a_block_rests_where_its_plane_is() {
    for angle in [0.0, 0.4, 1.2, 2.6, -1.9] {
        for offset in 0..8 {
            let corner = [0.013 * f64::from(offset), 0.125 * H * f64::from(offset)];
            let mut sim = Simulation::new(on_plane(angle, corner, Friction::Rough, 3.0));
            sim.set_damping(40.0);
            run_until(&mut sim, 0.6).expect("steps");
            let normal = Vector2::new(-libm::sin(angle), libm::cos(angle));
            let weight = sim.mass() * 10.0;
            let force = Vector2::from(sim.step_tallies()[0].impulse).dot(&normal) / sim.time_step().dt;
            // What still swings is far below; a plane at the nodes behind it lets the block fall by up to a cell and bounce.
            assert!((force / weight - 1.0).abs() < 0.01, "{angle} {offset}: {force} of {weight}");
            let depth = sim.particles().map(|(_, p)| sim.boundaries()[0].depth(p.x)).fold(f64::NEG_INFINITY, f64::max);
            assert!((-depth / H - 0.25).abs() < 0.05, "{angle} {offset}: lowest points lie {} cells above", -depth / H);
            books_balance(&sim);
        }
    }
}

/// The scene of the tests below: it slides, is off the nodes, and meets a plate in its way.
fn slide() -> Scene {
    let mut scene = on_plane(0.3, [0.03, 0.04], Friction::Coulomb(0.2), 4.0);
    let (foot, up) = (Vector2::new(0.62, 0.04 + 0.59 * libm::tan(0.3)), Vector2::new(-libm::sin(0.3), libm::cos(0.3)));
    scene.boundaries.push(Boundary::wall("plate", foot, up, 5.0 * H, 0.0, Friction::Coulomb(0.1)));
    scene
}

#[test]
fn a_mirrored_or_turned_scene_gives_a_mirrored_or_turned_result() {
    let expected = points_by_number(&run(slide(), 400));
    assert!(expected.iter().any(|p| p.v[0].abs() > 0.1), "it moves");
    type Map = fn([f64; 2]) -> [f64; 2];
    let maps: [(Map, bool); 3] = [(|[x, y]| [-x, y], true), (|[x, y]| [-y, x], false), (|[x, y]| [-x, -y], false)];
    for (k, (map, mirrors)) in maps.into_iter().enumerate() {
        let mut scene = slide();
        scene.gravity = map(scene.gravity);
        scene.bodies[0].1.iter_mut().for_each(|p| (p.x, p.v) = (map(p.x), map(p.v)));
        scene.boundaries = vec![
            Boundary::plane(
                "base",
                map(scene.boundaries[0].foot().into()).into(),
                map(scene.boundaries[0].normal.into()).into(),
                Friction::Coulomb(0.2),
            ),
            {
                let b = &scene.boundaries[1];
                let wall = Boundary::wall(
                    "plate",
                    map(b.foot().into()).into(),
                    map(b.tangent.into()).into(),
                    b.height(),
                    0.0,
                    b.friction,
                );
                if mirrors { wall.facing_right() } else { wall }
            },
        ];
        for (p, e) in points_by_number(&run(scene, 400)).iter().zip(&expected) {
            let (x, v) = (map(e.x), map(e.v));
            for d in 0..2 {
                assert!((p.x[d] - x[d]).abs() < 1e-9 && (p.v[d] - v[d]).abs() < 1e-7, "{k}: {p:?} {x:?} {v:?}");
            }
        }
    }
}

#[test]
fn a_plate_stops_what_comes_from_either_side() {
    for thickness in [0.0, 0.1 * H, 1.1 * H] {
        for place in 0..5 {
            for from_right in [false, true] {
                let x = 4.0 * H + 0.2 * H * f64::from(place);
                let mut boundary = Boundary::wall(
                    "plate",
                    Vector2::new(x, -H),
                    Vector2::new(0.0, 1.0),
                    6.0 * H,
                    thickness,
                    Friction::Smooth,
                );
                if from_right {
                    // The block hits its back.
                    boundary = Boundary::wall(
                        "plate",
                        Vector2::new(x + thickness, -H),
                        Vector2::new(0.0, 1.0),
                        6.0 * H,
                        thickness,
                        Friction::Smooth,
                    )
                    .facing_right();
                }
                let mut sim = run(block([0.5, 0.0], vec![boundary]), 500);
                let front = sim.particles().map(|(_, p)| p.x[0]).fold(0.0, f64::max);
                assert!(front < x, "{thickness} {place} {from_right}: {front} of {x}");
                let mass = sim.mass();
                let given = sim.ledger().boundaries[0].impulse[0];
                assert!(given < -0.8 * mass * 0.5 && given > -1.05 * mass, "{thickness} {place}: {given}");
                // An elastic block comes back, and does not stick to what it has left.
                assert!(centre(&sim).1[0] < -0.35, "{thickness} {place} {from_right}: {:?}", centre(&sim));
                books_balance(&sim);
                let left = sim.ledger().boundaries[0].impulse;
                sim = stepped(sim, 200);
                assert!(sim.ledger().boundaries[0].impulse == left, "{thickness} {place}: nothing pulls");
            }
        }
    }
}

#[test]
fn bodies_in_contact_on_a_plane_between_nodes_close_the_ledger_as_one_body_does() {
    let residual = |offset: f64, halves: bool| {
        let mut scene = on_plane(0.0, [0.0, offset * H], Friction::Coulomb(0.1), 4.0);
        if halves {
            let (body, points) = scene.bodies.pop().expect("a body");
            let (left, right): (Vec<_>, Vec<_>) = points.into_iter().partition(|p| p.x[0] < 2.0 * H);
            scene.bodies = vec![(body.clone(), left), (body, right)];
            scene.contacts = vec![ContactRule::with_structure(0, 1, 0.2)];
        }
        let sim = run(scene, 300);
        assert!(sim.stock().momentum[0].abs() > 1.0 && (offset == 0.0) == sim.sites().is_empty());
        assert!(sim.ledger().contacts.iter().all(|c| c.exchange.impulse != [0.0; 2]), "the halves touch");
        books_balance(&sim)
    };
    // What slides turns over so much, J.
    let scale = 12.0 * 10.0 * H;
    for offset in [0.0, 0.3, 0.5, 0.8] {
        let [one, two] = [false, true].map(|halves| residual(offset, halves));
        assert!((one - two).abs() < 1e-3 * scale, "{offset}: {one} {two} of {scale}");
        assert!(one.abs() < 0.02 * scale, "{offset}: {one} of {scale}");
    }
}

#[test]
fn at_nodes_the_surface_changes_only_what_strains_the_material() {
    // A plane through nodes has no crossings between them.
    let sim = run(on_plane(0.0, [0.0, 2.0 * H], Friction::Coulomb(0.3), 2.0), 5);
    assert!(sim.sites().is_empty() && sim.holds().count() > 0);
    let sim = run(on_plane(0.0, [0.0, 2.5 * H], Friction::Coulomb(0.3), 2.0), 5);
    assert!(!sim.sites().is_empty());
    let mut at_nodes = on_plane(0.0, [0.0, 2.5 * H], Friction::Coulomb(0.3), 2.0);
    at_nodes.numerics.boundary_contact = BoundaryContact::Nodes;
    assert!(run(at_nodes, 5).sites().is_empty());
}

/// Share of the line of nodes at the edge of a gate that lets material pass, by how far the gate is open (cells).
#[test]
fn an_opening_lets_pass_what_it_frees() {
    // A flow of uniform speed, wide as the grid: what passes in a step is speed times what is open.
    let passes = |open: f64| {
        let gate =
            Boundary::wall("gate", Vector2::new(2.03 * H, 0.0), Vector2::new(0.0, 1.0), 9.0 * H, 0.0, Friction::Smooth)
                .gate(Opening::Lift { speed: f64::INFINITY, opening: open * H });
        let base = Boundary::plane("base", Vector2::zeros(), Vector2::new(0.0, 1.0), Friction::Smooth);
        let brick = Brick::new([0.0; 2], [4, 8], H);
        let mut points = brick.points();
        points.iter_mut().for_each(|p| p.v = [0.1, 0.0]);
        let mut sim = Simulation::new(scene(&brick, law(), DENSITY, points, vec![base, gate]));
        sim.release_gates();
        let before = sim.stock().momentum[0];
        sim.step().expect("a step");
        // Nodes hold a cell of the flow each, half a cell at the base: what keeps its speed is what is open.
        let line = DENSITY * H * H * crate::scaffold::THICKNESS * 0.1;
        let stopped = (before - sim.stock().momentum[0]) / line;
        (stopped, open)
    };
    let all = passes(0.0).0;
    let mut last = all;
    for k in 1..=16 {
        let (stopped, open) = passes(0.25 * f64::from(k));
        assert!(stopped <= last + 1e-12, "{open}: {stopped} after {last}");
        // Between one line and the last, each cell opened frees a cell of the flow.
        if open >= 1.0 {
            assert!(
                ((all - stopped) - open * (passes(2.0).0 - passes(3.0).0)).abs() < 0.02,
                "{open}: {stopped} of {all}"
            );
        }
        last = stopped;
    }
}

#[test]
fn nothing_gets_through_a_plate_that_leans() {
    // Loose sand flies against plates at angles to the grid, and piles up before them.
    for (k, lean) in [-0.5f64, -0.17, 0.0, 0.17, 0.5].into_iter().enumerate() {
        for thickness in [0.0, 0.3 * H, 1.3 * H] {
            for place in 0..4 {
                let brick = Brick::new([0.0, 0.0], [6, 4], H);
                let elastic = LinearElastic::new(1e6, 0.3);
                let law = DruckerPrager::new(elastic, Cone::PlaneStrain, 0.54, 0.0, 0.0, 0.0, true);
                let law = AnyLaw::DruckerPrager(law);
                let base = Boundary::plane("base", Vector2::zeros(), Vector2::y(), Friction::Coulomb(0.4));
                // As far away that none of it hangs over the sand.
                let free = 7.0 + 5.0 * libm::tan(lean.min(0.0).abs()) + 0.23 * f64::from(place);
                let foot = Vector2::new(free * H, -0.2 * H * k as f64);
                let up = Vector2::new(libm::sin(lean), libm::cos(lean));
                let plate = Boundary::wall("plate", foot, up, 20.0 * H, thickness, Friction::Coulomb(0.4));
                let mut scene = scene(&brick, law, 1500.0, brick.points(), vec![base, plate]);
                scene.bodies[0].1.iter_mut().for_each(|p| p.v = [2.0, 0.0]);
                scene.gravity = [6.0, -8.0];
                let mut sim = Simulation::new(scene);
                run_until(&mut sim, 0.5).expect("steps");
                let plate = &sim.boundaries()[1];
                let through = sim.particles().filter(|(_, p)| plate.face_coordinates(p.x).0 < 0.0).count();
                assert_eq!(through, 0, "{lean} {thickness} {place}");
                books_balance(&sim);
            }
        }
    }
}

#[test]
fn a_gate_that_is_gone_holds_nothing() {
    // A block rests before gates whose crest lies within it, at places between the nodes and on them; then they open.
    for place in 0..8 {
        for opening in [Opening::Vanish, Opening::Lift { speed: f64::INFINITY, opening: f64::INFINITY }] {
            let (x, height) = (0.4 + 0.0125 * f64::from(place), 0.2 - 0.0125 * f64::from(place));
            let brick = Brick::new([x - 0.4, 0.0], [4, 3], H);
            let gate = Boundary::wall("gate", Vector2::new(x, 0.0), Vector2::y(), height, 0.4, Friction::Rough);
            let base = Boundary::plane("base", Vector2::zeros(), Vector2::y(), Friction::Smooth);
            let mut scene = scene(&brick, law(), DENSITY, brick.points(), vec![gate.gate(opening), base]);
            scene.gravity = [3.0, -10.0];
            let mut sim = stepped(Simulation::new(scene), 50);
            assert!(sim.ledger().boundaries[0].impulse[0] < 0.0, "it holds: {place}");
            sim.release_gates();
            sim = stepped(sim, 1);
            sim.open_ledger();
            sim = stepped(sim, 50);
            assert_eq!(sim.ledger().boundaries[0].impulse, [0.0; 2], "{place} {opening:?}");
        }
    }
}

#[test]
fn boundaries_take_what_the_points_lose() {
    // Without stress, all that points lose in a step went to the boundaries: at nodes, between them, in a corner, sliding or sticking.
    let mut random = Lcg::new(7);
    for place in [0.0, 0.3, 0.5] {
        for friction in [Friction::Smooth, Friction::Coulomb(0.4), Friction::Rough] {
            let low = place * H;
            let planes = [[1.0, 0.0], [0.0, 1.0]].map(|n| Boundary::plane("p", [low, low].into(), n.into(), friction));
            let brick = Brick::new([low, low], [4, 3], H);
            let mut points = brick.points();
            points.iter_mut().for_each(|p| p.v = [random.signed() - 0.5, random.signed() - 0.5]);
            let mut scene = scene(&brick, law(), DENSITY, points, planes.into());
            scene.numerics.max_time_step = DT;
            let kinetic = |sim: &Simulation| sim.stock().kinetic;
            let mut sim = Simulation::new(scene);
            let before = kinetic(&sim);
            sim.step().expect("a step");
            let lost = before - kinetic(&sim);
            let taken: f64 = sim.step_tallies().iter().map(|t| -t.friction_work - t.normal_work).sum();
            assert!(lost > 0.01 * before, "{lost} of {before}");
            // In a corner between nodes, boundaries act one after the other on what is left to strain the material.
            assert!((taken - lost).abs() < 1e-9 * lost, "{place} {friction:?}: {taken} of {lost}");
        }
    }
}
