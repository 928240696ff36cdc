//! The page of a study: its table, and any quantity over its runs.

use super::page::{Page, Part};
use super::{escape, figures, origin};
use checkdam::output::Table;
use serde_json::json;
use std::path::Path;

/// Rows of the table that are shown.
const ROWS: usize = 2000;

/// The page of the study in a folder.
///
/// # Errors
/// Its table cannot be read.
pub fn page(folder: &Path, table: &Table) -> Result<Page, String> {
    let cells = |name: &str| table.cells(name).map_err(|error| error.to_string());
    let [ended, trusted] = [cells("ended")?, cells("trusted")?];
    let count = table.rows();
    let failed = ended.iter().filter(|text| text.starts_with("failed")).count();
    let doubted = trusted.iter().filter(|text| *text == "false").count();
    let class = if failed + doubted == 0 { "good" } else { "bad" };
    let verdict = format!(
        "<div class=\"verdict {class}\" role=\"status\"><p><strong>{count} runs: {} trusted, {doubted} not to be trusted, {failed} \
         failed</strong></p><p>A run of its own says why it is not to be trusted.</p></div>",
        count - failed - doubted
    );
    let columns: Vec<(&String, Vec<String>)> =
        table.names().iter().map(|name| Ok((name, cells(name)?))).collect::<Result<_, String>>()?;
    let head: String = columns.iter().map(|(name, _)| format!("<th>{}</th>", escape(name))).collect();
    let row = |k: usize| {
        let cells: String = columns.iter().map(|(_, cells)| format!("<td>{}</td>", escape(&cells[k]))).collect();
        let class = if trusted[k] == "true" { "" } else { " class=\"doubt\"" };
        format!("<tr{class}><th scope=\"row\">{}</th>{cells}</tr>", k + 1)
    };
    let rows: String = (0..count.min(ROWS)).map(row).collect();
    let more = if count > ROWS { format!("<p>The first {ROWS} of {count} rows.</p>") } else { String::new() };
    let values = |name: &&String| {
        let column = table.column(name).ok()?;
        let finite = |value: &f64| Some(*value).filter(|value| value.is_finite());
        column
            .iter()
            .any(|value| value.is_finite())
            .then(|| json!({"name": name, "values": column.iter().map(finite).collect::<Vec<_>>()}))
    };
    let numbers: Vec<_> = table.names().iter().filter(|name| *name != "key").collect();
    let study: Vec<_> = numbers.iter().filter_map(values).collect();
    let title = std::fs::read_to_string(folder.join("study.toml")).ok().and_then(|text| {
        let file: toml::Table = text.parse().ok()?;
        Some(file.get("title")?.as_str()?.to_owned())
    });
    let name = || folder.file_name().map_or_else(|| "Study".into(), |name| name.to_string_lossy().into_owned());
    let picked = "<p class=\"controls\"><label>over <select id=\"study-x\"></select></label> <label>show <select id=\"study-y\"></select>\
                  </label></p><div id=\"study-chart\"></div>";
    Ok(Page {
        title: title.unwrap_or_else(name),
        verdict,
        data: json!({"study": study}),
        parts: vec![
            Part::new("study", "A quantity of all runs", picked.into()),
            Part::new("figures", "Figure of the study", figures(folder)?),
            Part::new(
                "runs",
                "Runs",
                format!(
                    "{more}<div class=\"wide\"><table><caption>runs.csv</caption><thead><tr><th>row</th>{head}</tr></thead>\
                     <tbody>{rows}</tbody></table></div>"
                ),
            ),
            Part::new("origin", "Origin", origin(folder, "")?),
        ],
    })
}
