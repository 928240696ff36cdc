//! What the lines of a figure are called, and how they are told apart.

use plotters::prelude::*;

use super::style::{
    BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, SMALL_PX, SOLID, VERMILION, WIDTH_PX, lighten, line, text_width_px,
};

/// Colours of the curves, in turn.
const COLOURS: [RGBColor; 6] = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY];
/// Share of white and dashes of what should come out, in turn, where there is more of it than two.
const EXACT: [(f64, &[f64]); 5] =
    [(0.0, SOLID), (0.0, &[8.0, 4.0]), (0.0, &[2.0, 3.0]), (0.0, &[9.0, 3.0, 2.0, 3.0]), (0.45, SOLID)];
/// Height of a row of entries, px.
pub(super) const LEGEND_ROW_PX: f64 = 19.0;

/// An entry of the legend.
pub(super) struct Key {
    pub(super) label: String,
    pub(super) style: ShapeStyle,
    /// Lengths of strokes and gaps, px; none for a solid line.
    pub(super) dashes: &'static [f64],
}

impl Key {
    /// Length of the line that is shown beside the label, px: two rounds of the longest pattern.
    pub(super) fn sample_px(&self) -> f64 {
        if self.dashes.is_empty() { 20.0 } else { 32.0 }
    }
}

/// Labels in the order in which they appear, each with its line; of each curve label and whether it is what should come out.
pub(super) fn legend<'a>(curves: impl Iterator<Item = (&'a str, bool)>) -> Vec<Key> {
    let mut seen: Vec<(&str, bool)> = Vec::new();
    for curve in curves {
        if seen.iter().all(|s| s.0 != curve.0) {
            seen.push(curve);
        }
    }
    // Two greys are told apart, more of them are not.
    let greys = seen.iter().filter(|s| s.1).count() <= 2;
    let (mut measured, mut exact) = (0, 0);
    let key = |(label, is_exact): (&str, bool)| {
        let count = if is_exact { &mut exact } else { &mut measured };
        *count += 1;
        let k = *count - 1;
        let (style, dashes) = match is_exact {
            true if greys => (line(lighten(GREY, 1.0 - 0.55f64.powi(k as i32)), 1.4), SOLID),
            true => (line(lighten(GREY, EXACT[k % EXACT.len()].0), 1.4), EXACT[k % EXACT.len()].1),
            false => (line(COLOURS[k % COLOURS.len()], 1.8), SOLID),
        };
        Key { label: label.to_string(), style, dashes }
    };
    seen.into_iter().map(key).collect()
}

/// Where the entries of the legend begin (px), and in which of its rows.
pub(super) fn flow(legend: &[Key]) -> Vec<(f64, usize)> {
    let (mut x, mut row) = (20.0, 0);
    let mut places = Vec::new();
    for key in legend {
        let wide = key.sample_px() + 6.0 + text_width_px(&key.label, SMALL_PX) + 18.0;
        if x > 20.0 && x + wide > f64::from(WIDTH_PX) {
            (x, row) = (20.0, row + 1);
        }
        places.push((x, row));
        x += wide;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether no two of so many lines that should come out look the same.
    fn apart(count: usize) -> bool {
        let names: Vec<String> = (0..count).map(|k| format!("line {k}")).collect();
        let keys = legend(names.iter().map(|n| (n.as_str(), true)));
        let look = |k: &Key| (k.style.color.0, k.style.color.1, k.style.color.2, k.dashes);
        keys.iter().enumerate().all(|(k, a)| keys[..k].iter().all(|b| look(a) != look(b)))
    }

    #[test]
    fn lines_are_told_apart() {
        assert!((1..=EXACT.len()).all(apart));
    }

    #[test]
    fn a_line_that_comes_twice_has_one_entry() {
        let keys = legend([("a", false), ("b", true), ("a", false)].into_iter());
        assert_eq!(keys.iter().map(|k| k.label.as_str()).collect::<Vec<_>>(), ["a", "b"]);
        assert!(keys.iter().all(|k| k.dashes.is_empty()));
    }
}
