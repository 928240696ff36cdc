//! From the inflows of a case to those of the solver: where their points are, and what stress they have.

use super::scene;
use crate::body::{Body, Particle};
use crate::case::{self, Case, ContactKind, Profile};
use crate::constitutive::{AnyLaw, DruckerPrager, Stress};
use crate::seeded::{self, Seed};
use crate::simulation::{Coming, Inflow, Simulation, Way};

/// Halvings after which a bracket is as narrow as numbers are.
const HALVINGS: usize = 60;

/// The simulation of a case, at its start.
pub fn simulation(case: &Case) -> Simulation {
    let mut scene = scene::build(case);
    scene.bodies.extend(case.inflows.iter().map(|i| body(case, i)));
    let mut simulation = Simulation::new(scene);
    if !case.inflows.is_empty() {
        let first = case.bodies.len();
        simulation.set_inflows((first..).zip(&case.inflows).filter_map(|(k, i)| inflow(case, i, k)).collect());
    }
    simulation
}

/// The body that what has entered belongs to, of which there is nothing yet.
fn body(case: &Case, inflow: &case::Inflow) -> (Body, Vec<Particle>) {
    let (mut body, _) = scene::body(case, &inflow.behind(&case.grid));
    let [along, across] = spacing(case, inflow);
    let volume = along * across * case.grid.thickness_m;
    body.point_mass *= volume / body.point_volume;
    body.point_volume = volume;
    body.point_spacing = (along * across).sqrt();
    (body, Vec::new())
}

/// Times, depths and velocities of an inflow; empty only for one that validation refuses.
fn hydrograph(case: &Case, inflow: &case::Inflow) -> [Vec<f64>; 3] {
    let Some([times, mut depths, mut speeds]) = inflow.hydrograph(case) else { return [vec![], vec![], vec![]] };
    depths.iter_mut().for_each(|d| *d = seeded::times(Seed::CaseInflowDepth, *d));
    speeds.iter_mut().for_each(|u| *u = seeded::times(Seed::CaseInflowVelocity, *u));
    [times, depths, speeds]
}

/// Distances of the points along and across the bed, m. Where the depth changes, those that their area is made of.
fn spacing(case: &Case, inflow: &case::Inflow) -> [f64; 2] {
    let wanted = inflow.particle_spacing_m(&case.grid);
    let [times, depths, speeds] = hydrograph(case, inflow);
    if inflow.is_varied() || times.is_empty() {
        return [wanted; 2];
    }
    let length = Way { times: times.clone(), speeds }.travel(times[times.len() - 1]);
    [length, depths[0]].map(|side| {
        let count = (side / wanted).round().max(1.0);
        side / count
    })
}

/// `None` only for an inflow that validation refuses.
fn inflow(case: &Case, inflow: &case::Inflow, body: usize) -> Option<Inflow> {
    let [times, depths, speeds] = hydrograph(case, inflow);
    let spacing = spacing(case, inflow);
    let way = Way { times: times.clone(), speeds };
    let length = way.travel(*times.last()?);
    let mut points = if inflow.is_varied() {
        let depth = |travel: f64| depth_at(&way, &depths, travel);
        columns(depth, length, spacing[0])
    } else {
        rows(inflow, depths[0], length, spacing)
    };
    let reach = case::Inflow::LED_CELLS * case.grid.spacing_m;
    let appears = |c: &Coming| (c.behind - reach) / c.pace;
    // In the order of their columns and heights where they appear together.
    points.sort_by(|a, b| appears(a).total_cmp(&appears(b)));
    let mut foot = inflow.foot_m;
    if seeded::is(Seed::CaseInflowFoot) {
        foot[0] += 0.1 * case.grid.spacing_m;
    }
    let (direction, column) = (inflow.direction(), spacing[0]);
    Some(Inflow { body, foot, direction, way, points, stress: layer(case, inflow)?, reach, column })
}

/// Points of a flow of one depth: rows at heights of their own, each with the mean velocity of what it stands for, from the wedge of the
/// front on.
fn rows(inflow: &case::Inflow, depth: f64, length: f64, [along, across]: [f64; 2]) -> Vec<Coming> {
    let count = (depth / across).round() as usize;
    let steep = inflow.front_angle_or_default_deg();
    let mut points = Vec::new();
    for row in 0..count {
        let share = |k: usize| inflow.profile.discharge_below(k as f64 / count as f64);
        let pace = if inflow.profile == Profile::Plug { 1.0 } else { count as f64 * (share(row + 1) - share(row)) };
        let height = (row as f64 + 0.5) * across;
        let wedge = if steep >= 90.0 { 0.0 } else { height / libm::tan(steep.to_radians()) };
        let columns = ((pace * length - wedge) / along).round().max(0.0) as usize;
        points.extend((0..columns).map(|k| {
            let behind = wedge + (k as f64 + 0.5) * along;
            let depth = if steep >= 90.0 { depth } else { depth.min(behind * libm::tan(steep.to_radians())) };
            Coming { behind, height, pace, depth }
        }));
    }
    points
}

/// Points of a flow of changing depth that slides: columns that are as deep as the flow is there and have as many points as come nearest to
/// the wanted distance, and are as long as the area of these points asks for.
fn columns(depth: impl Fn(f64) -> f64, length: f64, wanted: f64) -> Vec<Coming> {
    let mut points = Vec::new();
    let mut start = 0.0;
    loop {
        let deep = depth(start + 0.5 * wanted);
        let count = (deep / wanted).round().max(1.0);
        let long = count * wanted * wanted / deep;
        let behind = start + 0.5 * long;
        if behind > length {
            return points;
        }
        let across = deep / count;
        let point = |row: usize| Coming { behind, height: (row as f64 + 0.5) * across, pace: 1.0, depth: deep };
        points.extend((0..count as usize).map(point));
        start += long;
    }
}

