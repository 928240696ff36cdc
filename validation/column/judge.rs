//! What must hold, and what stands beside the data.

use super::plan::{self, CASES, CHANGES, Case, Planned, STEEP_DEG, friction_angles, numbers};
use super::verdict::{Ours, Recorded, sentence};
use crate::data::{self, Datum};
use checkdam::check::{Check, Expected, Kind, Tolerance};
use checkdam::theory::collapse::slope_run_out;
use checkdam::theory::sliding_block::sliding_acceleration;
use checkdam_verification::release::{Deposit, GRAVITY};
use checkdam_verification::report::{number, table_csv};
use checkdam_verification::{Fault, Outcome, RungFailure};

/// What any collapse must satisfy, whatever a laboratory says.
pub fn deposit(run: &Planned, deposit: &Deposit, rows: &[Recorded], outcome: &mut Outcome) {
    let (name, [_, h0]) = (run.case.name, run.case.size);
    let mut check = |c: Check| outcome.check(c);
    check(
        Check::value(format!("{name}: force on the bed over weight, at rest"), deposit.base, 1.0, "1")
            .within(Tolerance::Relative(0.01), "at rest but for creeping grains: 1e-6 of the energy")
            .from(Kind::Conservation, "Newton's third law"),
    );
    check(
        Check::at_most(format!("{name}: momentum not accounted for"), deposit.closure, 1e-10, "1")
            .because("booked node by node; only round-off remains")
            .from(Kind::Conservation, "Newton's second law"),
    );
    check(
        Check::at_most(format!("{name}: energy not accounted for over m g h0 and what gravity gives"), deposit.residual, 0.05, "1")
            .because("a rough bed stops its nodes anew in every step, and what is of second order in that is booked nowhere: a tenth of a per cent on a bed that slides, up to 3.3 % seen here on the coarsest grid")
            .from(Kind::Conservation, "first law"),
    );
    check(
        Check::at_most(format!("{name}: kinetic energy left over m g h0"), deposit.kinetic, 1e-4, "1")
            .because("a collapse takes some 4 sqrt(h0/g) on level ground and 15 on 19 degrees; the run lasts up to 40")
            .from(Kind::Measured, "Lube et al. 2005"),
    );
    let [low, high] = friction_angles(run.case.grains);
    let slope = run.column.slope;
    let heap = slope_run_out(h0, slope, high, 0.25).min(slope_run_out(h0, slope, low, 0.25));
    let dam_break = slope_run_out(h0, slope, low, 1.0);
    {
        check(
            Check::new(format!("{name}: run-out of the tip"), deposit.run_out[1], Expected::Within(heap, dam_break), "m")
                .because("a deposit no steeper than its friction angle, and a dam break with friction that never runs out of material")
                .from(Kind::Analytic, "equilibrium of a heap; Mangeney, Heinrich and Roche 2000"),
        );
    }
    // What was recorded is what this program computes.
    let recorded = rows.iter().find(|r| r.case == name && r.cells == run.cells && r.change == run.change);
    let ours = numbers(&run.column, deposit);
    let difference = recorded
        .map_or(f64::NAN, |r| r.numbers[..4].iter().zip(ours).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max));
    check(
        Check::at_most(
            format!("{name}: lengths against the record, largest relative difference"),
            difference,
            1e-7,
            "1",
        )
        .because("the same bits on every machine; the record has nine digits")
        .from(Kind::Golden, "runs/columns.csv"),
    );
}

