import { ask, choose, field, keepState, make } from '/dom.js';
import { chart, colour } from '/chart.js';
import { Rows } from '/rows.js';
import { settingsTable } from '/settings.js';

// Rows of the table that are shown at a time: thousands of runs stay quick. Runs of a chart, and of a comparison of settings.
const ROWS = 200, CHOSEN = 100, COMPARED = 12;
const CURVES = [['return_mean', 'return'], ['cost_mean', 'cost'], ['multiplier', 'multiplier'], ['fps', 'frames a second']];

export function runs(main, query) {
  const known = new Map();
  let change = 0, gone = false, timer, data = {};
  const chosen = new Set((query.get('chosen') ?? '').split(',').filter(Boolean));
  const wanted = Object.fromEntries(['env', 'algo', 'option', 'text', 'sort'].map((name) => [name, query.get(name) ?? '']));
  const env = make('span'), algo = make('span'), option = make('span');
  const text = make('input', { type: 'search', value: wanted.text, placeholder: 'name or option', oninput: () => { wanted.text = text.value; list(); } });
  const count = make('p', { class: 'pale', role: 'status' });
  const pick = (id, on) => { if (on) chosen.add(id); else chosen.delete(id); list(); load(); };
  const rows = new Rows(pick, (sort) => { wanted.sort = sort; list(); });
  const every = make('button', { onclick: () => { filtered().slice(0, CHOSEN).forEach((run) => chosen.add(run.id)); list(); load(); } }, 'Compare all of these');
  const none = make('button', { onclick: () => { chosen.clear(); list(); load(); } }, 'Compare none');

  const smooth = make('input', { type: 'range', min: 0, max: 0.98, step: 0.02, value: query.get('smooth') ?? 0, oninput: redraw });
  const seeds = make('input', { type: 'checkbox', onchange: redraw });
  seeds.checked = query.get('seeds') === 'true';
  const report = make('a', { target: '_blank' }, 'Report of the chosen runs');
  const charts = CURVES.map(([name, title]) => chart(name, title));
  const legend = make('p', { class: 'row legend' });
  const differences = make('div');
  const curves = make('section', { class: 'card', hidden: true, id: 'curves' },
    make('h2', {}, 'Curves'),
    make('div', { class: 'row' }, field('smoothing', smooth), make('label', { class: 'check' }, seeds, 'mean and 95 % over seeds'), report),
    legend,
    make('div', { class: 'charts' }, ...charts.map(({ figure }) => figure)),
    make('p', { class: 'pale' }, 'Drag over a curve to look closer, double-click to go back; with the keyboard +, -, arrows and 0. Dashed: the budget.'),
    make('h2', {}, 'Settings that differ'), differences);
  const card = make('section', { class: 'card', id: 'list' }, make('h1', {}, 'Runs'),
    make('div', { class: 'row' }, field('environment', env), field('algorithm', algo), field('option', option), field('search', text)), make('div', { class: 'row count' }, count, every, none), rows.element);
  const hint = make('section', { class: 'card', hidden: true });
  main.append(hint, card, curves);

  function filtered() {
    const fits = (run) => (!wanted.env || run.env === wanted.env) && (!wanted.algo || run.algo === wanted.algo)
      && (!wanted.option || `${wanted.option}` in run.kinds) && (!wanted.text || `${run.name} ${Object.keys(run.kinds).join(' ')}`.includes(wanted.text));
    return rows.sorted([...known.values()].filter(fits), wanted.sort);
  }

  function list() {
    keepState('runs', { ...wanted, chosen: [...chosen].join(','), smooth: Number(smooth.value) || '', seeds: seeds.checked || '' });
    const all = filtered();
    count.textContent = `${all.length} of ${known.size} runs${all.length > ROWS ? `, the first ${ROWS} are shown` : ''}${chosen.size ? `; ${chosen.size} compared below` : '; tick some to compare their curves below'}`;
    none.hidden = !chosen.size;
    every.hidden = all.every((run) => chosen.has(run.id)) || chosen.size >= CHOSEN;
    rows.show(all.slice(0, ROWS), chosen, wanted.sort);
  }

  function choices() {
    const pick_from = (key, names) => choose([['', 'all'], ...names.map((name) => [name, name])], wanted[key], (value) => { wanted[key] = value; list(); });
    const names = (key) => [...new Set([...known.values()].map((run) => run[key]))].sort();
    env.replaceChildren(pick_from('env', names('env')));
    algo.replaceChildren(pick_from('algo', names('algo')));
    // An option that all runs share chooses nothing.
    const shares = new Map();
    for (const run of known.values()) for (const kind of Object.keys(run.kinds)) shares.set(kind, (shares.get(kind) ?? 0) + 1);
    const telling = [...shares].filter(([, runs]) => runs < known.size).map(([kind]) => kind).sort();
    option.replaceChildren(pick_from('option', telling.slice(0, 300)));
    option.closest('label').hidden = !telling.length;
  }

  const picked = () => [...chosen].map((id) => known.get(id)).filter(Boolean).slice(0, CHOSEN);
  let compared = '';
  async function load() {
    const some = picked();
    curves.hidden = !some.length;
    rows.element.classList.toggle('short', some.length > 0);
    if (!some.length) return;
    const ids = some.map((run) => run.id).join(',');
    report.href = `/api/report?runs=${ids}`;
    const answer = await ask(`/api/curves?runs=${ids}&columns=${CURVES.map(([name]) => name).join(',')}`);
    // Answers may overtake each other: only the one to what is chosen now counts.
    if (gone || !answer || ids !== picked().map((run) => run.id).join(',')) return;
    data = answer;
    redraw();
    // Another run may have taken the place of one: then its settings are others.
    const settled = some.map((run) => `${run.id} ${run.settled}`).join(',');
    if (compared === settled) return;
    compared = settled;
    const table = await settingsTable(some.slice(0, COMPARED), true);
    if (table) differences.replaceChildren(...(some.length > COMPARED ? [make('p', { class: 'pale' }, `Of the first ${COMPARED}.`)] : []), table);
  }

  // Runs are of a group if all but their seed is equal; what tells groups apart names them.
  function groups(shown) {
    const kinds = shown.map((run) => Object.keys(run.kinds));
    const common = new Set((kinds[0] ?? []).filter((kind) => kinds.every((others) => others.includes(kind))));
    return kinds.map((own, at) => [shown[at].algo, shown[at].env, ...own.filter((kind) => !common.has(kind))].join(' '));
  }

  function redraw() {
    const shown = picked().filter((run) => data[run.id]);
    const group = groups(shown);
    const names = seeds.checked ? [...new Set(group)] : shown.map((run) => run.name);
    const budgets = new Set(shown.map((run) => run.budget));
    for (const { name, chart } of charts) {
      chart.smooth = Number(smooth.value);
      chart.bySeeds = seeds.checked;
      chart.budget = name === 'cost_mean' && budgets.size === 1 ? [...budgets][0] : null;
      chart.curves = shown.map((run, at) => ({ name: run.name, group: group[at], x: data[run.id].frames, y: data[run.id][name] ?? [] }));
      chart.draw();
    }
    legend.replaceChildren(...names.map((name, index) => make('span', {}, make('b', { style: `color:${colour(index)}`, 'aria-hidden': 'true' }, '● '), name)));
    list();
  }

  async function look() {
    try {
      const news = await ask(`/api/runs?since=${change}`);
      if (gone) return;
      if (news) {
        if (news.whole) known.clear();
        for (const run of news.runs) {
          run.kinds = Object.fromEntries(Object.entries(run.options).map(([key, value]) => [`${key} = ${value}`, true]));
          if (!known.has(run.id)) news.fresh = true;
          known.set(run.id, run);
        }
        empty(news);
        if (news.runs.length || news.whole) {
          if (news.fresh || news.whole) choices();
          list();
          if (news.whole || news.runs.some((run) => chosen.has(run.id))) load();
        }
        change = news.change;
      }
    } finally {
      if (!gone) timer = setTimeout(look, 1000);
    }
  }

  function empty(news) {
    hint.hidden = known.size > 0;
    card.hidden = known.size === 0;
    if (!hint.hidden && !hint.childElementCount) {
      hint.append(make('h1', {}, 'No runs yet'), make('p', {}, `This page looks below ${news.folders.join(', ')} and shows every run as soon as it begins. Begin one:`),
        make('pre', {}, 'hasard train VolcanicVentureLevel1-v0 --out runs/first'),
        make('p', {}, 'Meanwhile: ', make('a', { href: '#watch' }, 'watch an environment'), ' or ', make('a', { href: '#play' }, 'play it yourself'), '.'));
    }
  }
  look();
  return () => { gone = true; clearTimeout(timer); };
}
