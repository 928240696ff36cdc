//! A stiff block on a plane with Coulomb friction: slides, sticks, stops.
//!
//! The plane lies along the grid, or at an angle to it; gravity is turned so that the slope is what it should be. The block
//! first settles on a plane that lets nothing slip, then the friction is set free, so that no bounce spoils the normal force.
//!
//! An elastic block without damping does not slide smoothly: it starts to shake, the faster the larger the friction, until its heel lifts.
//! At 23 degrees the block of this rung then runs 54 % too far in 0.4 s. With contact at nodes it was 68 %. There it was 78 % on half the
//! cell size, 66 % with a quarter of the time step, 69 % with USF, and 30 % with USL, which damps. We take it for the instability of
//! elastic bodies that slide with Coulomb friction (mode coupling, cf. Hoffmann et al. 2002), since neither grid nor time step makes it go
//! away. This is an inference, not a proof. One thing is the method's own: boundaries know velocities and no gap. So what shook loose, up
//! to a tenth of a cell, does not fall back. A rigid block cannot shake, so these checks use pure PIC, which takes the shaking and leaves
//! translation alone. The table shows the undamped block, too; it is not judged.

mod placements;

use super::report::named_csv;
use super::scene::{Brick, Material, THICKNESS, centre, points_by_number, run_until, scene};
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use checkdam::body::Particle;
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::plot::curves::{Curves, panel};
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::sliding_block as theory;
use nalgebra::Vector2;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "A block on a plane with Coulomb friction, along the grid and at angles to it: slip, stick, arrest, work, impulse",
    goal: "A block slides, sticks and stops as Coulomb says, wherever the plane lies in the grid",
    source: "Coulomb 1785: a = g (sin - mu cos); work and impulse of friction",
    sketch: r"
        ____
       |o o o|-->  a
   ____|o_o_o|_______   mu, at an angle to the grid
      \
       \ g, turned by the slope
",
    run,
    covers: &[
        (FaultKind::Friction, 1.03),
        (FaultKind::Gravity, 1.03),
        (FaultKind::Density, 1.03),
        (FaultKind::ContactForce, 1.03),
    ],
    under_fault: "all; of the placements, one for each angle",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[SLIP, placements::FIGURE];

const SLIP: Figure = curves(
    "sliding_block_slip",
    "sliding_block_slip_plot",
    Curves {
        x: "time_s",
        x_title: "time (s)",
        y_title: "displacement (m)",
        curves: &[measured("displacement_m", ""), exact("displacement_exact_m", "exact")],
        panels: &[
            panel("slope 40°", &[("slope_deg", "40")]),
            panel("slope 31°", &[("slope_deg", "31")]),
            panel("slope 23°", &[("slope_deg", "23")]),
        ],
        split: &[("block", ""), ("plane_to_grid_deg", "plane to grid (degrees) ")],
        ..Curves::LINEAR
    },
);

const BLOCK: Material = Material::new(2e7, 0.3, 1500.0);
const H: f64 = 0.05;
const CELLS: [usize; 2] = [8, 4];
const GRAVITY: f64 = 9.81;
const MASS: f64 = BLOCK.density * 32.0 * H * H * THICKNESS;
/// Pure PIC: keeps the block from shaking without touching its translation.
const RIGID: f64 = 1.0;
const COULOMB: &str = "Coulomb 1785: g (sin - mu cos)";

/// A plane inclined by `plane` in the grid, under gravity that makes a slope of `slope` with it; rad.
#[derive(Clone, Copy)]
struct Setting {
    name: &'static str,
    plane: f64,
    slope: f64,
    friction: f64,
    /// The block's lower left corner, which lies on the plane, m.
    corner: [f64; 2],
    /// Whether the slope falls to the left, seen with the normal up.
    leftward: bool,
}

impl Setting {
    /// The plane and slope in degrees, at the place of the grid that most checks have, falling to the right.
    fn new(name: &'static str, plane: f64, slope: f64, friction: f64) -> Self {
        let [plane, slope] = [plane, slope].map(f64::to_radians);
        Self { name, plane, slope, friction, corner: [0.013, 0.007], leftward: false }
    }

    /// Down the slope.
    fn tangent(&self) -> Vector2<f64> {
        let right = Vector2::new(libm::cos(self.plane), -libm::sin(self.plane));
        if self.leftward { -right } else { right }
    }

    fn normal(&self) -> Vector2<f64> {
        Vector2::new(libm::sin(self.plane), libm::cos(self.plane))
    }

    fn brick(&self) -> Brick {
        Brick { angle: -self.plane, ..Brick::new(self.corner, CELLS, H) }
    }

    /// A simulation with these points and friction, and share of PIC.
    fn simulation(&self, points: Vec<Particle>, friction: Friction, pic: f64, fault: &Fault) -> Simulation {
        let brick = self.brick();
        let base = Boundary::plane("base", brick.corner.into(), self.normal(), friction);
        let mut scene = scene(&brick, BLOCK.law(fault), BLOCK.density * fault.density, points, vec![base]);
        let g = GRAVITY * fault.gravity;
        scene.gravity =
            (self.tangent() * (g * libm::sin(self.slope)) - self.normal() * (g * libm::cos(self.slope))).into();
        scene.numerics.pic = PicShare::Fraction(pic);
        Simulation::new(scene)
    }

