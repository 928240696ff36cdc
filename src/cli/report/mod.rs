//! `checkdam report`: a run or a study as one page (HTML) that needs nothing else.
//!
//! Every number of it is read from a file of the folder by name, and the page says from which. The same folder gives the same bytes.

mod design;
mod frames;
mod histories;
mod number;
mod page;
mod sha256;
mod study;

use super::console::{say, tell};
use super::folder::{Folder, Run};
use super::{BAD_INPUT, ENDED_EARLY};
use checkdam::output::{Table, write_text};
use number::Numbers;
use page::{Page, Part};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The most bytes of the run's figures.
const FIGURES: u64 = 700_000;

pub fn report(folder: &Path, out: Option<PathBuf>) -> ExitCode {
    let out = out.unwrap_or_else(|| folder.join("report.html"));
    let made = Folder::open(folder).and_then(|opened| {
        if out.exists() && !std::fs::read_to_string(&out).is_ok_and(|text| text.starts_with(page::START)) {
            return Err(format!("{} exists and is no report\n  = fix: give another name with --out", out.display()));
        }
        match &opened {
            Folder::Run(run) => of_run(run),
            Folder::Study(table) => study::page(folder, table),
        }
    });
    let text = match made {
        Ok(page) => page.html(),
        Err(error) => {
            tell!("error: {error}");
            return ExitCode::from(BAD_INPUT);
        }
    };
    if let Err(error) = write_text(&out, &text) {
        tell!("error: {error}");
        return ExitCode::from(ENDED_EARLY);
    }
    say!("{}: {:.2} MB", out.display(), text.len() as f64 / 1e6);
    ExitCode::SUCCESS
}

/// The page of a run.
fn of_run(run: &Run) -> Result<Page, String> {
    let mut tables: BTreeMap<String, Table> = BTreeMap::new();
    for name in run.tables()? {
        // Fields are read by the animation, if at all.
        if !["field.csv", "geometry.csv"].contains(&name.as_str()) {
            tables.insert(name.clone(), run.table(&name)?);
        }
    }
    let numbers = Numbers::new(run, tables);
    let charts = histories::charts(&numbers);
    let flow = frames::pack(run);
    let title = numbers.text("case.title").unwrap_or_default();
    let (flow, no_flow) = match flow {
        Ok(flow) => (flow, String::new()),
        Err(why) => (serde_json::Value::Null, why),
    };
    let number = |place: &str| numbers.at(&format!("summary.toml:{place}"));
    let data = serde_json::json!({
        "charts": charts,
        "flow": flow,
        "outlines": outlines(run)?,
        "inclination": number("case.gravity.inclination_deg").unwrap_or(0.0),
        "start": number("barrier.peak_20ms_time_s").unwrap_or(0.0),
    });
    let version = numbers.text("checkdam_version").unwrap_or_default();
    Ok(Page {
        title,
        verdict: verdict(run),
        data,
        parts: vec![
            Part::new("design", "Design sheet", design::sheets(&numbers) + &design::front(&numbers)),
            Part::new("histories", "Histories", page::charts()),
            Part::new("flow", "The flow", page::animation(&no_flow)),
            Part::new("ledgers", "Ledgers", design::ledgers(&numbers)),
            Part::new("health", "Health", design::health(&numbers)),
            Part::new("figures", "Figures of the run", figures(&run.path)?),
            Part::new("inputs", "Inputs", page::folded("All inputs", &design::inputs(&numbers))),
            Part::new("origin", "Origin", origin(&run.path, &version)?),
        ],
    })
}

/// Whether the numbers are to be trusted, before anything else.
fn verdict(run: &Run) -> String {
    let texts = |key: &str| -> Vec<String> {
        let list = run.summary.get(key).and_then(toml::Value::as_array).into_iter().flatten();
        list.filter_map(|text| text.as_str().map(|text| format!("<li>{}</li>", escape(text)))).collect()
    };
    let status = run.summary.get("status").and_then(toml::Value::as_str).unwrap_or_default();
    let trusted = run.summary.get("trusted").and_then(toml::Value::as_bool) == Some(true);
    let (class, words) = if trusted {
        ("good", "trusted = true: no known fault was met. It does not mean that the model is right.")
    } else {
        ("bad", "trusted = false: these numbers are NOT to be trusted")
    };
    let notes = texts("warnings");
    let notes = if notes.is_empty() {
        String::new()
    } else {
        format!("<p>What else deserves a second look:</p><ul>{}</ul>", notes.concat())
    };
    format!(
        "<div class=\"verdict {class}\" role=\"status\"><p><strong>{words}</strong></p><ul class=\"reasons\">{}</ul><p>{}</p></div>{notes}",
        texts("reasons").concat(),
        escape(status)
    )
}

