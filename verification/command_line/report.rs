//! `checkdam report`: every number of the page is that of its file, and the page stands alone.

use crate::lab::{Lab, TINY, changed};
use std::fs;

/// Digits that the page prints: half a unit of the last is this share at most.
pub const ROUNDED: f64 = 5.001e-4;

/// [`TINY`] with a second barrier behind the first.
fn two_barriers() -> String {
    let second = "[[boundaries]]\nname = \"Second one\"\nkind = \"wall\"\nfoot_m = [0.6, 0.0]\nheight_m = 0.3\n\
                  contact = \"smooth\"\n\n[stages.run]";
    changed("[stages.run]", second).replace("barrier = \"barrier\"", "barriers = [\"barrier\", \"Second one\"]")
}

/// Runs a case and makes its page.
pub fn page(case: &str) -> (Lab, String) {
    let lab = Lab::new(case);
    assert_eq!(lab.run(&["run", "case.toml", "--out", "run"]).code, Some(4));
    let outcome = lab.run(&["report", "run"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    let text = lab.read("run/report.html");
    (lab, text)
}

fn unescaped(text: &str) -> String {
    text.replace("&quot;", "\"").replace("&#39;", "'").replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
}

/// A number of the page: what is printed, its unit, its place, the place of what it is divided by.
#[derive(Debug)]
struct Printed {
    text: String,
    unit: String,
    from: String,
    over: Option<String>,
}

/// All numbers of a page that name their place.
fn printed(page: &str) -> Vec<Printed> {
    let one = |part: &str| {
        let (tag, rest) = part.split_once('>').unwrap();
        let of = |key: &str| Some(unescaped(format!(" {tag}").split(&format!(" {key}=\"")).nth(1)?.split('"').next()?));
        let text = rest.split("</span>").next().unwrap().replace('\u{2212}', "-");
        Printed { text, unit: of("data-unit").unwrap(), from: of("data-from").unwrap(), over: of("data-over") }
    };
    page.split("<span ").skip(1).filter(|part| part.starts_with("data-from")).map(one).collect()
}

/// How many of SI a unit is.
pub fn size(unit: &str) -> f64 {
    match unit {
        "%" => 0.01,
        "t" => 1e3,
        "kg" => 1.0,
        _ if unit.starts_with('k') => 1e3,
        _ if unit.starts_with('M') => 1e6,
        "N" | "N/m" | "N m" | "N m/m" | "N s" | "J" | "m" | "s" | "m/s" | "" => 1.0,
        _ => panic!("no unit {unit:?}"),
    }
}

/// The number at a place of the folder `run`, found without the program.
fn number(lab: &Lab, place: &str) -> f64 {
    let (file, key) = place.split_once(':').unwrap();
    let text = lab.read(&format!("run/{file}"));
    if file == "summary.toml" {
        let summary: toml::Table = text.parse().unwrap();
        let mut at = toml::Value::Table(summary);
        for part in key.split('.') {
            let (name, index) = part.split_once('[').map_or((part, None), |(n, k)| (n, Some(k.trim_end_matches(']'))));
            at = match &at {
                toml::Value::Array(list) => {
                    list.iter().find(|v| v["name"].as_str() == Some(name)).unwrap_or_else(|| panic!("{place}")).clone()
                }
                table => table.get(name).unwrap_or_else(|| panic!("{place}")).clone(),
            };
            if let Some(index) = index {
                at = at[index.parse::<usize>().unwrap()].clone();
            }
        }
        return at.as_float().or(at.as_integer().map(|v| v as f64)).unwrap_or_else(|| panic!("{place}"));
    }
    let (column, rule) = key.trim_end_matches(']').split_once('[').unwrap();
    let (which, of) = rule.split_once(' ').unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let of = names.iter().position(|name| *name == of).unwrap();
    let column = names.iter().position(|name| *name == column).unwrap();
    let rows: Vec<Vec<f64>> = lines.map(|l| l.split(',').map(|c| c.parse().unwrap_or(f64::NAN)).collect()).collect();
    let sign = if which == "max" { 1.0 } else { -1.0 };
    let best = rows.iter().map(|row| sign * row[of]).fold(f64::NEG_INFINITY, f64::max);
    rows.iter().find(|row| sign * row[of] == best).unwrap()[column]
}

/// The numbers of a page that are not those of their files.
fn wrong(lab: &Lab, page: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    for item in printed(page) {
        let expected = number(lab, &item.from) / item.over.as_ref().map_or(1.0, |over| number(lab, over));
        let shown: f64 = item.text.parse().unwrap_or(f64::NAN);
        let error = (shown * size(&item.unit) - expected).abs();
        if error.is_nan() || error > ROUNDED * expected.abs() {
            wrong.push(format!("{item:?}: {expected}"));
        }
    }
    wrong
}

#[test]
fn every_number_of_the_page_is_that_of_its_file() {
    let (lab, text) = page(&two_barriers());
    let found = printed(&text);
    assert!(found.len() > 80, "only {} numbers", found.len());
    assert!(wrong(&lab, &text).is_empty(), "{}", wrong(&lab, &text).join("\n"));
    let named = |place: &str| found.iter().any(|item| item.from == place);
    for place in [
        "summary.toml:barrier.peak_20ms_n",
        "summary.toml:barrier.peak_step_n",
        "summary.toml:barrier.static_force_n",
        "summary.toml:barrier.static_shear_n",
        "summary.toml:barrier.static_moment_n_m",
        "summary.toml:barrier.static_height_of_action_m",
        "summary.toml:barrier.run_up_m",
        "summary.toml:barrier.overtopped_kg",
        "summary.toml:barrier.passed_under_kg",
        "summary.toml:barrier.passed_kg",
        "summary.toml:further_barriers.Second one.barrier.peak_20ms_n",
        "history_second_one.csv:force_normal_n[max force_normal_n]",
        "summary.toml:momentum.momentum_closure_1",
    ] {
        assert!(named(place), "{place} is not on the page");
    }
    let summary: toml::Table = lab.read("run/summary.toml").parse().unwrap();
    let last = summary["front"].as_array().unwrap().len() - 1;
    for key in ["depth_m", "velocity_m_per_s", "froude_1", "x_m"] {
        assert!(named(&format!("summary.toml:front[{last}].{key}")), "{key} of the approach");
    }
    let per_metre = |item: &&Printed| item.from.ends_with(":barrier.peak_20ms_n") && item.unit.ends_with("N/m");
    let per_metre = found.iter().find(per_metre).expect("a force per metre");
    assert_eq!(per_metre.over.as_deref(), Some("summary.toml:case.grid.thickness_m"));

    // A structure, and a size that is not that of a flume.
    let plain = lab.read("run/summary.toml");
    let structure =
        "[structure]\npeak_clamp_n = 4.0e7\nstatic_clamp_moment_n_m = -12345.6\ntip_max_m = 0.0123456\ntorn = true\n";
    fs::write(lab.path("run/summary.toml"), format!("{plain}\n{structure}")).unwrap();
    assert_eq!(lab.run(&["report", "run", "--out", "bent.html"]).code, Some(0));
    let bent = lab.read("bent.html");
    assert!(wrong(&lab, &bent).is_empty(), "{}", wrong(&lab, &bent).join("\n"));
    let shown: Vec<String> = printed(&bent).iter().map(|item| format!("{} {}", item.text, item.unit)).collect();
    for text in ["40 MN", "200 MN/m", "-12.35 kN m", "0.01235 m"] {
        assert!(shown.iter().any(|other| other == text), "no {text} in {shown:?}");
    }
    assert!(bent.contains("yes: what is read after that means nothing"));
    fs::write(lab.path("run/summary.toml"), plain).unwrap();

    // A number of the page that is 3 % off is seen, and so is one of the run.
    let tag = text.split("<span ").find(|part| part.contains(":barrier.peak_20ms_n\"")).unwrap();
    let (shown, peak) = (tag.split(['>', '<']).nth(1).unwrap(), number(&lab, "summary.toml:barrier.peak_20ms_n"));
    let off = text.replacen(&format!(">{shown}<"), &format!(">{:.1}<", 1.03 * shown.parse::<f64>().unwrap()), 1);
    assert_eq!(wrong(&lab, &off).len(), 1, "{shown}");
    let summary = lab.read("run/summary.toml");
    let spoilt = summary.replacen(&format!("peak_20ms_n = {peak}"), &format!("peak_20ms_n = {}", 1.03 * peak), 1);
    assert_ne!(summary, spoilt);
    fs::write(lab.path("run/summary.toml"), spoilt).unwrap();
    assert!(!wrong(&lab, &text).is_empty());
}

#[test]
fn the_page_stands_alone_and_says_first_whether_to_trust_it() {
    let (lab, text) = page(TINY);
    assert!(text.starts_with("<!doctype html>\n<!-- checkdam report -->"));
    let at = |part: &str| text.find(part).unwrap_or_else(|| panic!("no {part}"));
    assert!(at("NOT to be trusted") < at("Design sheet") && at("Design sheet") < at("Histories"));
    let reasons = lab.read("run/summary.toml").parse::<toml::Table>().unwrap()["reasons"].as_array().unwrap().clone();
    assert!(reasons.iter().all(|reason| unescaped(&text).contains(reason.as_str().unwrap())));
    assert!(
        text.contains("boundaries.barrier.friction") && text.contains("numerics.cfl"),
        "inputs with their defaults"
    );
    assert!(text.contains("Permission is hereby granted"), "the licence of what is inlined");
    let bare = text.replace("https://github.com/leeoniya/uPlot", "").replace("http://www.w3.org", "");
    for outside in ["src=\"http", "href=\"http", "@import", "fetch(", "XMLHttpRequest", "src=\"//"] {
        assert!(!bare.contains(outside), "{outside}");
    }
    assert!(!text.contains(lab.directory.path().to_str().unwrap()), "it depends on the place of the folder");
    assert!(text.len() < 5_000_000, "{} bytes", text.len());
    // Made again it is the same; a file of somebody else is not replaced.
    assert_eq!(lab.run(&["report", "run"]).code, Some(0));
    assert!(lab.read("run/report.html") == text);
    fs::write(lab.path("mine.html"), "<p>mine").unwrap();
    let refused = lab.run(&["report", "run", "--out", "mine.html"]);
    assert!(refused.code == Some(2) && refused.err.contains("is no report"), "{refused:?}");
    assert_eq!(lab.read("mine.html"), "<p>mine");
    fs::create_dir(lab.path("empty")).unwrap();
    assert_eq!(lab.run(&["report", "empty"]).code, Some(2));
    assert!(!lab.path("empty/report.html").exists());
    // A frame that is cut is told, and the rest of the page is made.
    fs::write(lab.path("run/vtk/flow_00001.vtp"), "<VTKFile").unwrap();
    let cut = lab.run(&["report", "run", "--out", "cut.html"]);
    assert!(cut.code == Some(0) && lab.read("cut.html").contains("flow_00001.vtp is no frame of a run"), "{cut:?}");
    let title = "title = \"</script><b>& 'x'";
    fs::write(lab.path("case.toml"), TINY.replace("title = \"Tiny flume", &title.replace('\'', "`"))).unwrap();
    lab.run(&["run", "case.toml", "--out", "odd"]);
    assert_eq!(lab.run(&["report", "odd"]).code, Some(0));
    assert!(!lab.read("odd/report.html").contains("</script><b>"), "a title becomes a tag");
}

#[test]
fn a_study_has_a_page_too() {
    let lab = Lab::new(TINY);
    fs::create_dir(lab.path("study")).unwrap();
    let rows = "case,friction_1,key,ended,trusted,peak_20ms_n\nc,0.2,k1,at rest,true,101.5\nc,0.4,k2,end time,false,80.25\n\
                c,0.6,k3,failed: why,,\n";
    fs::write(lab.path("study/runs.csv"), rows).unwrap();
    fs::write(lab.path("study/study.toml"), "title = \"Friction & more\"\n").unwrap();
    let outcome = lab.run(&["report", "study"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    let text = lab.read("study/report.html");
    assert!(text.contains("3 runs: 1 trusted, 1 not to be trusted, 1 failed"), "no verdict");
    for part in ["Friction &amp; more", "101.5", "80.25", "failed: why"] {
        assert!(text.contains(part), "no {part}");
    }
}
