import { ask, choose, field, make, number } from '/dom.js';
import { chart } from '/chart.js';
import { settingsTable } from '/settings.js';

const CURVES = [['return_mean', 'return'], ['cost_mean', 'cost'], ['multiplier', 'multiplier'], ['fps', 'frames a second']];

// One run: its curves, the heatmap at a moment chosen on them, settings and how they differ from another run's.
export function run(main, query) {
  const id = query.get('id') ?? '';
  let gone = false, timer;
  const title = make('h1', {}, 'Run');
  const links = make('p', { class: 'row' }, make('a', { href: `#watch?agent=run:${id}` }, 'Watch its agent'), make('a', { href: `/api/report?runs=${id}`, target: '_blank' }, 'Report'), make('a', { href: `#runs?chosen=${id}` }, 'Compare'), make('a', { href: '#runs' }, 'All runs'));
  const map = make('canvas', { width: 480, height: 480, class: 'map', role: 'img', 'aria-label': 'Where the agent was' });
  const caption = make('figcaption', {}, 'No heatmap yet: a training writes them as it goes.');
  const moment = make('input', { type: 'range', min: 0, max: 0, value: 0, 'aria-label': 'Moment of the heatmap', disabled: true, oninput: () => heatmap(Number(moment.value)) });
  const nearest = (frames) => moments.reduce((best, one, k) => (Math.abs(one - frames) < Math.abs(moments[best] - frames) ? k : best), 0);
  const charts = CURVES.map(([name, label]) => chart(name, label, (frames) => moments.length && heatmap(nearest(frames))));
  const settings = make('div'), other = make('span');
  const smooth = make('input', { type: 'range', min: 0, max: 0.98, step: 0.02, value: 0, oninput: () => charts.forEach(({ chart }) => { chart.smooth = Number(smooth.value); chart.draw(); }) });
  main.append(make('section', { class: 'card' }, title, links, make('div', { class: 'row' }, field('smoothing', smooth))),
    make('section', { class: 'run' },
      make('div', { class: 'card charts' }, ...charts.map(({ figure }) => figure)),
      make('div', { class: 'card' }, make('h2', {}, 'Where it was'), make('p', { class: 'pale' }, 'Click a curve to choose the moment, or move this:'), moment,
        make('figure', {}, map, make('div', { class: 'scale', 'aria-hidden': 'true' }, 'seldom', make('i'), 'often'), caption))),
    make('section', { class: 'card' }, make('h2', {}, 'Settings'), make('div', { class: 'row' }, field('beside those of', other)), settings));

  let moments = [], shown = -1, me = null, beside = '', config = '';
  async function heatmap(at) {
    if (at === shown) return;
    shown = at;
    moment.value = at;
    const heat = await ask(`/api/heatmap?id=${id}&at=${at}`);
    if (!heat || gone || at !== shown) return;
    const pen = map.getContext('2d');
    const ground = heat.automap && await fetch(`/api/automap?id=${id}`).then((answer) => (answer.ok ? answer.blob() : null)).then((blob) => blob && createImageBitmap(blob)).catch(() => null);
    map.height = Math.round((map.width * heat.rows) / heat.columns);
    // The map in dim grey, so that warm colours on it are steps and nothing else.
    pen.filter = 'grayscale(1) brightness(0.75)';
    if (ground) pen.drawImage(ground, 0, 0, map.width, map.height);
    pen.filter = 'none';
    const most = Math.log1p(Math.max(...heat.steps, 1));
    const [w, h] = [map.width / heat.columns, map.height / heat.rows];
    heat.steps.forEach((steps, k) => {
      if (!steps) return;
      const share = Math.log1p(steps) / most;
      pen.fillStyle = `hsl(${60 - 60 * share} 100% 50% / ${0.25 + 0.65 * share})`;
      pen.fillRect((k % heat.columns) * w, Math.floor(k / heat.columns) * h, Math.ceil(w), Math.ceil(h));
    });
    caption.textContent = `At ${number(heat.frames, 0)} frames: steps of the latest ${heat.episodes} episodes.`;
    for (const { chart } of charts) { chart.moment = heat.frames; chart.draw(); }
  }

  async function compare(runs) {
    const against = runs.find((one) => one.id === beside);
    const table = await settingsTable(against ? [me, against] : [me], Boolean(against));
    if (table && !gone) settings.replaceChildren(table);
  }

  async function look() {
    try {
      const [detail, list, data] = await Promise.all([ask(`/api/run?id=${id}`), me ? { runs: [] } : ask('/api/runs'), ask(`/api/curves?runs=${id}&columns=${CURVES.map(([name]) => name).join(',')}`)]);
      if (gone || !detail || !list || !data) return;
      // Another run may have taken its place, or it was resumed with other settings.
      const present = JSON.stringify(detail.config);
      if (me && present !== config) { me = null; shown = -1; return; }
      config = present;
      if (!me) {
        me = list.runs.find((one) => one.id === id);
        if (!me) throw new Error('There is no such run; choose one from the list of runs.');
        title.textContent = `${me.name}: ${me.algo} in ${me.env}`;
        const others = list.runs.filter((one) => one.id !== id).sort((a, b) => (b.env === me.env) - (a.env === me.env) || a.name.localeCompare(b.name)).slice(0, 500);
        other.replaceChildren(choose([['', 'no other run'], ...others.map((one) => [one.id, one.name])], '', (value) => { beside = value; compare(list.runs); }));
        compare(list.runs);
      }
      for (const { name, chart } of charts) {
        chart.budget = name === 'cost_mean' ? me.budget : null;
        chart.curves = [{ name, group: name, x: data[id]?.frames ?? [], y: data[id]?.[name] ?? [] }];
        chart.draw();
      }
      const newest = shown === moments.length - 1;
      moments = detail.heatmaps;
      moment.max = Math.max(0, moments.length - 1);
      moment.disabled = moments.length < 2;
      // Whoever looks at the newest goes on doing so.
      if (moments.length && newest) heatmap(moments.length - 1);
    } catch (error) {
      title.textContent = error.message;
      me = null;
    } finally {
      if (!gone) { clearTimeout(timer); timer = setTimeout(look, me ? 2000 : 500); }
    }
  }
  look();
  return () => { gone = true; clearTimeout(timer); };
}
