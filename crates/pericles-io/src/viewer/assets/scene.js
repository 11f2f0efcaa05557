// Drawing with WebGL 2: faces coloured by a field, points as discs or balls, lines of any width.
"use strict";

const FACES = [`#version 300 es
uniform mat4 view; uniform vec3 back;
in vec3 position; in float fraction; in float dimmed;
out vec3 place; out float value; out float pale;
void main() { gl_Position = view * vec4(position, 1.0); place = position; value = fraction; pale = dimmed; }`, `#version 300 es
precision highp float;
uniform sampler2D colours; uniform vec4 plain; uniform vec3 back; uniform vec3 faint; uniform float lit; uniform float size;
in vec3 place; in float value; in float pale;
out vec4 colour;
void main() {
  vec3 own = value < -0.5 ? vec3(0.667) : texture(colours, vec2(clamp(value, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb;
  own = mix(own, plain.rgb, plain.a);
  own = mix(own, faint, 0.8 * step(0.5, pale));
  vec3 scaled = place / size;
  vec3 normal = normalize(cross(dFdx(scaled), dFdy(scaled)));
  colour = vec4(own * mix(1.0, 0.62 + 0.38 * abs(dot(normal, back)), lit), 1.0);
}`];

const POINTS = [`#version 300 es
uniform mat4 view; uniform float pixels; uniform float depth;
in vec3 position; in float radius; in float fraction; in float dimmed;
out float value; out float pale; out float reach;
void main() { gl_Position = view * vec4(position, 1.0); gl_PointSize = max(2.0 * radius * pixels, 1.5); value = fraction; pale = dimmed; reach = 0.5 * radius / depth; }`, `#version 300 es
precision highp float;
uniform sampler2D colours; uniform vec3 faint; uniform float lit;
in float value; in float pale; in float reach;
out vec4 colour;
void main() {
  vec2 off = 2.0 * gl_PointCoord - 1.0;
  float square = dot(off, off);
  if (square > 1.0) discard;
  float height = sqrt(1.0 - square);
  vec3 own = value < -0.5 ? vec3(0.667) : texture(colours, vec2(clamp(value, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb;
  own = mix(own, faint, 0.8 * step(0.5, pale));
  colour = vec4(own * mix(1.0, 0.62 + 0.38 * height, lit), 1.0);
  gl_FragDepth = gl_FragCoord.z - lit * reach * height;
}`];

const LINES = [`#version 300 es
uniform mat4 view; uniform vec2 screen; uniform float width; uniform float nearer;
in vec3 from; in vec3 to; in vec2 corner;
void main() {
  vec4 a = view * vec4(from, 1.0), b = view * vec4(to, 1.0);
  vec2 along = (b.xy - a.xy) * screen;
  vec2 across = length(along) > 0.0 ? normalize(vec2(-along.y, along.x)) : vec2(0.0);
  gl_Position = mix(a, b, corner.x);
  gl_Position.xy += across * corner.y * width / screen;
  gl_Position.z -= nearer;
}`, `#version 300 es
precision highp float;
uniform vec3 plain; out vec4 colour;
void main() { colour = vec4(plain, 1.0); }`];

class Program {
  constructor(gl, [vertex, fragment]) {
    this.gl = gl;
    const program = (this.program = gl.createProgram());
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    this.array = gl.createVertexArray();
    this.buffers = {};
  }

  /** Uploads numbers per vertex, or per instance. */
  attribute(name, values, size, stride = 0, offset = 0, divisor = 0) {
    const { gl } = this;
    const location = gl.getAttribLocation(this.program, name);
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, (this.buffers[name] ||= gl.createBuffer()));
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(location);
    gl.vertexAttribPointer(location, size, gl.FLOAT, false, stride, offset);
    gl.vertexAttribDivisor(location, divisor);
  }

  use(uniforms) {
    const { gl } = this;
    gl.useProgram(this.program);
    gl.bindVertexArray(this.array);
    for (const [name, value] of Object.entries(uniforms)) {
      const location = gl.getUniformLocation(this.program, name);
      if (location === null) continue;
      if (value.length === 16) gl.uniformMatrix4fv(location, false, value);
      else if (value.length) gl["uniform" + value.length + "fv"](location, value);
      else gl.uniform1f(location, value);
    }
  }
}

