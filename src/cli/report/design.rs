//! The tables of the page: the design sheet of each barrier, the front, the ledgers, the health of the run.

use super::number::{Kind, Numbers};
use super::{escape, shortened};
use checkdam::case::file_name;

/// Width of the flow, over which forces are taken per metre.
const WIDTH: &str = "summary.toml:case.grid.thickness_m";
const CELL: &str = "summary.toml:case.grid.spacing_m";

/// A barrier of a run: its name, where the summary has it, and the end of the names of its files.
pub struct Barrier {
    /// As in the case.
    pub name: String,
    /// What stands before `barrier.` and `structure.` in paths of the summary.
    prefix: String,
    /// What stands before `.csv` in the names of its tables.
    pub suffix: String,
    first: bool,
}

/// The barriers of a run, in the order of the case.
pub fn barriers(numbers: &Numbers) -> Vec<Barrier> {
    let summary = &numbers.run().summary;
    let gauges = summary.get("case").and_then(|case| case.get("gauges"));
    let first = gauges
        .and_then(|g| g.get("barrier")?.as_str().map(str::to_owned))
        .or_else(|| gauges.and_then(|g| g.get("barriers")?.as_array()?.first()?.as_str().map(str::to_owned)));
    let mut found = Vec::new();
    if summary.contains_key("barrier") {
        let name = first.unwrap_or_else(|| "barrier".into());
        found.push(Barrier { name, prefix: String::new(), suffix: String::new(), first: true });
    }
    for further in summary.get("further_barriers").and_then(toml::Value::as_array).into_iter().flatten() {
        let name = further.get("name").and_then(toml::Value::as_str).unwrap_or_default().to_owned();
        let prefix = format!("further_barriers.{name}.");
        found.push(Barrier { suffix: format!("_{}", file_name(&name)), name, prefix, first: false });
    }
    found
}

/// What stands in a row of the sheet: what it is, what it measures, its place in the section `barrier` or `structure`.
type Row = (&'static str, Kind, &'static str);

const FORCES: &[Row] = &[
    ("Largest normal force of a single step; grows as the step is made shorter", Kind::Force, "barrier.peak_step_n"),
    ("Largest normal force over 20 ms", Kind::Force, "barrier.peak_20ms_n"),
    ("the same over exactly 20 ms of steps", Kind::Force, "barrier.peak_20ms_by_steps_n"),
    ("Static normal force: mean of the last 0.3 s; base shear", Kind::Force, "barrier.static_force_n"),
    ("Static force along the face, positive towards the crest", Kind::Force, "barrier.static_shear_n"),
    ("Largest overturning moment of a single step, about the foot", Kind::Moment, "barrier.peak_moment_n_m"),
    ("Static overturning moment", Kind::Moment, "barrier.static_moment_n_m"),
    ("Impulse of the normal force in 0.5 s after arrival", Kind::Impulse, "barrier.impulse_half_second_n_s"),
];

const OTHERS: &[Row] = &[
    ("Time of the largest force over 20 ms", Kind::Time, "barrier.peak_20ms_time_s"),
    ("That force over \u{3c1}v\u{b2}hb of the front", Kind::Ratio, "barrier.peak_20ms_alpha_1"),
    ("Elastic impact \u{3c1}cvhb, for comparison", Kind::Force, "barrier.elastic_impact_n"),
    ("Height of action of the static force: moment over force", Kind::Length, "barrier.static_height_of_action_m"),
    ("Run-up: 95 % of the points at the face", Kind::Length, "barrier.run_up_p95_m"),
    ("Run-up: highest single point", Kind::Length, "barrier.run_up_m"),
    ("Mass over the crest", Kind::Mass, "barrier.overtopped_kg"),
    ("Mass under the barrier", Kind::Mass, "barrier.passed_under_kg"),
    ("Mass past the barrier, on whatever way", Kind::Mass, "barrier.passed_kg"),
];

const STRUCTURE: &[Row] = &[
    ("Largest force on the clamp of a single step", Kind::Force, "structure.peak_clamp_n"),
    ("Static force on the clamp", Kind::Force, "structure.static_clamp_n"),
    ("Static moment on the clamp", Kind::Moment, "structure.static_clamp_moment_n_m"),
    ("Largest deflection of the tip", Kind::Length, "structure.tip_max_m"),
    ("Final deflection of the tip", Kind::Length, "structure.tip_final_m"),
];

/// A row of a table: what it is, its cells, where they come from. None if the number is not there.
fn row(numbers: &Numbers, label: &str, kind: Kind, place: &str, width: bool) -> Option<String> {
    let value = numbers.cell(kind, place, None)?;
    let per_width = match kind {
        Kind::Force => Some(Kind::ForcePerWidth),
        Kind::Moment => Some(Kind::MomentPerWidth),
        _ => None,
    };
    let over = per_width.filter(|_| width).and_then(|kind| numbers.cell(kind, place, Some(WIDTH)));
    let second = if width { over.unwrap_or_else(|| "<td></td>".into()) } else { String::new() };
    Some(line(label, &format!("{value}{second}"), place))
}

