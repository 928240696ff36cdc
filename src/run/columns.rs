//! The tables of a run: name, unit, meaning and value of every column. A new column is one line here.

use super::records::{EnergyRow, HistoryRow, MomentumRow};
use super::table::{Column, Group, Per, TableKind, TableText};
use crate::gauge::structure::ProfilePoint;
use crate::gauge::{FieldCell, StationSample, StructureSample};
use crate::seeded::{self, Seed};
use crate::simulation::ContactPoint;

/// All tables of a run with all their columns.
pub fn columns() -> Vec<TableText> {
    vec![
        HISTORY.describe(),
        ENERGY.describe(),
        MOMENTUM.describe(),
        STATIONS.describe(),
        PRESSURE.describe(),
        STRUCTURE.describe(),
        BENDING.describe(),
        BENDING_AT_PEAK.describe(),
        OUTLINE.describe(),
        CONTACT.describe(),
        FIELD.describe(),
        GEOMETRY.describe(),
        FURTHER.describe(),
        FURTHER_BASE.describe(),
        WINDOW.describe(),
    ]
}

/// Columns of rows of a type, in order: name, unit, meaning, value.
macro_rules! columns {
    ($row:ty; $($name:literal, $unit:literal, $meaning:literal, $value:expr;)*) => {
        &[$(Column::<$row> { name: $name, unit: $unit, meaning: $meaning, value: $value }),*]
    };
}

// Numbers that stand side by side, as a seeded fault exchanges them.

fn layers(r: &HistoryRow) -> [f64; 2] {
    seeded::exchanged(Seed::TablesLayers, [r.layers[0], r.layers[2]])
}

fn base(r: &HistoryRow) -> [f64; 2] {
    seeded::exchanged(Seed::TablesBase, [r.base.normal, r.base.friction])
}

fn front(r: &HistoryRow) -> [f64; 2] {
    seeded::exchanged(Seed::TablesFront, [r.front.velocity, r.front.depth])
}

fn window(r: &HistoryRow) -> [f64; 2] {
    seeded::exchanged(Seed::TablesWindow, [r.window.mean, r.window.p95])
}

fn lost(r: &EnergyRow, k: usize) -> [f64; 2] {
    seeded::exchanged(Seed::TablesEnergy, [r.balance.friction[k], r.balance.contact[k]])
}

fn gravity(r: &MomentumRow) -> [f64; 2] {
    seeded::exchanged(Seed::TablesGravity, r.ledger.gravity)
}

fn outflow(r: &MomentumRow) -> f64 {
    let out = r.ledger.departed_momentum[0];
    if seeded::is(Seed::TablesOutflow) { out } else { -out }
}

fn traction(r: &Touching) -> [f64; 2] {
    seeded::exchanged(Seed::TablesTraction, r.2.traction(r.1))
}

fn moving(r: &(f64, FieldCell)) -> [f64; 2] {
    seeded::exchanged(Seed::TablesField, r.1.v)
}

const SAMPLE_TIME: &[Column<HistoryRow>] = columns![HistoryRow;
    "time_s", "s", "end of the sample's interval, after release; forces are means over the interval", |r, _| r.time;
];

const SAMPLE_FORCES: &[Column<HistoryRow>] = columns![HistoryRow;
    "force_normal_n", "N", "force against the barrier's face, positive when the material pushes; its base shear", |r, _| seeded::times(Seed::TablesNormal, r.normal);
    "force_tangential_n", "N", "force along the face, positive towards the crest, negative when the material drags it down", |r, _| seeded::times(Seed::TablesShear, r.tangential);
    "overturning_moment_n_m", "N m", "moment about the foot, positive when the material pushes the barrier over", |r, _| seeded::times(Seed::TablesMoment, r.moment);
    "force_normal_max_n", "N", "largest normal force of a single step in the interval", |r, _| r.normal_max;
    "force_layer1_n", "N", "normal force from the stress of the nearest layer of material points", |r, _| layers(r)[0];
    "force_layer2_n", "N", "the same from the nearest two layers", |r, _| r.layers[1];
    "force_layer3_n", "N", "the same from the nearest three layers", |r, _| layers(r)[1];
];

const SAMPLE_BASE: &[Column<HistoryRow>] = columns![HistoryRow;
    "base_normal_n", "N", "force of the base on the material along its normal", |r, _| base(r)[0];
    "base_friction_n", "N", "force of the base on the material along it, positive where the flow runs", |r, _| base(r)[1];
];

