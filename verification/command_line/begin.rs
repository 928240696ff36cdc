//! `checkdam new`, `checkdam completions` and `checkdam man`.

use crate::documents::first_case;
use crate::lab::{Lab, TINY};
use std::process::Command;

#[test]
fn a_new_case_can_be_run_and_is_never_written_over() {
    let lab = Lab::new(TINY);
    let outcome = lab.run(&["new", "sand.toml"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    let text = lab.read("sand.toml");
    assert!(text.contains("checkdam check sand.toml") && !text.contains("FILE"), "{text}");
    assert!(text.lines().filter(|line| line.contains('#')).count() > 20, "few comments");
    let check = lab.run(&["check", "sand.toml"]);
    assert!(check.code == Some(0) && !check.err.contains("warning"), "{check:?}");
    // It is the first case of the guide, whose numbers are to be trusted; here it runs until shortly after the impact.
    let inputs = |text: &str| toml::Table::try_from(checkdam::case::parse(text, "case").expect("a case").case).unwrap();
    let [ours, guide] = [inputs(&text), inputs(&first_case())];
    for part in ["gravity", "grid", "domain", "materials", "bodies", "boundaries", "contacts", "stages", "numerics"] {
        assert_eq!(ours.get(part), guide.get(part), "{part}");
    }
    std::fs::write(
        lab.path("short.toml"),
        text.replacen("end_time_s = 3 ", "end_time_s = 0.4 ", 1).replace(", 0.5, 1.0]", "]"),
    )
    .unwrap();
    let run = lab.run(&["run", "short.toml"]);
    assert!(run.code == Some(4) && run.out.contains("arrival at the barrier"), "{run:?}");
    // A file of this name is there: what the user has in it stays.
    let refused = lab.run(&["new"]);
    assert!(refused.code == Some(2) && refused.err.contains("case.toml exists"), "{refused:?}");
    assert_eq!(lab.read("case.toml"), TINY);
    assert_eq!(lab.run(&["new", "no/such/folder/case.toml"]).code, Some(2));
}

#[test]
fn shells_are_told_every_command() {
    let lab = Lab::new(TINY);
    let commands = ["run", "check", "study", "verify", "validate", "compare", "new", "completions", "man"];
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let outcome = lab.run(&["completions", shell]);
        assert_eq!(outcome.code, Some(0), "{shell}: {}", outcome.err);
        for command in commands {
            assert!(outcome.out.contains(command), "{shell}: no {command}");
        }
        assert!(outcome.out.contains("tolerance"), "{shell}");
    }
    assert_eq!(lab.run(&["completions", "cmd"]).code, Some(2));
    // What bash is given, bash can read.
    std::fs::write(lab.path("checkdam.bash"), lab.run(&["completions", "bash"]).out).unwrap();
    if let Ok(output) = Command::new("bash").arg("-n").arg(lab.path("checkdam.bash")).output() {
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let page = lab.run(&["man"]);
    assert!(page.code == Some(0) && page.out.contains(".TH checkdam"), "{}", page.out);
    assert!(commands.iter().all(|command| page.out.contains(command)), "{}", page.out);
    assert!(page.out.contains("Exit codes:"), "{}", page.out);
    let compare = lab.run(&["man", "compare"]);
    assert!(compare.code == Some(0) && compare.out.contains("tolerance"), "{}", compare.out);
    assert_eq!(lab.run(&["man", "nothing"]).code, Some(2));
}