/// At 30 degrees everything slides: the bed carries what friction allows and the mass accelerates as a block does, wherever the
/// bed may slide. On a rough bed a thin layer is braked by more than its own strength, the less the finer the grid: a table.
///
/// # Errors
/// Where the solver gives up.
pub fn steep(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    let [low, high] = friction_angles("slope");
    let friction = libm::tan(0.5 * (low + high));
    let [ratio, acceleration] = plan::steep(10, true).on_the_bed(0.8, 1.2, fault)?;
    let block = sliding_acceleration(GRAVITY, STEEP_DEG.to_radians(), friction);
    let reason = "all of the mass slides by then, and what the wall still touches is less than a cell's sand";
    outcome.check(
        Check::value("steep: shear over normal force on a bed that slides", ratio, friction, "1")
            .within(Tolerance::Relative(0.02), reason)
            .from(Kind::Analytic, "Coulomb's law"),
    );
    outcome.check(
        Check::value("steep: acceleration of all the mass on a bed that slides", acceleration, block, "m/s2")
            .within(
                Tolerance::Relative(0.06),
                format!("{reason}; 2 % of the friction is 7 % of the difference that accelerates"),
            )
            .from(Kind::Analytic, "g (sin - mu cos)"),
    );
    if *fault == Fault::NONE {
        let mut rows = Vec::new();
        for cells in [10, 20] {
            let rough = plan::steep(cells, false).on_the_bed(0.5, 0.6, fault)?;
            let slides = plan::steep(cells, true).on_the_bed(0.5, 0.6, fault)?;
            rows.push(vec![cells as f64, rough[0] / friction, slides[0] / friction, rough[1], slides[1], block]);
        }
        let header = [
            "cells",
            "rough_bed_shear_over_strength_1",
            "sliding_bed_shear_over_strength_1",
            "rough_bed_acceleration_m_per_s2",
            "sliding_bed_acceleration_m_per_s2",
            "block_acceleration_m_per_s2",
        ];
        outcome.tables.push(("column_slope_bed".into(), table_csv(&header, rows)));
    }
    Ok(())
}

/// Cases that a datum belongs to.
fn case_of(datum: &Datum) -> Option<&'static Case> {
    let aspect = datum.quantity.rsplit_once(" at ").map(|(_, a)| a).filter(|a| a.starts_with("a = "));
    CASES.iter().find(|c| match aspect {
        Some(a) => c.name == format!("{} {a}", datum.case),
        None => c.name == datum.case,
    })
}

/// Whether a datum is judged: not where it was not read in a source.
fn judged(datum: &Datum) -> bool {
    datum.kind == "measured" && datum.note != "not judged"
}

/// All data of one validation with ours.
fn compared(inclined: bool, rows: &[Recorded]) -> Vec<(Datum, &'static Case, Ours, f64)> {
    let own = data::rows(data::COLUMNS).into_iter().filter_map(|d| {
        let case = case_of(&d).filter(|c| (c.grains == "slope") == inclined)?;
        let of = d.ours.as_ref()?;
        // The length that scales the datum: our lengths are over r0.
        let scale = if d.unit == "m" { case.size[0] } else { 1.0 };
        // Inputs were changed on the column of the same grains as long as it is high, and on the slopes of 0 and 16 degrees.
        let changed = match case.grains {
            "slope" if case.slope_deg > 0.0 => "slope 16",
            "slope" => "slope 0",
            grains => CASES.iter().find(|c| c.grains == grains && c.changed_on.is_some())?.name,
        };
        let ours = Ours::new(rows, case.name, case.cells, of, changed);
        Some((d, case, ours, scale))
    });
    own.collect()
}

