//! The page of `checkdam report` in a real browser, in real time.

use crate::lab::{Lab, TINY};
use crate::report::{ROUNDED, page, size};
use std::collections::BTreeMap;
use std::fs;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// How long a browser on a busy machine may take to answer.
const PATIENCE: Duration = Duration::from_secs(180);

/// What the page is asked; it sends its answers.
const QUESTIONS: &str = include_str!("questions.js");

/// Collects what goes wrong in the page, before anything else of it.
const COLLECT: &str = "<head><script>window.problems = []; addEventListener('error', (e) => problems.push(e.message)); \
                       const complain = console.error; \
                       console.error = (...a) => { problems.push(a.join(' ')); complain(...a); };</script>";

/// Starts the browser with these arguments; its messages go to `log` of the lab. None if there is no browser.
fn start(lab: &Lab, arguments: &[&str]) -> Option<Child> {
    let named = std::env::var("CHROMIUM").ok();
    let names = ["chromium", "chromium-browser", "google-chrome"].map(str::to_owned);
    let started = named.into_iter().chain(names).find_map(|name| {
        let log = fs::File::create(lab.path("log")).unwrap();
        let mut command = Command::new(name);
        command.args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run"]);
        command.args(["--enable-logging=stderr", "--window-size=1100,900"]).args(arguments);
        command.arg(format!("--user-data-dir={}", lab.path("profile").display()));
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(log).spawn().ok()
    });
    if started.is_none() {
        println!("NOT RUN: there is no Chromium here (apt-get install chromium, or name one in CHROMIUM)");
    }
    started
}

/// What a page answers, by name, and what the browser said. None if there is no browser.
fn answers(lab: &Lab, text: &str) -> Option<(BTreeMap<String, String>, String)> {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    listener.set_nonblocking(true).unwrap();
    let port = listener.local_addr().unwrap().port().to_string();
    let questions = format!("<script>{}</script></body>", QUESTIONS.replace("PORT", &port));
    fs::write(lab.path("asked.html"), text.replacen("<head>", COLLECT, 1).replace("</body>", &questions)).unwrap();
    let url = format!("file://{}", lab.path("asked.html").display());
    // With a port of its own for those who look for faults it stays until it is ended.
    let mut browser = start(lab, &["--remote-debugging-port=0", &url])?;
    let begun = Instant::now();
    let mut body = None;
    while body.is_none() && begun.elapsed() < PATIENCE {
        sleep(Duration::from_millis(50));
        body = listener.accept().ok().and_then(|(stream, _)| received(stream));
    }
    browser.kill().unwrap();
    browser.wait().unwrap();
    let log = lab.read("log");
    let body = body.unwrap_or_else(|| panic!("no answer:\n{log}"));
    println!("{body}");
    let answers = body.lines().filter_map(|line| line.split_once(": ")).map(|(k, v)| (k.to_owned(), v.to_owned()));
    Some((answers.collect(), log))
}

/// The body of a request.
fn received(mut stream: TcpStream) -> Option<String> {
    stream.set_nonblocking(false).ok()?;
    stream.set_read_timeout(Some(Duration::from_secs(10))).ok()?;
    let (mut bytes, mut part) = (Vec::new(), [0; 4096]);
    loop {
        let text = String::from_utf8_lossy(&bytes).into_owned();
        if let Some((head, body)) = text.split_once("\r\n\r\n") {
            let head = head.to_ascii_lowercase();
            let length = head.lines().find_map(|line| line.strip_prefix("content-length: ")?.parse::<usize>().ok());
            if body.len() >= length.unwrap_or(0) {
                let _ = stream.write_all(b"HTTP/1.1 204 No Content\r\nConnection: close\r\n\r\n");
                return (!body.is_empty()).then(|| body.to_owned());
            }
        }
        match stream.read(&mut part) {
            Ok(count) if count > 0 => bytes.extend(&part[..count]),
            _ => return None,
        }
    }
}

