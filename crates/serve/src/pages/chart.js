// Curves as SVG: lines, points with intervals, budgets dashed; zoom by dragging or + and -, back by a double click or 0. Charts of one
// page share a pointer: what it is at in one is read in all of them.
import { coded, make } from '/dom.js';
import { at, smoothed } from '/curves.js';
import { axis, logTicks, scale, short, ticks } from '/scale.js';
import { downloads, inks, path, redrawn, shape, standalone, text } from '/svg.js';

const LEFT = 62, RIGHT = 12, TOP = 10, BOTTOM = 44;

// What the charts of a page have in common.
export class Shared {
  constructor() { Object.assign(this, { charts: [], pointer: null, range: null, over: 'frames', smooth: 0, log: false, moment: null, selected: null }); }
  add(chart) { this.charts.push(chart); return chart; }
  clear() { this.charts.forEach((chart) => chart.end()); this.charts = []; }
  draw() { this.charts.forEach((chart) => chart.draw()); }
  point(x) { this.pointer = x; this.charts.forEach((chart) => chart.update_readout()); }
}

// A series: { name, colour, dash, x, y, half, kind: 'line', 'points' or 'thin' }. Thin lines are neither smoothed nor read out.
export class Chart {
  constructor(shared, { title, unit = '', what = title, note = '', file, onmoment }) {
    Object.assign(this, { shared, title, unit: unit && unit !== what.toLowerCase() ? `${what} (${unit})` : what, file, onmoment, series: [], budgets: [], places: null });
    this.svg = shape('svg', { class: 'chart', role: 'img', tabindex: 0, height: 260, 'aria-label': title });
    this.readout = make('div', { class: 'readout' });
    const saves = downloads(title, file, () => standalone(this.svg, title, this.legend()), () => this.rows());
    this.element = make('figure', { 'data-chart': file }, make('figcaption', {}, make('span', { class: 'row' }, make('b', {}, title), saves), make('span', { class: 'note' }, ...coded(note))), this.svg, this.readout);
    this.listen();
    this.stop = redrawn(this.svg, this.svg, () => this.draw());
  }

  end() { this.stop(); this.element.remove(); }

  listen() {
    const { svg, shared } = this;
    let from = null;
    const inside = (event) => event.clientX - svg.getBoundingClientRect().left;
    svg.addEventListener('pointerdown', (event) => { from = inside(event); svg.setPointerCapture?.(event.pointerId); });
    svg.addEventListener('pointerup', (event) => {
      if (from == null || !this.places) return;
      const [a, b] = [from, inside(event)].sort((one, other) => one - other).map((pixel) => this.places.x.back(pixel));
      const far = Math.abs(inside(event) - from) > 8;
      from = this.drag = null;
      if (far) { shared.range = [Math.max(a, this.span[0]), Math.min(b, this.span[1])]; shared.draw(); } else this.onmoment?.(a);
    });
    svg.addEventListener('pointermove', (event) => { this.drag = from; if (this.places) shared.point(this.places.x.back(inside(event))); });
    svg.addEventListener('pointerleave', () => shared.point(null));
    svg.addEventListener('dblclick', () => { shared.range = null; shared.draw(); });
    svg.addEventListener('keydown', (event) => this.key(event));
  }

  // + and - zoom about the middle, arrows move what is seen, 0 shows all.
  key(event) {
    if (!this.span || event.ctrlKey || event.metaKey || event.altKey) return;
    const { shared, span: [low, high] } = this;
    const [middle, half] = [(low + high) / 2, (high - low) / 2];
    const wanted = { '+': [0, 0.5], '=': [0, 0.5], '-': [0, 2], ArrowLeft: [-0.5, 1], ArrowRight: [0.5, 1], 0: null }[event.key];
    if (wanted === undefined) return;
    shared.range = wanted && [middle + (wanted[0] - wanted[1]) * half, middle + (wanted[0] + wanted[1]) * half].map((one) => Math.max(0, one));
    if (shared.range && shared.range[1] <= shared.range[0]) shared.range = null;
    event.preventDefault();
    shared.draw();
  }

  legend() { return this.drawn().filter((one) => one.kind !== 'thin').map(({ name, colour, dash }) => ({ name, colour, dash })); }

  // The numbers behind the picture, as they were reported.
  rows() {
    const over = axis(this.shared.over, 0).title.split(' (')[0];
    return [['series', over === 'time of training' ? 'seconds' : over, this.title, 'half width of the 95 % interval'],
      ...this.series.flatMap((one) => one.x.map((x, k) => [one.name, x, one.y[k], one.half?.[k] ?? '']))];
  }

