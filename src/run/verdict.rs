//! Whether a run is to be trusted, and everything that deserves a second look: one list, from which the summary has its reasons
//! and its warnings.
//!
//! Each limit is argued where it stands, from `docs/limits.md` and `docs/error-bars.md`; `docs/results.md` lists them.
//!
//! Elsewhere: quality assurance, acceptance criteria.

use super::experiment::Experiment;
use super::note::{Kind, Note};
use super::records::Records;
use super::stage::End;
use super::summary::Summary;
use crate::body::Particle;
use crate::case::{self, Case};
use crate::gauge::flow::flowing;
use std::collections::BTreeMap;

/// Energy that may be missing, of what was released. The flume leaves 0.0004 +- 0.0001 of its E0 open on moved grids; a bowl and a
/// block whose contact was wrong left 0.04 and 0.05 (docs/limits.md, "Where boundaries act").
const ENERGY_OPEN: f64 = 0.02;
/// Momentum closes to round-off, of all impulses: 1e-15 is seen.
const MOMENTUM_OPEN: f64 = 1e-10;
/// Material may lie so deep in a boundary, cells: contact is felt up to a cell before it touches (docs/limits.md, "Contact").
const PENETRATION_CELLS: f64 = 1.0;
/// Mass that may be lost, of all mass: what a case may miss of its `mass_kg`.
const MASS_LOST: f64 = 1e-3;
/// Depth of the front before the barrier, cells. With 1.6 cells the peak over 20 ms of the flume was 43 % too high and its static force 17 %
/// too low, with 2.9 cells 1 and 4 % (`validation/flume/runs/baseline.csv`); nothing was measured between.
const FRONT_CELLS: f64 = 2.0;
/// What the points say that they fill may differ so much from the cells that they fill inside the flow, either way. Static force
/// goes with the square of the depth: twice as much, what the grid makes of the static force from 20 to 10 mm (error-bars.md).
const VOLUME_OFF: f64 = 0.1;
/// Material just beyond a section moves at least at this share of the velocity at which it enters. Between a supercritical flow and the
/// deposit that it runs into, the velocity falls to a small part of that (a shock); half of it lies between the two.
const DROWNED: f64 = 0.5;
/// Cells inside the flow from which volumes are compared: fewer say nothing.
const INSIDE_CELLS: usize = 20;
/// PIC is there to take noise, not energy: it may take as much as grids of 5 and 10 mm differ in the depth of a front (error-bars.md).
const PIC_SHARE: f64 = 0.1;

impl Summary {
    /// Of a run that ended.
    pub fn new(case: &Case, experiment: &Experiment, records: &Records, end: End) -> Self {
        let status = match end {
            End::Rest => "completed: at rest",
            End::Time => "completed: end time reached before rest",
            End::Stopped => "stopped by the user; everything computed until then is here",
        };
        Self::build(case, experiment, records, status.into()).judged(experiment, records, Some(end))
    }

    /// Of a run that failed.
    pub fn failed(case: &Case, experiment: &Experiment, records: &Records, error: &str) -> Self {
        Self::build(case, experiment, records, format!("failed: {error}")).judged(experiment, records, None)
    }

    fn judged(mut self, experiment: &Experiment, records: &Records, end: Option<End>) -> Self {
        let (reasons, warnings): (Vec<_>, Vec<_>) =
            notes(&self, experiment, records, end).into_iter().partition(|note| note.kind.doubts());
        self.trusted = reasons.is_empty();
        self.reasons = reasons.into_iter().map(|note| note.text).collect();
        self.warnings = warnings.into_iter().map(|note| note.text).collect();
        self
    }
}

/// All notes on a run, those that doubt it first.
fn notes(summary: &Summary, experiment: &Experiment, records: &Records, end: Option<End>) -> Vec<Note> {
    let mut notes = Vec::new();
    let mut add = |kind: Kind, text: String| notes.push(Note { kind, text });
    ending(summary, experiment, end, &mut add);
    ledgers(summary, experiment, records, &mut add);
    cells(summary, &mut add);
    barriers(summary, experiment, end == Some(End::Rest), &mut add);
    notes.sort_by_key(|note| !note.kind.doubts());
    notes
}

