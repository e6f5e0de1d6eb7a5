"use strict";
// One time for all panels, for what moves and for the table; where there are several answers, one answer for all.
(() => {
  const section = document.getElementById("explore");
  const source = document.getElementById("explore-data");
  if (!section || !source || !window.Plotly) return;
  const { answers, begin, words, decimal } = JSON.parse(source.textContent);
  if (!answers.length) return;
  section.querySelector(".explorer").hidden = false;
  const slider = document.getElementById("explore-time");
  const chooser = document.getElementById("explore-answer");
  const play = document.getElementById("explore-play");
  const stated = document.getElementById("explore-stated");
  const reading = document.getElementById("explore-reading");
  const scenesHome = document.getElementById("explore-scenes");
  const panelsHome = document.getElementById("explore-panels");
  const panelsKey = document.getElementById("explore-key");
  const animation = () => document.querySelector("#motion .motion");
  animation()?.classList.add("driven");
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  let ink, faint, line, BLUE, VERMILION, GREEN, PURPLE, GLOBE, PAINTS;
  /** Read the colours of the page, which are others in the dark. */
  const readColours = () => {
    [ink, faint, line, BLUE, VERMILION, GREEN, PURPLE, GLOBE] =
      ["--ink", "--faint", "--line", "--blue", "--vermilion", "--green", "--purple", "--globe"].map(css);
    // colours that the data have are those of printed pictures
    PAINTS = { "#0072b2": BLUE, "#d55e00": VERMILION, "#009e73": GREEN, "#a6508a": PURPLE };
  };
  readColours();
  const plain = { displaylogo: false, responsive: true, modeBarButtonsToRemove: ["select2d", "lasso2d"] };
  const SECONDS = 12, ROW = 150, GAP = 0.045;
  const paint = (colour) => PAINTS[colour.toLowerCase()] ?? colour;
  let current = answers[begin], time = current.t[0], running = 0, updates = [];

  const RAISED = Object.fromEntries([..."-0123456789"].map((sign, k) => [sign, "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"[k]]));
  /** A number with six digits; what is nothing but rounding beside a size is zero. */
  const number = (value, size = 0) => {
    if (value === null || !Number.isFinite(value)) return "–";
    if (Math.abs(value) < 1e-9 * size) return "0";
    const [digits, power] = String(Number(value.toPrecision(6))).split("e");
    const raised = (power ?? "").replace(/./g, (sign) => RAISED[sign] ?? "");
    return digits.replace("-", "−").replace(".", decimal) + (power ? ` × 10${raised}` : "");
  };

  /** Place of a time among the nodes: the node before, and the share of the way to the next. */
  const place = (t) => {
    const nodes = current.t;
    let low = 0, high = nodes.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (nodes[middle] <= t) low = middle; else high = middle;
    }
    const span = nodes[high] - nodes[low];
    return [low, span > 0 ? Math.min(1, Math.max(0, (t - nodes[low]) / span)) : 1];
  };
  const at = (row, [k, share]) => {
    const a = row[k], b = row[Math.min(k + 1, row.length - 1)];
    return a === null || b === null ? null : a + share * (b - a);
  };

  const layout = (more) => ({
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { color: ink, size: 12 },
    separators: `${decimal} `, showlegend: false, hovermode: "closest", dragmode: "pan",
    modebar: { bgcolor: "rgba(0,0,0,0)", color: faint, activecolor: ink }, ...more,
  });
  const axis = (more) => ({ gridcolor: line, zerolinecolor: line, linecolor: line, exponentformat: "power", minexponent: 5, ...more });
  const curve = (rows, name, look, mode = "lines") => ({
    x: rows[0], y: rows[1], ...(rows.length > 2 ? { z: rows[2], type: "scatter3d" } : {}), mode, name,
    hoverinfo: "skip", ...look, ...(look.line && rows.length < 3 ? { line: { simplify: false, ...look.line } } : {}),
  });
  const SWATCH = {
    line: (colour, dash = "") => `<line x1="1" y1="6" x2="27" y2="6" stroke="${colour}" stroke-width="2.5" stroke-dasharray="${dash}"/>`,
    thin: (colour) => `<line x1="1" y1="6" x2="27" y2="6" stroke="${colour}"/>`,
    thick: (colour) => `<line x1="1" y1="6" x2="27" y2="6" stroke="${colour}" stroke-width="5"/>`,
    arrow: (colour) => `<line x1="1" y1="6" x2="20" y2="6" stroke="${colour}" stroke-width="3"/><path d="M18 1l9 5l-9 5z" fill="${colour}"/>`,
    ring: (colour) => `<circle cx="14" cy="6" r="5" fill="none" stroke="${colour}" stroke-width="1.4"/>`,
    disc: (colour) => `<circle cx="14" cy="6" r="5" fill="${colour}" stroke="${ink}"/>`,
    square: () => `<rect x="9.5" y="1.5" width="9" height="9" fill="white" stroke="${ink}"/>`,
    diamond: () => `<path d="M14 1l5 5l-5 5l-5 -5z" fill="white" stroke="${ink}"/>`,
    cross: (colour) => `<path d="M9 6h10M14 1v10" stroke="${colour}" stroke-width="2.5"/>`,
    strip: () => `<rect x="1" y="1" width="26" height="10" fill="rgba(138,138,138,.3)"/>`,
  };
  /** One line that says what each kind of line and mark is. */
  const key = (entries) => {
    const list = document.createElement("p");
    list.className = "key";
    const said = new Set();
    for (const [shape, text, ...look] of entries) {
      if (!text || said.has(text)) continue;
      said.add(text);
      const entry = document.createElement("span");
      entry.innerHTML = `<svg viewBox="0 0 28 12" aria-hidden="true">${SWATCH[shape](...look)}</svg>`;
      entry.append(text);
      list.append(entry);
    }
    return list;
  };
  const dot = (rows, name, colour, symbol, size) =>
    curve(rows, name, { marker: { color: colour, size, symbol, line: { color: ink, width: 1 } } }, "markers");

  /** Height of what moves: one picture alone has more room than two beside each other. */
  const sideOf = () => (current.scenes.length > 1 ? 380 : Math.min(520, Math.max(380, 0.6 * scenesHome.clientWidth)));

  /** The path in a plane or in space, and what moves on it. */
  const drawPath = (home, scene) => {
    const side = sideOf();
    const deep = scene.kind === "space";
    const zero = scene.path.map(() => [0]);
    const traces = [], said = [];
    for (const field of scene.forbidden) {
      said.push(["strip", words.inadmissible]);
      traces.push({
        type: "contour", x: field.x, y: field.y, z: field.z, showscale: false, hoverinfo: "skip",
        contours: { type: "constraint", operation: "<", value: 0 }, fillcolor: "rgba(138,138,138,.22)",
        line: { color: faint, width: 1 }, name: words.inadmissible,
      });
    }
    if (scene.radius && deep) traces.push(globe(scene));
    if (scene.central && !scene.radius) traces.push(dot(zero, scene.body || words.origin, ink, "cross", deep ? 4 : 9));
    for (const [name, look, ...sample] of [
      ["path", { line: { color: BLUE, width: deep ? 5 : 2.5 } }, "line", BLUE],
      ["burns", { line: { color: VERMILION, width: deep ? 8 : 5 }, connectgaps: false }, "thick", VERMILION],
      ["free", { line: { color: faint, width: 1 } }, "thin", faint],
      ["reference", { line: { color: ink, width: deep ? 2 : 1, dash: "dash" } }, "line", ink, "5 3"],
      ["other", { line: { color: ink, width: deep ? 2 : 1, dash: "dash" } }, "line", ink, "5 3"],
    ]) if (scene[name]) {
      const drawn = curve(scene[name], words[name], look);
      if (name === "path" || name === "burns") traces.push(drawn); else traces.unshift(drawn);
      said.push([sample[0], words[name], ...sample.slice(1)]);
    }
    if (scene.target) {
      traces.push(dot(scene.target, words.target, "rgba(0,0,0,0)", "circle", deep ? 6 : 12));
      said.push(["ring", words.target, ink]);
    }
    if (scene.passed) {
      traces.push(dot(scene.passed, words.passed, "white", "diamond", deep ? 5 : 9));
      said.push(["diamond", words.passed]);
    }
    if (scene.central) said.push(scene.radius ? ["disc", scene.body, GLOBE] : ["cross", scene.body || words.origin, ink]);
    const moving = [];
    const follow = (key, colour, symbol, size) => {
      if (!scene[key]) return;
      moving.push({ index: traces.length, rows: () => scene[key].map((row) => [at(row, now())]) });
      traces.push({ ...dot(scene[key].map((row) => [row[0]]), words[key], colour, symbol, size), hoverinfo: "name" });
    };
    follow("reference", "white", "circle", deep ? 5 : 9);
    follow("moving", "white", "square", deep ? 5 : 9);
    if (scene.moving) said.push(["square", words.moving]);
    follow("path", BLUE, "circle", deep ? 6 : 11);
    if (scene.thrust) {
      moving.push({
        index: traces.length,
        rows: () => scene.path.map((row, i) => {
          const from = at(row, now()), along = at(scene.thrust[i], now());
          return [from, from === null || along === null ? null : from + along];
        }),
      });
      const head = { mode: "lines+markers", marker: { color: VERMILION, size: [0, 11], symbol: "arrow", angleref: "previous", line: { width: 0 } } };
      const look = { line: { color: VERMILION, width: deep ? 7 : 3 }, ...(deep ? {} : head) };
      traces.push(curve(scene.path.map(() => [0, 0]), scene.thrust_called, look, look.mode));
      said.push([deep ? "thick" : "arrow", scene.thrust_called, VERMILION]);
    }
    const names = scene.labels, range = (i) => [scene.low[i], scene.high[i]];
    const disc = scene.radius && !deep ? [{
      type: "circle", x0: -scene.radius, x1: scene.radius, y0: -scene.radius, y1: scene.radius,
      fillcolor: GLOBE, line: { color: faint, width: 1 }, layer: "below",
    }] : [];
    const space = (i) => axis({ title: { text: names[i] }, range: range(i), showbackground: false });
    Plotly.newPlot(home, traces, layout(deep
      ? { height: side + 60, margin: { l: 0, r: 0, t: 6, b: 0 }, scene: { xaxis: space(0), yaxis: space(1), zaxis: space(2), aspectmode: "cube" } }
      : {
          height: side, margin: { l: 60, r: 10, t: 8, b: 44 }, shapes: disc,
          xaxis: axis({ title: { text: names[0] }, range: range(0), constrain: "domain" }),
          yaxis: axis({ title: { text: names[1] }, range: range(1), ...(scene.free_aspect ? {} : { scaleanchor: "x", constrain: "domain" }) }),
        }), plain);
    updates.push(() => {
      const rows = moving.map((one) => one.rows());
      const changed = { x: rows.map((r) => r[0]), y: rows.map((r) => r[1]) };
      if (deep) changed.z = rows.map((r) => r[2]);
      if (moving.length) Plotly.restyle(home, changed, moving.map((one) => one.index));
    });
    return said;
  };

  const globe = (scene) => {
    const n = 24, x = [], y = [], z = [];
    for (let i = 0; i <= n; i++) {
      const height = Math.PI * (i / n - 0.5), rows = [[], [], []];
      for (let j = 0; j <= 2 * n; j++) {
        const turn = (Math.PI * j) / n;
        rows[0].push(scene.radius * Math.cos(height) * Math.cos(turn));
        rows[1].push(scene.radius * Math.cos(height) * Math.sin(turn));
        rows[2].push(scene.radius * Math.sin(height));
      }
      x.push(rows[0]); y.push(rows[1]); z.push(rows[2]);
    }
    return { type: "surface", x, y, z, showscale: false, hoverinfo: "skip", opacity: 0.9, colorscale: [[0, GLOBE], [1, GLOBE]] };
  };

  /** A box with its axes, as it is turned, and the torque in its axes. */
  const drawAttitude = (home, scene) => {
    const half = [0.55, 0.4, 0.28], corners = [], colours = [VERMILION, GREEN, BLUE];
    for (let k = 0; k < 8; k++) corners.push([0, 1, 2].map((i) => ((k >> i) & 1 ? half[i] : -half[i])));
    const edges = [];
    for (let k = 0; k < 8; k++) for (let i = 0; i < 3; i++) if (!((k >> i) & 1)) edges.push(corners[k], corners[k | (1 << i)], null);
    const turned = (point) => {
      const turn = scene.turns.length ? now() : [0, 0];
      const a = scene.turns[turn[0]], b = scene.turns[Math.min(turn[0] + 1, scene.turns.length - 1)];
      return [0, 1, 2].map((i) => [0, 1, 2].reduce((sum, j) => sum + (a[3 * i + j] + turn[1] * (b[3 * i + j] - a[3 * i + j])) * point[j], 0));
    };
    const rows = (points) => {
      const done = points.map((point) => (point ? turned(point) : [null, null, null]));
      return [0, 1, 2].map((i) => done.map((point) => point[i]));
    };
    const unit = (i, size) => [0, 1, 2].map((j) => (i === j ? size : 0));
    const bodies = [() => rows(edges), ...[0, 1, 2].map((i) => () => rows([[0, 0, 0], unit(i, 1.15)]))];
    if (scene.torque) bodies.push(() => rows([[0, 0, 0], scene.torque.map((row) => 1.2 * (at(row, now()) ?? 0))]));
    const looks = [
      { line: { color: ink, width: 4 } },
      ...colours.map((colour) => ({ line: { color: colour, width: 6 } })),
      { line: { color: PURPLE, width: 9 } },
    ];
    const names = [words.body_called, "1", "2", "3", words.torque];
    const traces = bodies.map((body, k) => ({ ...curve(body(), names[k], looks[k]), hoverinfo: "name" }));
    [0, 1, 2].forEach((i) => traces.push(curve([0, 1, 2].map((j) => [0, i === j ? 1.4 : 0]), words.fixed, { line: { color: faint, width: 2, dash: "dot" } })));
    const space = { range: [-1.4, 1.4], showbackground: false, showticklabels: false, title: { text: "" }, showgrid: false, zeroline: false };
    Plotly.newPlot(home, traces, layout({
      height: sideOf() + 20, margin: { l: 0, r: 0, t: 6, b: 0 },
      scene: { xaxis: space, yaxis: space, zaxis: space, aspectmode: "cube", camera: { eye: { x: 1.05, y: 0.75, z: 0.6 } } },
    }), plain);
    updates.push(() => {
      const found = bodies.map((body) => body());
      Plotly.restyle(home, { x: found.map((r) => r[0]), y: found.map((r) => r[1]), z: found.map((r) => r[2]) }, found.map((_, k) => k));
    });
    const axes = colours.map((colour, i) => ["line", words.axis.replace("<number>", i + 1), colour]);
    return [...axes, ["line", words.fixed, faint, "2 2"], ...(scene.torque ? [["thick", words.torque, PURPLE]] : [])];
  };

  /** All quantities over one time; what is hovered sets the time of all. */
  const drawPanels = () => {
    const left = current.panels.filter((p) => p.group === "state");
    const right = current.panels.filter((p) => p.group !== "state");
    const narrow = panelsHome.clientWidth < 700 || !right.length;
    const columns = narrow ? [[...left, ...right]] : [left, right];
    const rows = Math.max(...columns.map((column) => column.length));
    const traces = [], cursors = [], shapes = [], annotations = [], axes = {}, said = [];
    const span = [current.t[0], current.t[current.t.length - 1]];
    let k = 0;
    columns.forEach((column, c) => column.forEach((panel, r) => {
      const id = k++ ? String(k) : "";
      const from = columns.length > 1 ? [[0, 0.44], [0.56, 1]][c] : [0, 1];
      const top = 1 - r / column.length, bottom = 1 - (r + 1) / column.length;
      const last = r === column.length - 1;
      axes[`xaxis${id}`] = axis({ domain: from, anchor: `y${id}`, range: span, ...(k > 1 ? { matches: "x" } : {}), showticklabels: last, hoverformat: ".6~g", title: last ? { text: current.time, standoff: 4 } : undefined });
      axes[`yaxis${id}`] = axis({ domain: [bottom + GAP / Math.max(1, column.length / 4), top - 0.012], anchor: `x${id}`, range: [panel.low, panel.high], title: { text: panel.label, font: { size: 12 }, standoff: 6 }, nticks: 6 });
      const on = { xaxis: `x${id}`, yaxis: `y${id}` };
      for (const [key, look] of [["free", { color: faint, width: 1 }], ["reference", { color: ink, width: 1, dash: "dash" }]])
        if (panel[key]) {
          traces.push({ ...on, x: current.t, y: panel[key], mode: "lines", line: { simplify: false, ...look }, hoverinfo: "skip" });
          said.push([key === "free" ? "thin" : "line", words[key], look.color, look.dash && "5 3"]);
        }
      if (panel.lower !== undefined || panel.upper !== undefined) said.push(["strip", words.inadmissible]);
      if (panel.marks.length) said.push(["line", panel.marked, ink, "2 3"]);
      if (panel.target !== undefined) said.push(["ring", words.target, ink]);
      for (const key of ["lower", "upper"])
        if (panel[key] !== undefined) shapes.push({ type: "rect", xref: `x${id}`, yref: `y${id}`, x0: span[0], x1: span[1], y0: panel[key], y1: key === "lower" ? panel.low : panel.high, fillcolor: "rgba(138,138,138,.2)", line: { width: 0 }, layer: "below" });
      for (const mark of panel.marks) shapes.push({ type: "line", xref: `x${id}`, yref: `y${id}`, x0: mark, x1: mark, y0: panel.low, y1: panel.high, line: { color: paint(panel.colour), width: 1, dash: "dot" } });
      if (panel.target !== undefined) traces.push({ ...on, x: [span[1]], y: [panel.target], mode: "markers", marker: { color: "rgba(0,0,0,0)", size: 11, line: { color: ink, width: 1.2 } }, hoverinfo: "skip", cliponaxis: false });
      traces.push({ ...on, x: current.t, y: panel.values, mode: "lines", line: { color: paint(panel.colour), width: 2, simplify: false }, name: panel.meaning, hovertemplate: `${panel.label.replace(/ \[(.*)\]$/, "")}: %{y:.6~g} ${/ \[(.*)\]$/.exec(panel.label)?.[1] ?? ""}<extra></extra>` });
      cursors.push({ index: traces.length, panel });
      traces.push({ ...on, x: [0, 0, 0], y: [panel.low, 0, panel.high], mode: "lines+markers", line: { color: faint, width: 1 }, marker: { size: [0, 8, 0], color: paint(panel.colour) }, hoverinfo: "skip" });
    }));
    Plotly.newPlot(panelsHome, traces, layout({ height: 70 + ROW * rows, margin: { l: 92, r: 12, t: 8, b: 44 }, hovermode: "x", shapes, annotations, ...axes }), plain);
    panelsKey.replaceChildren(key(said));
    panelsHome.removeAllListeners?.("plotly_hover");
    panelsHome.on("plotly_hover", (event) => { stop(); set(Number(event.points[0].x)); });
    updates.push(() => {
      const there = now();
      Plotly.restyle(panelsHome, { x: cursors.map(() => [time, time, time]), y: cursors.map(({ panel }) => [panel.low, at(panel.values, there), panel.high]) }, cursors.map((one) => one.index));
    });
  };

  const now = () => place(time);
  const tell = () => {
    const there = now();
    const unit = /\[(.*)\]/.exec(current.time)?.[1] ?? "";
    stated.textContent = `t = ${number(time)} ${unit}`.trim();
    slider.setAttribute("aria-valuetext", stated.textContent);
    reading.querySelectorAll("td[data-panel]").forEach((cell) => {
      const panel = current.panels[cell.dataset.panel];
      const value = number(at(panel.values, there), Math.max(Math.abs(panel.low), Math.abs(panel.high)));
      const unit = / \[(.*)\]$/.exec(panel.label)?.[1] ?? "";
      cell.textContent = `${value} ${unit}`.trim();
    });
  };
  /** Set the animation of the page's own solution to this time. */
  const drive = () => {
    const own = answers[begin].t, span = own[own.length - 1] - own[0];
    const share = span > 0 ? Math.min(0.9999, Math.max(0, (time - own[0]) / span)) : 0;
    animation()?.getAnimations({ subtree: true }).forEach((one) => {
      one.pause();
      one.currentTime = 10000 * share; // it lasts ten seconds
    });
  };
  const set = (t) => {
    time = Math.min(current.t[current.t.length - 1], Math.max(current.t[0], t));
    const span = current.t[current.t.length - 1] - current.t[0];
    slider.value = String(span > 0 ? (1000 * (time - current.t[0])) / span : 0);
    updates.forEach((update) => update());
    drive();
    tell();
  };
  const stop = () => { cancelAnimationFrame(running); running = 0; play.textContent = words.play; play.setAttribute("aria-pressed", "false"); };
  const run = () => {
    const span = current.t[current.t.length - 1] - current.t[0];
    let before = performance.now();
    const step = (moment) => {
      const next = time + (span * (moment - before)) / (1000 * SECONDS);
      before = moment;
      set(next > current.t[current.t.length - 1] ? current.t[0] : next);
      running = requestAnimationFrame(step);
    };
    play.textContent = words.pause;
    play.setAttribute("aria-pressed", "true");
    running = requestAnimationFrame(step);
  };

  const draw = () => {
    updates = [];
    scenesHome.querySelectorAll(".scene-plot").forEach((home) => Plotly.purge(home));
    scenesHome.replaceChildren();
    // all places are made before anything is drawn, for a picture is as wide as its place when it is drawn
    const homes = current.scenes.map((scene) => {
      const figure = document.createElement("figure"), home = document.createElement("div"), caption = document.createElement("figcaption");
      home.className = "scene-plot";
      caption.textContent = scene.title + (scene.magnified ? `, ${words.magnified.replace("<times>", scene.magnified)}` : "");
      figure.append(home, caption);
      scenesHome.append(figure);
      return home;
    });
    current.scenes.forEach((scene, k) => {
      const said = (scene.kind === "attitude" ? drawAttitude : drawPath)(homes[k], scene);
      homes[k].parentElement.append(key(said));
    });
    Plotly.purge(panelsHome);
    drawPanels();
    const body = document.createElement("tbody");
    current.panels.forEach((panel, k) => {
      const row = document.createElement("tr"), name = document.createElement("th"), cell = document.createElement("td"), about = document.createElement("td");
      name.scope = "row";
      name.innerHTML = panel.label.replace(/ \[(.*)\]$/, ""); // escaped where it was made, but for indices
      cell.dataset.panel = k;
      about.innerHTML = panel.meaning;
      row.append(name, cell, about);
      body.append(row);
    });
    reading.querySelector("tbody").replaceWith(body);
    document.getElementById("explore-cost").textContent = [current.label, current.cost && `J = ${current.cost}`].filter(Boolean).join(", ");
    set(time);
  };

  slider.addEventListener("input", () => {
    stop();
    const span = current.t[current.t.length - 1] - current.t[0];
    set(current.t[0] + (span * Number(slider.value)) / 1000);
  });
  play.addEventListener("click", () => (running ? stop() : run()));
  chooser?.addEventListener("input", () => {
    const share = Number(slider.value) / 1000;
    current = answers[Number(chooser.value)];
    chooser.setAttribute("aria-valuetext", current.label);
    time = current.t[0] + share * (current.t[current.t.length - 1] - current.t[0]);
    draw();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    readColours();
    draw();
  });
  if (chooser) chooser.value = String(begin);
  draw();
})();
