//! Where ours stands in a run: a quantity of its summary, or a column of one of its tables, reduced to a number.

use crate::counterpart::Counterpart;
use checkdam::output::{OutputError, Table};
use checkdam::run::{Summary, TableText, columns};
use checkdam::study::quantities::{index, measure};
use std::path::Path;

/// Tables of a run that have a column `time_s`, without extension; `NAME` in one of them stands for that of a gauge.
fn tables() -> impl Iterator<Item = (&'static str, TableText)> {
    let timed = columns().into_iter().filter(|t| t.columns.iter().any(|c| c.name == "time_s"));
    timed.filter_map(|t| Some((t.file.strip_suffix(".csv")?, t)))
}

/// The table that is called so.
fn table_called(name: &str) -> Option<TableText> {
    let called = |pattern: &str| match pattern.split_once("NAME") {
        Some((before, after)) => {
            name.strip_prefix(before).and_then(|rest| rest.strip_suffix(after)).is_some_and(|n| !n.is_empty())
        }
        None => name == pattern,
    };
    tables().find(|(pattern, _)| called(pattern)).map(|(_, table)| table)
}

/// One number of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Number {
    /// From the quantities of its summary.
    Summary(Counterpart),
    /// From a table in its folder.
    Recorded {
        /// Name of the table, without extension.
        table: String,
        /// Its column.
        column: String,
        /// To one number.
        reduction: Reduction,
    },
}

/// How rows become one number.
#[derive(Debug, Clone, PartialEq)]
pub struct Reduction {
    /// Only rows that have this number in this column.
    pub only: Option<(String, f64)>,
    /// What of them.
    pub of: Of,
}

/// What of the rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Of {
    /// The last.
    Last,
    /// The largest value.
    Largest,
    /// The least value.
    Least,
    /// The mean of all, or between two times, s, both included.
    Mean(f64, f64),
    /// The first at a time, s, or after it.
    At(f64),
    /// The height, m, above which the last field has at least this value at a place along x.
    Height(f64),
}

/// What a reduction may be.
const REDUCTIONS: &str = "`last`, `largest`, `least`, `mean`, `mean 0.5 to 1.0` or `at 0.5` (s), and after it ` where x_m = 0.2` for rows of one place; of a field also `height of 0.2 where x_m = 0.06`";

impl Reduction {
    /// From its text.
    ///
    /// # Errors
    /// What is wrong, and what it may be.
    pub fn parse(text: &str) -> Result<Self, [String; 2]> {
        let fail = || [format!("`reduction` is `{text}`, which is none"), format!("write {REDUCTIONS}")];
        let number = |word: &str| word.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(fail);
        let (of, only) = text.split_once(" where ").map_or((text, None), |(of, only)| (of, Some(only)));
        let of = match of.split_whitespace().collect::<Vec<_>>()[..] {
            ["last"] => Of::Last,
            ["largest"] => Of::Largest,
            ["least"] => Of::Least,
            ["mean"] => Of::Mean(f64::NEG_INFINITY, f64::INFINITY),
            ["mean", from, "to", to] => Of::Mean(number(from)?, number(to)?),
            ["at", time] => Of::At(number(time)?),
            ["height", "of", level] if only.is_some_and(|o| o.trim_start().starts_with("x_m ")) => {
                Of::Height(number(level)?)
            }
            _ => return Err(fail()),
        };
        let only = match only.map(|o| o.split_whitespace().collect::<Vec<_>>()) {
            None => None,
            Some(words) => match words[..] {
                [column, "=", value] => Some((column.to_string(), number(value)?)),
                _ => return Err(fail()),
            },
        };
        Ok(Self { only, of })
    }

