//! What deserves a second look: one sentence and its kind.

/// What a note is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The run failed.
    Failed,
    /// The user stopped it.
    Stopped,
    /// The material had not settled when it was released.
    Settling,
    /// It was not at rest at the end, and forces were read.
    Rest,
    /// It was still moving at the end, and no force was read.
    Motion,
    /// Energy is missing.
    Energy,
    /// Momentum is missing.
    Momentum,
    /// Points lie deep in boundaries.
    Penetration,
    /// Mass left the domain.
    Mass,
    /// A little mass left the domain.
    Grains,
    /// Points lie closer than they say, or farther apart.
    Volume,
    /// PIC took much of the energy.
    Pic,
    /// A structure or an opening has few cells.
    Cells,
    /// The front has few cells.
    Front,
    /// The peak is that of an elastic body, and grows with its stiffness.
    Elastic,
    /// A gate had not opened to its end.
    Opening,
    /// An inflow had not ended.
    Unfinished,
    /// A deposit had grown back to the section of an inflow.
    Drowned,
    /// Mass went through a barrier.
    Through,
    /// A barrier that is a body is torn.
    Torn,
    /// Forces on a barrier that is a body do not balance.
    Balance,
    /// Contact with a body in implicit steps was not settled.
    Sweeps,
    /// Mass went over or under a barrier.
    Passed,
    /// Nothing reached a barrier.
    NotReached,
    /// Friction locks any of many forces in.
    Locked,
}

impl Kind {
    /// Whether a run with such a note is not to be trusted.
    pub fn doubts(self) -> bool {
        !matches!(self, Kind::Motion | Kind::Grains | Kind::Passed | Kind::NotReached | Kind::Locked)
    }
}

/// Something that deserves a second look.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// What it is about.
    pub kind: Kind,
    /// One sentence, with its number.
    pub text: String,
}
