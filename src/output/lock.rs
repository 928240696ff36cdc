//! A folder belongs to the process that works in it, or to several that share it.
//!
//! The system keeps the lock and drops it with the process, however that ends; the text in the file only says who it is.
//!
//! Elsewhere: advisory file locks (flock), lock files.

use super::OutputError;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Name of the file in a folder that is locked.
pub const LOCK: &str = ".checkdam-lock";
/// A lock file may be deleted by its owner while another process opens it: so often that one tries again.
const ATTEMPTS: usize = 100;

/// A lock that is held until it is dropped.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
    file: File,
    kind: Kind,
}

/// What is claimed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Nobody else may hold it; the file is deleted at the end.
    Alone,
    /// The same, but not where the file system has no locks.
    IfPossible,
    /// Others may share it.
    Shared,
}

impl Lock {
    /// For this process alone. A file that a dead process left behind is no obstacle.
    ///
    /// # Errors
    /// [`OutputError::InUse`] with the other process if there is one; [`OutputError::Create`] if the file cannot be made.
    pub fn alone(path: impl Into<PathBuf>) -> Result<Self, OutputError> {
        Self::claim(path.into(), Kind::Alone)
    }

    /// For all who share it: nobody has it alone at the same time.
    ///
    /// # Errors
    /// As [`Self::alone`].
    pub fn shared(path: impl Into<PathBuf>) -> Result<Self, OutputError> {
        Self::claim(path.into(), Kind::Shared)
    }

    /// For this process alone, where the file system has locks; where it has none, for what does no harm if two do it.
    ///
    /// # Errors
    /// As [`Self::alone`].
    pub fn if_possible(path: impl Into<PathBuf>) -> Result<Self, OutputError> {
        Self::claim(path.into(), Kind::IfPossible)
    }

    fn claim(path: PathBuf, kind: Kind) -> Result<Self, OutputError> {
        let fail = |source| OutputError::Create { path: path.clone(), source };
        for _ in 0..ATTEMPTS {
            let options = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
            let mut file = options.map_err(fail)?;
            let mut who = String::new();
            match if kind == Kind::Shared { file.try_lock_shared() } else { file.try_lock() } {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    // Its owner signs it a moment after it has locked it.
                    for _ in 0..ATTEMPTS {
                        let _ = file.read_to_string(&mut who);
                        if who.ends_with('\n') {
                            break;
                        }
                        std::thread::sleep(Duration::from_millis(2));
                    }
                    return Err(OutputError::InUse { path, holder: in_words(&who) });
                }
                // Some file systems of clusters have no locks: then the text has to do.
                Err(TryLockError::Error(_)) => {
                    let _ = file.read_to_string(&mut who);
                    if kind == Kind::Alone && may_live(&who, &host()) {
                        let told = in_words(&who);
                        let holder =
                            format!("{told} (there are no locks here: if it is dead, delete {})", path.display());
                        return Err(OutputError::InUse { path, holder });
                    }
                }
            }
            // Its last owner may have deleted it between the two: then another may make it anew.
            if is_at(&file, &path) {
                sign(&mut file).map_err(fail)?;
                return Ok(Self { path, file, kind });
            }
        }
        Err(fail(io::Error::other("it is deleted again and again")))
    }

    /// Whether the file still stands where it was made.
    ///
    /// # Errors
    /// [`OutputError::Gone`]: its folder was deleted or moved, and may belong to another process by now.
    pub fn check(&self) -> Result<(), OutputError> {
        if is_at(&self.file, &self.path) {
            return Ok(());
        }
        Err(OutputError::Gone { path: self.path.parent().unwrap_or(&self.path).to_path_buf() })
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        if self.kind != Kind::Shared && is_at(&self.file, &self.path) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Says in the file who has it.
fn sign(file: &mut File) -> io::Result<()> {
    let since = utc(SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or(Duration::ZERO).as_secs());
    file.set_len(0)?;
    file.seek(SeekFrom::Start(0))?;
    file.write_all(format!("process {} on {} since {since}\n", std::process::id(), host()).as_bytes())
}

fn in_words(who: &str) -> String {
    let who = who.trim();
    if who.starts_with("process ") { who.into() } else { "another process".into() }
}

/// Where there are no locks: whether the process that signed may still be there. Of one on another host nothing is known.
fn may_live(who: &str, host: &str) -> bool {
    let mut words = who.split_whitespace();
    let (Some("process"), Some(id), Some("on"), Some(on)) = (words.next(), words.next(), words.next(), words.next())
    else {
        return false;
    };
    on != host || id != std::process::id().to_string() && Path::new("/proc").join(id).exists()
}

#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |m: fs::Metadata| (m.dev(), m.ino());
    matches!((file.metadata().map(place), fs::metadata(path).map(place)), (Ok(a), Ok(b)) if a == b)
}

