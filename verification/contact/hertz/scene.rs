//! The scene: a wavy body, a flat one that rises against it, and what is measured when both rest.

use crate::contact::scenes::{Part, several};
use crate::scene::{Brick, Material, THICKNESS, run_until};
use crate::{Fault, RungFailure};
use checkdam::body::Particle;
use checkdam::boundary::{Boundary, Friction, Opening};
use checkdam::contact::rule::ContactRule;
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::elastic::confined_speed;
use checkdam::theory::hertz::{Wavy, contact_modulus};
use nalgebra::Vector2;
use std::f64::consts::PI;

/// What the wavy body is made of.
pub const BODY: Material = Material::new(1e6, 0.3, 1000.0);
/// m.
pub const WAVELENGTH: f64 = 1.0;
/// Depth of the body, m: reflections from its back change the first harmonic by 0.2 %.
const DEPTH: f64 = 0.75;
/// Largest slope of the waves.
const SLOPE: f64 = 0.025;
/// How far the crest lies above a row of nodes, cells.
const OFF: f64 = 0.37;
/// The closed form.
pub const fn exact(modulus: f64) -> Wavy {
    Wavy { wavelength: WAVELENGTH, amplitude: SLOPE * WAVELENGTH / (2.0 * PI), modulus }
}

/// The contact at rest under one load.
pub struct Rest {
    /// Mean pressure over the wavelength, Pa.
    pub mean: f64,
    /// How far the flat body has come since it touched the crest, m.
    pub travel: f64,
    /// Half width, m.
    pub half_width: f64,
    /// Place (m) and pressure (Pa) of each column of nodes.
    pub pressure: Vec<[f64; 2]>,
    /// Force at the back less that of the contact, over it.
    pub imbalance: f64,
    /// Change of the force over two tenths of a period, over it.
    pub drift: f64,
    /// Largest pull at a node so far, N s.
    pub pull: f64,
    /// Energy that the ledger misses, over the elastic energy.
    pub residual: f64,
}

impl Rest {
    /// Travel over that of the closed form under the same load: approach of the surfaces and even compression of the body.
    pub fn travel_over_exact(&self, w: &Wavy) -> f64 {
        self.travel / (w.approach(self.mean) + self.mean * (DEPTH - w.amplitude) / BODY.elastic.confined())
    }

    /// Half width over that of the closed form under the same load.
    pub fn width_over_exact(&self, w: &Wavy) -> f64 {
        self.half_width / w.half_width(self.mean)
    }
}

/// A plane of symmetry at `x` (m): boundaries do not pull, but two of them, back to back, hold nodes both ways.
fn symmetry(x: f64, inward: f64, h: f64) -> [Boundary; 2] {
    let plane = Boundary::plane("side", Vector2::new(x, 0.0), Vector2::x() * inward, Friction::Smooth);
    let foot = Vector2::new(x - 3.0 * h * inward, -10.0 * DEPTH);
    let wall = Boundary::wall("side", foot, Vector2::y(), 20.0 * DEPTH, 3.0 * h, Friction::Smooth);
    let wall = if inward < 0.0 { wall.facing_right() } else { wall };
    [plane.only_for(&[1]), wall.gate(Opening::Vanish).only_for(&[1])]
}

/// The points of the body, column by column, the back at y = 0.
fn points(w: &Wavy, h: f64) -> Vec<Particle> {
    let s = 0.5 * h;
    let mut points = Vec::new();
    for j in 0..(WAVELENGTH / s).round() as usize {
        let x = (j as f64 + 0.5) * s - 0.5 * WAVELENGTH;
        let bottom = OFF * h - DEPTH + w.amplitude * (1.0 - libm::cos(2.0 * PI * x / WAVELENGTH));
        for i in 0..(-bottom / s).round() as usize {
            points.push(Particle::at_rest(points.len() as u32, [x, bottom + (i as f64 + 0.5) * s]));
        }
    }
    points
}