    fn coulomb(&self, fault: &Fault) -> Friction {
        Friction::Coulomb(self.friction * fault.friction)
    }

    /// The block at rest under gravity on a plane that lets nothing slip.
    fn at_rest(&self, fault: &Fault) -> Result<Vec<Particle>, RungFailure> {
        let mut sim = self.simulation(self.brick().points(), Friction::Rough, 0.02, fault);
        settle(&mut sim)?;
        Ok(points_by_number(&sim))
    }
}

fn settle(sim: &mut Simulation) -> Result<(), RungFailure> {
    sim.set_damping(800.0);
    run_until(sim, 0.15)?;
    sim.set_damping(0.0);
    Ok(())
}

/// Displacement and velocity of the centre along the slope since `start`.
fn moved(sim: &Simulation, start: [f64; 2], setting: &Setting) -> (f64, f64) {
    let (x, v) = centre(sim);
    let t = setting.tangent();
    ((Vector2::from(x) - Vector2::from(start)).dot(&t), Vector2::from(v).dot(&t))
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    let mut rows = Vec::new();
    for (name, plane, slope, friction) in [
        ("40 deg, plane along the grid", 0.0, 40.0, 0.4),
        ("40 deg, plane at 40 deg to the grid", 40.0, 40.0, 0.4),
        ("23 deg, plane along the grid", 0.0, 23.0, 0.4),
        ("23 deg, plane at 23 deg to the grid", 23.0, 23.0, 0.4),
        ("31 deg, plane at 7.3 deg to the grid", 7.3, 31.0, 0.3),
    ] {
        let setting = Setting::new(name, plane, slope, friction);
        let (sim, moved) = slip(&setting, RIGID, fault, &mut rows)?;
        judge_slip(&sim, moved, &setting, fault, &mut outcome);
        if plane == 0.0 {
            slip(&setting, 0.0, fault, &mut rows)?;
        }
    }
    for (name, plane) in [("0.9 on 40 deg along the grid", 0.0), ("0.9 on 40 deg at 40 deg to the grid", 40.0)] {
        stick(&Setting::new(name, plane, 40.0, 0.9), fault, &mut outcome)?;
    }
    for (name, plane) in [("level", 0.0), ("level, at 17 deg to the grid", 17.0)] {
        arrest(&Setting::new(name, plane, 0.0, 0.4), fault, &mut outcome)?;
    }
    placements::judge(fault, &mut outcome)?;
    let header = [
        "plane_to_grid_deg",
        "slope_deg",
        "friction",
        "block",
        "time_s",
        "displacement_m",
        "displacement_exact_m",
        "velocity_m_s",
        "velocity_exact_m_s",
        "height_change_m",
    ];
    outcome
        .tables
        .push(("sliding_block_slip".into(), named_csv(&header, &[("block", &["undamped", "full PIC"])], rows)));
    Ok(outcome)
}

/// From rest on a slope steeper than the friction angle: the simulation after 0.4 s, and how far the block went, and how fast it is.
fn slip(
    s: &Setting,
    pic: f64,
    fault: &Fault,
    rows: &mut Vec<Vec<f64>>,
) -> Result<(Simulation, (f64, f64)), RungFailure> {
    let mut sim = s.simulation(s.at_rest(fault)?, s.coulomb(fault), pic, fault);
    let start = centre(&sim).0;
    let a = theory::acceleration_from_rest(GRAVITY, s.slope, s.friction);
    let mut height = None;
    for k in 0..=8 {
        run_until(&mut sim, 0.05 * f64::from(k))?;
        let ((x, v), t) = (moved(&sim, start, s), sim.time());
        let now = Vector2::from(centre(&sim).0).dot(&s.normal());
        let rise = now - *height.get_or_insert(now);
        let degrees = [s.plane.to_degrees(), s.slope.to_degrees()];
        rows.push(vec![degrees[0], degrees[1], s.friction, pic, t, x, theory::distance(a, t), v, a * t, rise]);
    }
    let moved = moved(&sim, start, s);
    Ok((sim, moved))
}