#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}

/// Name of this machine.
fn host() -> String {
    let told = fs::read_to_string("/proc/sys/kernel/hostname").ok();
    let told = told.or_else(|| ["HOSTNAME", "COMPUTERNAME"].iter().find_map(|name| std::env::var(name).ok()));
    told.map(|name| name.trim().to_string()).filter(|name| !name.is_empty()).unwrap_or_else(|| "this-machine".into())
}

/// Seconds since 1970 as a date and a time of day (the calendar of Hinnant, "chrono-compatible low-level date algorithms").
fn utc(seconds: u64) -> String {
    let (days, rest) = (seconds / 86_400 + 719_468, seconds % 86_400);
    let (era, of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
    let year = year_of_era + 400 * era + u64::from(month <= 2);
    format!("{year}-{month:02}-{day:02} {:02}:{:02}:{:02} UTC", rest / 3600, rest / 60 % 60, rest % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_has_it_alone_or_many_share_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(LOCK);
        let first = Lock::alone(&path).unwrap();
        for again in [Lock::alone(&path), Lock::shared(&path), Lock::if_possible(&path)] {
            let told = again.unwrap_err().to_string();
            assert!(told.contains(&format!("process {} on {} since 20", std::process::id(), host())), "{told}");
        }
        drop(first);
        assert!(!path.exists());
        let both = [Lock::shared(&path).unwrap(), Lock::shared(&path).unwrap()];
        assert!(Lock::alone(&path).is_err());
        drop(both);
        // What is left behind is no obstacle.
        assert!(path.exists() && Lock::alone(&path).is_ok());
        assert!(!path.exists());
    }

    #[test]
    fn a_folder_that_is_gone_or_made_anew_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let (inside, path) = (folder.path().join("a"), folder.path().join("a").join(LOCK));
        fs::create_dir(&inside).unwrap();
        let lock = Lock::alone(&path).unwrap();
        lock.check().unwrap();
        fs::remove_dir_all(&inside).unwrap();
        let told = lock.check().unwrap_err().to_string();
        assert!(told.contains("deleted or moved"), "{told}");
        fs::create_dir(&inside).unwrap();
        let other = Lock::alone(&path).unwrap();
        assert!(lock.check().is_err());
        drop(lock);
        other.check().unwrap();
    }

    #[test]
    fn without_locks_the_text_has_to_do() {
        let dead = (1..).map(|k| 4_000_000_000u64 + k).find(|k| !Path::new(&format!("/proc/{k}")).exists()).unwrap();
        assert!(!may_live("", "here") && !may_live("garbage", "here"));
        assert!(!may_live(&format!("process {dead} on here since 2026"), "here"));
        assert!(may_live(&format!("process {dead} on there since 2026"), "here"));
        assert!(!cfg!(target_os = "linux") || may_live("process 1 on here since 2026", "here"));
    }

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (seconds, text) in [
            (0, "1970-01-01 00:00:00 UTC"),
            (951_782_400, "2000-02-29 00:00:00 UTC"),
            (1_796_083_199, "2026-11-30 23:59:59 UTC"),
            (4_107_542_400, "2100-03-01 00:00:00 UTC"),
        ] {
            assert_eq!(utc(seconds), text);
        }
    }
}
