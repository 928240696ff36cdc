//! A beam clamped at its foot: deflection, first frequency, large rotation.
//!
//! The beam stands on a plane that holds its nodes, two cells deep; its cells are free from there on, so the length is known to
//! the node. Deflections are read at the topmost row of points, at whose own height the closed forms are taken. What can go
//! wrong: the modulus of plane strain, the clamp, the effective depth at free faces, locking of coarse cells.
//!
//! What theory expects of linear and uGIMP functions, two points a cell and direction, at small deflections: A bilinear cell that bends
//! shears instead (parasitic shear) and does not follow the lateral strain. Both go with the mean square distance (h/4)^2 of the points
//! from its middle. And the points sum up y^2 too low by (2 n)^-2. With n cells through the depth the beam is too stiff by (3/4 (G/E' +
//! M/E' - 1) - 1/4) / n^2: 0.18/n^2 at Poisson's ratio 0.3, 0.125/n^2 at zero (derived here). A clamp that also prevents lateral strain
//! stiffens the foot, which beam theory does not know: that remains on any grid, and is gone at Poisson's ratio zero, which is checked.
//! Splines reach over the free faces, where little mass holds few nodes, and are too soft by an amount of first order.
//!
//! At large deflection points cross cells. FLIP alone then lets them collect motion that no node sees and no damping stops, which spoils
//! the deflection by 3 to 30 %. One or two percent of PIC a step remove it, and cost nothing at rest. The rate law of the material differs
//! from any other one by the strain, at most 5 % at the foot, squared.
//!
//! A body that moves by its mesh (`meshed`) has none of this: its stiffness is that of its elements, whatever the points.

mod beam;
mod implicit;
mod meshed;
mod plate;
mod swing;

use super::report::named_csv;
use super::scene::Material;
use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::of_module;
use beam::{Beam, DEPTH, Load, settle};
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::plot::curves::{Curves, panel};
use checkdam::shape::ShapeFunction;
use checkdam::theory::cantilever::elastica;
use checkdam::theory::order;

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "A clamped beam: deflection under a force at the tip and a load all along, first frequency, elastica",
    goal: "A clamped beam: small deflection by tip and by line load, first frequency, large rotation; by its mesh also a large swing and an impact",
    source: "Timoshenko 1921 with Cowper 1966; the elastica with shear",
    sketch: r"
     F -> _
         | |  line load ->
         | |               w = F L^3/(3 E'I) + F L/(k G A)
         | | L
   ======|_|======  clamp
",
    run,
    covers: &[
        (FaultKind::Modulus, 1.03),
        (FaultKind::Density, 1.03),
        (FaultKind::Gravity, 1.03),
        (FaultKind::ContactForce, 1.02),
    ],
    under_fault: "a plate two cells thick by its mesh; modulus: uGIMP without lateral strain on 4 and 8 cells, first frequency on 8",
    figures: FIGURES,
};

