//! Hertzian contact: an elastic body with a wavy face is pressed on a rigid flat one, without friction.
//!
//! One wave between two planes of symmetry stands for a row of cylinders, for which Westergaard (1939) has the closed form. It is
//! that of Hertz while half widths are small against the wavelength: here 0.6 and 2.6 % wider under the same load. A row needs no
//! half space beside it, so cells can be small against the half width. The waves are low (a slope of 1 in 40, strains below 1 %);
//! columns of points are shifted up and down to follow them, which keeps areas.
//!
//! The flat body rises to where the closed form has its half width within half a period of the slowest wave up and down the body,
//! and stands for one and a half more under critical damping. What is measured is a mean over the last tenth of a period.
//!
//! Forces are read at nodes. Shape functions spread each over the nodes beside it, which takes sinc^2(kh/2), the transform of a hat, off
//! the mean of cos(kx). The half width is from the second moment without that: sin^2(pi a/wavelength) is four times the mean of sin^2(pi
//! x/wavelength). Forces of single nodes alternate; means (1, 2, 1)/4 do not.
//!
//! Tolerances are from the grid. Nodes on both sides of the surface are held together, so up to a cell of the body does not strain:
//! the flat body comes less far, by up to a cell times the strain in the middle. That falls with the cell size. Where the contact
//! ends is known to half a cell, which has no order: half widths come out 0.1 to 0.3 cells too small. The sharper estimate that
//! the load of the outermost cell is misplaced by a cell, 2.4 (h/a)^2.5 of the half width, is too hopeful at ten cells.

mod scene;

use super::scenes::usual;
use crate::report::{named_csv, table_csv};
use crate::{Fault, Outcome, RungFailure};
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::contact::rule::ContactRule;
use checkdam::theory::hertz::{self, Wavy, contact_modulus};
use scene::{BODY, Rest, WAVELENGTH, exact, press, read};
use std::f64::consts::PI;

/// Half widths that the closed form is asked for, m.
const WIDTHS: [f64; 2] = [0.0625, 0.125];
/// Cells to a wavelength.
const GRIDS: [usize; 2] = [40, 80];
const WESTERGAARD: &str = "theory::hertz::Wavy (Westergaard 1939)";

/// Means (1, 2, 1)/4 of what neighbours read.
fn smooth(of: impl Fn(usize) -> f64, c: usize) -> f64 {
    0.25 * (of(c - 1) + 2.0 * of(c) + of(c + 1))
}

/// Two loads on two grids; on the coarse one alone under a fault.
pub fn run(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let w = exact(contact_modulus(Some(&BODY.elastic), None));
    let grids = if *fault == Fault::NONE { &GRIDS[..] } else { &GRIDS[..1] };
    let (mut summary, mut profiles, mut all) = (Vec::new(), Vec::new(), Vec::new());
    for &cells in grids {
        let rests = press(cells, &WIDTHS, usual(0.0), fault)?;
        for (load, rest) in rests.iter().enumerate() {
            judge(&format!("Hertz, {cells} cells, load {}", load + 1), cells, rest, &w, outcome);
            let cylinder = hertz::half_width(rest.mean * WAVELENGTH, w.radius(), w.modulus);
            summary.push(vec![
                cells as f64,
                w.half_width(rest.mean) / WAVELENGTH * cells as f64,
                rest.mean,
                rest.travel_over_exact(&w),
                rest.width_over_exact(&w),
                rest.half_width / cylinder,
                rest.imbalance,
                rest.drift,
                rest.residual,
            ]);
            let (a, peak) = (w.half_width(rest.mean), w.pressure(rest.mean, 0.0));
            let at = |c: usize| rest.pressure[c][1];
            for c in (1..cells).filter(|&c| rest.pressure[c][0].abs() < 1.5 * a) {
                let x = rest.pressure[c][0];
                let row = [x / a, at(c) / peak, smooth(at, c) / peak, w.pressure(rest.mean, x) / peak];
                profiles.push([cells as f64, load as f64].into_iter().chain(row).collect());
            }
        }
        all.push(rests);
    }
    let [coarse, fine] = &all[..] else { return Ok(()) };
    converge(coarse, fine, &w, outcome);
    let header = [
        "cells_per_wavelength",
        "half_width_cells",
        "mean_pressure_pa",
        "travel_over_exact",
        "half_width_over_exact",
        "half_width_over_hertz",
        "imbalance",
        "drift",
        "ledger_residual",
    ];
    outcome.tables.push(("contact_hertz".into(), table_csv(&header, summary)));
    let header = [
        "cells_per_wavelength",
        "load",
        "x_over_half_width",
        "node_over_peak",
        "smoothed_over_peak",
        "exact_over_peak",
    ];
    let codes: [(&str, &[&str]); 1] = [("load", &["first", "second"])];
    outcome.tables.push(("contact_hertz_pressure".into(), named_csv(&header, &codes, profiles)));
    Ok(())
}

