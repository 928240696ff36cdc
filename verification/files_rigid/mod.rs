//! From the text of a case to the files of a run, for rigid walls: every number that is left there is read back by name.
//!
//! Seven small cases are run as the command runs them. What their files say is held against closed forms, against the balances, and
//! against what the points of the VTK frames say of the same moment. The folder of a run is all that this rung sees of the program.
//!
//! The table `files_rigid_seen` says of each number whether these checks notice when it alone is read 3 % too large: it is made by
//! judging once more with that number wrong. What they cannot notice is on a list, with its reason.

mod barrier;
mod column;
mod deposit;
mod free;
mod gauges;
mod inputs;
mod judge;
mod ledgers;
mod motion;
mod points;
mod rows;
mod seen;
mod setting;
mod statics;
mod summary;

use super::{Fault, FaultKind, Outcome, Rung, RungFailure};
use crate::figure::{Figure, curves, exact, measured};
use crate::from_file::Files;
use crate::{of_module, part};
use checkdam::plot::curves::Curves;
use judge::Judge;
use setting::Setting;
use toml::{Table, Value};

/// The rung.
pub const RUNG: Rung = Rung {
    name: of_module(module_path!()),
    title: "From a case's text to the files of a run: blocks, a column, bars, gates; every number read back by name",
    goal: "A number in a file is what the case's physics makes of it, whatever file and column it stands in",
    source: "Equilibrium, Coulomb 1785, Drucker and Prager 1952, Galilei 1638; balances of momentum and energy; definitions",
    sketch: r"
   case.toml --> scene --> steps --> gauges --> summary.toml, *.csv, *.vtp
       |                                                   |
       '--> closed forms, balances <------ compared -------'
",
    run,
    covers: &[
        (FaultKind::Friction, 1.03),
        (FaultKind::Modulus, 1.03),
        (FaultKind::Gravity, 1.03),
        (FaultKind::Density, 1.03),
        (FaultKind::SlipLength, 1.03),
    ],
    under_fault: "one of the seven cases, into whose text the fault is written",
    figures: &[STRESS],
};

const STRESS: Figure = curves(
    "files_rigid_column",
    "files_rigid_column_plot",
    Curves {
        x: "height_m",
        x_title: "height above the base (m)",
        y_title: "stress (Pa)",
        curves: &[
            measured("vertical_pa", "vertical"),
            exact("vertical_exact_pa", "its weight"),
            measured("lateral_pa", "lateral"),
            exact("lateral_exact_pa", "on the cone"),
        ],
        ..Curves::LINEAR
    },
);

/// A case, and what is known of it besides.
struct Scene {
    name: &'static str,
    text: &'static str,
    closed: fn(&Setting, &Files, &mut Judge),
}

const SCENES: [Scene; 7] = [
    Scene { name: "rest", text: include_str!("rest.toml"), closed: statics::rest },
    Scene { name: "slide", text: include_str!("slide.toml"), closed: motion::slide },
    Scene { name: "column", text: include_str!("column.toml"), closed: column::judge },
    Scene { name: "flight", text: include_str!("flight.toml"), closed: free::flight },
    Scene { name: "gate", text: include_str!("gate.toml"), closed: free::gate },
    Scene { name: "hang", text: include_str!("hang.toml"), closed: statics::hang },
    Scene { name: "slip", text: include_str!("slip.toml"), closed: motion::slip },
];

impl Scene {
    /// All checks of what was read, of the physics and of the inputs that the files repeat.
    fn judge(&self, set: &Setting, files: &Files) -> Judge {
        let mut judge = self.physics(set, files);
        inputs::repeated(set, files, &mut judge);
        judge
    }

    /// Those that do not look at the inputs.
    fn physics(&self, set: &Setting, files: &Files) -> Judge {
        let mut judge = Judge::default();
        ledgers::judge(set, files, &mut judge);
        points::judge(set, files, &mut judge);
        summary::judge(set, files, &mut judge);
        inputs::geometry(set, files, &mut judge);
        (self.closed)(set, files, &mut judge);
        judge
    }
}

/// The scene that is enough to notice.
fn enough(fault: &Fault) -> Option<&'static str> {
    let of = [
        (fault.friction, "slide"),
        (fault.modulus, "column"),
        (fault.gravity, "flight"),
        (fault.density, "rest"),
        (fault.slip_length, "slip"),
    ];
    of.into_iter().find(|f| f.0 != 1.0).map(|f| f.1)
}

fn run(fault: &Fault) -> Result<Outcome, RungFailure> {
    let only = enough(fault);
    let (mut all, mut read, mut tables) = (Judge::default(), Vec::new(), Vec::new());
    for scene in SCENES.iter().filter(|s| only.is_none_or(|name| s.name == name) && part::is_asked(s.name)) {
        let files = Files::run(&with_fault(scene.text, fault))?;
        let set = Setting::new(scene.text);
        // A fault in the text is to be noticed by what comes of it.
        all.merge(if only.is_none() { scene.judge(&set, &files) } else { scene.physics(&set, &files) });
        if scene.name == "column" {
            tables.push(("files_rigid_column".into(), column::profile(&set, &files)));
        }
        read.push((scene, set, files));
    }
    let mut outcome = Outcome { checks: all.checks, tables };
    if only.is_none() && part::is_whole() {
        seen::judge(&read, &mut outcome);
    }
    Ok(outcome)
}

/// The text with the fault in its numbers.
fn with_fault(text: &str, fault: &Fault) -> String {
    if *fault == Fault::NONE {
        return text.into();
    }
    let mut case: Table = text.parse().unwrap_or_default();
    if let Some(Value::Table(gravity)) = case.get_mut("gravity").filter(|_| fault.gravity != 1.0) {
        // What is left out is written down.
        gravity.entry("magnitude_m_per_s2").or_insert(Value::Float(9.81));
    }
    let factors = [
        ("magnitude_m_per_s2", fault.gravity),
        ("friction", fault.friction),
        ("static_friction", fault.friction),
        ("young_pa", fault.modulus),
        ("density_kg_per_m3", fault.density),
        ("mass_kg", fault.density),
        ("slip_length_m", fault.slip_length),
    ];
    let mut whole = Value::Table(case);
    scale(&mut whole, &factors);
    toml::to_string(&whole).unwrap_or_default()
}

/// Multiplies the numbers of these keys, wherever they stand.
fn scale(value: &mut Value, factors: &[(&str, f64)]) {
    match value {
        Value::Table(table) => {
            for (key, value) in table.iter_mut() {
                let factor = factors.iter().find(|f| f.0 == key.as_str()).map_or(1.0, |f| f.1);
                let number = value.as_float().or_else(|| value.as_integer().map(|n| n as f64));
                match number.filter(|_| factor != 1.0) {
                    Some(x) => *value = Value::Float(x * factor),
                    None => scale(value, factors),
                }
            }
        }
        Value::Array(list) => list.iter_mut().for_each(|v| scale(v, factors)),
        _ => {}
    }
}
