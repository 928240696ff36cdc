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
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/flume/40deg.toml");
    let mut case = checkdam::case::load(&path).expect("a valid case").case;
    case.grid.spacing_m = 0.02;
    let mut sim = checkdam::simulation::Simulation::new(checkdam::run::scene::build(&case));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    let between = pool.install(|| {
        (0..50).for_each(|_| sim.step().expect("a step"));
        let before = ALLOCATIONS.load(Ordering::Relaxed);
        (0..50).for_each(|_| sim.step().expect("a step"));
        ALLOCATIONS.load(Ordering::Relaxed) - before
    });
    assert_eq!(between, 0);
}
