// The header, blocks of numbers, and fields over time.
"use strict";

const header = JSON.parse(document.getElementById("header").textContent);

/** Returns the decompressed bytes of a block, of words of a size. */
async function bytesOf(number, size) {
  const text = document.getElementById("b" + number).textContent;
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const grouped = new Uint8Array(await new Response(stream).arrayBuffer());
  const words = grouped.length / size;
  const bytes = new Uint8Array(grouped.length);
  for (let byte = 0; byte < size; byte++) {
    for (let word = 0; word < words; word++) bytes[word * size + byte] = grouped[byte * words + word];
  }
  return bytes.buffer;
}

/** Adds up differences; typed arrays wrap around as those of the writer did. */
function summed(values) {
  for (let k = 1; k < values.length; k++) values[k] += values[k - 1];
  return values;
}

const blocks = {
  u16: async (number) => summed(new Uint16Array(await bytesOf(number, 2))),
  u32: async (number) => summed(new Uint32Array(await bytesOf(number, 4))),
  f32: async (number) => new Float32Array(await bytesOf(number, 4)),
  f64: async (number) => new Float64Array(await bytesOf(number, 8)),
};

/** Fields at output times, decoded when they are first shown. */
class Series {
  constructor() {
    this.decoded = new Map();
    this.bytes = 0;
  }

  /** Returns the components of a field at an output time. */
  async read(field, frame) {
    const entry = field.frames[frame];
    const key = field.name + " " + frame;
    const known = this.decoded.get(key);
    if (known) {
      // The most recently used ones are last.
      this.decoded.delete(key);
      this.decoded.set(key, known);
      return known;
    }
    const codes = await blocks.u16(entry.block);
    const n = header.points;
    const values = entry.low.map((low, c) => {
      const step = entry.step[c];
      const component = new Float64Array(n);
      for (let i = 0; i < n; i++) {
        const code = codes[c * n + i];
        component[i] = code === 65535 ? NaN : low + step * code;
      }
      return component;
    });
    this.decoded.set(key, values);
    this.bytes += 8 * n * values.length;
    for (const [old, components] of this.decoded) {
      if (this.bytes < 4e8 || old === key) break;
      this.decoded.delete(old);
      this.bytes -= 8 * n * components.length;
    }
    return values;
  }

  /** Returns one number per point: a component, or the magnitude of a vector. */
  async numbers(field, component, frame) {
    const values = await this.read(field, frame);
    if (component < values.length) return values[component];
    return Float64Array.from(values[0], (_, i) => Math.hypot(...values.map((one) => one[i])));
  }
}

const words = (name) => name.replaceAll("_", " ");
const fieldWords = (name) => words(name).toLowerCase();

const PREFIXES = [[1e12, "T"], [1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];

/** Returns factor and unit in which numbers up to a size are well readable. Powers of units have no prefix. */
function readable(size, unit) {
  if (!unit || !(size > 0) || !isFinite(size) || /^(m[²³23]|kg|rad)/.test(unit)) return [1, unit];
  const found = PREFIXES.find(([factor]) => size >= 0.9995 * factor) || PREFIXES.at(-1);
  return [found[0], found[1] + unit];
}

/** Formats a number with some significant digits. */
function significant(value, digits = 4) {
  if (!isFinite(value)) return "no value";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e5) return String(Number(value.toPrecision(digits)));
  const [mantissa, power] = value.toExponential(digits - 1).split("e");
  const raised = String(Number(power)).replace(/./g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]);
  return `${Number(mantissa)}·10${raised}`;
}

/** Formats a number with its unit. */
function quantity(value, unit, digits = 4) {
  const [factor, shown] = readable(Math.abs(value), unit);
  return significant(value / factor, digits) + (shown && isFinite(value) ? " " + shown : "");
}

/** Formats an output time: `40 µs`, `load factor 0.5`. */
function stamp(time) {
  const axis = header.axis;
  return axis.unit ? "t = " + quantity(time / axis.scale, axis.unit) : `${axis.name} ${significant(time / axis.scale, 3)}`;
}
