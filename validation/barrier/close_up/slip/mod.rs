//! Where plastic work is done relative to the slip surface, beside friction: what the paper's "85 % in pile-up" can
//! mean.
//!
//! **Plastic work** of a material point over a step is what the stresses do on the plastic strain, with the midpoint rule of the ledger: V
//! (s0 + s1)/2 : de_p + V (m0 + m1)/2 do. The plastic strain has the direction of the deviator s1 to which the law returns. Its size
//! follows from the change of the equivalent plastic shear strain that the point carries. m is the mean stress, and o the volumetric strain
//! by which the point has come apart. That is exact for a cone without dilatancy, as the sand has here ([`work`]). The sum over all points
//! has to be the plastic work of the ledger, which knows total work and stored energy only: a check on the record.
//!
//! **The slip surface** is the boundary between the deposit and everything else. Over every [`INTERVAL`], a grid cell rests if the mean
//! displacement of its sand is less than a share of what the front does in that time. That is in the frame of the flume: sand that goes
//! with a barrier that swings is not at rest. The deposit is the resting cells that hang together, over edges or corners, with some that
//! lie within [`TOUCH`] cells of the barrier ([`regions`]). A cell is at the slip surface if a cell with sand of the other side lies within
//! a number of cells of it, centre to centre. Work goes to where its point is at the end of the interval. That is the deposit away from the
//! slip surface, the slip surface on the deposit's or on the flow's side, or the flow away from it, which is all other sand. As long as
//! nothing rests, all is flow.
//!
//! Both thresholds are choices. What halving and doubling them changes is in the table of thresholds.

mod observer;
pub mod regions;
pub mod shares;
pub mod work;

pub(super) use observer::{Observer, Row};

use regions::Threshold;

/// Length of an interval, s.
pub const INTERVAL: f64 = 0.002;
/// A row of the table every so many intervals.
pub const ROW: u64 = 10;
/// How near the barrier a part of the deposit must lie, cells.
pub const TOUCH: i64 = 2;
/// Half or twice as much of each threshold is looked at beside these, which come first.
pub const THRESHOLDS: [Threshold; 5] = [
    Threshold { rest: 0.05, cells: 2 },
    Threshold { rest: 0.025, cells: 2 },
    Threshold { rest: 0.1, cells: 2 },
    Threshold { rest: 0.05, cells: 1 },
    Threshold { rest: 0.05, cells: 4 },
];
