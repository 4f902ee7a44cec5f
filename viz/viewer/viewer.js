const $ = (id) => document.getElementById(id);
const data = JSON.parse($("data").textContent);

async function unpacked(p) {  // rows of numbers in one array that knows its columns; what is not known is NaN
  const text = atob(p.data), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const size = planes.length / 4, rows = p.columns ? size / p.columns : 0;
  const out = p.step ? new Float32Array(size) : new Int32Array(size);
  for (let k = 0; k < p.columns; k++) {
    let sum = 0;
    for (let i = 0; i < rows; i++) {
      const at = k * rows + i;
      const step = planes[at] | (planes[size + at] << 8) | (planes[2 * size + at] << 16) | (planes[3 * size + at] << 24);
      sum += (step >>> 1) ^ -(step & 1);  // an odd one is negative
      out[i * p.columns + k] = !p.step ? sum : sum < 0 ? NaN : sum * p.step[k] + p.low[k];
    }
  }
  return Object.assign(out, { columns: p.columns });
}

async function opened(x) {  // the same with all that is packed in it unpacked
  if (typeof x !== "object" || x === null) return x;
  if (typeof x.data === "string") return unpacked(x);
  if (Array.isArray(x)) return Promise.all(x.map(opened));
  return Object.fromEntries(await Promise.all(Object.entries(x).map(async ([k, v]) => [k, await opened(v)])));
}

const VERTEX = `#version 300 es
precision highp float; precision highp int;
in vec3 place; in vec3 normal; in vec2 ends; in float share;
uniform mat4 view; uniform sampler2D field, told; uniform int wide;
out vec3 at; out vec3 facing; out vec2 T; out float sure;
uniform int layer;
ivec2 cell(float i) { int k = int(i); return ivec2(k % wide, k / wide); }
vec2 value(float i) { return texelFetch(field, cell(i), 0).rg; }
float known(float i) { return texelFetch(told, cell(i), 0).r; }
void main() {  // looking values up is most of a vertex's work without a graphics card: nodes are looked up once
  at = place; facing = normal; T = value(ends.x); sure = 1.0;
  if (share > 0.0) T = mix(T, value(ends.y), share);
  if (layer == 3) sure = mix(known(ends.x), known(ends.y), share);
  gl_Position = view * vec4(place, 1.0);
}`;
const FRAGMENT = `#version 300 es
precision highp float; precision highp int;
in vec3 at; in vec3 facing; in vec2 T; in float sure;
uniform vec4 plane; uniform vec3 eye; uniform vec2 range; uniform float wipe, alpha, part, flat_; uniform int layer, mode;
uniform vec3 windows[6]; uniform float reach; uniform sampler2D palette; out vec4 colour;
void main() {
  if (flat_ < 0.5 && dot(at, plane.xyz) > plane.w) discard;
  if (mode != 1 && reach > 0.0) {  // in a window what is nearer than the sensor keeps one pixel of four; mode 2 draws what is behind
    bool nearer = false, behind = false;
    for (int i = 0; i < 6; i++) if (distance(gl_FragCoord.xy, windows[i].xy) < reach) {
      nearer = nearer || gl_FragCoord.z < windows[i].z; behind = behind || gl_FragCoord.z >= windows[i].z;
    }
    if (mode == 0 ? nearer && mod(floor(gl_FragCoord.x) + 2.0 * floor(gl_FragCoord.y), 4.0) > 0.5 : nearer || !behind) discard;
  }
  float value = layer == 1 ? T.x - T.y : (gl_FragCoord.x < wipe ? T.y : T.x);
  float s = (value - range.x) / (range.y - range.x);
  if (mode == 1) { float q = clamp(s, 0.0, 1.0) * 65535.0; colour = vec4((part + 1.0) / 255.0, floor(q / 256.0) / 255.0, mod(q, 256.0) / 255.0, layer == 3 && sure < 0.5 ? 0.0 : 1.0); return; }
  vec3 towards = normalize(eye - at), n = normalize(facing);
  float facing = dot(n, towards), above = facing < 0.0 ? -n.y : n.y;
  float light = flat_ > 0.5 ? 1.0 : 0.6 + 0.28 * abs(facing) + 0.12 * above;
  vec3 paint = texture(palette, vec2(clamp(s, 0.002, 0.998), 0.5)).rgb * light;
  if (layer == 3 && sure < 0.5 && mod(gl_FragCoord.x + gl_FragCoord.y, 14.0) < 4.0) paint = mix(paint, vec3(0.12, 0.16, 0.2), 0.6);
  colour = vec4(paint, alpha);
}`;
const LINES = `#version 300 es
precision highp float;
in vec3 place; uniform mat4 view;
void main() { gl_Position = view * vec4(place, 1.0); gl_Position.z -= 0.0005 * gl_Position.w; }`;
const LINE = `#version 300 es
precision highp float;
out vec4 colour;
void main() { colour = vec4(0.12, 0.16, 0.2, 0.55); }`;
const DOTS = `#version 300 es
precision highp float;
in vec3 place; in vec3 tint; uniform mat4 view; uniform vec4 plane; uniform vec3 wedge[2]; uniform float size, nearer; out vec3 ink;
void main() { ink = tint; gl_Position = view * vec4(place, 1.0); gl_Position.z -= nearer * gl_Position.w; gl_PointSize = nearer > 0.0 && (dot(place, plane.xyz) > plane.w + 0.006 || dot(place, wedge[0]) > 0.006 && dot(place, wedge[1]) > 0.006) ? 0.0 : size;
  if (gl_PointSize == 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0); }`;
const DOT = `#version 300 es
precision highp float;
in vec3 ink; uniform float hollow; out vec4 colour;
void main() {
  float r = length(gl_PointCoord - 0.5) * 2.0;
  if (r > 1.0) discard;
  colour = vec4(r > 0.74 || r < hollow ? vec3(1.0) : ink, 1.0);
}`;

