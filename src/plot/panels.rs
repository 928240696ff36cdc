//! Panels of equal size and scale, and the turn that makes gravity point down.

use super::style::{Spot, WIDTH_PX, units};

pub(super) const MARGIN_PX: f64 = 14.0;
pub(super) const GAP_PX: f64 = 14.0;
pub(super) const TITLE_PX: f64 = 24.0;
pub(super) const FOOT_PX: f64 = 74.0;

/// A point in the plane of the figure: horizontal and vertical distance (m).
pub(super) type Point = [f64; 2];

/// From flume coordinates to the plane of the figure.
pub(super) struct Turn {
    sin: f64,
    cos: f64,
}

impl Turn {
    pub(super) fn new(inclination_deg: f64) -> Self {
        let (sin, cos) = inclination_deg.to_radians().sin_cos();
        Self { sin, cos }
    }

    pub(super) fn apply(&self, [x, y]: Point) -> Point {
        [x * self.cos + y * self.sin, y * self.cos - x * self.sin]
    }
}

/// A rectangle in the plane of the figure (m).
pub(super) struct Extent {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Extent {
    pub(super) fn around(points: impl Iterator<Item = Point>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points {
            for c in 0..2 {
                low[c] = low[c].min(point[c]);
                high[c] = high[c].max(point[c]);
            }
        }
        Self { left: low[0], top: high[1], width: high[0] - low[0], height: high[1] - low[1] }
    }

    pub(super) fn grown(self, by: f64) -> Self {
        let (width, height) = (self.width + 2.0 * by, self.height + 2.0 * by);
        Self { left: self.left - by, top: self.top + by, width, height }
    }
}

/// Where the panels are.
pub(super) struct Layout {
    columns: usize,
    panel_px: (f64, f64),
    pub(super) px_per_m: f64,
    pub(super) height_px: f64,
}

impl Layout {
    /// Two columns, or more if the figure would otherwise be much taller than a page.
    pub(super) fn new(panels: usize, extent: &Extent) -> Self {
        let fit = |columns: usize| {
            let inner = f64::from(WIDTH_PX) - 2.0 * MARGIN_PX - GAP_PX * (columns - 1) as f64;
            let width = inner / columns as f64;
            // A panel much taller than wide is drawn smaller instead.
            let px_per_m = (width / extent.width).min(1.4 * width / extent.height);
            let height = px_per_m * extent.height;
            let rows = panels.div_ceil(columns) as f64;
            let height_px = MARGIN_PX + rows * (TITLE_PX + height) + (rows - 1.0) * GAP_PX + FOOT_PX;
            Self { columns, panel_px: (width, height), px_per_m, height_px }
        };
        let page = 1.3 * f64::from(WIDTH_PX);
        (2..4).map(fit).find(|layout| layout.height_px <= page).unwrap_or_else(|| fit(4))
    }

    /// Upper left corner of a panel, below its title (px).
    pub(super) fn origin(&self, panel: usize) -> (f64, f64) {
        let (row, column) = ((panel / self.columns) as f64, (panel % self.columns) as f64);
        let (width, height) = self.panel_px;
        (MARGIN_PX + column * (width + GAP_PX), MARGIN_PX + TITLE_PX + row * (height + TITLE_PX + GAP_PX))
    }

    pub(super) fn spot(&self, origin: (f64, f64), extent: &Extent, [x, y]: Point) -> Spot {
        (units(origin.0 + (x - extent.left) * self.px_per_m), units(origin.1 + (extent.top - y) * self.px_per_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn down_the_flume_is_right_and_down() {
        let [x, y] = Turn::new(30.0).apply([1.0, 0.0]);
        assert!((x - 0.75f64.sqrt()).abs() < 1e-12 && (y + 0.5).abs() < 1e-12);
        let [x, y] = Turn::new(30.0).apply([0.0, 1.0]);
        assert!((x - 0.5).abs() < 1e-12 && (y - 0.75f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn panels_do_not_overlap_and_stay_on_the_figure() {
        let extent = Extent::around([[0.0, 0.0], [2.0, 1.0]].into_iter());
        for count in 1..30 {
            let layout = Layout::new(count, &extent);
            let last = layout.origin(count - 1);
            assert!(last.1 + layout.panel_px.1 <= layout.height_px - FOOT_PX + 1e-9);
            if count > 1 {
                assert!(layout.origin(1).0 >= layout.origin(0).0 + layout.panel_px.0);
            }
        }
    }
}
