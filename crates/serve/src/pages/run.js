import { ask, choose, fetch_on_click, field, keepState, make } from '/dom.js';
import { Chart, Shared } from '/chart.js';
import { colour } from '/svg.js';
import { column } from '/curves.js';
import { Heatmap } from '/heat.js';
import { evaluation_of, picker, title_of, usual } from '/metrics.js';
import { env_name } from '/names.js';
import { ownSettings, settingsTable } from '/settings.js';
import { NotesCard } from '/notes.js';
import { strip } from '/strip.js';
import { kept, tools } from '/tools.js';

// One run: what it is worth, its curves, visited positions, settings.
export function run(main, query) {
  const id = query.get('id') ?? '';
  const shared = new Shared();
  let gone = false, timer, me = null, detail = null, data = {}, chosen = null, drawn = '', settled = null;
  const title = make('h1', {}, 'Run');
  const tiles = make('div', { class: 'strip', id: 'strip' });
  const link = (text, to, more = {}) => make('a', { class: 'button', href: to, ...more }, text);
  const filmed = make('span', { role: 'status' });
  const film = fetch_on_click(link('Film', `/api/film?agent=run:${id}&best=true&seed=1`, { id: 'film', title: 'An episode of seed 1 as MP4, with the selected checkpoint' }), filmed);
  const links = make('p', { class: 'row links' }, link('Watch', `#watch?agent=run:${id}&best=true`), film, link('Report', `/api/report?runs=${id}`, { target: '_blank' }), link('Compare', `#runs?chosen=${id}`), link('All runs', '#runs'), filmed);
  const heat = new Heatmap(id, (frames) => { shared.moment = in_axis(frames); shared.charts.forEach((chart) => chart.update_readout()); });
  const picked = make('div'), charts = make('div', { class: 'charts' }), settings = make('div'), other = make('span'), beside = make('div');
  const bar = tools(shared, query, (again) => { keep(); if (again) draw(); });
  const notes = new NotesCard(id);
  main.append(make('section', { class: 'card' }, title, tiles, links, notes.element),
    make('section', { class: 'run' },
      make('div', { class: 'card' }, make('h2', {}, 'Curves'), bar, picked, charts, make('p', { class: 'note' }, 'Drag over a curve to look closer, double-click to go back; with the keyboard +, -, arrows and 0.')),
      heat.element),
    make('section', { class: 'card' }, make('h2', {}, 'Settings'), settings, make('h2', {}, 'Compare settings'), make('div', { class: 'row' }, field('with those of', other)), beside));

  // Frames in what the horizontal axis counts.
  function in_axis(frames) {
    if (frames == null || shared.over === 'frames') return frames;
    if (shared.over === 'steps') return frames / (detail?.frame_skip ?? 4);
    const at = column(data, 'wall_s', 'frames');
    const k = at.x.findIndex((one) => one >= frames);
    return at.y[k < 0 ? at.y.length - 1 : k] ?? null;
  }

  function keep() {
    const same = chosen && String([...chosen]) === String(usual(detail.metrics, me.last));
    keepState('run', { id, metrics: chosen && !same ? [...chosen].join(',') : '', ...kept(shared) });
  }

  function series(name) {
    const skip = detail.frame_skip ?? 4;
    const [mean, half] = evaluation_of(name);
    const own = name.startsWith('eval/');
    const one = [{ name: own ? 'evaluation' : mean ? 'training' : title_of(name), colour: colour(own ? 1 : 0), kind: own ? 'points' : 'line', ...column(data, name, shared.over, skip) }];
    const points = mean && data[mean] ? column(data, mean, shared.over, skip) : { x: [] };
    if (points.x.length) one.push({ name: 'evaluation', colour: colour(1), kind: 'points', ...points, half: half ? column(data, half, shared.over, skip).y : null });
    return one;
  }

  function budgets(name) {
    const own = me.evaluation?.costs ?? [];
    if (name === 'cost_mean') { const whole = own.find((one) => one.name === 'whole cost'); return whole || !own.length ? [{ name: `budget ${whole?.budget ?? me.budget}`, value: whole?.budget ?? me.budget }] : []; }
    return own.filter((one) => name === `cost/${one.name}`).map((one) => ({ name: `budget ${one.budget}`, value: one.budget }));
  }

  function draw() {
    const names = [...chosen].filter((name) => detail.metrics.some((metric) => metric.name === name));
    if (String(names) !== drawn) {
      drawn = String(names);
      shared.clear();
      const of = (name) => detail.metrics.find((metric) => metric.name === name);
      charts.replaceChildren(...names.map((name) => shared.add(new Chart(shared, { title: title_of(name), unit: of(name).unit, note: of(name).meaning, file: name.replace(/\W+/g, '-'), onmoment: (x) => heat.at_frames(to_frames(x)) })).element));
    }
    shared.selected = in_axis(me.evaluation?.frames ?? null);
    shared.charts.forEach((chart, k) => Object.assign(chart, { series: series(names[k]), budgets: budgets(names[k]) }));
    shared.draw();
  }

  function to_frames(x) {
    if (shared.over === 'frames') return x;
    if (shared.over === 'steps') return x * (detail.frame_skip ?? 4);
    const at = column(data, 'wall_s', 'frames');
    const k = at.y.findIndex((one) => one >= x);
    return at.x[k < 0 ? at.x.length - 1 : k] ?? 0;
  }

  function show_picker() {
    const open = picked.querySelector('details')?.open;
    const list = picker(detail.metrics, chosen, () => { keep(); show_picker(); load(); });
    list.open = open ?? false;
    // What was ticked stays focused.
    const focused = document.activeElement?.dataset?.metric;
    picked.replaceChildren(list);
    if (focused) list.querySelector(`[data-metric="${CSS.escape(focused)}"]`)?.focus({ preventScroll: true });
  }

  async function load() {
    // What this run has, each once: asking for more only comes nearer to what the server takes.
    const there = new Set(detail.metrics.map((metric) => metric.name));
    const names = [...new Set([...chosen].flatMap((name) => [name, ...evaluation_of(name)]))].filter((name) => there.has(name));
    const answer = await ask(`/api/curves?runs=${id}&columns=${names.map(encodeURIComponent).join(',')}`);
    if (gone || !answer) return;
    data = answer[id] ?? {};
    draw();
  }

  async function others() {
    const list = await ask('/api/runs');
    if (!list || gone) return;
    const all = list.runs.filter((one) => one.id !== id).sort((a, b) => (b.env === me.env) - (a.env === me.env) || a.name.localeCompare(b.name, 'en', { numeric: true })).slice(0, 500);
    other.replaceChildren(choose([['', 'no other run'], ...all.map((one) => [one.id, one.name])], '', async (value) => {
      const against = all.find((one) => one.id === value);
      const table = against ? await settingsTable([me, against]) : '';
      if (!gone) beside.replaceChildren(table ?? '');
    }));
  }

  async function look() {
    try {
      const answer = await ask(`/api/run?id=${id}`);
      if (gone || !answer) return;
      detail = answer;
      me = detail.run;
      if (!me) throw new Error('There is no such run; choose one from the list of runs.');
      title.textContent = `${me.algo} in ${env_name(me.env)}, seed ${me.seed}`;
      title.title = me.name;
      notes.show(me);
      tiles.replaceChildren(...strip(me, detail.over));
      chosen ??= new Set(query.get('metrics')?.split(',').filter(Boolean) ?? usual(detail.metrics, me.last));
      // Another run may have taken its place, or it was resumed with other settings.
      if (settled !== me.settled) {
        settled = me.settled;
        settings.replaceChildren(ownSettings(detail.settings, detail.settings.find((row) => row.name === 'preset')?.value ?? ''));
        others();
      }
      if (picked.dataset.known !== String(detail.metrics.length)) { picked.dataset.known = detail.metrics.length; show_picker(); }
      await load();
      heat.set(detail.heatmaps);
      if (me.env.includes(',')) heat.caption.textContent = 'Tasks on different maps have no heatmap together.';
    } catch (error) {
      title.textContent = error.message;
      settled = null;
    } finally {
      if (!gone) { clearTimeout(timer); timer = setTimeout(look, settled === null ? 500 : 2000); }
    }
  }
  look();
  return () => { gone = true; clearTimeout(timer); shared.clear(); };
}
