//! Gravity, grid, domain, side walls, stages, output and numerical settings.

use super::{Checker, text_down, text_up};
use crate::case::path::KeyPath;

/// Most samples of the force gauge, and most VTK files.
const MAX_SAMPLES: f64 = 1.0e8;
const MAX_VTK_FILES: f64 = 1.0e5;

impl Checker<'_> {
    pub(super) fn sections(&mut self) {
        self.gravity();
        self.grid_and_domain();
        self.stages();
        self.gauges();
        self.output_and_numerics();
    }

    fn gravity(&mut self) {
        let gravity = &self.case.gravity;
        let at = KeyPath::top("gravity");
        self.not_negative(&at.key("magnitude_m_per_s2"), gravity.magnitude_m_per_s2, 9.81);
        self.angle(&at.key("inclination_deg"), gravity.inclination_deg, 90.0);
        if let Some(settle) = gravity.settle_inclination_deg {
            let path = at.key("settle_inclination_deg");
            self.angle(&path, settle, 90.0);
            let stages = &self.case.stages;
            if stages.tilt.is_none() && settle != gravity.inclination_deg && settle.is_finite() {
                let allowed =
                    "another angle than inclination_deg only with a [stages.tilt] that turns one into the other";
                self.not_allowed(&path, &settle, allowed, "add [stages.tilt] or leave settle_inclination_deg out");
            }
        }
        if self.case.stages.settle.is_some() && gravity.magnitude_m_per_s2 == 0.0 {
            let allowed = "magnitude_m_per_s2 > 0 with [stages.settle]: nothing settles without gravity";
            let fix = "leave [stages.settle] out, or give gravity a magnitude";
            self.not_allowed(&at.key("magnitude_m_per_s2"), &0.0, allowed, fix);
        }
    }

    fn grid_and_domain(&mut self) {
        let (grid, domain) = (&self.case.grid, &self.case.domain);
        let at = KeyPath::top("grid");
        self.positive(&at.key("spacing_m"), grid.spacing_m, 0.01);
        self.positive(&at.key("thickness_m"), grid.thickness_m, 0.2);
        if grid.spacing_m > 0.0 && grid.origin_m.iter().any(|o| o.abs() > grid.spacing_m) {
            let allowed = "at most one spacing_m from 0: all nodes follow from one";
            self.not_allowed(&at.key("origin_m"), &grid.origin_m, allowed, "give the place of the node next to [0, 0]");
        }
        self.particles_per_cell(&at, grid.particles_per_cell);
        let at = KeyPath::top("domain");
        self.interval(&at.key("x_m"), domain.x_m);
        self.interval(&at.key("y_m"), domain.y_m);
        self.farthest_cell();
        let (at, walls) = (KeyPath::top("side_walls"), &self.case.side_walls);
        self.not_negative(&at.key("friction"), walls.friction, 0.0);
        self.names_of_bodies(&at.key("bodies"), walls.bodies.as_deref());
    }

    /// Particles per cell of the grid, or of the body at `at`.
    pub(super) fn particles_per_cell(&mut self, at: &KeyPath, count: u32) {
        if ![1, 4, 9, 16].contains(&count) {
            let path = at.key("particles_per_cell");
            self.not_allowed(&path, &count, "1, 4, 9 or 16: squares of 1 to 4", "use 4");
        }
    }

    fn stages(&mut self) {
        let stages = &self.case.stages;
        let at = KeyPath::top("stages");
        if let Some(settle) = &stages.settle {
            let at = at.key("settle");
            self.not_negative(&at.key("damping_per_s"), settle.damping_per_s, 60.0);
            self.positive(&at.key("residual"), settle.residual, 1.0e-4);
            self.positive(&at.key("max_time_s"), settle.max_time_s, 5.0);
        }
        if let Some(tilt) = &stages.tilt {
            self.positive(&at.key("tilt").key("duration_s"), tilt.duration_s, 0.5);
            if stages.settle.is_none() {
                let what = "stages.tilt is given without stages.settle".to_owned();
                let allowed = "a tilt follows a settling and uses its damping and residual";
                self.problem(&at.key("tilt"), what, &"", allowed, "add [stages.settle] or leave [stages.tilt] out");
            }
        }
        self.positive(&at.key("run").key("end_time_s"), stages.run.end_time_s, 6.0);
    }

    fn output_and_numerics(&mut self) {
        let (interval, numerics) = (self.case.output.vtk_interval_s, &self.case.numerics);
        let (end, rate) = (self.case.stages.run.end_time_s, self.case.gauges.sample_rate_hz);
        let path = KeyPath::top("output").key("vtk_interval_s");
        self.not_negative(&path, interval, 0.02);
        if interval > 0.0 && end / interval > MAX_VTK_FILES {
            let allowed = format!("at most {MAX_VTK_FILES:e} files; this would write {:.1e}", end / interval);
            let fix = format!("use {} or more, or 0 for no files", text_up(end / MAX_VTK_FILES));
            self.not_allowed(&path, &interval, &allowed, &fix);
        }
        if end * rate > MAX_SAMPLES {
            let allowed = format!("at most {MAX_SAMPLES:e} samples; this would record {:.1e}", end * rate);
            let fix = format!("use {} or less", text_down(MAX_SAMPLES / end));
            self.require(&KeyPath::top("gauges").key("sample_rate_hz"), rate, false, &allowed, &fix);
        }
        let at = KeyPath::top("numerics");
        let cfl = numerics.cfl;
        self.require(&at.key("cfl"), cfl, cfl > 0.0 && cfl <= 1.0, "0 < cfl <= 1", "use a value such as 0.3");
        if let Some(fraction) = numerics.pic_fraction {
            let holds = (0.0..=1.0).contains(&fraction);
            let allowed = "0 <= pic_fraction <= 1";
            self.require(&at.key("pic_fraction"), fraction, holds, allowed, "use a value such as 5.0e-4");
        }
        if let Some(rate) = numerics.pic_rate_per_s {
            let path = at.key("pic_rate_per_s");
            self.not_negative(&path, rate, 5.0);
            if numerics.pic_fraction.is_some() {
                let what = "pic_fraction and pic_rate_per_s are both given".to_owned();
                self.problem(&path, what, &rate, "one of the two: they set the same thing", "remove one of them");
            }
        }
        if let Some(step) = numerics.max_time_step_s {
            self.positive(&at.key("max_time_step_s"), step, 1.0e-4);
        }
    }
}