/// Depth (m) of the flow when it has travelled so far (m).
fn depth_at(way: &Way, depths: &[f64], travel: f64) -> f64 {
    let [mut low, mut high] = way.span();
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if way.travel(middle) < travel { low = middle } else { high = middle }
    }
    let k = way.times.partition_point(|t| *t <= low).clamp(1, depths.len() - 1);
    let share = ((low - way.times[k - 1]) / (way.times[k] - way.times[k - 1])).clamp(0.0, 1.0);
    depths[k - 1] + share * (depths[k] - depths[k - 1])
}

/// Stress at a depth of a metre of a uniform layer on the slope, Pa.
///
/// Across the bed a layer carries its weight: sigma_yy = rho g_y z at the depth z below its surface, with g_y negative. Its shear is what
/// the bed takes: of a plug, the friction of the bed against its motion, so that every height of it is slowed or driven alike; of a flow
/// that sticks to the bed, rho g_x z as in steady flow. Along the bed sigma_xx = K sigma_yy with K = nu / (1 - nu), that of a layer that has
/// never been strained along the bed, and across the plane the stress is the elastic one, nu (sigma_xx + sigma_yy). Where this lies outside of
/// the cone, the layer flows: across the plane it has half of the sum, to which flow at constant volume brings it in plane strain, and the
/// nearest K that lies in the cone, which is that of Rankine's active state on a slope. On slopes steeper than the angle of friction no K does, and
/// the shear is as large as the cone lets it be.
fn layer(case: &Case, inflow: &case::Inflow) -> Option<Stress> {
    let material = case.materials.get(&inflow.material)?;
    let [gx, gy] = scene::gravity(case, case.gravity.inclination_deg);
    if gy >= 0.0 {
        return Some(Stress::default());
    }
    let bed = inflow.bed(case)?;
    let friction = match bed.contact {
        ContactKind::Smooth => 0.0,
        ContactKind::Coulomb => bed.friction?,
        ContactKind::Rough | ContactKind::Bonded => f64::INFINITY,
    };
    let steady = gx / -gy;
    let wanted = if inflow.profile == Profile::Plug && friction.is_finite() {
        inflow.direction() * friction
    } else {
        steady.clamp(-friction, friction)
    };
    let nu = material.poisson;
    let law = match scene::law(material) {
        AnyLaw::DruckerPrager(law) => Some(law),
        // It enters before it has sheared.
        AnyLaw::SofteningDruckerPrager(law) => Some(law.peak),
        _ => None,
    };
    let Layer { k, across, share } = in_cone(law.as_ref(), nu, wanted);
    let weight = material.density_kg_per_m3 * -gy;
    let [xx, yy] = [-weight * k, -weight];
    Some(Stress { xx, yy, zz: across * (xx + yy), xy: weight * share * wanted })
}

/// A stress of the layer over the pressure across the bed.
#[derive(Debug, Clone, Copy)]
struct Layer {
    /// sigma_xx over sigma_yy.
    k: f64,
    /// sigma_zz over the sum of both.
    across: f64,
    /// The shear that is borne, of that which is wanted.
    share: f64,
}

impl Layer {
    /// How far the stress lies beyond the cone of a law without cohesion: not above zero inside. It is convex in the stress.
    fn beyond(&self, law: &DruckerPrager, shear: f64) -> f64 {
        let s = Stress { xx: -self.k, yy: -1.0, zz: -self.across * (1.0 + self.k), xy: self.share * shear };
        s.j2().sqrt() + law.friction * s.mean()
    }

    /// With the K that lies deepest in the cone.
    fn deepest(self, law: &DruckerPrager, shear: f64) -> Self {
        let [mut low, mut high] = [0.0, 10.0];
        let at = |k: f64| Self { k, ..self }.beyond(law, shear);
        for _ in 0..2 * HALVINGS {
            let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if at(a) < at(b) {
                high = b;
            } else {
                low = a;
            }
        }
        Self { k: 0.5 * (low + high), ..self }
    }
}

/// The stress nearest to that of a layer at rest that lies in the cone; see [`layer`].
fn in_cone(law: Option<&DruckerPrager>, nu: f64, shear: f64) -> Layer {
    let at_rest = Layer { k: nu / (1.0 - nu), across: nu, share: 1.0 };
    let Some(law) = law else { return at_rest };
    let fits = |l: Layer| l.deepest(law, shear).beyond(law, shear) <= 0.0;
    if at_rest.beyond(law, shear) <= 0.0 {
        return at_rest;
    }
    let mut chosen = Layer { across: 0.5, ..at_rest };
    if !fits(chosen) {
        let [mut low, mut high] = [0.0, 1.0];
        for _ in 0..HALVINGS {
            let share = 0.5 * (low + high);
            if fits(Layer { share, ..chosen }) {
                low = share;
            } else {
                high = share;
            }
        }
        chosen.share = low;
    }
    if chosen.beyond(law, shear) <= 0.0 {
        return chosen;
    }
    let [mut outside, mut inside] = [chosen.k, chosen.deepest(law, shear).k];
    for _ in 0..HALVINGS {
        let k = 0.5 * (outside + inside);
        if (Layer { k, ..chosen }).beyond(law, shear) > 0.0 {
            outside = k;
        } else {
            inside = k;
        }
    }
    Layer { k: inside, ..chosen }
}

#[cfg(test)]
#[path = "inflow_tests.rs"]
mod tests;
