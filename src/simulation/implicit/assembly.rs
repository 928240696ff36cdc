//! Mass, stiffness and stencils of a body in implicit steps, anew after each sort.

use super::{Banded, ImplicitBody, Point, TOUCHABLE};
use crate::constitutive::AnyLaw;
use crate::shape::stencil::Stencil;
use crate::shape::{STENCIL, ShapeFunction};
use crate::simulation::field::VelocityField;
use crate::space::dot;

/// Lame's parameters lambda and mu, Pa.
fn lame(law: &AnyLaw) -> [f64; 2] {
    match law {
        AnyLaw::LinearElastic(e) => [e.bulk - 2.0 / 3.0 * e.shear, e.shear],
        AnyLaw::DruckerPrager(dp) => [dp.elastic.bulk - 2.0 / 3.0 * dp.elastic.shear, dp.elastic.shear],
        AnyLaw::NeoHookean(law) => [law.lame, law.shear],
    }
}

impl ImplicitBody {
    /// Follows a sort of its field.
    pub fn rebuild(&mut self, number: usize, field: &VelocityField, shape: ShapeFunction) {
        self.field = number;
        self.find_points(field, shape);
        let n = 2 * self.mass.len();
        for values in [
            &mut self.velocity,
            &mut self.displacement,
            &mut self.force,
            &mut self.free,
            &mut self.after,
            &mut self.pulled,
            &mut self.damped,
            &mut self.contact,
            &mut self.caught,
        ] {
            values.clear();
            values.resize(n, 0.0);
        }
        self.assemble(field);
        self.unseen = self.nodal_kinetic() - self.point_kinetic(field);
        self.forget();
        self.shared.clear();
        self.slots.clear();
        self.dt = 0.0;
    }

    fn find_points(&mut self, field: &VelocityField, shape: ShapeFunction) {
        let (grid, body) = (&field.grid, &field.bodies[0]);
        let half_width = shape.half_width(body.points_per_direction);
        self.points.clear();
        let mut mass = vec![0.0; grid.len()];
        for base in field.bands.iter().flat_map(|b| b.points[0].iter()) {
            let stencil = Stencil::new(base.x, grid.corner, grid.inverse_spacing, half_width);
            let [column, row] = stencil.start;
            let mut point = Point { base, nodes: [0; 9], weight: [0.0; 9], gradient: [[0.0; 2]; 9] };
            stencil.nodes(|[a, b], weight, gradient| {
                let (k, node) = (a * STENCIL + b, grid.node(column as usize + a, row + b as i32));
                mass[node as usize] += weight * body.point_mass;
                (point.weight[k], point.gradient[k], point.nodes[k]) = (weight, gradient, node as u32);
            });
            self.points.push(point);
        }
        self.order(field, &mass);
    }

    /// Numbers the nodes along the body's longest direction, so that those that share points have numbers near each other.
    fn order(&mut self, field: &VelocityField, mass: &[f64]) {
        let positions: Vec<[f64; 2]> = field.grid.nodes().map(|(_, x)| x).collect();
        let mut nodes: Vec<usize> = (0..mass.len()).filter(|&i| mass[i] > 0.0).collect();
        let count = nodes.len().max(1) as f64;
        let mean = [0, 1].map(|d| nodes.iter().map(|&i| positions[i][d]).sum::<f64>() / count);
        let moment = |d: usize, e: usize| -> f64 {
            nodes.iter().map(|&i| (positions[i][d] - mean[d]) * (positions[i][e] - mean[e])).sum()
        };
        let angle = 0.5 * libm::atan2(2.0 * moment(0, 1), moment(0, 0) - moment(1, 1));
        let axis = [libm::cos(angle), libm::sin(angle)];
        let along = |i: usize| dot(positions[i], axis);
        nodes.sort_by(|&a, &b| along(a).total_cmp(&along(b)).then(a.cmp(&b)));
        let mut number = vec![u32::MAX; mass.len()];
        self.places.clear();
        self.mass.clear();
        self.clamped.clear();
        for (k, &node) in nodes.iter().enumerate() {
            number[node] = k as u32;
            let band = field.bands.partition_point(|b| b.first_node <= node) - 1;
            self.places.push((band, node - field.bands[band].first_node));
            self.mass.push(mass[node]);
            self.clamped.push(field.bands[band].holds.iter().any(|h| h.node as usize == node));
        }
        self.touchable = TOUCHABLE * self.mass.iter().fold(0.0, |a: f64, m| a.max(*m));
        for point in &mut self.points {
            for (node, weight) in point.nodes.iter_mut().zip(point.weight) {
                *node = if weight > 0.0 { number[*node as usize] } else { u32::MAX };
            }
            // A place for what has no weight: any node of the point.
            let some = point.nodes.iter().copied().find(|n| *n != u32::MAX).unwrap_or(0);
            point.nodes.iter_mut().filter(|n| **n == u32::MAX).for_each(|n| *n = some);
        }
    }

    fn assemble(&mut self, field: &VelocityField) {
        let body = &field.bodies[0];
        let [lambda, mu] = lame(&body.law);
        let spread = |p: &Point| {
            let (low, high) = p.nodes.iter().fold((u32::MAX, 0), |(l, h), &n| (l.min(n), h.max(n)));
            (high - low) as usize
        };
        let reach = 2 * self.points.iter().map(spread).max().unwrap_or(0) + 1;
        let n = 2 * self.mass.len();
        (self.stiffness, self.factor) = (Banded::new(n, reach), Banded::new(n, reach));
        let mut momentum = vec![0.0; n];
        for p in &self.points {
            let volume = body.point_volume * p.base.volume_ratio;
            let s = &p.base.state.stress;
            for (&i, (w, g)) in p.nodes.iter().zip(p.weight.iter().zip(&p.gradient)).filter(|(_, (w, _))| **w > 0.0) {
                let i = 2 * i as usize;
                self.force[i] += volume * (s.xx * g[0] + s.xy * g[1]);
                self.force[i + 1] += volume * (s.xy * g[0] + s.yy * g[1]);
                momentum[i] += body.point_mass * w * p.base.v[0];
                momentum[i + 1] += body.point_mass * w * p.base.v[1];
                for (&j, (_, h)) in p.nodes.iter().zip(p.weight.iter().zip(&p.gradient)).filter(|(_, (w, _))| **w > 0.0)
                {
                    let j = 2 * j as usize;
                    let product = dot(*g, *h);
                    for d in 0..2 {
                        for e in 0..2 {
                            let mut c = lambda * g[d] * h[e] + mu * g[e] * h[d];
                            if d == e {
                                c += mu * product;
                            }
                            if j + e <= i + d {
                                self.stiffness.add(i + d, j + e, volume * c);
                            }
                        }
                    }
                }
            }
        }
        self.blocks.follow(&self.stiffness);
        for (node, &m) in self.mass.iter().enumerate() {
            for i in [2 * node, 2 * node + 1] {
                self.velocity[i] = momentum[i] / m;
            }
        }
        self.start.clone_from(&self.velocity);
        // A clamp holds from the first moment on.
        for node in (0..self.mass.len()).filter(|&k| self.clamped[k]) {
            for i in [2 * node, 2 * node + 1] {
                self.velocity[i] = 0.0;
                self.caught[i] = momentum[i];
            }
        }
        self.internal.clone_from(&self.force);
    }
}
