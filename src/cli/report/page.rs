//! The page itself: one file without references to others.

use super::escape;
use serde_json::Value;

/// How every report begins.
pub const START: &str = "<!doctype html>\n<!-- checkdam report -->\n";

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
/// uPlot 1.6.32, as its package has it.
const UPLOT: &str = include_str!("uplot/uPlot.iife.min.js");
const UPLOT_STYLE: &str = include_str!("uplot/uPlot.min.css");
const UPLOT_LICENCE: &str = include_str!("uplot/LICENSE");

/// A section.
pub struct Part {
    id: &'static str,
    title: &'static str,
    html: String,
}

impl Part {
    /// A section with its title.
    pub fn new(id: &'static str, title: &'static str, html: String) -> Self {
        Self { id, title, html }
    }
}

/// What the page has.
pub struct Page {
    /// Its title, as text.
    pub title: String,
    /// What stands first, as HTML.
    pub verdict: String,
    /// What the script draws.
    pub data: Value,
    /// The sections.
    pub parts: Vec<Part>,
}

impl Page {
    /// The text of the file.
    pub fn html(&self) -> String {
        let title = escape(&self.title);
        let links: String =
            self.parts.iter().map(|p| format!("<a href=\"#{}\">{}</a>", p.id, escape(p.title))).collect();
        let parts: String = self
            .parts
            .iter()
            .map(|p| format!("<section id=\"{}\"><h2>{}</h2>{}</section>\n", p.id, escape(p.title), p.html))
            .collect();
        // Nothing in the data ends the element that holds it.
        let data = self.data.to_string().replace('<', "\\u003c");
        format!(
            "{START}<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n<title>{title}</title>\n\
             <style>{UPLOT_STYLE}\n{STYLE}</style>\n</head>\n<body>\n<header><h1>{title}</h1>\
             <button id=\"theme\" type=\"button\">Light or dark</button></header>\n{}\n<nav aria-label=\"Sections\">{links}</nav>\n\
             <main>\n{parts}</main>\n<script type=\"application/json\" id=\"data\">{data}</script>\n\
             <script>\n/* uPlot\n{}\n*/\n{UPLOT}\n</script>\n<script>\n{SCRIPT}</script>\n</body>\n</html>\n",
            self.verdict,
            UPLOT_LICENCE.replace("*/", "")
        )
    }
}

/// Where the charts go.
pub fn charts() -> String {
    "<p class=\"hint\">Drag across a chart to zoom into a time, double-click to see all again. The cursor reads all charts at one time.</p>\
     <div id=\"charts\"></div>"
        .into()
}

/// Where the animation goes, or why there is none.
pub fn animation(why_not: &str) -> String {
    if !why_not.is_empty() {
        return format!("<p>There is nothing to play: {}.</p>", escape(why_not));
    }
    "<div class=\"controls\"><button id=\"play\" type=\"button\" aria-pressed=\"false\">Play</button>\
     <input id=\"scrub\" type=\"range\" min=\"0\" value=\"0\" step=\"1\" aria-label=\"Frame\"><output id=\"clock\"></output>\
     <label>colour by <select id=\"quantity\"><option value=\"0\">speed</option><option value=\"1\">pressure</option>\
     <option value=\"2\">shear strain</option></select></label><label>pace <select id=\"pace\"><option value=\"0.1\">a tenth</option>\
     <option value=\"0.25\">a quarter</option><option value=\"0.5\" selected>half</option><option value=\"1\">as it was</option>\
     </select></label></div><canvas id=\"stage\" role=\"img\" aria-label=\"The material points at a time\"></canvas>\
     <p class=\"hint\" id=\"flow-note\"></p>\
     <p class=\"hint\">Space plays and pauses, the arrow keys step, Home and End go to the first and last frame.</p>"
        .into()
}

/// Something that is opened when it is wanted.
pub fn folded(summary: &str, html: &str) -> String {
    format!("<details><summary>{}</summary>{html}</details>", escape(summary))
}

/// The licence of what is inside the page and was written by others.
pub fn licence() -> String {
    folded("Charts are drawn by uPlot 1.6.32, under the MIT licence", &format!("<pre>{}</pre>", escape(UPLOT_LICENCE)))
}
