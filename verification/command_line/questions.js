// Run inside a report by the test of browser.rs: what a browser makes of it. PORT is where the test listens.
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
  setTimeout(end, 100, 1);
}, 200);
/** Waits until the animation has moved, as long as a busy machine may take, and tells the test what was found. */
function end(tries) {
  found.played = Number(document.getElementById("stage").dataset.time);
  if (!(found.played > 0.05) && tries < 150) return setTimeout(end, 100, tries + 1);
  found.fetched = performance.getEntriesByType("resource").filter((r) => !r.name.startsWith("data:")).length;
  const body = Object.entries(found).map(([k, v]) => k + ": " + v).join("\n");
  fetch("http://127.0.0.1:PORT/", { method: "POST", mode: "no-cors", body });
}