  drawn() {
    const { smooth } = this.shared;
    return this.series.filter((one) => !one.hidden && one.x.length).map((one) => (one.kind ?? 'line') === 'line' ? { ...one, kind: 'line', raw: smooth ? one.y : null, y: smoothed(one.y, smooth) } : one);
  }

  draw() {
    const { svg, shared } = this;
    const width = svg.clientWidth;
    if (!width) return;
    const height = this.height = Math.round(Math.min(380, Math.max(240, 0.56 * width)));
    svg.setAttribute('width', width);
    svg.setAttribute('height', height);
    const ink = inks(svg);
    const drawn = this.drawn();
    const most = Math.max(1e-9, ...drawn.map((one) => one.x.at(-1)));
    const whole = axis(shared.over, most);
    const span = shared.range ?? [0, most];
    this.span = span;
    const seen = drawn.flatMap((one) => one.y.flatMap((y, k) => (one.x[k] < span[0] || one.x[k] > span[1] ? [] : one.half?.[k] && one.kind !== 'thin' ? [y - Math.min(one.half[k], Math.abs(y) || 1), y + Math.min(one.half[k], Math.abs(y) || 1)] : [y])));
    seen.push(...this.budgets.map((one) => one.value));
    const log = shared.log && seen.some((value) => value > 0);
    const positive = seen.filter((value) => value > 0);
    let [low, high] = log ? [Math.min(...positive) * 0.9, Math.max(...positive) * 1.1] : [Math.min(0, ...seen), Math.max(...seen, 1e-9)];
    if (!seen.length) [low, high] = [0, 1];
    // Where nothing is drawn, numbers on an axis would be made up.
    const rows = !seen.length ? [] : log ? logTicks(low, high) : ticks(low, high * 1.04);
    if (!log && rows.length) [low, high] = [Math.min(low, rows[0]), rows.at(-1)];
    const x = scale(span, [LEFT, width - RIGHT]), y = scale([low, high], [height - BOTTOM, TOP], log);
    this.places = { x, y, drawn, whole };
    const parts = [];
    for (const value of rows) parts.push(path([[LEFT, y(value)], [width - RIGHT, y(value)]], { stroke: ink.line }), text(short(value), LEFT - 6, y(value) + 4, ink.pale, { 'text-anchor': 'end' }));
    for (const tick of drawn.length ? ticks(span[0] / whole.per, span[1] / whole.per) : []) {
      const place = x(tick * whole.per);
      if (place < LEFT - 1 || place > width - RIGHT + 1) continue;
      parts.push(path([[place, height - BOTTOM], [place, height - BOTTOM + 4]], { stroke: ink.pale }), text(short(tick), place, height - BOTTOM + 17, ink.pale, { 'text-anchor': place > width - RIGHT - 16 ? 'end' : 'middle' }));
    }
    parts.push(text(whole.title, (LEFT + width - RIGHT) / 2, height - 8, ink.pale, { 'text-anchor': 'middle' }));
    const upright = `${this.unit}${log ? ' (log scale)' : ''}`;
    parts.push(text(upright, 0, 0, ink.pale, { 'text-anchor': 'middle', transform: `translate(14 ${(TOP + height - BOTTOM) / 2}) rotate(-90)` }));
    parts.push(this.plot(drawn, x, y, log, ink));
    svg.replaceChildren(...parts);
    this.update_readout();
  }

