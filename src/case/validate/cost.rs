//! What a case would cost: particles, grid cells and time steps, refused before any memory is asked for.

use super::shapes::has_geometry;
use super::{Checker, text, text_down, toml_text};
use crate::case::path::KeyPath;
use crate::case::schema::{Body, MAX_GRID_CELLS, MAX_PARTICLES, MAX_TIME_STEPS};

impl Checker<'_> {
    pub(super) fn cost(&mut self) {
        let parts = ["grid", "domain", "bodies", "materials", "inflows"].map(KeyPath::top);
        if self.is_clean(&parts[0]) && self.case.grid.particles_per_cell > 0 {
            self.particles();
            // An interval of the domain that is wrong is reported by itself, and so is what follows from it.
            if self.is_clean(&parts[1]) {
                self.memory();
            }
            if parts.iter().all(|part| self.is_clean(part)) {
                self.time_steps();
            }
        }
    }

    fn particles(&mut self) {
        let case = self.case;
        let counted = |body: &Body| has_geometry(body) && body.particles_per_cell(&case.grid) > 0;
        for (index, body) in case.bodies.iter().enumerate().filter(|(_, body)| counted(body)) {
            let at = KeyPath::top("bodies").index(index);
            self.fillable(&at, body);
            let Some(rectangle) = body.rectangle() else { continue };
            let spacing = body.particle_spacing_m(&case.grid);
            let [along, across] = body.particle_counts(&case.grid);
            let per_side = f64::from(body.particles_per_cell(&case.grid)).sqrt();
            let keys = if body.foot_m.is_some() { ["thickness_m", "height_m"] } else { ["x_m", "y_m"] };
            let sides = keys.into_iter().zip(rectangle.size_m).zip([along, across]);
            for ((key, side), count) in sides {
                if count == 0.0 {
                    let what = format!("body `{}` is thinner than a particle", body.name);
                    let allowed = format!("sides of at least the particle spacing of {} m", text(spacing));
                    let fix =
                        format!("enlarge the body, or use grid.spacing_m = {} or less", text_down(side * per_side));
                    let edges = if key == "x_m" { body.x_m } else { body.y_m.filter(|_| key == "y_m") };
                    match edges {
                        Some(edges) => self.problem(&at.key(key), what, &edges, &allowed, &fix),
                        None => self.problem(&at.key(key), what, &side, &allowed, &fix),
                    }
                }
            }
        }
    }

    /// Refuses a cell size that asks for more memory than there is.
    fn memory(&mut self) {
        let (case, domain) = (self.case, &self.case.domain);
        let bodies = || case.bodies.iter().filter(|body| has_geometry(body));
        let spacing = case.grid.spacing_m;
        let entering = if self.is_clean(&KeyPath::top("inflows")) { case.entering_count_estimate() } else { 0.0 };
        let particles = bodies().map(|body| body.particle_count(&case.grid)).sum::<f64>() + entering;
        let domain_area = (domain.x_m[1] - domain.x_m[0]) * (domain.y_m[1] - domain.y_m[0]);
        let cells = domain_area / spacing.powi(2);

        let at_start = bodies().map(|body| body.area_m2() * f64::from(body.particles_per_cell(&case.grid)));
        let weighted_area = at_start.sum::<f64>() + entering * spacing.powi(2);
        let for_particles = rounded_up((weighted_area / MAX_PARTICLES).sqrt());
        let for_cells = rounded_up((domain_area / MAX_GRID_CELLS).sqrt());
        let both = for_particles.max(for_cells);
        for (count, of_what, limit, smallest) in [
            (particles, "particles", MAX_PARTICLES, for_particles),
            (cells, "grid cells in the domain", MAX_GRID_CELLS, for_cells),
        ] {
            if count > limit {
                let path = KeyPath::top("grid").key("spacing_m");
                let what = format!("{path} = {} would give {count:.1e} {of_what}", text(spacing));
                let allowed = format!("at most {limit:.1e} {of_what}: spacing_m >= {}", text(smallest));
                let fix = format!("use spacing_m = {} or more", text(both));
                self.problem(&path, what, &spacing, &allowed, &fix);
            }
        }
    }

    fn time_steps(&mut self) {
        let (stages, step) = (&self.case.stages, self.case.time_step_estimate_s());
        let at = KeyPath::top("stages");
        let settle = stages.settle.as_ref().map(|s| (at.key("settle").key("max_time_s"), s.max_time_s));
        let tilt = stages.tilt.as_ref().map(|t| (at.key("tilt").key("duration_s"), t.duration_s));
        let run = (at.key("run").key("end_time_s"), stages.run.end_time_s);
        for (path, time) in settle.into_iter().chain(tilt).chain([run]) {
            if time / step > MAX_TIME_STEPS {
                let what = format!("{path} = {} would take {:.1e} time steps", toml_text(&time), time / step);
                let allowed = format!(
                    "at most {MAX_TIME_STEPS:.1e} steps of {} s, the time step of this cell size and the fastest waves",
                    text(step)
                );
                let fix = format!(
                    "use {} = {} or less, a larger grid.spacing_m, or a smaller young_pa",
                    path.last_key(),
                    text_down(step * MAX_TIME_STEPS)
                );
                self.problem(&path, what, &time, &allowed, &fix);
            }
        }
    }
}

/// A length rounded up to two digits, so that it is accepted when a user copies it.
fn rounded_up(length_m: f64) -> f64 {
    let digit = 10.0_f64.powf(length_m.log10().floor() - 1.0);
    (length_m * 1.001 / digit).ceil() * digit
}
