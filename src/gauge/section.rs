//! How the flow moves just beyond the section at which it enters: a deposit that has grown back to it takes no more in, and what is led
//! behind it is pushed into that.

use super::flow::flowing_extents;
use crate::simulation::{Inflow, Simulation};

/// Mean velocity where the flow runs, m/s, of the material from the section on, over `length` (m). `None` where there is none.
pub fn velocity_beyond(simulation: &Simulation, inflow: &Inflow, length: f64) -> Option<f64> {
    let way = inflow.direction;
    let ahead = |x: f64| way * (x - inflow.foot[0]);
    let near = flowing_extents(simulation, &[])
        .filter(|e| ahead(e.low[0]).max(ahead(e.high[0])) >= 0.0 && ahead(e.low[0]).min(ahead(e.high[0])) <= length);
    let (mut mass, mut momentum) = (0.0, 0.0);
    for extent in near {
        let m = simulation.bodies()[extent.body].point_mass;
        for (block, n) in simulation.blocks_in(extent) {
            for l in (0..n).filter(|&l| (0.0..=length).contains(&ahead(block.x[0][l]))) {
                mass += m;
                momentum += m * way * block.v[0][l];
            }
        }
    }
    (mass > 0.0).then(|| momentum / mass)
}
