//! Faults on purpose, each at the place where it would arise, to ask who notices it.
//!
//! A site is one call in the code that it spoils: [`times`] for a wrong factor, [`exchanged`] for two numbers in each other's place,
//! [`is`] for what is left out. `Seed` in `table` names all of them, and a test finds each at exactly one site. Which one is at work is
//! said by an environment variable, `CHECKDAM_SEEDED_FAULT`, and read once; then the program says so, and `summary.toml` does.
//!
//! **Only tests have the switch.** It is there in builds with debug assertions, as `cargo test` makes them; without, as in releases and
//! benchmarks, all three are constants, and what is compiled is the code around them.
//!
//! Elsewhere: fault seeding (error seeding), mutation analysis with hand-made mutants.

mod table;

pub use table::{ALL, Seed};

/// Whether the switch is there.
pub const COMPILED: bool = cfg!(debug_assertions);

/// What a fault does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A number is this many times what it should be.
    Times(f64),
    /// Something is left out.
    Dropped,
    /// Two things stand in each other's place.
    Exchanged,
    /// Something else, which the words say.
    Wrong,
}

/// An entry of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entry {
    /// Which one.
    pub seed: Seed,
    /// Name: the room, a point, what.
    pub name: &'static str,
    /// What it does.
    pub kind: Kind,
    /// The same in words.
    pub what: &'static str,
}

impl Entry {
    /// The room of `src` whose numbers it spoils.
    pub fn room(&self) -> &'static str {
        self.name.split_once('.').map_or(self.name, |n| n.0)
    }
}

impl std::fmt::Display for Kind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Kind::Times(factor) => write!(f, "times {factor}"),
            Kind::Dropped => f.write_str("dropped"),
            Kind::Exchanged => f.write_str("exchanged"),
            Kind::Wrong => f.write_str("wrong"),
        }
    }
}

/// Place of the fault that is at work in [`ALL`] and one; zero if there is none.
#[cfg(debug_assertions)]
#[inline(always)]
fn number() -> usize {
    use std::sync::atomic::{AtomicUsize, Ordering};
    /// Nobody has asked yet.
    const UNREAD: usize = usize::MAX;
    static NUMBER: AtomicUsize = AtomicUsize::new(UNREAD);
    match NUMBER.load(Ordering::Relaxed) {
        UNREAD => {
            let number = read();
            NUMBER.store(number, Ordering::Relaxed);
            number
        }
        number => number,
    }
}

/// That number from the environment; all threads find the same.
#[cfg(debug_assertions)]
#[cold]
#[inline(never)]
fn read() -> usize {
    use std::io::Write;
    static READ: std::sync::OnceLock<usize> = std::sync::OnceLock::new();
    *READ.get_or_init(|| {
        let Ok(name) = std::env::var("CHECKDAM_SEEDED_FAULT") else { return 0 };
        let place = ALL.iter().position(|e| e.name == name);
        let Some(place) = place else { panic!("CHECKDAM_SEEDED_FAULT={name}: no such fault in src/seeded/table.rs") };
        // Past the capture of tests, too.
        let _ =
            writeln!(std::io::stderr(), "checkdam: wrong on purpose ({name}); no number of this run is to be trusted");
        place + 1
    })
}

/// The fault that is at work, if there is one.
#[cfg(debug_assertions)]
pub fn active() -> Option<&'static Entry> {
    ALL.get(number().checked_sub(1)?)
}

/// No fault is: this build has no switch.
#[cfg(not(debug_assertions))]
#[inline(always)]
fn number() -> usize {
    0
}

/// The fault that is at work: none, as this build has no switch.
#[cfg(not(debug_assertions))]
#[inline(always)]
pub fn active() -> Option<&'static Entry> {
    None
}

/// Whether this fault is at work.
#[inline(always)]
pub fn is(seed: Seed) -> bool {
    COMPILED && number() == seed as usize + 1
}

/// A number, or so many times that number where this fault is at work.
#[inline(always)]
pub fn times(seed: Seed, value: f64) -> f64 {
    if is(seed) { factor(seed) * value } else { value }
}

/// The wrong factor of a fault: as the table has it, or as much to the other side where `CHECKDAM_SEEDED_OTHER_SIDE` is set.
#[cold]
fn factor(seed: Seed) -> f64 {
    static OTHER_SIDE: std::sync::OnceLock<bool> = std::sync::OnceLock::new();
    match ALL[seed as usize].kind {
        Kind::Times(factor) if *OTHER_SIDE.get_or_init(|| std::env::var_os("CHECKDAM_SEEDED_OTHER_SIDE").is_some()) => {
            2.0 - factor
        }
        Kind::Times(factor) => factor,
        _ => 1.0,
    }
}

/// Two numbers, in each other's place where this fault is at work.
#[inline(always)]
pub fn exchanged<T>(seed: Seed, pair: [T; 2]) -> [T; 2] {
    let [a, b] = pair;
    if is(seed) { [b, a] } else { [a, b] }
}

// Tests without debug assertions (`cargo test --release`) have no switch, and nothing to ask.
#[cfg(all(test, debug_assertions))]
mod tests;