/// The figures of the folder as pictures, as many as fit.
fn figures(folder: &Path) -> Result<String, String> {
    let mut text = String::new();
    let mut left = FIGURES;
    for path in files(folder, &["svg"])? {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let size = path.metadata().map_or(u64::MAX, |data| data.len());
        if size > left {
            text += &format!("<p>{} ({:.1} MB) is in the folder of the run.</p>", escape(&name), size as f64 / 1e6);
            continue;
        }
        left -= size;
        let bytes = std::fs::read(&path).map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
        text += &format!(
            "<figure><img alt=\"{0}\" src=\"data:image/svg+xml;base64,{1}\"><figcaption>{0}</figcaption></figure>",
            escape(&name),
            base64(&bytes)
        );
    }
    Ok(if text.is_empty() { "<p>The folder has none.</p>".into() } else { text })
}

/// Files of these kinds in a folder, in order.
fn files(folder: &Path, kinds: &[&str]) -> Result<Vec<PathBuf>, String> {
    let fail = |error| format!("cannot look into {}: {error}", folder.display());
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(fail)? {
        let path = entry.map_err(fail)?.path();
        if path.is_file() && path.extension().is_some_and(|kind| kinds.iter().any(|k| kind == *k)) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// What the page was made from: versions, and the digest of every table.
fn origin(folder: &Path, version: &str) -> Result<String, String> {
    let mut rows = String::new();
    for path in files(folder, &["toml", "csv", "pvd"])? {
        let bytes = std::fs::read(&path).map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        rows += &format!(
            "<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td><td class=\"from\">{}</td></tr>",
            escape(&name),
            bytes.len(),
            sha256::digest(&bytes)
        );
    }
    let made =
        if version.is_empty() { String::new() } else { format!("The run was made by checkdam {}. ", escape(version)) };
    Ok(format!(
        "<p>{made}This page was made by checkdam {}.</p><table><caption>Files</caption><thead><tr><th>file</th><th>bytes</th>\
         <th>SHA-256</th></tr></thead><tbody>{rows}</tbody></table>{}",
        env!("CARGO_PKG_VERSION"),
        page::licence()
    ))
}

/// The outlines of the boundaries that stay, with their names.
fn outlines(run: &Run) -> Result<serde_json::Value, String> {
    if !run.path.join("geometry.csv").exists() {
        return Ok(serde_json::json!([]));
    }
    let table = run.table("geometry.csv")?;
    let column = |name: &str| table.column(name).map_err(|error| error.to_string());
    let [number, x, y] = [column("boundary")?, column("x_m")?, column("y_m")?];
    let mut found: Vec<(usize, Vec<[f64; 2]>)> = Vec::new();
    for k in 0..table.rows() {
        let boundary = number[k] as usize;
        if found.last().is_none_or(|(last, _)| *last != boundary) {
            found.push((boundary, Vec::new()));
        }
        found.last_mut().into_iter().for_each(|(_, corners)| corners.push([x[k], y[k]]));
    }
    let case = run.summary.get("case").and_then(|case| case.get("boundaries")).and_then(toml::Value::as_array);
    let text = |k: usize, key: &str| case.and_then(|list| list.get(k)?.get(key)?.as_str()).unwrap_or_default();
    let outline = |(k, corners): &(usize, Vec<[f64; 2]>)| {
        let [name, kind] = ["name", "kind"].map(|key| text(*k, key));
        serde_json::json!({"name": name, "kind": kind, "corners": corners})
    };
    Ok(found.iter().map(outline).collect())
}

/// Text as it may stand in HTML, in attributes too.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c if c.is_control() && c != '\n' => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// A text of at most so many characters.
fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        text.to_owned()
    } else {
        text.chars().take(most).chain("\u{2026}".chars()).collect()
    }
}

/// Bytes in base 64 (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for part in bytes.chunks(3) {
        let word = (0..3).fold(0u32, |word, k| word << 8 | u32::from(part.get(k).copied().unwrap_or(0)));
        for k in 0..4 {
            let sign = SIGNS[(word >> (18 - 6 * k) & 63) as usize];
            text.push(if k <= part.len() { char::from(sign) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base_64_is_that_of_the_standard() {
        let examples =
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("foobar", "Zm9vYmFy")];
        for (text, expected) in examples {
            assert_eq!(base64(text.as_bytes()), expected);
        }
    }

    #[test]
    fn nothing_in_a_name_becomes_a_tag() {
        assert_eq!(escape("<b a=\"1\" c='2'>&\u{1b}"), "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp; ");
    }
}
