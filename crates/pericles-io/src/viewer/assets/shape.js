// Displaced cells, triangles, points and lines, as in the pictures of Pericles: a node of a cell moves with the mean of the
// cells that hold together there, each extrapolated from its point by its displacement gradient.
"use strict";

const OUTSIDE = 0xffffffff;
/** Least mean damage of two points whose cells can separate, and drawn distances for which they do not. */
const DAMAGED = 0.2, CLOSEST = 0.5, FARTHEST = 1.1;
/** Drawn length of a part of a line, relative to that at rest, beyond which it is torn. */
const TORN = 3;

/** Corners of the facets of VTK's cell types. */
const FACETS = {
  5: [[0, 1], [1, 2], [2, 0]],
  9: [[0, 1], [1, 2], [2, 3], [3, 0]],
  10: [[0, 1, 3], [1, 2, 3], [0, 3, 2], [0, 2, 1]],
  14: [[0, 1, 4], [1, 2, 4], [2, 3, 4], [0, 4, 3], [0, 3, 2, 1]],
  13: [[0, 1, 4, 3], [1, 2, 5, 4], [0, 3, 5, 2], [0, 2, 1], [3, 4, 5]],
  12: [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [0, 4, 7, 3], [0, 3, 2, 1], [4, 5, 6, 7]],
};
/** Corners of plane cells in turn. */
const AROUND = { 5: [0, 1, 2], 9: [0, 1, 2, 3] };
const CORNERS = { 5: 3, 9: 4, 10: 4, 14: 5, 13: 6, 12: 8 };

class Shape {
  static async load() {
    const shape = new Shape();
    const n = (shape.n = header.points);
    const flat = await blocks.f32(header.positions);
    shape.x = [0, 1, 2].map((c) => flat.subarray(c * n, (c + 1) * n));
    shape.radii = await blocks.f32(header.radii);
    shape.triangles = header.triangles === null ? null : await blocks.u32(header.triangles);
    shape.cells = header.cells && (await Cells.load(shape));
    const { places, points, lengths } = header.lines;
    shape.lines = { places: await blocks.f32(places), points: await blocks.u32(points), lengths: await blocks.u32(lengths) };
    const covered = new Uint8Array(n);
    if (shape.triangles) shape.triangles.forEach((i) => (covered[i] = 1));
    if (shape.cells) shape.cells.points.forEach((i) => (covered[i] = 1));
    shape.single = Uint32Array.from({ length: n }, (_, i) => i).filter((i) => !covered[i]);
    shape.low = shape.x.map((x) => x.reduce((a, b) => Math.min(a, b), Infinity));
    shape.high = shape.x.map((x) => x.reduce((a, b) => Math.max(a, b), -Infinity));
    const margin = shape.radii.reduce((a, b) => Math.max(a, b), 0);
    for (let c = 0; c < header.dimension && !shape.triangles; c++) {
      shape.low[c] -= margin;
      shape.high[c] += margin;
    }
    return shape;
  }

  /** Returns what is drawn of a state: `u` has the components of the displacement, `hidden` a flag for each point. */
  displaced(u, damage, scale, hidden) {
    const { n, x } = this;
    const zero = (this.zero ||= new Float64Array(n));
    this.u = [0, 1, 2].map((c) => (u && u[c]) || zero);
    this.scale = scale;
    const places = new Float32Array(3 * n);
    for (let i = 0; i < n; i++) {
      for (let c = 0; c < 3; c++) places[3 * i + c] = x[c][i] + scale * this.u[c][i];
    }
    let faces = { positions: new Float32Array(0), points: new Uint32Array(0) };
    if (this.triangles) {
      const corners = [];
      const t = this.triangles;
      for (let k = 0; k < t.length; k += 3) {
        if (!hidden[t[k]] && !hidden[t[k + 1]] && !hidden[t[k + 2]]) corners.push(t[k], t[k + 1], t[k + 2]);
      }
      faces.points = Uint32Array.from(corners);
      faces.positions = new Float32Array(3 * corners.length);
      corners.forEach((i, k) => faces.positions.set(places.subarray(3 * i, 3 * i + 3), 3 * k));
    } else if (this.cells) {
      faces = this.cells.faces(damage, hidden);
    }
    const single = this.single.filter((i) => !hidden[i]);
    return { places, faces, single, lines: this.movedLines(hidden) };
  }

  /** Returns the displaced position of a place that moves with a point. */
  place(place, point) {
    const moved = [0, 1, 2].map((c) => this.u[c][point]);
    const cell = this.cells ? this.cells.ofPoint[point] : OUTSIDE;
    if (cell !== OUTSIDE) {
      const gradient = this.cells.gradient;
      for (let r = 0; r < 3; r++) {
        for (let c = 0; c < 3; c++) moved[r] += gradient[9 * cell + 3 * r + c] * (place[c] - this.x[c][point]);
      }
    }
    return moved.map((m, c) => place[c] + this.scale * m);
  }