const SAMPLE_FRONT: &[Column<HistoryRow>] = columns![HistoryRow;
    "front_x_m", "m", "position that 1 % of the flow's mass has passed: the 99 % quantile, which lags the edge in a long flow", |r, _| r.front.x;
    "front_edge_x_m", "m", "position of the foremost point of the flow: its edge", |r, _| r.front.edge;
    "front_velocity_m_per_s", "m/s", "mean velocity of the mass within front_length_m behind the front and of all ahead of it, positive where the flow runs", |r, _| front(r)[0];
    "front_depth_m", "m", "largest flow depth within twice that length behind the front", |r, _| front(r)[1];
];

const SAMPLE_CREST: &[Column<HistoryRow>] = columns![HistoryRow;
    "run_up_m", "m", "highest single point within 1.5 cells of the barrier's face, above its foot", |r, _| r.run_up;
    "run_up_p95_m", "m", "95th percentile of the heights of the points there, if they are twenty or more, else 0", |r, _| r.run_up_p95;
    "overtopped_kg", "kg", "mass that went over the barrier's crest since the release", |r, _| r.passage.over;
    "passed_under_kg", "kg", "mass that went under the barrier since the release", |r, _| r.passage.under;
    "passed_kg", "kg", "all mass that has passed the barrier since the release, on whatever way", |r, _| r.passage.past;
];

const SAMPLE_WINDOW: &[Column<HistoryRow>] = columns![HistoryRow;
    "window_speed_mean_m_per_s", "m/s", "mean speed of the points in the window", |r, _| window(r)[0];
    "window_speed_p95_m_per_s", "m/s", "their 95th percentile", |r, _| window(r)[1];
];

const SAMPLE_STATE: &[Column<HistoryRow>] = columns![HistoryRow;
    "kinetic_j", "J", "kinetic energy of everything but barriers", |r, _| r.kinetic;
    "penetration_m", "m", "deepest that a point lies inside a boundary or a barrier", |r, _| r.penetration;
    "time_step_s", "s", "length of the last time step", |r, _| r.time_step;
];

const SAMPLE_INFLOW: &[Column<HistoryRow>] = columns![HistoryRow;
    "entered_kg", "kg", "mass that has entered with inflows; only where the case has one", |r, _| r.entered;
];

/// Samples of the gauges.
pub(super) static HISTORY: TableKind<HistoryRow> = TableKind {
    file: "history.csv",
    row: "a sample of the gauges, with the forces on the first barrier",
    groups: &[
        Group(Per::Table, SAMPLE_TIME),
        Group(Per::Table, SAMPLE_FORCES),
        Group(Per::Table, SAMPLE_BASE),
        Group(Per::Table, SAMPLE_FRONT),
        Group(Per::Table, SAMPLE_CREST),
        Group(Per::Table, SAMPLE_WINDOW),
        Group(Per::Table, SAMPLE_STATE),
        Group(Per::Inflow, SAMPLE_INFLOW),
    ],
};

/// Samples of a barrier that is not the first.
pub(super) static FURTHER: TableKind<HistoryRow> = TableKind {
    file: "history_NAME.csv",
    row: "a sample of the barrier NAME, where it is not the first",
    groups: &[Group(Per::Table, SAMPLE_TIME), Group(Per::Table, SAMPLE_FORCES), Group(Per::Table, SAMPLE_CREST)],
};

/// Samples of a base that is not the first.
pub(super) static FURTHER_BASE: TableKind<HistoryRow> = TableKind {
    file: "base_NAME.csv",
    row: "a sample of the base NAME, where it is not the first",
    groups: &[Group(Per::Table, SAMPLE_TIME), Group(Per::Table, SAMPLE_BASE)],
};

/// Samples of a window that has a name.
pub(super) static WINDOW: TableKind<HistoryRow> = TableKind {
    file: "window_NAME.csv",
    row: "a sample of the window NAME; speeds are those at the end of its interval",
    groups: &[Group(Per::Table, SAMPLE_TIME), Group(Per::Table, SAMPLE_WINDOW)],
};

