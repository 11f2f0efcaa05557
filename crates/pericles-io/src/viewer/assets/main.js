// State and controls of the page.
"use strict";

const find = (id) => document.getElementById(id);
const solid = header.dimension === 3;
const isBar = header.dimension === 1;
const fieldNamed = (name) => header.fields.find((field) => field.name === name);

const viewer = {
  frame: 0, field: null, component: 0, map: "", range: "all", limits: [0, 1], scale: header.scale, broken: 1,
  clip: { axis: null, place: 0.5, flip: false }, set: null, point: null, playing: false, ready: false,
  series: new Series(), charts: [], numbers: null,

  /** Loads the body and shows the first output time. */
  async start() {
    this.shape = await Shape.load();
    this.sets = await Promise.all(header.sets.map((set) => blocks.u32(set.points)));
    for (const impactor of header.impactors) impactor.corners = impactor.triangles === null ? null : await blocks.u32(impactor.triangles);
    this.tips = await crackTips();
    find("profile").hidden = !isBar;
    if (isBar) {
      this.profile = new ProfileChart(find("profile"));
      find("scene").hidden = find("overlay").hidden = true;
    } else {
      this.scene = new Scene(find("scene"));
      this.camera = new Camera(find("overlay"), () => this.draw());
    }
    connect();
    this.chooseField(preferredField());
    this.fit();
    await this.show(0);
    for (const offer of defaultCharts()) await this.addChart(offer);
    this.ready = true;
  },

  /** Shows an output time; returns when it is drawn. */
  async show(frame) {
    const request = (this.request = (this.request || 0) + 1);
    const { field, component } = this;
    const read = async (name) => (fieldNamed(name) ? this.series.read(fieldNamed(name), frame) : null);
    const displacement = await read("Displacement");
    const damage = ((await read("Damage")) || [null])[0];
    const numbers = await this.series.numbers(field, component, frame);
    const rigid = await Promise.all(header.impactors.map((one) => (one.frames[frame] === null ? null : blocks.f32(one.frames[frame]))));
    if (request !== this.request) return;
    Object.assign(this, { frame, displacement, damage, numbers, rigid });
    this.move();
    this.colour();
    this.draw();
    find("time").value = frame;
    find("stamp").textContent = stampOf(frame);
    for (const chart of this.charts) chart.show(frame);
    await this.tellPoint();
  },

  /** Computes the displaced shape. */
  move() {
    const { shape, damage, clip } = this;
    const hidden = new Uint8Array(shape.n);
    const limit = clip.axis === null ? 0 : shape.low[clip.axis] + clip.place * (shape.high[clip.axis] - shape.low[clip.axis]);
    for (let i = 0; i < shape.n; i++) {
      const cut = clip.axis !== null && (shape.x[clip.axis][i] > limit) !== clip.flip;
      hidden[i] = cut || (damage && this.broken < 1 && damage[i] > this.broken) ? 1 : 0;
    }
    this.hidden = hidden;
    this.drawn = shape.displaced(this.displacement, damage, this.scale, hidden);
    this.scene?.shape(this.drawn, shape.radii);
  },

  /** Computes range and colours. */
  colour() {
    const { field, component, frame } = this;
    const ranges = this.range === "one" ? field.frames[frame].ranges : field.ranges;
    if (this.range !== "fixed") this.limits = usualRange(field, ranges[component], this.range);
    const [low, high] = this.limits;
    const name = this.map || (low < 0 && high > 0 ? "diverging" : "viridis");
    this.table = colourTable(name);
    const fractions = Float32Array.from(this.numbers, (v) => (isFinite(v) ? Math.min(Math.max(high > low ? (v - low) / (high - low) : 0.5, 0), 1) : -1));
    const members = this.set === null ? null : new Set(this.sets[this.set]);
    const dimmed = Float32Array.from({ length: this.shape.n }, (_, i) => (members && !members.has(i) ? 1 : 0));
    this.members = members;
    this.scene?.colours(this.table);
    this.scene?.values(fractions, dimmed);
    const [factor, unit] = readable(Math.max(Math.abs(low), Math.abs(high)), field.unit);
    Object.assign(this, { factor, unit });
    if (this.range !== "fixed") {
      find("low").value = plain(low / factor);
      find("high").value = plain(high / factor);
    }
    find("unit").textContent = unit;
  },

  draw() {
    if (!this.drawn || !this.table) return;
    if (isBar) {
      const places = Array.from(this.shape.x[0], (x, i) => header.origin[0] + x + this.scale * (this.displacement ? this.displacement[0][i] : 0));
      const chosen = this.members && places.map((_, i) => this.members.has(i));
      this.profile.show(places, this.numbers, chosen, fieldLabel(), this.field.unit, this.limits);
      return;
    }
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => {
      this.waiting = 0;
      this.paint();
    });
  },

  paint() {
    const theme = { back: rgb("--back"), faint: rgb("--line") };
    const lines = [];
    const triangles = [];
    this.rigid.forEach((vertices, k) => {
      if (!vertices) return;
      const { corners, closed } = header.impactors[k];
      if (corners) corners.forEach((i) => triangles.push(vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]));
      else lines.push({ ends: polyline(vertices, closed), colour: rgb("--soft"), thick: 2 });
    });
    if (find("lines").checked) lines.push({ ends: this.drawn.lines, colour: solid ? [0.1, 0.1, 0.1] : [0.95, 0.2, 0.5], thick: 1.5 });
    if (find("rest").checked) lines.push({ ends: boxEdges(this.shape), colour: rgb("--soft"), thick: 1 });
    this.scene.draw(this.camera, theme, Float32Array.from(triangles), lines);
    paintOverlay(this);
  },

  /** Shows the whole body as it is drawn; fragments that are far away may be outside. */
  fit() {
    if (isBar) return;
    const { shape, drawn } = this;
    let { low, high } = shape;
    if (drawn) {
      const size = Math.max(...high.map((h, c) => h - low[c]));
      const rest = [low, high];
      const margin = shape.radii.reduce((a, b) => Math.max(a, b), 0);
      [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
      for (let i = 0; i < shape.n; i++) {
        if (this.hidden[i]) continue;
        for (let c = 0; c < 3; c++) {
          const x = drawn.places[3 * i + c];
          const room = c < header.dimension ? margin : 0;
          if (!(x > rest[0][c] - 4 * size && x < rest[1][c] + 4 * size)) continue;
          low[c] = Math.min(low[c], x - room);
          high[c] = Math.max(high[c], x + room);
        }
      }
      if (!low.every((l, c) => l <= high[c])) [low, high] = rest;
    }
    this.camera.fit(low, high, solid ? [0.75, -1, 0.6] : [0, 0, 1]);
  },

  chooseField(field) {
    this.field = field;
    const parts = field.components.map((name, c) => [c, name]);
    if (field.is_vector) parts.unshift([field.components.length, "magnitude"]);
    fill(find("component"), parts);
    find("component").hidden = parts.length < 2;
    this.component = parts.length ? parts[0][0] : 0;
    find("field").value = field.name;
    find("component").value = this.component;
    if (this.range === "fixed") find("range").value = this.range = "all";
  },

  /** Shows the values of the chosen point. */
  async tellPoint() {
    const point = this.point;
    find("hint").hidden = point !== null;
    if (point === null) return find("point").replaceChildren();
    const frame = this.frame;
    const rows = [["number", String(point)], ["position at rest", Array.from({ length: header.dimension }, (_, c) => quantity(header.origin[c] + this.shape.x[c][point], "m")).join(", ")]];
    const sets = header.sets.filter((_, k) => this.sets[k].includes(point)).map((set) => set.name);
    if (sets.length) rows.push(["sets", sets.join(", ")]);
    for (const field of header.fields) {
      const values = await this.series.read(field, frame);
      const names = field.components.length > 1 ? field.components : [""];
      names.forEach((name, c) => rows.push([`${fieldWords(field.name)}${name ? ", " + name : ""}`, quantity(values[c][point], field.unit)]));
    }
    if (frame !== this.frame || point !== this.point) return;
    find("point").replaceChildren(...rows.map((row) => {
      const line = document.createElement("tr");
      line.append(...row.map((text) => Object.assign(document.createElement("td"), { textContent: text })));
      return line;
    }));
  },

  /** Returns the point that is drawn at a place of the canvas; null if there is none. */
  pointAt(x, y) {
    const { shape, drawn, camera } = this;
    let best = null, nearest = Infinity, highest = -Infinity;
    for (let i = 0; i < shape.n; i++) {
      if (this.hidden[i]) continue;
      const [px, py, height] = camera.project(drawn.places[3 * i], drawn.places[3 * i + 1], drawn.places[3 * i + 2]);
      const away = Math.hypot(px - x, py - y);
      const reach = Math.max(1.1 * shape.radii[i] * camera.zoom, 6);
      if (away > 1.5 * reach) continue;
      // In space the foremost point, in the plane the nearest.
      const level = solid ? Math.round(height / shape.radii[i]) : 0;
      if (level > highest || (level === highest && away < nearest)) [best, nearest, highest] = [i, away, level];
    }
    return best;
  },

  async choosePoint(point) {
    this.point = point;
    this.draw();
    await this.tellPoint();
  },

  async addChart(offer) {
    const chart = await HistoryChart.create(find("charts"), offer, (t) => this.show(nearestFrame(t)), (gone) => (this.charts = this.charts.filter((one) => one !== gone)));
    this.charts.push(chart);
    chart.show(this.frame);
  },

  /** Plays the output times until it is stopped. */
  async play() {
    this.playing = !this.playing;
    find("play").textContent = this.playing ? "❚❚" : "▶";
    let next = performance.now();
    while (this.playing) {
      await this.show((this.frame + 1) % header.times.length);
      next = Math.max(next + 1000 / find("speed").value, performance.now());
      await new Promise((resolve) => setTimeout(resolve, next - performance.now()));
    }
  },

  step(by) {
    return this.show(Math.min(Math.max(this.frame + by, 0), header.times.length - 1));
  },

  redraw() {
    if (!this.numbers) return;
    this.move();
    this.colour();
    this.draw();
  },
};