  /** Returns the parts of the lines: pairs of end points. */
  movedLines(hidden) {
    const { places, points, lengths } = this.lines;
    const ends = [];
    let first = 0;
    for (const length of lengths) {
      let last = null;
      for (let k = first; k < first + length; k++) {
        const rest = places.subarray(3 * k, 3 * k + 3);
        const [a, b] = [points[2 * k], points[2 * k + 1]];
        const [p, q] = [this.place(rest, a), this.place(rest, b)];
        const together = distance(p, q) <= header.spacing && !hidden[a] && !hidden[b];
        const here = { rest, place: p.map((v, c) => 0.5 * (v + q[c])), together };
        const whole = last && last.together && together;
        if (whole && distance(last.place, here.place) <= TORN * distance(last.rest, rest)) ends.push(...last.place, ...here.place);
        last = here;
      }
      first += length;
    }
    return Float32Array.from(ends);
  }
}

function distance(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

class Cells {
  static async load(shape) {
    const cells = new Cells();
    const data = header.cells;
    cells.shape = shape;
    cells.nodes = await blocks.f32(data.nodes);
    cells.types = await blocks.u32(data.types);
    cells.corners = await blocks.u32(data.corners);
    cells.points = await blocks.u32(data.points);
    cells.across = await blocks.u32(data.across);
    cells.cut = await blocks.u32(data.cut);
    const count = (cells.count = cells.types.length);
    cells.nodeCount = cells.nodes.length / 3;
    cells.start = new Uint32Array(count + 1);
    cells.first = new Uint32Array(count + 1);
    cells.ofPoint = new Uint32Array(shape.n).fill(OUTSIDE);
    cells.meeting = new Uint32Array(cells.nodeCount);
    for (let k = 0; k < count; k++) {
      cells.start[k + 1] = cells.start[k] + CORNERS[cells.types[k]];
      cells.first[k + 1] = cells.first[k] + FACETS[cells.types[k]].length;
      cells.ofPoint[cells.points[k]] = k;
    }
    for (const node of cells.corners) cells.meeting[node] += 1;
    cells.gradient = new Float64Array(9 * count);
    return cells;
  }

  /** Returns the vertices of triangles with the points whose colours they have: all plane cells, the visible facets of solids. */
  faces(damage, hidden) {
    const open = this.openSides(damage);
    const visible = this.visible(open, hidden);
    const needed = this.needed(visible);
    this.fitGradients(open, needed);
    this.moveNodes(open, needed);
    let count = 0;
    for (const [cell, facet] of visible) count += this.cornersOf(cell, facet).length - 2;
    const positions = new Float32Array(9 * count), points = new Uint32Array(3 * count);
    let vertex = 0;
    for (const [cell, facet] of visible) {
      const start = this.start[cell];
      const places = this.cornersOf(cell, facet).map((corner) => this.nodePlace(cell, this.corners[start + corner], open));
      for (let k = 2; k < places.length; k++) {
        for (const place of [places[0], places[k - 1], places[k]]) {
          positions.set(place, 3 * vertex);
          points[vertex++] = this.points[cell];
        }
      }
    }
    return { positions, points };
  }

  /** Returns the corners of a facet of a solid cell, or of a plane cell. */
  cornersOf(cell, facet) {
    return header.dimension === 3 ? FACETS[this.types[cell]][facet] : AROUND[this.types[cell]];
  }

  /** Returns the cells and facets that can be seen: plane cells, and facets of solids without a cell beyond them. */
  visible(open, hidden) {
    const visible = [];
    for (let cell = 0; cell < this.count; cell++) {
      if (hidden[this.points[cell]]) continue;
      if (header.dimension < 3) {
        visible.push([cell, 0]);
        continue;
      }
      for (let side = this.first[cell]; side < this.first[cell + 1]; side++) {
        if (open[side] || hidden[this.points[this.across[side]]]) visible.push([cell, side - this.first[cell]]);
      }
    }
    return visible;
  }

  /** Returns flags of the cells that determine the positions of visible nodes and of lines. */
  needed(visible) {
    const nodes = new Uint8Array(this.nodeCount);
    for (const [cell, facet] of visible) {
      for (const corner of this.cornersOf(cell, facet)) nodes[this.corners[this.start[cell] + corner]] = 1;
    }
    const needed = new Uint8Array(this.count);
    for (let cell = 0; cell < this.count; cell++) {
      for (let k = this.start[cell]; k < this.start[cell + 1] && !needed[cell]; k++) needed[cell] = nodes[this.corners[k]];
    }
    for (const point of this.shape.lines.points) if (this.ofPoint[point] !== OUTSIDE) needed[this.ofPoint[point]] = 1;
    return needed;
  }

  /** Returns for each side whether the cells there are drawn apart. */
  openSides(damage) {
    const { x, u, scale } = this.shape;
    const open = new Uint8Array(this.across.length);
    for (let cell = 0; cell < this.count; cell++) {
      const i = this.points[cell];
      for (let side = this.first[cell]; side < this.first[cell + 1]; side++) {
        const across = this.across[side];
        if (across === OUTSIDE || this.cut[side]) {
          open[side] = 1;
          continue;
        }
        if (!damage) continue;
        const j = this.points[across];
        if (0.5 * (damage[i] + damage[j]) < DAMAGED) continue;
        let rest = 0, drawn = 0;
        for (let c = 0; c < 3; c++) {
          const arm = x[c][j] - x[c][i];
          const length = arm + scale * (u[c][j] - u[c][i]);
          rest += arm * arm;
          drawn += length * length;
        }
        const ratio = Math.sqrt(drawn / rest);
        open[side] = ratio >= CLOSEST && ratio <= FARTHEST ? 0 : 1;
      }
    }
    return open;
  }

  /** Fits the displacement gradient of each cell to the neighbours that are not drawn apart, by least squares. */
  fitGradients(open, needed) {
    const { x, u } = this.shape;
    const a = new Float64Array(9), b = new Float64Array(9), arm = [0, 0, 0], moved = [0, 0, 0];
    for (let cell = 0; cell < this.count; cell++) {
      if (!needed[cell]) continue;
      a.fill(0);
      b.fill(0);
      const i = this.points[cell];
      for (let side = this.first[cell]; side < this.first[cell + 1]; side++) {
        if (open[side]) continue;
        const j = this.points[this.across[side]];
        let square = 0;
        for (let c = 0; c < 3; c++) {
          arm[c] = x[c][j] - x[c][i];
          moved[c] = u[c][j] - u[c][i];
          square += arm[c] * arm[c];
        }
        for (let r = 0; r < 3; r++) {
          for (let c = 0; c < 3; c++) {
            a[3 * r + c] += (arm[r] * arm[c]) / square;
            b[3 * r + c] += (moved[r] * arm[c]) / square;
          }
        }
      }
      const trace = a[0] + a[4] + a[8];
      const g = this.gradient.subarray(9 * cell, 9 * cell + 9);
      g.fill(0);
      if (!(trace > 0)) continue;
      // Zero in directions without neighbours.
      for (let k = 0; k < 3; k++) a[4 * k] += 1e-6 * trace;
      const minor = (r, c) => {
        const [r1, r2, c1, c2] = [(r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3];
        return a[3 * r1 + c1] * a[3 * r2 + c2] - a[3 * r1 + c2] * a[3 * r2 + c1];
      };
      const determinant = a[0] * minor(0, 0) + a[1] * minor(0, 1) + a[2] * minor(0, 2);
      for (let c = 0; c < 3; c++) {
        const m = [minor(c, 0), minor(c, 1), minor(c, 2)];
        for (let r = 0; r < 3; r++) g[3 * r + c] = (b[3 * r] * m[0] + b[3 * r + 1] * m[1] + b[3 * r + 2] * m[2]) / determinant;
      }
    }
  }

  /** Adds the displaced position of a node, as its cell moves it, to a sum. */
  addPlace(cell, node, sum, at) {
    const { x, u, scale } = this.shape;
    const count = this.nodeCount;
    const i = this.points[cell];
    for (let r = 0; r < 3; r++) {
      let moved = u[r][i];
      for (let c = 0; c < 3; c++) moved += this.gradient[9 * cell + 3 * r + c] * (this.nodes[c * count + node] - x[c][i]);
      sum[at + r] += this.nodes[r * count + node] + scale * moved;
    }
  }

  /** Computes the positions of the nodes of some cells, for nodes whose cells hold together. */
  moveNodes(open, needed) {
    this.torn = new Uint8Array(this.nodeCount);
    this.moved = new Float64Array(3 * this.nodeCount);
    for (let cell = 0; cell < this.count; cell++) {
      if (!needed[cell]) continue;
      const start = this.start[cell];
      const facets = FACETS[this.types[cell]];
      for (let f = 0; f < facets.length; f++) {
        const side = this.first[cell] + f;
        if (!open[side] || this.across[side] === OUTSIDE) continue;
        for (const corner of facets[f]) this.torn[this.corners[start + corner]] = 1;
      }
      for (let k = start; k < this.start[cell + 1]; k++) this.addPlace(cell, this.corners[k], this.moved, 3 * this.corners[k]);
    }
    for (let node = 0; node < this.nodeCount; node++) {
      for (let c = 0; c < 3; c++) this.moved[3 * node + c] /= this.meeting[node];
    }
  }

  /** Returns the displaced position of a node of a cell: the mean of the cells that hold together there. */
  nodePlace(cell, node, open) {
    if (!this.torn[node]) return this.moved.subarray(3 * node, 3 * node + 3);
    const group = [cell];
    const sum = [0, 0, 0];
    for (let next = 0; next < group.length; next++) {
      const member = group[next];
      for (let side = this.first[member]; side < this.first[member + 1]; side++) {
        const other = this.across[side];
        if (open[side] || group.includes(other)) continue;
        if (this.corners.subarray(this.start[other], this.start[other + 1]).includes(node)) group.push(other);
      }
      this.addPlace(member, node, sum, 0);
    }
    return sum.map((v) => v / group.length);
  }
}