/// Energy by mechanism.
pub(super) static ENERGY: TableKind<EnergyRow> = TableKind {
    file: "energy.csv",
    row: "the energy of everything, every tenth sample; dissipation is positive and counts from release",
    groups: &[
        Group(
            Per::Table,
            columns![EnergyRow;
                "time_s", "s", "after release", |r, _| r.time;
                "kinetic_j", "J", "kinetic energy", |r, _| r.balance.kinetic;
                "gravitational_j", "J", "gravitational energy above the first barrier's foot, or above the lowest corner of what flows as it is drawn, if that is lower or there is no barrier", |r, _| r.balance.gravitational;
                "elastic_j", "J", "elastic energy", |r, _| r.balance.elastic;
                "plastic_j", "J", "work of the stresses that was not stored", |r, _| r.balance.plastic;
            ],
        ),
        Group(
            Per::Surface,
            columns![EnergyRow;
                "friction_{surface}_j", "J", "dissipated by sliding on this boundary, or between these two bodies", |r, k| lost(r, k)[0];
            ],
        ),
        Group(
            Per::Surface,
            columns![EnergyRow;
                "contact_{surface}_j", "J", "normal motion lost at this boundary, or between these two bodies; negative where a moving boundary does work", |r, k| lost(r, k)[1];
            ],
        ),
        Group(
            Per::Table,
            columns![EnergyRow;
                "pic_j", "J", "taken by the PIC share of the velocity update", |r, _| r.balance.pic;
                "damping_j", "J", "taken by damping", |r, _| r.balance.damping;
                "side_walls_j", "J", "dissipated by friction on the side walls", |r, _| r.balance.side_walls;
                "outflow_j", "J", "carried out of the domain", |r, _| r.balance.outflow;
            ],
        ),
        Group(
            Per::Inflow,
            columns![EnergyRow;
                "inflow_j", "J", "given by inflows: kinetic, gravitational and elastic energy of what has entered, and the work of what pushed behind it; only where the case has one", |r, _| r.balance.inflow;
            ],
        ),
        Group(
            Per::Table,
            columns![EnergyRow;
                "residual_j", "J", "what was there at release and what inflows gave, less all of the above", |r, _| r.balance.residual;
            ],
        ),
    ],
};

/// Momentum by agent.
pub(super) static MOMENTUM: TableKind<MomentumRow> = TableKind {
    file: "momentum.csv",
    row: "the impulses on everything since release, every tenth sample",
    groups: &[
        Group(
            Per::Table,
            columns![MomentumRow;
                "time_s", "s", "after release", |r, _| r.time;
                "gained_x_n_s", "N s", "momentum along x less that at release", |r, _| r.gained[0];
                "gained_y_n_s", "N s", "momentum along y less that at release", |r, _| r.gained[1];
                "gravity_x_n_s", "N s", "impulse of gravity along x", |r, _| gravity(r)[0];
                "gravity_y_n_s", "N s", "impulse of gravity along y", |r, _| gravity(r)[1];
            ],
        ),
        Group(
            Per::Boundary,
            columns![MomentumRow;
                "{boundary}_x_n_s", "N s", "impulse of this boundary on the material along x", |r, k| r.ledger.boundaries[k].impulse[0];
                "{boundary}_y_n_s", "N s", "impulse of this boundary on the material along y", |r, k| r.ledger.boundaries[k].impulse[1];
            ],
        ),
        Group(
            Per::Table,
            columns![MomentumRow;
                "damping_x_n_s", "N s", "impulse of damping along x", |r, _| r.ledger.damping.impulse[0];
                "damping_y_n_s", "N s", "impulse of damping along y", |r, _| r.ledger.damping.impulse[1];
                "side_walls_x_n_s", "N s", "impulse of the side walls along x", |r, _| r.ledger.side_walls.impulse[0];
                "side_walls_y_n_s", "N s", "impulse of the side walls along y", |r, _| r.ledger.side_walls.impulse[1];
                "outflow_x_n_s", "N s", "momentum along x carried out of the domain, as a loss", |r, _| outflow(r);
                "outflow_y_n_s", "N s", "momentum along y carried out of the domain, as a loss", |r, _| -r.ledger.departed_momentum[1];
            ],
        ),
        Group(
            Per::Inflow,
            columns![MomentumRow;
                "inflow_x_n_s", "N s", "momentum along x that came in with inflows, and impulse of what pushed behind it; only where the case has one", |r, _| r.ledger.inflow(0);
                "inflow_y_n_s", "N s", "the same along y: what the bed bears of the cells behind the section comes in as a load", |r, _| r.ledger.inflow(1);
            ],
        ),
        Group(
            Per::Table,
            columns![MomentumRow;
                "residual_x_n_s", "N s", "gained along x less all impulses", |r, _| r.residual[0];
                "residual_y_n_s", "N s", "gained along y less all impulses", |r, _| r.residual[1];
            ],
        ),
    ],
};

