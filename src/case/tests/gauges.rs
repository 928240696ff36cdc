//! Bases and windows, in the gauges of the 40 degree case.

use super::bad_input::{Bad, check};
use super::*;

const BASE: &str = "base = \"base\"";

/// The 40 degree case with these lines after its gauges.
fn with_windows(windows: &str) -> String {
    changed("[output]", &format!("{windows}\n[output]"))
}

#[test]
fn several_bases_are_a_list() {
    let case_of = |text: &str| parse(text, "some/case.toml").unwrap_or_else(|e| panic!("{e}")).case;
    let several = case_of(&changed(BASE, "bases = [\"base\", \"barrier\"]"));
    assert_eq!(several.gauges.base_names().collect::<Vec<_>>(), ["base", "barrier"]);
    assert_eq!(case_of(&several.to_toml().expect("TOML")), several);
    // One base is written as it always was.
    let one = case_of(FLUME);
    assert_eq!(one.gauges.base_names().collect::<Vec<_>>(), ["base"]);
    assert!(!one.to_toml().expect("TOML").contains("bases"));
}

#[rustfmt::skip]
pub const BASES: &[Bad] = &[
    (BASE, "bases = [\"floor\"]", "\"floor\"", &["gauges.bases[0] = \"floor\"", "use one of `base`, `back wall`, `gate`, `barrier`"]),
    (BASE, "bases = [\"base\", \"barier\"]", "\"barier\"", &["gauges.bases[1] = \"barier\"", "did you mean `barrier`?"]),
    (BASE, "bases = [\"base\", \"sand\"]", "\"base\", \"sand\"", &["gauges.bases[1] = \"sand\"", "one of [[boundaries]]"]),
    (BASE, "bases = [\"base\", \"gate\", \"base\"]", "bases = [", &["gauges.bases[2] = \"base\"", "every base once", "remove one of them"]),
    (BASE, "base = \"gate\"\nbases = [\"base\"]", "bases = [", &["gauges.base and gauges.bases are both given", "write bases = [\"gate\", \"base\"]"]),
    (BASE, "bases = \"base\"", "bases = ", &["a list"]),
];

#[test]
fn bases_that_cannot_be() {
    check(BASES);
    // Two boundaries may have these names, and files may not.
    let text = changed(BASE, "bases = [\"base\", \"back wall\", \"Back-Wall\"]").replacen(
        "name = \"gate\"",
        "name = \"Back-Wall\"",
        1,
    );
    let report = report_of(&text);
    assert!(report.contains("gauges.bases[2] = \"Back-Wall\"") && report.contains("rename one of the two"), "{report}");
}

#[test]
fn windows_have_names() {
    let text = with_windows(
        "[[gauges.windows]]\nname = \"up\"\nx_m = [0.1, 0.2]\ny_m = [0, 0.3]\n\
         [[gauges.windows]]\nname = \"down\"\nx_m = [0.9, 1]\ny_m = [0.0, 0.1]",
    );
    let case = parse(&text, "some/case.toml").unwrap_or_else(|e| panic!("{e}")).case;
    let down = Window { name: "down".into(), x_m: [0.9, 1.0], y_m: [0.0, 0.1] };
    assert_eq!(case.gauges.windows[1], down);
    // The one without a name is another.
    assert_eq!((case.gauges.windows.len(), case.gauges.window_x_m), (2, Some([0.7, 1.2])));
    assert_eq!(parse(&case.to_toml().expect("TOML"), "again.toml").expect("the same").case, case);
}

/// Cases with a window that cannot be, what stands on the line at fault, and parts of their reports.
pub fn wrong_windows() -> Vec<(String, &'static str, Vec<&'static str>)> {
    let window = |name: &str, more: &str| format!("[[gauges.windows]]\nname = \"{name}\"\n{more}\n");
    let good = window("A b", "x_m = [0.1, 0.2]\ny_m = [0.0, 0.3]");
    let wrong = vec![
        (good.replace("0.1, 0.2", "0.2, 0.1"), "[0.2, 0.1]", vec!["gauges.windows[0].x_m", "swap the two"]),
        (good.replace("0.1, 0.2", "0.1, 3"), "[0.1, 3]", vec!["gauges.windows[0].x_m[1] = 3", "inside the domain"]),
        (good.replace("0.0, 0.3", "-0.5, 0.3"), "[-0.5, 0.3]", vec!["gauges.windows[0].y_m[0] = -0.5"]),
        (good.replace("0.0, 0.3", "nan, 0.3"), "[nan, 0.3]", vec!["gauges.windows[0].y_m[0] = nan"]),
        (good.replace("0.0, 0.3", "0.0, 0.3, 1"), "[0.0, 0.3, 1]", vec!["gauges.windows[0].y_m has 3 values"]),
        (good.replace("y_m = [0.0, 0.3]", ""), "[[gauges.windows]]", vec!["y_m is missing", "add y_m"]),
        (good.replace("x_m = ", "x = "), "x = [0.1", vec!["x is not a key", "did you mean `x_m`?"]),
        (good.replace("A b", " "), "name = \" \"", vec!["gauges.windows[0].name", "not empty"]),
        (good.clone() + &good, "", vec!["gauges.windows[1].name = \"A b\"", "every window once"]),
        (
            good.clone() + &good.replace("A b", "a_B"),
            "name = \"a_B\"",
            vec!["gauges.windows[1].name = \"a_B\"", "letters and digits differ", "rename one of the two"],
        ),
        (good.replace("[[", "[").replace("]]", "]"), "[gauges.windows]", vec!["write [[gauges.windows]]"]),
    ];
    wrong.into_iter().map(|(windows, at, parts)| (with_windows(&windows), at, parts)).collect()
}

#[test]
fn windows_that_cannot_be() {
    for (text, at, parts) in wrong_windows() {
        let report = report_of(&text);
        println!("{report}");
        let place = if at.is_empty() { String::new() } else { format!(".toml:{}:", line_of(&text, at)) };
        for part in [place.as_str(), " = fix: "].iter().chain(&parts) {
            assert!(report.contains(part), "no {part:?} in\n{report}");
        }
    }
}
