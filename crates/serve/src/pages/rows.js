import { make, number } from '/dom.js';
import { by_seed, estimate } from '/curves.js';
import { env_name, path_rest } from '/names.js';
import { short } from '/scale.js';
import { duration, interval, verdict } from '/strip.js';

const minus = -Infinity;
// Heads of the columns, whether they are numbers, and what rows are sorted by; a name with a minus before it is the other way round.
const HEADS = [['experiment', false, (row) => `${row.algo} ${row.rest}`], ['environment', false, (row) => row.env], ['seeds', true, (row) => row.seeds], ['evaluation return', true, (row) => row.evaluated?.return?.mean ?? minus], ['evaluation cost', true, (row) => row.evaluated?.costs[0]?.cost?.mean ?? minus],
  ['training return', true, (row) => row.training.return?.mean ?? minus], ['training cost', true, (row) => row.training.cost?.mean ?? minus], ['frames', true, (row) => row.frames / row.seeds], ['state', false, (row) => row.state]];
// A training that has its frames and is still closing is at work too.
const at_work = ({ state }) => state === 'running' || state === 'evaluating';
const ORDER = { surely: 3, mean: 2, over: 1, unknown: 0 };

// How many runs stand beside the seeds without counting.
export const repeated = (count) => (count ? ` + ${count} repeat${count === 1 ? '' : 's'}` : '');

// Several estimates as one: of a single run its own interval over episodes, of more the interval over seeds.
function over_seeds(all) {
  const known = all.filter((one) => one?.mean != null);
  if (known.length < 2) return known[0] ?? null;
  return estimate(known.map((one) => one.mean));
}

// What a row shows: of one run, or of all runs of an experiment. `all` of them can be picked; numbers are of each seed once.
export function summary(all, label) {
  const { counted: runs, repeats } = by_seed(all);
  const [first] = runs;
  const evaluated = runs.map((run) => run.evaluation).filter((one) => one?.return);
  const plain = (name) => over_seeds(runs.map((run) => (run.last[name] == null ? null : { mean: run.last[name], half: null })));
  const costs = (evaluated[0]?.costs ?? []).map((one, k) => {
    const cost = over_seeds(evaluated.map((other) => other.costs[k]?.cost));
    const kept = cost == null ? 'unknown' : evaluated.length === 1 ? one.kept : cost.half != null && cost.mean + cost.half <= one.budget ? 'surely' : cost.mean <= one.budget ? 'mean' : 'over';
    return { ...one, cost, kept };
  });
  const count = (state) => all.filter((run) => run.state === state).length;
  const states = ['running', 'evaluating', 'done', 'stopped'].filter(count);
  const left = Math.max(0, ...all.filter((run) => run.state === 'running' && run.total && run.last.fps).map((run) => (run.total - (run.last.frames ?? 0)) / run.last.fps));
  return {
    runs: all, seeds: runs.length, repeats: repeats.map((run) => run.id), env: first.env, algo: first.algo, rest: label.rest, full: label.full, budget: first.budget, state: states[0],
    evaluated: evaluated.length ? { return: over_seeds(evaluated.map((one) => one.return)), costs, n: evaluated.length, episodes: evaluated[0].episodes } : null,
    training: { return: plain('return_mean'), cost: plain('cost_mean') },
    frames: runs.reduce((sum, run) => sum + (run.last.frames ?? 0), 0), total: runs.reduce((sum, run) => sum + (run.total ?? 0), 0),
    states: states.map((state) => (all.length > 1 ? `${count(state)} ${state}` : state)).join(', ') + (left ? `, ${duration(left)} left` : ''),
  };
}