/// Compares with the data: a table, and checks where a measurement was read in a source.
pub fn against_data(name: &str, inclined: bool, rows: &[Recorded], outcome: &mut Outcome) {
    let mut text = String::from(
        "id,case,quantity,unit,kind,judged,data,u_data,coarse,medium,fine,trend,order_1,error,error_percent,u_num,u_input,u_val,error_over_2_u_val,largest_input,verdict\n",
    );
    for (datum, case, ours, scale) in compared(inclined, rows) {
        let [coarse, medium, fine] = ours.grids;
        let data = datum.value / scale;
        let error = fine - data;
        let u = ours.uncertainty(&datum, scale);
        let (u_data, u_val) = (u.data, u.validation());
        let head = [data, u_data, coarse, medium, fine].map(number).join(",");
        let tail = [error, 100.0 * error / data, ours.numerical, ours.input, u_val, error.abs() / (2.0 * u_val)];
        let tail = tail.map(number).join(",");
        let order = if ours.study.order.is_nan() { String::new() } else { number(ours.study.order) };
        let judged = judged(&datum);
        text += &format!(
            "{},{},{},1,{},{},{head},{},{order},{tail},{},{}\n",
            datum.id,
            case.name,
            datum.quantity,
            datum.kind,
            if judged { "yes" } else { "no" },
            ours.study.trend.name(),
            ours.largest_input,
            sentence(&ours, &datum, scale),
        );
        if judged {
            outcome.check(
                Check::value(format!("{}: {}, over r0", case.name, datum.quantity), fine, data, "1")
                    .within(
                        Tolerance::Absolute(2.0 * u_val),
                        "twice the standard uncertainty from grids and repetitions, inputs and data together",
                    )
                    .from(Kind::Measured, &*datum.place),
            );
        }
    }
    outcome.tables.push((format!("{name}_verdict"), text));
    if inclined { slopes(rows, outcome) } else { scaling(rows, outcome) }
}

fn fine(rows: &[Recorded], case: &str, column: &str) -> f64 {
    let own = rows.iter().filter(|r| r.case == case && r.change == "base");
    own.max_by_key(|r| r.cells).map_or(f64::NAN, |r| r.get(column))
}

/// How the run-out depends on the column and on the grains, where the definition of a front cancels.
fn scaling(rows: &[Recorded], outcome: &mut Outcome) {
    let tip = |case: &str| fine(rows, case, "run_out_tip_1");
    for grains in ["sand", "beads"] {
        let exponent = libm::log(tip(&format!("{grains} a = 1")) / tip(&format!("{grains} a = 0.5"))) / libm::log(2.0);
        outcome.check(
            Check::value(format!("{grains}: exponent of the run-out with a, 0.5 to 1"), exponent, 1.0, "1")
                .within(
                    Tolerance::Absolute(0.3),
                    "15 % of scatter at either end, independent of each other, over a factor of 2",
                )
                .from(Kind::Measured, "Lube et al. 2005, Lajeunesse et al. 2005: in proportion to a"),
        );
    }
    outcome.check(
        Check::value(
            "run-out of beads over that of sand, a = 1",
            tip("beads a = 1") / tip("sand a = 1"),
            1.8 / 1.2,
            "1",
        )
        .within(Tolerance::Relative(0.21), "15 % of scatter in either experiment, independent of each other")
        .from(Kind::Measured, "Lajeunesse et al. 2005, Lube et al. 2005"),
    );
}

/// How the run-out grows with the slope: what is left of the friction.
fn slopes(rows: &[Recorded], outcome: &mut Outcome) {
    let [low, high] = friction_angles("slope");
    let angle = 0.5 * (low + high);
    let level = fine(rows, "slope 0", "run_out_tip_1");
    for case in CASES.iter().filter(|c| c.slope_deg > 0.0) {
        let expected =
            slope_run_out(1.0, case.slope_deg.to_radians(), angle, 1.0) / slope_run_out(1.0, 0.0, angle, 1.0);
        outcome.check(
            Check::value(
                format!("{}: run-out of the tip over that on level ground", case.name),
                fine(rows, case.name, "run_out_tip_1") / level,
                expected,
                "1",
            )
            .within(
                Tolerance::Relative(0.25),
                "depth-averaged: columns as high as long are not shallow, and a rough bed holds half a cell back",
            )
            .from(Kind::Analytic, "tan(angle) / (tan(angle) - tan(slope)), dam break with friction"),
        );
    }
}

