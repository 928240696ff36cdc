//! The table of faults: a line each. Its site names the same `Seed`.

use super::{Entry, Kind};
use Kind::{Dropped, Exchanged, Times, Wrong};

macro_rules! faults {
    ($($seed:ident, $name:literal, $kind:expr, $what:literal;)*) => {
        /// A fault, by what is wrong.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Seed {
            $(#[doc = $what] $seed,)*
        }

        /// All of them, room by room.
        pub const ALL: &[Entry] = &[$(Entry { seed: Seed::$seed, name: $name, kind: $kind, what: $what }),*];
    };
}

faults! {
    CaseGravity, "case.gravity", Times(1.03), "gravity of the case on its way to the scene";
    CaseInclination, "case.inclination", Times(1.03), "inclination of the flume";
    CaseDensity, "case.density", Times(1.03), "density of a material";
    CaseYoung, "case.young", Times(1.03), "Young's modulus of a material";
    CasePoisson, "case.poisson", Times(1.03), "Poisson's ratio of a material";
    CaseFrictionAngle, "case.friction_angle", Times(1.03), "friction angle of a material";
    CaseDilatancy, "case.dilatancy", Dropped, "dilatancy angle of a material";
    CaseCohesion, "case.cohesion", Times(1.03), "cohesion of a material";
    CaseSoftening, "case.softening", Dropped, "that friction softens";
    CasePorePressure, "case.pore_pressure", Times(1.03), "share of the pressure that pore fluid carries";
    CaseStrength, "case.strength", Times(1.03), "shear strength of a von Mises material";
    CaseHardening, "case.hardening", Times(1.03), "hardening of a von Mises material";
    CaseViscosity, "case.viscosity", Times(1.03), "viscosity of a von Mises material";
    CaseGrains, "case.grains", Times(1.03), "diameter of the grains of mu(I)";
    CaseVoids, "case.voids", Dropped, "void tracking of a material";
    CaseFriction, "case.friction", Times(1.03), "friction of a boundary";
    CaseSlipLength, "case.slip_length", Times(1.03), "slip length of a boundary";
    CaseStaticFriction, "case.static_friction", Dropped, "static friction of a boundary";
    CaseClamp, "case.clamp", Wrong, "a clamp lets go";
    CaseLift, "case.lift", Dropped, "speed of a gate that lifts";
    CaseOpening, "case.opening", Dropped, "height at which a raised gate stays";
    CaseSideWalls, "case.side_walls", Dropped, "friction on the side walls";
    CaseContactFriction, "case.contact_friction", Times(1.03), "friction between bodies";
    CaseThickness, "case.thickness", Times(1.03), "thickness of the scene";
    CaseVelocity, "case.velocity", Times(1.03), "velocity of a body at the start";
    CaseWeightless, "case.weightless", Dropped, "that a body has no weight";
    CaseFoot, "case.foot", Wrong, "foot of a wall, a tenth of a cell too far along x";
    CasePlace, "case.place", Wrong, "points of a body, a tenth of their spacing too high";
    CaseFilling, "case.filling", Wrong, "points of a polygon or a ring, a tenth of their piece too far";
    CaseBodyFoot, "case.body_foot", Wrong, "foot of a body, a tenth of its thickness too far";
    CaseSpin, "case.spin", Times(1.03), "rotation of a body at the start";
    CaseGradient, "case.gradient", Exchanged, "shears of the velocity of a body at the start";
    CaseTerrain, "case.terrain", Exchanged, "frictions of the pieces of a terrain, first and last";
    CaseInflowVelocity, "case.inflow_velocity", Times(1.03), "velocity of an inflow";
    CaseInflowDepth, "case.inflow_depth", Times(1.03), "depth of an inflow";
    CaseInflowFoot, "case.inflow_foot", Wrong, "foot of an inflow's section, a tenth of a cell too far along x";
    CasePic, "case.pic", Dropped, "share of PIC";

    RunDamping, "run.damping", Wrong, "damping of the settling stays on";
    RunTilt, "run.tilt", Dropped, "gravity stays that of the settling";
    RunMean, "run.mean", Wrong, "a late mean divides by one sample too few";
    RunPeak, "run.peak", Wrong, "the largest mean over 20 ms divides by one sample too few";
    RunImpulse, "run.impulse", Times(1.03), "impulse of the first half second";
    RunTimeToStatic, "run.time_to_static", Wrong, "begin of the last interval instead of its end";
    RunDrift, "run.drift", Exchanged, "first and last third of the static force";
    RunArchive, "run.archive", Wrong, "an archive keeps the sample before its frame";
    RunArrival, "run.arrival", Times(1.5), "force from which the flow counts as arrived";
    RunShear, "run.shear", Times(1.03), "static shear";
    RunMoment, "run.moment", Times(0.001), "static moment in kN m";
    RunAction, "run.action", Times(1.03), "height at which the static force acts";
    RunPeakMoment, "run.peak_moment", Times(1.03), "largest moment of a step";
    RunImpulses, "run.impulses", Exchanged, "impulses along the normal and along the face";
    RunLayers, "run.layers", Exchanged, "static forces of one and of three layers";
    RunRunUp, "run.run_up", Times(1.03), "largest run-up";
    RunOvertopped, "run.overtopped", Exchanged, "masses that went over and under the barrier";
    RunAlpha, "run.alpha", Times(1.03), "coefficient of dynamic pressure";
    RunElastic, "run.elastic", Times(1.03), "force of an elastic impact";
    RunFroude, "run.froude", Dropped, "cosine in the Froude number";
    RunPassage, "run.passage", Wrong, "time of the edge at a station is that of the quantile";
    RunMass, "run.mass", Times(1.03), "mass at the start";
    RunWeight, "run.weight", Times(1.03), "weight of the deposit along the flume";
    RunLimit, "run.limit", Times(1.03), "largest friction of the base";
    RunHeld, "run.held", Times(1.03), "force of the deposit on what holds it";
    RunSides, "run.sides", Dropped, "side walls in the equilibrium of the deposit";
    RunPeakClamp, "run.peak_clamp", Times(1.03), "largest force on the clamp";
    RunClamp, "run.clamp", Times(1.03), "static force on the clamp";
    RunClampMoment, "run.clamp_moment", Times(1.03), "static moment on the clamp";
    RunTip, "run.tip", Times(1.03), "final deflection of the tip";
    RunDissipated, "run.dissipated", Dropped, "elastic energy in what was dissipated before the arrival";
    RunShares, "run.shares", Exchanged, "shares of friction and of impact";
    RunPicShare, "run.pic_share", Times(1.03), "share that PIC took";
    RunReleased, "run.released", Times(1.03), "energy released";
    RunDatum, "run.datum", Dropped, "level of the energies: it is that of the origin";
    RunFrontLength, "run.front_length", Times(1.03), "length behind the front";
    RunDensity, "run.density", Times(1.03), "density of the flow";
    RunRest, "run.rest", Wrong, "rest after one quiet window instead of three";
    RunClock, "run.clock", Times(1.03), "interval of the rows";
    RunFurther, "run.further", Exchanged, "normal force and friction of a further base";

    TablesLayers, "tables.layers", Exchanged, "forces of one and of three layers in the history";
    TablesNormal, "tables.normal", Times(1.03), "normal force in the history";
    TablesShear, "tables.shear", Times(1.03), "tangential force in the history";
    TablesMoment, "tables.moment", Times(0.001), "moment of the history in kN m";
    TablesBase, "tables.base", Exchanged, "normal force and friction of the base";
    TablesFront, "tables.front", Exchanged, "velocity and depth of the front";
    TablesWindow, "tables.window", Exchanged, "mean and 95th percentile of the speeds in a window";
    TablesEnergy, "tables.energy", Exchanged, "friction and impact of a boundary in the energies";
    TablesGravity, "tables.gravity", Exchanged, "impulse of gravity along x and y";
    TablesOutflow, "tables.outflow", Wrong, "sign of the momentum that left the domain";
    TablesStation, "tables.station", Times(1.03), "depth at a station";
    TablesPressure, "tables.pressure", Times(0.001), "pressure on a barrier in kPa";
    TablesClamp, "tables.clamp", Times(1.03), "force on the clamp in the table of a barrier";
    TablesClampMoment, "tables.clamp_moment", Times(0.001), "moment on the clamp in kN m";
    TablesInertia, "tables.inertia", Times(1.03), "inertia in the table of a barrier";
    TablesTip, "tables.tip", Times(1.03), "deflection of the tip in the table of a barrier";
    TablesBending, "tables.bending", Times(1.03), "deflection in the profile of a barrier";
    TablesOutline, "tables.outline", Exchanged, "x and y of the surface of a barrier";
    TablesTraction, "tables.traction", Exchanged, "pressure and shear between bodies";
    TablesField, "tables.field", Exchanged, "velocities along x and y of a field";
    TablesGeometry, "tables.geometry", Times(1.03), "thickness of a wall as it is drawn";

    GaugeNormal, "gauge.normal", Times(1.03), "normal force on a barrier";
    GaugeShear, "gauge.shear", Times(1.03), "force along a barrier";
    GaugeArm, "gauge.arm", Wrong, "moment about a point a metre below the foot";
    GaugePeak, "gauge.peak", Times(1.03), "largest force of a step";
    GaugeRunning, "gauge.running", Times(1.03), "length of the running mean";
    GaugeProfile, "gauge.profile", Wrong, "lowest and highest bin of the pressure count as whole";
    GaugeBody, "gauge.body", Times(1.03), "impulse of contacts on a barrier that is a body";
    GaugeBodyArm, "gauge.body_arm", Wrong, "its moment about a point a metre below the foot";
    GaugeBase, "gauge.base", Times(1.03), "friction of a base";
    GaugeBaseNormal, "gauge.base_normal", Times(1.03), "normal force of a base";
    GaugeLayer, "gauge.layer", Times(1.03), "thickness of a layer of points";
    GaugeRunUp, "gauge.run_up", Wrong, "run-up above the origin instead of the foot";
    GaugePercentile, "gauge.percentile", Wrong, "90th percentile instead of the 95th";
    GaugeWindow, "gauge.window", Wrong, "mean speed in a window divides by one point too few";
    GaugeStation, "gauge.station", Times(1.03), "width of a station";
    GaugeField, "gauge.field", Wrong, "a field moved by half a cell";
    GaugeBodies, "gauge.bodies", Dropped, "that a wall acts on some bodies alone, in what is read beside it";
    GaugeDeparted, "gauge.departed", Wrong, "what leaves the domain before a barrier that is a body has passed it";
    GaugeFieldOrigin, "gauge.field_origin", Wrong, "cells of a field counted from the origin of the axes, not from that of the grid";
    GaugeFieldPressure, "gauge.field_pressure", Times(1.03), "pressure of a field";
    GaugeFront, "gauge.front", Times(1.5), "share of the mass ahead of the front";
    GaugeFrontVelocity, "gauge.front_velocity", Times(1.03), "velocity of the front";
    GaugeFrontDepth, "gauge.front_depth", Times(1.03), "depth of the front";
    GaugePassage, "gauge.passage", Times(1.03), "mass that passed a wall";
    GaugeClampArm, "gauge.clamp_arm", Dropped, "lever arm of a clamp's force about the foot";
    GaugeInertia, "gauge.inertia", Times(1.03), "rate of a barrier's momentum";
    GaugeDeflection, "gauge.deflection", Times(1.03), "deflection of a barrier";
    GaugeSurvey, "gauge.survey", Dropped, "volume ratio in the stress of layers at a bent barrier";
    GaugePenetration, "gauge.penetration", Times(1.03), "depth of a point inside a boundary";
    GaugeKinetic, "gauge.kinetic", Times(1.03), "kinetic energy of the flow";

    OutputTensor, "output.tensor", Exchanged, "xx and yy of the stress in VTK";
    OutputVector, "output.vector", Exchanged, "second and third component of a vector in VTK";
    OutputFields, "output.fields", Exchanged, "volume ratio and opened strain in VTK";
    OutputTime, "output.time", Times(1.03), "time of a frame in VTK";
    OutputCollection, "output.collection", Times(1.03), "time of a frame in the collection";
    OutputDigits, "output.digits", Wrong, "tables with two digits";

    LedgerGravity, "ledger.gravity", Times(1.03), "impulse of gravity as it is booked";
    LedgerPotential, "ledger.potential", Times(1.03), "gravitational energy";
    LedgerElastic, "ledger.elastic", Times(1.03), "elastic energy";
    LedgerKinetic, "ledger.kinetic", Times(1.03), "kinetic energy";
    LedgerPlastic, "ledger.plastic", Dropped, "elastic energy at the opening in the plastic work";
    LedgerSlip, "ledger.slip", Dropped, "energy of the elastic slip";
    LedgerPic, "ledger.pic", Times(1.03), "energy that PIC took";
    LedgerOutflow, "ledger.outflow", Times(1.03), "energy carried out of the domain";
    LedgerOutflowMass, "ledger.outflow_mass", Times(1.03), "mass that left the domain";
    LedgerInflow, "ledger.inflow", Times(1.03), "energy that comes in with an inflow";
    LedgerInflowMass, "ledger.inflow_mass", Times(1.03), "mass that entered";
    LedgerInflowMomentum, "ledger.inflow_momentum", Times(1.03), "momentum that came in with an inflow";
    LedgerWork, "ledger.work", Times(1.03), "work of a distributed force";

    BoundarySurfaceWork, "boundary.surface_work", Times(1.03), "remapped work at a crossing";
    BoundaryNodeWork, "boundary.node_work", Times(1.03), "work of friction at a node";
    BoundarySurfaceFriction, "boundary.surface_friction", Times(1.03), "friction at a crossing";
    BoundaryNodeFriction, "boundary.node_friction", Times(1.03), "friction at a node";
    BoundaryArm, "boundary.arm", Times(1.03), "lever arm of a crossing about the foot";
    BoundaryCrossing, "boundary.crossing", Wrong, "a crossing moved by a twentieth of a cell";
    BoundaryLift, "boundary.lift", Times(1.03), "speed at which a gate is lifted";
    BoundarySlip, "boundary.slip", Times(1.03), "stiffness of elastic slip";
    BoundaryWear, "boundary.wear", Dropped, "loss of static friction by slip";

    ContactFriction, "contact.friction", Times(1.03), "friction between bodies at a node";
    ContactTouching, "contact.touching", Times(1.03), "distance at which bodies touch by mean positions";
    ContactExtents, "contact.extents", Wrong, "bodies touch a twentieth of a cell early";
    ContactArea, "contact.area", Times(1.03), "area of contact at a node";
    ContactWork, "contact.work", Times(1.03), "work of friction between bodies";
    ContactMoment, "contact.moment", Times(1.03), "moment of what bodies give to each other";

    ConstitutiveCone, "constitutive.cone", Times(1.03), "slope of the yield cone";
    ConstitutiveDilatancy, "constitutive.dilatancy", Times(1.03), "slope of the plastic potential";
    ConstitutiveCohesion, "constitutive.cohesion", Times(1.03), "strength without pressure";
    ConstitutiveBulk, "constitutive.bulk", Times(1.03), "bulk modulus";
    ConstitutiveShear, "constitutive.shear", Times(1.03), "shear modulus";
    ConstitutiveLame, "constitutive.lame", Times(1.03), "Lame's first parameter of the neo-Hookean law";
    ConstitutivePyramid, "constitutive.pyramid", Times(1.03), "sine of the friction angle of Mohr-Coulomb";
    ConstitutivePyramidDilatancy, "constitutive.pyramid_dilatancy", Times(1.03), "sine of the dilatancy angle of Mohr-Coulomb";
    ConstitutiveInertial, "constitutive.inertial", Times(1.03), "inertial number of mu(I) at half way";
    ConstitutiveSpin, "constitutive.spin", Dropped, "turn of the stress with the material";

    TransferForce, "transfer.force", Times(1.03), "volume in the internal force";
    TransferStrain, "transfer.strain", Times(1.03), "strain of a step";
    TransferPic, "transfer.pic", Times(1.5), "share of PIC in a step";
    TransferSides, "transfer.sides", Times(1.03), "pressure on the side walls";
    MomentumGravity, "momentum.gravity", Times(1.03), "gravity at the nodes";
    MomentumDrag, "momentum.drag", Wrong, "work of the side walls with the velocity after the step";
    TimestepSpeed, "timestep.speed", Dropped, "speed of the points in the time step";
    TimestepWave, "timestep.wave", Times(1.03), "length of a time step";
    SimulationEndForce, "simulation.end_force", Times(1.03), "force at the end of an implicit step of a mesh";
    SimulationTaken, "simulation.taken", Times(1.03), "energy that implicit steps of a mesh take";
    SimulationSurface, "simulation.surface", Times(1.05), "0.7 of the bound of the volume at a surface";
    SimulationOccupied, "simulation.occupied", Times(1.05), "volume of a cell in that bound";
    SimulationInflowStress, "simulation.inflow_stress", Dropped, "stress of what enters";
    SimulationInflowColumn, "simulation.inflow_column", Dropped, "one of 32 columns of an inflow";

    StudyColumns, "study.columns", Exchanged, "static force and shear in the table of a study";
    StudyDissipated, "study.dissipated", Dropped, "elastic energy in the share that was dissipated";
    StudyDigits, "study.digits", Wrong, "two digits in the table of a study";
    StudyChange, "study.change", Times(1.03), "a value of an axis";
}
