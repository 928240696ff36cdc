//! Parts of a rung. Under a fault that is seeded in the program one part may be enough; else a rung is all of them.

use checkdam::seeded;
use std::sync::{Mutex, PoisonError};

static ASKED: Mutex<Option<String>> = Mutex::new(None);

/// Asks one part alone from now on: for who judges seeded faults. Without a fault at work it changes nothing.
pub fn ask(part: &str) {
    *ASKED.lock().unwrap_or_else(PoisonError::into_inner) = Some(part.into());
}

/// Whether a rung runs the part of this name.
pub fn is_asked(part: &str) -> bool {
    let asked = ASKED.lock().unwrap_or_else(PoisonError::into_inner);
    is_whole() || asked.as_ref().is_none_or(|name| name == part)
}

/// Whether a rung judges itself, too: not under a seeded fault, where what it says of numbers read wrong is no physics.
pub fn is_whole() -> bool {
    seeded::active().is_none()
}
