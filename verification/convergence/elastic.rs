//! A bar that strikes a wall and a column that settles, on four grids with four numbers of points per cell.

use crate::scene::{Brick, Material, THICKNESS, run_until, scene};
use crate::{Fault, RungFailure};
use checkdam::boundary::{Boundary, Friction};
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::bar;
use checkdam::theory::elastic::{bar_speed, confined_speed};
use checkdam::theory::self_weight::Column;
use nalgebra::Vector2;

/// The bar: Poisson's ratio zero, 1 m long.
pub const BAR: Material = Material::new(1e6, 0.0, 1500.0);
/// Length of the bar, m.
pub const LENGTH: f64 = 1.0;
/// Its velocity over its wave speed: strains of 1e-3.
pub const MACH: f64 = 1e-3;
/// The column.
pub const COLUMN: Material = Material::new(5e5, 0.3, 1500.0);
/// Its height, m.
pub const HEIGHT: f64 = 0.8;
/// Gravity, m/s2.
pub const GRAVITY: f64 = 9.81;

/// The bar strikes a rigid wall: mean force (Pa) between 20 and 80 % of the contact, and impulse over 2 m v.
pub fn impact(cells: usize, per_cell: usize, fault: &Fault) -> Result<[f64; 2], RungFailure> {
    let h = LENGTH / cells as f64;
    let speed = bar_speed(&BAR.elastic, BAR.density);
    let v = MACH * speed;
    let brick = Brick { per_cell, ..Brick::new([0.0, 0.0], [cells, 2], h) };
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v[0] = -v);
    let wall = Boundary::plane("wall", Vector2::zeros(), Vector2::new(1.0, 0.0), Friction::Smooth);
    let mut sim = Simulation::new(scene(&brick, BAR.law(fault), BAR.density * fault.density, points, vec![wall]));
    let duration = 2.0 * LENGTH / speed;
    let (mut impulse, mut plateau, mut time) = (0.0, 0.0, 0.0);
    while sim.time() < 1.5 * duration {
        sim.step()?;
        let push = sim.step_tallies()[0].impulse[0] * fault.contact_force;
        impulse += push;
        if (0.2..0.8).contains(&(sim.time() / duration)) {
            plateau += push;
            time += sim.time_step().dt;
        }
    }
    let area = 2.0 * h * THICKNESS;
    Ok([plateau / time / area, impulse / (2.0 * BAR.density * LENGTH * area * v)])
}

/// The column settles between smooth walls: force on a side wall per width (N/m) and settlement of the centre of mass (m).
pub fn settle(cells: usize, per_cell: usize, fault: &Fault) -> Result<[f64; 2], RungFailure> {
    let h = HEIGHT / cells as f64;
    let brick = Brick { per_cell, ..Brick::new([0.0, 0.0], [2, cells], h) };
    let at = Vector2::new;
    let boundaries = vec![
        Boundary::plane("base", at(0.0, 0.0), at(0.0, 1.0), Friction::Smooth),
        Boundary::plane("left", at(0.0, 0.0), at(1.0, 0.0), Friction::Smooth),
        Boundary::plane("right", at(2.0 * h, 0.0), at(-1.0, 0.0), Friction::Smooth),
    ];
    let mut scene = scene(&brick, COLUMN.law(fault), COLUMN.density * fault.density, brick.points(), boundaries);
    scene.gravity = [0.0, -GRAVITY * fault.gravity];
    scene.numerics.pic = PicShare::Fraction(0.02);
    let mut sim = Simulation::new(scene);
    let speed = confined_speed(&COLUMN.elastic, COLUMN.density);
    sim.set_damping(std::f64::consts::PI * speed / HEIGHT);
    run_until(&mut sim, 15.0 * HEIGHT / speed)?;
    let force = sim.step_tallies()[1].impulse[0] / (sim.time_step().dt * THICKNESS) * fault.contact_force;
    let centre = sim.particles().map(|(_, p)| p.x[1]).sum::<f64>() / sim.particle_count() as f64;
    Ok([force, 0.5 * HEIGHT - centre])
}

/// Closed forms of what [`impact`] returns.
pub fn impact_exact() -> [f64; 2] {
    let speed = bar_speed(&BAR.elastic, BAR.density);
    [bar::impact_stress(BAR.density, speed, MACH * speed), 1.0]
}

/// Closed forms of what [`settle`] returns.
pub fn settle_exact() -> [f64; 2] {
    let column =
        Column { height: HEIGHT, density: COLUMN.density, gravity: GRAVITY, modulus: COLUMN.elastic.confined() };
    // Vertical stress over the settled height: rho0 g integral of (L - Y) dy, dy = (1 - strain) dY, logarithmic law.
    let n = 2000;
    let force = (0..n).map(|i| {
        let y = |k: f64| HEIGHT * k / f64::from(n);
        let (a, b) = (y(f64::from(i)), y(f64::from(i + 1)));
        -column.stress(0.5 * (a + b)) * (column.position(b) - column.position(a))
    });
    let sunk = (0..n).map(|i| {
        let y = HEIGHT * (f64::from(i) + 0.5) / f64::from(n);
        (y - column.position(y)) / f64::from(n)
    });
    [force.sum::<f64>() * COLUMN.elastic.lateral_ratio(), sunk.sum()]
}
