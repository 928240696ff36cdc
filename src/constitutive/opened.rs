//! What granular laws do with volume that has opened: close it first, fill it with dilatancy, cut tension off.
//!
//! Elsewhere: void tracking, a volume correction for material that separates.

use super::Increment;

/// How much of the strain that is opened an increment closes without resistance, and what is still open.
#[inline(always)]
pub(super) fn closed(opened: f64, d: &Increment) -> (f64, f64) {
    let closing = max(0.0, min(opened, -d.volumetric()));
    (closing, opened - closing)
}

/// What becomes of the mean stress that a return along the flow leads to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Capped {
    /// Mean stress without the cut-off, once dilatancy has filled what is open, Pa.
    pub uncapped: f64,
    /// Mean stress, Pa.
    pub mean: f64,
    /// Opened strain.
    pub opened: f64,
}

/// Fills what is open with dilatancy, and cuts off tension: `mean` (Pa) is where the return along the flow ends, `cutoff` the largest
/// mean stress (Pa), `tracking` whether what opens is kept.
#[inline(always)]
pub(super) fn capped(mean: f64, still_open: f64, bulk: f64, cutoff: f64, tracking: bool) -> Capped {
    // Dilatancy, too, fills what is open before it presses.
    let filled = max(0.0, min(still_open, -mean * (1.0 / bulk)));
    let uncapped = if filled < still_open { max(mean, 0.0) } else { mean + bulk * filled };
    let still_open = still_open - filled;
    // Material that is open, or comes apart now, has lost its tensile strength.
    let torn = still_open > 0.0 || (tracking && uncapped > cutoff);
    let cap = if torn { min(0.0, cutoff) } else { cutoff };
    let mean = min(uncapped, cap);
    let opening = (uncapped - mean) * (1.0 / bulk);
    Capped { uncapped, mean, opened: if tracking { still_open + opening } else { 0.0 } }
}

// Comparisons that become single vector instructions; f64::min and max treat NaN apart, which costs.
#[inline(always)]
pub(super) fn max(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline(always)]
pub(super) fn min(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}