/// Acceleration, displacement, impulses and work.
fn judge_slip(sim: &Simulation, (x, v): (f64, f64), s: &Setting, fault: &Fault, outcome: &mut Outcome) {
    let a = theory::acceleration_from_rest(GRAVITY, s.slope, s.friction);
    let t = sim.time();
    outcome.check(
        Check::value(format!("{}: acceleration, mean over the slide", s.name), v / t, a, "m/s2")
            .within(
                Tolerance::Absolute(0.01 * GRAVITY * libm::sin(s.slope)),
                "1 % of what gravity alone would do: the block is not rigid, and starts with a shear wave",
            )
            .from(Kind::Analytic, COULOMB),
    );
    // What friction and gravity would do alone sets the scale: at 23 degrees they nearly cancel.
    let scale = theory::distance(GRAVITY * libm::sin(s.slope), t);
    outcome.check(
        Check::value(format!("{}: displacement", s.name), x, theory::distance(a, t), "m")
            .within(
                Tolerance::Absolute(0.01 * scale),
                "1 % of what gravity alone would do: the block is not rigid, and starts with a shear wave",
            )
            .from(Kind::Analytic, COULOMB),
    );
    let tally = &sim.ledger().boundaries[0];
    let impulse = Vector2::from(tally.impulse) * fault.contact_force;
    let normal = MASS * GRAVITY * libm::cos(s.slope) * t;
    outcome.check(
        Check::value(format!("{}: normal impulse of the plane", s.name), impulse.dot(&s.normal()), normal, "N s")
            .within(
                Tolerance::Relative(0.005),
                "weight times time; what the block still moves along the normal is below 1 mm/s",
            )
            .from(Kind::Conservation, "Newton's second law"),
    );
    outcome.check(
        Check::value(
            format!("{}: tangential impulse of the plane", s.name),
            -impulse.dot(&s.tangent()),
            s.friction * normal,
            "N s",
        )
        .within(Tolerance::Relative(0.02), "mu times the normal impulse but for the first shear wave, 5 ms of 400")
        .from(Kind::Analytic, COULOMB),
    );
    outcome.check(
        Check::value(
            format!("{}: friction work in the ledger", s.name),
            -tally.friction_work,
            theory::friction_work(MASS, GRAVITY, s.slope, s.friction, x),
            "J",
        )
        .within(
            Tolerance::Relative(0.01),
            "the base slips as far as the centre moves but for the shear of the block, 1e-5 m",
        )
        .from(Kind::Analytic, "mu N s"),
    );
}

/// Friction above the tangent of the slope.
fn stick(s: &Setting, fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let mut sim = s.simulation(s.at_rest(fault)?, s.coulomb(fault), RIGID, fault);
    settle(&mut sim)?;
    let start = centre(&sim).0;
    let end = sim.time() + 1.0;
    run_until(&mut sim, end)?;
    let (x, _) = moved(&sim, start, s);
    outcome.check(
        Check::at_most(format!("friction {}: creep in 1 s", s.name), x.abs(), 1e-4, "m")
            .because("none in theory; a five-hundredth of a cell, less than the elastic shear under gravity")
            .from(Kind::Analytic, "Coulomb 1785: sticks where mu > tan"),
    );
    Ok(())
}

/// An initial speed on level ground.
fn arrest(s: &Setting, fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let speed = 1.0;
    let mut points = s.at_rest(fault)?;
    points.iter_mut().for_each(|p| p.v = (s.tangent() * speed).into());
    let mut sim = s.simulation(points, s.coulomb(fault), RIGID, fault);
    let start = centre(&sim).0;
    // Half way through first: it could stop anywhere by another law.
    let half = 0.5 * theory::stopping_time(GRAVITY, s.friction, speed);
    run_until(&mut sim, half)?;
    let t = sim.time();
    let exact = speed * t - theory::distance(s.friction * GRAVITY, t);
    outcome.check(
        Check::value(format!("{}: distance half way to the stop", s.name), moved(&sim, start, s).0, exact, "m")
            .within(Tolerance::Relative(0.01), "the block is not rigid, and braking starts with a shear wave")
            .from(Kind::Analytic, COULOMB),
    );
    run_until(&mut sim, 3.0 * half)?;
    let (x, v) = moved(&sim, start, s);
    let exact = theory::stopping_distance(GRAVITY, s.friction, speed);
    outcome.check(
        Check::value(format!("{}: stopping distance", s.name), x, exact, "m")
            .within(Tolerance::Relative(0.01), "the block is not rigid, and braking starts with a shear wave")
            .from(Kind::Analytic, "v^2 / (2 mu g)"),
    );
    outcome.check(
        Check::at_most(format!("{}: speed after the stop", s.name), v.abs(), 0.01, "m/s")
            .because("1 % of the initial speed: the block still rings")
            .from(Kind::Analytic, "v / (mu g) has passed by half"),
    );
    let tally = &sim.ledger().boundaries[0];
    outcome.check(
        Check::value(
            format!("{}: friction work in the ledger", s.name),
            -tally.friction_work,
            0.5 * MASS * speed * speed,
            "J",
        )
        .within(Tolerance::Relative(0.01), "what rings in the block is not dissipated")
        .from(Kind::Conservation, "all kinetic energy"),
    );
    let impulse = Vector2::from(tally.impulse).dot(&s.tangent()) * fault.contact_force;
    outcome.check(
        Check::value(format!("{}: impulse along the plane", s.name), -impulse, MASS * speed, "N s")
            .within(
                Tolerance::Relative(0.01),
                "mass times the change of velocity, which is within 1 % of the initial speed",
            )
            .from(Kind::Conservation, "Newton's second law"),
    );
    Ok(())
}