/// Asks a real browser. `.ci/run` installs one and asks; without one this says so.
#[test]
#[ignore = "needs Chromium; .ci/run asks it"]
fn the_page_works_in_a_browser() {
    let (lab, text) = page(TINY);
    let Some((answers, log)) = answers(&lab, &text) else { return };
    let number = |key: &str| answers[key].parse::<f64>().unwrap_or_else(|_| panic!("{key}: {answers:?}"));
    assert_eq!((&*answers["problems"], &*answers["ready"]), ("", "true"), "{answers:?}");
    assert!(!log.lines().any(|line| line.contains("CONSOLE") && line.contains("rror")), "{log}");
    assert_eq!(number("fetched"), 0.0, "{answers:?}");
    let rows = lab.rows("run");
    let drawn: Vec<usize> = answers["rows"].split(' ').map(|n| n.parse().unwrap()).collect();
    let all = drawn.len() >= 6 && drawn[0] == rows["history.csv"] && drawn.contains(&rows["energy.csv"]);
    assert!(all, "{drawn:?} {rows:?}");
    assert!(number("blue") > 100.0, "no curve is drawn: {answers:?}");
    assert_eq!(number("frames"), 9.0);
    for changed in ["moved", "recoloured", "dark"] {
        assert!(number(changed) > 200.0, "{changed}: {answers:?}");
    }
    assert!(number("played") > 0.05, "the animation does not play: {answers:?}");
    // The cursor reads the row of the history at the time of the frame.
    let read: Vec<&str> = answers["read"].split(' ').collect();
    let [time, "s", force, unit] = read[..] else { panic!("the cursor reads {read:?}") };
    let [time, force] = [time, force].map(|text| text.replace('\u{2212}', "-").parse::<f64>().unwrap());
    let history = lab.read("run/history.csv");
    let near = |line: &&str| line.split(',').next().unwrap().parse::<f64>().is_ok_and(|t| (t - time).abs() < 1e-4);
    let row: Vec<f64> = history.lines().find(near).expect("a row").split(',').map(|c| c.parse().unwrap()).collect();
    let error = (force * size(unit) - row[1]).abs();
    assert!(row[1] > 1.0 && error <= ROUNDED * row[1], "the cursor reads {read:?}, the row has {} N", row[1]);
    assert!((time - 0.35).abs() < 2e-3, "{time}");
}

/// A page that breaks is seen by what is asked.
#[test]
#[ignore = "needs Chromium; .ci/run asks it"]
fn a_page_that_breaks_is_seen_in_a_browser() {
    let (lab, text) = page(TINY);
    let broken = text.replacen("\nstartFlow();\n", "\nnothing.is.here();\n", 1);
    assert_ne!(broken, text);
    let Some((answers, log)) = answers(&lab, &broken) else { return };
    assert!(answers["problems"].contains("nothing is not defined"), "{answers:?}");
    assert!(log.contains("nothing is not defined"), "{log}");
    let silent = answers["ready"] == "true" || answers["frames"] == "9" || answers["moved"] != "0";
    assert!(!silent, "{answers:?}");
}

/// It prints to a PDF of several pages.
#[test]
#[ignore = "needs Chromium; .ci/run asks it"]
fn the_page_prints_from_a_browser() {
    let (lab, _) = page(TINY);
    let paper = lab.path("page.pdf");
    let print = format!("--print-to-pdf={}", paper.display());
    let url = format!("file://{}", lab.path("run/report.html").display());
    let arguments = ["--virtual-time-budget=8000", "--no-pdf-header-footer", &print, &url];
    let Some(mut browser) = start(&lab, &arguments) else { return };
    browser.wait().unwrap();
    let pdf = fs::read(&paper).expect("a PDF");
    let pages = pdf.windows(11).filter(|w| *w == b"/Type /Page").count();
    assert!(pdf.starts_with(b"%PDF") && pages >= 3, "{pages} pages");
}
