//! A block slides without friction down a parabola that is made of planes.
//!
//! The planes are tangents, so what they leave free is the inside of a polygon around the parabola. A block of 50 mm turns by 63 degrees on its
//! way. A rigid one has a closed form. The kinks of the polygon cost energy: a body that meets one of the angle d and does not bounce loses the share
//! d^2 of what it has. Over the slide that is 4 a (1 - x^2)/(1 + 4 x^2)^2 summed over x, 1.33 a per metre of distance a between the planes, or
//! 0.67 a of the speed at the bottom. It is a bound, as the block is elastic and longer than a plane. With the default share of PIC, planes 20, 10
//! and 5 mm apart took 0.41, 0.17 and 0.12 % of the speed. Codes whose bed is the curve itself have 0.01 to 0.1 %.

use crate::report::table_csv;
use crate::scene::{Brick, Material, centre, scene};
use crate::{Fault, Outcome, RungFailure};
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::parabola::Bowl;
use nalgebra::Vector2;

const BLOCK: Material = Material::new(1e6, 0.3, 1000.0);
const H: f64 = 0.01;
const CELLS: usize = 5;
const EXACT: Bowl = Bowl { curvature: 1.0, side: H * CELLS as f64, gravity: 9.81 };
/// Where the middle of the base starts, m.
const START: f64 = -1.0;
/// Distance of the planes along x, m.
const APART: f64 = 0.005;
/// Share of the speed that kinks may take, per metre between the planes.
const KINKS: f64 = 0.67;

pub(super) fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let angle = EXACT.angle(START);
    let [x, y] = EXACT.centre(START);
    let (c, s, half) = (libm::cos(angle), libm::sin(angle), 0.5 * EXACT.side);
    // The lower left corner, on the parabola.
    let corner = [x - c * half + s * half, y - s * half - c * half];
    let brick = Brick { angle, ..Brick::new(corner, [CELLS, CELLS], H) };
    let planes = (-220..=20).map(|k| {
        let x = APART * f64::from(k);
        Boundary::plane("bowl", Vector2::new(x, x * x), Vector2::new(-2.0 * x, 1.0), Friction::Smooth)
    });
    let mut scene = scene(&brick, BLOCK.law(fault), BLOCK.density * fault.density, brick.points(), planes.collect());
    scene.gravity = [0.0, -EXACT.gravity * fault.gravity];
    scene.numerics.pic = PicShare::Fraction(0.0);
    let mut sim = Simulation::new(scene);

    let (mut rows, mut before) = (Vec::new(), [x, 0.0]);
    let bottom = loop {
        sim.step()?;
        let (x, v) = centre(&sim);
        let now = [x[0], v[0].hypot(v[1])];
        if rows.len() < 1 + (20.0 * (now[0] - START)) as usize {
            let v = EXACT.velocity(START, EXACT.base_over(now[0]));
            rows.push(vec![now[0], now[1], v[0].hypot(v[1])]);
        }
        if now[0] >= 0.0 || sim.time() > 1.0 {
            break before[1] + (now[1] - before[1]) * before[0] / (before[0] - now[0]);
        }
        before = now;
    };
    let balance = sim.energy_balance(&sim.stock(), [0.0; 2]);
    let given = EXACT.centre(START)[1] - EXACT.centre(0.0)[1];
    let given = given * sim.mass() * EXACT.gravity;

    let mut outcome = Outcome::default();
    outcome.check(
        Check::value("slide down y = x^2: speed at the bottom", bottom, EXACT.velocity(START, 0.0)[0], "m/s")
            .within(Tolerance::Relative(KINKS * APART), "what the kinks between the planes may take, 0.33 %")
            .from(Kind::Analytic, "energy of a rigid block that turns"),
    );
    outcome.check(
        Check::at_most("the same: energy residual over what gravity gave", balance.residual.abs() / given, 2e-3, "1")
            .because("what a bowl of 81 planes left on cells of 10 mm (docs/limits.md)")
            .from(Kind::Conservation, "energy balance"),
    );
    outcome.tables.push(("other_codes_bowl".into(), table_csv(&["x_m", "speed_m_s", "speed_exact_m_s"], rows)));
    Ok(outcome)
}
