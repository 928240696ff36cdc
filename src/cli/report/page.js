"use strict";
// Charts, animation, colours of a report. All data is in the element `data`; nothing is fetched.
const data = JSON.parse(document.getElementById("data").textContent);
const root = document.documentElement;
const css = (name) => getComputedStyle(root).getPropertyValue(name).trim();
const LIGHT = ["#0072b2", "#d55e00", "#009e73", "#b3508a", "#b87d00", "#2f8fc4", "#6f6f6f", "#7a5c00", "#6a3d9a", "#b15928"];
const DARK = ["#58b0ee", "#ff8a3d", "#34d3a4", "#e79ac6", "#f2bd45", "#8fd0f7", "#b5b5b5", "#d1b14a", "#b79be0", "#e09a6b"];
const system = matchMedia("(prefers-color-scheme: dark)");
const isDark = () => (root.dataset.theme || (system.matches ? "dark" : "light")) === "dark";
const colour = (k) => (isDark() ? DARK : LIGHT)[k % LIGHT.length];
const charts = [];

/** A number in four significant digits, as it is read. */
function read(value) {
  if (value === null || value === undefined || !isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4 ? value.toExponential(3) : String(Number(value.toPrecision(4)));
  return text.replace("-", "−");
}

// ---------------------------------------------------------------- charts

/** Room for the names of the ticks of an axis, as wide as the widest. */
function room(chart, values, axisIndex, cycle) {
  const axis = chart.axes[axisIndex];
  if (cycle > 1) return axis._size;
  let size = axis.ticks.size + axis.gap;
  const longest = (values || []).reduce((a, b) => (b && b.length > a.length ? b : a), "");
  if (longest !== "") {
    chart.ctx.font = axis.font[0];
    size += chart.ctx.measureText(longest).width / devicePixelRatio;
  }
  // At least this, so that charts with short names stand one below the other.
  return Math.max(58, Math.ceil(size) + 4);
}

function axis(label) {
  return {
    label, stroke: () => css("--ink"), font: "12px sans-serif", labelFont: "12px sans-serif", labelSize: 18,
    grid: { stroke: () => css("--grid"), width: 1 }, ticks: { stroke: () => css("--grid"), width: 1, size: 5 },
  };
}

let zooming = false;
/** What one chart shows of the time, all show. */
function zoomAll(from, key) {
  if (key !== "x" || zooming || !from.timed) return;
  zooming = true;
  const { min, max } = from.scales.x;
  for (const chart of charts) if (chart !== from && chart.timed) chart.setScale("x", { min, max });
  zooming = false;
}

function width(element) {
  return Math.max(280, Math.floor(element.clientWidth) || 680);
}

function draw(parent, about) {
  const box = document.createElement("div");
  box.className = "chart";
  box.dataset.rows = about.time.length;
  const head = document.createElement("h3");
  head.textContent = about.title;
  box.append(head);
  parent.append(box);
  const series = [{ label: "time", value: (u, v) => (v == null ? "–" : read(v) + " s") }];
  about.series.forEach((s, k) => series.push({
    label: s.label, stroke: () => colour(k) + (k === 0 ? "" : "c0"), width: k === 0 ? 1.8 : 1.1, points: { show: false },
    value: (u, v) => (v == null ? "–" : read(v) + " " + about.unit),
  }));
  const chart = new uPlot({
    width: width(box), height: 250, series,
    scales: { x: { time: false } },
    axes: [{ ...axis("time (s)"), size: 34 }, { ...axis(about.unit || "1"), size: room }],
    cursor: { sync: { key: "run", scales: ["x", null] }, drag: { x: true, y: false }, y: false },
    legend: { live: true },
    hooks: { setScale: [zoomAll] },
  }, [about.time, ...about.series.map((s) => s.values)], box);
  chart.timed = true;
  charts.push(chart);
  const note = document.createElement("p");
  note.className = "from";
  const all = about.of === about.time.length ? "every row" : `${about.time.length} of ${about.of} rows, with the extremes of the first column`;
  note.textContent = `${about.file}: ${about.series.map((s) => s.column).join(", ")}; ${all}`;
  box.append(note);
}

const place = document.getElementById("charts");
if (place) {
  data.charts.forEach((about) => draw(place, about));
  if (data.charts.length === 0) place.textContent = "There is nothing to draw.";
}

/** The charts of a study: one quantity over another. */
function study() {
  const [x, y, target] = ["study-x", "study-y", "study-chart"].map((id) => document.getElementById(id));
  if (!target) return;
  const rows = { name: "row", values: (data.study[0] || { values: [] }).values.map((_, k) => k + 1) };
  const all = [rows, ...data.study];
  for (const select of [x, y]) all.forEach((c, k) => select.append(new Option(c.name, k)));
  const first = all.findIndex((c) => c.name === "peak_20ms_n" || c.name === "static_force_n");
  y.value = String(first > 0 ? first : Math.min(1, all.length - 1));
  const show = () => {
    charts.splice(0).forEach((chart) => chart.destroy());
    const [a, b] = [all[x.value], all[y.value]];
    const order = a.values.map((_, k) => k).filter((k) => a.values[k] !== null).sort((i, j) => a.values[i] - a.values[j]);
    target.dataset.rows = order.length;
    const points = [order.map((k) => a.values[k]), order.map((k) => b.values[k])];
    charts.push(new uPlot({
      width: width(target), height: 320, scales: { x: { time: false } },
      series: [{ label: a.name, value: (u, v) => read(v) },
        { label: b.name, stroke: () => colour(0), paths: () => null, points: { show: true, size: 7, fill: () => colour(0) }, value: (u, v) => read(v) }],
      axes: [axis(a.name), { ...axis(b.name), size: room }],
    }, points, target));
  };
  x.onchange = y.onchange = show;
  show();
}
study();

// ---------------------------------------------------------------- the flow

/** 256 colours between a few. */
function ramp(anchors) {
  const rgb = anchors.map((a) => [1, 3, 5].map((k) => parseInt(a.slice(k, k + 2), 16)));
  return Array.from({ length: 256 }, (_, k) => {
    const at = (k / 255) * (rgb.length - 1), i = Math.min(Math.floor(at), rgb.length - 2);
    return "rgb(" + rgb[i].map((c, j) => Math.round(c + (at - i) * (rgb[i + 1][j] - c))).join(",") + ")";
  });
}
const FLOW = ramp(["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"]);
const SOLID = ramp(["#8c8c8c", "#b0896a", "#d58034", "#d55e00", "#8f1d00"]);

/** The unit of a number of this size, and how many of SI it is. */
function pressureUnit(size) {
  return size >= 1e6 ? ["MPa", 1e6] : size >= 1e3 ? ["kPa", 1e3] : ["Pa", 1];
}

let flow = null;
function startFlow() {
  const about = data.flow;
  const stage = document.getElementById("stage");
  if (!about || !stage) return;
  const raw = atob(about.bytes);
  const bytes = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k++) bytes[k] = raw.charCodeAt(k);
  let offset = 0;
  const frames = about.frames.map((f) => {
    const start = offset;
    offset += 7 * f.n;
    const part = (from, to) => bytes.slice(start + from * f.n, start + to * f.n);
    return { t: f.t, n: f.n, solids: f.solids, x: new Uint16Array(part(0, 2).buffer), y: new Uint16Array(part(2, 4).buffer),
      values: [part(4, 5), part(5, 6), part(6, 7)] };
  });
  const angle = (data.inclination * Math.PI) / 180, cos = Math.cos(angle), sin = Math.sin(angle);
  // The x axis of a run points down the slope; here gravity points down.
  const turned = (x, y) => [x * cos + y * sin, -x * sin + y * cos];
  const [lo, hi] = [about.low, about.high];
  const [w, h] = [(hi[0] - lo[0]) / 65535, (hi[1] - lo[1]) / 65535];
  // What is in view: walls, and all points but the few that fly far.
  const corners = data.outlines.filter((o) => o.kind === "wall").flatMap((o) => o.corners).map(([x, y]) => turned(x, y));
  const bounds = [0, 1].map((side) => {
    const all = new Float32Array(frames.reduce((sum, f) => sum + f.n, 0));
    let at = 0;
    for (const f of frames) for (let k = 0; k < f.n; k++) all[at++] = turned(lo[0] + f.x[k] * w, lo[1] + f.y[k] * h)[side];
    all.sort();
    const walls = corners.map((p) => p[side]), cut = Math.floor(all.length / 2000);
    return [Math.min(all[cut], ...walls), Math.max(all[all.length - 1 - cut], ...walls)];
  });
  const [[left, right], [low, high]] = bounds;
  const [BAR, PAD] = [46, 14];
  const context = stage.getContext("2d");
  const [scrub, clock, play, quantity, pace] = ["scrub", "clock", "play", "quantity", "pace"].map((id) => document.getElementById(id));
  scrub.max = frames.length - 1;
  stage.dataset.frames = frames.length;
  const solids = frames.some((f) => f.solids > 0);
  const state = { frame: 0, playing: false, last: 0, time: frames[0].t };

  function bar(x, y, colours, name, most, unit) {
    for (let k = 0; k < 160; k++) {
      context.fillStyle = colours[Math.round((k / 159) * 255)];
      context.fillRect(x + k, y, 1, 9);
    }
    context.fillStyle = css("--ink");
    context.font = "12px sans-serif";
    context.textBaseline = "alphabetic";
    context.textAlign = "left";
    context.fillText(name, x, y - 5);
    context.textBaseline = "top";
    context.fillText("0", x, y + 12);
    context.textAlign = "right";
    context.fillText("≥ " + read(most) + (unit ? " " + unit : ""), x + 160, y + 12);
  }

  function render() {
    const f = frames[state.frame], q = Number(quantity.value);
    const wide = width(stage.parentElement);
    const scale = Math.min((wide - 2 * PAD) / (right - left || 1), (520 - BAR - 2 * PAD) / (high - low || 1));
    const tall = Math.ceil((high - low) * scale) + BAR + 2 * PAD;
    const ratio = window.devicePixelRatio || 1;
    if (stage.width !== Math.round(wide * ratio) || stage.height !== Math.round(tall * ratio)) {
      stage.width = Math.round(wide * ratio);
      stage.height = Math.round(tall * ratio);
      stage.style.width = wide + "px";
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = css("--stage");
    context.fillRect(0, 0, wide, tall);
    const middle = (wide - (right - left) * scale) / 2;
    const sx = (X) => middle + (X - left) * scale, sy = (Y) => BAR + PAD + (high - Y) * scale;
    context.save();
    context.beginPath();
    context.rect(0, BAR, wide, tall - BAR);
    context.clip();
    context.fillStyle = css("--wall");
    for (const o of data.outlines) {
      context.beginPath();
      o.corners.forEach(([x, y], k) => {
        const [X, Y] = turned(x, y);
        if (k) context.lineTo(sx(X), sy(Y)); else context.moveTo(sx(X), sy(Y));
      });
      context.closePath();
      context.fill();
      context.strokeStyle = css("--ink");
      context.lineWidth = 1;
      context.stroke();
    }
    const dot = Math.max(1.5, about.size * scale), half = dot / 2;
    const values = f.values[q], grains = f.n - f.solids;
    for (let k = 0; k < f.n; k++) {
      const x = lo[0] + f.x[k] * w, y = lo[1] + f.y[k] * h;
      context.fillStyle = (k < grains ? FLOW : SOLID)[values[k]];
      context.fillRect(sx(x * cos + y * sin) - half, sy(-x * sin + y * cos) - half, dot, dot);
    }
    context.restore();
    const names = ["speed", "pressure", "plastic shear strain"];
    const unit = q === 1 ? pressureUnit(about.flow[1]) : [q === 0 ? "m/s" : "", 1];
    bar(PAD, 18, FLOW, names[q], about.flow[q] / unit[1], unit[0]);
    if (solids) {
      const of = q === 0 ? ["m/s", 1] : pressureUnit(about.body[q]);
      bar(PAD + 200, 18, SOLID, q === 0 ? "speed of the barrier" : "stress in the barrier (von Mises)", about.body[q] / of[1], of[0]);
    }
    clock.textContent = "t = " + f.t.toFixed(3) + " s";
    scrub.value = state.frame;
    scrub.setAttribute("aria-valuetext", clock.textContent);
    stage.dataset.time = f.t;
  }

  /** All charts read at the time of the frame. */
  function point() {
    for (const chart of charts) if (chart.timed) {
      const at = chart.valToPos(frames[state.frame].t, "x");
      if (isFinite(at)) chart.setCursor({ left: at, top: chart.bbox.height / devicePixelRatio / 2 }, false);
    }
  }

  function show(frame, pointing) {
    state.frame = Math.max(0, Math.min(frames.length - 1, frame));
    render();
    if (pointing) point();
  }

  function tick(now) {
    if (!state.playing) return;
    state.time += ((now - state.last) / 1000) * Number(pace.value);
    state.last = now;
    let next = state.frame;
    while (next + 1 < frames.length && frames[next + 1].t <= state.time) next++;
    if (next !== state.frame) show(next, true);
    if (next === frames.length - 1) return run(false);
    requestAnimationFrame(tick);
  }

  function run(on) {
    state.playing = on;
    play.textContent = on ? "Pause" : "Play";
    play.setAttribute("aria-pressed", String(on));
    if (!on) return;
    if (state.frame === frames.length - 1) show(0, true);
    state.time = frames[state.frame].t;
    state.last = performance.now();
    requestAnimationFrame(tick);
  }

  play.onclick = () => run(!state.playing);
  scrub.oninput = () => { run(false); show(Number(scrub.value), true); };
  quantity.onchange = render;
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || /^(INPUT|SELECT|BUTTON|SUMMARY|TEXTAREA)$/.test(event.target.tagName)) return;
    const step = { ArrowLeft: state.frame - 1, ArrowRight: state.frame + 1, Home: 0, End: frames.length - 1 }[event.key];
    if (event.key === " ") run(!state.playing);
    else if (step !== undefined) { run(false); show(step, true); }
    else return;
    event.preventDefault();
  });
  const said = [`From ${about.source}: ${frames.length} frames.`];
  if (about.thinned) said.push(`Shown: ${about.thinned}.`);
  said.push("Gravity points down. The last colour is also that of the largest 0.2 % of the values, and a point in 2000 may be out of view.");
  document.getElementById("flow-note").textContent = said.join(" ");
  // What stands still, as in print, is where the force was largest.
  let first = 0;
  frames.forEach((f, k) => { if (Math.abs(f.t - data.start) < Math.abs(frames[first].t - data.start)) first = k; });
  show(first, false);
  flow = { render };
}
startFlow();

