//! Shares of the dissipation by place, from the record.

use super::THRESHOLDS;
use crate::Failure;
use crate::barrier::close_up::releases::{BARRIERS, Release, arrival, rows_of};
use checkdam::check::{Check, Kind, significant};
use checkdam::output::Table;

/// Columns of the record of the slip surface.
pub(in super::super) const COLUMNS: &str = "barrier,time_s,deposit_j,slip_deposit_j,slip_flow_j,flow_j,plastic_j,friction_base_j,\
                                            friction_barrier_j,side_walls_j,contact_j,pic_j,deposit_kg";
/// Of the plastic work in the ledger, what the sum over the points may miss: the ledger counts the barrier's work, too, which it stores to
/// second order in the step, and both leave out how far stress turns within a step.
pub const MISSED: f64 = 0.02;

/// Longer than a time step, s.
const STEP: f64 = 5e-4;

/// Places at which energy is dissipated after the arrival; "other" is loss of normal motion, PIC and what the points miss of the ledger.
pub const PLACES: [&str; 7] =
    ["deposit_1", "slip_surface_1", "flow_1", "friction_base_1", "friction_barrier_1", "side_walls_1", "other_1"];

/// Where the dissipation of a run is done, as shares of all of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Shares {
    /// Before the arrival, whatever the place.
    pub before: f64,
    /// After it, parallel to [`PLACES`].
    pub after: [f64; 7],
    /// When the deposit first has half of the mass that it has at the end, s after the arrival, and the part of the flow's share done
    /// until then: while there is little that it could slip on.
    pub half: [f64; 2],
    /// Through time: time (s), and shares since the release by place.
    pub path: Vec<(f64, [f64; 7])>,
    /// Plastic work of the ledger that the sum over the points misses, over that of the ledger at the end, largest.
    pub missed: f64,
}

impl Shares {
    /// Plastic work at the slip surface over all plastic work after the arrival.
    pub fn slip_of_plastic(&self) -> f64 {
        self.after[1] / self.after[..3].iter().sum::<f64>()
    }
}

/// Shares at a barrier that the flow meets at `arrival` (s).
pub fn shares(slip: &Table, barrier: &str, arrival: f64) -> Result<Shares, Failure> {
    let names: Vec<&str> = COLUMNS.split(',').collect();
    let columns = names[2..12].iter().map(|name| slip.column(name)).collect::<Result<Vec<_>, _>>()?;
    let (time, mass) = (slip.column("time_s")?, slip.column("deposit_kg")?);
    // By row: the places, J, and what the points miss.
    let places = |k: usize| {
        let [deposit, near, above, flow, plastic, base, on_barrier, side, contact, pic] =
            std::array::from_fn(|c| columns[c][k]);
        let missed = plastic - (deposit + near + above + flow);
        ([deposit, near + above, flow, base, on_barrier, side, contact + pic + missed], missed, plastic)
    };
    let own = rows_of(slip, barrier)?;
    let rows: Vec<_> = own.iter().map(|&k| (time[k], places(k))).collect();
    let end = rows.last().ok_or_else(|| Failure::Record(format!("nothing is on record of {barrier}")))?.1;
    let all: f64 = end.0.iter().sum();
    let path: Vec<_> = rows.iter().map(|(t, p)| (*t, p.0.map(|j| j / all))).collect();
    // One of the rows is that of the first step at or after the arrival.
    let at = path.iter().find(|p| (p.0 - arrival).abs() < STEP).map(|p| p.1);
    let at = at.ok_or_else(|| {
        let again = "make it anew with `checkdam validate --studies barrier_close_up`";
        Failure::Record(format!("the record of {barrier} has no row at the arrival after {arrival} s: {again}"))
    })?;
    let after = std::array::from_fn(|k| end.0[k] / all - at[k]);
    let whole = own.last().map_or(f64::NAN, |&k| mass[k]);
    let half = own.iter().position(|&k| mass[k] >= 0.5 * whole).map_or(path[0], |k| path[k]);
    let half = [half.0 - arrival, half.1[2] - at[2]];
    let missed = rows.iter().map(|(_, p)| p.1.abs() / end.2);
    let missed = missed.fold(0.0, |a: f64, x| if x.is_nan() || a.is_nan() { f64::NAN } else { a.max(x) });
    Ok(Shares { before: at.iter().sum(), after, half, path, missed })
}

/// The record is right if the sum over the points is what the ledger says.
pub fn check(release: &str, barrier: &str, shares: &Shares) -> Check {
    let what = format!(
        "{release}, {barrier}: plastic work that the sum over all points misses, largest, over that at the end"
    );
    Check::at_most(what, shares.missed, MISSED, "1")
        .because("the same midpoint rule, but for the barrier's own second-order error and turning stress")
        .from(Kind::Conservation, "plastic work of the ledger: total work less what is stored")
}

/// Header of the table of shares.
pub fn header() -> String {
    format!(
        "release,barrier,before_arrival_1,{},slip_of_plastic_1,half_deposit_after_s,flow_until_half_1,missed_1\n",
        PLACES.join(",")
    )
}

