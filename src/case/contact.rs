//! Contact of two bodies: the `[[contacts]]` tables of a case file.
//!
//! The rules have words here and types in the solver, [`NormalKind`] and [`NormalRule`], [`GapKind`] and [`GapRule`], for the reason at the
//! head of `boundary.rs`.

use serde::{Deserialize, Serialize};

use super::angle::direction;
use crate::contact::rule::{GapRule, NormalRule};
use crate::contact::separation::TOUCHING;

/// The contact of two bodies. Bodies that no contact names stick to each other where they meet; a body that one names needs one
/// with every other body. At most eight bodies are in contacts.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BodyContact {
    /// Names of the two bodies. Allowed: two different names of `[[bodies]]`; one contact for two bodies. Example:
    /// `["barrier", "sand"]`.
    pub bodies: Vec<String>,
    /// Coulomb friction coefficient, not an angle. Allowed: 0 or more. Example: `0.4`.
    pub friction: f64,
    /// How the direction of the surface between them is found. Default: `"nearest_face"`. Example: `"regression"`.
    pub normal: Option<NormalKind>,
    /// The one of the two that keeps its shape, a barrier for instance. Default: the first of `bodies`. Allowed: only
    /// with `normal = "nearest_face"`; one of the two names. Example: `"barrier"`.
    pub structure: Option<String>,
    /// Direction out of the first body, from the x axis, counter-clockwise. Default: none; required by `normal =
    /// "prescribed"`. Allowed: only with `normal = "prescribed"`; -360 to 360. Example: `90`.
    pub normal_deg: Option<f64>,
    /// How it is decided whether they touch. Default: `"extents"`. Example: `"positions"`.
    pub gap: Option<GapKind>,
    /// Distance of the mean positions of bodies that touch. Default: `0.8`. Allowed: only with `gap = "positions"`;
    /// above 0. Example: `1.0`.
    pub offset_cells: Option<f64>,
}

/// How the direction of the surface between two bodies is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum NormalKind {
    /// From the faces of a structure nearest to the points of the other body.
    #[default]
    NearestFace,
    /// From the volume gradient of the body that has more volume at the node.
    LargerBody,
    /// From the difference of both volume gradients.
    Average,
    /// By logistic regression between the points of both.
    Regression,
    /// Given.
    Prescribed,
}

/// How it is decided whether two bodies touch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum GapKind {
    /// From the points nearest to the surface and their size.
    #[default]
    Extents,
    /// From mean positions at the node.
    Positions,
    /// From displacements since the start, for bodies that touch then.
    Displacements,
    /// They touch where they reach the same node and approach.
    Approach,
}

impl BodyContact {
    /// Distance of the mean positions of bodies that touch, in cells, when none is given.
    pub const DEFAULT_OFFSET_CELLS: f64 = TOUCHING;

    /// Name of the structure, for `nearest_face`; `None` for a contact without bodies, which validation refuses.
    pub fn structure_name(&self) -> Option<&str> {
        self.structure.as_deref().or(self.bodies.first().map(String::as_str))
    }

    /// The word of the file with the keys beside it as one; `None` if a required key is missing, which validation refuses.
    pub fn normal_rule(&self) -> Option<NormalRule> {
        Some(match self.normal.unwrap_or_default() {
            NormalKind::NearestFace => {
                let second = self.structure_name() == self.bodies.get(1).map(String::as_str);
                NormalRule::NearestFace(usize::from(second))
            }
            NormalKind::LargerBody => NormalRule::LargerBody,
            NormalKind::Average => NormalRule::Average,
            NormalKind::Regression => NormalRule::Regression,
            NormalKind::Prescribed => NormalRule::Prescribed(direction(self.normal_deg?)),
        })
    }

    /// The word of the file with the distance beside it.
    pub fn gap_rule(&self) -> GapRule {
        match self.gap.unwrap_or_default() {
            GapKind::Extents => GapRule::Extents,
            GapKind::Positions => {
                GapRule::Positions { offset: self.offset_cells.unwrap_or(Self::DEFAULT_OFFSET_CELLS) }
            }
            GapKind::Displacements => GapRule::Displacements,
            GapKind::Approach => GapRule::Approach,
        }
    }

    pub(super) fn resolve(&mut self) {
        let normal = *self.normal.get_or_insert_default();
        let gap = *self.gap.get_or_insert_default();
        if normal == NormalKind::NearestFace {
            self.structure = self.structure_name().map(str::to_owned);
        }
        if gap == GapKind::Positions {
            self.offset_cells.get_or_insert(Self::DEFAULT_OFFSET_CELLS);
        }
    }
}