/// Depth and velocity at the stations: time and sample.
pub(super) static STATIONS: TableKind<(f64, StationSample)> = TableKind {
    file: "stations.csv",
    row: "a station at a moment, every tenth sample",
    groups: &[Group(
        Per::Table,
        columns![(f64, StationSample);
            "time_s", "s", "after release", |r, _| r.0;
            "x_m", "m", "place of the station", |r, _| r.1.x;
            "depth_m", "m", "flow depth in a strip two cells wide around it", |r, _| seeded::times(Seed::TablesStation, r.1.depth);
            "velocity_m_per_s", "m/s", "mean velocity along x in that strip", |r, _| r.1.velocity;
        ],
    )],
};

/// Mean pressure on a barrier: time, height, pressure.
pub(super) static PRESSURE: TableKind<[f64; 3]> = TableKind {
    file: "pressure_profile.csv",
    row: "a height on the barrier over an interval between VTK frames",
    groups: &[Group(
        Per::Table,
        columns![[f64; 3];
            "time_s", "s", "end of the interval, after release", |r, _| r[0];
            "height_m", "m", "height of the middle of the bin above the foot; bins are one cell high, half a cell at foot and crest", |r, _| r[1];
            "pressure_pa", "Pa", "mean pressure over the interval", |r, _| seeded::times(Seed::TablesPressure, r[2]);
        ],
    )],
};

/// A barrier that is a body: time and sample.
pub(super) static STRUCTURE: TableKind<(f64, StructureSample)> = TableKind {
    file: "barrier.csv",
    row: "a sample of a barrier that is a body; forces are means over the interval, against its face at the start and along it",
    groups: &[Group(
        Per::Table,
        columns![(f64, StructureSample);
            "time_s", "s", "end of the sample's interval, after release", |r, _| r.0;
            "contact_normal_n", "N", "what the material gives to the barrier, against its face", |r, _| r.1.contact.normal;
            "contact_tangential_n", "N", "what the material gives to the barrier, towards its crest", |r, _| r.1.contact.tangential;
            "clamp_normal_n", "N", "what the barrier gives to its clamp, against its face", |r, _| seeded::times(Seed::TablesClamp, r.1.clamp.normal);
            "clamp_tangential_n", "N", "what the barrier gives to its clamp, towards its crest", |r, _| r.1.clamp.tangential;
            "clamp_moment_n_m", "N m", "moment on the clamp about the foot, positive when it turns the barrier over", |r, _| seeded::times(Seed::TablesClampMoment, r.1.clamp_moment);
            "inertia_normal_n", "N", "rate of the barrier's momentum, against its face", |r, _| seeded::times(Seed::TablesInertia, r.1.inertia.normal);
            "inertia_tangential_n", "N", "rate of the barrier's momentum, towards its crest", |r, _| r.1.inertia.tangential;
            "imbalance", "1", "contact and weight less clamp and inertia, over the sum of their magnitudes: round-off", |r, _| r.1.imbalance;
            "tip_deflection_m", "m", "deflection of the highest point of the face, away from the material", |r, _| seeded::times(Seed::TablesTip, r.1.bend.tip);
            "tip_velocity_m_per_s", "m/s", "its velocity", |r, _| r.1.bend.tip_velocity;
            "largest_deflection_m", "m", "largest deflection of the face", |r, _| r.1.bend.largest;
            "largest_deflection_height_m", "m", "its height above the foot at the start", |r, _| r.1.bend.largest_at;
            "penetration_m", "m", "deepest that a point's domain lies inside the barrier", |r, _| r.1.survey.penetration;
            "gap_cells", "cells", "widest gap between neighbouring points beyond what stretch explains; from 0.25 on the barrier is torn", |r, _| r.1.bend.gap;
            "gap_height_m", "m", "its height above the foot at the start", |r, _| r.1.bend.gap_at;
            "run_up_m", "m", "highest material within 1.5 cells of the face, above the foot", |r, _| r.1.survey.run_up;
            "behind_kg", "kg", "mass behind the barrier, there or where it left the domain since the release", |r, _| r.1.survey.behind;
        ],
    )],
};

const BENT: &[Column<(f64, ProfilePoint)>] = columns![(f64, ProfilePoint);
    "time_s", "s", "after release", |r, _| r.0;
    "height_m", "m", "height of the point above the foot at the start", |r, _| r.1.height;
    "deflection_m", "m", "deflection away from the material", |r, _| seeded::times(Seed::TablesBending, r.1.deflection);
    "velocity_m_per_s", "m/s", "velocity away from the material", |r, _| r.1.velocity;
];

