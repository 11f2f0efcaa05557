// Time histories and, for bars, the field along the bar, drawn with uPlot.
"use strict";

/** Colours that colour-blind readers can distinguish (M. Okabe and K. Ito, 2008). */
const CURVES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#7f7f7f", "#b8a900"];
const MOST_CURVES = 8;

const themed = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

const AXIS = {
  stroke: () => themed("--soft"), grid: { stroke: () => themed("--line"), width: 1 }, ticks: { stroke: () => themed("--line"), width: 1 },
  font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif", labelSize: 18, size: 34,
  values: (_, values) => values.map((v) => (v === null ? "" : significant(v, 5))),
};

/** Returns the common last or first words of names, or the quantity that a unit measures. */
function commonWords(names, unit) {
  const all = names.map((name) => name.split("_"));
  const shared = (part) => {
    let count = 0;
    while (count < all[0].length && all.every((own) => part(own, count + 1) === part(all[0], count + 1))) count++;
    return part(all[0], count);
  };
  const ending = shared((own, count) => (count ? own.slice(-count) : []).join(" "));
  const beginning = shared((own, count) => own.slice(0, count).join(" "));
  return ending || beginning || { J: "energy", N: "force", m: "length", "m/s": "velocity" }[unit] || "value";
}

/** Returns the charts that the tables offer: columns of one unit together, and each column. */
function offeredCharts() {
  const offered = [];
  for (const table of header.tables) {
    const groups = new Map();
    const columns = table.columns.filter((column) => !column.constant);
    for (const column of columns) {
      // Dimensionless columns have no common scale.
      const key = column.unit || column.name;
      const group = groups.get(key) || [];
      if (!groups.has(key)) groups.set(key, group);
      group.push(column);
    }
    for (const group of groups.values()) {
      for (let k = 0; k < group.length; k += MOST_CURVES) {
        const some = group.slice(k, k + MOST_CURVES);
        const name = commonWords(some.map((one) => one.name), some[0].unit);
        offered.push({ table, columns: some, name, label: `${table.name}: ${name}${some.length > 1 ? ` (${some.length} curves)` : ""}` });
      }
    }
    for (const column of columns) {
      if (!offered.some((one) => one.columns.length === 1 && one.columns[0] === column)) {
        offered.push({ table, columns: [column], name: words(column.name), label: `${table.name}: ${words(column.name)}` });
      }
    }
  }
  return offered;
}

/** A chart of time histories with a line at the present time. */
class HistoryChart {
  static async create(parent, offer, toTime, removed) {
    const chart = new HistoryChart();
    chart.offer = offer;
    const { table, columns } = offer;
    const axis = header.axis;
    const time = await blocks.f64(table.time);
    const values = await Promise.all(columns.map((column) => blocks.f64(column.block)));
    const last = time.reduce((a, b) => Math.max(a, Math.abs(b)), Math.abs(header.times.at(-1)));
    const [factor, unit] = readable(last / axis.scale, axis.unit);
    chart.scale = axis.scale * factor;
    const size = values.reduce((most, one) => one.reduce((a, b) => (Math.abs(b) > a ? Math.abs(b) : a), most), 0);
    const [vertical, shown] = readable(size, columns[0].unit);
    const data = [Float64Array.from(time, (t) => t / chart.scale), ...values.map((one) => Array.from(one, (v) => (isFinite(v) ? v / vertical : null)))];
    chart.box = document.createElement("div");
    chart.box.className = "chart";
    const close = document.createElement("button");
    close.textContent = "✕";
    close.title = "Remove this chart";
    close.onclick = () => {
      chart.plot.destroy();
      chart.box.remove();
      removed(chart);
    };
    chart.box.append(close);
    parent.append(chart.box);
    chart.frame = 0;
    const label = (name, its) => (its ? `${name} (${its})` : name);
    chart.plot = new uPlot({
      width: parent.clientWidth || 360, height: 170,
      scales: { x: { time: false } }, cursor: { drag: { setScale: true, x: true, y: false }, points: { size: 5 } },
      axes: [{ ...AXIS, label: label(axis.name, unit) }, { ...AXIS, size: 52, label: label(offer.name, shown) }],
      series: [{ label: axis.name, value: (_, v) => (v === null ? "" : `${significant(v)} ${unit || ""}`) },
        ...columns.map((column, k) => ({ label: words(column.name), stroke: CURVES[k], width: 1.5, spanGaps: false, value: (_, v) => (v === null || v === undefined ? "" : `${significant(v)} ${shown}`) }))],
      hooks: { draw: [(plot) => chart.mark(plot)] },
    }, data, chart.box);
    chart.plot.over.addEventListener("click", (event) => toTime(chart.plot.posToVal(event.offsetX, "x") * chart.scale));
    chart.plot.over.addEventListener("pointerleave", () => chart.show(chart.frame));
    return chart;
  }