class Viewer {
  constructor() {  // asks for GL and its programs: they are made beside this script, while it unpacks the data
    this.gl = $("gl").getContext("webgl2", { antialias: false, preserveDrawingBuffer: true });
    if (!this.gl) throw new Error("this browser has no WebGL 2, which this page draws with");
    this.programs();
  }
  open() {  // what is unpacked
    this.points = data.points; this.tets = data.tets;
    this.owner = Int32Array.from(data.parts.flatMap((p, k) => Array(p.nodes).fill(k)));
    this.parts = data.parts.map((p) => ({ ...p, chosen: 1, opacity: 1 }));
    this.chosen = ""; this.behindOf = new Set(); this.right = 0; this.left = 1; this.time = 1; this.playing = false; this.frames = 0; this.dirty = true; this.smooth = false; this.slow = true; this.pointers = new Map();
    this.bounds();
    this.meshes();
    this.textures();
    this.choose(0);
  }
  bounds() {
    this.low = [Infinity, Infinity, Infinity]; this.high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < this.points.length; i++) {
      const k = i % 3, v = this.points[i];
      if (v < this.low[k]) this.low[k] = v;
      if (v > this.high[k]) this.high[k] = v;
    }
    this.frame = data.looks ? data.looks.frame : [this.low, this.high];
    this.middle = this.frame[0].map((v, k) => (v + this.frame[1][k]) / 2);
    this.size = Math.hypot(...this.frame[0].map((v, k) => v - this.frame[1][k]));
  }
  first() {  // all of the machine, as large as leaves room for labels on both sides
    this.turn = TURN; this.tilt = TILT; this.zoom = 1;
    const corners = Array.from({ length: 8 }, (_, i) => [0, 1, 2].map((k) => this.frame[i >> k & 1][k]));
    for (let i = 0; i < 2; i++) {  // nearer means more perspective, so once more
      this.matrix();
      const at = corners.map((c) => [0, 1].map((k) => this.row(k, c) / this.row(3, c))), width = (k) => Math.max(...at.map((a) => a[k])) - Math.min(...at.map((a) => a[k]));
      this.zoom *= Math.min(2 * FILL[0] / width(0), 2 * FILL[1] / width(1));
    }
    this.dirty = true;
  }
  nearer(factor) { this.zoom = Math.max(0.3, Math.min(12, this.zoom * factor)); }
  row(k, xyz) { const m = this.rows[k]; return m[0] * xyz[0] + m[1] * xyz[1] + m[2] * xyz[2] + m[3]; }
  program(vertex, fragment, inputs) {
    const gl = this.gl, p = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const s = gl.createShader(kind);
      gl.shaderSource(s, text); gl.compileShader(s); gl.attachShader(p, s);
    }
    inputs.forEach((name, k) => gl.bindAttribLocation(p, k, name));
    gl.linkProgram(p);
    return new Proxy({ p }, { get: (o, name) => name === "p" ? p : (o[name] ??= gl.getUniformLocation(p, name)) });
  }
  programs() {
    this.skin = this.program(VERTEX, FRAGMENT, ["place", "normal", "ends", "share"]);
    this.lines = this.program(LINES, LINE, ["place"]);
    this.dots = this.program(DOTS, DOT, ["place", "tint"]);
  }
  linked() {
    const gl = this.gl;
    for (const { p } of [this.skin, this.lines, this.dots])
      if (!gl.getProgramParameter(p, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(p) || "its shaders do not link");
  }
  mesh(floats, sizes, index) {
    const gl = this.gl, vao = gl.createVertexArray(), buffer = gl.createBuffer();
    const stride = 4 * sizes.reduce((a, b) => a + b);
    gl.bindVertexArray(vao); gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    let offset = 0, order = null;
    sizes.forEach((n, k) => {
      gl.enableVertexAttribArray(k); gl.vertexAttribPointer(k, n, gl.FLOAT, false, stride, offset); offset += 4 * n;
    });
    gl.bufferData(gl.ARRAY_BUFFER, floats, gl.DYNAMIC_DRAW);
    if (index) {
      order = gl.createBuffer(); gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, order);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, index, gl.STATIC_DRAW);
    }
    return { vao, buffer, order };
  }
  triangles() {  // corners of the triangles that bound parts: first those that nothing lies on, then the others; by part each
    const t = this.tets, out = [], spans = [];
    for (const covered of [0, 1]) {
      const first = out.length;
      for (let i = 0; i < data.faces.length; i++)
        FACES.forEach((face, k) => {
          const bits = data.faces[i] >> k;
          if (bits & 1 && (bits >> 4 & 1) === covered) for (const c of face) out.push(t[4 * i + c]);
        });
      spans.push(this.spans((out.length - first) / 3, (i) => this.owner[out[first + 3 * i]], first));
    }
    return [Int32Array.from(out), spans];
  }
  meshes() {  // as it looks, cut open; the mesh itself waits until somebody asks for it
    this.behind = { order: this.gl.createBuffer() };
    this.section = this.mesh(new Float32Array(9), [3, 3, 2, 1]);
    this.outline = this.mesh(new Float32Array(3), [3]);
    this.beads = { ...this.mesh(new Float32Array(6), [3, 3]), rows: 0 };
    if (data.looks) this.looks = this.dressed();
    $("axis").options[0].hidden = $("axis").options[0].disabled = !data.looks;
    $("axis").value = data.looks ? "3" : "0";
  }
  dress() {  // as it looks, in place of the mesh; what was turned or cut meanwhile stays so
    const still = this.turn === TURN && this.tilt === TILT, unchosen = $("axis").value === "0";
    this.looks = this.dressed();
    $("axis").options[0].hidden = $("axis").options[0].disabled = false;
    if (unchosen) $("axis").value = "3";
    this.bounds();
    if (still) this.first();
    this.slice();
  }
  get whole() { return this.own ??= this.bare(); }
  get solid() { return $("axis").value === "3" ? this.looks : this.whole; }
  bare() {  // the mesh: every corner is a node
    const [t, spans] = this.triangles();
    return this.shaded(t, this.points, spans, (node) => [node, node, 0]);
  }
  dressed() {  // shapes for the eye: a corner shows a mix of two nodes; sections have outlines
    const { points, triangles: t, mix, counts } = data.looks, spans = [], edges = [];
    let first = 0;
    for (const [shell, caps] of counts) {
      const known = new Map(), size = points.length;
      spans.push([first, 3 * (shell + caps)]);
      for (let i = first + 3 * shell; i < first + 3 * (shell + caps); i += 3)
        for (let k = 0; k < 3; k++) {
          const a = t[i + k], b = t[i + (k + 1) % 3], key = Math.min(a, b) * size + Math.max(a, b);
          if (!known.delete(key)) known.set(key, [a, b]);
        }
      edges.push([...known.values()].flatMap((ends) => ends.flatMap((i) => [points[3 * i], points[3 * i + 1], points[3 * i + 2]])));
      first += 3 * (shell + caps);
    }
    return { ...this.shaded(t, points, [spans, spans.map(([at]) => [at, 0])], (i) => [mix[3 * i], mix[3 * i + 1], mix[3 * i + 2] / SHARES]), edges };
  }
  shaded(t, p, spans, mix) {  // normals are shared by triangles that meet at less than 40 degrees, so that edges stay sharp
    const n = t.length / 3, nodes = p.length / 3, flat = new Float32Array(3 * n);
    const count = new Int32Array(nodes + 1);
    for (let i = 0; i < 3 * n; i += 3) {
      const a = 3 * t[i], b = 3 * t[i + 1], c = 3 * t[i + 2];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx, s = 1 / (Math.sqrt(x * x + y * y + z * z) || 1);
      flat[i] = x * s; flat[i + 1] = y * s; flat[i + 2] = z * s;
      for (let k = 0; k < 3; k++) count[t[i + k] + 1]++;
    }
    for (let i = 1; i < count.length; i++) count[i] += count[i - 1];
    const fill = count.slice(), around = new Int32Array(3 * n), index = new Uint32Array(3 * n);
    for (let i = 0; i < 3 * n; i++) around[fill[t[i]]++] = Math.floor(i / 3);
    const last = new Int32Array(nodes).fill(-1), before = new Int32Array(3 * n), rows = new Float32Array(27 * n);
    let vertices = 0;  // a node has one for each of its normals
    for (let i = 0; i < 3 * n; i++) {
      const node = t[i], own = i - i % 3, nx = flat[own], ny = flat[own + 1], nz = flat[own + 2];
      let x = 0, y = 0, z = 0;
      for (let j = count[node]; j < count[node + 1]; j++) {
        const o = 3 * around[j];
        if (flat[o] * nx + flat[o + 1] * ny + flat[o + 2] * nz > CREASE) { x += flat[o]; y += flat[o + 1]; z += flat[o + 2]; }
      }
      const s = 1 / (Math.sqrt(x * x + y * y + z * z) || 1);
      let vertex = last[node];
      while (vertex >= 0 && (rows[9 * vertex + 3] * x + rows[9 * vertex + 4] * y + rows[9 * vertex + 5] * z) * s <= SAME) vertex = before[vertex];
      if (vertex < 0) {
        vertex = vertices++; before[vertex] = last[node]; last[node] = vertex;
        rows.set([p[3 * node], p[3 * node + 1], p[3 * node + 2], x * s, y * s, z * s, ...mix(node)], 9 * vertex);
      }
      index[i] = vertex;
    }
    return { ...this.mesh(rows.subarray(0, 9 * vertices), [3, 3, 2, 1], index), spans, triangles: t, index, points: p };
  }
  spans(n, part, first = 0) {  // of n triangles sorted by part: [first, count] in corners
    const out = this.parts.map(() => [first, 0]);
    for (let i = 0; i < n; i++) { const s = out[part(i)]; if (!s[1]) s[0] = first + 3 * i; s[1] += 3; }
    return out;
  }
  textures() {
    const gl = this.gl;
    this.wide = 1024; this.high_ = Math.ceil(this.owner.length / this.wide);
    this.values = new Float32Array(2 * this.wide * this.high_);
    const made = (unit) => {
      const t = gl.createTexture();
      gl.activeTexture(gl.TEXTURE0 + unit); gl.bindTexture(gl.TEXTURE_2D, t);
      for (const k of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, k, gl.NEAREST);
      for (const k of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, k, gl.CLAMP_TO_EDGE);
      return t;
    };
    made(0); made(1); made(2);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    const buffers = () => ({ frame: gl.createFramebuffer(), colour: gl.createRenderbuffer(), depth: gl.createRenderbuffer() });
    this.picked = buffers(); this.sampled = buffers();
  }
  choose(k) {
    this.test = data.tests[k];
    const options = $("layer").options, several = this.test.states.length > 1;
    options[1].disabled = !several; options[2].disabled = !data.k; options[3].disabled = !data.errors;
    this.number = k; $("test").value = k;
    this.parts.forEach((p, i) => {  // the machine stands on another base in another test
      p.absent = this.test.absent.includes(i);
      p.opacity = p.absent ? 0 : p.chosen;
      if (p.line) p.line.hidden = p.absent;
    });
    this.sure();
    if (options[$("layer").selectedIndex].disabled) $("layer").value = "0";
    $("wiping").hidden = !several;
    this.recolour();
    this.move(this.time);
  }
  flows(network) {  // the network and its panel, as soon as they are known
    $("networked").parentNode.hidden = !network;
    if (!network) return;
    data.network = network;
    this.network = new Network($("network"), network);
    $("networked").checked = innerWidth >= WIDE;
    this.beside($("networked").checked);
  }
  async more(rest) {  // what the first picture did without: temperatures of every test, then the rest
    const { errors, network, ...every } = rest;
    if (every.tests && !this.complete) {
      this.complete = true;
      Object.assign(data, await opened(every));
      if (every.looks) this.dress();
      this.listed();
      this.choose(Math.max(0, this.numbered(this.wanted ?? this.test.test)));
      if (this.limits) this.judged(this.limits);
    }
    if (network !== undefined && !this.network) this.flows(await opened(network));
    if (errors && !data.errors) this.told(await opened(errors));
  }
  listed() {  // tests and revisions to choose from
    $("test").replaceChildren(...data.tests.map((t, k) => new Option(t.name, k)));
    const states = data.tests[0].states.length;
    for (const side of ["left", "right"]) {
      $(side).replaceChildren(...data.revisions.slice(0, states).map((name, k) => new Option(name, k)));
      $(side).value = Math.min(this[side], states - 1);
    }
  }
  numbered(name) { return data.tests.findIndex((t) => t.test === name); }
  want(name) {  // the test of that name, at once or as soon as it is there
    this.wanted = name;
    const k = this.numbered(name);
    if (k >= 0 && k !== this.number) this.choose(k);
  }
  told(errors) {  // what residuals tell between the sensors
    data.errors = errors; $("layer").options[3].disabled = false;
    this.sure();
  }
  sure() {  // the share of the variance that the sensors of this test explain, node by node; 1 where nothing is said
    const gl = this.gl, n = this.owner.length, share = new Float32Array(this.wide * this.high_).fill(1);
    if (data.errors) {
      const { told } = data.errors, c = told.weights.columns, both = new Float32Array(2 * n);
      const weights = told.weights.subarray(c * this.number, c * (this.number + 1));
      this.mix(told, weights, weights, both);
      for (let i = 0; i < n; i++) share[i] = both[2 * i];
    }
    gl.activeTexture(gl.TEXTURE2);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R32F, this.wide, this.high_, 0, gl.RED, gl.FLOAT, share);
  }
  misses(state) {  // weights of what residuals tell between the sensors; a sensor that is silent keeps its last one
    const { gains, sensors } = data.errors, g = gains.weights, c = g.columns, out = new Float32Array(c);
    let row = sensors.slice(0, this.number).reduce((n, names) => n + names.length, 0);
    for (const name of sensors[this.number]) {
      const j = this.test.sensors.findIndex((s) => s.name === name);
      let k = Math.round(this.place);
      while (k > 0 && this.residual(j, k, state) === null) k--;
      const residual = this.residual(j, k, state) ?? 0;
      for (let i = 0; i < c; i++) out[i] += residual * g[row * c + i];
      row++;
    }
    return out;
  }
  residual(j, k, state) {  // measured - modelled of sensor j at the k-th instant
    const { measured, models } = this.test, at = k * measured.columns + j, found = measured[at] - (models[state] ?? models[0])[at];
    return Number.isNaN(found) ? null : found;
  }
  mix(fields, right, left, out) {  // values at all nodes (right, left) from the weights of both states
    let node = 0, first = 0;
    for (const block of fields.blocks) {
      const c = block.columns;
      for (let i = 0; i < block.length; i += c, node++) {
        let a = 0, b = 0;
        for (let k = 0; k < c; k++) { const x = block[i + k]; a += right[first + k] * x; b += left[first + k] * x; }
        out[2 * node] = a; out[2 * node + 1] = b;
      }
      first += c;
    }
  }
  recolour() {
    const gl = this.gl, layer = +$("layer").value, rgb = [data.heat, data.missing, data.power, data.missing][layer];
    gl.activeTexture(gl.TEXTURE1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, new Uint8Array(rgb));
    const ramp = $("ramp").getContext("2d"), picture = ramp.createImageData(1, 256);
    for (let i = 0; i < 256; i++) picture.data.set([...rgb.slice(3 * (255 - i), 3 * (255 - i) + 3), 255], 4 * i);
    ramp.putImageData(picture, 0, 0);
    this.marks = [data.marks, data.change_marks, data.flux_marks, data.errors && data.errors.marks][layer];
    this.range = [this.marks[0], this.marks[this.marks.length - 1]];
    $("unit").textContent = ["°C", "K", "kW/m²", "K"][layer];
    $("guess").hidden = layer !== 3;
    $("marks").replaceChildren(...this.marks.map((m) => {
      const s = document.createElement("span");
      s.textContent = String(m).replace("-", "−"); s.style.bottom = `${100 * (m - this.range[0]) / (this.range[1] - this.range[0])}%`;
      return s;
    }));
    this.dirty = true;
  }
  between(rows, first = 0) {  // of a run whose rows begin at `first`: the row at the present instant
    const c = rows.columns, i = Math.min(Math.floor(this.place), this.test.times.length - 2), f = this.place - i, at = (first + i) * c;
    return Array.from({ length: c }, (_, k) => rows[at + k] + f * (rows[at + c + k] - rows[at + k]));
  }
  move(time) {  // 0 to 1 of the test
    const times = this.test.times, s = times[0] + time * (times[times.length - 1] - times[0]);
    this.time = time;
    let i = 0;
    while (i < times.length - 2 && times[i + 1] <= s) i++;
    this.place = i + (s - times[i]) / (times[i + 1] - times[i]);
    const wrong = $("layer").value === "3", left = this.left < this.test.states.length ? this.left : 0, v = this.values;
    const [right, other] = [this.right, left].map((state) => wrong ? this.misses(state) : this.between(data.fields.weights, this.test.states[state]));
    this.mix(wrong ? data.errors.gains : data.fields, right, other, v);
    if ($("layer").value === "2") this.fluxes(v);
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE0);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RG32F, this.wide, this.high_, 0, gl.RG, gl.FLOAT, v);
    $("title").textContent = `${data.title}: ${this.test.name} at ${(s / 60).toFixed(0)} min`;
    $("time").value = 1000 * time;
    this.described();
    this.networked();
    this.readings();
    this.dirty = true;
  }
  described() {  // alternative texts
    const colour = $("layer").selectedOptions[0].textContent, unit = $("unit").textContent;
    $("gl").ariaLabel = `${$("title").textContent}, coloured by ${colour}. Arrow keys turn it, plus and minus zoom, space plays.`;
    $("bar").ariaLabel = `colours from ${this.range[0]} to ${this.range[1]} ${unit}`;
  }
  networked() {  // the network at the same instant
    if (!this.network || $("beside").hidden) return;
    const run = data.network.tests[this.number];
    this.network.show(this.between(run.T), this.between(run.W), [data.marks[0], data.marks[data.marks.length - 1]]);
  }
  beside(on) {  // open or close the network's panel
    $("beside").hidden = !on;
    if (on) { this.network.place(); this.networked(); }
    this.dirty = true;
  }
  slopes() {  // of every tetrahedron a, b, c, d: grad T = (T_b - T_a) u + (T_c - T_a) v + (T_d - T_a) w; u, v, w, volume
    const t = this.tets, p = this.points, out = new Float32Array(10 * t.length / 4);
    for (let i = 0; i < t.length; i += 4) {
      const edge = [1, 2, 3].map((k) => [0, 1, 2].map((m) => p[3 * t[i + k] + m] - p[3 * t[i] + m]));
      const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
      const u = cross(edge[1], edge[2]), det = u[0] * edge[0][0] + u[1] * edge[0][1] + u[2] * edge[0][2];
      const all = [...u, ...cross(edge[2], edge[0]), ...cross(edge[0], edge[1])];
      for (let k = 0; k < 9; k++) out[10 * i / 4 + k] = all[k] / det;
      out[10 * i / 4 + 9] = Math.abs(det) / 6;
    }
    return out;
  }
  fluxes(v) {  // temperatures become |k grad T| in kW/m2: the mean vector of the tetrahedra around a node, by volume
    this.gradients ??= this.slopes();
    const t = this.tets, n = this.owner.length, g = this.gradients, sum = new Float64Array(7 * n);
    for (let i = 0, j = 0; i < t.length; i += 4, j += 10) {
      const [across, along] = data.k[this.owner[t[i]]], volume = g[j + 9];
      for (let side = 0; side < 2; side++) {
        const a = v[2 * t[i] + side], b = v[2 * t[i + 1] + side] - a, c = v[2 * t[i + 2] + side] - a, d = v[2 * t[i + 3] + side] - a;
        for (let m = 0; m < 3; m++) {
          const q = volume * (m < 2 ? across : along) * (b * g[j + m] + c * g[j + 3 + m] + d * g[j + 6 + m]);
          for (let k = 0; k < 4; k++) sum[7 * t[i + k] + 3 * side + m] += q;
        }
      }
      for (let k = 0; k < 4; k++) sum[7 * t[i + k] + 6] += volume;
    }
    for (let i = 0; i < n; i++)
      for (let side = 0; side < 2; side++)
        v[2 * i + side] = Math.hypot(sum[7 * i + 3 * side], sum[7 * i + 3 * side + 1], sum[7 * i + 3 * side + 2]) / sum[7 * i + 6] / 1000;
  }
  readings() {
    const k = Math.round(this.place), { measured } = this.test;
    const all = this.test.sensors.map((s, j) => {
      const read = measured[k * measured.columns + j], y = Number.isNaN(read) ? null : read, residual = this.residual(j, k, this.right);
      const [rmse, late] = [this.test.rmse, this.test.late].map((of) => (of[this.right] ?? of[0])[j]), judged = late !== null && s.limit !== null;
      const verdict = !judged ? 3 : rmse <= s.limit ? 0 : late > 0 ? 1 : 2;  // of the whole test, as everywhere
      const weight = s.channel === this.chosen ? Infinity : late === null ? -1 : Math.abs(late) / (s.limit ?? 1);
      return { ...s, y, residual, verdict, weight };
    });
    this.sensors = all.filter((s) => s.xyz);
    const beads = new Float32Array(6 * this.sensors.length);
    this.sensors.forEach((s, i) => beads.set([...s.xyz, ...TINTS[s.verdict]], 6 * i));
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.beads.buffer);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, beads, this.gl.DYNAMIC_DRAW);
    this.beads.rows = this.sensors.length;
    const list = $("sensors"), held = [...list.querySelectorAll("button")].indexOf(document.activeElement);
    list.replaceChildren(...all.map((s) => line(s.name, s.y === null ? "–" : `${s.y.toFixed(1)} °C  ${signed(s.residual)} K`, `rgb(${TINTS[s.verdict].map((c) => 255 * c)})`, () => this.pin(s.channel), s.channel === this.chosen)));
    if (held >= 0) list.querySelectorAll("button")[held].focus();
  }
  judged(limits) {  // the largest errors that count as agreement: test -> sensor -> K
    this.limits = limits;
    for (const t of data.tests) for (const s of t.sensors) s.limit = limits[t.test]?.[s.channel] ?? null;
    this.readings();
  }
  pin(channel) {  // a sensor gets a label and a larger dot, whatever the others miss
    this.chosen = channel;
    this.readings();
    this.dirty = true;
  }
  plane() {
    const axis = +$("axis").value;
    if (axis < 0 || axis > 2) return [0, 0, 0, 1];
    const share = $("cut").value / 1000, sign = axis === 0 ? -1 : 1, out = [0, 0, 0, 0];
    out[axis] = sign;
    out[3] = sign * (this.low[axis] + share * (this.high[axis] - this.low[axis])) + 1e-7 * this.size;
    return out;
  }
  slice() {  // the plane through every tetrahedron: each corner of the section is a mix of two nodes
    const plane = this.plane(), off = this.plane().slice(0, 3).every((v) => v === 0), n = this.owner.length;
    const d = new Float32Array(n), p = this.points, t = this.tets, out = [], part = [];
    this.cutting = plane;
    for (let i = 0; i < n && !off; i++) d[i] = plane[0] * p[3 * i] + plane[1] * p[3 * i + 1] + plane[2] * p[3 * i + 2] - plane[3];
    const corner = (i, j) => {
      const s = d[i] / (d[i] - d[j]), a = 3 * i, b = 3 * j;
      out.push(p[a] + s * (p[b] - p[a]), p[a + 1] + s * (p[b + 1] - p[a + 1]), p[a + 2] + s * (p[b + 2] - p[a + 2]),
        plane[0], plane[1], plane[2], i, j, s);
    };
    for (let i = 0; i < t.length && !off; i += 4) {
      const above = (d[t[i]] > 0) + (d[t[i + 1]] > 0) + (d[t[i + 2]] > 0) + (d[t[i + 3]] > 0);
      if (above === 0 || above === 4) continue;
      const up = [], down = [];
      for (let k = 0; k < 4; k++) (d[t[i + k]] > 0 ? up : down).push(t[i + k]);
      const triangles = up.length === 2
        ? [[up[0], down[0], up[0], down[1], up[1], down[1]], [up[0], down[0], up[1], down[1], up[1], down[0]]]
        : [(up.length === 1 ? down : up).flatMap((j) => [up.length === 1 ? up[0] : down[0], j])];
      for (const c of triangles) { corner(c[0], c[1]); corner(c[2], c[3]); corner(c[4], c[5]); part.push(this.owner[t[i]]); }
    }
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.section.buffer);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, new Float32Array(out), this.gl.DYNAMIC_DRAW);
    this.section.spans = this.spans(part.length, (i) => part[i]);
    $("cut").disabled = off;
    this.lined(this.solid.edges ?? this.outlined(d));
  }
  outlined(d) {  // where the plane, d away from every node, meets what bounds the parts: a line in each triangle, part by part
    const p = this.points, t = this.whole.triangles, lines = this.parts.map(() => []);
    for (let i = 0; i < t.length; i += 3)
      for (let j = 0; j < 3; j++) {
        const a = t[i + j], b = t[i + (j + 1) % 3];
        if (d[a] > 0 !== d[b] > 0)
          for (let k = 0; k < 3; k++) lines[this.owner[a]].push(p[3 * a + k] + d[a] / (d[a] - d[b]) * (p[3 * b + k] - p[3 * a + k]));
      }
    return lines;
  }
  lined(lines) {  // of every part
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.outline.buffer);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, new Float32Array(lines.flat()), this.gl.DYNAMIC_DRAW);
    let first = 0;
    this.outline.spans = lines.map(({ length }) => [(first += length / 3) - length / 3, length / 3]);
  }
  matrix() {
    const [ct, st, cp, sp] = [Math.cos(this.turn), Math.sin(this.turn), Math.cos(this.tilt), Math.sin(this.tilt)];
    const towards = [st * cp, sp, ct * cp], right = [ct, 0, -st], up = [-st * sp, cp, -ct * sp];
    const far = 3.4 * this.size / this.zoom, gl = $("gl"), f = 6.2, aspect = gl.clientWidth / gl.clientHeight;
    const near = Math.max(far - this.size, 0.01 * this.size), end = far + this.size;
    this.eye = this.middle.map((m, k) => m + far * towards[k]);
    const fy = f * Math.min(1, aspect), fx = fy / aspect;
    const rows = [right, up, towards].map((v) => [...v, -v.reduce((s, x, k) => s + x * this.eye[k], 0)]);
    const a = -(end + near) / (end - near), b = -2 * end * near / (end - near), z = rows[2];
    const m = [rows[0].map((v) => fx * v), rows[1].map((v) => fy * v), z.map((v, k) => a * v + (k === 3 ? b : 0)), z.map((v) => -v)];
    m[0] = m[0].map((v, k) => v - 0.1 * m[3][k]);  // room for the colour bar
    this.rows = m;
    return new Float32Array([0, 1, 2, 3].flatMap((c) => m.map((row) => row[c])));
  }
  skinned(mode, reach = 0) {  // 0 as it is seen, 1 numbers for the pointer, 2 what windows of `reach` pixels show
    const gl = this.gl, s = this.skin;
    gl.useProgram(s.p);
    gl.uniformMatrix4fv(s.view, false, this.matrix());
    gl.uniform4fv(s.plane, this.cutting); gl.uniform3fv(s.eye, this.eye); gl.uniform2fv(s.range, this.range);
    gl.uniform1i(s.layer, +$("layer").value); gl.uniform1i(s.mode, mode); gl.uniform1i(s.wide, this.wide);
    gl.uniform3fv(s["windows[0]"], this.windows()); gl.uniform1f(s.reach, reach);
    gl.uniform1i(s.field, 0); gl.uniform1i(s.palette, 1); gl.uniform1i(s.told, 2);
    gl.uniform1f(s.wipe, this.test.states.length > 1 ? $("wipe").value / 1000 * $("gl").width : 0);
    const solid = this.solid, shape = mode < 2 ? solid : this.through(reach), whole = mode < 2 && this.parts.every((p) => p.opacity === 1);  // then nobody sees a face that another part lies on
    for (const opacity of mode ? [1] : [1, 0.5]) {
      if (opacity < 1) { this.blending(); gl.depthMask(false); }
      gl.uniform1f(s.alpha, opacity < 1 ? 0.16 : 1);
      for (const [mesh, flat] of [[solid, 0], [this.section, 1]]) {
        gl.uniform1f(s.flat_, flat);
        gl.bindVertexArray(mesh.vao);
        if (!flat) gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, shape.order);
        (flat || mode === 2 ? gl.disable : gl.enable).call(gl, gl.CULL_FACE);  // parts are closed, and closed again where they are cut
        this.parts.forEach((p, k) => {
          gl.uniform1f(s.part, k);
          if (p.opacity !== opacity) return;
          if (flat) gl.drawArrays(gl.TRIANGLES, ...mesh.spans[k]);
          else for (const spans of whole ? shape.spans.slice(0, 1) : shape.spans) gl.drawElements(gl.TRIANGLES, spans[k][1], gl.UNSIGNED_INT, 4 * spans[k][0]);
        });
      }
    }
    gl.disable(gl.BLEND); gl.depthMask(true);
  }
  through(reach) {  // the triangles that may show in a window of `reach` pixels, part by part: a few of all
    const gl = this.gl, { index, triangles: t, spans, points: p, vao } = this.solid, w = this.windows(), n = p.length / 3;
    const [a, b, , c] = this.rows, wide = $("gl").width / 2, high = $("gl").height / 2, x = new Float32Array(n), y = new Float32Array(n);
    for (let i = 0, j = 0; i < n; i++, j += 3) {
      const far = c[0] * p[j] + c[1] * p[j + 1] + c[2] * p[j + 2] + c[3];
      x[i] = wide * (1 + (a[0] * p[j] + a[1] * p[j + 1] + a[2] * p[j + 2] + a[3]) / far);
      y[i] = high * (1 + (b[0] * p[j] + b[1] * p[j + 1] + b[2] * p[j + 2] + b[3]) / far);
    }
    const meets = (i) => {
      const [i0, i1, i2] = [t[i], t[i + 1], t[i + 2]];
      const left = Math.min(x[i0], x[i1], x[i2]) - reach, right = Math.max(x[i0], x[i1], x[i2]) + reach;
      const low = Math.min(y[i0], y[i1], y[i2]) - reach, top = Math.max(y[i0], y[i1], y[i2]) + reach;
      for (let k = 0; k < w.length; k += 3) if (w[k] > left && w[k] < right && w[k + 1] > low && w[k + 1] < top) return true;
      return false;
    };
    const some = new Uint32Array(index.length);
    let size = 0;
    this.behind.spans = spans.map((parts) => parts.map(([first, count]) => {
      const begin = size;
      for (let i = first; i < first + count; i += 3)
        if (meets(i)) { some[size++] = index[i]; some[size++] = index[i + 1]; some[size++] = index[i + 2]; }
      return [begin, size - begin];
    }));
    gl.bindVertexArray(vao); gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.behind.order);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, some.subarray(0, size), gl.DYNAMIC_DRAW);
    return this.behind;
  }
  draw(samples) {  // edges are smooth with several samples per pixel
    const gl = this.gl, c = $("gl"), full = Math.min(devicePixelRatio || 1, 2), scale = full * (samples > 1 ? 1 : COARSE);
    const [w, h] = [c.clientWidth, c.clientHeight].map((side) => Math.max(1, Math.round(side * scale)));
    if (c.width !== w || c.height !== h) { c.width = w; c.height = h; }
    const paper = getComputedStyle(document.body).backgroundColor.match(/\d+/g).map((v) => v / 255);
    if (samples > 1) this.target(samples);
    gl.viewport(0, 0, w, h); gl.clearColor(paper[0], paper[1], paper[2], 1); gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const reach = samples > 1 ? WINDOW * scale : 0;  // windows cost a second pass: rough pictures have none
    if (reach) { this.matrix(); this.behindOf = new Set(this.labelled().filter((s) => this.hidden(s)).map((s) => s.channel)); }
    this.skinned(0, reach);
    if (reach) this.skinned(2, reach);
    this.outlines();
    gl.useProgram(this.dots.p); gl.bindVertexArray(this.beads.vao);
    gl.uniformMatrix4fv(this.dots.view, false, this.matrix()); gl.uniform4fv(this.dots.plane, this.cutting); gl.uniform3fv(this.dots["wedge[0]"], this.missing());
    const at = this.sensors.findIndex((s) => s.channel === this.chosen);
    for (const [hollow, test] of [[0.42, false], [0, true]]) {  // hollow everywhere, filled where nothing covers it
      (test ? gl.enable : gl.disable).call(gl, gl.DEPTH_TEST);
      gl.uniform1f(this.dots.hollow, hollow); gl.uniform1f(this.dots.size, 15 * scale); gl.uniform1f(this.dots.nearer, test ? 0.002 : 0);
      gl.drawArrays(gl.POINTS, 0, this.beads.rows);
      gl.uniform1f(this.dots.size, 22 * scale);
      if (at >= 0) gl.drawArrays(gl.POINTS, at, 1);
    }
    if (samples > 1) {
      gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.sampled.frame); gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
      gl.blitFramebuffer(0, 0, w, h, 0, 0, w, h, gl.COLOR_BUFFER_BIT, gl.NEAREST);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }
    this.labels(scale, full);
    this.frames++;
  }
  missing() {  // of the wedge that the shapes for the eye have not: normals of its sides, towards it; nothing elsewhere
    if ($("axis").value !== "3") return new Float32Array(6);
    const [start, end] = [data.looks.wedge[0], data.looks.wedge[0] + data.looks.wedge[1]].map((v) => v * Math.PI / 180);
    return new Float32Array([-Math.sin(start), Math.cos(start), 0, Math.sin(end), -Math.cos(end), 0]);
  }
  target(samples) {  // draw into a buffer of several samples per pixel, of the canvas's size
    const gl = this.gl, c = $("gl"), s = this.sampled, size = [c.width, c.height];
    gl.bindFramebuffer(gl.FRAMEBUFFER, s.frame);
    if (`${s.size}` === `${size}`) return;
    for (const [buffer, kind, at] of [[s.colour, gl.RGBA8, gl.COLOR_ATTACHMENT0], [s.depth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer); gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, kind, ...size);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, at, gl.RENDERBUFFER, buffer);
    }
    s.size = size;
  }
  blending() {  // over what is drawn; the canvas itself stays opaque
    const gl = this.gl;
    gl.enable(gl.BLEND); gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }
  outlines() {  // of the parts in the section
    const gl = this.gl;
    gl.useProgram(this.lines.p); gl.bindVertexArray(this.outline.vao);
    gl.uniformMatrix4fv(this.lines.view, false, this.matrix());
    this.blending();
    this.parts.forEach((p, k) => { if (p.opacity) gl.drawArrays(gl.LINES, ...this.outline.spans[k]); });
    gl.disable(gl.BLEND);
  }
  pixel(sensor) {
    const at = [...sensor.xyz, 1], q = this.rows.map((row) => row.reduce((sum, v, k) => sum + v * at[k], 0));
    return [(q[0] / q[3] + 1) / 2 * $("gl").width, (1 - q[1] / q[3]) / 2 * $("gl").height];
  }
  labelled() { return [...this.sensors].sort((a, b) => b.weight - a.weight).slice(0, $("gl").clientWidth < SMALL ? 3 : 6); }  // the chosen one, and those furthest beyond their uncertainty
  hidden(s) {  // does a triangle of what is drawn lie between the eye and the sensor? Cuts across the mesh are not asked: there always
    const solid = this.solid;
    if (!solid.edges) return true;
    const { triangles: t, points: p } = solid, o = this.eye, d = s.xyz.map((v, k) => v - o[k]), far = 1 - ABOVE * this.size / Math.hypot(...d);
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    return this.parts.some((part, k) => {
      if (part.opacity < 1) return false;
      const [first, count] = solid.spans[0][k];
      for (let i = first; i < first + count; i += 3) {  // Moeller and Trumbore 1997
        const a = 3 * t[i], b = 3 * t[i + 1], c = 3 * t[i + 2];
        const u = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]], v = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
        const h = cross(d, v), det = dot(u, h), from = [o[0] - p[a], o[1] - p[a + 1], o[2] - p[a + 2]];
        const x = dot(from, h) / det;
        if (!(x >= 0 && x <= 1)) continue;
        const q = cross(from, u), y = dot(d, q) / det, at = dot(v, q) / det;
        if (y >= 0 && x + y <= 1 && at > 0 && at < far) return true;
      }
      return false;
    });
  }
  windows() {  // of what is labelled: pixels, and the depth down to which material is ghosted, just above the sensor
    const out = new Float32Array(18).fill(-1e6);  // none there
    this.labelled().filter((s) => this.behindOf.has(s.channel)).forEach((s, i) => {
      const far = this.eye.map((e, k) => e - s.xyz[k]), share = ABOVE * this.size / Math.hypot(...far);
      const at = [...s.xyz.map((v, k) => v + share * far[k]), 1], [x, y] = this.pixel(s);
      const [z, w] = [2, 3].map((row) => this.rows[row].reduce((sum, v, k) => sum + v * at[k], 0));
      out.set([x, $("gl").height - y, 0.5 + z / w / 2], 3 * i);
    });
    return out;
  }
  labels(drawn, scale) {  // at full size, however coarse GL draws: of the six sensors furthest beyond their uncertainty; none covers a dot, the title or another label
    const c = $("over"), x = c.getContext("2d"), d = 9 * scale, by = scale / drawn, place = (s) => this.pixel(s).map((v) => v * by);
    const head = $("title"), taken = this.sensors.map(place).map((p) => [p[0] - d, p[1] - d, 2 * d, 2 * d]);
    taken.push([0, 0, ...[head.offsetWidth, head.offsetHeight].map((v) => v * scale)]);
    c.width = Math.round($("gl").width * by); c.height = Math.round($("gl").height * by);
    x.font = `${13 * scale}px "DejaVu Sans", system-ui, sans-serif`; x.textBaseline = "middle";
    this.divided(x, scale);
    for (const s of this.labelled()) {
      const at = place(s);
      const text = `${s.name}  ${signed(s.residual)} K`, wide = x.measureText(text).width + 12 * scale, tall = 22 * scale;
      const room = c.width - 100 * scale - wide;
      const left = Math.max(4 * scale, at[0] < c.width * 0.45 ? at[0] - wide - 26 * scale : Math.min(at[0] + 26 * scale, room));
      let top = at[1] - tall / 2;
      const over = (y) => y < 0 || y + tall > c.height || taken.some((t) => left < t[0] + t[2] && left + wide > t[0] && y < t[1] + t[3] && y + tall > t[1]);
      for (let k = 1; over(top) && k < 30; k++) top = at[1] - tall / 2 + (k % 2 ? 1 : -1) * Math.ceil(k / 2) * tall * 1.1;
      if (over(top)) continue;  // no room: its name is under the pointer
      taken.push([left, top, wide, tall]);
      x.strokeStyle = getComputedStyle(document.body).color; x.lineWidth = 1.5 * scale; x.beginPath();
      x.moveTo(...at); x.lineTo(Math.max(left, Math.min(at[0], left + wide)), top + tall / 2); x.stroke();
      x.fillStyle = `rgb(${TINTS[s.verdict].map((v) => 255 * v)})`; x.fillRect(left, top, wide, tall);
      x.fillStyle = "#fff"; x.fillText(text, left + 6 * scale, top + tall / 2);
    }
  }
  divided(x, scale) {  // the line between two revisions, and which stands on either side of it
    const share = $("wipe").value / 1000, { width, height } = $("over");
    if (this.test.states.length < 2 || $("layer").value === "1" || share <= 0 || share >= 1) return;
    x.strokeStyle = x.fillStyle = getComputedStyle(document.body).color; x.lineWidth = 1.5 * scale; x.beginPath();
    x.moveTo(share * width, 0.08 * height); x.lineTo(share * width, height); x.stroke();
    for (const [state, side] of [[this.left, -1], [this.right, 1]]) {
      x.textAlign = side < 0 ? "right" : "left";
      const room = (side < 0 ? share : 1 - share) * width - 16 * scale;
      x.fillText(data.revisions[state], share * width + 8 * side * scale, height - 40 * scale, Math.max(room, 1));
    }
    x.textAlign = "left";
  }
  pick(x, y) {  // part and value under the pointer, read back from one pixel
    const gl = this.gl, c = $("gl"), p = this.picked, scale = c.width / c.clientWidth;
    gl.bindFramebuffer(gl.FRAMEBUFFER, p.frame);
    for (const [buffer, kind, at] of [[p.colour, gl.RGBA8, gl.COLOR_ATTACHMENT0], [p.depth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer); gl.renderbufferStorage(gl.RENDERBUFFER, kind, c.width, c.height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, at, gl.RENDERBUFFER, buffer);
    }
    const [px, py] = [Math.round(x * scale), c.height - 1 - Math.round(y * scale)], out = new Uint8Array(4);
    gl.enable(gl.SCISSOR_TEST); gl.enable(gl.DEPTH_TEST); gl.scissor(px, py, 1, 1);
    gl.clearColor(0, 0, 0, 0); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.skinned(1);
    gl.readPixels(px, py, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out);
    gl.disable(gl.SCISSOR_TEST); gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    if (!out[0]) return null;
    const s = (256 * out[1] + out[2]) / 65535;
    return { name: this.parts[out[0] - 1].name, value: this.range[0] + s * (this.range[1] - this.range[0]), guess: !out[3] };
  }
  near(x, y) {  // the sensor whose dot is there
    const scale = $("gl").width / $("gl").clientWidth;
    const far = (s) => { const p = this.pixel(s); return Math.hypot(p[0] / scale - x, p[1] / scale - y); };
    const [first] = [...this.sensors].sort((a, b) => far(a) - far(b));
    return first && far(first) < NEAR ? first : undefined;
  }
  hover(x, y) {
    const box = $("hover"), sensor = this.near(x, y), found = sensor || this.pick(x, y);
    box.style.display = found ? "block" : "none";
    if (sensor) box.textContent = `${sensor.name}  ${sensor.y === null ? "–" : sensor.y.toFixed(1)} °C, ${signed(sensor.residual)} K`;
    else if (found) box.textContent = `${found.name}  ${found.value.toFixed(1)} ${$("unit").textContent}${found.guess ? ", a guess" : ""}`;
    box.style.left = `${Math.min(x + 14, $("gl").clientWidth - 180)}px`; box.style.top = `${y + 14}px`;
  }
  tick(now) {
    if (this.drawn(now)) {
      if (this.playing) this.advance((now - this.last) / 1000);
      this.last = now;
      this.next(now);
    }
    requestAnimationFrame((t) => this.tick(t));
  }
  advance(seconds) {  // an hour in ten of them
    const times = this.test.times, time = this.time + seconds * 360 / (times[times.length - 1] - times[0]);
    this.move(Math.min(time, 1));
    if (time >= 1) this.play(false);
  }
  next(now) {  // a slow computer draws roughly while something moves, and smoothly once a picture has stood still
    const resting = now - this.moved > Math.max(REST, 2 * this.took);  // else a slow hand meets a slow picture
    if (!this.dirty && (this.smooth || !resting)) return;
    this.smooth = !this.slow || !this.dirty;
    const still = !this.dirty;
    this.dirty = false;
    this.draw(this.smooth ? SAMPLES : 1);
    this.begun = performance.now();
    this.pending = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.gl.flush();
    if (still && this.took < QUICK) this.slow = this.finished() - now > SLOW;
  }
  drawn(now) {  // is the last picture done? GL draws beside this script; no picture is asked for before that
    const gl = this.gl;
    if (this.pending) {
      if (gl.clientWaitSync(this.pending, 0, 0) === gl.TIMEOUT_EXPIRED) return false;
      gl.deleteSync(this.pending); this.pending = null;
      this.moved = now; this.took = performance.now() - this.begun;
    }
    return true;
  }
  finished() {  // ms, when the picture is there: reading a pixel waits for it
    this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4));
    return performance.now();
  }
  play(on) {
    if (on && this.time >= 1) this.move(0);
    this.playing = on; $("play").textContent = on ? "❚❚" : "▶";
  }
}

