//! Transformations of a case: what is written in it, moved, turned, mirrored, scaled or written in another order.

use checkdam::case::{Body, Boundary, Case, MaterialSide, Rectangle, Towards};

/// Factors of mass (with the density), length, time, and of the width alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factors {
    /// Of mass, at the same width.
    pub mass: f64,
    /// Of lengths, the width among them.
    pub length: f64,
    /// Of times.
    pub time: f64,
    /// Of the width, and of masses, forces and energies with it.
    pub width: f64,
}

impl Factors {
    /// None.
    pub const ONE: Self = Self { mass: 1.0, length: 1.0, time: 1.0, width: 1.0 };

    /// Those of a model at equal Froude number, of the same density: `length` times as long, its times as the square root.
    pub fn froude(length: f64) -> Self {
        Self { mass: length * length * length, length, time: length.sqrt(), width: 1.0 }
    }

    /// The factor of a number of this name, which ends in its unit.
    pub fn of(&self, name: &str) -> f64 {
        let power = |x: f64, n: i32| (0..n.abs()).fold(1.0, |y, _| if n > 0 { y * x } else { y / x });
        let found = UNITS.iter().find(|(unit, _)| name.ends_with(unit));
        let [m, l, t, w] = found.map_or([0; 4], |u| u.1);
        power(self.mass, m) * power(self.length, l) * power(self.time, t) * power(self.width, w)
    }
}

/// Units as names end in them: powers of mass, length, time and width. Longer ones come first.
const UNITS: [(&str, [i32; 4]); 15] = [
    ("_kg_per_m3", [1, -3, 0, 0]),
    ("_m_per_s2", [0, 1, -2, 0]),
    ("_m_per_s", [0, 1, -1, 0]),
    ("_per_s", [0, 0, -1, 0]),
    ("_hz", [0, 0, -1, 0]),
    ("_n_m", [1, 2, -2, 1]),
    ("_n_s", [1, 1, -1, 1]),
    ("_kg", [1, 0, 0, 1]),
    ("_pa", [1, -1, -2, 0]),
    ("_deg", [0, 0, 0, 0]),
    ("_j", [1, 2, -2, 1]),
    ("_n", [1, 1, -2, 1]),
    ("_m", [0, 1, 0, 0]),
    ("_s", [0, 0, 1, 0]),
    ("_1", [0, 0, 0, 0]),
];

fn scale(factor: f64, number: &mut f64) {
    *number *= factor;
}

