//! A rigid block on a surface whose friction is elastic-plastic in slip, under a constant pull: swings on the elastic slip, slides,
//! stops, springs back.

use libm::{acos, atan2, cos, hypot, sin};

/// A block and what acts on it, per mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slider {
    /// Constant pull, m/s2.
    pub pull: f64,
    /// Full friction, m/s2.
    pub grip: f64,
    /// Elastic slip at full friction, m.
    pub length: f64,
}

/// Where it is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sliding {
    /// Place, m.
    pub x: f64,
    /// Velocity, m/s.
    pub v: f64,
    /// Elastic slip, m.
    pub elastic: f64,
}

impl Slider {
    /// Circular frequency on the elastic slip, 1/s.
    pub fn frequency(&self) -> f64 {
        (self.grip / self.length).sqrt()
    }

    /// Elastic slip at which friction balances the pull, m.
    pub fn balance(&self) -> f64 {
        self.length * self.pull / self.grip
    }

    /// The state after `time` (s).
    pub fn after(&self, mut at: Sliding, mut time: f64) -> Sliding {
        while time > 0.0 {
            let outward = at.v * at.elastic >= 0.0 && at.elastic.abs() >= self.length * (1.0 - 1e-12);
            let (next, used) = if outward && at.v != 0.0 { self.slide(at, time) } else { self.swing(at, time) };
            (at, time) = (next, time - used);
        }
        at
    }

    /// Plastic slip until it stops, at most for `time`.
    fn slide(&self, at: Sliding, time: f64) -> (Sliding, f64) {
        let side = at.v.signum();
        let a = self.pull - side * self.grip;
        let stop = if a * side < 0.0 { -at.v / a } else { f64::INFINITY };
        let t = time.min(stop);
        let v = if t == stop { 0.0 } else { at.v + a * t };
        (Sliding { x: at.x + t * (at.v + 0.5 * a * t), v, elastic: side * self.length }, t)
    }

    /// Elastic slip until it yields, at most for `time`.
    fn swing(&self, at: Sliding, time: f64) -> (Sliding, f64) {
        let (w, middle) = (self.frequency(), self.balance());
        // middle + size cos(w t - phase)
        let (p, q) = (at.elastic - middle, at.v / w);
        let (size, phase) = (hypot(p, q), atan2(q, p));
        let turn = 2.0 * std::f64::consts::PI;
        let yields = |side: f64| {
            let share = (side * self.length - middle) / size;
            if share.abs() > 1.0 {
                return f64::INFINITY;
            }
            // It moves outward where the angle w t - phase lies before a crest, or before a trough.
            let angle = if side > 0.0 { -acos(share) } else { acos(share) };
            let t = (angle + phase).rem_euclid(turn) / w;
            if t < 1e-12 / w { turn / w } else { t }
        };
        let first = yields(1.0).min(yields(-1.0));
        let t = time.min(first);
        let angle = w * t - phase;
        let (elastic, v) = (middle + size * cos(angle), -w * size * sin(angle));
        let elastic = if t == first { self.length.copysign(elastic) } else { elastic };
        (Sliding { x: at.x + elastic - at.elastic, v, elastic }, t)
    }
}

/// Work that a cycle of slip between -`amplitude` and `amplitude` (m) takes at full friction `force` (N), 4 F (A - u), J: the area of the
/// hysteresis loop.
pub fn loop_area(force: f64, amplitude: f64, length: f64) -> f64 {
    4.0 * force * (amplitude - length).max(0.0)
}

/// Energy of the elastic slip at full friction `force` (N), J.
pub fn stored(force: f64, length: f64) -> f64 {
    0.5 * force * length
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLIDER: Slider = Slider { pull: 1.5, grip: 4.0, length: 3e-3 };

    /// The same by many small steps.
    fn stepped(slider: &Slider, mut at: Sliding, time: f64) -> Sliding {
        let steps = 2_000_000;
        let dt = time / f64::from(steps);
        for _ in 0..steps {
            at.v += dt * (slider.pull - slider.grip * at.elastic / slider.length);
            at.x += dt * at.v;
            at.elastic = (at.elastic + dt * at.v).clamp(-slider.length, slider.length);
        }
        at
    }

    #[test]
    fn phases_follow_each_other_as_small_steps_find() {
        for v in [-1.0, -0.1, 0.02, 0.3] {
            for time in [0.05, 0.4, 1.1] {
                let from = Sliding { v, ..Sliding::default() };
                let (one, other) = (SLIDER.after(from, time), stepped(&SLIDER, from, time));
                assert!((one.x - other.x).abs() < 2e-6 && (one.v - other.v).abs() < 2e-4, "{one:?} {other:?}");
                assert!((one.elastic - other.elastic).abs() < 2e-6);
            }
        }
    }

    #[test]
    fn released_from_nothing_it_swings_about_its_balance() {
        let half = std::f64::consts::PI / SLIDER.frequency();
        let far = SLIDER.after(Sliding::default(), half);
        assert!((far.x - 2.0 * SLIDER.balance()).abs() < 1e-15 && far.v.abs() < 1e-12);
    }

    #[test]
    fn a_loop_that_stays_elastic_takes_nothing() {
        assert_eq!(loop_area(50.0, 1e-3, 2e-3), 0.0);
        assert!((loop_area(50.0, 5e-3, 1e-3) - 0.8).abs() < 1e-12);
        assert!((stored(50.0, 1e-3) - 0.025).abs() < 1e-15);
    }
}
