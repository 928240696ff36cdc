//! Wrong physics on purpose.
//!
//! Elsewhere: fault injection.

/// What can be wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultKind {
    /// Friction coefficients: of boundaries, and the slope of the yield cone.
    Friction,
    /// Young's modulus.
    Modulus,
    /// Gravity.
    Gravity,
    /// Density.
    Density,
    /// The impulse that a boundary reports.
    ContactForce,
    /// Slip over which friction is mobilised.
    SlipLength,
}

impl FaultKind {
    /// All of them.
    pub const ALL: [FaultKind; 6] = [
        FaultKind::Friction,
        FaultKind::Modulus,
        FaultKind::Gravity,
        FaultKind::Density,
        FaultKind::ContactForce,
        FaultKind::SlipLength,
    ];

    /// Name in reports.
    pub fn name(self) -> &'static str {
        match self {
            FaultKind::Friction => "friction",
            FaultKind::Modulus => "modulus",
            FaultKind::Gravity => "gravity",
            FaultKind::Density => "density",
            FaultKind::ContactForce => "contact_force",
            FaultKind::SlipLength => "slip_length",
        }
    }
}

/// Factors on the physics that the solver is given; the closed forms keep the true values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fault {
    /// See [`FaultKind::Friction`].
    pub friction: f64,
    /// See [`FaultKind::Modulus`].
    pub modulus: f64,
    /// See [`FaultKind::Gravity`].
    pub gravity: f64,
    /// See [`FaultKind::Density`].
    pub density: f64,
    /// See [`FaultKind::ContactForce`].
    pub contact_force: f64,
    /// See [`FaultKind::SlipLength`].
    pub slip_length: f64,
}

impl Fault {
    /// Nothing wrong.
    pub const NONE: Fault =
        Fault { friction: 1.0, modulus: 1.0, gravity: 1.0, density: 1.0, contact_force: 1.0, slip_length: 1.0 };

    /// One factor wrong.
    pub fn of(kind: FaultKind, factor: f64) -> Self {
        let mut fault = Self::NONE;
        *match kind {
            FaultKind::Friction => &mut fault.friction,
            FaultKind::Modulus => &mut fault.modulus,
            FaultKind::Gravity => &mut fault.gravity,
            FaultKind::Density => &mut fault.density,
            FaultKind::ContactForce => &mut fault.contact_force,
            FaultKind::SlipLength => &mut fault.slip_length,
        } = factor;
        fault
    }
}