const FACES = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];  // of a tetrahedron, seen from outside
const SAME = 0.9999;  // cosine of the angle between normals below which they are one: under a degree
const SAMPLES = 4;  // per pixel: every WebGL 2 has them
const SLOW = 12, QUICK = 50;  // ms that a smooth picture takes from which moving ones are rough; a rough one, until which smooth ones are timed
const FILL = [0.66, 0.86];  // shares of the picture's width and height that the machine takes
const SHARES = 16;  // extras.portraits.looks
const COARSE = 0.5;  // of the pixels along a side, in rough pictures
const REST = 200;  // ms without a movement until the picture is smooth
const CREASE = 0.77;  // cosine of 40 degrees
const TURN = -1.0, TILT = 0.35;  // radians: a machine from its side and a little from above
const WINDOW = 22, ABOVE = 0.01;  // pixels around a labelled sensor in which what hides it is ghosted; of the machine's size
const NEAR = 12, STILL = 4;  // pixels from a dot that mean its sensor; that a pointer moves in a click
const SMALL = 560;  // pixels of a picture below which three sensors have labels: six would cover the machine
const WIDE = 1100;  // pixels from which machine and network stand side by side
const TINTS = data.tints;  // within, hot, cold, unknown: red, green, blue from 0 to 1
const signed = (v) => v === null ? "–" : (v <= -0.05 ? "−" : "+") + Math.abs(v).toFixed(1);

