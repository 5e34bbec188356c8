// Where the agent was: the share of steps in each place over the map, at a moment of training, or how it changed since another.
import { ask, choose, field, make, number } from '/dom.js';
import { short } from '/scale.js';

// As in the report: dark violet, magenta, orange, pale yellow, over the root of the share of the most visited place.
const HEAT = [[48, 18, 110], [140, 30, 130], [225, 70, 85], [252, 160, 60], [254, 246, 180]];
// Less and more.
const LESS = [56, 135, 225], MORE = [240, 120, 30];

// Milliseconds of a moment in the film through training.
const STAY = 250;

export function heat_colour(heat) {
  const place = Math.min(1, Math.max(0, heat)) * (HEAT.length - 1);
  const low = Math.min(HEAT.length - 2, Math.floor(place));
  return HEAT[low].map((value, k) => Math.round(value + (HEAT[low + 1][k] - value) * (place - low)));
}

// Colour and opacity of each cell, in rows from the north: rows of a heatmap begin in the south.
export function cells(heat, before, most) {
  const shares = (one) => { const all = one.steps.reduce((sum, steps) => sum + steps, 0) || 1; return one.steps.map((steps) => steps / all); };
  const now = shares(heat), then = before && shares(before);
  const value = now.map((share, k) => share - (then ? then[k] : 0));
  most ??= Math.max(...value.map(Math.abs), 1e-12);
  const paint = (k) => {
    const part = Math.sqrt(Math.min(1, Math.abs(value[k]) / most));
    if (!part) return null;
    return [...(then ? (value[k] > 0 ? MORE : LESS) : heat_colour(part)), (110 + 110 * part) / 255];
  };
  const { rows, columns } = heat;
  return { most, colours: Array.from({ length: rows * columns }, (_, k) => paint((rows - 1 - Math.floor(k / columns)) * columns + (k % columns))) };
}

export class Heatmap {
  constructor(id, onmoment) {
    Object.assign(this, { id, onmoment, moments: [], shown: -1, against: '', grounds: new Map(), known: new Map() });
    this.canvas = make('canvas', { width: 720, height: 720, class: 'map', role: 'img', 'aria-label': 'Visited positions over the map' });
    this.bar = make('canvas', { width: 256, height: 1, class: 'colours', 'aria-hidden': 'true' });
    this.ends = [make('span'), make('span'), make('span')];
    this.caption = make('figcaption', {}, 'No heatmap yet: a training writes them as it goes.');
    this.slide = make('input', { type: 'range', min: 0, max: 0, value: 0, 'aria-label': 'Moment of the heatmap', disabled: true, oninput: () => this.show(Number(this.slide.value)) });
    this.other = make('span');
    this.film = make('button', { id: 'heat-film', disabled: true, onclick: () => this.play() }, 'Play through training');
    const scale = make('div', { class: 'scale' }, make('div', {}, this.bar, make('div', { class: 'ends' }, ...this.ends)), make('span', { class: 'note', id: 'heat-unit' }, ''));
    this.element = make('div', { class: 'card heat' }, make('h2', {}, 'Visited positions'), make('p', { class: 'pale' }, 'Click a curve to choose the moment, or move this:'), this.slide, make('div', { class: 'row' }, field('compare with', this.other), this.film), make('figure', {}, this.canvas, scale, this.caption));
  }

  // The moments there are now.
  set(moments) {
    const newest = this.shown === this.moments.length - 1;
    const grown = moments.length !== this.moments.length;
    this.moments = moments;
    this.slide.max = Math.max(0, moments.length - 1);
    this.slide.disabled = moments.length < 2;
    this.film.disabled = moments.length < 2;
    if (grown) this.other.replaceChildren(choose([['', 'nothing'], ...moments.map((frames, k) => [String(k), `the moment at ${short(frames)} frames`])], this.against, (value) => { this.against = value; const at = this.shown; this.shown = -1; this.show(at); }));
    // Who looks at the newest goes on doing so.
    if (moments.length && newest) this.show(moments.length - 1);
  }

