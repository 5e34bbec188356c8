// Curves on a canvas: a line a run, or mean and 95 % confidence over seeds; the budget dashed; zoom by dragging, back by a double click.
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

export class Chart {
  constructor(canvas, onmoment) {
    this.canvas = canvas;
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
      from = null;
      this.draw();
    });
    canvas.addEventListener('dblclick', () => { this.range = null; this.draw(); });
    new ResizeObserver(() => this.draw()).observe(canvas);
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
    pen.font = '12px system-ui';
    const curves = this.curves.map((curve) => ({ ...curve, y: smoothed(curve.y, this.smooth), half: null }));
    const drawn = this.bySeeds ? grouped(curves) : curves;
    const span = this.range ?? [0, Math.max(1, ...drawn.map((curve) => curve.x.at(-1) ?? 0))];
    this.span = span;
    const seen = drawn.flatMap((curve) => curve.y.filter((y, k) => y != null && curve.x[k] >= span[0] && curve.x[k] <= span[1]));
    if (this.budget != null) seen.push(this.budget);
    let [low, high] = [Math.min(0, ...seen), Math.max(...seen, 1e-9) * 1.05];
    if (!seen.length) [low, high] = [0, 1];
    const x = (frames) => 48 + ((frames - span[0]) / (span[1] - span[0])) * (width - 58);
    const y = (value) => height - 22 - ((value - low) / (high - low)) * (height - 32);
    pen.lineWidth = 1;
    pen.fillStyle = ink;
    for (let k = 0; k <= 4; k += 1) {
      const value = low + ((high - low) * k) / 4;
      pen.strokeStyle = line;
      pen.beginPath();
      pen.moveTo(48, y(value));
      pen.lineTo(width - 10, y(value));
      pen.stroke();
      pen.textAlign = 'right';
      pen.fillText(value.toPrecision(3).replace(/\.?0+$/, ''), 44, y(value) + 4);
      pen.textAlign = 'center';
      const frames = span[0] + ((span[1] - span[0]) * k) / 4;
      pen.fillText(Intl.NumberFormat('en', { notation: 'compact' }).format(frames), Math.min(x(frames), width - 22), height - 5);
    }
    pen.save();
    pen.beginPath();
    pen.rect(48, 0, width - 58, height - 20);
    pen.clip();
    drawn.forEach((curve, index) => {
      pen.strokeStyle = pen.fillStyle = colour(index);
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
    pen.restore();
  }
}
