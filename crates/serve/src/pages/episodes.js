// An agent's episodes at a glance: a dot each, its cost across, its return up. A click shows the episode.
import { ask, make, number } from '/dom.js';
import { scale, short, ticks } from '/scale.js';
import { inks, path, redrawn, shape, text } from '/svg.js';

const LEFT = 46, RIGHT = 12, TOP = 10, BOTTOM = 34, HEIGHT = 150;
// Episodes that are acted out where a run's closing evaluation is not at hand.
const ACTED = 20;

// The best within the budget (or the one that is least over), the worst, the most costly.
export function remarkable(rows, budget) {
  const most = (value) => rows.reduce((best, row) => (best && value(best) >= value(row) ? best : row), null);
  const within = rows.some((row) => row.cost <= budget);
  return { best: most((row) => (within ? (row.cost <= budget ? row.return : -Infinity) : -row.cost)), worst: most((row) => -row.return), costly: most((row) => row.cost) };
}

export class Episodes {
  constructor(onpick) {
    Object.assign(this, { onpick, rows: [], seed: '', budget: 0, path: '', number: 0 });
    this.svg = shape('svg', { class: 'chart', role: 'img', height: HEIGHT, 'aria-label': 'Episodes: cost across, return up; click one to watch it' });
    this.words = make('p', { class: 'pale', role: 'status' });
    const to = (name, title, which) => make('button', { id: `episode-${which}`, title, onclick: () => { const row = remarkable(this.rows, this.budget)[which]; if (row) this.onpick(row.seed); } }, name);
    this.buttons = make('span', { class: 'row' }, to('Best', 'Most return within the budget', 'best'), to('Worst', 'Least return', 'worst'), to('Most costly', 'Most cost', 'costly'));
    this.act = make('button', { id: 'act', onclick: () => this.play() }, `Play ${ACTED} episodes`);
    this.element = make('div', { id: 'episodes' }, make('h2', {}, 'Episodes'), this.words, this.svg, make('div', { class: 'row' }, this.buttons, this.act));
    redrawn(this.svg, this.element, () => this.draw());
  }

  // Of the agent of a link.
  async of(path, seed) {
    this.seed = seed;
    if (path === this.path) { this.draw(); return; }
    Object.assign(this, { path, rows: [] });
    await this.load(path, '');
  }

  async play() {
    this.act.disabled = true;
    this.words.textContent = 'Playing; some seconds.';
    await this.load(this.path, `&act=${ACTED}`);
    this.act.disabled = false;
  }

  async load(path, more) {
    const asked = (this.number += 1);
    const answer = await ask(`/api/episodes?${path}${more}`).catch((error) => ({ rows: [], why: error.message }));
    if (asked !== this.number || path !== this.path || !answer) return;
    this.rows = answer.rows;
    this.source = answer.why ?? (answer.source === 'closing' ? 'closing episodes of the selected checkpoint' : 'episodes, seeds in a row');
    this.draw();
  }

  at(seed, budget) {
    Object.assign(this, { seed, budget });
    this.draw();
  }

  draw() {
    const { rows, svg, budget } = this;
    svg.toggleAttribute('hidden', !rows.length);
    this.buttons.hidden = !rows.length;
    this.act.hidden = rows.length > 0 || !this.path;
    if (!rows.length) { this.words.textContent = this.act.disabled ? this.words.textContent : this.source?.includes(' ') && !/episodes/.test(this.source) ? this.source : 'None are kept for this one.'; return; }
    const within = rows.filter((row) => row.cost <= budget).length;
    this.words.textContent = `${rows.length} ${this.source}: ${within} within the budget. Click one to watch it.`;
    const width = svg.clientWidth;
    if (!width) return;
    svg.setAttribute('width', width);
    const ink = inks(svg);
    const [costs, returns] = [rows.map((row) => row.cost), rows.map((row) => row.return)];
    const across = ticks(0, Math.max(...costs, budget, 1e-9) * 1.05), up = ticks(Math.min(0, ...returns), Math.max(...returns, 1e-9) * 1.05);
    const x = scale([across[0], across.at(-1)], [LEFT, width - RIGHT]), y = scale([up[0], up.at(-1)], [HEIGHT - BOTTOM, TOP]);
    const parts = [];
    up.forEach((value, k) => { if (k % 2 === 0) parts.push(path([[LEFT, y(value)], [width - RIGHT, y(value)]], { stroke: ink.line }), text(short(value), LEFT - 6, y(value) + 4, ink.pale, { 'text-anchor': 'end' })); });
    across.forEach((value, k) => { if (k % 2 === 0) parts.push(text(short(value), x(value), HEIGHT - BOTTOM + 15, ink.pale, { 'text-anchor': 'middle' })); });
    parts.push(text('cost', (LEFT + width) / 2, HEIGHT - 4, ink.pale, { 'text-anchor': 'middle' }), text('return', 0, 0, ink.pale, { 'text-anchor': 'middle', transform: `translate(12 ${(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)` }));
    parts.push(path([[x(budget), TOP], [x(budget), HEIGHT - BOTTOM]], { stroke: ink.bad, 'stroke-width': 1.5, 'stroke-dasharray': '6 4' }));
    for (const row of rows) {
      const here = row.seed === this.seed;
      const dot = shape('circle', { cx: x(row.cost), cy: y(row.return), r: here ? 6 : 4, fill: row.cost <= budget ? ink.good : ink.bad, 'fill-opacity': here ? 1 : 0.55, stroke: here ? ink.ink : ink.card, 'stroke-width': here ? 2 : 1, 'data-seed': row.seed, style: 'cursor:pointer' }, shape('title', {}, `seed ${row.seed}: return ${number(row.return)}, cost ${number(row.cost)}`));
      dot.addEventListener('click', () => this.onpick(row.seed));
      parts.push(dot);
    }
    svg.replaceChildren(...parts);
  }
}
