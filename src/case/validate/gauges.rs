//! What is measured: barriers, bases, stations, windows, snapshots.

use super::shapes::has_geometry;
use super::{Checker, text};
use crate::case::boundary::{BoundaryKind, MaterialSide};
use crate::case::file_name;
use crate::case::path::KeyPath;
use crate::case::schema::Body;
use crate::case::suggest::did_you_mean;

/// Fewest rows of a table that is coarser than the numbers of the summary.
const LEAST_ROWS: f64 = 10.0;

impl Checker<'_> {
    pub(super) fn gauges(&mut self) {
        let (gauges, domain) = (&self.case.gauges, &self.case.domain);
        let at = KeyPath::top("gauges");
        self.barriers(&at);
        self.bases(&at);
        self.rate(&at.key("sample_rate_hz"));
        if let Some(length) = gauges.front_length_m {
            self.positive(&at.key("front_length_m"), length, 0.05);
        }
        if let Some(force) = gauges.arrival_force_n {
            self.not_negative(&at.key("arrival_force_n"), force, 0.5);
        }
        for (index, &station) in gauges.stations_m.iter().enumerate() {
            self.inside(&at.key("stations_m").index(index), station, domain.x_m);
        }
        let windows = [("window_x_m", gauges.window_x_m, domain.x_m), ("window_y_m", gauges.window_y_m, domain.y_m)];
        for (key, window, limits) in windows {
            let path = at.key(key);
            if let Some(window) = window {
                self.interval_inside(&path, window, limits);
            } else if gauges.window_x_m.is_some() || gauges.window_y_m.is_some() {
                let what = format!("{path} is missing");
                self.problem(&path, what, &"", "window_x_m and window_y_m together, or neither", "give both");
            }
        }
        self.named_windows(&at.key("windows"));
        self.field_times();
    }

    /// The rate of the tables: too coarse a one leaves them empty.
    fn rate(&mut self, path: &KeyPath) {
        let (rate, end) = (self.case.gauges.sample_rate_hz, self.case.stages.run.end_time_s);
        self.positive(path, rate, 1000.0);
        if rate > 0.0 && end > 0.0 && rate < 1000.0 && rate * end < LEAST_ROWS {
            let allowed = format!(
                "at least {} rows in a run, or 1000 rows a second; in {} s this gives {}",
                text(LEAST_ROWS),
                text(end),
                (rate * end).floor()
            );
            let least = (1.1 * LEAST_ROWS / end).min(1000.0);
            self.not_allowed(path, &rate, &allowed, &format!("use {} or more", text(least)));
        }
    }

    /// The barriers whose force is measured: each is one thing, and has files of its own.
    fn barriers(&mut self, at: &KeyPath) {
        let gauges = &self.case.gauges;
        if let Some(name) = &gauges.barrier {
            self.barrier(&at.key("barrier"), name);
        }
        self.one_or_list(at, ["barrier", "barriers"], gauges.barrier.as_deref(), &gauges.barriers);
        let names: Vec<&str> = gauges.barriers.iter().map(String::as_str).collect();
        for (index, name) in names.iter().enumerate() {
            let path = at.key("barriers").index(index);
            self.barrier(&path, name);
            let clashes = self.clash(&path, &names[..=index], "barrier");
            let like = |word: &&str| file_name(name).starts_with(word);
            if !clashes && index > 0 && ["profile", "outline"].iter().any(like) {
                let allowed = "a name that begins with neither `profile` nor `outline`, as files of other barriers do";
                self.not_allowed(&path, name, allowed, "rename it, or let it be the first");
            }
        }
    }

    fn barrier(&mut self, path: &KeyPath, name: &str) {
        let boundaries = || self.case.boundaries.iter().map(|boundary| boundary.name.as_str());
        let bodies = || self.case.bodies.iter().map(|body| body.name.as_str());
        let (rigid, body) = (boundaries().any(|b| b == name), bodies().any(|b| b == name));
        let in_contact = self.case.contacts.iter().any(|c| c.bodies.iter().any(|b| b == name));
        let fix = match (rigid, body) {
            (false, false) => did_you_mean(name, boundaries().chain(bodies())),
            (true, true) => "rename the boundary or the body: both have this name".to_owned(),
            (false, true) if !in_contact => {
                format!("add [[contacts]] with `{name}`: what sticks to other bodies has no force to measure")
            }
            _ => return self.faces_the_material(name),
        };
        self.not_allowed(path, &name, "the name of one of [[boundaries]], or of a body in [[contacts]]", &fix);
    }

    /// A wall whose force is measured has material on the side of its face: else it is loaded on its back, and pulled.
    fn faces_the_material(&mut self, name: &str) {
        let Some(index) = self.case.boundaries.iter().position(|b| b.name == name) else { return };
        let (boundary, at) = (&self.case.boundaries[index], KeyPath::top("boundaries").index(index));
        let wall = boundary.wall(&self.case.grid).filter(|_| boundary.kind != BoundaryKind::Plane);
        let Some(wall) = wall.filter(|_| self.is_clean(&at)) else { return };
        let normal = wall.normal();
        let before = |corner: &[f64; 2]| {
            (corner[0] - wall.foot_m[0]) * normal[0] + (corner[1] - wall.foot_m[1]) * normal[1] > 0.0
        };
        let mut bodies = self.case.bodies.iter().filter(|b| boundary.acts_on(&b.name) && has_geometry(b)).peekable();
        let nearest = |b: &Body| b.drawing().map(|d| d.farthest_m(normal));
        if bodies.peek().is_none() || bodies.any(|b| nearest(b).is_some_and(|place| before(&place))) {
            return;
        }
        let other = if wall.material_side == MaterialSide::Left { "right" } else { "left" };
        let what = format!("the face of the barrier `{name}` looks away from all material");
        let allowed = "a wall whose force is measured with material on the side of its face";
        let fix = format!("use material_side = \"{other}\"");
        self.problem(&at.key("material_side"), what, &boundary.material_side.unwrap_or_default(), allowed, &fix);
    }

    /// The boundaries that hold the deposit: each but the first has a file of its own.
    fn bases(&mut self, at: &KeyPath) {
        let gauges = &self.case.gauges;
        if let Some(name) = &gauges.base {
            self.base(&at.key("base"), name);
        }
        self.one_or_list(at, ["base", "bases"], gauges.base.as_deref(), &gauges.bases);
        let names: Vec<&str> = gauges.bases.iter().map(String::as_str).collect();
        for (index, name) in names.iter().enumerate() {
            let path = at.key("bases").index(index);
            self.base(&path, name);
            self.clash(&path, &names[..=index], "base");
        }
    }

    fn base(&mut self, path: &KeyPath, name: &str) {
        let boundaries = || self.case.boundaries.iter().map(|boundary| boundary.name.as_str());
        if !boundaries().any(|other| other == name) {
            let fix = did_you_mean(name, boundaries());
            self.not_allowed(path, &name, "the name of one of [[boundaries]]", &fix);
        }
    }

    /// Windows with names: each has a file of its own.
    fn named_windows(&mut self, list: &KeyPath) {
        let (windows, domain) = (&self.case.gauges.windows, &self.case.domain);
        let names: Vec<&str> = windows.iter().map(|window| window.name.as_str()).collect();
        for (index, window) in windows.iter().enumerate() {
            let path = list.index(index);
            let name = path.key("name");
            if window.name.trim().is_empty() {
                let fix = "give it a name such as \"upstream\"";
                self.not_allowed(&name, &window.name, "a name that is not empty", fix);
            } else {
                self.clash(&name, &names[..=index], "window");
            }
            self.interval_inside(&path.key("x_m"), window.x_m, domain.x_m);
            self.interval_inside(&path.key("y_m"), window.y_m, domain.y_m);
        }
    }

    /// What is named by itself or in a list, and not by both.
    fn one_or_list(&mut self, at: &KeyPath, [one, list]: [&str; 2], name: Option<&str>, names: &[String]) {
        if let (Some(name), false) = (name, names.is_empty()) {
            let what = format!("{} and {} are both given", at.key(one), at.key(list));
            let all = std::iter::once(name).chain(names.iter().map(String::as_str));
            let all: Vec<String> = all.map(|name| format!("{name:?}")).collect();
            let fix = format!("remove {one}, and write {list} = [{}]", all.join(", "));
            self.problem(&at.key(list), what, &names, "one of the two", &fix);
        }
    }

    /// Whether the last of these names, by which files are called, is like one before it.
    fn clash(&mut self, path: &KeyPath, names: &[&str], what: &str) -> bool {
        let Some((name, before)) = names.split_last() else { return false };
        let file = file_name(name);
        let Some(first) = before.iter().find(|other| file_name(other) == file) else { return false };
        if first == name {
            self.not_allowed(path, name, &format!("every {what} once"), "remove one of them");
        } else {
            let allowed = "names whose letters and digits differ: files are called by them";
            self.not_allowed(path, name, allowed, "rename one of the two");
        }
        true
    }

    fn field_times(&mut self) {
        let (times, end) = (&self.case.gauges.field_times_s, self.case.stages.run.end_time_s);
        let path = KeyPath::top("gauges").key("field_times_s");
        for (index, &time) in times.iter().enumerate() {
            let allowed = format!("0 <= time <= stages.run.end_time_s = {}", text(end));
            let holds = time >= 0.0 && (time <= end || !end.is_finite());
            self.require(&path.index(index), time, holds, &allowed, "leave this time out, or run longer");
            if index > 0 && time <= times[index - 1] {
                let allowed = format!("times that increase: the one before is {}", text(times[index - 1]));
                self.not_allowed(&path.index(index), &time, &allowed, "sort the times and remove repeated ones");
            }
        }
    }

    fn interval_inside(&mut self, path: &KeyPath, interval: [f64; 2], limits: [f64; 2]) {
        self.interval(path, interval);
        self.inside(&path.index(0), interval[0], limits);
        self.inside(&path.index(1), interval[1], limits);
    }

    fn inside(&mut self, path: &KeyPath, number: f64, [low, high]: [f64; 2]) {
        // An inverted domain is reported by itself.
        if low < high {
            let allowed = format!("inside the domain: from {} to {}", text(low), text(high));
            let holds = (low..=high).contains(&number);
            self.require(path, number, holds, &allowed, "move it into the domain, or enlarge the domain");
        }
    }
}
