import { make, number } from '/dom.js';

const NUMBERS = ['seed', 'fps', 'return', 'cost', 'budget', 'multiplier'];
const last = (name) => (run) => run.last[name] ?? -Infinity;
// Heads of the columns, and what they are sorted by; a name with a minus before it is the other way round.
const HEADS = [['run', (run) => run.name], ['environment', (run) => run.env], ['algorithm', (run) => run.algo], ['seed', (run) => run.seed], ['progress', (run) => (run.last.frames ?? 0) / (run.total ?? 1)], ['fps', last('fps')],
  ['return', last('return_mean')], ['cost', last('cost_mean')], ['budget', (run) => run.budget], ['multiplier', last('multiplier')], ['state', (run) => run.state]];

// The table of runs. A row stays the same element while its run changes, so that what the user points at or has focused stays.
export class Rows {
  constructor(onpick, onsort) {
    this.onpick = onpick;
    this.rows = new Map();
    this.body = make('tbody');
    this.heads = HEADS.map(([name]) => make('th', { scope: 'col', class: NUMBERS.includes(name) ? 'number' : '' }, make('button', { class: 'sort', onclick: () => onsort(this.sort === name ? `-${name}` : name) }, name)));
    const table = make('table', {}, make('thead', {}, make('tr', {}, make('th', { scope: 'col' }, make('span', { class: 'unseen' }, 'compare')), ...this.heads)), this.body);
    this.element = make('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Runs' }, table);
  }

  sorted(runs, sort) {
    const [, key] = HEADS.find(([name]) => name === sort.replace('-', '')) ?? [];
    const by_name = (a, b) => a.name.localeCompare(b.name, 'en', { numeric: true });
    if (!key) return runs.sort((a, b) => (b.state === 'running') - (a.state === 'running') || by_name(a, b));
    const way = sort.startsWith('-') ? -1 : 1;
    return runs.sort((a, b) => { const [x, y] = [key(a), key(b)]; return way * (typeof x === 'string' ? x.localeCompare(y, 'en', { numeric: true }) : x - y) || by_name(a, b); });
  }

  show(runs, chosen, sort) {
    this.sort = sort;
    this.heads.forEach((head, k) => {
      const [name] = HEADS[k];
      if (sort.replace('-', '') === name) head.setAttribute('aria-sort', sort.startsWith('-') ? 'descending' : 'ascending');
      else head.removeAttribute('aria-sort');
    });
    const rows = runs.map((run) => this.row(run, chosen.has(run.id)));
    const here = new Set(runs.map((run) => run.id));
    for (const [id, row] of this.rows) if (!here.has(id)) { row.element.remove(); this.rows.delete(id); }
    rows.forEach((row, k) => { if (this.body.children[k] !== row) this.body.insertBefore(row, this.body.children[k] ?? null); });
  }

  row(run, chosen) {
    let row = this.rows.get(run.id);
    if (!row) {
      const box = make('input', { type: 'checkbox', 'aria-label': `Compare ${run.name}`, 'data-run': run.id, onchange: () => this.onpick(run.id, box.checked) });
      const cells = HEADS.map(([name]) => make('td', { class: NUMBERS.includes(name) ? 'number' : '' }));
      row = { box, cells, element: make('tr', {}, make('td', {}, box), ...cells) };
      cells[0].append(make('a', { href: `#run?id=${run.id}` }, run.name));
      [cells[1].textContent, cells[2].textContent, cells[3].textContent] = [run.env, run.algo, run.seed];
      row.progress = make('progress', { max: 1, 'aria-label': `Progress of ${run.name}` });
      row.percent = make('span', { class: 'pale' });
      cells[4].append(row.progress, row.percent);
      this.rows.set(run.id, row);
    }
    row.box.checked = chosen;
    if (row.run !== run) this.fill(row, run);
    return row.element;
  }

  fill(row, run) {
    row.run = run;
    const { last } = run;
    row.progress.max = run.total ?? 1;
    row.progress.value = last.frames ?? 0;
    row.percent.textContent = run.total ? ` ${Math.min(100, Math.floor((100 * (last.frames ?? 0)) / run.total))} %` : '';
    row.cells[4].title = run.state === 'running' && run.total && last.fps ? `${number((run.total - last.frames) / last.fps / 60, 0)} minutes left` : '';
    const within = last.cost_mean == null ? '' : last.cost_mean <= run.budget ? 'good' : 'bad';
    const multipliers = last.multiplier ?? (last.multipliers && Object.values(last.multipliers));
    const text = [number(last.fps, 0), number(last.return_mean), `${number(last.cost_mean)}${within === 'bad' ? ' over' : within === 'good' ? ' within' : ''}`, number(run.budget), [multipliers].flat().map((one) => number(one, 3)).join(' '), run.state];
    text.forEach((value, k) => { row.cells[5 + k].textContent = value; });
    row.cells[7].className = `number ${within}`;
    row.cells[10].className = run.state === 'running' ? 'good' : 'pale';
  }
}
