//! The same bits for any number of threads and any width of vectors.

use super::super::scene::{Brick, Material, points_by_number, scene};
use super::super::{Fault, Outcome};
use crate::RungFailure;
use checkdam::boundary::{Boundary, BoundaryContact, Friction};
use checkdam::check::{Check, Kind, Tolerance};
use checkdam::constitutive::{AnyLaw, Cone, DruckerPrager};
use checkdam::simulation::{Scheme, Simulation};
use checkdam::transfer::{VectorUnit, limit_vector_unit};
use nalgebra::Vector2;
use rayon::ThreadPoolBuilder;

const SAND: Material = Material::new(1e6, 0.3, 1500.0);

/// All bits of the state of a long heap after some steps, folded into one number, and the parts into which its bands are divided
/// for so many threads: eight need 35 bands, which 190 columns make.
fn fingerprint(
    fault: &Fault,
    (scheme, contact): (Scheme, BoundaryContact),
    threads: usize,
) -> Result<(u64, usize), RungFailure> {
    let brick = Brick::new([0.0, 0.0], [190, 16], 0.01);
    let law = DruckerPrager::new(SAND.linear_elastic(fault), Cone::TriaxialCompression, 0.5, 0.1, 0.0, 0.0, true);
    let base = Boundary::plane("base", Vector2::zeros(), Vector2::new(-0.03, 1.0), Friction::Coulomb(0.4));
    let mut points = brick.points();
    points.iter_mut().for_each(|p| p.v = [p.x[1], 0.5 - p.x[0]]);
    let mut scene = scene(&brick, AnyLaw::DruckerPrager(law), SAND.density, points, vec![base]);
    scene.gravity = [3.0, -9.81];
    scene.numerics.scheme = scheme;
    scene.numerics.boundary_contact = contact;
    let mut sim = Simulation::new(scene);
    for _ in 0..40 {
        sim.step()?;
    }
    let stock = sim.stock();
    let ledger = sim.ledger();
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    let mut fold = |x: f64| hash = (hash ^ x.to_bits()).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(23);
    for p in points_by_number(&sim) {
        let s = p.state.stress;
        let state = [p.x[0], p.x[1], p.v[0], p.v[1], s.xx, s.yy, s.zz, s.xy, p.volume_ratio, p.state.opened];
        state.into_iter().for_each(&mut fold);
    }
    [stock.kinetic, stock.elastic, ledger.internal_work, ledger.boundaries[0].impulse[0]]
        .into_iter()
        .for_each(&mut fold);
    Ok((hash, sim.parts(threads)))
}

pub fn run(fault: &Fault, outcome: &mut Outcome) -> Result<(), RungFailure> {
    // In the one sweep of a step, and in steps that wait where the surface crosses the grid.
    let [nodes, surface] = [BoundaryContact::Nodes, BoundaryContact::Surface];
    for (method, name) in [
        ((Scheme::Musl, nodes), "MUSL"),
        ((Scheme::Usf, nodes), "USF"),
        ((Scheme::Musl, surface), "MUSL on the surface"),
        ((Scheme::Usf, surface), "USF on the surface"),
    ] {
        let mut prints = Vec::new();
        for threads in [1, 2, 3, 8] {
            // Without threads to be had, or a part for each, there is nothing to compare; the count below then fails.
            if let Ok(pool) = ThreadPoolBuilder::new().num_threads(threads).build() {
                let (print, parts) = pool.install(|| fingerprint(fault, method, threads))?;
                prints.extend((parts == threads).then_some(print));
            }
        }
        let same = prints.iter().filter(|&&p| p == prints[0]).count();
        outcome.check(
            Check::value(format!("{name}: runs on 1, 2, 3 and 8 threads with the same bits"), same as f64, 4.0, "1")
                .within(Tolerance::Absolute(0.0), "bits are equal or not")
                .from(Kind::Conservation, "sums are taken in an order that the points alone decide"),
        );
    }
    let mut prints = Vec::new();
    for unit in [VectorUnit::Plain, VectorUnit::Avx2, VectorUnit::Avx512] {
        limit_vector_unit(unit);
        prints.push(fingerprint(fault, (Scheme::Musl, surface), 1));
    }
    limit_vector_unit(VectorUnit::Avx512);
    let first = prints[0].clone()?;
    let mut same = 0;
    for print in prints {
        same += u32::from(print? == first);
    }
    outcome.check(
        Check::value(
            "runs with plain, AVX2 and AVX-512 code (as far as there is) with the same bits",
            f64::from(same),
            3.0,
            "1",
        )
        .within(Tolerance::Absolute(0.0), "bits are equal or not")
        .from(Kind::Conservation, "no fused operations, the same order in every lane"),
    );
    Ok(())
}
