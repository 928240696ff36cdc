//! Where the particles of a polygon, a disk or a ring are at the start.
//!
//! All particles of a body have one mass. So the shape is cut into as many pieces of one area, and each has a particle at its centre: the mass
//! is that of the drawing, and nothing sticks out of it. A polygon is cut into columns along its own x axis, each of which holds a whole number
//! of pieces, and a column from its lower edge to its upper one in equal shares of its height, so that rows follow what the shape stands on and
//! what it ends with. Where a column has several parts, because the shape forks or steps along the axis, each gets the whole number that
//! is nearest to its area and to what the columns before it have left over. A disk or a ring is cut into rings, and these into sectors.
//!
//! Elsewhere: particle seeding, discretisation of the initial domain; largest remainders.

use crate::case::{Ring, direction, nearest_whole};
use crate::seeded::{self, Seed};
use std::f64::consts::PI;

type Point = [f64; 2];

/// How far a particle is moved from the centre of its piece, as shares of the piece in two directions, by its number.
pub type Moved<'a> = &'a dyn Fn(u32) -> [f64; 2];

/// Where in its share of the height a particle lies.
fn middle() -> f64 {
    if seeded::is(Seed::CaseFilling) { 0.6 } else { 0.5 }
}

/// Two straight sides above each other over a stretch of the axis: where it begins and ends, the lower and the upper side at both, m.
#[derive(Debug, Clone, Copy)]
struct Trapezoid {
    u: [f64; 2],
    low: [f64; 2],
    high: [f64; 2],
}

impl Trapezoid {
    fn heights(&self) -> [f64; 2] {
        [self.high[0] - self.low[0], self.high[1] - self.low[1]]
    }

    fn area(&self) -> f64 {
        let [a, b] = self.heights();
        0.5 * (self.u[1] - self.u[0]) * (a + b)
    }

    /// Lower side and height at a place of the axis.
    fn at(&self, u: f64) -> [f64; 2] {
        let share = ((u - self.u[0]) / (self.u[1] - self.u[0])).clamp(0.0, 1.0);
        let between = |[a, b]: [f64; 2]| a + share * (b - a);
        [between(self.low), between(self.heights())]
    }

    /// What of it lies between two places.
    fn cut(&self, from: f64, to: f64) -> Option<Self> {
        let u = [self.u[0].max(from), self.u[1].min(to)];
        (u[0] < u[1]).then(|| {
            let at = u.map(|u| self.at(u));
            Self { u, low: at.map(|a| a[0]), high: at.map(|a| a[0] + a[1]) }
        })
    }

    /// Length over which one that ends here and one that begins here are open to each other.
    fn opening(&self, next: &Self) -> f64 {
        self.high[1].min(next.high[0]) - self.low[1].max(next.low[0])
    }

    /// Whether one that begins where this one ends goes on from it, with steps of at most `step` (m) in its sides.
    fn goes_on(&self, next: &Self, step: f64) -> bool {
        let steps = [self.low[1] - next.low[0], self.high[1] - next.high[0]];
        self.opening(next) > 0.0 && steps.iter().all(|s| s.abs() <= step)
    }
}

/// The stretches between corners, each with its trapezoids from below.
fn stretches(points: &[Point]) -> Vec<Vec<Trapezoid>> {
    let mut us: Vec<f64> = points.iter().map(|p| p[0]).collect();
    us.sort_by(f64::total_cmp);
    us.dedup();
    let sides: Vec<[Point; 2]> = (0..points.len()).map(|k| [points[k], points[(k + 1) % points.len()]]).collect();
    us.windows(2)
        .map(|w| {
            let [from, to] = [w[0], w[1]];
            let spans = |[a, b]: &&[Point; 2]| a[0].min(b[0]) <= from && a[0].max(b[0]) >= to;
            let height = |[a, b]: &[Point; 2], u: f64| match u {
                u if u == a[0] => a[1],
                u if u == b[0] => b[1],
                u => a[1] + (u - a[0]) / (b[0] - a[0]) * (b[1] - a[1]),
            };
            let mut lines: Vec<[f64; 2]> =
                sides.iter().filter(spans).map(|s| [height(s, from), height(s, to)]).collect();
            lines.sort_by(|a, b| (a[0] + a[1]).total_cmp(&(b[0] + b[1])));
            let pairs = lines.chunks_exact(2);
            pairs.map(|p| Trapezoid { u: [from, to], low: p[0], high: p[1] }).collect()
        })
        .collect()
}