/** Returns the range of colours: 0 to 1 for damage over time, symmetric for numbers of both signs. Curves need no symmetry. */
function usualRange(field, [low, high], range) {
  if (field.name === "Damage" && range === "all") return [0, 1];
  if (!(low <= high)) return [0, 1];
  if (low < 0 && high > 0 && !isBar) {
    const most = Math.max(-low, high);
    return [-most, most];
  }
  return [low, high];
}

const colourTables = {};
function colourTable(name) {
  if (colourTables[name]) return colourTables[name];
  const { colours } = header.maps.find((map) => map.name === name);
  const table = new Uint8Array(3 * 256);
  for (let k = 0; k < 256; k++) {
    const place = (k / 255) * (colours.length - 1);
    const below = Math.min(Math.floor(place), colours.length - 2);
    for (let c = 0; c < 3; c++) table[3 * k + c] = Math.round(colours[below][c] + (place - below) * (colours[below + 1][c] - colours[below][c]));
  }
  return (colourTables[name] = table);
}

function rgb(name) {
  const hex = themed(name).slice(1);
  const long = hex.length === 3 ? hex.replace(/./g, "$&$&") : hex;
  return [0, 2, 4].map((k) => parseInt(long.slice(k, k + 2), 16) / 255);
}

function preferredField() {
  const damage = fieldNamed("Damage");
  if (damage && damage.ranges[0][1] > 0) return damage;
  return fieldNamed("Displacement") || header.fields[0];
}

