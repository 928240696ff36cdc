//! A rectangle divided into elements of nine nodes: the reference configuration of a body in total-Lagrangian kinematics.
//!
//! The elements lie along the edges of the rectangle, whatever the angle of these to the background grid, and are two cells wide, so that
//! nodes are about a cell apart. Functions are biquadratic (Lagrange): one element bends as a beam does, so a plate one element
//! thick does not lock.
//!
//! Elsewhere: the nine-node quadrilateral (Q9); masses lumped at its nodes are those of Simpson's rule.

/// Nodes of an element.
pub const NODES: usize = 9;
/// Gauss points of an element, which integrate the stiffness of an undistorted element exactly.
pub const POINTS: usize = 9;
/// Weights of Simpson's rule in one direction: the shares of an element's mass at its three nodes.
const SIMPSON: [f64; 3] = [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0];
/// Gauss's three points in [0, 1] and their weights.
const GAUSS: [[f64; 2]; 3] =
    [[0.112_701_665_379_258_31, 5.0 / 18.0], [0.5, 8.0 / 18.0], [0.887_298_334_620_741_7, 5.0 / 18.0]];

/// A rectangle with its elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    corner: [f64; 2],
    /// Unit vector of the first axis; the second is that turned by a right angle, counter-clockwise.
    axis: [f64; 2],
    /// Edges of the elements along either axis, counted from the corner, ascending, m.
    lines: [Vec<f64>; 2],
}

/// A place in a mesh: the nodes of its element, their weights, and the gradients of these in space (1/m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Numbers of the nodes.
    pub nodes: [u32; NODES],
    /// Weights; they add up to one.
    pub weight: [f64; NODES],
    /// Gradients of the weights, 1/m; they add up to zero.
    pub gradient: [[f64; 2]; NODES],
}

/// An element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Element {
    /// Numbers of its nodes.
    pub nodes: [u32; NODES],
    /// Its edges, m.
    pub size: [f64; 2],
}

/// A point of an element at which stresses are summed up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gauss {
    /// Area that belongs to it, m2.
    pub area: f64,
    /// Gradients of the weights of the element's nodes there, 1/m.
    pub gradient: [[f64; 2]; NODES],
}

impl Mesh {
    /// A rectangle of `size` (m) with its first corner at `corner` (m) and its first edge at `angle` (rad) to x, in elements about two
    /// `spacing`s (m) wide. Edges of elements lie at the `cuts` along either axis (m from the corner), where they are inside.
    pub fn rectangle(corner: [f64; 2], angle: f64, size: [f64; 2], spacing: f64, cuts: [&[f64]; 2]) -> Self {
        let lines = [0, 1].map(|d| {
            let near = 1e-6 * spacing;
            let mut ends: Vec<f64> = cuts[d].iter().copied().filter(|s| *s > near && *s < size[d] - near).collect();
            ends.push(size[d]);
            ends.sort_by(f64::total_cmp);
            ends.dedup_by(|b, a| *b - *a < near);
            let mut lines = vec![0.0];
            let mut from = 0.0;
            for to in ends {
                let count = (0.5 * (to - from) / spacing).round().max(1.0);
                lines.extend((1..count as usize).map(|k| from + (to - from) * (k as f64 / count)));
                lines.push(to);
                from = to;
            }
            lines
        });
        Self { corner, axis: [libm::cos(angle), libm::sin(angle)], lines }
    }

    /// Nodes along either axis. Numbers of nodes count up along the second axis first.
    pub fn counts(&self) -> [usize; 2] {
        [0, 1].map(|d| 2 * self.lines[d].len() - 1)
    }

    /// Where the nodes are in the reference configuration, by their numbers, m.
    pub fn nodes(&self) -> Vec<[f64; 2]> {
        let [nx, ny] = self.counts();
        let along = |d: usize, i: usize| {
            let lines = &self.lines[d];
            if i.is_multiple_of(2) { lines[i / 2] } else { 0.5 * (lines[i / 2] + lines[i / 2 + 1]) }
        };
        (0..nx * ny).map(|k| self.place(along(0, k / ny), along(1, k % ny))).collect()
    }