/// Its figures.
const FIGURES: &[Figure] = &[
    curves(
        "cantilever_deflection",
        "cantilever_deflection_plot",
        Curves {
            x: "cells_through_depth",
            x_title: "cells through the depth",
            y_title: "error of the deflection, relative",
            curves: &[measured("deflection_error", "")],
            panels: &[panel("uGIMP", &[("shape", "uGIMP")]), panel("B-spline", &[("shape", "B-spline")])],
            split: &[("load", ""), ("length_over_depth", "L/t "), ("poisson", "nu ")],
            orders: &[1.0, 2.0],
            ..Curves::LOGARITHMIC
        },
    ),
    curves(
        "cantilever_elastica",
        "cantilever_elastica_plot",
        Curves {
            x: "cells_through_depth",
            x_title: "cells through the depth",
            y_title: "deflection / length, at 26° of the tip",
            curves: &[measured("deflection_over_length", ""), exact("deflection_exact", "elastica with shear")],
            split: &[("shape", "")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "cantilever_frequency",
        "cantilever_frequency_plot",
        Curves {
            x: "cells_through_depth",
            x_title: "cells through the depth",
            y_title: "first frequency (Hz)",
            curves: &[measured("frequency_hz", ""), exact("frequency_exact_hz", "3.516, shear, rotary inertia")],
            split: &[("shape", "")],
            ..Curves::LINEAR
        },
    ),
    curves(
        "cantilever_swing",
        "cantilever_swing_plot",
        Curves {
            x: "time_s",
            x_title: "time (s)",
            y_title: "way of the tip's lower corner (m)",
            curves: &[measured("tip_m", "")],
            split: &[("cells_through_depth", "cells "), ("points_per_cell", "points a cell ")],
            ..Curves::LINEAR
        },
    ),
];

const MATERIAL: Material = Material::new(1e6, 0.3, 2000.0);
const NO_LATERAL_STRAIN: Material = Material::new(1e6, 0.0, 2000.0);
const SHAPES: [(ShapeFunction, &str); 2] = [(ShapeFunction::Ugimp, "uGIMP"), (ShapeFunction::Bspline, "B-spline")];
/// Deflection over depth where it is small: a thirtieth of the finest cell.
const SMALL: f64 = 0.002;
const SHAPE_NAMES: [&str; 2] = ["uGIMP", "B-spline"];
const TIMOSHENKO: &str = "Timoshenko 1921 with E/(1 - nu^2), shear coefficient of Cowper 1966";

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let mut outcome = Outcome::default();
    meshed::run(fault, &mut outcome)?;
    // Faults of other kinds are for the mesh alone.
    if fault.modulus == 1.0 && *fault != Fault::NONE {
        return Ok(outcome);
    }
    let (mut rows, mut large) = (Vec::new(), Vec::new());
    for (index, (shape, name)) in SHAPES.into_iter().enumerate() {
        let mut record = |beam: &Beam, spread: bool| -> Result<f64, RungFailure> {
            let [error, kinetic] = small(beam, spread, fault)?;
            let load = f64::from(u8::from(spread));
            let nu = beam.material.elastic.poisson;
            rows.push(vec![index as f64, nu, beam.slenderness as f64, beam.cells as f64, load, error, kinetic]);
            Ok(error)
        };
        let beam = |slenderness, cells, material| Beam {
            shape,
            slenderness,
            cells,
            material,
            per_cell: 2,
            mesh: false,
            implicit: None,
        };
        if *fault != Fault::NONE {
            // Without lateral strain the clamp does nothing, and two grids tell the stiffness to 0.2 %.
            if shape == ShapeFunction::Ugimp {
                free(&[4, 8].map(|n| record(&beam(4, n, NO_LATERAL_STRAIN), false)), &mut outcome)?;
            }
            continue;
        }
        let tip = [4, 8, 16].map(|n| record(&beam(4, n, MATERIAL), false));
        let [coarse, medium, fine] = tip;
        let tip = [coarse?, medium?, fine?];
        let spread = [record(&beam(4, 4, MATERIAL), true)?, record(&beam(4, 8, MATERIAL), true)?];
        deflections(shape, name, &tip, &spread, &mut outcome);
        if shape == ShapeFunction::Ugimp {
            clamp(&tip, &mut outcome);
            free(&[4, 8].map(|n| record(&beam(4, n, NO_LATERAL_STRAIN), false)), &mut outcome)?;
        }
        let barrier = record(&beam(6, 10, MATERIAL), false)?;
        outcome.check(
            Check::value(
                format!("{name}, 0.6 m by 0.1 m on cells of 10 mm: error of the tip's deflection"),
                barrier,
                0.0,
                "1",
            )
            .within(Tolerance::Absolute(allowed(shape, 10.0, 3.0 * 4.0 / 6.0)), reason(shape))
            .from(Kind::Analytic, TIMOSHENKO),
        );
        for cells in [4, 6] {
            large.push(rotated(&beam(10, cells, MATERIAL), name, index, fault, &mut outcome)?);
        }
    }
    let moving = rows.iter().chain(&large).filter_map(|r| r.last()).fold(0.0f64, |a, &k| if k <= a { a } else { k });
    outcome.check(
        Check::at_most("kinetic over elastic energy when deflections are read, largest", moving, 1e-5, "1")
            .because("a velocity of 0.3 % of that of a free swing, most of it ripples on cells: 0.1 % of a deflection at most")
            .from(Kind::Analytic, "damped oscillator"),
    );
    let names: [(&str, &[&str]); 2] = [("shape", &SHAPE_NAMES), ("load", &["force at the tip", "load all along"])];
    let header = [
        "shape",
        "poisson",
        "length_over_depth",
        "cells_through_depth",
        "load",
        "deflection_error",
        "kinetic_over_elastic",
    ];
    outcome.tables.push(("cantilever_deflection".into(), named_csv(&header, &names, rows)));
    let header = [
        "shape",
        "cells_through_depth",
        "deflection_over_length",
        "deflection_exact",
        "shortening_over_length",
        "shortening_exact",
        "kinetic_over_elastic",
    ];
    outcome.tables.push(("cantilever_elastica".into(), named_csv(&header, &names, large)));
    swing::run(fault, &mut outcome)?;
    Ok(outcome)
}

/// Relative error of a small deflection, and kinetic over elastic energy when it is read.
fn small(beam: &Beam, spread: bool, fault: &Fault) -> Result<[f64; 2], RungFailure> {
    let e = beam.exact();
    let (load, exact) = if spread {
        let q = SMALL * DEPTH / e.under_load(1.0, e.length);
        (Load::Spread(q), e.under_load(q, beam.tip()))
    } else {
        let force = SMALL * DEPTH / e.under_force(1.0, e.length);
        (Load::Tip(force), e.under_force(force, beam.tip()))
    };
    let rest = settle(beam, load, fault)?;
    Ok([rest.tip[0] / exact - 1.0, rest.kinetic])
}

/// Allowed for a deflection on `n` cells: a foot moved by d takes 3 d/L from the deflection under a force at the tip, and 4 d/L
/// under a load all along; `foot` is that factor for L/t = 4.
fn allowed(shape: ShapeFunction, n: f64, foot: f64) -> f64 {
    if shape == ShapeFunction::Ugimp { foot * 0.04 / 12.0 + 0.33 / (n * n) } else { 0.3 / n }
}

fn reason(shape: ShapeFunction) -> &'static str {
    if shape == ShapeFunction::Ugimp {
        "a foot moved by t/75 in the clamp, which prevents lateral strain, and 0.33/n^2, twice what bilinear cells are too stiff"
    } else {
        "splines reach h/4 over either face at first order: 0.3/n"
    }
}