function fieldLabel() {
  const { field, component } = viewer;
  const part = component < field.components.length ? field.components[component] : field.components.length ? "magnitude" : "";
  return fieldWords(field.name) + (part && field.components.length > 1 ? ", " + part : "");
}

function stampOf(frame) {
  const time = header.times[frame];
  const step = header.steps.filter((one) => one.start <= time * (1 + 1e-12)).at(-1);
  return stamp(time) + (step ? ` (step ${step.name})` : "");
}

function nearestFrame(time) {
  return header.times.reduce((best, t, k) => (Math.abs(t - time) < Math.abs(header.times[best] - time) ? k : best), 0);
}

function defaultCharts() {
  const offered = offeredCharts();
  const energies = offered.find((one) => one.table.name === "history" && one.columns[0].unit === "J");
  const others = ["quantities", "force_displacement", "cracks", "reactions", "probes", "impactors"];
  const other = others.map((name) => offered.find((one) => one.table.name === name)).find((one) => one);
  return [energies || offered[0], other].filter((one, k, all) => one && all.indexOf(one) === k);
}

/** Returns the crack tips over time: reference positions. */
async function crackTips() {
  const tips = [];
  const tables = header.tables.filter((table) => table.name === "cracks");
  for (const table of tables) {
    const axes = ["x", "y", "z"].map((axis) => table.columns.find((column) => column.name.endsWith("tip_" + axis)));
    const places = await Promise.all(axes.map((column) => (column ? blocks.f64(column.block) : null)));
    if (places.some((one) => one)) tips.push({ time: await blocks.f64(table.time), places });
  }
  return tips;
}