    /// Position of a place given along the axes, m.
    fn place(&self, a: f64, b: f64) -> [f64; 2] {
        let [c, s] = self.axis;
        [self.corner[0] + c * a - s * b, self.corner[1] + s * a + c * b]
    }

    /// Its elements.
    pub fn elements(&self) -> impl Iterator<Item = Element> {
        let [nx, ny] = [0, 1].map(|d| self.lines[d].len() - 1);
        (0..nx * ny).map(move |k| {
            let at = [k / ny, k % ny];
            Element { nodes: self.numbers(at), size: [0, 1].map(|d| self.lines[d][at[d] + 1] - self.lines[d][at[d]]) }
        })
    }

    fn numbers(&self, [i, j]: [usize; 2]) -> [u32; NODES] {
        let rows = self.counts()[1];
        std::array::from_fn(|k| ((2 * i + k / 3) * rows + 2 * j + k % 3) as u32)
    }

    /// A place at `x` (m) of the reference configuration; outside of the rectangle, of the element nearest to it.
    pub fn at(&self, x: [f64; 2]) -> Place {
        let (r, [c, s]) = ([x[0] - self.corner[0], x[1] - self.corner[1]], self.axis);
        let along = [c * r[0] + s * r[1], c * r[1] - s * r[0]];
        let cell = [0, 1].map(|d| {
            let lines = &self.lines[d];
            lines.partition_point(|l| *l <= along[d]).clamp(1, lines.len() - 1) - 1
        });
        let size = [0, 1].map(|d| self.lines[d][cell[d] + 1] - self.lines[d][cell[d]]);
        let inside = [0, 1].map(|d| (along[d] - self.lines[d][cell[d]]) / size[d]);
        Place { nodes: self.numbers(cell), weight: weights(inside), gradient: self.gradients(inside, size) }
    }

    /// Gradients in space of the weights at a place of an element, given in shares of its edges, 1/m.
    fn gradients(&self, [a, b]: [f64; 2], size: [f64; 2]) -> [[f64; 2]; NODES] {
        let ((wa, ga), (wb, gb)) = (quadratic(a), quadratic(b));
        let [c, s] = self.axis;
        std::array::from_fn(|k| {
            let g = [ga[k / 3] * wb[k % 3] / size[0], wa[k / 3] * gb[k % 3] / size[1]];
            [c * g[0] - s * g[1], s * g[0] + c * g[1]]
        })
    }

    /// Gauss's points of an element with these edges (m).
    pub fn gauss(&self, size: [f64; 2]) -> [Gauss; POINTS] {
        std::array::from_fn(|k| {
            let ([a, wa], [b, wb]) = (GAUSS[k / 3], GAUSS[k % 3]);
            Gauss { area: size[0] * size[1] * wa * wb, gradient: self.gradients([a, b], size) }
        })
    }
}

impl Element {
    /// Shares of its mass at its nodes.
    pub fn shares() -> [f64; NODES] {
        std::array::from_fn(|k| SIMPSON[k / 3] * SIMPSON[k % 3])
    }

    /// Largest ratio of the squared gradient of a function of the element, integrated, to its square with the masses at the nodes,
    /// 1/m2: 24 over the square of each edge.
    pub fn steepest(&self) -> f64 {
        24.0 * self.size.iter().map(|a| 1.0 / (a * a)).sum::<f64>()
    }
}

/// Quadratic Lagrange functions of three nodes on [0, 1], and their derivatives.
fn quadratic(s: f64) -> ([f64; 3], [f64; 3]) {
    let w = [(1.0 - s) * (1.0 - 2.0 * s), 4.0 * s * (1.0 - s), s * (2.0 * s - 1.0)];
    (w, [4.0 * s - 3.0, 4.0 - 8.0 * s, 4.0 * s - 1.0])
}