fn judge(name: &str, cells: usize, rest: &Rest, w: &Wavy, outcome: &mut Outcome) {
    let h = WAVELENGTH / cells as f64;
    let a = w.half_width(rest.mean);
    let (e, peak) = (BODY.elastic, w.pressure(rest.mean, 0.0));
    let strain = peak * (1.0 + e.poisson) * (1.0 - 2.0 * e.poisson) / e.young;
    let least = 1.0 - h * strain / rest.travel;
    outcome.check(
        Check::new(
            format!("{name}: travel over the closed form under that load"),
            rest.travel_over_exact(w),
            Expected::Within(least, 1.005),
            "1",
        )
        .because("up to a cell of the body does not strain; half a percent for depth, strain, settling")
        .from(Kind::Analytic, WESTERGAARD),
    );
    outcome.check(
        Check::value(
            format!("{name}: half width over the closed form under that load"),
            rest.width_over_exact(w),
            1.0,
            "1",
        )
        .within(Tolerance::Absolute(0.5 * h / a), "nodes say to half a cell where the contact ends")
        .from(Kind::Analytic, WESTERGAARD),
    );
    // The same load on a contact that is narrower by half a cell.
    let sine = |a: f64| libm::sin(PI * a / WAVELENGTH);
    let narrow = exact(w.modulus * (sine(a) / sine(a - 0.5 * h)).powi(2));
    let nodes: Vec<usize> = (1..cells).filter(|&c| rest.pressure[c][0].abs() < a + h).collect();
    let reads = |w: Wavy| move |c: usize| smooth(|c| read(&w, rest.mean, rest.pressure[c][0], h), c) / peak;
    let found = |c: usize| smooth(|c| rest.pressure[c][1], c) / peak;
    let rms = |a: &dyn Fn(usize) -> f64, b: &dyn Fn(usize) -> f64| {
        (nodes.iter().map(|&c| (a(c) - b(c)).powi(2)).sum::<f64>() / nodes.len() as f64).sqrt()
    };
    outcome.check(
        Check::at_most(
            format!("{name}: root mean square error of the pressure, (1, 2, 1)/4, over the peak"),
            rms(&found, &reads(*w)),
            rms(&reads(narrow), &reads(*w)),
            "1",
        )
        .because("that of the closed form with a contact narrower by half a cell on either side")
        .from(Kind::Analytic, WESTERGAARD),
    );
    outcome.check(
        Check::value(format!("{name}: force at the back over that of the contact"), rest.imbalance, 0.0, "1")
            .within(Tolerance::Absolute(5e-3), "what still moves: 1e-3 of the rise is left, and single steps ripple")
            .from(Kind::Conservation, "Newton's second law"),
    );
    outcome.check(
        Check::value(format!("{name}: change of the force over two tenths of a period"), rest.drift, 0.0, "1")
            .within(Tolerance::Absolute(2e-3), "it has come to rest: 1e-3 of the rise is left")
            .from(Kind::Conservation, "equilibrium"),
    );
    outcome.check(
        Check::at_most(format!("{name}: largest pull at a node"), rest.pull, 0.0, "N s")
            .because("contact does not hold back")
            .from(Kind::Analytic, "Signorini 1933"),
    );
}

/// How load goes with half width, and what a finer grid does.
fn converge(coarse: &[Rest], fine: &[Rest], w: &Wavy, outcome: &mut Outcome) {
    let sine = |r: &Rest| libm::sin(PI * r.half_width / WAVELENGTH);
    let ratio = libm::log(sine(&fine[1]) / sine(&fine[0]));
    let h = WAVELENGTH / GRIDS[1] as f64;
    outcome.check(
        Check::value(
            "Hertz: exponent of the load in sin(pi a/wavelength)",
            libm::log(fine[1].mean / fine[0].mean) / ratio,
            2.0,
            "1",
        )
        .within(Tolerance::Absolute(h / WIDTHS[0] / ratio), "half a cell at the smaller half width")
        .from(Kind::Analytic, WESTERGAARD),
    );
    for (load, (coarse, fine)) in coarse.iter().zip(fine).enumerate() {
        let [coarse, fine] = [coarse, fine].map(|r| r.travel_over_exact(w) - 1.0);
        outcome.check(
            Check::at_most(
                format!("Hertz, load {}: error of the travel on the fine grid over that on the coarse", load + 1),
                (fine / coarse).abs(),
                0.7,
                "1",
            )
            .because("first order in the cell size: 0.5, and where the nodes lie")
            .from(Kind::Convergence, WESTERGAARD),
        );
    }
}

/// Load over that of the closed form at the same travel, and half width over that under the same load, on a coarse grid with
/// other normals and gaps. Forces that are spread over more than the whole wave have no half width: NaN.
pub fn of_option(rule: ContactRule) -> Result<[f64; 2], RungFailure> {
    let w = exact(contact_modulus(Some(&BODY.elastic), None));
    let rests = press(32, &WIDTHS[1..], rule, &Fault::NONE)?;
    Ok([rests[0].mean / w.mean_pressure(WIDTHS[1]), rests[0].width_over_exact(&w)])
}