/// Errors on 4, 8, 16 cells under a force at the tip, on 4, 8 cells under a spread load.
fn deflections(shape: ShapeFunction, name: &str, tip: &[f64; 3], spread: &[f64; 2], outcome: &mut Outcome) {
    let loads = tip.iter().map(|e| (("a force at the tip", 3.0), e)).zip([4.0, 8.0, 16.0]);
    for (((load, foot), &error), n) in
        loads.chain(spread.iter().map(|e| (("a load all along", 4.0), e)).zip([4.0, 8.0]))
    {
        outcome.check(
            Check::value(
                format!("{name}, L/t = 4, {n} cells: error of the tip's deflection under {load}"),
                error,
                0.0,
                "1",
            )
            .within(Tolerance::Absolute(allowed(shape, n, foot)), reason(shape))
            .from(Kind::Analytic, TIMOSHENKO),
        );
    }
    let (expected, why) = if shape == ShapeFunction::Ugimp {
        (Expected::Within(1.6, 2.4), "second order at deflections that cross no cell, 0.4 for coarse grids")
    } else {
        (Expected::Within(0.8, 2.0), "first order at the faces, second inside")
    };
    outcome.check(
        Check::new(
            format!("{name}, L/t = 4, 4, 8, 16 cells: observed order of the deflection"),
            order::from_values(tip[0], tip[1], tip[2], 2.0),
            expected,
            "1",
        )
        .because(why)
        .from(Kind::Convergence, "Roache 1994"),
    );
}