  // Shows the moments one after the other, from the first if the last is shown; again, and it stops.
  async play() {
    if (this.playing) { this.playing = false; return; }
    this.playing = true;
    this.film.textContent = 'Stop';
    let at = this.shown >= this.moments.length - 1 ? 0 : this.shown;
    while (this.playing && this.element.isConnected && at < this.moments.length) {
      const turn = new Promise((done) => { setTimeout(done, STAY); });
      await this.show(at);
      await turn;
      at += 1;
    }
    this.playing = false;
    this.film.textContent = 'Play through training';
  }

  at_frames(frames) {
    if (this.moments.length) this.show(this.moments.reduce((best, one, k) => (Math.abs(one - frames) < Math.abs(this.moments[best] - frames) ? k : best), 0));
  }

  async heat(at) {
    const name = `${at} ${this.moments[at]}`;
    if (!this.known.has(name)) this.known.set(name, await ask(`/api/heatmap?id=${this.id}&at=${at}`));
    return this.known.get(name);
  }

  async ground(heat, at) {
    const name = heat.automap ?? '';
    if (!name) return null;
    if (!this.grounds.has(name)) {
      const blob = await fetch(`/api/automap?id=${this.id}&at=${at}`).then((answer) => (answer.ok ? answer.blob() : null)).catch(() => null);
      this.grounds.set(name, blob && (await createImageBitmap(blob).catch(() => null)));
    }
    return this.grounds.get(name);
  }

  async show(at) {
    if (at === this.shown) return;
    this.shown = at;
    this.slide.value = at;
    const heat = await this.heat(at);
    const before = this.against === '' || Number(this.against) === at ? null : await this.heat(Number(this.against));
    const ground = heat && (await this.ground(heat, at));
    if (!heat || at !== this.shown || !this.element.isConnected) return;
    const { canvas } = this;
    canvas.height = Math.round((canvas.width * (heat.extent[3] - heat.extent[1])) / (heat.extent[2] - heat.extent[0]));
    const pen = canvas.getContext('2d');
    pen.fillStyle = '#1c1e24';
    pen.fillRect(0, 0, canvas.width, canvas.height);
    if (ground) pen.drawImage(ground, 0, 0, canvas.width, canvas.height);
    const alike = before && before.steps.length === heat.steps.length ? before : null;
    const { most, colours } = cells(heat, alike);
    const [w, h] = [canvas.width / heat.columns, canvas.height / heat.rows];
    colours.forEach((colour, k) => {
      if (!colour) return;
      pen.fillStyle = `rgba(${colour[0]} ${colour[1]} ${colour[2]} / ${colour[3]})`;
      const [left, top] = [(k % heat.columns) * w, Math.floor(k / heat.columns) * h];
      pen.fillRect(Math.round(left), Math.round(top), Math.round(left + w) - Math.round(left), Math.round(top + h) - Math.round(top));
    });
    this.legend(most, Boolean(alike));
    this.caption.textContent = alike ? `From ${short(alike.frames)} to ${short(heat.frames)} frames: orange places are visited more, blue ones less.` : `At ${number(heat.frames, 0)} frames: share of the steps of the latest ${heat.episodes} episodes in each place.`;
    this.onmoment(heat.frames);
  }

  // What the colours mean, with the root scale's own places.
  legend(most, difference) {
    const pen = this.bar.getContext('2d');
    for (let k = 0; k < 256; k += 1) {
      const colour = difference ? (k < 128 ? LESS : MORE) : heat_colour(k / 255);
      const part = difference ? Math.abs(k - 127.5) / 127.5 : 1;
      pen.clearRect(k, 0, 1, 1);
      pen.fillStyle = `rgba(${colour} / ${part})`.replaceAll(',', ' ');
      pen.fillRect(k, 0, 1, 1);
    }
    const percent = (share) => `${short(100 * share)} %`;
    const words = difference ? [`−${percent(most)}`, '0', `+${percent(most)}`] : ['0 %', percent(most / 4), percent(most)];
    this.ends.forEach((end, k) => { end.textContent = words[k]; });
    document.getElementById('heat-unit').textContent = difference ? 'change of the share of steps in a place (root scale)' : 'share of steps in a place (root scale)';
  }
}
