// Curves on a canvas: a line a run, or mean and 95 % confidence over seeds; the budget dashed; zoom by dragging or + and -, back by a
// double click or 0. What the curves are at the pointer is told in words.
import { make } from '/dom.js';

const COLOURS = ['#2f6dbd', '#d1651b', '#2e8b57', '#9a4fb5', '#b8860b', '#c2326e', '#3f8f9b', '#7a6a53'];
// Student's t at 97.5 %, for 1 to 10 degrees of freedom.
const T = [12.71, 4.3, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26, 2.23];

export function colour(index) {
  return COLOURS[index % COLOURS.length];
}

function smoothed(values, weight) {
  let last = null;
  return values.map((value) => {
    if (value == null) return null;
    last = last == null ? value : weight * last + (1 - weight) * value;
    return last;
  });
}

function at(curve, frames) {
  const { x, y } = curve;
  if (!x.length || frames < x[0] || frames > x[x.length - 1]) return null;
  let high = x.findIndex((value) => value >= frames);
  if (high <= 0) return y[0];
  const share = (frames - x[high - 1]) / (x[high] - x[high - 1]);
  return y[high - 1] == null || y[high] == null ? null : y[high - 1] + share * (y[high] - y[high - 1]);
}

// Curves of equal group as mean and half width of its confidence.
function grouped(curves) {
  const groups = Map.groupBy ? Map.groupBy(curves, (curve) => curve.group) : curves.reduce((map, curve) => map.set(curve.group, [...(map.get(curve.group) ?? []), curve]), new Map());
  return [...groups].map(([name, all]) => {
    const end = Math.max(...all.map((curve) => curve.x.at(-1) ?? 0));
    const x = Array.from({ length: 121 }, (_, k) => (end * k) / 120);
    const y = [], half = [];
    for (const frames of x) {
      const values = all.map((curve) => at(curve, frames)).filter((value) => value != null);
      const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
      const variance = values.reduce((sum, value) => sum + (value - mean) ** 2, 0) / (values.length - 1);
      y.push(values.length ? mean : null);
      half.push(values.length > 1 ? (T[values.length - 2] ?? 1.96) * Math.sqrt(variance / values.length) : 0);
    }
    return { name: `${name} (${all.length})`, x, y, half };
  });
}

const frames_text = (frames) => Intl.NumberFormat('en', { notation: 'compact' }).format(frames);
const value_text = (value) => Number(value.toPrecision(3)).toLocaleString('en');

// Round values from below `low` to above `high`, four to nine of them.
function ticks(low, high) {
  const rough = (high - low) / 5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 2.5, 5, 10].find((one) => one * power >= rough);
  return Array.from({ length: Math.ceil(high / step) - Math.floor(low / step) + 1 }, (_, k) => (Math.floor(low / step) + k) * step);
}

// A chart with its caption, which tells what the curves are at the pointer.
export function chart(name, title, onmoment) {
  const canvas = make('canvas', { class: 'chart', role: 'img', tabindex: 0, 'aria-label': `${title} over frames` });
  const told = make('span', { class: 'told' });
  return { name, chart: new Chart(canvas, told, onmoment), figure: make('figure', {}, make('figcaption', {}, make('b', {}, title), told), canvas) };
}