fn weights([a, b]: [f64; 2]) -> [f64; NODES] {
    let ((wa, _), (wb, _)) = (quadratic(a), quadratic(b));
    std::array::from_fn(|k| wa[k / 3] * wb[k % 3])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh() -> Mesh {
        Mesh::rectangle([3.0, -1.0], 0.4, [0.9, 0.2], 0.05, [&[0.2, 5.0, 0.0], &[]])
    }

    /// A quadratic function of space, and its gradient.
    fn function([x, y]: [f64; 2]) -> (f64, [f64; 2]) {
        (1.0 - x + 2.0 * y + 0.5 * x * x - 3.0 * x * y + y * y, [-1.0 + x - 3.0 * y, 2.0 - 3.0 * x + 2.0 * y])
    }

    #[test]
    fn elements_divide_the_pieces_between_cuts() {
        // Pieces of 0.2 and 0.7 m in elements of 0.1 m; 0.2 m in two.
        let lines = mesh().lines;
        assert_eq!(lines.each_ref().map(Vec::len), [10, 3]);
        assert!(lines[0].contains(&0.2) && *lines[0].last().expect("a line") == 0.9);
        // A piece of two cells is an element, one of three cells two; one of half a cell is one.
        for (length, elements) in [(2.0, 1), (3.0, 2), (0.5, 1), (4.9, 2), (5.1, 3)] {
            let m = Mesh::rectangle([0.0; 2], 0.0, [length, 2.0], 1.0, [&[], &[]]);
            assert_eq!(m.elements().count(), elements, "{length}");
        }
    }

    #[test]
    fn quadratic_functions_are_exact_everywhere() {
        let mesh = mesh();
        let values: Vec<f64> = mesh.nodes().iter().map(|x| function(*x).0).collect();
        for [a, b] in [[0.01, 0.01], [0.2, 0.1], [0.55, 0.13], [0.9, 0.2], [0.0, 0.0]] {
            let x = mesh.place(a, b);
            let at = mesh.at(x);
            let (value, gradient) = function(x);
            let found: f64 = at.nodes.iter().zip(at.weight).map(|(n, w)| w * values[*n as usize]).sum();
            assert!((found - value).abs() < 1e-12, "{found} {value}");
            for d in 0..2 {
                let found: f64 = at.nodes.iter().zip(at.gradient).map(|(n, g)| g[d] * values[*n as usize]).sum();
                assert!((found - gradient[d]).abs() < 1e-11, "{found} {gradient:?}");
            }
        }
    }

    #[test]
    fn areas_and_moments_add_up() {
        let mesh = mesh();
        let nodes = mesh.nodes();
        let (mut area, mut lumped, mut mean) = (0.0, 0.0, [0.0; 2]);
        for element in mesh.elements() {
            area += mesh.gauss(element.size).iter().map(|g| g.area).sum::<f64>();
            for (node, share) in element.nodes.iter().zip(Element::shares()) {
                let mass = share * element.size[0] * element.size[1];
                lumped += mass;
                let x = nodes[*node as usize];
                mean = [mean[0] + mass * x[0] / 0.18, mean[1] + mass * x[1] / 0.18];
            }
        }
        let centre = mesh.place(0.45, 0.1);
        assert!((area - 0.18).abs() < 1e-14 && (lumped - 0.18).abs() < 1e-14);
        assert!((mean[0] - centre[0]).abs() < 1e-13 && (mean[1] - centre[1]).abs() < 1e-13);
    }

    #[test]
    fn no_function_is_steeper_than_the_steepest() {
        // By power iteration with the masses at the nodes.
        let mesh = Mesh::rectangle([0.0; 2], 0.3, [0.1, 0.06], 0.05, [&[], &[]]);
        let element = mesh.elements().next().expect("an element");
        let gauss = mesh.gauss(element.size);
        let mass = Element::shares().map(|s| s * element.size[0] * element.size[1]);
        let mut f: [f64; NODES] = std::array::from_fn(|k| libm::sin(1.0 + 7.0 * k as f64));
        let mut ratio = 0.0;
        for _ in 0..2000 {
            let mut next = [0.0; NODES];
            for g in &gauss {
                let slope = [0, 1].map(|d| (0..NODES).map(|k| g.gradient[k][d] * f[k]).sum::<f64>());
                for k in 0..NODES {
                    next[k] += g.area * (slope[0] * g.gradient[k][0] + slope[1] * g.gradient[k][1]) / mass[k];
                }
            }
            ratio = next.iter().fold(0.0f64, |a, x| a.max(x.abs()));
            f = next.map(|x| x / ratio);
        }
        let bound = element.steepest();
        assert!(ratio <= bound * (1.0 + 1e-9) && ratio > 0.3 * bound, "{ratio} {bound}");
    }
}