fn line(label: &str, cells: &str, place: &str) -> String {
    format!("<tr><th scope=\"row\">{}</th>{cells}<td class=\"from\">{}</td></tr>", escape(label), escape(place))
}

fn table(caption: &str, head: &str, rows: &[String]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    format!(
        "<table><caption>{}</caption><thead>{head}</thead><tbody>{}</tbody></table>",
        escape(caption),
        rows.concat()
    )
}

const WIDE: &str = "<tr><th></th><th>in all</th><th>per metre of width</th><th>where it stands</th></tr>";
const NARROW: &str = "<tr><th></th><th>value</th><th>where it stands</th></tr>";

/// The design sheets of all barriers.
pub fn sheets(numbers: &Numbers) -> String {
    let sheets: Vec<String> = barriers(numbers).iter().map(|barrier| sheet(numbers, barrier)).collect();
    if sheets.is_empty() {
        return "<p>No barrier is gauged in this run.</p>".into();
    }
    sheets.concat()
}

fn sheet(numbers: &Numbers, barrier: &Barrier) -> String {
    let at = |key: &str| format!("summary.toml:{}{key}", barrier.prefix);
    let mut rows = Vec::new();
    if barrier.first && numbers.at(&at("barrier.arrival_s")).is_some() {
        rows.extend(approach(numbers));
    }
    if !barrier.first {
        let words = "<td>not read: the front is followed to the first barrier</td><td></td>";
        rows.push(line("Approach", words, "summary.toml:front"));
    }
    rows.extend(row(numbers, "Arrival at the barrier", Kind::Time, &at("barrier.arrival_s"), true));
    rows.extend(FORCES.iter().filter_map(|(label, kind, key)| row(numbers, label, *kind, &at(key), true)));
    let history = format!("history{}.csv", barrier.suffix);
    let in_history = |column: &str, rule: &str| format!("{history}:{column}[{rule}]");
    let largest = in_history("force_normal_n", "max force_normal_n");
    rows.extend(row(numbers, "Largest sample of the normal force", Kind::Force, &largest, true));
    let moment = in_history("overturning_moment_n_m", "max force_normal_n");
    if let Some(cell) = numbers.cell(Kind::Length, &moment, Some(&largest)) {
        let label = "Height of action in that sample: moment over force";
        rows.push(line(label, &format!("{cell}<td></td>"), &format!("{moment} over {largest}")));
    }
    for (label, rule) in
        [("Largest sample of the force along the face", "max"), ("Least sample of the force along the face", "min")]
    {
        let place = in_history("force_tangential_n", &format!("{rule} force_tangential_n"));
        rows.extend(row(numbers, label, Kind::Force, &place, true));
    }
    for (label, kind, key) in OTHERS.iter().chain(STRUCTURE) {
        rows.extend(row(numbers, label, *kind, &at(key), true));
    }
    if let Some(torn) = numbers.text(&format!("{}structure.torn", barrier.prefix)) {
        let torn = if torn == "true" { "yes: what is read after that means nothing" } else { "no" };
        rows.push(line("Torn", &format!("<td>{torn}</td><td></td>"), &at("structure.torn")));
    }
    table(&format!("Barrier \u{201c}{}\u{201d}", barrier.name), WIDE, &rows)
}

/// The front just before the first barrier: the last that was seen.
fn approach(numbers: &Numbers) -> Vec<String> {
    let last = fronts(numbers).checked_sub(1);
    let rows = [
        ("Approach: depth of the front", Kind::Length, "depth_m"),
        ("Approach: velocity of the front", Kind::Velocity, "velocity_m_per_s"),
        ("Approach: Froude number", Kind::Ratio, "froude_1"),
        ("Approach: read at x", Kind::Length, "x_m"),
        ("Approach: read at time", Kind::Time, "time_s"),
    ];
    let of = |k: usize| {
        rows.iter().filter_map(move |(label, kind, key)| {
            row(numbers, label, *kind, &format!("summary.toml:front[{k}].{key}"), true)
        })
    };
    last.into_iter().flat_map(of).collect()
}

fn fronts(numbers: &Numbers) -> usize {
    numbers.run().summary.get("front").and_then(toml::Value::as_array).map_or(0, Vec::len)
}

/// The front at the stations and before the barrier.
pub fn front(numbers: &Numbers) -> String {
    let columns = [
        (Kind::Length, "x_m"),
        (Kind::Time, "time_s"),
        (Kind::Velocity, "velocity_m_per_s"),
        (Kind::Length, "depth_m"),
        (Kind::Ratio, "froude_1"),
    ];
    let row = |k: usize| {
        let cell = |(kind, key): &(Kind, &str)| {
            numbers
                .cell(*kind, &format!("summary.toml:front[{k}].{key}"), None)
                .unwrap_or_else(|| "<td>\u{2013}</td>".into())
        };
        format!("<tr>{}</tr>", columns.iter().map(cell).collect::<String>())
    };
    let head = "<tr><th>x</th><th>time</th><th>velocity</th><th>depth</th><th>Froude number</th></tr>";
    table("The front on its way", head, &(0..fronts(numbers)).map(row).collect::<Vec<_>>())
}

