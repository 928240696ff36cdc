//! Two columns over time: the largest difference on the times that both have.

use super::judge::{Line, relative};
use checkdam::check::brief;
use checkdam::output::Table;

/// A column that varies by less than this share of itself does not vary: tables are written in nine digits.
const CONSTANT: f64 = 1e-8;

/// Whether a table has one row a time, in order.
pub fn is_series(table: &Table) -> bool {
    table.column("time_s").is_ok_and(|times| {
        !times.is_empty() && times.iter().all(|t| t.is_finite()) && times.windows(2).all(|pair| pair[0] < pair[1])
    })
}

/// Where two tables can be compared: from `first` to `last` (s).
pub struct Common {
    /// All times of both in that interval.
    times: Vec<f64>,
    /// What is to be said about times that only one has.
    pub note: String,
}

impl Common {
    /// Of two series; none if they have no time in common.
    pub fn of(tables: [&Table; 2]) -> Option<Self> {
        let times = tables.map(|table| table.column("time_s").unwrap_or_default());
        let ends = times.map(|t| t.last().copied().unwrap_or(f64::NEG_INFINITY));
        let first = times.iter().filter_map(|t| t.first().copied()).fold(f64::NEG_INFINITY, f64::max);
        let last = ends[0].min(ends[1]);
        let mut all: Vec<f64> = times.concat().into_iter().filter(|t| (first..=last).contains(t)).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        let note = if ends[0] == ends[1] {
            String::new()
        } else {
            format!("A ends at {} s, B at {} s", brief(ends[0]), brief(ends[1]))
        };
        (!all.is_empty()).then_some(Self { times: all, note })
    }

    /// The largest difference of a column, relative to `scale`, or to its range where there is none.
    pub fn line(&self, quantity: String, column: &str, tables: [&Table; 2], scale: Option<f64>) -> Line {
        let series = tables.map(|table| Some((table.column("time_s").ok()?, table.column(column).ok()?)));
        let [Some(a), Some(b)] = series else {
            return match series {
                [None, Some(_)] => Line::missing(quantity, "a column", 0),
                [Some(_), None] => Line::missing(quantity, "a column", 1),
                _ => Line::numbers(quantity, [f64::NAN; 2]).noted("is no column of numbers"),
            };
        };
        let scale = scale.unwrap_or_else(|| scale_of([a.1, b.1]));
        let mut largest: Option<(f64, f64, [f64; 2])> = None;
        let [mut neither, mut one] = [0usize; 2];
        for &time in &self.times {
            let pair = [a, b].map(|(times, values)| at(times, values, time));
            match (pair.map(f64::is_nan), relative(pair[0], pair[1], scale)) {
                ([true, true], _) => neither += 1,
                (_, None) => one += 1,
                (_, Some(difference)) => {
                    if largest.is_none_or(|(most, ..)| difference.abs() > most.abs()) {
                        largest = Some((difference, time, pair));
                    }
                }
            }
        }
        let of = format!("of {}", brief(scale));
        match largest {
            _ if one > 0 => Line::numbers(quantity, [f64::NAN; 2]).noted(format!("empty on one side at {one} times")),
            None => Line::texts(quantity, ["no value", "no value"]).noted("nothing to compare: empty on both sides"),
            Some((difference, time, pair)) => {
                let mut note = if difference == 0.0 { String::new() } else { format!("at {} s, {of}", brief(time)) };
                if neither > 0 {
                    note +=
                        &format!("{}empty on both sides at {neither} times", if note.is_empty() { "" } else { "; " });
                }
                Line::scaled(quantity, pair, scale).noted(note)
            }
        }
    }
}

/// What differences of two columns are relative to: the wider of their ranges; where neither varies, the larger magnitude.
pub fn scale_of(columns: [&[f64]; 2]) -> f64 {
    let (mut range, mut size): (f64, f64) = (0.0, 0.0);
    for column in columns {
        let finite = || column.iter().copied().filter(|v| v.is_finite());
        let [low, high] = [finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max)];
        if low <= high {
            range = range.max(high - low);
            size = size.max(high.abs()).max(low.abs());
        }
    }
    if range > CONSTANT * size { range } else { size }
}

/// The value at a time, between those of its neighbours along a straight line; NaN outside, and where a neighbour has none.
fn at(times: &[f64], values: &[f64], time: f64) -> f64 {
    let after = times.partition_point(|t| *t < time);
    match (after.checked_sub(1), times.get(after)) {
        (_, Some(t)) if *t == time => values[after],
        (Some(before), Some(t)) => {
            let share = (time - times[before]) / (t - times[before]);
            values[before] + share * (values[after] - values[before])
        }
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Table {
        Table::parse(text, "history.csv").expect("a table")
    }

    #[test]
    fn a_straight_line_is_itself_at_other_times() {
        let a = table("time_s,f_n\n0,0\n1,10\n2,20\n");
        let b = table("time_s,f_n\n0,0\n0.5,5\n1.5,15\n2.5,25\n");
        let common = Common::of([&a, &b]).expect("common times");
        let line = common.line("f".into(), "f_n", [&a, &b], None);
        assert!(!line.differs(0.0), "{line:?}");
        assert_eq!(common.note, "A ends at 2 s, B at 2.5 s");
    }

    #[test]
    fn the_largest_difference_is_found_with_its_time_and_side() {
        let a = table("time_s,f_n\n0,0\n1,100\n2,50\n");
        let b = table("time_s,f_n\n0,0\n1,103\n2,48\n");
        let line = Common::of([&a, &b]).expect("common").line("f".into(), "f_n", [&a, &b], None);
        // 3 of a range of 103.
        assert!(line.differs(0.029) && !line.differs(0.0292), "{line:?}");
        assert!(line.note.starts_with("at 1 s"), "{line:?}");
    }

    #[test]
    fn empty_cells_are_never_equal_in_silence() {
        let full = table("time_s,f_n\n0,0\n1,1\n2,2\n");
        let gap = table("time_s,f_n\n0,0\n1,\n2,2\n");
        let empty = table("time_s,f_n\n0,\n1,\n2,\n");
        let line = |a: &Table, b: &Table| Common::of([a, b]).expect("common").line("f".into(), "f_n", [a, b], None);
        assert!(line(&full, &gap).differs(0.9) && line(&gap, &full).differs(0.9) && line(&full, &empty).differs(0.9));
        assert!(line(&gap, &gap).note.contains("empty on both sides at 1 times"));
        assert!(line(&empty, &empty).note.contains("nothing to compare"));
    }

    #[test]
    fn a_column_on_one_side_counts() {
        let a = table("time_s,f_n\n0,0\n1,1\n");
        let b = table("time_s,g_n\n0,0\n1,1\n");
        assert!(Common::of([&a, &b]).expect("common").line("f".into(), "f_n", [&a, &b], None).differs(0.9));
    }

    #[test]
    fn what_does_not_vary_is_measured_by_its_size() {
        assert_eq!(scale_of([&[2.0, 2.0], &[2.0, 2.0]]), 2.0);
        assert_eq!(scale_of([&[0.0, 2.0], &[-1.0, 2.0]]), 3.0);
        assert_eq!(scale_of([&[f64::NAN], &[]]), 0.0);
    }
}