  plot(drawn, x, y, log, ink) {
    const [width, height] = [this.svg.clientWidth, this.height];
    const clip = `clip-${this.file}`;
    const plot = shape('g', { 'clip-path': `url(#${clip})` });
    plot.append(shape('clipPath', { id: clip }, shape('rect', { x: LEFT, y: TOP - 6, width: Math.max(0, width - LEFT - RIGHT + 6), height: height - BOTTOM - TOP + 6 })));
    const place = (one, values = one.y) => one.x.map((at_x, k) => [at_x, values[k]]).filter(([, value]) => value != null && (!log || value > 0)).map(([at_x, value]) => [x(at_x), y(value)]);
    for (const one of drawn.filter((other) => other.kind === 'thin')) plot.append(path(place(one), { stroke: one.colour, 'stroke-width': 0.9, opacity: 0.4 }));
    for (const one of drawn) {
      if (one.raw) plot.append(path(place(one, one.raw), { stroke: one.colour, 'stroke-width': 1, opacity: 0.25 }));
      if (one.kind === 'line' && one.half?.some((half) => half)) {
        const ends = (way) => one.x.map((at_x, k) => [x(at_x), y(Math.max(one.y[k] + way * (one.half[k] ?? 0), log ? 1e-12 : -Infinity))]);
        plot.append(path([...ends(1), ...ends(-1).reverse()], { fill: one.colour, opacity: 0.16 }));
      }
    }
    for (const one of drawn) {
      if (one.kind === 'line') plot.append(path(place(one), { stroke: one.colour, 'stroke-width': 2, 'stroke-dasharray': one.dash }));
      if (one.kind !== 'points') continue;
      plot.append(path(place(one), { stroke: one.colour, 'stroke-width': 1.5, 'stroke-dasharray': '3 3' }));
      one.x.forEach((at_x, k) => {
        if (log && one.y[k] <= 0) return;
        const half = one.half?.[k];
        if (half) plot.append(path([[x(at_x), y(Math.max(one.y[k] - half, log ? 1e-12 : -Infinity))], [x(at_x), y(one.y[k] + half)]], { stroke: one.colour, 'stroke-width': 1.5 }));
        plot.append(shape('circle', { cx: x(at_x), cy: y(one.y[k]), r: 4.5, fill: one.colour, stroke: ink.card, 'stroke-width': 1.5 }));
      });
    }
    for (const budget of this.budgets) {
      if (log && budget.value <= 0) continue;
      plot.append(path([[LEFT, y(budget.value)], [width - RIGHT, y(budget.value)]], { stroke: ink.bad, 'stroke-width': 1.5, 'stroke-dasharray': '6 4' }), text(budget.name, width - RIGHT - 4, y(budget.value) - 5, ink.bad, { 'text-anchor': 'end' }));
    }
    const { selected } = this.shared;
    if (selected != null) {
      const at_x = x(selected), end = at_x > width - 130;
      plot.append(path([[at_x, TOP], [at_x, height - BOTTOM]], { stroke: ink.good, 'stroke-width': 1.5, 'stroke-dasharray': '1 3' }), text('selected checkpoint', at_x + (end ? -5 : 5), TOP + 10, ink.good, { 'text-anchor': end ? 'end' : 'start', class: 'selected' }));
    }
    return plot;
  }

  // Lines at the pointer and at the moment of the heatmap, and what the curves are there, in words.
  update_readout() {
    if (!this.places) return;
    const { svg, shared, height, places: { x, drawn, whole } } = this;
    svg.querySelectorAll('.pointer').forEach((one) => one.remove());
    const ink = inks(svg);
    const line = (place, more) => svg.append(path([[x(place), TOP], [x(place), height - BOTTOM]], { class: 'pointer', stroke: ink.ink, ...more }));
    const inside = (place) => place != null && place >= this.span[0] && place <= this.span[1];
    if (inside(shared.moment)) line(shared.moment, { 'stroke-width': 2, opacity: 0.5 });
    const pointed = inside(shared.pointer) ? shared.pointer : null;
    if (pointed != null) line(pointed, { 'stroke-width': 1 });
    if (this.drag != null && pointed != null) {
      const [a, b] = [this.drag, x(pointed)].sort((one, other) => one - other);
      svg.append(shape('rect', { class: 'pointer', x: a, y: TOP, width: b - a, height: height - BOTTOM - TOP, fill: ink.pale, opacity: 0.2 }));
    }
    const read = drawn.filter((one) => one.kind !== 'thin').map((one) => {
      const value = pointed == null ? one.y.at(-1) : one.kind === 'points' ? one.y[nearest(one.x, pointed)] : at(one, pointed);
      const k = pointed == null ? one.x.length - 1 : nearest(one.x, pointed);
      const half = value != null && one.half?.[k] ? ` ± ${short(one.half[k])}` : '';
      if (pointed != null && value != null && one.kind === 'line') svg.append(shape('circle', { class: 'pointer', cx: x(pointed), cy: this.places.y(value), r: 3.5, fill: one.colour }));
      return make('span', {}, make('b', { 'aria-hidden': 'true', style: `color:${one.colour}` }, one.kind === 'points' ? '● ' : '━ '), `${one.name} ${short(value)}${half}`);
    });
    const where = pointed == null ? 'at the end' : `at ${short(pointed / whole.per)}`;
    this.readout.replaceChildren(...(read.length ? [make('span', {}, where), ...read.slice(0, 8)] : [make('span', {}, 'not reported')]));
    svg.setAttribute('aria-description', this.readout.textContent);
  }
}

export function nearest(values, wanted) {
  return values.reduce((best, one, k) => (Math.abs(one - wanted) < Math.abs(values[best] - wanted) ? k : best), 0);
}