/// A part of a column that does not fork.
#[derive(Debug, Clone)]
struct Part(Vec<Trapezoid>);

impl Part {
    fn area(&self) -> f64 {
        self.0.iter().map(Trapezoid::area).sum()
    }

    fn ends(&self) -> [f64; 2] {
        let [first, last] = [self.0.first(), self.0.last()];
        [first.map_or(0.0, |t| t.u[0]), last.map_or(0.0, |t| t.u[1])]
    }

    fn at(&self, u: f64) -> [f64; 2] {
        let here = self.0.iter().find(|t| u <= t.u[1]).or(self.0.last());
        here.map_or([0.0; 2], |t| t.at(u))
    }

    /// Centres of `count` pieces of one area from below.
    fn centres(&self, count: usize, first: u32, moved: Moved) -> Vec<Point> {
        let (mut area, mut first_moment, mut low_moment, mut square) = (0.0, 0.0, 0.0, 0.0);
        for t in &self.0 {
            let (w, [a, b], [l, m]) = (t.u[1] - t.u[0], t.heights(), t.low);
            area += 0.5 * w * (a + b);
            first_moment += 0.5 * w * (a + b) * t.u[0] + w * w * (a + 2.0 * b) / 6.0;
            low_moment += w * (l * a / 3.0 + (l * b + m * a) / 6.0 + m * b / 3.0);
            square += w * (a * a + a * b + b * b) / 3.0;
        }
        let centre = first_moment / area;
        let [from, to] = self.ends();
        let n = count as f64;
        (0..count)
            .map(|j| {
                let share = (j as f64 + middle()) / n;
                let [along, across] = moved(first + j as u32);
                if along != 0.0 || across != 0.0 {
                    let u = centre + 2.0 * along * (centre - from).min(to - centre);
                    let [low, height] = self.at(u);
                    return [u, low + (share + across / n) * height];
                }
                let v = (low_moment + share * square) / area;
                let [low, height] = self.at(centre);
                // Where a side bends in the column, the centre of a piece may lie outside of it.
                let own = low + j as f64 / n * height..=low + (j as f64 + 1.0) / n * height;
                [centre, if own.contains(&v) { v } else { low + share * height }]
            })
            .collect()
    }
}

/// Steps of a side up to this share of a column's width are no end of a part.
const STEP: f64 = 0.5;

/// The parts of the column between two places.
fn parts(stretches: &[Vec<Trapezoid>], from: f64, to: f64) -> Vec<Part> {
    let cut = |s: &Vec<Trapezoid>| s.iter().filter_map(|t| t.cut(from, to)).collect::<Vec<_>>();
    let inside: Vec<Vec<Trapezoid>> = stretches.iter().map(cut).filter(|s| !s.is_empty()).collect();
    let mut found: Vec<Part> = Vec::new();
    // Parts that end where the next stretch begins, by the number of the trapezoid.
    let mut open: Vec<usize> = Vec::new();
    for (k, now) in inside.iter().enumerate() {
        let before: &[Trapezoid] = if k > 0 { &inside[k - 1] } else { &[] };
        let beside = |t: &Trapezoid| -> Vec<usize> {
            (0..before.len()).filter(|&b| before[b].goes_on(t, STEP * (to - from))).collect()
        };
        let mut next = Vec::with_capacity(now.len());
        for t in now {
            let own = match beside(t)[..] {
                [one] if now.iter().filter(|o| before[one].goes_on(o, STEP * (to - from))).count() == 1 => open[one],
                _ => {
                    found.push(Part(Vec::new()));
                    found.len() - 1
                }
            };
            found[own].0.push(*t);
            next.push(own);
        }
        open = next;
    }
    found
}