/// How a barrier that is a body is bent.
pub(super) static BENDING: TableKind<(f64, ProfilePoint)> = TableKind {
    file: "barrier_profile.csv",
    row: "a point of the face of a barrier that is a body, at each VTK frame",
    groups: &[Group(Per::Table, BENT)],
};

/// How it was bent at its largest force.
pub(super) static BENDING_AT_PEAK: TableKind<(f64, ProfilePoint)> = TableKind {
    file: "barrier_profile_at_peak.csv",
    row: "a point of that face when the mean force of a sample was largest",
    groups: &[Group(Per::Table, BENT)],
};

/// The surface of a barrier that is a body: time, x, y.
pub(super) static OUTLINE: TableKind<[f64; 3]> = TableKind {
    file: "barrier_outline.csv",
    row: "a point of the surface of a barrier that is a body, in order, at each of field_times_s",
    groups: &[Group(
        Per::Table,
        columns![[f64; 3];
            "time_s", "s", "after release", |r, _| r[0];
            "x_m", "m", "place along x", |r, _| r[1];
            "y_m", "m", "place along y", |r, _| r[2];
        ],
    )],
};

/// A node where bodies touch: time (s), length of the step (s), what they did there.
pub(super) type Touching = (f64, f64, ContactPoint);

/// Traction between bodies.
pub(super) static CONTACT: TableKind<Touching> = TableKind {
    file: "contact.csv",
    row: "a node where two bodies touch in the last step, at each of field_times_s",
    groups: &[Group(
        Per::Table,
        columns![Touching;
            "time_s", "s", "after release", |r, _| r.0;
            "contact", "-", "number of the contact in the case, from 0", |r, _| r.2.contact as f64;
            "x_m", "m", "place of the node along x", |r, _| r.2.x[0];
            "y_m", "m", "place of the node along y", |r, _| r.2.x[1];
            "normal_x_1", "1", "unit normal out of the structure, along x", |r, _| r.2.normal[0];
            "normal_y_1", "1", "unit normal out of the structure, along y", |r, _| r.2.normal[1];
            "pressure_pa", "Pa", "normal traction, positive where the bodies press on each other", |r, _| traction(r)[0];
            "shear_pa", "Pa", "traction on the other body along the normal turned clockwise", |r, _| traction(r)[1];
            "area_m2", "m2", "area of contact that belongs to the node (Nairn 2013)", |r, _| r.2.area;
        ],
    )],
};

/// Velocity and stress by cell.
pub(super) static FIELD: TableKind<(f64, FieldCell)> = TableKind {
    file: "field.csv",
    row: "a cell that holds material, at each of field_times_s; means are weighted by mass",
    groups: &[Group(
        Per::Table,
        columns![(f64, FieldCell);
            "time_s", "s", "after release", |r, _| r.0;
            "x_m", "m", "middle of the cell along x", |r, _| r.1.x[0];
            "y_m", "m", "middle of the cell along y", |r, _| r.1.x[1];
            "solid_fraction", "1", "share of the cell's volume filled with material", |r, _| r.1.fill;
            "velocity_x_m_per_s", "m/s", "mean velocity along x", |r, _| moving(r)[0];
            "velocity_y_m_per_s", "m/s", "mean velocity along y", |r, _| moving(r)[1];
            "speed_m_per_s", "m/s", "magnitude of the mean velocity", |r, _| r.1.v[0].hypot(r.1.v[1]);
            "pressure_pa", "Pa", "mean of minus a third of the trace of the stress, positive in compression", |r, _| r.1.pressure;
            "plastic_shear_strain", "1", "mean equivalent plastic shear strain since the start", |r, _| r.1.plastic_shear;
        ],
    )],
};

/// Corners of the boundaries: number, x, y.
pub(super) static GEOMETRY: TableKind<[f64; 3]> = TableKind {
    file: "geometry.csv",
    row: "a corner of a boundary that stays, in order; planes are cut to a strip along the domain",
    groups: &[Group(
        Per::Table,
        columns![[f64; 3];
            "boundary", "-", "number of the boundary in the case, from 0", |r, _| r[0];
            "x_m", "m", "place of the corner along x", |r, _| r[1];
            "y_m", "m", "place of the corner along y", |r, _| r[2];
        ],
    )],
};

#[cfg(test)]
#[path = "columns_tests.rs"]
mod tests;