// ---------------------------------------------------------------- light, dark, paper

function redraw() {
  charts.forEach((chart) => {
    chart.redraw(true, true);
    // The legend keeps the colours of its beginning.
    chart.root.querySelectorAll(".u-legend .u-series").forEach((row, k) => {
      const marker = row.querySelector(".u-marker");
      if (marker && k > 0) marker.style.borderColor = colour(k - 1);
    });
  });
  if (flow) flow.render();
}
function fit(fixed) {
  charts.forEach((chart) => chart.setSize({ width: fixed || width(chart.root.parentElement), height: chart.height }));
  if (flow) flow.render();
}
document.getElementById("theme").onclick = () => {
  root.dataset.theme = isDark() ? "light" : "dark";
  redraw();
};
system.addEventListener("change", redraw);
let before = null;
addEventListener("beforeprint", () => {
  before = [root.dataset.theme, [...document.querySelectorAll("details:not([open])")]];
  root.dataset.theme = "light";
  before[1].forEach((details) => { details.open = true; });
  fit(660);
  redraw();
});
addEventListener("afterprint", () => {
  if (!before) return;
  if (before[0]) root.dataset.theme = before[0]; else delete root.dataset.theme;
  before[1].forEach((details) => { details.open = false; });
  before = null;
  fit();
  redraw();
});
let waiting = 0;
addEventListener("resize", () => { clearTimeout(waiting); waiting = setTimeout(() => fit(), 80); });
root.dataset.ready = "true";
