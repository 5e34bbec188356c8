import { ask, choose, field, keepState, make, number } from '/dom.js';
import { Chart, colour } from '/chart.js';

// Rows of the table that are shown at a time: thousands of runs stay quick.
const ROWS = 200;

export function runs(main, query) {
  const known = new Map();
  let change = 0, gone = false, timer;
  const chosen = new Set((query.get('chosen') ?? '').split(',').filter(Boolean));
  const wanted = { env: query.get('env') ?? '', algo: query.get('algo') ?? '', text: query.get('text') ?? '' };
  const env = make('span'), algo = make('span');
  const text = make('input', { type: 'search', value: wanted.text, placeholder: 'name or option', oninput: () => { wanted.text = text.value; list(); } });
  const body = make('tbody');
  const count = make('p', { class: 'pale', role: 'status' });
  const heads = ['', 'run', 'environment', 'algorithm', 'seed', 'progress', 'fps', 'return', 'cost', 'budget', 'multiplier', 'state'];
  const table = make('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Runs' }, make('table', {}, make('thead', {}, make('tr', {}, ...heads.map((head) => make('th', { scope: 'col' }, head)))), body));
  const smooth = make('input', { type: 'range', min: 0, max: 0.98, step: 0.02, value: 0, oninput: redraw });
  const seeds = make('input', { type: 'checkbox', onchange: redraw });
  const report = make('a', { target: '_blank' }, 'Report of the chosen runs');
  const columns = ['return_mean', 'cost_mean', 'fps', 'multiplier'];
  const charts = columns.map((name) => {
    const canvas = make('canvas', { class: 'chart', role: 'img', 'aria-label': `Curve of ${name} over frames` });
    return { name, canvas, chart: new Chart(canvas) };
  });
  const legend = make('p', { class: 'row' });
  const curves = make('section', { class: 'card', hidden: true },
    make('h2', {}, 'Curves'),
    make('div', { class: 'row' }, field('smoothing', smooth), make('label', { class: 'check' }, seeds, 'mean and 95 % over seeds'), report),
    legend,
    make('div', { class: 'charts' }, ...charts.map(({ name, canvas }) => make('figure', {}, make('figcaption', {}, name), canvas))),
    make('p', { class: 'pale' }, 'Drag over a curve to look closer, double-click to go back.'));
  const list_card = make('section', { class: 'card' }, make('h1', {}, 'Runs'),
    make('div', { class: 'row' }, field('environment', env), field('algorithm', algo), field('search', text)), count, table);
  main.append(list_card, curves);

  function filtered() {
    return [...known.values()].filter((run) => (!wanted.env || run.env === wanted.env) && (!wanted.algo || run.algo === wanted.algo)
      && (!wanted.text || `${run.name} ${Object.entries(run.options).join(' ')}`.includes(wanted.text)));
  }

  function list() {
    keepState('runs', { ...wanted, chosen: [...chosen].join(',') });
    const all = filtered().sort((a, b) => (b.state === 'running') - (a.state === 'running') || a.name.localeCompare(b.name, 'en', { numeric: true }));
    count.textContent = `${all.length} of ${known.size} runs${all.length > ROWS ? `, the first ${ROWS} are shown` : ''}`;
    const focused = document.activeElement?.dataset?.run;
    body.replaceChildren(...all.slice(0, ROWS).map(row));
    if (focused) body.querySelector(`[data-run="${focused}"]`)?.focus();
  }

  function row(run) {
    const { last } = run;
    const box = make('input', { type: 'checkbox', 'aria-label': `Compare ${run.name}`, 'data-run': run.id, onchange: () => { if (box.checked) chosen.add(run.id); else chosen.delete(run.id); list(); load(); } });
    box.checked = chosen.has(run.id);
    const within = last.cost_mean == null ? '' : last.cost_mean <= run.budget ? 'good' : 'bad';
    const cell = (value, kind = 'number') => make('td', { class: kind }, value);
    const progress = make('progress', { max: run.total ?? 1, value: last.frames ?? 0, 'aria-label': `Progress of ${run.name}` });
    return make('tr', {}, make('td', {}, box), make('td', {}, make('a', { href: `#run?id=${run.id}` }, run.name)), cell(run.env, ''), cell(run.algo, ''), cell(String(run.seed)),
      make('td', {}, progress), cell(number(last.fps, 0)), cell(number(last.return_mean)),
      cell(`${number(last.cost_mean)}${within === 'bad' ? ' over' : within === 'good' ? ' within' : ''}`, `number ${within}`),
      cell(number(run.budget)), cell(number(last.multiplier, 3)), cell(run.state, run.state === 'running' ? 'good' : 'pale'));
  }

  function choices() {
    const names = (key) => [['', 'all'], ...[...new Set([...known.values()].map((run) => run[key]))].sort()];
    env.replaceChildren(choose(names('env'), wanted.env, (value) => { wanted.env = value; list(); }));
    algo.replaceChildren(choose(names('algo'), wanted.algo, (value) => { wanted.algo = value; list(); }));
  }

  let data = {};
  async function load() {
    curves.hidden = chosen.size === 0;
    if (!chosen.size) return;
    const ids = [...chosen].slice(0, 100).join(',');
    report.href = `/api/report?runs=${ids}`;
    data = (await ask(`/api/curves?runs=${ids}&columns=${columns.join(',')}`)) ?? data;
    redraw();
  }

  function redraw() {
    const shown = [...chosen].map((id) => known.get(id)).filter((run) => run && data[run.id]);
    const budgets = new Set(shown.map((run) => run.budget));
    for (const { name, chart } of charts) {
      chart.smooth = Number(smooth.value);
      chart.bySeeds = seeds.checked;
      chart.budget = name === 'cost_mean' && budgets.size === 1 ? [...budgets][0] : null;
      chart.curves = shown.map((run) => ({ name: run.name, group: `${run.algo} ${run.env}`, x: data[run.id].frames, y: data[run.id][name] ?? [] }));
      chart.draw();
    }
    const names = seeds.checked ? [...new Set(shown.map((run) => `${run.algo} ${run.env}`))] : shown.map((run) => run.name);
    legend.replaceChildren(...names.map((name, index) => make('span', {}, make('b', { style: `color:${colour(index)}`, 'aria-hidden': 'true' }, '● '), name)));
  }

  async function look() {
    try {
      const news = await ask(`/api/runs?since=${change}`);
      if (gone) return;
      if (news) {
        if (news.whole) known.clear();
        for (const run of news.runs) known.set(run.id, run);
        const first = change === 0;
        if (news.runs.length || news.whole) {
          list();
          if (news.whole || first || env.childElementCount === 0) choices();
          if (news.runs.some((run) => chosen.has(run.id))) load();
        }
        change = news.change;
        empty(news);
      }
    } finally {
      if (!gone) timer = setTimeout(look, 1000);
    }
  }

  const hint = make('section', { class: 'card', hidden: true });
  main.prepend(hint);
  function empty(news) {
    hint.hidden = known.size > 0;
    list_card.hidden = known.size === 0;
    if (!hint.hidden && !hint.childElementCount) {
      hint.append(make('h1', {}, 'No runs yet'), make('p', {}, `This page looks below ${news.folders.join(', ')} and shows every run as soon as it begins. Begin one:`),
        make('pre', {}, 'hasard train VolcanicVentureLevel1-v0 --preset quick --out runs/first'),
        make('p', {}, 'Meanwhile: ', make('a', { href: '#watch' }, 'watch an environment'), ' or ', make('a', { href: '#play' }, 'play it yourself'), '.'));
    }
  }
  look();
  return () => { gone = true; clearTimeout(timer); };
}
