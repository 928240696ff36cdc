//! The binary of a test once more, with a fault at work. It imports nothing, as several binaries have it.

use std::io::Read;
use std::process::{Command, Stdio};
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

/// How long an answer may take that takes seconds: what has not come by then does not come.
pub const LIMIT: Duration = Duration::from_secs(600);

/// Runs this binary with a fault at work. Nothing is written or compared that has to do with reports. What it said: its output, and its errors after that. After `limit` it is
/// killed, and whoever asked fails.
pub fn under(fault: &str, variables: &[(&str, &str)], arguments: &[&str], limit: Duration) -> String {
    let start = Instant::now();
    let mut command = Command::new(std::env::current_exe().expect("this binary"));
    for variable in ["CHECKDAM_REPORTS", "INSTA_UPDATE", "RUST_BACKTRACE", "RUST_TEST_THREADS"] {
        command.env_remove(variable);
    }
    command.env("CHECKDAM_SEEDED_FAULT", fault).env("RAYON_NUM_THREADS", "1").envs(variables.iter().copied());
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("this binary once more");
    let (say, heard) = channel();
    let streams: [Box<dyn Read + Send>; 2] =
        [Box::new(child.stdout.take().expect("a pipe")), Box::new(child.stderr.take().expect("a pipe"))];
    for (k, mut stream) in streams.into_iter().enumerate() {
        let say = say.clone();
        std::thread::spawn(move || {
            let mut bytes = Vec::new();
            // What cannot be read is not said.
            let _ = stream.read_to_end(&mut bytes);
            let _ = say.send((k, bytes));
        });
    }
    let mut said = [Vec::new(), Vec::new()];
    for _ in 0..2 {
        let Ok((k, bytes)) = heard.recv_timeout(limit.saturating_sub(start.elapsed())) else {
            let _ = child.kill();
            let _ = child.wait();
            panic!("under the fault {fault} `{}` {variables:?} was killed after {limit:?}", arguments.join(" "));
        };
        said[k] = bytes;
    }
    child.wait().expect("its end");
    said.map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).join("\n")
}