// The table of experiments and their runs. A row stays the same element while its runs change, so that what the user points at or has
// focused stays.
export class Rows {
  constructor(onpick, onsort, onopen) {
    Object.assign(this, { onpick, onopen, rows: new Map(), body: make('tbody') });
    this.heads = HEADS.map(([name, is_number]) => make('th', { scope: 'col', class: is_number ? 'number' : '' }, make('button', { class: 'sort', onclick: () => onsort(this.sort === name ? `-${name}` : name) }, name)));
    const table = make('table', { class: 'runs' }, make('thead', {}, make('tr', {}, make('th', { scope: 'col' }, make('span', { class: 'unseen' }, 'compare')), ...this.heads)), this.body);
    this.element = make('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Runs' }, table);
  }

  static sorted(rows, sort) {
    const [, , key] = HEADS.find(([name]) => name === sort.replace('-', '')) ?? [];
    const names = (a, b) => a.env.localeCompare(b.env, 'en', { numeric: true }) || a.algo.localeCompare(b.algo) || a.rest.localeCompare(b.rest, 'en', { numeric: true });
    if (!key) return rows.sort((a, b) => at_work(b) - at_work(a) || names(a, b));
    const way = sort.startsWith('-') ? -1 : 1;
    return rows.sort((a, b) => { const [x, y] = [key(a), key(b)]; return way * (typeof x === 'string' ? x.localeCompare(y, 'en', { numeric: true }) : x - y) || names(a, b); });
  }

  // `shown`: rows { key, summary, run }, a run for a row of a single seed below its experiment.
  show(shown, chosen, open, sort) {
    this.sort = sort;
    this.heads.forEach((head, k) => {
      const [name] = HEADS[k];
      if (sort.replace('-', '') === name) head.setAttribute('aria-sort', sort.startsWith('-') ? 'descending' : 'ascending');
      else head.removeAttribute('aria-sort');
    });
    const elements = shown.map((one) => this.row(one, chosen, open));
    const here = new Set(shown.map(({ key }) => key));
    for (const [key, row] of this.rows) if (!here.has(key)) { row.element.remove(); this.rows.delete(key); }
    elements.forEach((element, k) => { if (this.body.children[k] !== element) this.body.insertBefore(element, this.body.children[k] ?? null); });
  }

  row({ key, summary: what, seed }, chosen, open) {
    let row = this.rows.get(key);
    if (!row) {
      const box = make('input', { type: 'checkbox', onchange: () => this.onpick(row.what.runs, box.checked) });
      const cells = HEADS.map(([name, is_number]) => make('td', { class: is_number ? 'number' : '', 'data-label': name }));
      row = { box, cells, element: make('tr', { class: seed ? 'seed' : '' }, make('td', { class: 'pick' }, box), ...cells), progress: make('progress', { max: 1 }), percent: make('span', { class: 'note' }) };
      row.cells[7].append(row.progress, row.percent);
      this.rows.set(key, row);
    }
    const some = what.runs.filter((run) => chosen.has(run.id)).length;
    row.box.checked = some === what.runs.length;
    row.box.indeterminate = some > 0 && some < what.runs.length;
    const face = JSON.stringify([what, open.has(key)]);
    if (row.face !== face) { row.face = face; this.fill(row, key, what, seed, open.has(key)); }
    row.what = what;
    return row.element;
  }

  name(key, what, seed, is_open) {
    const [run] = what.runs;
    if (seed) return [make('a', { href: `#run?id=${run.id}`, 'data-run': run.id }, `seed ${run.seed}`), ...(what.again ? [make('span', { class: 'note', title: 'Another run of these settings and this seed got further or as far: this one does not count.' }, 'repeats')] : []), make('span', { class: 'note' }, [path_rest(run), ...(run.notes?.tags ?? []).map((tag) => `#${tag}`)].filter(Boolean).join(' '))];
    const tags = [...new Set(what.runs.flatMap((one) => one.notes?.tags ?? []))];
    const note = make('span', { class: 'note', title: what.full }, [what.rest, ...tags.map((tag) => `#${tag}`)].filter(Boolean).join(' '));
    if (what.runs.length === 1) return [make('a', { href: `#run?id=${run.id}`, 'data-run': run.id }, what.algo), note, make('span', { class: 'note' }, path_rest(run))];
    return [make('button', { class: 'open', 'aria-expanded': String(is_open), onclick: () => this.onopen(key) }, what.algo), note];
  }

  fill(row, key, what, seed, is_open) {
    const { cells } = row;
    row.box.setAttribute('aria-label', `Compare ${what.algo} in ${env_name(what.env)}${seed ? `, seed ${what.runs[0].seed}` : ''}`);
    cells[0].replaceChildren(...this.name(key, what, seed, is_open));
    cells[1].textContent = seed ? '' : env_name(what.env);
    cells[1].title = what.env;
    cells[2].textContent = seed ? '' : `${what.seeds === 1 ? `seed ${what.runs[0].seed}` : what.seeds}${repeated(what.repeats.length)}`;
    cells[2].title = what.repeats.length ? 'Runs of equal settings and seed: the one that got furthest counts.' : '';
    const found = what.evaluated;
    cells[3].textContent = interval(found?.return);
    cells[3].title = found ? (found.n > 1 ? `mean of ${found.n} seeds, each over ${found.episodes} closing episodes; ± half the 95 % interval over seeds` : `${found.episodes} closing episodes of the selected checkpoint`) : 'no checkpoint was evaluated yet';
    const worst = (found?.costs ?? []).reduce((low, one) => (ORDER[one.kept] < ORDER[low] ? one.kept : low), 'surely');
    cells[4].replaceChildren(...(found ? found.costs.map((one) => make('span', { class: `line ${verdict(one.kept)[1]}`, title: verdict(one.kept)[2] }, `${interval(one.cost)} of ${number(one.budget)}${found.costs.length > 1 ? ` (${one.name})` : ''}`, make('span', { class: 'note' }, verdict(one.kept)[0]))) : [make('span', { class: 'pale' }, `– of ${number(what.budget)}`)]));
    cells[4].className = `number ${found ? verdict(worst)[1] : ''}`;
    cells[5].textContent = number(what.training.return?.mean);
    cells[6].textContent = number(what.training.cost?.mean);
    const share = what.total ? Math.min(1, what.frames / what.total) : null;
    row.progress.hidden = share == null || share >= 1;
    row.progress.value = share ?? 0;
    row.progress.setAttribute('aria-label', `Progress of ${what.algo} in ${env_name(what.env)}`);
    row.percent.textContent = `${short(what.frames / what.seeds)}${share != null && share < 1 ? `, ${Math.floor(100 * share)} %` : ''}`;
    row.percent.title = what.seeds > 1 ? 'frames of a run, on average' : 'frames';
    cells[8].textContent = what.states;
    cells[8].className = at_work(what) ? 'good' : 'pale';
  }
}
