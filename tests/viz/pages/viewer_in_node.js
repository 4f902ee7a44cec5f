// The viewer's script without a browser: a page that draws nothing. Usage: node viewer_in_node.js PAGE LEFT RIGHT
// Prints the values (right, left) of every node at the end of the first test.
const page = require("fs").readFileSync(process.argv[2], "utf-8");
const between = (a, b) => page.split(a)[1].split(b)[0];
const nothing = () => new Proxy(() => {}, { get: (o, k) => k === Symbol.toPrimitive ? () => 1 : nothing(), apply: () => nothing() });
const flat = { createImageData: () => ({ data: new Uint8ClampedArray(1024) }) };
const context = (kind) => kind === "2d"
  ? new Proxy(flat, { get: (o, k) => o[k] ?? (() => {}) })
  : new Proxy({}, { get: (o, k) => k === k.toUpperCase() ? 1 : () => ({}) });
const element = () => ({
  value: "0", style: {}, options: [{}, {}, {}, {}], selectedIndex: 0, selectedOptions: [{}], parentNode: {}, width: 100, height: 100, clientWidth: 100, clientHeight: 100,
  getContext: context, replaceChildren() {}, append() {}, appendChild() {}, prepend() {}, remove() {}, setAttribute() {}, firstChild: { prepend() {} }, lastChild: {},
  querySelectorAll: () => [],
});
const known = { data: { ...element(), textContent: between('id="data">', "</script>") } };
globalThis.document = { getElementById: (id) => known[id] ??= element(), createElement: element, createElementNS: element, documentElement: element(), body: { classList: { toggle() {} } } };
globalThis.location = { hash: "" };
globalThis.Option = class {};
globalThis.window = globalThis.parent = globalThis;
globalThis.matchMedia = () => ({});
globalThis.getComputedStyle = () => ({ getPropertyValue: () => "#000" });
globalThis.devicePixelRatio = 1; globalThis.innerWidth = 800; globalThis.onkeydown = globalThis.onresize = globalThis.onmessage = null;
let ready;
globalThis.requestAnimationFrame = () => ready();
new Promise((done) => { ready = done; }).then(() => {
  known.left.onchange({ target: { value: process.argv[3] } });
  known.right.onchange({ target: { value: process.argv[4] } });
  const { values, owner, sensors, parts } = globalThis.viewer;
  const drawn = { values: [...values.slice(0, 2 * owner.length)], residuals: sensors.map((s) => s.residual), verdicts: sensors.map((s) => s.verdict), opacities: parts.map((p) => p.opacity) };
  process.stdout.write(JSON.stringify(drawn), () => process.exit(0));
});
setTimeout(() => { console.error(known.fault && known.fault.textContent); process.exit(1); }, 20000);
(0, eval)(page.split("<script>").at(-1).split("</script>")[0]);
