"use strict";
class Network {  // the nodes in the half section of the machine; heat along the lines between, as the model stands
  constructor(svg, network) {
    Object.assign(this, { svg, ...network });
    this.lines = this.links.map(() => this.made("line"));
    this.dots = this.nodes.map(() => this.made("circle"));
    this.words = this.nodes.map(() => this.made("text"));
    this.titles = [...this.lines, ...this.dots].map((e) => e.appendChild(this.made("title")));
    svg.replaceChildren(...this.lines, ...this.dots, ...this.words);
  }
  made(kind) { return document.createElementNS(this.svg.namespaceURI, kind); }
  place() {  // in pixels of the panel as it is now; names where they cover no dot and no other name, else under the pointer
    const w = this.svg.clientWidth, h = this.svg.clientHeight, edge = 34;
    this.svg.setAttribute("viewBox", `0 0 ${w} ${h}`);
    const span = (k) => [Math.min(...this.nodes.map((n) => n[k])), Math.max(...this.nodes.map((n) => n[k]))];
    const [z, y] = [span("z"), span("y")], share = (v, [a, b]) => b > a ? (v - a) / (b - a) : 0.5;
    this.at = this.nodes.map((n) => [edge + share(n.z, z) * (w - 2 * edge), h - edge - share(n.y, y) * (h - 2 * edge)]);
    this.dots.forEach((e, i) => set(e, { cx: this.at[i][0], cy: this.at[i][1], r: 9 }));
    this.lines.forEach((e, i) => {
      const [a, b, conductance] = this.links[i], [p, q] = [this.at[a], this.at[b]];
      set(e, { x1: p[0], y1: p[1], x2: q[0], y2: q[1], "stroke-width": 1.5 + 9 * Math.sqrt(conductance / this.widest) });
    });
    const taken = this.at.map(([a, b]) => [a - 11, b - 11, 22, 22]);
    this.words.forEach((e, i) => {
      const [a, b] = this.at[i], wide = 6.9 * (this.nodes[i].name.length + 6), tall = 15;
      const free = SIDES.map(([x, y]) => [a + x[0] + x[1] * wide, b + y]).find(([left, top]) =>
        left >= 0 && left + wide <= w && top >= 0 && top + tall <= h
        && !taken.some((t) => left < t[0] + t[2] && left + wide > t[0] && top < t[1] + t[3] && top + tall > t[1]));
      if (free) taken.push([...free, wide, tall]);
      set(e, { x: free ? free[0] : 0, y: free ? free[1] + 12 : 0, visibility: free ? "visible" : "hidden" });
    });
  }
  show(T, W, limits) {  // degC of every node, W along every line
    this.nodes.forEach((n, i) => {
      const said = `${n.name}  ${T[i].toFixed(0)} °C`;
      this.dots[i].setAttribute("fill", tint(data.heat, (T[i] - limits[0]) / (limits[1] - limits[0])));
      this.words[i].textContent = said; this.titles[this.links.length + i].textContent = said;
    });
    this.links.forEach(([a, b, conductance], i) => {
      const [from, to] = W[i] < 0 ? [b, a] : [a, b];
      this.lines[i].setAttribute("stroke", tint(data.power, Math.abs(W[i]) / this.most));
      this.titles[i].textContent = `${this.nodes[from].name} to ${this.nodes[to].name}: ${Math.abs(W[i]).toFixed(0)} W, ${conductance.toPrecision(2)} W/K`;
    });
  }
}
const SIDES = [  // of a dot, where its name may stand: pixels and widths to the right, pixels down
  [[13, 0], -7], [[-13, -1], -7], [[0, -0.5], -28], [[0, -0.5], 13], [[8, 0], -24], [[-8, -1], -24], [[8, 0], 9], [[-8, -1], 9],
  [[0, -0.5], -44], [[0, -0.5], 29],
];
const set = (element, values) => Object.entries(values).forEach(([k, v]) => element.setAttribute(k, v));
const tint = (palette, share) => {
  const k = 3 * Math.round(255 * Math.min(1, Math.max(0, share)));
  return `rgb(${palette.slice(k, k + 3)})`;
};
