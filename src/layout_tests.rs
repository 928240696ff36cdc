use super::*;
use crate::constitutive::{AnyLaw, LinearElastic};
use crate::scaffold::{Brick, Lcg};
use std::collections::BTreeMap;

const H: f64 = 0.1;

/// What a sort makes of points at given places: bands, grid, and what departed.
struct Sorted {
    bands: Vec<Band>,
    grid: ActiveGrid,
    departed: Vec<Departed>,
    /// Column and row of the first node of each point's stencil, by its number, counted from the origin of the lattice.
    starts: BTreeMap<u32, [i64; 2]>,
}

fn sorted(places: &[[f64; 2]], domain: [[f64; 2]; 2]) -> Sorted {
    let body = Brick::new([0.0; 2], [1, 1], H).body(AnyLaw::LinearElastic(LinearElastic::new(1e5, 0.0)), 1000.0);
    let lattice = Lattice { spacing: H, origin: [0.03, -0.02] };
    let shape = ShapeFunction::Ugimp;
    let mut points = Points::default();
    let mut starts = BTreeMap::new();
    for (id, &x) in places.iter().enumerate() {
        points.push(&Particle::at_rest(id as u32, x));
        let half = shape.half_width(body.points_per_direction);
        starts.insert(id as u32, [0, 1].map(|d: usize| ((x[d] - lattice.origin[d]) / H - half).floor() as i64));
    }
    let (mut bands, mut grid, mut departed) = (vec![Band::default()], ActiveGrid::default(), Vec::new());
    bands[0].points.push(points);
    let bodies = [body];
    let rules = SortRules { lattice, shape, bodies: &bodies, domain };
    let mut sorter = Sorter::default();
    // A second sort finds what the first has left.
    sorter.sort(&rules, &mut bands, &mut grid, &mut departed);
    sorter.sort(&rules, &mut bands, &mut grid, &mut departed);
    bands.iter_mut().for_each(Band::make_room);
    Sorted { bands, grid, departed, starts }
}

/// Clouds of various shapes: wide, high, in two heaps, scattered, a single point.
fn clouds() -> Vec<Vec<[f64; 2]>> {
    let mut rng = Lcg::new(5);
    let mut cloud = |n: usize, low: [f64; 2], size: [f64; 2]| -> Vec<[f64; 2]> {
        (0..n).map(|_| [low[0] + size[0] * rng.unit(), low[1] + size[1] * rng.unit()]).collect()
    };
    vec![
        cloud(4000, [-3.0, 2.0], [8.0, 1.2]),
        cloud(900, [1.0, -5.0], [0.5, 9.0]),
        [cloud(400, [-7.0, 1.0], [1.0, 1.0]), cloud(400, [4.0, -2.0], [1.0, 1.0])].concat(),
        [cloud(1500, [0.0, 0.0], [3.0, 0.5]), cloud(100, [3.0, 0.0], [2.0, 0.2])].concat(),
        cloud(40, [-9.0, -9.0], [30.0, 12.0]),
        cloud(257, [0.0, 0.0], [0.2, 0.2]),
        cloud(1, [-1.0, 1.0], [1.0, 1.0]),
        // As many points in each column as make a band.
        cloud(5000, [0.0, 0.0], [2.0, 9.0]),
        // A rest of few points, of few columns, of enough of both, which joins the last band or makes one.
        [cloud(256, [0.0, 0.0], [0.5, 0.5]), cloud(100, [0.9, 0.0], [0.8, 0.5])].concat(),
        [cloud(256, [0.0, 0.0], [0.5, 0.5]), cloud(200, [0.65, 0.0], [0.2, 0.5])].concat(),
        [cloud(256, [0.0, 0.0], [0.5, 0.5]), cloud(200, [0.9, 0.0], [0.8, 0.5])].concat(),
    ]
}

const EVERYWHERE: [[f64; 2]; 2] = [[-1e3, 1e3], [-1e3, 1e3]];
/// Nodes past the first of a stencil that its points may reach until the next sort.
const PAST: i64 = (STENCIL - 1 + DRIFT) as i64;

#[test]
fn the_grid_has_what_points_can_reach_and_no_more() {
    for places in clouds() {
        let Sorted { grid, starts, .. } = sorted(&places, EVERYWHERE);
        let mut reached: BTreeMap<i64, [i64; 2]> = BTreeMap::new();
        for [i, j] in starts.into_values() {
            for column in i - DRIFT as i64..=i + PAST {
                let rows = reached.entry(column).or_insert([i64::MAX, i64::MIN]);
                *rows = [rows[0].min(j - DRIFT as i64), rows[1].max(j + PAST)];
            }
        }
        let lowest = *reached.keys().next().expect("a point");
        let highest = *reached.keys().last().expect("a point");
        assert_eq!((grid.first[0], grid.columns.len() as i64), (lowest, highest - lowest + 1));
        let corner = [0.03 + grid.first[0] as f64 * H, -0.02 + grid.first[1] as f64 * H];
        assert!((0..2).all(|d| (grid.corner[d] - corner[d]).abs() < 1e-12));
        assert!(grid.spacing == H && (grid.inverse_spacing * H - 1.0).abs() < 1e-15);
        let mut next = 0;
        for (c, column) in grid.columns.iter().enumerate() {
            assert_eq!(column.start, next);
            next += column.rows;
            let Some(&[low, high]) = reached.get(&(lowest + c as i64)) else {
                assert_eq!(column.rows, 0);
                continue;
            };
            assert_eq!((grid.first[1] + i64::from(column.row), i64::from(column.rows)), (low, high - low + 1));
            // And back from a place to the node.
            let node = grid.find([lowest + c as i64, low]).expect("a node");
            assert_eq!((node, grid.place(node)), (column.start as usize, [lowest + c as i64, low]));
            assert_eq!(grid.find([lowest + c as i64, low - 1]), None);
            assert_eq!(grid.find([lowest + c as i64, high]), Some(node + column.rows as usize - 1));
            assert_eq!(grid.find([lowest + c as i64, high + 1]), None);
        }
        assert_eq!(grid.len(), next as usize);
        assert_eq!((grid.find([lowest - 1, 0]), grid.find([highest + 1, 0])), (None, None));
    }
}

