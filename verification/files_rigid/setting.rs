//! What a case says, read from its text without the program's help, and the points of a frame with what they carry by it.

use crate::from_file::Files;
use toml::{Table, Value};

/// A body as it is drawn.
#[derive(Debug, Clone)]
pub struct BodyOf {
    pub name: String,
    pub density: f64,
    pub young: f64,
    pub poisson: f64,
    /// Edges, m.
    pub x: [f64; 2],
    pub y: [f64; 2],
    /// rad.
    pub rotation: f64,
    pub v: [f64; 2],
    pub per_cell: f64,
}

impl BodyOf {
    /// Length and height, m.
    pub fn size(&self) -> [f64; 2] {
        [self.x[1] - self.x[0], self.y[1] - self.y[0]]
    }

    /// m2.
    pub fn area(&self) -> f64 {
        self.size()[0] * self.size()[1]
    }

    /// Bulk and shear modulus, Pa.
    pub fn moduli(&self) -> [f64; 2] {
        [self.young / (3.0 * (1.0 - 2.0 * self.poisson)), self.young / (2.0 * (1.0 + self.poisson))]
    }

    /// Speed of the P-wave, m/s.
    pub fn wave_speed(&self) -> f64 {
        let [bulk, shear] = self.moduli();
        ((bulk + 4.0 * shear / 3.0) / self.density).sqrt()
    }

    fn corners(&self) -> [[f64; 2]; 4] {
        let ([l, h], (s, c)) = (self.size(), (libm::sin(self.rotation), libm::cos(self.rotation)));
        let at = |a: f64, b: f64| [self.x[0] + c * a - s * b, self.y[0] + s * a + c * b];
        [at(0.0, 0.0), at(l, 0.0), at(l, h), at(0.0, h)]
    }
}

/// A boundary as it is drawn.
#[derive(Debug, Clone)]
pub struct BoundaryOf {
    pub name: String,
    pub gate: bool,
    /// Clamps count as no solid.
    pub bonded: bool,
    pub foot: [f64; 2],
    /// Into the material.
    pub normal: [f64; 2],
    /// From foot to crest.
    pub tangent: [f64; 2],
    /// m; infinite for a plane.
    pub height: f64,
    pub thickness: f64,
    pub friction: f64,
    /// Whether its friction needs slip.
    pub slips: bool,
}

impl BoundaryOf {
    /// Distance before the face and place along it, m.
    pub fn face(&self, x: [f64; 2]) -> [f64; 2] {
        let r = [x[0] - self.foot[0], x[1] - self.foot[1]];
        [dot(r, self.normal), dot(r, self.tangent)]
    }
}

/// What a case says.
#[derive(Debug, Clone)]
pub struct Setting {
    pub case: Table,
    pub gravity: f64,
    /// rad.
    pub slope: f64,
    pub h: f64,
    pub width: f64,
    pub bodies: Vec<BodyOf>,
    pub boundaries: Vec<BoundaryOf>,
    pub barriers: Vec<String>,
    pub bases: Vec<String>,
}

pub fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// The number at these keys, dots between them.
pub fn at(table: &Table, key: &str) -> Option<f64> {
    let value = find(table, key)?;
    value.as_float().or_else(|| value.as_integer().map(|n| n as f64))
}

/// What is at these keys.
pub fn find<'a>(table: &'a Table, key: &str) -> Option<&'a Value> {
    let mut parts = key.split('.');
    let first = table.get(parts.next()?)?;
    parts.try_fold(first, |value, part| match value {
        Value::Table(table) => table.get(part),
        Value::Array(list) => list.get(part.parse::<usize>().ok()?),
        _ => None,
    })
}

fn list<'a>(table: &'a Table, key: &str) -> impl Iterator<Item = &'a Table> {
    table.get(key).and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_table)
}

fn pair(table: &Table, key: &str) -> [f64; 2] {
    [0, 1].map(|k| at(table, &format!("{key}.{k}")).unwrap_or(0.0))
}

fn text(table: &Table, key: &str) -> String {
    table.get(key).and_then(Value::as_str).unwrap_or_default().to_string()
}