/// All lengths, times, masses of a case.
pub fn scaled(case: &Case, by: &Factors) -> Case {
    let mut case = case.clone();
    let [length, time, speed] = [by.length, by.time, by.of("_m_per_s")];
    let lengths = |xs: &mut [f64]| xs.iter_mut().for_each(|x| scale(length, x));
    scale(by.of("_m_per_s2"), &mut case.gravity.magnitude_m_per_s2);
    scale(length, &mut case.grid.spacing_m);
    scale(length * by.width, &mut case.grid.thickness_m);
    [&mut case.grid.origin_m, &mut case.domain.x_m, &mut case.domain.y_m].into_iter().for_each(|x| lengths(x));
    for material in case.materials.values_mut() {
        scale(by.of("_kg_per_m3"), &mut material.density_kg_per_m3);
        let stresses = [
            &mut material.cohesion_pa,
            &mut material.tension_cutoff_pa,
            &mut material.shear_strength_pa,
            &mut material.hardening_pa,
        ];
        let stresses = stresses.into_iter().flatten().chain([&mut material.young_pa]);
        stresses.for_each(|x| scale(by.of("_pa"), x));
        material.viscosity_pa_s.iter_mut().for_each(|x| scale(by.of("_pa") * time, x));
        material.grain_diameter_m.iter_mut().for_each(|x| scale(length, x));
        material.grain_density_kg_per_m3.iter_mut().for_each(|x| scale(by.of("_kg_per_m3"), x));
    }
    for body in &mut case.bodies {
        body.x_m.iter_mut().chain(&mut body.y_m).for_each(|x| lengths(x));
        places(body).for_each(|x| lengths(x));
        let own = [&mut body.radius_m, &mut body.inner_radius_m, &mut body.height_m, &mut body.thickness_m];
        own.into_iter().flatten().for_each(|x| scale(length, x));
        body.velocity_m_per_s.iter_mut().for_each(|v| scale(speed, v));
        body.spin_rad_per_s.iter_mut().for_each(|w| scale(1.0 / time, w));
        body.velocity_gradient_per_s.iter_mut().flatten().flatten().for_each(|g| scale(1.0 / time, g));
        body.mass_kg.iter_mut().for_each(|m| scale(by.of("_kg"), m));
    }
    for inflow in &mut case.inflows {
        lengths(&mut inflow.foot_m);
        inflow.depth_m.iter_mut().chain(inflow.depths_m.iter_mut().flatten()).for_each(|x| scale(length, x));
        inflow
            .velocity_m_per_s
            .iter_mut()
            .chain(inflow.velocities_m_per_s.iter_mut().flatten())
            .for_each(|v| scale(speed, v));
        let times = [&mut inflow.start_time_s, &mut inflow.duration_s];
        times.into_iter().flatten().chain(inflow.times_s.iter_mut().flatten()).for_each(|t| scale(time, t));
        inflow.mass_kg.iter_mut().for_each(|m| scale(by.of("_kg"), m));
    }
    for b in &mut case.boundaries {
        b.point_m.iter_mut().chain(&mut b.foot_m).chain(b.points_m.iter_mut().flatten()).for_each(|x| lengths(x));
        let own = [&mut b.height_m, &mut b.thickness_m, &mut b.slip_length_m, &mut b.opening_m];
        own.into_iter().flatten().for_each(|x| scale(length, x));
        b.lift_speed_m_per_s.iter_mut().for_each(|v| scale(speed, v));
    }
    let stages = &mut case.stages;
    if let Some(settle) = &mut stages.settle {
        scale(1.0 / time, &mut settle.damping_per_s);
        scale(time, &mut settle.max_time_s);
    }
    stages.tilt.iter_mut().for_each(|t| scale(time, &mut t.duration_s));
    scale(time, &mut stages.run.end_time_s);
    let gauges = &mut case.gauges;
    scale(1.0 / time, &mut gauges.sample_rate_hz);
    lengths(&mut gauges.stations_m);
    gauges.window_x_m.iter_mut().chain(&mut gauges.window_y_m).for_each(|x| lengths(x));
    gauges.front_length_m.iter_mut().for_each(|x| scale(length, x));
    gauges.arrival_force_n.iter_mut().for_each(|x| scale(by.of("_n"), x));
    gauges.field_times_s.iter_mut().for_each(|x| scale(time, x));
    scale(time, &mut case.output.vtk_interval_s);
    case.numerics.pic_rate_per_s.iter_mut().for_each(|x| scale(1.0 / time, x));
    case.numerics.max_time_step_s.iter_mut().for_each(|x| scale(time, x));
    case
}

/// Everything that says where, moved; the nodes of the grid with it or not.
pub fn moved(case: &Case, by: [f64; 2], with_the_grid: bool) -> Case {
    let mut case = case.clone();
    let both = |place: &mut [f64; 2]| (0..2).for_each(|d| place[d] += by[d]);
    let along = |d: usize, places: &mut [f64]| places.iter_mut().for_each(|x| *x += by[d]);
    along(0, &mut case.domain.x_m);
    along(1, &mut case.domain.y_m);
    for body in &mut case.bodies {
        body.x_m.iter_mut().for_each(|x| along(0, x));
        body.y_m.iter_mut().for_each(|y| along(1, y));
        places(body).for_each(both);
    }
    case.inflows.iter_mut().for_each(|inflow| both(&mut inflow.foot_m));
    for b in &mut case.boundaries {
        b.point_m.iter_mut().chain(&mut b.foot_m).chain(b.points_m.iter_mut().flatten()).for_each(both);
    }
    along(0, &mut case.gauges.stations_m);
    case.gauges.window_x_m.iter_mut().for_each(|x| along(0, x));
    case.gauges.window_y_m.iter_mut().for_each(|y| along(1, y));
    if with_the_grid {
        let h = case.grid.spacing_m;
        (0..2).for_each(|d| case.grid.origin_m[d] += by[d] - (by[d] / h).round() * h);
    }
    case
}

