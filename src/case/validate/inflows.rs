//! Inflows: what they need, and what they cannot do together with other parts of a case.

use super::{Checker, text, text_down, text_up};
use crate::case::boundary::{Boundary, BoundaryKind};
use crate::case::drawing::Drawing;
use crate::case::geometry::penetration;
use crate::case::inflow::{Inflow, Profile, Towards};
use crate::case::material::Law;
use crate::case::path::KeyPath;
use crate::case::schema::Kinematics;
use crate::case::suggest::did_you_mean;

/// Overlap up to this depth is rounding, m.
const TOLERANCE_M: f64 = 1.0e-9;
/// Most moments of a hydrograph.
const MOST_MOMENTS: usize = 10_000;

impl Checker<'_> {
    pub(super) fn inflows(&mut self) {
        let list = KeyPath::top("inflows");
        if self.case.inflows.is_empty() {
            return;
        }
        let names: Vec<&str> = self.case.inflows.iter().map(|inflow| inflow.name.as_str()).collect();
        self.names(&list, &names);
        self.beside_others();
        for (index, inflow) in self.case.inflows.iter().enumerate() {
            let at = list.index(index);
            if let Some(body) = self.case.bodies.iter().position(|b| b.name == inflow.name) {
                let what = format!("{} = {:?} is used twice", at.key("name"), inflow.name);
                let fix = format!("rename one of them: {} has the same name", KeyPath::top("bodies").index(body));
                self.problem(&at.key("name"), what, &inflow.name, "names that differ", &fix);
            }
            self.inflow_material(&at, inflow);
            if let Some(count) = inflow.particles_per_cell {
                self.particles_per_cell(&at, count);
            }
            self.given(&at, inflow);
            self.front(&at, inflow);
            if self.is_clean(&at) && self.is_clean(&KeyPath::top("grid")) && self.is_clean(&KeyPath::top("domain")) {
                self.place(&at, index, inflow);
                self.extent(&at, inflow);
            }
        }
    }

    /// What an inflow cannot be combined with.
    fn beside_others(&mut self) {
        if !self.case.contacts.is_empty() {
            let what = "a case with inflows has contacts of bodies".to_owned();
            let allowed = "[[contacts]] only without [[inflows]]: what enters would pass through bodies in contact";
            let fix = "make the barrier a boundary with kind = \"wall\", or let a body with a velocity hit it";
            self.problem(&KeyPath::top("contacts"), what, &"", allowed, fix);
        }
        let meshed = self.case.bodies.iter().position(|b| b.kinematics == Kinematics::TotalLagrangian);
        if let Some(k) = meshed {
            let path = KeyPath::top("bodies").index(k).key("kinematics");
            let allowed =
                "\"updated_lagrangian\" beside [[inflows]]: what enters would pass through a body with a mesh";
            self.not_allowed(&path, &Kinematics::TotalLagrangian, allowed, "remove the line, or the inflows");
        }
        if self.case.bodies.is_empty() && self.case.stages.settle.is_some() {
            let what = format!("{} is given and nothing is there to settle", KeyPath::top("stages").key("settle"));
            let allowed = "[stages.settle] only with [[bodies]]: inflows begin after the release";
            self.problem(&KeyPath::top("stages").key("settle"), what, &"", allowed, "leave [stages.settle] out");
        }
    }

    fn inflow_material(&mut self, at: &KeyPath, inflow: &Inflow) {
        let path = at.key("material");
        match self.case.materials.get(&inflow.material) {
            None => {
                let fix = did_you_mean(&inflow.material, self.case.materials.keys().map(String::as_str));
                self.not_allowed(&path, &inflow.material, "the name of one of [materials.NAME]", &fix);
            }
            Some(m) if m.law != Law::DruckerPrager && self.is_clean(&KeyPath::top("materials")) => {
                let allowed = "a material that flows: law = \"drucker_prager\"";
                let fix = "give it a friction angle, or let a body with a velocity hit the barrier";
                self.not_allowed(&path, &inflow.material, allowed, fix);
            }
            Some(_) => {}
        }
    }

    /// Either depth, velocity and duration, or a hydrograph.
    fn given(&mut self, at: &KeyPath, inflow: &Inflow) {
        let spacing = inflow.particle_spacing_m(&self.case.grid);
        let numbers = [
            ("depth_m", inflow.depth_m, "3.0"),
            ("velocity_m_per_s", inflow.velocity_m_per_s, "10.0"),
            ("start_time_s", inflow.start_time_s, "0.0"),
            ("duration_s", inflow.duration_s, "20.0"),
            ("mass_kg", inflow.mass_kg, "1.0e6"),
        ];
        if let Some(times) = &inflow.times_s {
            for (key, number, _) in numbers.into_iter().filter(|(_, n, _)| n.is_some()) {
                let allowed = "left out with times_s: the hydrograph says it";
                self.not_allowed(
                    &at.key(key),
                    &number.unwrap_or_default(),
                    allowed,
                    "remove the line, or the hydrograph",
                );
            }
            return self.hydrograph(at, inflow, times, spacing);
        }
        for (key, list) in [("depths_m", &inflow.depths_m), ("velocities_m_per_s", &inflow.velocities_m_per_s)] {
            if let Some(values) = list {
                self.not_allowed(&at.key(key), values, "only with times_s", "add times_s, or remove the line");
            }
        }
        for (key, number, example) in &numbers[..2] {
            if number.is_none() {
                let (path, what) = (at.key(key), format!("{} is missing", at.key(key)));
                let fix = format!("add a line such as {key} = {example}");
                self.problem(&path, what, &"", "required unless there is a hydrograph", &fix);
            }
        }
        match (inflow.duration_s, inflow.mass_kg) {
            (Some(_), Some(mass)) => {
                let allowed = "one of duration_s and mass_kg: each follows from the other";
                self.not_allowed(&at.key("mass_kg"), &mass, allowed, "remove one of them");
            }
            (None, None) => {
                let what = format!("{} is missing", at.key("duration_s"));
                let fix = "add a line such as duration_s = 20.0";
                self.problem(&at.key("duration_s"), what, &"", "required, or mass_kg, or a hydrograph", fix);
            }
            _ => {}
        }
        for (key, number, _) in numbers.iter().filter(|n| n.0 != "start_time_s" && n.0 != "depth_m") {
            if let Some(number) = number {
                self.positive(&at.key(key), *number, 10.0);
            }
        }
        self.not_negative(&at.key("start_time_s"), inflow.start_time_s.unwrap_or(0.0), 0.0);
        if let Some(depth) = inflow.depth_m {
            self.deep_enough(&at.key("depth_m"), depth, spacing);
        }
    }

    fn deep_enough(&mut self, path: &KeyPath, depth: f64, spacing: f64) {
        let allowed = format!("at least the distance of the particles, {} m", text(spacing));
        let fix = format!("use {} or more, or smaller cells", text_up(spacing));
        self.require(path, depth, depth >= spacing * (1.0 - 1.0e-9) && depth > 0.0, &allowed, &fix);
    }

    fn hydrograph(&mut self, at: &KeyPath, inflow: &Inflow, times: &[f64], spacing: f64) {
        let path = at.key("times_s");
        if times.len() < 2 || times.len() > MOST_MOMENTS {
            let what = format!("{path} has {} moments", times.len());
            let allowed = format!("2 to {MOST_MOMENTS}");
            return self.problem(
                &path,
                what,
                &"",
                &allowed,
                "give the moments between which depth and velocity are linear",
            );
        }
        if times[0] < 0.0 || times.windows(2).any(|two| two[0] >= two[1]) {
            self.not_allowed(
                &path,
                &times,
                "moments that increase, from 0 on: the release is at 0",
                "put them in order",
            );
        }
        for (key, list) in [("depths_m", &inflow.depths_m), ("velocities_m_per_s", &inflow.velocities_m_per_s)] {
            let path = at.key(key);
            let Some(values) = list else {
                let what = format!("{path} is missing");
                let fix = format!("add {key} with a number for each of times_s");
                self.problem(&path, what, &"", "required by times_s", &fix);
                continue;
            };
            if values.len() != times.len() {
                let what = format!("{path} has {} numbers and times_s has {}", values.len(), times.len());
                self.problem(&path, what, &"", "a number for each of times_s", "give as many");
            }
        }
        for (k, depth) in inflow.depths_m.iter().flatten().enumerate() {
            self.deep_enough(&at.key("depths_m").index(k), *depth, spacing);
        }
        let speeds = inflow.velocities_m_per_s.iter().flatten();
        for (k, speed) in speeds.clone().enumerate() {
            self.not_negative(&at.key("velocities_m_per_s").index(k), *speed, 10.0);
        }
        if inflow.velocities_m_per_s.is_some() && speeds.fold(0.0, |a: f64, b| a.max(*b)) == 0.0 {
            let path = at.key("velocities_m_per_s");
            self.not_allowed(&path, &inflow.velocities_m_per_s, "not all 0", "give a velocity, or use a body");
        }
        if inflow.is_varied() && inflow.profile != Profile::Plug {
            let allowed = "profile = \"plug\" where the depth changes: rows of a sheared flow have one height";
            self.not_allowed(&at.key("profile"), &inflow.profile, allowed, "use one depth, or \"plug\"");
        }
    }

    fn front(&mut self, at: &KeyPath, inflow: &Inflow) {
        let Some(angle) = inflow.front_angle_deg else { return };
        let path = at.key("front_angle_deg");
        let fix = "use 90 for a vertical face, or 45";
        self.require(&path, angle, angle > 0.0 && angle <= 90.0, "0 < front_angle_deg <= 90, in degrees", fix);
        if angle < 90.0 && inflow.is_varied() {
            let allowed = "90, a vertical face, where the depth changes";
            self.not_allowed(&path, &angle, allowed, "remove the line, and let the first depths be the front");
        }
        if !self.is_clean(at) || angle >= 90.0 {
            return;
        }
        let (wedge, area) = (inflow.wedge_m(), inflow.area_m2(self.case));
        let long = (area + 0.5 * inflow.deepest_m() * wedge) / inflow.deepest_m();
        if wedge > long {
            let what =
                format!("{path} = {} makes a wedge of {} m of a flow of {} m", text(angle), text(wedge), text(long));
            let least = libm::atan(inflow.deepest_m() / long).to_degrees();
            self.problem(
                &path,
                what,
                &angle,
                "a wedge that is shorter than the flow",
                &format!("use {} or more", text_up(least)),
            );
        }
    }

    /// The section stands on a plane, and what is led behind it has room.
    fn place(&mut self, at: &KeyPath, index: usize, inflow: &Inflow) {
        let path = at.key("foot_m");
        let (h, domain, behind) = (self.case.grid.spacing_m, &self.case.domain, inflow.behind(&self.case.grid));
        let ([low, high], [bottom, top]) = (behind.x_m.unwrap_or_default(), behind.y_m.unwrap_or_default());
        let right = inflow.towards == Towards::Right;
        // A cell beyond the section for what has entered.
        let [low, high] = if right { [low, high + h] } else { [low - h, high] };
        if low < domain.x_m[0] - TOLERANCE_M || high > domain.x_m[1] + TOLERANCE_M {
            let what = format!(
                "inflow `{}` is led from x = {} to {} m, out of the domain",
                inflow.name,
                text(low),
                text(high)
            );
            let allowed = format!(
                "five cells behind the section and one beyond it inside domain.x_m = [{}, {}]",
                text(domain.x_m[0]),
                text(domain.x_m[1])
            );
            self.problem(&path, what, &inflow.foot_m, &allowed, "move the section, or enlarge the domain");
        }
        if bottom < domain.y_m[0] - TOLERANCE_M || top > domain.y_m[1] + TOLERANCE_M {
            let what = format!(
                "inflow `{}` reaches from y = {} to {} m, out of the domain",
                inflow.name,
                text(bottom),
                text(top)
            );
            let allowed = format!("inside domain.y_m = [{}, {}]", text(domain.y_m[0]), text(domain.y_m[1]));
            self.problem(&path, what, &inflow.foot_m, &allowed, "move the section, or enlarge the domain");
        }
        if !self.is_clean(&KeyPath::top("boundaries")) {
            return;
        }
        if inflow.bed(self.case).is_none() {
            let what = format!("no plane lies under the section of inflow `{}`", inflow.name);
            let allowed = "a foot on a boundary with kind = \"plane\" and normal_deg = 90";
            let planes =
                self.case.boundaries.iter().filter(|b| b.kind == BoundaryKind::Plane && b.normal_deg == Some(90.0));
            let fix = match planes.filter_map(|b| Some((b.name.as_str(), b.point_m?[1]))).next() {
                Some((name, y)) => format!("use foot_m = [{}, {y}], on `{name}`", inflow.foot_m[0]),
                None => {
                    "add [[boundaries]] with kind = \"plane\", normal_deg = 90 and a point_m at this height".to_owned()
                }
            };
            self.problem(&path, what, &inflow.foot_m, allowed, &fix);
        }
        let solid = |b: &&Boundary| b.penetration(&behind, &self.case.grid).is_some_and(|p| p.depth_m > TOLERANCE_M);
        let boundary = self.case.boundaries.iter().find(solid).map(|b| format!("boundary `{}`", b.name));
        let drawn = behind.drawing();
        let meets = |other: Option<Drawing>| {
            drawn.as_ref().zip(other).is_some_and(|(own, other)| penetration(own, &other).depth_m > TOLERANCE_M)
        };
        let body = self.case.bodies.iter().find(|b| meets(b.drawing())).map(|b| format!("body `{}`", b.name));
        let others = self.case.inflows[..index].iter().find(|i| meets(i.behind(&self.case.grid).drawing()));
        let other = others.map(|i| format!("inflow `{}`", i.name));
        if let Some(other) = boundary.or(body).or(other) {
            let what = format!("{other} lies within five cells behind the section of inflow `{}`", inflow.name);
            self.problem(
                &path,
                what,
                &inflow.foot_m,
                "nothing else where the flow is led",
                "move the section, or the other",
            );
        }
    }

    /// It begins before the run ends.
    fn extent(&mut self, at: &KeyPath, inflow: &Inflow) {
        let Some([times, ..]) = inflow.hydrograph(self.case) else { return };
        let end = self.case.stages.run.end_time_s;
        if times[0] >= end {
            let key = if inflow.times_s.is_some() { "times_s" } else { "start_time_s" };
            let what =
                format!("inflow `{}` begins at {} s, and the run ends at {} s", inflow.name, text(times[0]), text(end));
            let fix = format!("begin before {} s, or raise stages.run.end_time_s", text_down(end));
            self.problem(&at.key(key), what, &times[0], "a beginning before the end of the run", &fix);
        }
    }
}
