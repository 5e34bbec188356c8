import { ask, choose, field, keepState, make } from '/dom.js';
import { Comparison } from '/compare.js';
import { env_name, labels } from '/names.js';
import { Rows, summary } from '/rows.js';
import { kept } from '/tools.js';

// Experiments of the table that are shown at a time: thousands of runs stay quick. Runs that are compared at a time.
const ROWS = 200, CHOSEN = 100;

export function runs(main, query) {
  const known = new Map(), options = new Map(), open = new Set();
  let change = 0, gone = false, timer, named = new Map();
  const chosen = new Set((query.get('chosen') ?? '').split(',').filter(Boolean));
  const wanted = Object.fromEntries(['env', 'algo', 'option', 'text', 'sort'].map((name) => [name, query.get(name) ?? '']));
  const env = make('span'), algo = make('span'), option = make('span');
  const text = make('input', { type: 'search', value: wanted.text, placeholder: 'name, setting, tag', oninput: () => { wanted.text = text.value; list(); } });
  const count = make('p', { class: 'pale', role: 'status' });
  const change_choice = (all, on) => { for (const run of all) if (on) chosen.add(run.id); else chosen.delete(run.id); list(); compare(); };
  const rows = new Rows(change_choice, (sort) => { wanted.sort = sort; list(); }, (key) => { if (!open.delete(key)) open.add(key); list(); });
  const archived = make('input', { type: 'checkbox', id: 'archived', onchange: () => list() });
  const every = make('button', { onclick: () => change_choice(filtered().flatMap((row) => row.runs).slice(0, CHOSEN), true) }, 'Compare all of these');
  const none = make('button', { onclick: () => { chosen.clear(); list(); compare(); } }, 'Compare none');
  const comparison = new Comparison(query, list);
  const card = make('section', { class: 'card', id: 'list' }, make('h1', {}, 'Runs'),
    make('div', { class: 'row' }, field('environment', env), field('algorithm', algo), field('setting', option), field('search', text), make('label', { class: 'check', hidden: true }, archived, 'archived too')), make('div', { class: 'row count' }, count, every, none), rows.element);
  const hint = make('section', { class: 'card', hidden: true });
  main.append(hint, card, comparison.element);

  const experiment = (run) => ({ env: run.env, algo: run.algo, total: run.total, options: options.get(run.experiment) ?? {} });
  const settings = (run) => Object.entries(options.get(run.experiment) ?? {}).map(([name, value]) => `${name} = ${value}`);

  function filtered() {
    const text_of = (run) => `${run.name} ${run.env} ${run.algo} ${settings(run).join(' ')} ${run.notes?.note ?? ''} ${(run.notes?.tags ?? []).join(' ')}`;
    archived.parentElement.hidden = ![...known.values()].some((run) => run.notes?.archived);
    const fits = (run) => (archived.checked || !run.notes?.archived) && (!wanted.env || run.env === wanted.env) && (!wanted.algo || run.algo === wanted.algo)
      && (!wanted.option || settings(run).includes(wanted.option)) && (!wanted.text || text_of(run).toLowerCase().includes(wanted.text.toLowerCase()));
    const groups = new Map();
    for (const run of known.values()) if (fits(run)) groups.set(run.experiment, [...(groups.get(run.experiment) ?? []), run]);
    const all = [...groups].map(([key, group]) => ({ key, ...summary(group.sort((a, b) => a.seed - b.seed || a.name.localeCompare(b.name)), named.get(key) ?? { rest: '', full: '' }) }));
    return Rows.sorted(all, wanted.sort);
  }

  function list() {
    keepState('runs', { ...wanted, chosen: [...chosen].join(','), ...comparison.kept(), ...kept(comparison.shared) });
    const all = filtered();
    const runs_shown = all.reduce((sum, row) => sum + row.runs.length, 0);
    const plural = (number, noun) => `${number} ${noun}${number === 1 ? '' : 's'}`;
    count.textContent = `${plural(runs_shown, 'run')} of ${plural(all.length, 'experiment')}${runs_shown < known.size ? ` (${known.size} runs in all)` : ''}${all.length > ROWS ? `, the first ${ROWS} experiments are shown` : ''}${chosen.size ? `; ${plural(chosen.size, 'run')} compared below` : '; tick some to compare them below'}`;
    none.hidden = !chosen.size;
    every.hidden = all.every((row) => row.runs.every((run) => chosen.has(run.id))) || chosen.size >= CHOSEN;
    const shown = all.slice(0, ROWS).flatMap((row) => {
      const seeds = row.runs.length > 1 && open.has(row.key) ? row.runs.slice(0, ROWS) : [];
      return [{ key: row.key, summary: row }, ...seeds.map((run) => ({ key: run.id, summary: { ...summary([run], { rest: '', full: '' }), again: row.repeats.includes(run.id) }, seed: true }))];
    });
    rows.show(shown, chosen, open, wanted.sort);
  }

  function choices() {
    const all = [...known.values()];
    const keys = [...new Set(all.map((run) => run.experiment))];
    const some = labels(keys.map((key) => experiment(all.find((run) => run.experiment === key))));
    named = new Map(keys.map((key, k) => [key, some[k]]));
    const pick_from = (key, names, said = (name) => name) => choose([['', 'all'], ...names.map((name) => [name, said(name)])], wanted[key], (value) => { wanted[key] = value; list(); });
    const names = (key) => [...new Set(all.map((run) => run[key]))].sort();
    env.replaceChildren(pick_from('env', names('env'), env_name));
    algo.replaceChildren(pick_from('algo', names('algo')));
    // A setting that all experiments share chooses nothing.
    const shares = new Map();
    for (const key of keys) for (const [name, value] of Object.entries(options.get(key) ?? {})) shares.set(`${name} = ${value}`, (shares.get(`${name} = ${value}`) ?? 0) + 1);
    const differing = [...shares].filter(([, share]) => share < keys.length).map(([kind]) => kind).sort();
    option.replaceChildren(pick_from('option', differing.slice(0, 300)));
    option.closest('label').hidden = !differing.length;
  }

  const picked = () => [...chosen].map((id) => known.get(id)).filter(Boolean).slice(0, CHOSEN);
  function compare() {
    const some = picked();
    rows.element.classList.toggle('short', some.length > 0);
    comparison.show(some, options);
  }

  async function look() {
    try {
      const news = await ask(`/api/runs?since=${change}`);
      if (gone) return;
      if (news) {
        if (news.whole) known.clear();
        for (const [key, value] of Object.entries(news.experiments)) options.set(key, value);
        for (const run of news.runs) {
          if (known.get(run.id)?.experiment !== run.experiment) news.fresh = true;
          known.set(run.id, run);
        }
        empty(news);
        if (news.runs.length || news.whole) {
          if (news.fresh || news.whole) choices();
          list();
          if (news.whole || news.runs.some((run) => chosen.has(run.id))) compare();
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
  return () => { gone = true; clearTimeout(timer); comparison.end(); };
}