/// Unit vector at an angle (degrees), exact along the axes.
fn direction(degrees: f64) -> [f64; 2] {
    let [s, c] = [libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians())];
    [c, s].map(|x| if x.abs() < 1e-15 { 0.0 } else { x })
}

impl Setting {
    /// Of a case's text; of an empty one if it cannot be read.
    pub fn new(case: &str) -> Self {
        let case: Table = case.parse().unwrap_or_default();
        let h = at(&case, "grid.spacing_m").unwrap_or(f64::NAN);
        let number = |table: &Table, key: &str, otherwise: f64| at(table, key).unwrap_or(otherwise);
        let names = |one: &str, many: &str| {
            let gauges = case.get("gauges").and_then(Value::as_table).cloned().unwrap_or_default();
            let all = gauges.get(many).and_then(Value::as_array).cloned().unwrap_or_default();
            let all = gauges.get(one).cloned().into_iter().chain(all);
            all.filter_map(|v| v.as_str().map(String::from)).collect()
        };
        let body = |b: &Table| {
            let material = |key: &str| number(&case, &format!("materials.{}.{key}", text(b, "material")), f64::NAN);
            BodyOf {
                name: text(b, "name"),
                density: material("density_kg_per_m3"),
                young: material("young_pa"),
                poisson: material("poisson"),
                x: pair(b, "x_m"),
                y: pair(b, "y_m"),
                rotation: number(b, "rotation_deg", 0.0).to_radians(),
                v: pair(b, "velocity_m_per_s"),
                per_cell: number(b, "particles_per_cell", 4.0),
            }
        };
        let boundary = |b: &Table| {
            let plane = text(b, "kind") == "plane";
            let tangent = direction(number(b, "inclination_deg", 90.0));
            let right = text(b, "material_side") == "right";
            let normal = match plane {
                true => direction(number(b, "normal_deg", f64::NAN)),
                false if right => [tangent[1], -tangent[0]],
                false => [-tangent[1], tangent[0]],
            };
            BoundaryOf {
                name: text(b, "name"),
                gate: text(b, "kind") == "gate",
                bonded: text(b, "contact") == "bonded",
                foot: pair(b, if plane { "point_m" } else { "foot_m" }),
                normal,
                tangent: if plane { [normal[1], -normal[0]] } else { tangent },
                height: number(b, "height_m", f64::INFINITY),
                thickness: number(b, "thickness_m", if plane { f64::INFINITY } else { 4.0 * h }),
                friction: number(b, "friction", 0.0),
                slips: b.contains_key("slip_length_m"),
            }
        };
        Self {
            gravity: number(&case, "gravity.magnitude_m_per_s2", 9.81),
            slope: number(&case, "gravity.inclination_deg", f64::NAN).to_radians(),
            h,
            width: number(&case, "grid.thickness_m", f64::NAN),
            bodies: list(&case, "bodies").map(body).collect(),
            boundaries: list(&case, "boundaries").map(boundary).collect(),
            barriers: names("barrier", "barriers"),
            bases: names("base", "bases"),
            case,
        }
    }

    /// Acceleration of gravity, m/s2.
    pub fn g(&self) -> [f64; 2] {
        [self.gravity * libm::sin(self.slope), -self.gravity * libm::cos(self.slope)]
    }

    /// kg.
    pub fn mass(&self) -> f64 {
        self.bodies.iter().map(|b| b.density * b.area() * self.width).sum()
    }

    /// m2.
    pub fn area(&self) -> f64 {
        self.bodies.iter().map(BodyOf::area).sum()
    }