function line(name, value, colour, act, on) {  // a dot of the colour, the name, the value; on or off where it can be chosen
  const li = document.createElement("li"), b = document.createElement("button");
  b.append(...[name, value].map((text) => Object.assign(document.createElement("span"), { textContent: text })));
  if (colour) {
    const dot = Object.assign(document.createElement("i"), { className: "dot" });
    dot.style.background = colour;
    b.firstChild.prepend(dot);
  }
  b.onclick = () => act(b.lastChild);
  if (on !== undefined) b.ariaPressed = on;
  li.append(b);
  return li;
}

function wired(v) {
  const c = $("gl"), again = () => { v.dirty = true; };
  v.listed();
  $("test").onchange = (e) => v.want(data.tests[e.target.value].test);
  $("layer").onchange = () => { v.recolour(); v.move(v.time); };
  $("wipe").oninput = again;
  for (const side of ["left", "right"]) $(side).onchange = (e) => { v[side] = +e.target.value; v.move(v.time); };
  $("axis").onchange = $("cut").oninput = () => { v.slice(); again(); };
  $("time").oninput = (e) => { v.play(false); v.move(e.target.value / 1000); };
  $("play").onclick = () => v.play(!v.playing);
  const words = { 1: "shown", 0.5: "ghost", 0: "hidden" }, next = { 1: 0.5, 0.5: 0, 0: 1 };
  $("parts").replaceChildren(...v.parts.map((p) => {
    p.line = line(p.name, "shown", "", (span) => { p.chosen = p.opacity = next[p.opacity]; span.textContent = words[p.opacity]; again(); });
    p.line.hidden = p.absent;
    return p.line;
  }));
  c.onpointerdown = (e) => { c.setPointerCapture(e.pointerId); v.pointers.set(e.pointerId, e); c.pressed = v.pointers.size > 1 ? null : e; };
  c.onpointerup = c.onpointercancel = (e) => {
    v.pointers.delete(e.pointerId);
    const still = e.type === "pointerup" && c.pressed && Math.hypot(e.clientX - c.pressed.clientX, e.clientY - c.pressed.clientY) < STILL;
    const sensor = still && v.near(e.offsetX, e.offsetY);
    if (!sensor) return;
    v.pin(sensor.channel);
    if (parent !== window) parent.postMessage({ sensor: sensor.channel }, "*");
  };
  c.onpointerleave = () => { $("hover").style.display = "none"; };
  c.onpointermove = (e) => {
    const old = v.pointers.get(e.pointerId);
    if (!old) return v.hover(e.offsetX, e.offsetY);
    const other = [...v.pointers.values()].find((q) => q.pointerId !== e.pointerId);
    if (other) {
      const far = (q) => Math.hypot(q.clientX - other.clientX, q.clientY - other.clientY);
      v.nearer(far(e) / Math.max(far(old), 1));
    } else {
      v.turn -= 0.008 * (e.clientX - old.clientX);
      v.tilt = Math.max(-1.5, Math.min(1.5, v.tilt + 0.008 * (e.clientY - old.clientY)));
    }
    v.pointers.set(e.pointerId, e); again();
  };
  c.onwheel = (e) => { e.preventDefault(); v.nearer(Math.exp(-0.001 * e.deltaY)); again(); };
  const keys = {
    ArrowLeft: () => { v.turn -= 0.15; }, ArrowRight: () => { v.turn += 0.15; }, ArrowUp: () => { v.tilt += 0.1; },
    ArrowDown: () => { v.tilt -= 0.1; }, "+": () => v.nearer(1.2), "-": () => v.nearer(1 / 1.2),
    0: () => v.first(), " ": () => v.play(!v.playing), ",": () => v.move(Math.max(0, v.time - 0.02)),
    ".": () => v.move(Math.min(1, v.time + 0.02)),
  };
  onkeydown = (e) => {
    if (["INPUT", "SELECT", "BUTTON"].includes(e.target.tagName)) return;
    if (keys[e.key]) { e.preventDefault(); keys[e.key](); again(); } else if (parent !== window && e.key.length === 1) parent.postMessage({ key: e.key }, "*");
  };
  onmessage = ({ source, data: words }) => {  // from the page around, the workbench: what is chosen there, a key pressed there
    if (source !== parent || parent === window) return;
    const said = words ?? {};
    if (keys[said.key]) keys[said.key]();
    if (said.test) v.want(said.test);
    if (said.dark !== undefined) document.documentElement.dataset.theme = said.dark ? "dark" : "light";
    if (said.limits) v.judged(said.limits);
    if (said.sensor) v.pin(said.sensor);
    if (said.rest) v.more(said.rest);
    again();
  };
  $("networked").onchange = (e) => v.beside(e.target.checked);
  v.flows(data.network);
  onresize = () => { again(); if (v.network && !$("beside").hidden) v.network.place(); };
  matchMedia("(prefers-color-scheme: dark)").onchange = again;
}

document.body.classList.toggle("bench", location.hash === "#bench");  // beside the workbench's own lists of tests and sensors

(async () => {
  try {
    const v = new Viewer(), { errors } = data;
    delete data.errors;  // the first picture does without
    Object.assign(data, await opened(data));
    v.open();
    v.slice();
    wired(v);
    v.first();
    v.linked();
    window.viewer = v;
    $("wait").remove();
    if (parent !== window) parent.postMessage({ ready: true }, "*");
    requestAnimationFrame((t) => { v.last = t; v.tick(t); });
    while (errors && !v.took) await new Promise(requestAnimationFrame);
    if (errors) v.told(await opened(errors));
  } catch (fault) {
    $("wait").remove();
    $("fault").hidden = false; $("fault").textContent = `The machine cannot be drawn: ${fault.message}.`;
    $("title").textContent = data.title;
  }
})();
