//! The command as a user meets it: exit codes, messages, what is in the folder afterwards and what is not.

mod begin;
mod browser;
mod compare;
mod documents;
mod faults;
mod interrupted;
mod lab;
mod report;
mod run;
mod snippets;
mod study;
mod suites;

use lab::{Lab, TINY};

#[test]
fn help_names_the_commands_and_the_exit_codes() {
    let lab = Lab::new(TINY);
    let help = lab.run(&["--help"]);
    assert_eq!(help.code, Some(0));
    for text in [
        "run ",
        "check ",
        "Exit codes:",
        "0  done",
        "2  the input",
        "3  the run",
        "4  the run is done and not to be trusted",
        "validation/flume/40deg.toml",
    ] {
        assert!(help.out.contains(text), "no {text:?} in\n{}", help.out);
    }
    assert!(lab.run(&["run", "--help"]).out.contains("--out <DIR>"));
    assert!(lab.run(&["--version"]).out.contains(env!("CARGO_PKG_VERSION")));
    for arguments in
        [&[][..], &["go"], &["run"], &["run", "case.toml", "--threads", "0"], &["run", "case.toml", "--ot", "x"]]
    {
        assert_eq!(lab.run(arguments).code, Some(2), "{arguments:?}");
    }
    assert_eq!(lab.contents("").len(), 1);
}
