//! The runs: which columns, on which grids, with which inputs changed.

use crate::data;
use checkdam::boundary::{Friction, Opening};
use checkdam::simulation::PicShare;
use checkdam_verification::Fault;
use checkdam_verification::release::{Column, Deposit, plane_strain_angle_of_slope};
use checkdam_verification::report::number;
use checkdam_verification::scene::Material;

/// A column as it stood in a laboratory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Case {
    /// Name.
    pub name: &'static str,
    /// Grains, or where the experiment's rows have them: the case of `published.csv` that gives the angles.
    pub grains: &'static str,
    /// Length r0 and height h0, m.
    pub size: [f64; 2],
    /// Inclination of the bed, degrees.
    pub slope_deg: f64,
    /// Cells over r0 of the three grids; whole cells over h0, too.
    pub cells: [usize; 3],
    /// Grid of the changed inputs, for those cases that have them.
    pub changed_on: Option<usize>,
}

const fn case(name: &'static str, grains: &'static str, height: f64, cells: [usize; 3], on: Option<usize>) -> Case {
    Case { name, grains, size: [0.1, height], slope_deg: 0.0, cells, changed_on: on }
}

const fn slope(name: &'static str, slope_deg: f64, on: Option<usize>) -> Case {
    Case { name, grains: "slope", size: [0.2, 0.14], slope_deg, cells: [10, 20, 30], changed_on: on }
}

/// All cases, level ones first.
pub const CASES: [Case; 10] = [
    case("sand a = 0.5", "sand", 0.05, [12, 18, 28], None),
    case("sand a = 1", "sand", 0.1, [12, 18, 27], Some(12)),
    case("sand a = 4", "sand", 0.4, [8, 12, 18], None),
    case("beads a = 0.5", "beads", 0.05, [12, 18, 28], None),
    case("beads a = 1", "beads", 0.1, [12, 18, 27], Some(12)),
    case("beads a = 4", "beads", 0.4, [8, 12, 18], None),
    slope("slope 0", 0.0, Some(20)),
    slope("slope 10", 10.0, None),
    slope("slope 16", 16.0, Some(20)),
    slope("slope 19", 19.0, None),
];

/// The friction angle of grains as far as it is known, rad: lowest and highest. Grains come to rest at the angle of repose and
/// start at the avalanche angle; where only the first is known, with its uncertainty.
pub fn friction_angles(grains: &str) -> [f64; 2] {
    let rows = data::rows(data::COLUMNS);
    let of = |what: &str| rows.iter().find(|r| r.case == grains && r.quantity == what);
    let repose = of("angle of repose").unwrap_or_else(|| panic!("no angle of repose of {grains}"));
    let (low, high) = match of("avalanche angle") {
        Some(avalanche) => (repose.value, avalanche.value),
        None => (repose.value - repose.uncertainty, repose.value + repose.uncertainty),
    };
    [low.to_radians(), high.to_radians()]
}

/// What may be changed: name, cause, effect on the column. `angles` as of [`friction_angles`].
type Change = (&'static str, &'static str, fn(&mut Column, [f64; 2]));

/// The changes. Causes that are empty are repetitions: another time step takes other sums, and nothing else.
pub const CHANGES: [Change; 13] = [
    ("base", "base", |_, _| {}),
    ("lowest friction angle", "friction angle", |c, a| c.friction_angle = plane_strain_angle_of_slope(a[0])),
    ("highest friction angle", "friction angle", |c, a| c.friction_angle = plane_strain_angle_of_slope(a[1])),
    ("angle taken in plane strain", "meaning of the angle", |c, a| c.friction_angle = 0.5 * (a[0] + a[1])),
    ("bed that slides at the same angle", "bed", |c, a| c.bed = Friction::Coulomb(libm::tan(0.5 * (a[0] + a[1])))),
    ("gate lifts at 1 m/s", "gate", |c, _| c.opening = Opening::Lift { speed: 1.0, opening: f64::INFINITY }),
    ("four times as stiff", "Young's modulus", |c, _| c.material.elastic.young *= 4.0),
    ("side walls of 0.2", "side walls", |c, _| c.side_walls = 0.2),
    ("ten times the PIC", "PIC", |c, _| c.pic = PicShare::Fraction(5e-3)),
    ("nine points a cell", "points", |c, _| c.per_cell = 3),
    ("time step of 0.36", "", |c, _| c.cfl = 0.36),
    ("time step of 0.38", "", |c, _| c.cfl = 0.38),
    ("time step of 0.42", "", |c, _| c.cfl = 0.42),
];