/// Presses the body to one half width (m) after the other on a grid of `cells` cells to a wavelength.
pub fn press(cells: usize, widths: &[f64], rule: ContactRule, fault: &Fault) -> Result<Vec<Rest>, RungFailure> {
    let h = WAVELENGTH / cells as f64;
    let w = exact(contact_modulus(Some(&BODY.elastic), None));
    let face = OFF * h - DEPTH;
    let half = (cells / 4) as f64;
    let flat = Part::new(Brick::new([-half * h, face - 3.0 * h], [cells / 2, 3], h), BODY);
    let body = Part { points: points(&w, h), ..flat.clone() };
    let mut boundaries = vec![
        Boundary::plane("clamp", Vector2::new(0.0, face + 3.0 * h), Vector2::y(), Friction::Bonded).only_for(&[0]),
        Boundary::plane("back", Vector2::zeros(), -Vector2::y(), Friction::Smooth).only_for(&[1]),
    ];
    boundaries.extend(symmetry(-0.5 * WAVELENGTH, 1.0, h));
    boundaries.extend(symmetry(0.5 * WAVELENGTH, -1.0, h));
    let mut scene = several(vec![flat, body], vec![rule], boundaries, fault);
    scene.numerics.pic = PicShare::Fraction(0.02);
    let mut sim = Simulation::new(scene);
    let period = 4.0 * DEPTH / confined_speed(&BODY.elastic, BODY.density);
    sim.set_damping(4.0 * PI / period);
    let mut pull = 0.0f64;
    let mut rests = Vec::new();
    for &width in widths {
        let mean = w.mean_pressure(width);
        let travel = w.approach(mean) + mean * (DEPTH - w.amplitude) / BODY.elastic.confined();
        let (start, end) = (sim.time(), sim.time() + 2.0 * period);
        let rise = (travel - sim.boundaries()[0].travel.y) / (0.5 * period);
        sim.set_boundary_velocity(0, [0.0, rise]);
        run_until(&mut sim, start + 0.5 * period)?;
        sim.set_boundary_velocity(0, [0.0; 2]);
        let mut columns = vec![0.0; cells + 1];
        // Impulse and time two tenths of a period earlier, and in the last tenth; impulse at the back.
        let (mut before, mut last, mut back) = ([0.0; 2], [0.0; 2], 0.0);
        while sim.time() < end {
            sim.step()?;
            let (left, dt) = ((end - sim.time()) / (0.1 * period), sim.time_step().dt);
            let push = sim.contact_tallies().map(|t| t.exchange.impulse[1]).sum::<f64>() * fault.contact_force;
            pull = sim.contact_points().iter().map(|p| -p.impulse[1]).fold(pull, f64::max);
            if (2.0..3.0).contains(&left) {
                before = [before[0] + push, before[1] + dt];
            } else if left < 1.0 {
                last = [last[0] + push, last[1] + dt];
                back -= sim.step_tallies()[1].impulse[1];
                for p in sim.contact_points() {
                    let column = (p.x[0] / h).round() + 0.5 * cells as f64;
                    columns[column as usize] += p.impulse[1] * fault.contact_force;
                }
            }
        }
        let per_pressure = last[1] * THICKNESS * h;
        let pressure: Vec<_> =
            (0..=cells).map(|c| [(c as f64 - 0.5 * cells as f64) * h, columns[c] / per_pressure]).collect();
        let stock = sim.stock();
        rests.push(Rest {
            mean: last[0] / last[1] / (THICKNESS * WAVELENGTH),
            travel: sim.boundaries()[0].travel.y,
            half_width: half_width_of(&pressure, h),
            pressure,
            imbalance: back / last[0] - 1.0,
            drift: 1.0 - before[0] / before[1] / (last[0] / last[1]),
            pull,
            residual: sim.energy_balance(&stock, [0.0; 2]).residual / stock.elastic,
        });
    }
    Ok(rests)
}

/// Half width (m) from pressures of nodes at places (m).
fn half_width_of(pressure: &[[f64; 2]], h: f64) -> f64 {
    let k = 2.0 * PI / WAVELENGTH;
    let sum: f64 = pressure.iter().map(|p| p[1]).sum();
    let cosine = pressure.iter().map(|p| p[1] * libm::cos(k * p[0])).sum::<f64>() / sum;
    let hat = libm::sin(0.5 * k * h) / (0.5 * k * h);
    libm::asin((2.0 * (1.0 - cosine / (hat * hat))).sqrt()) * WAVELENGTH / PI
}

/// What a node at `x` (m) reads of a closed form: the part of the pressure that its hat covers, Pa.
pub fn read(w: &Wavy, mean: f64, x: f64, h: f64) -> f64 {
    let n = 64;
    let at = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
    (-n..n).map(|i| w.pressure(mean, x + at(i) * h) * (1.0 - at(i).abs())).sum::<f64>() / f64::from(n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_of_symmetry_hold_both_ways() {
        for inward in [1.0, -1.0] {
            let held = symmetry(2.0, inward, 0.1).map(|b| b.hold([2.0, 0.3], 0.1, 1e-7, false).map(|c| c.normal[0]));
            assert_eq!(held, [Some(inward), Some(-inward)]);
            let inside = symmetry(2.0, inward, 0.1).map(|b| b.hold([2.0 + 0.1 * inward, 0.3], 0.1, 1e-7, false));
            assert_eq!(inside, [None, None]);
        }
    }

    #[test]
    fn points_stand_on_the_wave() {
        let (w, h) = (exact(1e6), WAVELENGTH / 40.0);
        let points = points(&w, h);
        let lowest = |x: f64| {
            let column = points.iter().filter(|p| (p.x[0] - x).abs() < 0.3 * h);
            column.map(|p| p.x[1] - 0.25 * h).fold(f64::INFINITY, f64::min) + DEPTH - OFF * h
        };
        assert!(lowest(0.0).abs() < 1e-4 * w.amplitude + h * h / (16.0 * w.radius()));
        assert!((lowest(0.5 * WAVELENGTH) / (2.0 * w.amplitude) - 1.0).abs() < 0.01);
        let area = points.len() as f64 * 0.25 * h * h;
        assert!((area / (WAVELENGTH * (DEPTH - OFF * h - w.amplitude)) - 1.0).abs() < 0.01);
    }

    #[test]
    fn half_widths_are_found_in_what_nodes_read_of_the_closed_form() {
        let w = exact(1e6);
        for (cells, a) in [(40, 0.0625), (40, 0.125), (80, 0.125)] {
            let h = WAVELENGTH / f64::from(cells);
            let place = |c| (f64::from(c) - 0.5 * f64::from(cells)) * h;
            let nodes: Vec<_> = (1..cells).map(|c| [place(c), read(&w, w.mean_pressure(a), place(c), h)]).collect();
            assert!((half_width_of(&nodes, h) / a - 1.0).abs() < 2e-3, "{cells} {a}: {}", half_width_of(&nodes, h));
            let sum: f64 = nodes.iter().map(|p| p[1] * h).sum();
            assert!((sum / (w.mean_pressure(a) * WAVELENGTH) - 1.0).abs() < 1e-3);
        }
    }
}
