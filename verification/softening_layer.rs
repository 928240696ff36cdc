//! A layer that softens, sheared between two plates: it localises, and its shear band is as wide as the grid makes it.
//!
//! Cohesion alone, so that no pressure has to be held. One row of points in the middle has sheared a little before; there the band forms.
//! What the layer takes up to its end, over the strength and half of the strain over which it softens, is the width of the band: in cells it
//! is the same on both grids, in metres it is not. That is no property of the material, and what is checked here is that it is as the
//! theory manual says.

use super::report::named_csv;
use super::scene::{Brick, Material, run_until, scene};
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, measured};
use crate::of_module;
use checkdam::boundary::{Boundary, Friction};
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::constitutive::{AnyLaw, Cone, DruckerPrager, Softening};
use checkdam::plot::curves::Curves;
use checkdam::simulation::{PicShare, Simulation};
use checkdam::theory::mohr_coulomb as theory;
use nalgebra::Vector2;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "A layer that softens, sheared between two plates on two grids: one band, as wide as the grid makes it",
    goal: "Elastic slope and peak of the layer; a band whose width is a number of cells, which is how results depend on the grid",
    source: "G/H; de Borst and others 1993 on softening without a length",
    sketch: r"
   =================  -->  bonded, moves
   o o o o o o o o o
   - - - - - - - - -  the band, one or two cells
   o o o o o o o o o
   =================       bonded
",
    run,
    covers: &[(FaultKind::Modulus, 1.03)],
    under_fault: "the coarse grid",
    figures: &[DESCENT],
};

const DESCENT: Figure = curves(
    "softening_layer_descent",
    "softening_layer_descent_plot",
    Curves {
        x: "displacement_mm",
        x_title: "displacement of the upper plate (mm)",
        y_title: "shear stress in the middle (Pa)",
        curves: &[measured("shear_stress_pa", "")],
        split: &[("grid", "")],
        ..Curves::LINEAR
    },
);

const CLAY: Material = Material::new(1e6, 0.3, 1500.0);
const DEPTH: f64 = 0.1;
/// Length over depth: in the middle the free ends have no say.
const LONG: usize = 4;
/// Pa.
const COHESION: f64 = 1000.0;
/// Engineering strain of plastic simple shear over which all of it is lost. In a band of one cell of the finer grid that is three times what
/// the layer springs back by, so that the descent is followed.
const OVER: f64 = 0.1;
/// Of the upper plate, m/s: a shear wave goes through the layer four times on the way to the peak.
const SPEED: f64 = 0.01;
/// Displacement at the end, m.
const END: f64 = 0.004;
/// Share of the strength that the middle row has lost at the start.
const WEAK: f64 = 0.05;
const GRIDS: [usize; 2] = [6, 12];
const NAMES: [&str; 2] = ["6 cells", "12 cells"];
const SAMPLES: u32 = 150;

/// What one grid gives: rows of displacement and stress, the slope of the ascent over G/H, the largest stress, the width of the band (m).
struct Seen {
    rows: Vec<Vec<f64>>,
    slope: f64,
    peak: f64,
    width: f64,
}