/** Returns the tips of the cracks at the present time, moved with the nearest points. */
function presentTips() {
  const time = header.times[viewer.frame];
  const { shape, drawn } = viewer;
  const found = [];
  for (const tip of viewer.tips) {
    let row = -1;
    tip.time.forEach((t, k) => { if (t <= time * (1 + 1e-9)) row = k; });
    if (row < 0) continue;
    const place = [0, 1, 2].map((c) => (tip.places[c] ? tip.places[c][row] - header.origin[c] : 0));
    if (!place.every(isFinite)) continue;
    let nearest = 0, least = Infinity;
    for (let i = 0; i < shape.n; i++) {
      const square = [0, 1, 2].reduce((sum, c) => sum + (shape.x[c][i] - place[c]) ** 2, 0);
      if (square < least) [nearest, least] = [i, square];
    }
    if (!viewer.hidden[nearest]) found.push(place.map((x, c) => x + drawn.places[3 * nearest + c] - shape.x[c][nearest]));
  }
  return found;
}

function polyline(vertices, closed) {
  const ends = [];
  const n = vertices.length / 3;
  for (let k = 0; k < (closed ? n : n - 1); k++) {
    const next = (k + 1) % n;
    ends.push(...vertices.subarray(3 * k, 3 * k + 3), ...vertices.subarray(3 * next, 3 * next + 3));
  }
  return Float32Array.from(ends);
}

/** Returns the edges of the box around the body at rest. */
function boxEdges({ low, high }) {
  const corner = (k) => [0, 1, 2].map((c) => ((k >> c) & 1 ? high[c] : low[c]));
  const ends = [];
  for (let a = 0; a < 8; a++) for (let c = 0; c < 3; c++) if (!((a >> c) & 1)) ends.push(...corner(a), ...corner(a | (1 << c)));
  return Float32Array.from(ends);
}

/** Draws colour bar, scale bar, axes and markers. */
function paintOverlay({ camera, table, limits, factor, unit, drawn, point }) {
  const canvas = find("overlay");
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = camera.size;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const pen = canvas.getContext("2d");
  pen.scale(ratio, ratio);
  const text = themed("--text");
  pen.font = "13px system-ui, sans-serif";
  pen.fillStyle = pen.strokeStyle = text;
  pen.textBaseline = "middle";
  // Colour bar.
  const bar = { x: width - 100, y: 60, width: 16, height: Math.min(height - 150, 360) };
  for (let k = 0; k < bar.height; k++) {
    const entry = 3 * Math.round(255 * (1 - k / Math.max(bar.height - 1, 1)));
    pen.fillStyle = `rgb(${table[entry]},${table[entry + 1]},${table[entry + 2]})`;
    pen.fillRect(bar.x, bar.y + k, bar.width, 1.5);
  }
  pen.fillStyle = text;
  const [low, high] = limits;
  for (const value of high > low ? ticks(low / factor, high / factor, 6) : [low / factor]) {
    const y = bar.y + bar.height * (high > low ? 1 - (value * factor - low) / (high - low) : 0.5);
    pen.fillRect(bar.x + bar.width, y - 0.5, 5, 1);
    pen.fillText(significant(value, 5), bar.x + bar.width + 9, y);
  }
  // Texts may be over the body.
  const write = (words, x, y) => {
    pen.strokeStyle = themed("--back");
    pen.lineWidth = 4;
    pen.lineJoin = "round";
    pen.strokeText(words, x, y);
    pen.fillText(words, x, y);
  };
  pen.textAlign = "right";
  write(fieldLabel() + (unit ? ` (${unit})` : ""), width - 12, 30);
  pen.textAlign = "left";
  write(stampOf(viewer.frame), 16, 30);
  if (viewer.scale !== 1 && viewer.displacement) write(`displacements × ${significant(viewer.scale, 3)}`, 16, 50);
  // Scale bar: a round length.
  const target = 130 / camera.zoom;
  const power = 10 ** Math.floor(Math.log10(target));
  const length = power * [5, 2, 1].find((f) => f * power <= target);
  const right = width - 30, under = height - 28;
  pen.fillRect(right - length * camera.zoom, under, length * camera.zoom, 2);
  pen.textAlign = "center";
  write(quantity(length, "m"), right - 0.5 * length * camera.zoom, under - 12);
  // Axes.
  const arm = 30;
  ["x", "y", "z"].slice(0, header.dimension).forEach((name, c) => {
    const [dx, dy] = [arm * camera.axes[0][c], -arm * camera.axes[1][c]];
    pen.strokeStyle = ["#d55e00", "#009e73", "#0072b2"][c];
    pen.lineWidth = 2;
    pen.beginPath();
    pen.moveTo(45, height - 45);
    pen.lineTo(45 + dx, height - 45 + dy);
    pen.stroke();
    if (Math.hypot(dx, dy) > 6) write(name, 45 + 1.35 * dx, height - 45 + 1.35 * dy);
  });
  // Crack tips and the chosen point.
  const circle = (place, radius, colour) => {
    const [x, y] = camera.project(...place);
    pen.strokeStyle = colour;
    pen.lineWidth = 2;
    pen.beginPath();
    pen.arc(x, y, radius, 0, 2 * Math.PI);
    pen.stroke();
  };
  if (find("lines").checked) for (const tip of presentTips()) circle(tip, 6, "#f2338f");
  if (point !== null) circle(drawn.places.subarray(3 * point, 3 * point + 3), 8, themed("--accent"));
}

