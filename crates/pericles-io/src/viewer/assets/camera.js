// A parallel projection that the pointer moves: rotation (bodies in space), shift and zoom.
"use strict";

class Camera {
  constructor(canvas, changed) {
    this.canvas = canvas;
    this.changed = changed;
    this.centre = [0, 0, 0];
    /** Pixels per metre. */
    this.zoom = 1;
    /** Rows: right, up, towards the viewer. */
    this.axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    this.pointers = new Map();
    canvas.addEventListener("pointerdown", (event) => this.begin(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoomAt(event.offsetX, event.offsetY, Math.exp(-0.0015 * event.deltaY));
    }, { passive: false });
  }

  get size() {
    return [this.canvas.clientWidth || 1, this.canvas.clientHeight || 1];
  }

  /** Shows a box from a direction: the front right and above by default for bodies in space. */
  fit(low, high, toViewer) {
    if (toViewer) {
      const back = unit(toViewer);
      const up = Math.abs(back[2]) > 0.999 ? [0, 1, 0] : [0, 0, 1];
      const right = unit(cross(up, back));
      this.axes = [right, cross(back, right), back];
    }
    this.centre = low.map((l, c) => 0.5 * (l + high[c]));
    const half = high.map((h, c) => 0.5 * (h - low[c]));
    const extent = this.axes.map((axis) => axis.reduce((sum, a, c) => sum + Math.abs(a) * half[c], 0));
    const [width, height] = this.size;
    // Space for the colour bar on the right and the scale bar below.
    const room = [Math.max(width - 190, 0.5 * width), Math.max(height - 110, 0.5 * height)];
    this.zoom = Math.min(room[0] / Math.max(2 * extent[0], 1e-300), room[1] / Math.max(2 * extent[1], 1e-300));
    const shift = [40 / this.zoom, -10 / this.zoom];
    for (let c = 0; c < 3; c++) this.centre[c] += shift[0] * this.axes[0][c] + shift[1] * this.axes[1][c];
    this.changed();
  }

  /** Returns place in pixels and height above the centre in metres. */
  project(x, y, z) {
    const d = [x - this.centre[0], y - this.centre[1], z - this.centre[2]];
    const [a, b, c] = this.axes.map((axis) => axis[0] * d[0] + axis[1] * d[1] + axis[2] * d[2]);
    const [width, height] = this.size;
    return [0.5 * width + this.zoom * a, 0.5 * height - this.zoom * b, c];
  }

  /** Returns the matrix of the projection, by columns; `depth` is the largest distance from the centre. */
  matrix(depth) {
    const [width, height] = this.size;
    const factors = [(2 * this.zoom) / width, (2 * this.zoom) / height, -1 / depth];
    const rows = this.axes.map((axis, r) => {
      const row = axis.map((a) => factors[r] * a);
      return [...row, -row.reduce((sum, a, c) => sum + a * this.centre[c], 0)];
    });
    return Float32Array.from([0, 1, 2, 3].flatMap((c) => [rows[0][c], rows[1][c], rows[2][c], c === 3 ? 1 : 0]));
  }

  zoomAt(x, y, factor) {
    const [width, height] = this.size;
    const away = [(x - 0.5 * width) / this.zoom, -(y - 0.5 * height) / this.zoom];
    this.zoom *= factor;
    for (let c = 0; c < 3; c++) this.centre[c] += (1 - 1 / factor) * (away[0] * this.axes[0][c] + away[1] * this.axes[1][c]);
    this.changed();
  }

  begin(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    this.travelled = 0;
  }

  move(event) {
    const last = this.pointers.get(event.pointerId);
    if (!last) return;
    const here = [event.offsetX, event.offsetY];
    const [dx, dy] = [here[0] - last[0], here[1] - last[1]];
    this.travelled += Math.abs(dx) + Math.abs(dy);
    const other = [...this.pointers].find(([id]) => id !== event.pointerId);
    this.pointers.set(event.pointerId, here);
    if (other) {
      const apart = (p) => Math.hypot(p[0] - other[1][0], p[1] - other[1][1]);
      this.zoomAt(0.5 * (here[0] + other[1][0]), 0.5 * (here[1] + other[1][1]), apart(here) / Math.max(apart(last), 1));
    } else if (header.dimension < 3 || event.shiftKey || event.buttons & 6) {
      for (let c = 0; c < 3; c++) this.centre[c] -= (dx * this.axes[0][c] - dy * this.axes[1][c]) / this.zoom;
    } else {
      // About the vertical and the horizontal of the screen.
      const [right, up, back] = this.axes;
      const [a, b] = [0.008 * dx, 0.008 * dy];
      const facing = combine(back, Math.cos(a), right, -Math.sin(a));
      this.axes[0] = unit(combine(right, Math.cos(a), back, Math.sin(a)));
      this.axes[2] = unit(combine(facing, Math.cos(b), up, Math.sin(b)));
      this.axes[1] = cross(this.axes[2], this.axes[0]);
    }
    this.changed();
  }
}

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const combine = (a, s, b, t) => a.map((v, c) => s * v + t * b[c]);
const unit = (a) => a.map((v) => v / Math.hypot(...a));