/// Centres of `count` pieces of one area of a polygon that is counter-clockwise, with columns along an axis at this angle.
pub fn polygon(points: &[Point], count: usize, rotation_deg: f64, moved: Moved) -> Vec<Point> {
    let Some(&origin) = points.first() else { return Vec::new() };
    let [c, s] = direction(rotation_deg);
    let own: Vec<Point> = points
        .iter()
        .map(|p| {
            let [x, y] = [p[0] - origin[0], p[1] - origin[1]];
            [c * x + s * y, c * y - s * x]
        })
        .collect();
    let stretches = stretches(&own);
    // Area up to the end of each stretch.
    let mut up_to = vec![0.0];
    for stretch in &stretches {
        up_to.push(up_to.last().copied().unwrap_or(0.0) + stretch.iter().map(Trapezoid::area).sum::<f64>());
    }
    let total = up_to.last().copied().unwrap_or(0.0);
    let [Some(low), Some(high)] = [stretches.first(), stretches.last()].map(|s| s.and_then(|s| s.first())) else {
        return Vec::new();
    };
    let (low, high) = (low.u[0], high.u[1]);
    let piece = total / count as f64;
    let edges = edges(&stretches, &up_to, [low, high], count);
    let mut centres = Vec::with_capacity(count);
    // Parts of the column before that reach its end, with what they have left over.
    let mut before: Vec<(Trapezoid, f64)> = Vec::new();
    for w in edges.windows(2) {
        let [(from, first), (to, last)] = [w[0], w[1]];
        let parts = parts(&stretches, from, to);
        let mut shares: Vec<f64> = parts.iter().map(|p| p.area() / piece).collect();
        for (end, left) in before.drain(..) {
            let beside = |p: &Part| p.0.first().filter(|t| t.u[0] <= from).map_or(0.0, |t| end.opening(t));
            let rank = |k: &usize| (beside(&parts[*k]).max(0.0), parts[*k].area());
            let larger = |a: &usize, b: &usize| rank(a).partial_cmp(&rank(b)).unwrap_or(std::cmp::Ordering::Equal);
            if let Some(k) = (0..parts.len()).max_by(larger) {
                shares[k] += left;
            }
        }
        let counts = whole(&shares, last - first);
        for ((part, share), n) in parts.iter().zip(&shares).zip(counts) {
            let more = part.centres(n, centres.len() as u32, moved);
            centres.extend(more);
            before.extend(part.0.last().map(|t| (*t, share - n as f64)));
        }
    }
    let back = |[u, v]: Point| [origin[0] + (c * u - s * v), origin[1] + (s * u + c * v)];
    centres.into_iter().map(back).collect()
}

/// Edges of the columns, with how many pieces lie before each: as many columns as a square of one piece fits into the length.
fn edges(stretches: &[Vec<Trapezoid>], up_to: &[f64], [low, high]: [f64; 2], count: usize) -> Vec<(f64, usize)> {
    let total = up_to.last().copied().unwrap_or(0.0);
    let piece = total / count as f64;
    let columns = nearest_whole((high - low) / piece.sqrt()).max(1.0) as usize;
    let begins: Vec<f64> = stretches.iter().map(|s| s.first().map_or(low, |t| t.u[0])).collect();
    let area = |u: f64| {
        let k = begins.partition_point(|b| *b <= u).saturating_sub(1);
        let here = stretches[k].iter().filter_map(|t| t.cut(f64::NEG_INFINITY, u));
        up_to[k] + here.map(|t| t.area()).sum::<f64>()
    };
    let place = |area: f64| {
        let k = up_to.partition_point(|a| *a <= area).saturating_sub(1).min(stretches.len() - 1);
        let [a, b] = [0, 1].map(|end| stretches[k].iter().map(|t| t.heights()[end]).sum::<f64>());
        let (missing, begin) = (area - up_to[k], begins[k]);
        let length = stretches[k].first().map_or(0.0, |t| t.u[1] - t.u[0]);
        // Of a t + (b - a) t^2 / (2 length) = missing the root that stays finite.
        let root = (a * a + 2.0 * (b - a) * missing / length).max(0.0).sqrt();
        begin + if a + root > 0.0 { (2.0 * missing / (a + root)).min(length) } else { 0.0 }
    };
    let mut edges = vec![(low, 0)];
    for k in 1..columns {
        let pieces = nearest_whole(area(low + (high - low) * k as f64 / columns as f64) / piece) as usize;
        if pieces > edges.last().map_or(0, |e| e.1) && pieces < count {
            edges.push((place(pieces as f64 * piece), pieces));
        }
    }
    edges.push((high, count));
    edges
}