/** Returns round numbers in a range, about as many as asked. */
function ticks(low, high, count) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((f) => f * power >= rough * 0.999);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(Number((k * step).toPrecision(12)));
  return found;
}

/** Formats a number for an input. */
const plain = (value) => String(Number(value.toPrecision(4)));

function fill(select, entries) {
  select.replaceChildren(...entries.map(([value, text]) => new Option(text, value)));
}

/** Deformation scales of the slider: 0, then 0.1 to 100 000 on a logarithmic scale. */
const scaleOf = (position) => (position <= 0 ? 0 : Number((10 ** (-1 + (6 * position) / 1000)).toPrecision(2)));
const positionOf = (scale) => (scale > 0 ? Math.max((1000 * (Math.log10(scale) + 1)) / 6, 1) : 0);

function connect() {
  find("title").textContent = header.title;
  find("source").textContent = [header.deck.split(/[\\/]/).pop(), `${header.points.toLocaleString("en").replaceAll(",", " ")} points`, `Pericles ${header.version}`].filter((text) => text).join(" · ");
  fill(find("field"), header.fields.map((field) => [field.name, fieldWords(field.name)]));
  fill(find("set"), [["", "none"], ...header.sets.map((set, k) => [k, set.name])]);
  find("set-row").hidden = !header.sets.length;
  find("damage-row").hidden = !fieldNamed("Damage") || !(fieldNamed("Damage").ranges[0][1] > 0) || isBar;
  find("clip-row").hidden = !solid;
  find("lines-row").hidden = !viewer.shape.lines.lengths.length && !viewer.tips.length;
  find("rest-row").hidden = isBar;
  find("save").hidden = find("reset").hidden = isBar;
  find("scale").value = plain(viewer.scale);
  find("scale-slider").value = positionOf(viewer.scale);
  find("scale").disabled = find("scale-slider").disabled = !fieldNamed("Displacement");
  find("time").max = header.times.length - 1;
  find("player").hidden = header.times.length < 2;
  for (const note of header.notes) find("notes").append(Object.assign(document.createElement("p"), { textContent: note }));
  find("notes").append(Object.assign(document.createElement("p"), { textContent: "Values are rounded to 16 bits: errors are at most 8·10⁻⁶ of the range of a field at an output time." }));
  const offered = offeredCharts();
  find("chart-box").hidden = !offered.length;
  fill(find("add-chart"), [["", "Add a chart …"], ...offered.map((one, k) => [k, one.label])]);

  const on = (id, type, act) => find(id).addEventListener(type, act);
  on("time", "input", (event) => viewer.show(Number(event.target.value)));
  on("play", "click", () => viewer.play());
  on("back", "click", () => viewer.step(-1));
  on("next", "click", () => viewer.step(1));
  on("field", "change", (event) => {
    viewer.chooseField(fieldNamed(event.target.value));
    viewer.show(viewer.frame);
  });
  on("component", "change", (event) => {
    viewer.component = Number(event.target.value);
    viewer.show(viewer.frame);
  });
  on("map", "change", (event) => {
    viewer.map = event.target.value;
    viewer.redraw();
  });
  on("range", "change", (event) => {
    viewer.range = event.target.value;
    viewer.redraw();
  });
  for (const id of ["low", "high"]) {
    on(id, "change", () => {
      const limits = ["low", "high"].map((end) => Number(find(end).value) * viewer.factor);
      if (limits.every(isFinite) && limits[0] < limits[1]) {
        viewer.limits = limits;
        find("range").value = viewer.range = "fixed";
      }
      viewer.redraw();
    });
  }
  const rescale = (scale) => {
    viewer.scale = scale;
    find("scale").value = plain(scale);
    find("scale-slider").value = positionOf(scale);
    viewer.redraw();
  };
  on("scale-slider", "input", (event) => rescale(scaleOf(Number(event.target.value))));
  on("scale", "change", (event) => {
    const scale = Number(event.target.value);
    rescale(isFinite(scale) && scale >= 0 ? scale : viewer.scale);
  });
  on("damage", "input", (event) => {
    viewer.broken = Number(event.target.value);
    find("damage-value").textContent = viewer.broken < 1 ? viewer.broken.toFixed(2) : "off";
    viewer.redraw();
  });
  on("clip", "change", (event) => {
    viewer.clip.axis = event.target.value === "" ? null : Number(event.target.value);
    viewer.redraw();
  });
  on("clip-place", "input", (event) => {
    viewer.clip.place = event.target.value / 1000;
    viewer.redraw();
  });
  on("clip-flip", "change", (event) => {
    viewer.clip.flip = event.target.checked;
    viewer.redraw();
  });
  on("set", "change", (event) => {
    viewer.set = event.target.value === "" ? null : Number(event.target.value);
    viewer.redraw();
  });
  on("lines", "change", () => viewer.draw());
  on("rest", "change", () => viewer.draw());
  on("reset", "click", () => viewer.fit());
  on("save", "click", savePicture);
  on("add-chart", "change", (event) => {
    if (event.target.value !== "") viewer.addChart(offered[Number(event.target.value)]);
    event.target.value = "";
  });
  on("overlay", "click", (event) => {
    if (viewer.camera.travelled < 4) viewer.choosePoint(viewer.pointAt(event.offsetX, event.offsetY));
  });
  on("profile", "click", (event) => {
    if (event.target.className === "u-over") viewer.choosePoint(viewer.profile.pointAt(event));
  });
  document.addEventListener("keydown", (event) => {
    if (["INPUT", "SELECT"].includes(event.target.tagName) && event.target.id !== "time") return;
    const last = header.times.length - 1;
    const acts = { " ": () => viewer.play(), ArrowLeft: () => viewer.step(-1), ArrowRight: () => viewer.step(1), Home: () => viewer.show(0), End: () => viewer.show(last), r: () => viewer.fit() };
    const act = acts[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    viewer.draw();
    viewer.charts.forEach((chart) => chart.plot.redraw());
    viewer.profile?.plot?.redraw();
  });
  new ResizeObserver(() => {
    viewer.draw();
    viewer.profile?.resize();
    viewer.charts.forEach((chart) => chart.resize(find("charts").clientWidth));
  }).observe(find("stage"));
}

/** Saves the view as a PNG file. */
function savePicture() {
  viewer.paint();
  const picture = document.createElement("canvas");
  picture.width = find("scene").width;
  picture.height = find("scene").height;
  const pen = picture.getContext("2d");
  pen.drawImage(find("scene"), 0, 0);
  pen.drawImage(find("overlay"), 0, 0);
  picture.toBlob((blob) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = `${viewer.field.name}-${String(viewer.frame).padStart(6, "0")}.png`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
}

viewer.start().catch((error) => {
  find("message").hidden = false;
  find("message").textContent = typeof DecompressionStream === "undefined" ? "This browser is too old: Chrome 80, Firefox 113 or Safari 16.4, or a later version is needed." : error.message;
  console.error(error);
});