    /// From the lowest corner to the highest against the gravity of the settling, m.
    pub fn tall(&self) -> f64 {
        let down = at(&self.case, "gravity.settle_inclination_deg").map_or(self.slope, f64::to_radians);
        let heights =
            || self.bodies.iter().flat_map(BodyOf::corners).map(|c| c[1] * libm::cos(down) - c[0] * libm::sin(down));
        heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min)
    }

    pub fn boundary(&self, name: &str) -> Option<&BoundaryOf> {
        self.boundaries.iter().find(|b| b.name == name)
    }

    /// 1 if the flow runs to the right, -1 if to the left: towards the first barrier's foot if that is a wall, else where gravity points.
    pub fn way(&self) -> f64 {
        let centre = |b: &BodyOf| b.corners().iter().map(|c| c[0]).sum::<f64>() / 4.0;
        let mean: f64 =
            self.bodies.iter().map(|b| b.density * b.area() * self.width * centre(b)).sum::<f64>() / self.mass();
        let wall = self.barriers.first().and_then(|name| self.boundary(name)).filter(|b| b.height.is_finite());
        let [towards, down] = [wall.map_or(0.0, |b| b.foot[0] - mean), self.g()[0]];
        if towards != 0.0 {
            towards.signum()
        } else if down.abs() > 1e-12 {
            down.signum()
        } else {
            1.0
        }
    }

    /// Height of a place, m, above the level at which gravitational energy is zero.
    pub fn level(&self, x: [f64; 2]) -> f64 {
        let level = |x: &[f64; 2]| x[1] * libm::cos(self.slope) - x[0] * libm::sin(self.slope);
        let foot = self.barriers.first().and_then(|name| self.boundary(name)).map(|b| b.foot);
        let corners = self.bodies.iter().flat_map(BodyOf::corners);
        let zero = corners.chain(foot).map(|x| level(&x)).fold(f64::INFINITY, f64::min);
        level(&x) - zero
    }

    /// Elastic energy of a point, J.
    pub fn stored(&self, p: &Point) -> f64 {
        let [bulk, shear] = self.bodies[p.body].moduli();
        p.volume * (p.tau().powi(2) / (2.0 * shear) + p.mean().powi(2) / (2.0 * bulk))
    }

    /// The points of a frame.
    pub fn points(&self, files: &Files, frame: usize) -> Vec<Point> {
        let start = files.array(0, "body");
        let count = |k: usize| start.iter().filter(|b| **b == k as f64).count().max(1) as f64;
        let get = |name: &str| files.array(frame, name);
        let [x, y, vx, vy] = ["Points.x", "Points.y", "velocity_m_per_s.x", "velocity_m_per_s.y"].map(get);
        let stress = ["xx", "yy", "zz", "xy"].map(|c| get(&format!("stress_pa.{c}")));
        let [ratio, opened, shear, body] = ["volume_ratio", "opened_strain", "plastic_shear_strain", "body"].map(get);
        let n = x.len();
        if x[0].is_nan() || [&y, &vx, &vy, &ratio, &opened, &shear, &body].iter().any(|a| a.len() != n) {
            return Vec::new();
        }
        let point = |k: usize| {
            let of = &self.bodies.get(body[k] as usize)?;
            let volume = of.area() * self.width / count(body[k] as usize);
            Some(Point {
                body: body[k] as usize,
                x: [x[k], y[k]],
                v: [vx[k], vy[k]],
                stress: [0, 1, 2, 3].map(|c| stress[c].get(k).copied().unwrap_or(f64::NAN)),
                ratio: ratio[k],
                opened: opened[k],
                shear: shear[k],
                mass: of.density * volume,
                volume: volume * ratio[k],
                spacing: self.h / of.per_cell.sqrt(),
            })
        };
        (0..n).filter_map(point).collect()
    }
}

/// A point of a frame.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    pub body: usize,
    pub x: [f64; 2],
    pub v: [f64; 2],
    /// xx, yy, zz, xy; Pa.
    pub stress: [f64; 4],
    pub ratio: f64,
    pub opened: f64,
    /// Plastic shear strain.
    pub shear: f64,
    /// kg.
    pub mass: f64,
    /// Now, m3.
    pub volume: f64,
    /// Between points, m.
    pub spacing: f64,
}

impl Point {
    pub fn speed(&self) -> f64 {
        self.v[0].hypot(self.v[1])
    }

    /// Mean stress, Pa.
    pub fn mean(&self) -> f64 {
        (self.stress[0] + self.stress[1] + self.stress[2]) / 3.0
    }

    /// Root of the second invariant of the deviator, Pa.
    pub fn tau(&self) -> f64 {
        let m = self.mean();
        let [x, y, z] = [0, 1, 2].map(|k| self.stress[k] - m);
        (0.5 * (x * x + y * y + z * z) + self.stress[3] * self.stress[3]).sqrt()
    }
}