fn ending(summary: &Summary, experiment: &Experiment, end: Option<End>, add: &mut impl FnMut(Kind, String)) {
    let forces = summary.barrier.is_some() || summary.deposit.is_some();
    match end {
        None => add(Kind::Failed, summary.status.clone()),
        Some(End::Stopped) => add(Kind::Stopped, "the run was stopped before its end".into()),
        Some(End::Time) if forces => add(
            Kind::Rest,
            "the material was not seen to come to rest: static values are means over the last 0.3 s, no more".into(),
        ),
        Some(End::Time) => add(Kind::Motion, "the material was not seen to come to rest".into()),
        Some(End::Rest) => {}
    }
    if end.is_some_and(|end| end != End::Rest) {
        for gate in experiment.simulation().boundaries().iter().filter(|b| b.is_opening()) {
            add(Kind::Opening, format!("gate `{}` was still opening when the run ended", gate.name));
        }
    }
    if let Some(inflow) = &summary.inflow {
        for name in inflow.unfinished.iter().filter(|_| end.is_some()) {
            add(Kind::Unfinished, format!("inflow `{name}` had not ended when the run ended"));
        }
        let beyond = inflow.velocity_beyond_1;
        if beyond.is_nan() || beyond < DROWNED {
            let text = format!(
                "beyond the section of an inflow the material had slowed down to {:.0} % of the velocity at which it enters: the section was \
                 drowned, and what followed was pushed into a deposit; move the section upstream",
                100.0 * beyond
            );
            add(Kind::Drowned, text);
        }
    }
    let (wanted, reached) = (summary.case.stages.settle.as_ref(), summary.stepping.settle_residual);
    if let Some(wanted) = wanted.map(|s| s.residual)
        && (reached.is_nan() || reached > wanted)
        && end.is_some_and(|end| end != End::Stopped)
    {
        add(
            Kind::Settling,
            format!("the material was released before it had settled: residual {reached:.1e}, wanted {wanted:.1e}"),
        );
    }
}

fn ledgers(summary: &Summary, experiment: &Experiment, records: &Records, add: &mut impl FnMut(Kind, String)) {
    let h = experiment.simulation().spacing();
    let mass = summary.mass_kg();
    // A motion that lowers the material by less than a cell is none that the grid resolves.
    let least = mass * summary.case.gravity.magnitude_m_per_s2 * h;
    let released = summary.energy.released_j.max(least);
    // What is not a number is not small.
    let worst = |a: f64, b: f64| if b.is_nan() { f64::INFINITY } else { a.max(b) };
    let missing = records.energy.iter().map(|r| r.balance.residual.abs()).fold(0.0, worst);
    if released > 0.0 && missing > ENERGY_OPEN * released {
        add(
            Kind::Energy,
            format!(
                "energy does not close: {:.2} % of what was released is not accounted for",
                100.0 * missing / released
            ),
        );
    }
    let pic = records.energy.last().map_or(0.0, |r| r.balance.pic);
    if released > 0.0 && pic > PIC_SHARE * released {
        add(
            Kind::Pic,
            format!("PIC took {:.0} % of the energy that was released: use a smaller share", 100.0 * pic / released),
        );
    }
    if summary.momentum.momentum_closure_1 > MOMENTUM_OPEN {
        let closure = summary.momentum.momentum_closure_1;
        add(Kind::Momentum, format!("momentum does not close: {closure:.1e} of all impulses"));
    }
    let deep = summary.momentum.penetration_m / h;
    if deep > PENETRATION_CELLS {
        add(Kind::Penetration, format!("material lay {deep:.1} cells deep inside a boundary or the barrier"));
    }
    let lost = summary.momentum.outflow_kg;
    if lost > 0.0 {
        let kind = if lost > MASS_LOST * mass { Kind::Mass } else { Kind::Grains };
        add(kind, format!("{lost:.4} kg left the domain"));
    }
    let outside = outside_domain(experiment);
    if outside > 0.0 {
        add(Kind::Mass, format!("{outside:.4} kg of a body that moves by a mesh of its own lie outside the domain"));
    }
    if let Some(ratio) = tracked_over_occupied(experiment)
        && (ratio - 1.0).abs() > VOLUME_OFF
    {
        add(
            Kind::Volume,
            format!("inside the flow the points fill {:.0} % of the cells that they occupy at the end", 100.0 * ratio),
        );
    }
}