/// Grids, changed inputs, and what the figures need.
pub fn tables(name: &str, inclined: bool, runs: &[(&Planned, Deposit)], rows: &[Recorded], outcome: &mut Outcome) {
    let own = |case: &str| CASES.iter().find(|c| c.name == case && (c.grains == "slope") == inclined);
    let mut grids = String::from(
        "case,cells,cell_1,run_out_tip_1,run_out_mass_1,run_out_depth_1,height_1,arrived_1,base_force_1\n",
    );
    let mut changed =
        String::from("case,cause,change,run_out_tip_1,run_out_change_percent,height_1,height_change_percent\n");
    for row in rows.iter().filter(|r| own(&r.case).is_some()) {
        let lengths = ["run_out_tip_1", "run_out_mass_1", "run_out_depth_1", "height_1", "arrived_1", "base_force_1"];
        let cells = row.cells;
        if row.change == "base" {
            let values = lengths.map(|c| number(row.get(c))).join(",");
            grids += &format!("{},{cells},{},{values}\n", row.case, number(1.0 / cells as f64));
        } else if let Some(base) =
            rows.iter().find(|r| r.case == row.case && r.cells == row.cells && r.change == "base")
        {
            let cause = CHANGES.iter().find(|c| c.0 == row.change).map_or("", |c| c.1);
            let percent = |c: &str| number(100.0 * (row.get(c) / base.get(c) - 1.0));
            changed += &format!(
                "{},{},{},{},{},{},{}\n",
                row.case,
                if cause.is_empty() { "repetition" } else { cause },
                row.change,
                number(row.get("run_out_tip_1")),
                percent("run_out_tip_1"),
                number(row.get("height_1")),
                percent("height_1"),
            );
        }
    }
    let mut front = String::from("case,time_1,run_out_1\n");
    let mut profiles = String::from("case,x_m,depth_m\n");
    for (run, deposit) in runs {
        let time = (run.case.size[1] / checkdam_verification::release::GRAVITY).sqrt();
        for (t, run_out) in deposit.history.iter().filter(|s| s.0 < 20.0 * time).step_by(5) {
            front += &format!("{},{},{}\n", run.case.name, number(t / time), number(run_out[1] / run.case.size[0]));
        }
        for [x, depth] in &deposit.profile {
            profiles += &format!("{},{},{}\n", run.case.name, number(*x), number(*depth));
        }
    }
    let scaling = if inclined { slope_table(rows) } else { level_table(rows) };
    for (stem, text) in
        [("grids", grids), ("changed", changed), ("front", front), ("profiles", profiles), ("scaling", scaling)]
    {
        outcome.tables.push((format!("{name}_{stem}"), text));
    }
}

fn level_table(rows: &[Recorded]) -> String {
    let mut text = String::from("grains,aspect_ratio,run_out_1,run_out_measured_1,run_out_low_1,run_out_high_1\n");
    for (datum, case, ours, _) in compared(false, rows) {
        if datum.quantity.starts_with("run-out") {
            let (v, u) = (datum.value, datum.uncertainty);
            let values = [case.size[1] / case.size[0], ours.grids[2], v, v - u, v + u].map(number).join(",");
            text += &format!("{},{values}\n", case.grains);
        }
    }
    text
}

fn slope_table(rows: &[Recorded]) -> String {
    let mut text = String::from("slope_deg,run_out_m,run_out_law_m,run_out_dam_break_m,run_out_heap_m\n");
    let angles = friction_angles("slope");
    for (datum, case, ours, scale) in compared(true, rows) {
        if datum.quantity == "run-out by the fitted law" {
            let slope = case.slope_deg.to_radians();
            let bound = |angle: f64, k: f64| slope_run_out(case.size[1], slope, angle, k);
            let values =
                [case.slope_deg, ours.grids[2] * scale, datum.value, bound(angles[0], 1.0), bound(angles[1], 0.25)];
            text += &format!("{}\n", values.map(number).join(","));
        }
    }
    text
}