/// The places of a body that is no rectangle written by its edges.
fn places(body: &mut Body) -> impl Iterator<Item = &mut [f64; 2]> {
    body.polygon_m.iter_mut().flatten().chain(&mut body.centre_m).chain(&mut body.foot_m)
}

/// A rectangle that is written by its edges, if the body is one.
fn edges(body: &Body) -> Option<Rectangle> {
    body.rectangle().filter(|_| body.x_m.is_some())
}

/// A corner of a rectangle and its lengths as they are written.
fn place(body: &mut Body, corner: [f64; 2], [length, height]: [f64; 2]) {
    body.x_m = Some([corner[0], corner[0] + length]);
    body.y_m = Some([corner[1], corner[1] + height]);
}

/// The other side.
fn opposite(side: Option<MaterialSide>) -> Option<MaterialSide> {
    Some(match side.unwrap_or_default() {
        MaterialSide::Left => MaterialSide::Right,
        MaterialSide::Right => MaterialSide::Left,
    })
}

/// Right and left exchanged.
pub fn mirrored(case: &Case) -> Case {
    let mut case = case.clone();
    let swap = |range: &mut [f64; 2]| *range = [-range[1], -range[0]];
    case.gravity.inclination_deg *= -1.0;
    case.gravity.settle_inclination_deg = case.gravity.settle_inclination_deg.map(|a| 0.0 - a);
    case.grid.origin_m[0] *= -1.0;
    swap(&mut case.domain.x_m);
    for body in &mut case.bodies {
        if let Some(r) = edges(body) {
            // The lower right corner becomes the lower left one.
            let corner = r.corners_m()[1];
            place(body, [-corner[0], corner[1]], r.size_m);
            body.rotation_deg *= -1.0;
        } else if body.foot_m.is_some() {
            body.inclination_deg = Some(180.0 - body.inclination_deg.unwrap_or(90.0));
            body.material_side = opposite(body.material_side);
        } else {
            // The axis of its columns or sectors becomes its mirror image, not that turned round.
            body.rotation_deg = 180.0 - body.rotation_deg;
        }
        places(body).for_each(|x| x[0] *= -1.0);
        body.velocity_m_per_s[0] *= -1.0;
        body.spin_rad_per_s.iter_mut().for_each(|w| *w *= -1.0);
        body.velocity_gradient_per_s.iter_mut().for_each(|[[_, xy], [yx, _]]| (*xy, *yx) = (-*xy, -*yx));
    }
    for inflow in &mut case.inflows {
        inflow.foot_m[0] *= -1.0;
        inflow.towards = if inflow.towards == Towards::Right { Towards::Left } else { Towards::Right };
    }
    for b in &mut case.boundaries {
        let points = b.points_m.iter_mut().flatten();
        b.point_m.iter_mut().chain(&mut b.foot_m).chain(points).for_each(|x| x[0] *= -1.0);
        b.normal_deg.iter_mut().for_each(|a| *a = 180.0 - *a);
        if b.foot_m.is_some() {
            b.inclination_deg = Some(180.0 - b.inclination_deg.unwrap_or(90.0));
        }
        if b.foot_m.is_some() || b.points_m.is_some() {
            b.material_side = opposite(b.material_side);
        }
    }
    case.gauges.stations_m.iter_mut().for_each(|x| *x *= -1.0);
    case.gauges.window_x_m.iter_mut().for_each(swap);
    case
}

