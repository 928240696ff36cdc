//! The layers of the energy figure: their order, names, colours and heights.

use plotters::prelude::*;

use super::style::{BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, YELLOW, lighten};
use crate::output::Table;

/// Shares (of 1) below which a mechanism is counted among the others at all times.
const NEGLIGIBLE: f64 = 0.002;

/// A mechanism and its share of the initial energy (percent) at the instants drawn.
pub(super) struct Layer {
    pub(super) name: String,
    pub(super) column: String,
    pub(super) colour: RGBColor,
    pub(super) share: Vec<f64>,
}

impl Layer {
    pub(super) fn largest(&self) -> f64 {
        self.share.iter().fold(0.0, |largest, v| largest.max(v.abs()))
    }
}

/// The energy columns from the bottom of the stack to its top: what is still there, then what was lost.
pub(super) fn columns(table: &Table) -> Vec<String> {
    let rank = |name: &str| match name {
        "gravitational_j" => 0,
        "kinetic_j" => 1,
        "elastic_j" => 2,
        "plastic_j" => 3,
        _ if name.starts_with("friction_") => 4,
        "side_walls_j" => 5,
        _ if name.starts_with("contact_") => 6,
        "outflow_j" => 9,
        "damping_j" => 8,
        _ => 7,
    };
    let mut names: Vec<String> =
        table.names().iter().filter(|name| name.ends_with("_j") && *name != "residual_j").cloned().collect();
    names.sort_by_key(|name| rank(name));
    names
}

/// What a column is called in the figure.
pub(super) fn title(column: &str) -> String {
    let name = column.strip_suffix("_j").unwrap_or(column);
    match name {
        "plastic" => "plastic work".to_owned(),
        "pic" => "velocity smoothing (PIC)".to_owned(),
        "side_walls" => "friction, side walls".to_owned(),
        _ => match name.split_once('_') {
            Some((kind @ ("friction" | "contact"), boundary)) => {
                format!("{kind}, {}", boundary.replace('_', " "))
            }
            _ => name.replace('_', " "),
        },
    }
}

/// Colours the layers; boundaries of the same mechanism get paler and paler tones of its colour.
pub(super) fn paint(layers: &mut [Layer]) {
    let mut earlier: Vec<String> = Vec::new();
    for layer in layers {
        let kind = layer.column.split('_').next().unwrap_or_default().to_owned();
        let base = match kind.as_str() {
            "gravitational" => BLUE,
            "kinetic" => SKY,
            "elastic" => lighten(SKY, 0.6),
            "plastic" => VERMILION,
            "friction" => ORANGE,
            "side" => YELLOW,
            "contact" => PURPLE,
            "pic" => GREEN,
            "damping" => lighten(GREEN, 0.5),
            _ => lighten(GREY, 0.4),
        };
        let same = earlier.iter().filter(|other| **other == kind).count();
        layer.colour = lighten(base, 1.0 - 0.6f64.powi(same as i32));
        earlier.push(kind);
    }
}

/// Puts the negligible layers together at the end.
pub(super) fn group(layers: Vec<Layer>) -> Vec<Layer> {
    let (mut kept, small): (Vec<Layer>, Vec<Layer>) =
        layers.into_iter().partition(|layer| layer.largest() >= 100.0 * NEGLIGIBLE);
    if small.iter().any(|layer| layer.largest() > 0.0) {
        let instants = small[0].share.len();
        let share = (0..instants).map(|k| small.iter().map(|layer| layer.share[k]).sum()).collect();
        kept.push(Layer { name: "other".to_owned(), column: String::new(), colour: GREY, share });
    }
    kept
}

/// What a layer covers at an instant: from the near to the far end of its pile, above zero and below it. One of the two is empty.
///
/// A share that changes its sign leaves one pile for the other, and both outlines stay continuous.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Band {
    pub(super) above: (f64, f64),
    pub(super) below: (f64, f64),
}

impl Band {
    /// The side that is not empty.
    pub(super) fn larger(&self) -> (f64, f64) {
        if self.below.0 > self.below.1 { self.below } else { self.above }
    }
}

/// Piles up the layers at each instant: positive shares from zero up, negative ones from zero down.
pub(super) fn stack(layers: &[Layer], instants: usize) -> Vec<Vec<Band>> {
    let mut piles = vec![(0.0, 0.0); instants];
    let mut bands = |layer: &Layer| {
        let place = |((above, below), share): (&mut (f64, f64), &f64)| {
            let near = (*above, *below);
            *above += share.max(0.0);
            *below += share.min(0.0);
            Band { above: (near.0, *above), below: (near.1, *below) }
        };
        piles.iter_mut().zip(&layer.share).map(place).collect()
    };
    layers.iter().map(&mut bands).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(column: &str, share: &[f64]) -> Layer {
        Layer { name: title(column), column: column.to_owned(), colour: GREY, share: share.to_vec() }
    }

    #[test]
    fn negative_shares_stack_below_zero() {
        let layers = [layer("kinetic_j", &[60.0]), layer("contact_base_j", &[-2.0]), layer("pic_j", &[40.0])];
        let band = |above, below| [Band { above, below }];
        assert_eq!(
            stack(&layers, 1),
            [band((0.0, 60.0), (0.0, 0.0)), band((60.0, 60.0), (0.0, -2.0)), band((60.0, 100.0), (-2.0, -2.0)),]
        );
    }

    #[test]
    fn a_share_that_changes_sign_does_not_jump() {
        let layers = [layer("kinetic_j", &[100.0, 100.0]), layer("contact_base_j", &[1e-9, -1e-9])];
        let bands = stack(&layers, 2);
        assert!(bands[1].iter().all(|b| (b.above.1 - 100.0).abs() < 1e-6 && b.below.1.abs() < 1e-6));
    }

    #[test]
    fn small_mechanisms_are_drawn_together_and_absent_ones_not_at_all() {
        let absent = || layer("outflow_j", &[0.0, 0.0]);
        let layers = group(vec![layer("kinetic_j", &[0.0, 5.0]), layer("pic_j", &[0.0, 0.1]), absent()]);
        assert_eq!(layers.iter().map(|layer| layer.name.as_str()).collect::<Vec<_>>(), ["kinetic", "other"]);
        assert_eq!(group(vec![absent()]).len(), 0);
    }

    #[test]
    fn names_are_readable() {
        assert_eq!(title("friction_back_wall_j"), "friction, back wall");
        assert_eq!(title("side_walls_j"), "friction, side walls");
        assert_eq!(title("gravitational_j"), "gravitational");
    }
}