/// Mass outside the domain, kg: of bodies with a mesh, which are not removed there.
fn outside_domain(experiment: &Experiment) -> f64 {
    let (sim, domain) = (experiment.simulation(), &experiment.case().domain);
    let is_inside =
        |p: &Particle| [domain.x_m, domain.y_m].iter().zip(p.x).all(|([low, high], x)| *low <= x && x <= *high);
    // Others are taken away when they are sorted next.
    let stays = |body: usize| sim.bodies()[body].mesh.is_some();
    sim.particles()
        .filter(|(body, p)| stays(*body) && !is_inside(p))
        .map(|(body, _)| sim.bodies()[body].point_mass)
        .sum()
}

/// The volume that the points say they have, over that of the cells they lie in, inside what flows: in cells all of whose neighbours
/// hold points. `None` if there are few.
fn tracked_over_occupied(experiment: &Experiment) -> Option<f64> {
    let sim = experiment.simulation();
    let (h, origin) = (sim.spacing(), experiment.case().grid.origin_m);
    let mut cells: BTreeMap<[i64; 2], f64> = BTreeMap::new();
    for (body, p) in flowing(sim, experiment.structures()) {
        let cell = [0, 1].map(|d| ((p.x[d] - origin[d]) / h).floor() as i64);
        *cells.entry(cell).or_default() += p.volume_ratio * sim.bodies()[body].point_volume;
    }
    let around = |[i, j]: [i64; 2]| (-1..=1).flat_map(move |a| (-1..=1).map(move |b| [i + a, j + b]));
    let inside = cells.iter().filter(|(cell, _)| around(**cell).all(|near| cells.contains_key(&near)));
    let (volume, count) = inside.fold((0.0, 0), |(sum, n), (_, volume)| (sum + volume, n + 1));
    let thickness = experiment.case().grid.thickness_m;
    (count >= INSIDE_CELLS).then(|| volume / (count as f64 * h * h * thickness))
}

fn cells(summary: &Summary, add: &mut impl FnMut(Kind, String)) {
    case::too_few_cells(&summary.case).into_iter().for_each(|what| add(Kind::Cells, what));
    if let Some(front) = summary.arriving_front() {
        let deep = front.depth_m / summary.case.grid.spacing_m;
        if deep < FRONT_CELLS {
            add(Kind::Front, format!("the front that reached the barrier was {deep:.1} cells deep: use smaller cells"));
        }
    }
}

fn barriers(summary: &Summary, experiment: &Experiment, at_rest: bool, add: &mut impl FnMut(Kind, String)) {
    let all = summary.mass_kg();
    if let Some(b) = &summary.barrier {
        b.note("the barrier", all * MASS_LOST, add);
    }
    if let Some([most, allowed]) = experiment.simulation().contact_sweeps()
        && most >= allowed
    {
        let text = format!("contact with a structure was not settled after {allowed} sweeps of a step");
        add(Kind::Sweeps, text);
    }
    if let Some(s) = &summary.structure {
        s.note("the barrier", add);
    }
    for further in &summary.further_barriers {
        let name = format!("barrier `{}`", further.name);
        further.barrier.iter().for_each(|b| b.note(&name, all * MASS_LOST, add));
        further.structure.iter().for_each(|s| s.note(&name, add));
    }
    if at_rest
        && let Some(d) = &summary.deposit
        && d.mobilised_1.abs() < 0.9
        && let Some([low, high]) = d.equilibrium_limits_n
    {
        add(
            Kind::Locked,
            format!(
                "the base mobilises {:.0} % of its friction at rest: any force between {low:.1} and {high:.1} N is in equilibrium, \
                 and which one it is depends on the history",
                100.0 * d.mobilised_1
            ),
        );
    }
}

#[cfg(test)]
#[path = "verdict_tests.rs"]
mod tests;
