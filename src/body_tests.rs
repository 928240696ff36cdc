use super::*;
use crate::constitutive::{LinearElastic, NeoHookean, VonMises};

/// A point of which no two numbers are alike.
fn distinct(id: u32) -> Particle {
    let n = |k: u32| f64::from(id) * 100.0 + f64::from(k);
    Particle {
        id,
        x: [n(1), n(2)],
        v: [n(3), n(4)],
        state: PointState {
            stress: Stress { xx: n(5), yy: n(6), zz: n(7), xy: n(8) },
            opened: n(9),
            plastic_shear: n(10),
            history: History::default(),
        },
        volume_ratio: n(11),
        slip: Slip::default(),
    }
}

fn points(count: u32) -> Points {
    let mut points = Points::default();
    (0..count).for_each(|id| points.push(&distinct(id)));
    points
}

#[test]
fn a_point_at_rest_is_undeformed() {
    let p = Particle::at_rest(7, [1.0, 2.0]);
    assert_eq!((p.id, p.x, p.v, p.volume_ratio), (7, [1.0, 2.0], [0.0; 2], 1.0));
    assert_eq!(p.state, PointState::default());
    assert_eq!(Particle { v: [-3.0, 4.0], ..p }.speed(), 5.0);
}

#[test]
fn what_is_written_is_read_in_every_lane() {
    let mut block = Block::default();
    for l in 0..LANES {
        block.set(l, &distinct(l as u32));
    }
    for l in 0..LANES {
        assert_eq!(block.get(l, l as u32), distinct(l as u32));
    }
}

#[test]
fn points_come_back_in_order() {
    for count in [0, 1, 7, 8, 9, 16, 21] {
        let mut points = points(count);
        assert_eq!((points.len(), points.is_empty()), (count as usize, count == 0));
        assert!(points.iter().eq((0..count).map(distinct)), "{count}");
        let counts: Vec<usize> = points.blocks().map(|(_, n)| n).collect();
        assert_eq!(counts.iter().sum::<usize>(), count as usize);
        assert_eq!([counts.len(), points.block_count()], [(count as usize).div_ceil(LANES); 2]);
        assert!(counts.iter().rev().skip(1).all(|&n| n == LANES));
        assert_eq!(points.blocks_mut().0.len(), counts.len());
    }
}

#[test]
fn points_can_be_written_in_place() {
    let mut points = Points::default();
    points.resize(19);
    assert_eq!(points.len(), 19);
    for i in (0..19).rev() {
        points.set(i, &distinct(i as u32));
    }
    assert!(points.iter().eq((0..19).map(distinct)));
    for block in points.blocks_mut().0 {
        block.x[0].iter_mut().for_each(|x| *x += 1.0);
    }
    assert!(points.iter().enumerate().all(|(i, p)| p.x == [distinct(i as u32).x[0] + 1.0, distinct(i as u32).x[1]]));
    points.clear();
    assert!(points.is_empty() && points.iter().next().is_none() && points.blocks().next().is_none());
}

#[test]
fn padding_copies_the_last_point_and_counts_it_once() {
    for count in [1u32, 5, 8, 11, 16] {
        let mut points = points(count);
        points.pad();
        assert!(points.iter().eq((0..count).map(distinct)), "{count}");
        let (last, used) = points.blocks().last().unwrap();
        for l in used..LANES {
            assert_eq!(last.get(l, count - 1), distinct(count - 1), "{count}");
            assert_eq!(points.ids().last().expect("a block")[l], u32::MAX, "{count}");
        }
    }
    let mut none = Points::default();
    none.pad();
    assert!(none.is_empty());
}

#[test]
fn wave_speed_is_the_root_of_modulus_over_density() {
    let body = Body {
        name: "sand".into(),
        law: AnyLaw::LinearElastic(LinearElastic { bulk: 5000.0, shear: 3000.0 }),
        point_mass: 20.0,
        point_volume: 0.02,
        points_per_direction: 2,
        point_spacing: 0.1,
        weightless: false,
        between_side_walls: true,
        implicit: false,
        mesh: None,
    };
    // M = K + 4/3 G = 9 kPa, 1000 kg/m3.
    assert!((body.p_wave_speed() - 3.0).abs() < 1e-14);
}

/// A point of a law with a history.
fn with_history(id: u32) -> Particle {
    let mut p = distinct(id);
    p.state.history = std::array::from_fn(|k| f64::from(id) + 0.1 * (k + 1) as f64);
    p
}

#[test]
fn a_history_is_kept_as_far_as_the_law_has_one() {
    let elastic = LinearElastic::new(1e6, 0.3);
    let (strength, hardening, viscosity) = (1e3, 1e5, 10.0);
    for (law, kept) in [
        (AnyLaw::NeoHookean(NeoHookean::new(1e6, 0.3)), 3),
        (AnyLaw::VonMises(VonMises { elastic, strength, hardening, viscosity }), 1),
        (AnyLaw::LinearElastic(elastic), 0),
    ] {
        let mut points = Points::for_law(&law);
        (0..11).for_each(|id| points.push(&with_history(id)));
        for (p, id) in points.iter().zip(0..) {
            let mut expected = with_history(id);
            expected.state.history[kept..].fill(0.0);
            assert_eq!(p, expected);
        }
        // Two blocks; the unused lanes of the second copy the last point.
        assert_eq!(points.blocks_mut().1.len(), 2 * kept);
        points.pad();
        for (k, lane) in points.blocks_mut().1[kept..].iter().enumerate() {
            assert!(lane[3..].iter().all(|value| *value == with_history(10).state.history[k]));
        }
        points.clear();
        points.resize(3);
        assert!(points.iter().all(|p| p.state.history == History::default()), "nothing is left of what was there");
    }
}