/// A run.
#[derive(Debug, Clone, PartialEq)]
pub struct Planned {
    /// Its case.
    pub case: Case,
    /// Cells over r0.
    pub cells: usize,
    /// The name of its change.
    pub change: &'static str,
    /// What is run.
    pub column: Column,
}

impl Planned {
    fn new(case: Case, cells: usize, change: &Change) -> Self {
        let angles = friction_angles(case.grains);
        let mut column = Column {
            length: case.size[0],
            height: case.size[1],
            slope: case.slope_deg.to_radians(),
            cells,
            per_cell: 2,
            material: Material::new(2.5e5, 0.3, 1500.0),
            friction_angle: plane_strain_angle_of_slope(0.5 * (angles[0] + angles[1])),
            bed: Friction::Rough,
            opening: Opening::Vanish,
            side_walls: 0.0,
            pic: PicShare::Fraction(5e-4),
            cfl: 0.4,
        };
        (change.2)(&mut column, angles);
        Self { case, cells, change: change.0, column }
    }

    /// Time in which its height falls, s.
    fn time(&self) -> f64 {
        (self.column.height / checkdam_verification::release::GRAVITY).sqrt()
    }

    /// About how many particle-steps it takes to come to rest after so many of its times.
    pub fn cost(&self, rest: f64) -> f64 {
        let (c, h) = (&self.column, self.column.spacing());
        let points = c.length * c.height / (h * h) * (c.per_cell * c.per_cell) as f64;
        let step = c.cfl * h / (c.material.elastic.young / c.material.density).sqrt();
        points * rest * self.time() / step
    }

    /// Runs it.
    ///
    /// # Errors
    /// Where the solver gives up.
    pub fn run(&self, fault: &Fault) -> Result<Deposit, checkdam_verification::RungFailure> {
        self.column.collapse(40.0 * self.time(), fault)
    }
}

/// The column of the slopes at 30 degrees, where nothing comes to rest, on a bed that slides at the grains' angle or on a rough one.
pub fn steep(cells: usize, slides: bool) -> Column {
    let case = slope("steep", STEEP_DEG, None);
    let change = if slides { CHANGES.iter().find(|c| c.1 == "bed") } else { None };
    Planned::new(case, cells, change.unwrap_or(&CHANGES[0])).column
}

/// Inclination of [`steep`], degrees.
pub const STEEP_DEG: f64 = 30.0;

/// The coarsest grid of every case that is no higher than long: what is run each time.
pub fn coarse() -> Vec<Planned> {
    let low = CASES.iter().filter(|c| c.size[1] <= c.size[0]);
    low.map(|c| Planned::new(*c, c.cells[0], &CHANGES[0])).collect()
}

/// All runs: every case on its grids, and the changed inputs.
pub fn all() -> Vec<Planned> {
    let grids = CASES.iter().flat_map(|c| c.cells.map(|n| Planned::new(*c, n, &CHANGES[0])));
    let changed = CASES.iter().filter_map(|c| Some((c, c.changed_on?)));
    let changed = changed.flat_map(|(c, n)| CHANGES[1..].iter().map(move |change| Planned::new(*c, n, change)));
    grids.chain(changed).collect()
}

/// Columns of the record, after the case, the cells and the change.
pub const COLUMNS: [&str; 10] = [
    "run_out_tip_1",
    "run_out_mass_1",
    "run_out_depth_1",
    "height_1",
    "arrived_1",
    "rest_1",
    "kinetic_1",
    "energy_residual_1",
    "momentum_closure_1",
    "base_force_1",
];

/// What a run gives, in the order of [`COLUMNS`]: lengths over r0, times over sqrt(h0/g).
pub fn numbers(column: &Column, deposit: &Deposit) -> [f64; 10] {
    let time = (column.height / checkdam_verification::release::GRAVITY).sqrt();
    let over = |x: f64| x / column.length;
    [
        over(deposit.run_out[1]),
        over(deposit.run_out[0]),
        over(deposit.run_out[2]),
        over(deposit.height),
        deposit.arrived / time,
        deposit.at_rest / time,
        deposit.kinetic,
        deposit.residual,
        deposit.closure,
        deposit.base,
    ]
}

/// The head of the record.
pub fn header() -> String {
    format!("case,cells,change,{}\n", COLUMNS.join(","))
}

/// A line of the record.
pub fn line(run: &Planned, numbers: [f64; 10]) -> String {
    format!("{},{},{},{}\n", run.case.name, run.cells, run.change, numbers.map(number).join(","))
}
