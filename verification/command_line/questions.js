// Run inside a report by the test of report.rs: what a browser makes of it.
const found = { problems: window.problems };
const grab = () => { const c = document.getElementById("stage"); return c ? c.getContext("2d").getImageData(0, 0, c.width, c.height).data : []; };
const changed = (a, b) => { let n = 0; for (let k = 0; k < a.length; k += 4) if (a[k] !== b[k] || a[k + 1] !== b[k + 1] || a[k + 2] !== b[k + 2]) n++; return n; };
const set = (id, value, event) => { const e = document.getElementById(id); e.value = value; e.dispatchEvent(new Event(event)); };
setTimeout(() => {
  found.ready = document.documentElement.dataset.ready;
  found.rows = [...document.querySelectorAll(".chart")].map((c) => c.dataset.rows).join(" ");
  const chart = document.querySelector("#charts canvas");
  const pixels = chart.getContext("2d").getImageData(0, 0, chart.width, chart.height).data;
  found.blue = 0;
  for (let k = 0; k < pixels.length; k += 4) if (pixels[k + 2] > 140 && pixels[k] < 60 && pixels[k + 3] > 100) found.blue++;
  found.frames = document.getElementById("stage").dataset.frames;
  set("scrub", 0, "input");
  const first = grab();
  set("scrub", 4, "input");
  const later = grab();
  found.moved = changed(first, later);
  set("quantity", 1, "change");
  found.recoloured = changed(later, grab());
  set("scrub", 7, "input");
  found.read = [...document.querySelectorAll("#charts .u-legend:first-of-type .u-value")].slice(0, 2).map((e) => e.textContent).join(" ");
  set("scrub", 4, "input");
  document.getElementById("theme").click();
  found.dark = changed(later, grab());
  set("scrub", 0, "input");
  set("pace", 1, "change");
  document.getElementById("play").click();
}, 200);
setTimeout(() => {
  found.played = document.getElementById("stage").dataset.time;
  found.fetched = performance.getEntriesByType("resource").filter((r) => !r.name.startsWith("data:")).length;
  const result = document.createElement("pre");
  result.id = "result";
  result.textContent = Object.entries(found).map(([k, v]) => k + ": " + v).join("\n");
  document.body.append(result);
}, 1500);