    /// The number that rows of a table give; NaN where there is none.
    fn of(&self, table: &Table, column: &str) -> Result<f64, OutputError> {
        let (times, values) = (table.column("time_s")?, table.column(column)?);
        if let (Of::Height(level), Some((_, x))) = (self.of, &self.only) {
            let cells = (table.column("x_m")?, table.column("y_m")?, values);
            return Ok(height(times, cells, level, *x));
        }
        let places = self.only.as_ref().map(|(c, x)| Ok::<_, OutputError>((table.column(c)?, *x))).transpose()?;
        let here = |k: &usize| places.is_none_or(|(at, x)| (at[*k] - x).abs() <= 1e-9 * x.abs().max(1e-3));
        let rows = (0..table.rows()).filter(here).map(|k| (times[k], values[k])).filter(|r| r.1.is_finite());
        let mut rows = rows.collect::<Vec<_>>().into_iter();
        Ok(match self.of {
            Of::Last => rows.last().map_or(f64::NAN, |r| r.1),
            Of::Largest => rows.map(|r| r.1).fold(f64::NAN, f64::max),
            Of::Least => rows.map(|r| r.1).fold(f64::NAN, f64::min),
            Of::At(time) => rows.find(|r| r.0 >= time * (1.0 - 1e-9)).map_or(f64::NAN, |r| r.1),
            Of::Height(_) => f64::NAN,
            Of::Mean(from, to) => {
                let inside: Vec<f64> = rows.filter(|r| (from..=to).contains(&r.0)).map(|r| r.1).collect();
                inside.iter().sum::<f64>() / inside.len() as f64
            }
        })
    }
}

/// The height at `x` above which the cells of the last time hold at least `level`: between the middles of cells along y, and between the
/// two columns of cells beside `x`. A column that holds it all the way has its lower end, one that holds it nowhere its upper end.
fn height(times: &[f64], (xs, ys, values): (&[f64], &[f64], &[f64]), level: f64, x: f64) -> f64 {
    let last = times.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let cells: Vec<[f64; 3]> =
        (0..times.len()).filter(|&k| times[k] == last).map(|k| [xs[k], ys[k], values[k]]).collect();
    let in_column = |place: f64| {
        let mut column: Vec<&[f64; 3]> = cells.iter().filter(|c| c[0] == place).collect();
        column.sort_by(|a, b| b[1].total_cmp(&a[1]));
        let half = 0.5 * column.windows(2).map(|w| w[0][1] - w[1][1]).fold(f64::INFINITY, f64::min);
        match (column.iter().position(|c| c[2] < level), column.last()) {
            (Some(0), _) => column[0][1] + half,
            (Some(k), _) => {
                let ([_, low, a], [_, high, b]) = (column[k], column[k - 1]);
                low + (high - low) * (level - a) / (b - a)
            }
            (None, Some(lowest)) => lowest[1] - half,
            (None, None) => f64::NAN,
        }
    };
    let left = cells.iter().map(|c| c[0]).filter(|&c| c <= x).fold(f64::NAN, f64::max);
    let right = cells.iter().map(|c| c[0]).filter(|&c| c >= x).fold(f64::NAN, f64::min);
    let share = if right > left { (x - left) / (right - left) } else { 0.0 };
    in_column(left) * (1.0 - share) + in_column(right) * share
}

impl Number {
    /// From the cells `ours` and `reduction`, of which the second may be empty.
    ///
    /// # Errors
    /// What is wrong, and what to do.
    pub fn parse(ours: &str, reduction: &str) -> Result<Self, [String; 2]> {
        let list = |names: &mut dyn Iterator<Item = &str>| names.collect::<Vec<_>>().join(", ");
        let of_a_table =
            ours.split_once('.').filter(|(table, _)| table_called(table).is_some() || !reduction.is_empty());
        let Some((table, column)) = of_a_table else {
            let fix = "name a quantity of a run, or two with +, -, * or / between, or a column of one of its tables as table.column with a reduction";
            if !reduction.is_empty() {
                let what = format!("`{ours}` has a reduction and is no column of a table");
                return Err([what, "write table.column, as stations.depth_m, or leave `reduction` empty".into()]);
            }
            let counterpart = Counterpart::parse(ours).map_err(|what| [what, fix.into()])?;
            if let Some(unknown) = counterpart.names().find(|name| index(name).is_none()) {
                let known = list(&mut checkdam::study::quantities::QUANTITIES.iter().map(|q| q.name));
                return Err([
                    format!("`ours` names `{unknown}`, which no run has"),
                    format!("the quantities are {known}"),
                ]);
            }
            return Ok(Self::Summary(counterpart));
        };
        let Some(described) = table_called(table) else {
            return Err([
                format!("`ours` names the table `{table}`, which no run has"),
                format!("the tables are {}", list(&mut tables().map(|(name, _)| name))),
            ]);
        };
        let known: Vec<&str> = described.columns.iter().map(|c| c.name).collect();
        // Columns that bear the name of a boundary are known once the case is.
        if !known.iter().any(|c| c.contains('{')) && !known.contains(&column) {
            let fix = format!("the columns are {}", list(&mut known.iter().copied()));
            return Err([format!("`ours` names `{column}`, which the table `{table}` has not"), fix]);
        }
        if reduction.is_empty() {
            return Err([format!("`{ours}` is a column, and `reduction` is empty"), format!("write {REDUCTIONS}")]);
        }
        Ok(Self::Recorded { table: table.into(), column: column.into(), reduction: Reduction::parse(reduction)? })
    }