export class Chart {
  constructor(canvas, told, onmoment) {
    Object.assign(this, { canvas, told, moment: null, pointer: null });
    this.curves = [];
    this.range = null;
    this.smooth = 0;
    this.bySeeds = false;
    let from = null;
    canvas.addEventListener('pointerdown', (event) => { from = event.offsetX; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener('pointerup', (event) => {
      if (from == null || !this.span) return;
      const [a, b] = [this.framesAt(Math.min(from, event.offsetX)), this.framesAt(Math.max(from, event.offsetX))];
      if (Math.abs(event.offsetX - from) > 8) this.range = [a, b];
      else onmoment?.(a);
      from = this.drag = null;
      this.draw();
    });
    canvas.addEventListener('dblclick', () => { this.range = null; this.draw(); });
    canvas.addEventListener('pointermove', (event) => { this.pointer = event.offsetX; this.drag = from; this.draw(); });
    canvas.addEventListener('pointerleave', () => { this.pointer = null; this.draw(); });
    canvas.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  // + and - zoom about the middle, arrows move what is seen, 0 shows all.
  key(event) {
    if (!this.span || event.ctrlKey || event.metaKey || event.altKey) return;
    const [low, high] = this.span;
    const [middle, half] = [(low + high) / 2, (high - low) / 2];
    const wanted = { '+': [0, 0.5], '=': [0, 0.5], '-': [0, 2], ArrowLeft: [-0.5, 1], ArrowRight: [0.5, 1], 0: null }[event.key];
    if (wanted === undefined) return;
    this.range = wanted && [middle + (wanted[0] - wanted[1]) * half, middle + (wanted[0] + wanted[1]) * half].map((frames) => Math.max(0, frames));
    if (this.range && this.range[1] <= this.range[0]) this.range = null;
    event.preventDefault();
    this.draw();
  }

  // The line at a moment, and what the curves are there.
  tell(pen, drawn, x, height) {
    const [, , ink] = this.inks;
    const line = (frames, width) => {
      pen.fillStyle = ink;
      pen.fillRect(x(frames) - width / 2, 8, width, height - 30);
    };
    if (this.moment != null) line(this.moment, 2);
    const at_pointer = this.pointer != null && this.pointer > 46;
    const frames = at_pointer ? this.framesAt(this.pointer) : Math.max(0, ...drawn.map((curve) => curve.x.at(-1) ?? 0));
    if (at_pointer) line(frames, 1);
    // Without a pointer, where each curve ends.
    const value = (curve) => (at_pointer ? at(curve, frames) : curve.y.findLast((one) => one != null));
    const values = drawn.slice(0, 4).map(value).map((one) => (one == null ? '–' : value_text(one)));
    this.told.textContent = drawn.length ? ` ${values.join(' · ')}${drawn.length > 4 ? ' …' : ''} at ${at_pointer ? '' : 'the end, '}${frames_text(frames)} frames` : '';
    this.canvas.setAttribute('aria-description', this.told.textContent);
  }

  framesAt(pixel) {
    const [low, high] = this.span;
    return low + ((pixel - 48) / (this.canvas.clientWidth - 58)) * (high - low);
  }

  draw() {
    const { canvas } = this;
    const [width, height, scale] = [canvas.clientWidth, canvas.clientHeight, devicePixelRatio || 1];
    canvas.width = width * scale;
    canvas.height = height * scale;
    const pen = canvas.getContext('2d');
    pen.scale(scale, scale);
    const style = getComputedStyle(canvas);
    const [ink, line, bad] = ['--pale', '--line', '--bad'].map((name) => style.getPropertyValue(name));
    this.inks = [line, bad, ink];
    pen.font = '12px system-ui';
    const curves = this.curves.map((curve) => ({ ...curve, y: smoothed(curve.y, this.smooth), half: null }));
    const drawn = this.bySeeds ? grouped(curves) : curves;
    const span = this.range ?? [0, Math.max(1, ...drawn.map((curve) => curve.x.at(-1) ?? 0))];
    this.span = span;
    const seen = drawn.flatMap((curve) => curve.y.filter((y, k) => y != null && curve.x[k] >= span[0] && curve.x[k] <= span[1]));
    if (this.budget != null) seen.push(this.budget);
    let [low, high] = [Math.min(0, ...seen), Math.max(...seen, 1e-9) * 1.05];
    if (!seen.length) [low, high] = [0, 1];
    const rows = ticks(low, high);
    [low, high] = [Math.min(low, rows[0]), Math.max(high, rows.at(-1))];
    const x = (frames) => 48 + ((frames - span[0]) / (span[1] - span[0])) * (width - 58);
    const y = (value) => height - 22 - ((value - low) / (high - low)) * (height - 32);
    pen.lineWidth = 1;
    pen.fillStyle = ink;
    for (const value of rows) {
      pen.strokeStyle = line;
      pen.beginPath();
      pen.moveTo(48, y(value));
      pen.lineTo(width - 10, y(value));
      pen.stroke();
      pen.textAlign = 'right';
      pen.fillText(Math.abs(value) >= 10000 ? frames_text(value) : value_text(value), 44, y(value) + 4);
    }
    pen.textAlign = 'center';
    for (const frames of ticks(...span).filter((one) => one >= span[0] && one <= span[1])) pen.fillText(frames_text(frames), Math.min(x(frames), width - 18), height - 5);
    pen.save();
    pen.beginPath();
    pen.rect(48, 0, width - 58, height - 20);
    pen.clip();
    drawn.forEach((curve, index) => {
      pen.strokeStyle = pen.fillStyle = colour(curve.place ?? index);
      const points = curve.x.map((frames, k) => [frames, curve.y[k], curve.half?.[k] ?? 0]).filter(([, value]) => value != null);
      if (this.bySeeds) {
        pen.globalAlpha = 0.2;
        pen.beginPath();
        for (const [frames, value, half] of points) pen.lineTo(x(frames), y(value + half));
        for (const [frames, value, half] of points.toReversed()) pen.lineTo(x(frames), y(value - half));
        pen.fill();
        pen.globalAlpha = 1;
      }
      pen.lineWidth = 1.8;
      pen.beginPath();
      for (const [frames, value] of points) pen.lineTo(x(frames), y(value));
      pen.stroke();
    });
    if (this.budget != null) {
      pen.strokeStyle = bad;
      pen.setLineDash([6, 4]);
      pen.beginPath();
      pen.moveTo(48, y(this.budget));
      pen.lineTo(width, y(this.budget));
      pen.stroke();
    }
    if (this.drag != null && this.pointer != null) {
      pen.fillStyle = ink;
      pen.globalAlpha = 0.2;
      pen.fillRect(Math.min(this.drag, this.pointer), 0, Math.abs(this.pointer - this.drag), height);
      pen.globalAlpha = 1;
    }
    this.tell(pen, drawn, x, height);
    pen.restore();
  }
}