/// Where the dissipation after the arrival is done, a line a barrier, as shares of all of the run.
pub(in super::super) fn table(release: &Release, slip: &Table) -> Result<(String, Vec<Check>), Failure> {
    let (mut text, mut checks) = (String::new(), Vec::new());
    for (barrier, _) in BARRIERS {
        let s = shares(slip, barrier, arrival(release, barrier)?.time)?;
        let numbers = [&[s.before], &s.after[..], &[s.slip_of_plastic()], &s.half, &[s.missed]].concat();
        let cells: Vec<String> = numbers.iter().map(|x| significant(*x, 4)).collect();
        text += &format!("{},{barrier},{}\n", release.name, cells.join(","));
        checks.push(check(release.name, barrier, &s));
    }
    Ok((text, checks))
}

/// Shares since the release against time, for the figure.
pub(in super::super) fn paths(release: &Release, slip: &Table) -> Result<String, Failure> {
    let mut text = format!("barrier,time_s,{}\n", PLACES.join(","));
    for (barrier, _) in BARRIERS {
        for (time, parts) in shares(slip, barrier, arrival(release, barrier)?.time)?.path {
            let cells = parts.map(|x| significant(x, 5)).join(",");
            text += &format!("{barrier},{},{cells}\n", significant(time, 6));
        }
    }
    Ok(text)
}

/// Header of the table of thresholds.
pub const BY_THRESHOLD: &str = "release,barrier,rest_over_front_1,cells,deposit_1,slip_surface_1,flow_1\n";

/// Shares of the plastic work after the arrival by threshold.
pub(in super::super) fn thresholds(release: &Release, recorded: &Table) -> Result<String, Failure> {
    let column = |name: &str| recorded.column(name);
    let parts = [column("deposit_j")?, column("slip_deposit_j")?, column("slip_flow_j")?, column("flow_j")?];
    let (rest, cells) = (column("rest_over_front_1")?, column("cells")?);
    let barriers = recorded.cells("barrier")?;
    let line = |k: usize| {
        let [deposit, near, above, flow] = parts.map(|p| p[k]);
        let all = deposit + near + above + flow;
        let shares = [deposit, near + above, flow].map(|j| significant(j / all, 4)).join(",");
        format!("{},{},{},{},{shares}\n", release.name, barriers[k], rest[k], cells[k])
    };
    if recorded.rows() != BARRIERS.len() * THRESHOLDS.len() {
        return Err(Failure::Record("the record has other thresholds of the slip surface".into()));
    }
    Ok((0..recorded.rows()).map(line).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run that dissipates 20 J before the arrival at 0.5 s and 80 J after it; `factor` is what the sum over the points is off by.
    fn run(factor: f64) -> Shares {
        let row = |time: f64, work: [f64; 4], rest: [f64; 6]| {
            let cells = work.map(|w| (w * factor).to_string()).join(",");
            let deposit = 10.0 * time;
            format!("steel,{time},{cells},{},{deposit}\n", rest.map(|x| x.to_string()).join(","))
        };
        let text = format!("{COLUMNS}\n")
            + &row(0.0, [0.0; 4], [0.0; 6])
            + &row(0.5, [0.0, 0.0, 0.0, 10.0], [10.0, 8.0, 0.0, 1.0, 0.0, 1.0])
            + &row(1.0, [5.0, 10.0, 20.0, 15.0], [50.0, 28.0, 10.0, 6.0, 4.0, 2.0]);
        shares(&Table::parse(&text, "slip.csv").expect("a table"), "steel", 0.499_97).expect("shares")
    }

    #[test]
    fn a_record_of_another_arrival_is_refused() {
        let text = format!("{COLUMNS}\nsteel,0.5{}\n", ",1".repeat(11));
        let table = Table::parse(&text, "slip.csv").expect("a table");
        assert!(shares(&table, "steel", 0.499_9).is_ok() && shares(&table, "steel", 0.51).is_err());
    }

    #[test]
    fn shares_are_of_all_that_is_dissipated() {
        let s = run(1.0);
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(close(s.before, 0.2) && close(s.before + s.after.iter().sum::<f64>(), 1.0));
        let expected = [0.05, 0.3, 0.05, 0.2, 0.1, 0.05, 0.05];
        assert!(s.after.iter().zip(expected).all(|(a, b)| close(*a, b)), "{:?}", s.after);
        assert!(close(s.slip_of_plastic(), 0.75) && close(s.missed, 0.0));
        // Half of the deposit lies at the arrival.
        assert!(close(s.half[0], 0.500 - 0.499_97) && close(s.half[1], 0.0));
    }

    #[test]
    fn plastic_work_that_is_off_by_three_percent_fails() {
        for (factor, passes) in [(1.0, true), (1.01, true), (1.03, false), (0.97, false)] {
            assert_eq!(check("literal", "steel", &run(factor)).share_used() <= 1.0, passes, "{factor}");
        }
    }
}