/// Energy, momentum and the deposit.
pub fn ledgers(numbers: &Numbers) -> String {
    let rows = |section: &str, rows: &[(&str, Kind, &str)]| -> Vec<String> {
        let one = |(label, kind, key): &(&str, Kind, &str)| {
            row(numbers, label, *kind, &format!("summary.toml:{section}.{key}"), false)
        };
        rows.iter().filter_map(one).collect()
    };
    let energy = rows(
        "energy",
        &[
            ("Energy at release", Kind::Energy, "initial_j"),
            ("Released by gravity and what moved, the most at any time", Kind::Energy, "released_j"),
            ("Kinetic at the end, of the energy at release", Kind::Share, "kinetic_1"),
            ("Gravitational", Kind::Share, "gravitational_1"),
            ("Elastic", Kind::Share, "elastic_1"),
            ("Plastic", Kind::Share, "plastic_1"),
            ("Friction on boundaries and between bodies", Kind::Share, "friction_1"),
            ("Normal impact", Kind::Share, "impact_1"),
            ("PIC", Kind::Share, "pic_1"),
            ("Side walls", Kind::Share, "side_walls_1"),
            ("Outflow", Kind::Share, "outflow_1"),
            ("Not accounted for at the end", Kind::Share, "residual_end_1"),
        ],
    );
    let deposit = rows(
        "deposit",
        &[
            ("Weight along the base", Kind::Force, "weight_along_n"),
            ("Friction of the base on the material", Kind::Force, "base_friction_n"),
            ("Friction that the base could give", Kind::Force, "friction_limit_n"),
            ("Mobilised share of it", Kind::Share, "mobilised_1"),
            ("Least force on the barrier in equilibrium", Kind::Force, "equilibrium_limits_n[0]"),
            ("Greatest force on the barrier in equilibrium", Kind::Force, "equilibrium_limits_n[1]"),
            ("Left of the sum of forces", Kind::Force, "equilibrium_residual_n"),
        ],
    );
    [table("Energy", NARROW, &energy), table("Deposit at the end", NARROW, &deposit)].concat()
}

/// How well the run went.
pub fn health(numbers: &Numbers) -> String {
    let rows = [
        ("Energy not accounted for, largest, of what was released", Kind::Share, "energy.residual_of_released_1"),
        ("Momentum not accounted for, largest, of all impulses", Kind::Ratio, "momentum.momentum_closure_1"),
        ("Deepest point inside a boundary or barrier", Kind::Length, "momentum.penetration_m"),
        ("Mass that left the domain", Kind::Mass, "momentum.outflow_kg"),
        ("Material points at the start", Kind::Count, "stepping.particles"),
        ("Mass at the start", Kind::Mass, "stepping.mass_kg"),
        ("Residual at release", Kind::Ratio, "stepping.settle_residual"),
        ("Steps after release", Kind::Count, "stepping.run_steps"),
        ("End of the run", Kind::Time, "stepping.end_s"),
        ("Shortest time step", Kind::Time, "stepping.time_step_min_s"),
        ("Longest time step", Kind::Time, "stepping.time_step_max_s"),
        ("Change of the static force within its 0.3 s", Kind::Force, "barrier.static_force_drift_n"),
        ("Imbalance of contact, clamp and inertia", Kind::Ratio, "structure.imbalance_1"),
        ("Widest gap in the barrier, cells", Kind::Ratio, "structure.gap_cells"),
    ];
    let mut lines: Vec<String> = Vec::new();
    for (label, kind, key) in rows {
        let place = format!("summary.toml:{key}");
        lines.extend(row(numbers, label, kind, &place, false));
        if key == "momentum.penetration_m"
            && let Some(cell) = numbers.cell(Kind::Ratio, &place, Some(CELL))
        {
            lines.push(line("the same in cells", &cell, &format!("{place} over {CELL}")));
        }
    }
    if let Some(limit) = numbers.text("stepping.time_step_limited_by") {
        lines.push(line(
            "What limited the time step",
            &format!("<td>{}</td>", escape(&limit)),
            "summary.toml:stepping.time_step_limited_by",
        ));
    }
    table("Health of the run", NARROW, &lines)
}

/// All inputs with their defaults; the numbers of a list stand in one row.
pub fn inputs(numbers: &Numbers) -> String {
    let mut found: Vec<(String, String)> = Vec::new();
    for (path, leaf) in numbers.run().case() {
        let list = path.strip_suffix(']').and_then(|path| path.rsplit_once('[')).map(|(list, _)| list.to_owned());
        match (list, found.last_mut()) {
            (Some(list), Some((last, text))) if *last == list => *text += &format!(", {leaf}"),
            (list, _) => found.push((list.unwrap_or(path), leaf.to_string())),
        }
    }
    let row = |(path, text): &(String, String)| {
        let cells = format!("<td>{}</td>", escape(&shortened(text, 400)));
        format!("<tr><th scope=\"row\">{}</th>{cells}</tr>", escape(path))
    };
    let rows: Vec<String> = found.iter().map(row).collect();
    table("Inputs, with the defaults filled in", "<tr><th>field</th><th>value</th></tr>", &rows)
}
