//! When rows are read: those that numbers with a name come from, and those of the tables.

use crate::seeded::{self, Seed};

/// Rows a second that everything with a name in `summary.toml` comes from. They are no setting: a peak over 20 ms, an impulse or a time
/// to rest must not depend on how fine the tables are. Where steps are longer, a row is a step.
pub(super) const METER_HZ: f64 = 1000.0;
/// Length of such a row, s.
pub(super) const METER_S: f64 = 1.0 / METER_HZ;
/// Rows per row of the ledgers and stations.
const PER_LEDGER: u64 = 10;

/// Says when a row is due.
#[derive(Debug, Clone)]
pub(super) struct Clock {
    interval: f64,
    rows: u64,
    ledgers: u64,
}

impl Clock {
    /// So many rows a second, from zero on.
    pub fn new(rate_hz: f64) -> Self {
        Self { interval: seeded::times(Seed::RunClock, 1.0 / rate_hz), rows: 0, ledgers: 0 }
    }

    /// Whether a step that ended at `time` (s) ends a row.
    pub fn strikes(&mut self, time: f64) -> bool {
        if time < (self.rows + 1) as f64 * self.interval {
            return false;
        }
        self.rows = (time / self.interval) as u64;
        true
    }

    /// Whether a row of the ledgers is due with the row that has just ended.
    pub fn strikes_ten(&mut self) -> bool {
        let ledgers = self.rows / PER_LEDGER;
        std::mem::replace(&mut self.ledgers, ledgers) < ledgers
    }

    /// Whether no row has ended yet.
    pub fn is_silent(&self) -> bool {
        self.rows == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows and ledgers of a second of steps of `dt`.
    fn counted(rate: f64, dt: f64) -> (usize, usize) {
        let mut clock = Clock::new(rate);
        let steps = (1..).map(|k| f64::from(k) * dt).take_while(|t| *t <= 1.0 + 1e-12);
        let (mut rows, mut ledgers) = (0, 0);
        for time in steps {
            if clock.strikes(time) {
                rows += 1;
                ledgers += usize::from(clock.strikes_ten());
            }
        }
        (rows, ledgers)
    }

    #[test]
    fn rows_end_with_steps_and_none_of_the_ledgers_is_skipped() {
        assert_eq!(counted(1000.0, 1.0 / 8192.0), (1000, 100));
        // Steps of 4 ms: each is a row, and every third or second of them passes another hundredth of a second.
        assert_eq!(counted(1000.0, 1.0 / 256.0), (256, 100));
        assert_eq!(counted(1e5, 1.0 / 8192.0), (8192, 8192));
        assert_eq!(counted(20.0, 1.0 / 8192.0), (20, 2));
        assert!(Clock::new(1.0).is_silent());
    }
}
