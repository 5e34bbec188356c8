import { make, number } from '/dom.js';

// Costs in a row of one kind are one event: ten steps in lava are one fall.
function folded(events) {
  const open = new Map(), all = [];
  for (const event of events) {
    const last = open.get(event.what);
    if (last && event.kind !== 'reward' && event.step === last.until + 1) { last.until = event.step; last.size += event.size; continue; }
    const one = { ...event, until: event.step };
    open.set(event.what, one);
    all.push(one);
  }
  return all;
}

// An episode as far as it is known: return, cost and budget over its steps, and its events, where a click jumps to.
export class Timeline {
  constructor(jump) {
    this.jump = jump;
    this.slide = make('input', { type: 'range', min: 0, max: 525, value: 0, 'aria-label': 'Step', oninput: () => jump(Number(this.slide.value)) });
    this.line = make('canvas', { class: 'line', role: 'img', 'aria-label': 'Time line: return, cost, rewards and costs; click to jump', onclick: (event) => jump(Math.round((event.offsetX / this.line.clientWidth) * this.slide.max)) });
    this.events = make('div', { class: 'events', id: 'events' });
    this.key = make('p', { class: 'pale key' }, make('b', { class: 'good', 'aria-hidden': 'true' }, '━ '), 'return, ', make('b', { class: 'bad', 'aria-hidden': 'true' }, '━ '), 'cost, dashed its budget; marks: rewards and costs');
    this.begin({ length: 525, budget: 0 });
    new ResizeObserver(() => this.draw()).observe(this.line);
  }

  begin(scene) {
    Object.assign(this, { scene, step: 0, returns: [], costs: [], known: [] });
    this.slide.max = scene.length;
    this.events.replaceChildren(make('span', { class: 'pale' }, 'None yet.'));
  }

  steps({ from, returns, costs, events, over }) {
    this.returns.splice(from, Infinity, ...returns);
    this.costs.splice(from, Infinity, ...costs);
    this.known = [...this.known.filter((event) => event.step <= from), ...events];
    if (over) this.slide.max = this.returns.length;
    const button = (event) => make('button', { class: { cost: 'bad', reward: 'good' }[event.kind] ?? 'pale', 'data-kind': event.kind, 'data-step': event.step, onclick: () => this.jump(event.step - 1) },
      `${event.until > event.step ? `${event.step}–${event.until}` : event.step}: ${event.what.replaceAll('_', ' ')} ${number(event.size)}`);
    const order = (event) => (event.kind === 'noted' ? 1 : 0);
    const buttons = folded(this.known).sort((a, b) => order(a) - order(b) || a.step - b.step).slice(0, 500).map(button);
    if (buttons.length) this.events.replaceChildren(...buttons);
    else if (over) this.events.replaceChildren(make('span', { class: 'pale' }, 'No reward and no cost.'));
    this.draw();
  }

  at(step) {
    this.step = step;
    if (document.activeElement !== this.slide) this.slide.value = step;
    this.draw();
  }

  draw() {
    const { line } = this;
    const [width, height] = [(line.width = line.clientWidth * devicePixelRatio), (line.height = line.clientHeight * devicePixelRatio)];
    const pen = line.getContext('2d');
    const style = getComputedStyle(line);
    const [good, bad, ink] = ['--good', '--bad', '--ink'].map((name) => style.getPropertyValue(name));
    const x = (at) => (at / this.slide.max) * width;
    const y = (value, top) => height - 14 - (value / top) * (height - 22);
    pen.lineWidth = 2;
    const curve = (values, top, colour) => {
      pen.strokeStyle = colour;
      pen.beginPath();
      values.forEach((value, k) => pen.lineTo(x(k + 1), y(value, top)));
      pen.stroke();
    };
    curve(this.returns, Math.max(1, ...this.returns), good);
    const most = Math.max(this.scene.budget, 1, ...this.costs);
    curve(this.costs, most, bad);
    pen.setLineDash([6, 4]);
    curve([this.scene.budget, ...Array(Number(this.slide.max)).fill(this.scene.budget)], most, bad);
    pen.setLineDash([]);
    for (const event of this.known.filter((one) => one.kind !== 'noted')) {
      pen.fillStyle = event.kind === 'cost' ? bad : good;
      pen.fillRect(x(event.step) - 1, event.kind === 'cost' ? height - 12 : height - 6, 3, 6);
    }
    pen.fillStyle = ink;
    pen.fillRect(x(this.step) - 1, 0, 2, height);
  }
}
