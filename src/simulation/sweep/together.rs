//! Two things side by side, on threads that stay awake.
//!
//! Elsewhere: fork and join with threads that spin (busy wait).

use std::sync::atomic::{AtomicBool, Ordering};

/// Looks at a flag before a thread that waits for another may fall asleep: a tenth of a millisecond, or one where it looks for work
/// as well. Where there are more threads than processors, others wait for it as long.
pub const LOOKS: u32 = 10_000;

/// Does both, side by side if a thread is free. The one that is done first waits for the other with open eyes for a while: a thread
/// that falls asleep takes as long to wake up as a small sweep takes.
pub fn together(a: impl FnOnce() + Send, b: impl FnOnce() + Send) {
    let [a_done, b_begun, b_done] = [const { AtomicBool::new(false) }; 3];
    rayon::join(
        || {
            a();
            a_done.store(true, Ordering::Release);
            // What no other thread has taken up yet is done by this one, after this.
            wait(|| is(&b_begun) && !is(&b_done));
        },
        || {
            b_begun.store(true, Ordering::Release);
            b();
            b_done.store(true, Ordering::Release);
            wait(|| !is(&a_done));
        },
    );
}

/// Does what has no parts, or few: another thread stays awake for a while and takes what [`together`] offers it.
pub fn alone(work: impl FnOnce() + Send) {
    let done = AtomicBool::new(false);
    rayon::join(
        || {
            work();
            done.store(true, Ordering::Release);
        },
        || {
            wait(|| {
                let go_on = !is(&done);
                if go_on {
                    rayon::yield_now();
                }
                go_on
            })
        },
    );
}

/// Does a sweep and something else at its side. Either may use several threads: the one that is done first helps the other.
pub fn beside(sweep: impl FnOnce() + Send, work: impl FnOnce() + Send) {
    let [begun, done] = [const { AtomicBool::new(false) }; 2];
    rayon::join(
        || {
            sweep();
            wait(|| {
                let go_on = is(&begun) && !is(&done);
                if go_on {
                    rayon::yield_now();
                }
                go_on
            });
        },
        || {
            begun.store(true, Ordering::Release);
            work();
            done.store(true, Ordering::Release);
        },
    );
}

fn is(flag: &AtomicBool) -> bool {
    flag.load(Ordering::Acquire)
}

fn wait(go_on: impl Fn() -> bool) {
    (0..LOOKS).take_while(|_| go_on()).for_each(|_| std::hint::spin_loop());
}