fn shear(grid: usize, fault: &Fault) -> Result<Seen, RungFailure> {
    let cells = GRIDS[grid];
    let h = DEPTH / cells as f64;
    let brick = Brick::new([0.0, 0.0], [LONG * cells, cells], h);
    let peak =
        DruckerPrager::new(CLAY.linear_elastic(fault), Cone::PlaneStrain, 0.0, 0.0, COHESION, f64::INFINITY, false);
    // Equivalent strain of simple shear is gamma / sqrt(3).
    let over = OVER / 3f64.sqrt();
    let mut points = brick.points();
    let row = |id: u32| id as usize / (2 * LONG * cells);
    points.iter_mut().filter(|p| row(p.id) / 2 == cells / 2).for_each(|p| p.state.plastic_shear = WEAK * over);
    // In simple shear from the start, so that no wave is sent out.
    points.iter_mut().for_each(|p| p.v[0] = SPEED * p.x[1] / DEPTH);
    let at = Vector2::new;
    let plates = vec![
        Boundary::plane("upper", at(0.0, DEPTH), at(0.0, -1.0), Friction::Bonded),
        Boundary::plane("lower", at(0.0, 0.0), at(0.0, 1.0), Friction::Bonded),
    ];
    let law = AnyLaw::SofteningDruckerPrager(Softening { peak, critical: 0.0, over });
    let mut scene = scene(&brick, law, CLAY.density * fault.density, points, plates);
    scene.numerics.pic = PicShare::Fraction(5e-4);
    let mut sim = Simulation::new(scene);
    sim.set_boundary_velocity(0, [SPEED, 0.0]);
    let middle = 0.5 * LONG as f64 * DEPTH;
    let mut rows = Vec::new();
    let (mut work, mut last) = (0.0, 0.0);
    for k in 1..=SAMPLES {
        run_until(&mut sim, END / SPEED * f64::from(k) / f64::from(SAMPLES))?;
        let (mut sum, mut n) = (0.0, 0.0);
        for (_, p) in sim.particles().filter(|(_, p)| (p.x[0] - middle).abs() < 0.5 * DEPTH) {
            sum += p.state.stress.xy;
            n += 1.0;
        }
        let stress = sum / n;
        work += 0.5 * (last + stress) * END / f64::from(SAMPLES);
        last = stress;
        rows.push(vec![grid as f64, 1000.0 * SPEED * sim.time(), stress]);
    }
    let top = rows.iter().map(|r| r[2]).fold(0.0, f64::max);
    // Between a fifth and four fifths of the strength, before the weak row yields.
    let up: Vec<&Vec<f64>> =
        rows.iter().take_while(|r| r[2] < 0.8 * COHESION).filter(|r| r[2] > 0.2 * COHESION).collect();
    let slope = match (up.first(), up.last()) {
        (Some(a), Some(b)) => 1000.0 * (b[2] - a[2]) / (b[1] - a[1]) / (CLAY.elastic.shear() / DEPTH),
        _ => f64::NAN,
    };
    Ok(Seen { rows, slope, peak: top, width: work / theory::softening_work(COHESION, OVER) })
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    let grids = if *fault == Fault::NONE { 0..2 } else { 0..1 };
    let (mut rows, mut widths) = (Vec::new(), Vec::new());
    for grid in grids {
        let seen = shear(grid, fault)?;
        let name = NAMES[grid];
        outcome.check(
            Check::value(format!("{name}: slope of the ascent over G/H"), seen.slope, 1.0, "1")
                .within(
                    Tolerance::Relative(0.01),
                    "in simple shear from the start; the free ends are two depths away, and what they do falls off by exp(-pi) over each",
                )
                .from(Kind::Analytic, "simple shear"),
        );
        outcome.check(
            Check::value(
                format!("{name}: largest shear stress over the strength"),
                seen.peak / COHESION,
                1.0 - WEAK,
                "1",
            )
            .within(
                Tolerance::Absolute(WEAK),
                "that of the weak row, plus up to what the swing and one row in two leave of its weakness",
            )
            .from(Kind::Analytic, "cohesion"),
        );
        outcome.check(
            Check::new(
                format!("{name}: width of the band over the cell"),
                seen.width * GRIDS[grid] as f64 / DEPTH,
                Expected::Within(0.8, 3.0),
                "1",
            )
            .because("a cell is the least that a grid resolves, and a shape function is three nodes wide")
            .from(Kind::Analytic, "work over half of strength times strain"),
        );
        widths.push(seen.width);
        rows.extend(seen.rows);
    }
    if let [coarse, fine] = widths[..] {
        outcome.check(
            Check::value("width of the band on half the cell, over that on the whole", fine / coarse, 0.5, "1")
                .within(Tolerance::Relative(0.25), "where in its cell the band begins changes its width by a quarter")
                .from(Kind::Convergence, "a band is a number of cells wide: it does not converge"),
        );
    }
    let header = ["grid", "displacement_mm", "shear_stress_pa"];
    outcome.tables.push(("softening_layer_descent".into(), named_csv(&header, &[("grid", &NAMES)], rows)));
    Ok(outcome)
}