#[test]
fn bands_share_out_points_and_nodes() {
    let mut most = 0;
    for places in clouds() {
        let Sorted { bands, grid, starts, departed } = sorted(&places, EVERYWHERE);
        assert!(departed.is_empty());
        most = most.max(bands.len());
        let column = |node: usize| grid.place(node)[0];
        let (mut seen, mut owned) = (0, 0);
        for (k, band) in bands.iter().enumerate() {
            assert_eq!(band.first_node, owned, "bands follow each other");
            owned += band.owned;
            let points: Vec<Particle> = band.points[0].iter().collect();
            seen += points.len();
            assert!(!band.is_empty() && band.len() == points.len());
            let starts: Vec<[i64; 2]> = points.iter().map(|p| starts[&p.id]).collect();
            assert!(starts.is_sorted(), "by column, then by row");
            // Columns where stencils may start: one beside the band's first node, up to the next band's.
            let first = grid.first[0] + DRIFT as i64 + column_of(&grid, band.first_node) as i64;
            let end = bands
                .get(k + 1)
                .map_or(i64::MAX, |b| grid.first[0] + DRIFT as i64 + column_of(&grid, b.first_node) as i64);
            assert!(starts.iter().all(|s| (first..end).contains(&s[0])), "{first} {end} {starts:?}");
            let last = bands.len() - 1;
            if k < last {
                assert!(points.len() >= BAND_POINTS && end - first >= MIN_COLUMNS as i64);
                // No column more than it takes.
                let without_last = starts.iter().filter(|s| s[0] < end - 1).count();
                assert!(without_last < BAND_POINTS || end - first == MIN_COLUMNS as i64 || k + 1 == last);
                assert_eq!(column(band.first_node + band.reach - 1), end - 1 + PAST);
            } else if k > 0 {
                assert!(points.len() >= BAND_POINTS / 2);
                assert!(grid.columns.len() - column_of(&grid, band.first_node) >= MIN_COLUMNS + PAST as usize + DRIFT);
            }
            if k == last {
                // The rest after a possible cut is too small for a band.
                let cut = (first + MIN_COLUMNS as i64..)
                    .find(|&c| starts.iter().filter(|s| s[0] < c).count() >= BAND_POINTS.min(starts.len()));
                let cut = cut.expect("all points lie somewhere");
                let rest = starts.iter().filter(|s| s[0] >= cut).count();
                let columns = starts.last().expect("a point")[0] + 1 - cut;
                assert!(rest < BAND_POINTS / 2 || columns < MIN_COLUMNS as i64, "{rest} {columns}");
            }
            let reach = band.reach;
            assert!(k < last || band.first_node + reach == grid.len() && reach == band.owned);
            let work = &band.work;
            assert_eq!([work.sums.len(), work.motion.len()], [reach; 2]);
            assert_eq!([work.remapped.len(), work.strain_velocity.len()], [reach + 1; 2]);
            assert_eq!([work.mass.len(), work.moved.len()], [band.owned, points.len().div_ceil(8)]);
        }
        assert_eq!((seen, owned), (places.len(), grid.len()));
    }
    assert!(most > 5, "{most}");
}

/// Column, counted from the grid's first, that starts with a node.
fn column_of(grid: &ActiveGrid, node: usize) -> usize {
    grid.columns.iter().position(|c| c.start as usize == node).expect("bands start where columns do")
}

#[test]
fn what_is_outside_departs() {
    let places = [[0.5, 0.5], [1.0, 2.0], [-0.01, 0.5], [0.0, 0.0], [0.5, 2.01], [1.01, 1.0], [0.3, -0.01]];
    let Sorted { bands, departed, .. } = sorted(&places, [[0.0, 1.0], [0.0, 2.0]]);
    let mut left: Vec<u32> = bands.iter().flat_map(|b| b.points[0].iter()).map(|p| p.id).collect();
    left.sort_unstable();
    assert_eq!(left, [0, 1, 3]);
    let gone: Vec<_> = departed.iter().map(|d| (d.body, d.particle.id, d.particle.x)).collect();
    assert_eq!(gone, [(0, 2, places[2]), (0, 4, places[4]), (0, 5, places[5]), (0, 6, places[6])]);
    let nothing = sorted(&[], EVERYWHERE);
    assert!(nothing.bands.iter().all(Band::is_empty));
    assert_eq!((nothing.grid.len(), nothing.bands.iter().map(Band::len).sum::<usize>()), (0, 0));
}
