import { ask, make, number } from '/dom.js';
import { Chart } from '/chart.js';

const COLUMNS = ['return_mean', 'cost_mean', 'fps', 'multiplier'];

// One run: its curves, the heatmap at a moment chosen on them, settings and how they differ from another run's.
export function run(main, query) {
  const id = query.get('id') ?? '';
  let gone = false, timer;
  const title = make('h1', {}, 'Run');
  const links = make('p', { class: 'row' }, make('a', { href: `#watch?agent=run:${id}` }, 'Watch its agent'), make('a', { href: `/api/report?runs=${id}`, target: '_blank' }, 'Report'), make('a', { href: '#runs' }, 'All runs'));
  const map = make('canvas', { width: 480, height: 480, role: 'img', 'aria-label': 'Where the agent was' });
  const caption = make('figcaption', {}, 'No heatmap yet.');
  const charts = COLUMNS.map((name) => {
    const canvas = make('canvas', { class: 'chart', role: 'img', 'aria-label': `Curve of ${name} over frames` });
    return { name, canvas, chart: new Chart(canvas, (frames) => heatmap(frames)) };
  });
  const settings = make('tbody');
  main.append(make('section', { class: 'card' }, title, links, make('div', { class: 'charts' }, ...charts.map(({ name, canvas }) => make('figure', {}, make('figcaption', {}, name), canvas)))),
    make('section', { class: 'card' }, make('h2', {}, 'Where it was'), make('p', { class: 'pale' }, 'Click a curve to choose the moment.'), make('figure', {}, map, caption)),
    make('section', { class: 'card' }, make('h2', {}, 'Settings'), make('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Settings' }, make('table', {}, settings))));

  let moments = [], shown = -1;
  async function heatmap(frames) {
    if (!moments.length) return;
    const at = moments.reduce((best, moment, k) => (Math.abs(moment - frames) < Math.abs(moments[best] - frames) ? k : best), 0);
    if (at === shown) return;
    shown = at;
    const heat = await ask(`/api/heatmap?id=${id}&at=${at}`);
    if (!heat || gone) return;
    const pen = map.getContext('2d');
    const ground = await fetch(`/api/automap?id=${id}`).then((answer) => (answer.ok ? answer.blob() : null)).then((blob) => blob && createImageBitmap(blob)).catch(() => null);
    map.height = Math.round((map.width * heat.rows) / heat.columns);
    if (ground) pen.drawImage(ground, 0, 0, map.width, map.height);
    const most = Math.log1p(Math.max(...heat.steps, 1));
    const [w, h] = [map.width / heat.columns, map.height / heat.rows];
    heat.steps.forEach((steps, k) => {
      if (!steps) return;
      const share = Math.log1p(steps) / most;
      pen.fillStyle = `hsl(${60 - 60 * share} 100% 50% / ${0.25 + 0.65 * share})`;
      pen.fillRect((k % heat.columns) * w, Math.floor(k / heat.columns) * h, Math.ceil(w), Math.ceil(h));
    });
    caption.textContent = `At ${number(heat.frames, 0)} frames, steps of the latest ${heat.episodes} episodes.`;
  }

  function flat(value, name, out) {
    if (value && typeof value === 'object') for (const [key, inner] of Object.entries(value)) flat(inner, name ? `${name}.${key}` : key, out);
    else out.push([name, String(value)]);
    return out;
  }

  async function look() {
    try {
      const [detail, list, data] = await Promise.all([ask(`/api/run?id=${id}`), ask('/api/runs'), ask(`/api/curves?runs=${id}&columns=${COLUMNS.join(',')}`)]);
      if (gone || !detail || !list || !data) return;
      const me = list.runs.find((one) => one.id === id);
      title.textContent = me ? `${me.name}: ${me.algo} in ${me.env}` : 'Run';
      for (const { name, chart } of charts) {
        chart.budget = name === 'cost_mean' ? me?.budget : null;
        chart.curves = [{ name, group: name, x: data[id]?.frames ?? [], y: data[id]?.[name] ?? [] }];
        chart.draw();
      }
      moments = detail.heatmaps;
      if (shown < 0 && moments.length) heatmap(moments.at(-1));
      if (!settings.childElementCount) settings.append(...flat(detail.config, '', []).map(([name, value]) => make('tr', {}, make('th', { scope: 'row' }, name), make('td', {}, value))));
    } catch (error) {
      title.textContent = error.message;
    } finally {
      if (!gone) timer = setTimeout(look, 2000);
    }
  }
  look();
  return () => { gone = true; clearTimeout(timer); };
}
