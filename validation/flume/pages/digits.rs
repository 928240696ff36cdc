//! Numbers as pages show them.

use checkdam::check::significant;

/// Three digits; a dash where there is no number.
pub fn three(x: f64) -> String {
    if x.is_finite() { significant(x, 3) } else { "\u{2013}".into() }
}

/// Two digits; a dash where there is no number.
pub fn two(x: f64) -> String {
    if x.is_finite() { significant(x, 2) } else { "\u{2013}".into() }
}

/// A published number with its half width, and its kind if it is not the column's.
pub fn published(value: f64, half_width: f64, kind: &str) -> String {
    if !value.is_finite() {
        return "\u{2013}".into();
    }
    let note = match kind {
        "" | "computed" | "measured" => String::new(),
        kind => format!(" ({kind})"),
    };
    format!("{} \u{b1} {}{note}", three(value), two(half_width))
}