/// Whole numbers that add up to `sum`, each near to its share (largest remainders).
fn whole(shares: &[f64], sum: usize) -> Vec<usize> {
    // Round-off must not take a piece from a part that has it whole.
    let mut counts: Vec<usize> = shares.iter().map(|s| (s + 1.0e-9).max(0.0).floor() as usize).collect();
    // Nor decide between equals.
    let rest = |counts: &[usize], k: usize| ((shares[k] - counts[k] as f64) * 1.0e6).round();
    while counts.iter().sum::<usize>() < sum {
        let Some(k) = (0..shares.len()).max_by(|&a, &b| rest(&counts, a).total_cmp(&rest(&counts, b))) else { break };
        counts[k] += 1;
    }
    while counts.iter().sum::<usize>() > sum {
        let some = (0..shares.len()).filter(|&k| counts[k] > 0);
        let Some(k) = some.min_by(|&a, &b| rest(&counts, a).total_cmp(&rest(&counts, b))) else { break };
        counts[k] -= 1;
    }
    counts
}

/// Centres of `count` pieces of one area of a disk or a ring, from the inside, with the first edge between sectors at this angle.
pub fn ring(ring: &Ring, count: usize, rotation_deg: f64, moved: Moved) -> Vec<Point> {
    let Ring { centre_m: [x, y], radius_m: outer, inner_radius_m: inner } = *ring;
    let per_radian = 0.5 * (outer - inner) * (outer + inner);
    let piece = 2.0 * PI * per_radian / count as f64;
    let rings = nearest_whole((outer - inner) / piece.sqrt()).max(1.0) as usize;
    let [c, s] = direction(rotation_deg);
    let mut centres = Vec::with_capacity(count);
    let (mut begin, mut before) = (inner, 0);
    for k in 1..=rings {
        let wanted = inner + (outer - inner) * k as f64 / rings as f64;
        let area = PI * (wanted - inner) * (wanted + inner);
        let pieces = if k == rings { count } else { (nearest_whole(area / piece) as usize).min(count) };
        if pieces <= before {
            continue;
        }
        let end = (inner * inner + pieces as f64 * piece / PI).sqrt();
        let n = pieces - before;
        let half = PI / n as f64;
        // Centre of a sector of a ring, if it lies in it.
        let radial = (end * end * end - begin * begin * begin) / (end * end - begin * begin) * 2.0 / 3.0;
        let radius = radial * libm::sin(half) / half;
        let radius = if radius < begin || n == 1 && inner > 0.0 { 0.5 * (begin + end) } else { radius };
        for j in 0..n {
            let [out, around] = moved(centres.len() as u32);
            let angle = 2.0 * half * (j as f64 + middle() + around);
            let r = if out == 0.0 { radius } else { radius + 2.0 * out * (radius - begin).min(end - radius) };
            let [u, v] = [r * libm::cos(angle), r * libm::sin(angle)];
            centres.push([x + (c * u - s * v), y + (s * u + c * v)]);
        }
        (begin, before) = (end, pieces);
    }
    centres
}

#[cfg(test)]
#[path = "filling_tests.rs"]
mod tests;