    /// Of a run whose tables are in `folder`.
    ///
    /// # Errors
    /// A table or a column that is not there.
    pub fn of(&self, summary: &Summary, folder: &Path) -> Result<f64, OutputError> {
        match self {
            Self::Summary(counterpart) => {
                let values = measure(summary);
                Ok(counterpart.of(&|name| index(name).map_or(f64::NAN, |k| values[k])))
            }
            Self::Recorded { table, column, reduction } => {
                reduction.of(&Table::load(folder.join(format!("{table}.csv")))?, column)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_become_a_number() {
        let text = "time_s,x_m,depth_m\n0,0.2,3\n0,0.4,9\n1,0.2,5\n1,0.4,8\n2,0.2,4\n2,0.4,\n";
        let table = Table::parse(text, "stations.csv").expect("a table");
        let of = |text: &str| Reduction::parse(text).expect("a reduction").of(&table, "depth_m").expect("a number");
        assert_eq!(of("last where x_m = 0.2"), 4.0);
        assert_eq!([of("last where x_m = 0.4"), of("largest"), of("least")], [8.0, 9.0, 3.0]);
        assert_eq!([of("mean where x_m = 0.2"), of("mean 1 to 2 where x_m = 0.2")], [4.0, 4.5]);
        assert_eq!(of("at 0.5 where x_m = 0.2"), 5.0);
        assert!(of("last where x_m = 0.3").is_nan() && of("at 3").is_nan() && of("mean 5 to 6").is_nan());
    }

    #[test]
    fn a_field_has_a_height_at_each_place() {
        // Columns of cells of 1 m over x = 0.5, 1.5 and 2.5.
        let text = "time_s,x_m,y_m,shear\n0,0.5,0.5,9\n1,0.5,0.5,0\n1,0.5,1.5,0.4\n1,0.5,2.5,0.1\n\
                    1,1.5,0.5,0\n1,1.5,1.5,0.1\n1,1.5,2.5,0.5\n1,2.5,0.5,0.3\n1,2.5,1.5,0.3\n";
        let table = Table::parse(text, "field.csv").expect("a table");
        let of = |text: &str| Reduction::parse(text).expect("a reduction").of(&table, "shear").expect("a number");
        // From above the first cell below the level counts; here that is the top one, so nothing of the column is above.
        assert_eq!(of("height of 0.2 where x_m = 0.5"), 3.0);
        assert_eq!(of("height of 0.1 where x_m = 0.5"), 0.75);
        assert_eq!(of("height of 0.2 where x_m = 1.5"), 1.75);
        assert_eq!(of("height of 0.2 where x_m = 2.5"), 0.0);
        assert_eq!(of("height of 0.2 where x_m = 2.0"), 0.875);
        assert!(of("height of 0.2 where x_m = 9").is_nan());
        assert!(Reduction::parse("height of 0.2").is_err() && Reduction::parse("height of 0.2 where y_m = 1").is_err());
    }

    #[test]
    fn what_is_no_number_of_a_run_is_refused() {
        let wrong = [
            ("static_force", "", "`static_force`"),
            ("static_force_n", "last", "no column of a table"),
            ("profile.depth_m", "last", "the table `profile`"),
            ("history.depth_m", "last", "`depth_m`"),
            ("stations.depth_m", "", "`reduction` is empty"),
            ("stations.depth_m", "median", "`median`"),
            ("stations.depth_m", "last where x_m 0.2", "which is none"),
            ("a b", "", "`a b`"),
        ];
        for (ours, reduction, named) in wrong {
            let [what, fix] = Number::parse(ours, reduction).expect_err(ours);
            assert!(what.contains(named) && !fix.is_empty(), "{what}");
        }
        assert!(Number::parse("peak_20ms_n / static_force_n", "").is_ok());
        assert!(Number::parse("0.5 * static_force_n", "").is_ok());
    }
}
