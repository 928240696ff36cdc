use super::super::two_bodies::{BODIES, close, point, scene_of, simulation};
use super::*;
use crate::scaffold::THICKNESS;

#[test]
fn field_gives_the_mean_velocity_and_fill_of_each_cell() {
    // Cells (-1, 2), (2, -1), (2, 2); points of both bodies in the last.
    let light =
        vec![point(0.6, 0.6, [3.0, 0.0], 1.0), point(-0.1, 0.7, [5.0, 6.0], 1.0), point(0.7, -0.2, [7.0, 8.0], 9.0)];
    let mut heavy = vec![point(0.7, 0.7, [0.0, 3.0], 1.2)];
    (heavy[0].state.stress.xx, heavy[0].state.plastic_shear) = (-6.0, 9.0);
    let sim = simulation(0.25, [light, heavy], vec![]);
    let field = velocity_field(&sim, &[]);
    let cell_volume = 0.0625 * THICKNESS;
    let expected = [
        ([-0.125, 0.625], BODIES[0].1, [5.0, 6.0]),
        ([0.625, -0.125], 1.5 * BODIES[0].1, [7.0, 8.0]),
        ([0.625, 0.625], BODIES[0].1 + 1.2 * BODIES[1].1, [1.0, 2.0]),
    ];
    assert_eq!(field.len(), 3);
    for (cell, (x, volume, v)) in field.iter().zip(expected) {
        assert!(close(cell.x[0], x[0]) && close(cell.x[1], x[1]), "{cell:?}");
        assert!(close(cell.fill, volume / cell_volume), "{cell:?}");
        assert!(close(cell.v[0], v[0]) && close(cell.v[1], v[1]), "{cell:?}");
    }
    // The heavy point is two thirds of the mass of the last cell; its mean stress is a third of -6 Pa.
    assert!(
        close(field[2].pressure, 2.0 * 2.0 / 3.0) && close(field[2].plastic_shear, 9.0 * 2.0 / 3.0),
        "{:?}",
        field[2]
    );
}

#[test]
fn cells_of_a_field_are_those_of_the_grid() {
    let still = |x: f64, y: f64| point(x, y, [0.0; 2], 1.0);
    let light = vec![still(0.6, 0.6), still(-0.1, 0.7), still(0.7, -0.2)];
    let mut scene = scene_of(0.25, [light, vec![still(0.7, 0.7)]], vec![]);
    scene.lattice.origin = [0.1, -0.06];
    let field = velocity_field(&Simulation::new(scene), &[]);
    // Cells (-1, 3), (2, -1), (2, 2), (2, 3), counted from the origin of the grid.
    let middles = [[-0.025, 0.815], [0.725, -0.185], [0.725, 0.565], [0.725, 0.815]];
    assert_eq!(field.len(), middles.len());
    for (cell, middle) in field.iter().zip(middles) {
        assert!((0..2).all(|d| close(cell.x[d], middle[d])), "{cell:?} {middle:?}");
    }
}