/// Turned about the origin, counter-clockwise, together with gravity; of a case without inflows, whose beds lie along x. The domain becomes the square that holds it at any angle; windows
/// and stations, which belong to the axes, are left out.
pub fn turned(case: &Case, angle_deg: f64) -> Case {
    let mut case = case.clone();
    let [c, s] = checkdam::case::direction(angle_deg);
    let turn = |p: [f64; 2]| [c * p[0] - s * p[1], s * p[0] + c * p[1]];
    case.gravity.settle_inclination_deg =
        Some(case.gravity.settle_inclination_deg.unwrap_or(case.gravity.inclination_deg) + angle_deg);
    case.gravity.inclination_deg += angle_deg;
    let ends = [case.domain.x_m, case.domain.y_m];
    let reach = ends.iter().map(|e| e[0].abs().max(e[1].abs())).fold(0.0, f64::hypot);
    (case.domain.x_m, case.domain.y_m) = ([-reach, reach], [-reach, reach]);
    for body in &mut case.bodies {
        if let Some(r) = edges(body) {
            place(body, turn(r.corner_m), r.size_m);
        }
        if body.foot_m.is_some() {
            body.inclination_deg = Some(body.inclination_deg.unwrap_or(90.0) + angle_deg);
        } else {
            body.rotation_deg += angle_deg;
        }
        places(body).for_each(|x| *x = turn(*x));
        body.velocity_m_per_s = turn(body.velocity_m_per_s);
        // R G R^T: its columns turned, then its rows.
        body.velocity_gradient_per_s.iter_mut().for_each(|g| {
            let [a, b] = [turn([g[0][0], g[1][0]]), turn([g[0][1], g[1][1]])];
            *g = [turn([a[0], b[0]]), turn([a[1], b[1]])];
        });
    }
    for b in &mut case.boundaries {
        let points = b.points_m.iter_mut().flatten();
        b.point_m.iter_mut().chain(&mut b.foot_m).chain(points).for_each(|x| *x = turn(*x));
        b.normal_deg.iter_mut().for_each(|a| *a += angle_deg);
        if b.foot_m.is_some() {
            b.inclination_deg = Some(b.inclination_deg.unwrap_or(90.0) + angle_deg);
        }
    }
    case.gauges.stations_m.clear();
    (case.gauges.window_x_m, case.gauges.window_y_m) = (None, None);
    case
}

/// The bodies of each contact exchanged, with the same one as the structure.
pub fn exchanged(case: &Case) -> Case {
    let mut case = case.clone();
    for contact in &mut case.contacts {
        contact.structure = contact.structure.take().or_else(|| contact.bodies.first().cloned());
        contact.bodies.reverse();
    }
    case
}

/// Other names, in another order of the alphabet.
pub fn renamed(case: &Case) -> Case {
    let mut case = case.clone();
    // Backwards, so that the order of the alphabet is another one.
    let other = |name: &mut String| *name = format!("n{}", name.chars().rev().collect::<String>());
    let new = |name: String| {
        let mut name = name;
        other(&mut name);
        name
    };
    case.materials = std::mem::take(&mut case.materials).into_iter().map(|(name, m)| (new(name), m)).collect();
    for body in &mut case.bodies {
        other(&mut body.name);
        other(&mut body.material);
    }
    for inflow in &mut case.inflows {
        other(&mut inflow.name);
        other(&mut inflow.material);
    }
    for Boundary { name, bodies, .. } in &mut case.boundaries {
        other(name);
        bodies.iter_mut().flatten().for_each(other);
    }
    for contact in &mut case.contacts {
        contact.bodies.iter_mut().chain(&mut contact.structure).for_each(other);
    }
    case.side_walls.bodies.iter_mut().flatten().for_each(other);
    let gauges = &mut case.gauges;
    let lists = gauges.barriers.iter_mut().chain(&mut gauges.bases);
    gauges.barrier.iter_mut().chain(&mut gauges.base).chain(lists).for_each(other);
    case
}

/// The first body, which nothing names, written as three: cut between rows of its points, and the lower part between columns.
pub fn in_three(case: &Case, row: f64, column: f64) -> Case {
    let mut case = case.clone();
    let whole = case.bodies.remove(0);
    let part = |name: &str, x: [f64; 2], y: [f64; 2]| Body {
        name: name.into(),
        x_m: Some(x),
        y_m: Some(y),
        mass_kg: None,
        ..whole.clone()
    };
    let (Some([left, right]), Some([low, high])) = (whole.x_m, whole.y_m) else { return case };
    case.bodies.push(part("upper", [left, right], [row, high]));
    case.bodies.push(part("right", [column, right], [low, row]));
    case.bodies.push(part("left", [left, column], [low, row]));
    case
}

/// The text of a case with its tables in reverse order, and with them the bodies and boundaries. What stands before the first table stays.
pub fn tables_reversed(text: &str) -> String {
    let mut blocks: Vec<String> = vec![String::new()];
    for line in text.lines() {
        if line.starts_with('[') {
            blocks.push(String::new());
        }
        if let Some(block) = blocks.last_mut() {
            block.push_str(line);
            block.push('\n');
        }
    }
    blocks[1..].reverse();
    blocks.concat()
}
