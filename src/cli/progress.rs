//! Progress of a run: a bar on a terminal, plain lines elsewhere.

use super::tell;
use checkdam::run::{Progress, Stage};
use checkdam::study;
use indicatif::{ProgressBar, ProgressStyle};
use std::collections::BTreeMap;
use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

/// Steps of the bar.
const TICKS: u64 = 1000;
/// Time between plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(5);

/// Shows how far a run is.
pub struct Display {
    bar: Option<ProgressBar>,
    stage: Option<Stage>,
    stage_start: Instant,
    stage_first_step: u64,
    last: Instant,
}

impl Display {
    /// A display on the standard error stream.
    pub fn new() -> Self {
        let bar = stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(TICKS);
            if let Ok(style) = ProgressStyle::with_template("{prefix:>7} [{bar:30}] {msg}") {
                bar.set_style(style.progress_chars("=> "));
            }
            bar
        });
        let now = Instant::now();
        Self {
            bar,
            stage: None,
            stage_start: now,
            stage_first_step: 0,
            last: now.checked_sub(LINE_INTERVAL).unwrap_or(now),
        }
    }

    /// Shows `p`; called often, draws seldom.
    pub fn show(&mut self, p: &Progress) {
        let now = Instant::now();
        let new_stage = self.stage != Some(p.stage);
        if new_stage {
            self.stage = Some(p.stage);
            self.stage_start = now;
            self.stage_first_step = p.steps;
        }
        let interval = if self.bar.is_some() { Duration::from_millis(100) } else { LINE_INTERVAL };
        if !new_stage && now - self.last < interval {
            return;
        }
        self.last = now;
        let seconds = (now - self.stage_start).as_secs_f64();
        let share = (p.time / p.end).clamp(0.0, 1.0);
        let rate = if seconds > 0.0 { (p.steps - self.stage_first_step) as f64 / seconds } else { 0.0 };
        let mut text = match p.stage {
            Stage::Settle => format!("t {:.3} s, residual {:.1e}", p.time, p.residual),
            Stage::Tilt => format!("t {:.3} of {:.3} s", p.time, p.end),
            Stage::Run => format!(
                "t {:.3} of at most {:.3} s, force {:.1} N, kinetic {:.2} % of E0",
                p.time,
                p.end,
                p.force,
                100.0 * p.residual
            ),
        };
        if seconds > 0.5 {
            text += &format!(", {rate:.0} steps/s");
            let left = remaining(seconds * (1.0 - share) / share);
            match p.stage {
                Stage::Settle => {}
                Stage::Tilt => text += &format!(", {left} left"),
                Stage::Run => text += &format!(", at most {left} left"),
            }
        }
        match &self.bar {
            Some(bar) => {
                bar.set_prefix(p.stage.name());
                bar.set_position((share * TICKS as f64) as u64);
                bar.set_message(text);
            }
            None => tell!("{:>7}: {text}", p.stage.name()),
        }
    }

    /// Removes the bar.
    pub fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Shows how far a study is: one bar over all runs, or a line when a run ends.
pub struct StudyDisplay {
    bar: Option<ProgressBar>,
    start: Instant,
    last: Instant,
    /// Share of each run that is on the way, by its number.
    inside: BTreeMap<usize, f64>,
}

impl StudyDisplay {
    /// A display of so many runs on the standard error stream.
    pub fn new(total: usize) -> Self {
        let bar = stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(TICKS);
            if let Ok(style) = ProgressStyle::with_template("[{bar:30}] {msg}") {
                bar.set_style(style.progress_chars("=> "));
            }
            bar.set_message(format!("0 of {total} runs"));
            bar
        });
        let now = Instant::now();
        Self { bar, start: now, last: now, inside: BTreeMap::new() }
    }

    /// Shows `p`; called often, draws seldom.
    pub fn show(&mut self, p: &study::Progress) {
        match p.inside {
            // Settling and tilting count as a tenth; a run may come to rest before its end.
            Some(i) => self.inside.insert(
                p.run.number,
                if i.stage == Stage::Run { 0.1 + 0.9 * (i.time / i.end).clamp(0.0, 1.0) } else { 0.05 },
            ),
            None => self.inside.remove(&p.run.number),
        };
        let now = Instant::now();
        if p.ended.is_none() && (self.bar.is_none() || now - self.last < Duration::from_millis(100)) {
            return;
        }
        self.last = now;
        let seconds = (now - self.start).as_secs_f64();
        let done = (p.finished - p.earlier) as f64 + self.inside.values().sum::<f64>();
        let left =
            if done > 0.0 { remaining(seconds * ((p.total - p.earlier) as f64 - done) / done) } else { "?".into() };
        let text = format!("{} of {} runs, about {left} left", p.finished, p.total);
        match (&self.bar, p.ended) {
            (Some(bar), _) => {
                bar.set_position((p.finished as f64 / p.total as f64 * TICKS as f64) as u64);
                bar.set_message(format!("{text}; {}", p.run.what));
            }
            (None, Some(ended)) => tell!("{text}; {}: {ended}", p.run.what),
            (None, None) => {}
        }
    }

    /// Removes the bar.
    pub fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Shows words that change: in place on a terminal, a line every few seconds elsewhere.
pub struct Words {
    bar: Option<ProgressBar>,
    last: Option<Instant>,
}

impl Words {
    /// On the standard error stream.
    pub fn new() -> Self {
        Self { bar: stderr().is_terminal().then(ProgressBar::new_spinner), last: None }
    }

    /// Shows `text`, if it says anything; called often, draws seldom.
    pub fn show(&mut self, text: &str) {
        let now = Instant::now();
        let interval = if self.bar.is_some() { Duration::from_millis(100) } else { LINE_INTERVAL };
        if text.is_empty() || self.last.is_some_and(|last| now - last < interval) {
            return;
        }
        self.last = Some(now);
        match &self.bar {
            Some(bar) => {
                bar.set_message(text.to_string());
                bar.tick();
            }
            None => tell!("      {text}"),
        }
    }

    /// Removes them.
    pub fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A time in words.
pub fn remaining(seconds: f64) -> String {
    match seconds {
        s if s < 9.5 => format!("{:.1} s", s.max(0.1)),
        s if s < 90.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86_400.0),
    }
}
