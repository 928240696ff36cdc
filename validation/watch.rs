//! Runs that are watched: with progress in words, one by one or side by side.

use super::Failure;
use super::record::processors;
use checkdam::run::{ProgressFn, RunError};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Is told how far something is, in words; it ends early when this answers `false`.
pub type WordsFn<'a> = dyn FnMut(&str) -> bool + Send + 'a;

/// A run that tells its stage and time under a name.
///
/// # Errors
/// It fails, or is stopped.
pub fn watched<T>(
    name: &str,
    words: &mut WordsFn,
    run: impl FnOnce(&mut ProgressFn) -> Result<T, RunError>,
) -> Result<T, Failure> {
    let mut stopped = false;
    let done = run(&mut |p| {
        let go_on = words(&format!("{name}: {} {:.2} s", p.stage.name(), p.time));
        stopped |= !go_on;
        go_on
    })?;
    if stopped { Err(Failure::Stopped) } else { Ok(done) }
}

/// Does something with every item, one item a thread, the last first; the results in the order of the items.
///
/// # Errors
/// The first of the items that fails or is stopped; the others end early then.
pub fn side_by_side<I: Sync, T: Send>(
    items: &[I],
    words: &mut WordsFn,
    one: impl Fn(&I, &mut WordsFn) -> Result<T, Failure> + Sync,
) -> Result<Vec<T>, Failure> {
    let (total, next) = (items.len(), AtomicUsize::new(0));
    let results: Mutex<Vec<Option<Result<T, Failure>>>> = Mutex::new(items.iter().map(|_| None).collect());
    // What to tell, how many are finished, whether to go on.
    let shared = Mutex::new((words, 0, true));
    let lock = || shared.lock().unwrap_or_else(PoisonError::into_inner);
    std::thread::scope(|scope| {
        for _ in 0..processors().get().min(total) {
            scope.spawn(|| {
                while lock().2
                    && let Some(k) = total.checked_sub(1 + next.fetch_add(1, Ordering::Relaxed))
                {
                    let mut tell = |text: &str| {
                        let (words, finished, go_on) = &mut *lock();
                        *go_on &= words(&format!("{finished} of {total} runs have ended; {text}"));
                        *go_on
                    };
                    // A thread a run: many side by side use the processors better than many threads on one.
                    let result = match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
                        Ok(alone) => alone.install(|| one(&items[k], &mut tell)),
                        Err(error) => Err(Failure::Record(error.to_string())),
                    };
                    let (_, finished, go_on) = &mut *lock();
                    *finished += 1;
                    *go_on &= result.is_ok();
                    results.lock().unwrap_or_else(PoisonError::into_inner)[k] = Some(result);
                }
            });
        }
    });
    let results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    // A failure goes before those that were stopped because of it.
    let mut done = Vec::new();
    let mut stopped = false;
    for result in results {
        match result {
            Some(Ok(value)) => done.push(value),
            Some(Err(Failure::Stopped)) | None => stopped = true,
            Some(Err(failure)) => return Err(failure),
        }
    }
    if stopped { Err(Failure::Stopped) } else { Ok(done) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_stand_in_the_order_of_the_items() {
        let items: Vec<u64> = (0..20).collect();
        let doubled = side_by_side(&items, &mut |_| true, |k, _| Ok(2 * k)).expect("no failure");
        assert_eq!(doubled, items.iter().map(|k| 2 * k).collect::<Vec<_>>());
    }

    #[test]
    fn a_failure_ends_the_others_and_is_told() {
        let wait = |k: &i32, words: &mut WordsFn| {
            if *k == 1 {
                return Err(Failure::Record("one".into()));
            }
            while words("on its way") {
                std::thread::yield_now();
            }
            Err::<(), _>(Failure::Stopped)
        };
        assert!(matches!(side_by_side(&[0, 1], &mut |_| true, wait), Err(Failure::Record(text)) if text == "one"));
        assert!(matches!(side_by_side(&[0, 2], &mut |_| false, wait), Err(Failure::Stopped)));
    }
}