class Scene {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = (this.gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true }));
    if (!gl) throw new Error("This browser does not offer WebGL 2, which the view of the body needs.");
    this.faces = new Program(gl, FACES);
    this.rigid = new Program(gl, FACES);
    this.points = new Program(gl, POINTS);
    this.lines = new Program(gl, LINES);
    this.texture = gl.createTexture();
    this.counts = { faces: 0, points: 0 };
    this.reach = 1;
  }

  /** Sets the colours: 256 values of red, green, blue. */
  colours(table) {
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, table);
    for (const [key, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR], [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]]) gl.texParameteri(gl.TEXTURE_2D, key, value);
  }

  /** Sets the shape of the body. */
  shape(drawn, radii) {
    this.drawn = drawn;
    this.faces.attribute("position", drawn.faces.positions, 3);
    const places = new Float32Array(3 * drawn.single.length);
    const own = new Float32Array(drawn.single.length);
    drawn.single.forEach((i, k) => {
      places.set(drawn.places.subarray(3 * i, 3 * i + 3), 3 * k);
      own[k] = radii[i];
    });
    this.points.attribute("position", places, 3);
    this.points.attribute("radius", own, 1);
    this.counts = { faces: drawn.faces.points.length, points: drawn.single.length };
    let reach = 0;
    for (const v of drawn.places) if (isFinite(v)) reach = Math.max(reach, Math.abs(v));
    this.reach = reach;
  }

  /** Sets the colours of the points: fractions of the range, -1 for none, and flags of points drawn pale. */
  values(fractions, dimmed) {
    const of = (points, values) => Float32Array.from(points, (i) => values[i]);
    this.faces.attribute("fraction", of(this.drawn.faces.points, fractions), 1);
    this.faces.attribute("dimmed", of(this.drawn.faces.points, dimmed), 1);
    this.points.attribute("fraction", of(this.drawn.single, fractions), 1);
    this.points.attribute("dimmed", of(this.drawn.single, dimmed), 1);
  }

  /** Draws the body, rigid bodies (triangles) and lines: pairs of end points with colour and width in pixels. */
  draw(camera, theme, rigid, lines) {
    const { gl, canvas } = this;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = camera.size;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...theme.back, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const solid = header.dimension === 3;
    const depth = 2 * (Math.hypot(...camera.centre) + 2 * this.reach + 1e-30);
    const view = camera.matrix(depth);
    const common = { view, back: camera.axes[2], faint: theme.faint, lit: solid ? 1 : 0, size: this.reach || 1 };
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    if (this.counts.faces) {
      this.faces.use({ ...common, plain: [0, 0, 0, 0] });
      gl.drawArrays(gl.TRIANGLES, 0, this.counts.faces);
    }
    if (this.counts.points) {
      this.points.use({ ...common, pixels: camera.zoom * ratio, depth });
      gl.drawArrays(gl.POINTS, 0, this.counts.points);
    }
    if (rigid.length) {
      this.rigid.attribute("position", rigid, 3);
      this.rigid.attribute("fraction", new Float32Array(rigid.length / 3), 1);
      this.rigid.attribute("dimmed", new Float32Array(rigid.length / 3), 1);
      this.rigid.use({ ...common, plain: [0.55, 0.57, 0.6, 1] });
      gl.drawArrays(gl.TRIANGLES, 0, rigid.length / 3);
    }
    if (!solid) gl.disable(gl.DEPTH_TEST);
    this.lines.attribute("corner", new Float32Array([0, -1, 0, 1, 1, -1, 1, 1]), 2);
    for (const { ends, colour, thick } of lines.filter((one) => one.ends.length)) {
      this.lines.attribute("from", ends, 3, 24, 0, 1);
      this.lines.attribute("to", ends, 3, 24, 12, 1);
      this.lines.use({ view, screen: [canvas.width, canvas.height], width: thick * ratio, nearer: solid ? 2e-4 : 0, plain: colour });
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, ends.length / 6);
    }
  }
}
