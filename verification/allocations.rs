//! A step allocates nothing once its buffers have grown: a sort reuses what the last one left.

#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

struct Counting;

static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);

// SAFETY: everything is passed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn a_step_allocates_nothing() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../validation/flume/40deg.toml");
    let mut case = checkdam::case::load(&path).expect("a valid case").case;
    case.grid.spacing_m = 0.02;
    assert_eq!(allocations_of(&case), 0);

    // The same sand on an elastic bed, with contact.
    let flume = std::fs::read_to_string(&path).expect("a file");
    let bed = "
        [[bodies]]
        name = \"bed\"
        material = \"rubber\"
        x_m = [-0.2, 0.0]
        y_m = [-0.1, 0.0]
        [materials.rubber]
        law = \"neo_hookean\"
        density_kg_per_m3 = 1200
        young_pa = 1e6
        poisson = 0.3
        [[contacts]]
        bodies = [\"bed\", \"sand\"]
        friction = 0.4";
    let others = flume.replace("point_m = [0.0, 0.0]", "point_m = [0.0, -0.1]");
    let mut case = checkdam::case::parse(&format!("{others}{bed}"), "bed").expect("a valid case").case;
    case.grid.spacing_m = 0.02;
    assert_eq!(allocations_of(&case), 0);
    // In implicit steps memory is asked for where the bed is factorised anew, and where contact touches a node for the first time;
    // hardly ever else.
    case.bodies[1].integration = checkdam::case::Integration::Implicit;
    let (steps, _) = allocating(&case);
    assert!(steps < 20, "{steps} of 400 steps");
}

/// Allocations in 400 steps after the first thousand, in which every body is sorted anew.
fn allocations_of(case: &checkdam::case::Case) -> u64 {
    allocating(case).1
}

/// How many of these steps allocate, and how often in all.
fn allocating(case: &checkdam::case::Case) -> (usize, u64) {
    let mut sim = checkdam::simulation::Simulation::new(checkdam::run::scene::build(case));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    pool.install(|| {
        sim.set_damping(50.0);
        (0..1000).for_each(|_| sim.step().expect("a step"));
        assert_eq!(sim.contact_points().is_empty(), case.contacts.is_empty());
        let (mut steps, mut all) = (0, 0);
        for _ in 0..400 {
            let before = ALLOCATIONS.load(Ordering::Relaxed);
            sim.step().expect("a step");
            let own = ALLOCATIONS.load(Ordering::Relaxed) - before;
            (steps, all) = (steps + usize::from(own > 0), all + own);
        }
        (steps, all)
    })
}
