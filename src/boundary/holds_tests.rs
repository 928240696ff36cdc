use super::tests::{holds_at, plane};
use super::*;
use crate::boundary::BoundaryContact;
use crate::boundary::search::{Found, find_holds};
use crate::grid::{ActiveGrid, Column};
use nalgebra::Vector2;

#[test]
fn holds_are_listed_by_node_with_their_place_on_the_boundary() {
    // A base at y = 0 and a wall with its foot at (1, 0) on 4 x 4 nodes from (-1, -1) on, of spacing 1.
    let base = plane([0.0, 1.0], Friction::Coulomb(0.3));
    let mut wall = Boundary::wall("wall", Vector2::new(1.0, 0.0), Vector2::new(0.0, 1.0), 1.0, 1.0, Friction::Bonded);
    wall.velocity = Vector2::new(0.1, 0.2);
    let boundaries = [base, wall];
    let columns = (0..4).map(|c| Column { start: 4 * c, row: 0, rows: 4 }).collect();
    let mut grid =
        ActiveGrid { corner: [-1.0, -1.0], spacing: 1.0, inverse_spacing: 1.0, columns, ..ActiveGrid::default() };
    grid.index_columns();
    let mut found = Found::default();
    find_holds(&boundaries, &[0], &grid, BoundaryContact::Nodes, &mut found);
    let holds = found.holds;
    let found: Vec<_> = holds.iter().map(|h| (h.node, h.boundary, h.normal, h.along, h.arm)).collect();
    let mut expected = Vec::new();
    for (c, x) in [-1.0, 0.0, 1.0, 2.0].into_iter().enumerate() {
        for (r, y) in [-1.0, 0.0, 1.0, 2.0].into_iter().enumerate() {
            let node = (4 * c + r) as u32;
            if y <= 0.0 {
                expected.push((node, 0, [0.0, 1.0], x, [x, y]));
            }
            // The wall also holds below its foot, inside the base; its crest is a corner of its sides.
            if x >= 1.0 && y <= 1.0 {
                let normal = if x == 1.0 {
                    [-1.0, 0.0]
                } else if y == 1.0 {
                    [0.0, 1.0]
                } else {
                    [1.0, 0.0]
                };
                expected.push((node, 1, normal, y, [x - 1.0, y]));
            }
        }
    }
    assert_eq!(found, expected);
    for h in &holds {
        let (friction, bonded, velocity) =
            [(0.3, false, [0.0; 2]), (f64::INFINITY, true, [0.1, 0.2])][h.boundary as usize];
        assert_eq!((h.friction, h.bonded, h.wall), (friction, bonded, velocity));
    }
}

#[test]
fn walls_without_a_base_end_at_their_foot() {
    let wall = [Boundary::wall("wall", Vector2::zeros(), Vector2::new(0.0, 1.0), 2.0, 1.0, Friction::Smooth)];
    assert_eq!(holds_at([0.0, 0.0], &wall).len(), 1);
    assert!(holds_at([0.0, -0.5], &wall).is_empty());
    // A base that the node is just outside of does not bury it.
    let base = |y: f64| Boundary::plane("base", Vector2::new(0.0, y), Vector2::new(0.0, 1.0), Friction::Smooth);
    assert!(holds_at([0.0, -0.5], &[wall[0].clone(), base(-0.51)]).is_empty());
    assert_eq!(holds_at([0.0, -0.5], &[wall[0].clone(), base(-0.5)]).len(), 2);
    assert_eq!(holds_at([0.0, -0.5], &[wall[0].clone(), base(0.0)]).len(), 2);
}

#[test]
fn small_grids_have_small_tolerances_and_arms_begin_at_the_foot() {
    let h = 1e-4;
    let wall = Boundary::wall("wall", Vector2::new(0.5, 0.25), Vector2::new(0.0, 1.0), 10.0 * h, h, Friction::Smooth);
    let mut grid = ActiveGrid {
        corner: [0.5 - h, 0.25 + h],
        spacing: h,
        inverse_spacing: 1.0 / h,
        columns: (0..2).map(|c| Column { start: c, row: 0, rows: 1 }).collect(),
        ..ActiveGrid::default()
    };
    grid.index_columns();
    let mut found = Found::default();
    find_holds(&[wall], &[0], &grid, BoundaryContact::Nodes, &mut found);
    let holds = found.holds;
    let [hold] = &holds[..] else { panic!("the node on the face and not the one before it: {holds:?}") };
    assert_eq!(hold.node, 1);
    assert!(hold.arm[0].abs() < 1e-12 && (hold.arm[1] - h).abs() < 1e-12, "{hold:?}");
}