  /** Moves the line to an output time. */
  show(frame) {
    this.frame = frame;
    const at = header.times[frame] / this.scale;
    const [times] = this.plot.data;
    let nearest = 0;
    for (let k = 1; k < times.length; k++) if (Math.abs(times[k] - at) <= Math.abs(times[nearest] - at)) nearest = k;
    this.plot.redraw(false);
    this.plot.setLegend({ idx: nearest });
  }

  mark(plot) {
    const x = plot.valToPos(header.times[this.frame] / this.scale, "x", true);
    const { left, top, width, height } = plot.bbox;
    if (!(x >= left && x <= left + width)) return;
    plot.ctx.save();
    plot.ctx.strokeStyle = themed("--accent");
    plot.ctx.lineWidth = 2 * (window.devicePixelRatio || 1);
    plot.ctx.beginPath();
    plot.ctx.moveTo(x, top);
    plot.ctx.lineTo(x, top + height);
    plot.ctx.stroke();
    plot.ctx.restore();
  }

  resize(width) {
    this.plot.setSize({ width, height: 170 });
  }
}

/** The field along a bar. */
class ProfileChart {
  constructor(box) {
    this.box = box;
  }

  show(places, numbers, chosen, label, unit, [low, high]) {
    const order = Array.from(places.keys()).sort((a, b) => places[a] - places[b]);
    const [length, shown] = readable(Math.max(...places.map(Math.abs)), "m");
    const [factor, its] = readable(Math.max(Math.abs(low), Math.abs(high)), unit);
    const pick = (of) => order.map((i) => (isFinite(of(i)) ? of(i) : null));
    const data = [pick((i) => places[i] / length), pick((i) => numbers[i] / factor), pick((i) => (chosen && chosen[i] ? numbers[i] / factor : NaN))];
    const margin = 0.05 * (high - low || 1);
    this.limits = [(low - margin) / factor, (high + margin) / factor];
    const key = [label, its, shown].join(" ");
    if (key !== this.key) {
      this.plot?.destroy();
      this.key = key;
      this.plot = new uPlot({
        width: this.box.clientWidth, height: this.box.clientHeight - 30, scales: { x: { time: false }, y: { range: () => this.limits } },
        axes: [{ ...AXIS, label: `x (${shown})` }, { ...AXIS, size: 70, label: its ? `${label} (${its})` : label }],
        series: [{ label: "x", value: (_, v) => (v === null ? "" : `${significant(v)} ${shown}`) },
          { label, stroke: CURVES[0], width: 1.5, points: { show: places.length < 400, size: 5 }, value: (_, v) => (v === null ? "" : `${significant(v)} ${its}`) },
          { label: "highlighted", stroke: CURVES[1], width: 0, paths: () => null, points: { show: true, size: 7, fill: CURVES[1] } }],
        legend: { live: true },
      }, data, this.box);
    } else {
      this.plot.setData(data);
    }
    this.plot.setSeries(2, { show: Boolean(chosen) });
    this.order = order;
  }

  /** Returns the point nearest to the pointer. */
  pointAt(event) {
    return this.order[this.plot.posToIdx(event.offsetX)];
  }

  resize() {
    this.plot?.setSize({ width: this.box.clientWidth, height: this.box.clientHeight - 30 });
  }
}