/// What the clamp does: extrapolated to no cell size, with lateral strain.
fn clamp(tip: &[f64; 3], outcome: &mut Outcome) {
    outcome.check(
        Check::new(
            "uGIMP, L/t = 4, nu = 0.3: error of the deflection, extrapolated",
            order::extrapolated(tip[1], tip[2], 2.0, 2.0),
            Expected::Within(-0.012, 0.0),
            "1",
        )
        .because("the clamp stiffens the foot over a small part of the depth: 1 % is a foot moved by t/75")
        .from(Kind::Convergence, TIMOSHENKO),
    );
}

/// Without lateral strain, on 4 and 8 cells: the clamp does nothing then.
fn free(errors: &[Result<f64, RungFailure>; 2], outcome: &mut Outcome) -> Result<(), RungFailure> {
    let [coarse, fine] = errors.clone();
    let (coarse, fine) = (coarse?, fine?);
    outcome.check(
        Check::value(
            "uGIMP, L/t = 4, nu = 0: error of the deflection, extrapolated",
            order::extrapolated(coarse, fine, 2.0, 2.0),
            0.0,
            "1",
        )
        .within(
            Tolerance::Absolute(0.002),
            "no lateral strain to prevent; what two grids leave of 0.125/n^2 and of warping",
        )
        .from(Kind::Convergence, TIMOSHENKO),
    );
    outcome.check(
        Check::value("uGIMP, L/t = 4, nu = 0, 4 cells: error of the deflection", coarse, -0.125 / 16.0, "1")
            .within(Tolerance::Absolute(0.005), "next order in 1/n, and warping at the clamp")
            .from(Kind::Analytic, "bilinear cells with points at their quarters: 0.125/n^2 too stiff"),
    );
    Ok(())
}

/// Under the force P = E'I/L^2, which turns the tip by 26 degrees; a row of the table.
fn rotated(
    beam: &Beam,
    name: &str,
    index: usize,
    fault: &Fault,
    outcome: &mut Outcome,
) -> Result<Vec<f64>, RungFailure> {
    let e = beam.exact();
    let at = beam.tip();
    let force = e.bending_stiffness() / (at * at);
    let [_, shortening, bending] = elastica(1.0);
    let deflection = bending + force / e.shear_stiffness();
    let rest = settle(beam, Load::Tip(force), fault)?;
    let measured = [rest.tip[0] / at, -rest.tip[1] / at];
    if beam.cells == 6 {
        let source = "elastica, Bisshopp and Drucker 1945, with Timoshenko's shear";
        outcome.check(
            Check::value(
                format!("{name}, elastica, L/t = 10, 6 cells: deflection over L"),
                measured[0],
                deflection,
                "1",
            )
            .within(
                Tolerance::Relative(0.02),
                "1 % of grid, as at small deflection, 0.5 % of clamp, strains of 5 % squared",
            )
            .from(Kind::Analytic, source),
        );
        outcome.check(
            Check::value(
                format!("{name}, elastica, L/t = 10, 6 cells: shortening over L"),
                measured[1],
                shortening,
                "1",
            )
            .within(Tolerance::Relative(0.04), "quadratic in the deflection: twice its tolerance")
            .from(Kind::Analytic, source),
        );
    }
    let [across, along] = measured;
    Ok(vec![index as f64, beam.cells as f64, across, deflection, along, shortening, rest.kinetic])
}
