// Experiments side by side: a facet for each environment, one legend that switches curves, means over seeds, return against cost.
import { ask, make, number, renew } from '/dom.js';
import { Chart, Shared } from '/chart.js';
import { by_seed, column, folded } from '/curves.js';
import { picker, title_of, USUAL } from '/metrics.js';
import { env_name, labels } from '/names.js';
import { repeated } from '/rows.js';
import { scatter } from '/scatter.js';
import { settingsTable } from '/settings.js';
import { colour, dash } from '/svg.js';
import { kept as kept_tools, tools } from '/tools.js';

const COMPARED = 12;

export class Comparison {
  constructor(query, onchange) {
    Object.assign(this, { shared: new Shared(), onchange, runs: [], experiments: [], data: {}, metrics: [], hidden: new Set(), drawn: '', settled: '', asked: 0 });
    this.chosen = new Set(query.get('metrics')?.split(',').filter(Boolean) ?? USUAL);
    this.seeds = make('input', { type: 'checkbox', onchange: () => { this.draw(); onchange(); } });
    this.seeds.checked = query.get('seeds') !== 'false';
    this.report = make('a', { class: 'button', target: '_blank' }, 'Report of these runs');
    this.legend = make('div', { class: 'row legend', role: 'group', 'aria-label': 'Curves' });
    this.wrong = make('p', { class: 'bad', role: 'alert' });
    [this.picked, this.facets, this.table, this.pareto, this.differences] = Array.from({ length: 5 }, () => make('div'));
    const bar = tools(this.shared, query, (again) => { if (again) this.draw(); onchange(); });
    bar.append(make('label', { class: 'check' }, this.seeds, 'mean and 95 % interval over seeds'), this.report);
    this.element = make('section', { class: 'card', hidden: true, id: 'curves' }, make('h2', {}, 'Compare'), bar, this.picked, this.wrong, this.legend, this.facets,
      make('p', { class: 'note' }, 'Drag over a curve to look closer, double-click to go back; with the keyboard +, -, arrows and 0.'),
      make('h2', {}, 'Inter-quartile means over seeds'), this.table, this.pareto, make('h2', {}, 'Settings that differ'), this.differences);
  }

  end() { this.shared.clear(); }

  kept() {
    const same = String([...this.chosen]) === String(USUAL);
    return { metrics: same ? '' : [...this.chosen].join(','), seeds: this.seeds.checked ? '' : 'false', ...kept_tools(this.shared) };
  }

  async show(runs, options) {
    this.runs = runs;
    this.element.hidden = !runs.length;
    if (!runs.length) return;
    const keys = [...new Set(runs.map((run) => run.experiment))];
    const first = keys.map((key) => runs.find((run) => run.experiment === key));
    const named = labels(first.map((run) => ({ env: run.env, algo: run.algo, total: run.total, options: options.get(run.experiment) ?? {} })));
    // One colour for one name: the same algorithm and settings in several environments are one entry of the legend.
    const texts = [...new Set(named.map((one) => one.text))];
    this.experiments = keys.map((key, k) => ({ key, env: first[k].env, budget: first[k].budget, label: named[k], place: texts.indexOf(named[k].text), skip: Number(options.get(key)?.frame_skip ?? 4) }));
    this.report.href = `/api/report?runs=${runs.map((run) => run.id).join(',')}`;
    const turn = ++this.asked;
    await this.load(turn);
    const settled = runs.map((run) => `${run.id} ${run.settled}`).join(',');
    if (this.settled === settled) return;
    this.settled = settled;
    const some = first.slice(0, COMPARED).map((run, k) => ({ ...run, label: `${named[k].text}, ${env_name(run.env)}` }));
    const table = await settingsTable(some);
    if (table) this.differences.replaceChildren(...(first.length > COMPARED ? [make('p', { class: 'pale' }, `Of the first ${COMPARED} experiments.`)] : []), table);
  }

  async load(turn = this.asked) {
    const ids = this.runs.map((run) => run.id).join(',');
    const asked = Promise.all([ask(`/api/curves?runs=${ids}&columns=${[...this.chosen].map(encodeURIComponent).join(',')}`), ask(`/api/compare?runs=${ids}`), ask(`/api/metrics?runs=${ids}`)]);
    let why = '';
    const [data, means, metrics] = await asked.catch((error) => { why = error.message; return []; });
    if (turn === this.asked) this.wrong.textContent = why;
    // Answers may overtake each other: only the one to what is chosen now counts.
    if (!data || !means || !metrics || turn !== this.asked) return;
    this.data = data;
    // Those of all that are chosen: one may report what the others do not, and a run that goes on may begin to.
    const names = (all) => String(all.map((metric) => metric.name));
    if (names(metrics) !== names(this.metrics) || !this.picked.firstChild) { this.metrics = metrics; this.show_picker(); }
    this.draw();
    this.show_means(means);
  }

  show_picker() {
    const list = picker(this.metrics, this.chosen, () => { this.show_picker(); this.load(); this.onchange(); });
    list.open = this.picked.querySelector('details')?.open ?? false;
    const focused = document.activeElement?.dataset?.metric;
    this.picked.replaceChildren(list);
    if (focused) list.querySelector(`[data-metric="${CSS.escape(focused)}"]`)?.focus({ preventScroll: true });
  }

  draw() {
    this.show_legend();
    const envs = [...new Set(this.experiments.map((one) => one.env))].sort();
    const names = [...this.chosen];
    const wanted = `${envs} ${names}`;
    if (this.drawn !== wanted) {
      this.drawn = wanted;
      this.shared.clear();
      this.facets.replaceChildren(...envs.map((env) => make('section', { class: 'facet' }, make('h3', {}, env_name(env)), make('div', { class: 'charts' }, ...names.map((name) => {
        const of = this.metrics.find((metric) => metric.name === name);
        return this.shared.add(Object.assign(new Chart(this.shared, { title: `${title_of(name)}, ${env_name(env)}`, unit: of?.unit, what: title_of(name), file: `${env}-${name}`.replace(/\W+/g, '-') }), { env, name })).element;
      })))));
    }
    for (const chart of this.shared.charts) {
      const here = this.experiments.filter((one) => one.env === chart.env);
      chart.series = here.flatMap((one) => this.series(one, chart.name));
      const budgets = new Set(here.map((one) => one.budget));
      chart.budgets = chart.name.endsWith('cost_mean') ? [...budgets].map((value) => ({ name: `budget ${value}`, value })) : [];
      chart.draw();
    }
  }

  series(one, name) {
    if (this.hidden.has(one.label.text)) return [];
    const ink = { colour: colour(one.place), dash: dash(one.place) };
    const all = this.runs.filter((run) => run.experiment === one.key && this.data[run.id]);
    const { counted, repeats } = by_seed(all);
    // A mean is of each seed once; each for itself, all are there.
    const own = this.seeds.checked ? counted : all;
    const curves = own.map((run) => ({ name: `${one.label.text}, seed ${run.seed}${repeats.includes(run) ? ' (repeats)' : ''}`, ...ink, ...column(this.data[run.id], name, this.shared.over, one.skip) }));
    if (!this.seeds.checked) return curves;
    const text = own.length > 1 ? `${one.label.text} (${own.length} seeds)` : one.label.text;
    return [...(own.length > 1 ? curves.map((curve) => ({ ...curve, kind: 'thin' })) : []), { name: text, ...ink, ...folded(curves) }];
  }

  show_legend() {
    const entries = new Map(this.experiments.map((one) => [one.label.text, one]));
    const entry = ([text, one]) => make('button', { class: 'small', 'aria-pressed': String(!this.hidden.has(text)), title: one.label.full, 'data-legend': text, onclick: () => { if (!this.hidden.delete(text)) this.hidden.add(text); this.draw(); } },
      make('b', { 'aria-hidden': 'true', style: `color:${colour(one.place)}` }, '━ '), text);
    renew(this.legend, ...[...entries].map(entry));
  }

  show_means(facets) {
    const of = (key) => this.experiments.find((one) => one.key === key);
    const said = (one) => (one ? `${number(one.value)}${one.low == null ? '' : ` [${number(one.low)}, ${number(one.high)}]`}` : '–');
    const rows = facets.flatMap(({ env, source, rows: all }) => all.map((row) => {
      const within = row.cost && row.cost.value <= row.budget;
      return make('tr', {}, make('td', {}, env_name(env)), make('th', { scope: 'row' }, of(row.experiment)?.label.text ?? row.algo), make('td', { class: 'number' }, `${row.n}${repeated(row.repeats)}`), make('td', { class: 'number' }, said(row.return)),
        make('td', { class: `number ${within ? 'good' : 'bad'}` }, `${said(row.cost)} of ${number(row.budget)} ${within ? 'within' : 'over'}`), make('td', { class: 'pale' }, source === 'evaluation' ? 'closing evaluations' : 'latest training episodes'));
    }));
    const heads = make('tr', {}, ...['environment', 'experiment', 'seeds', 'return', 'cost of budget', 'from'].map((head, k) => make('th', { scope: 'col', class: k > 1 && k < 5 ? 'number' : '' }, head)));
    renew(this.table, make('p', { class: 'note' }, 'In brackets: 95 % of 2,000 bootstrap samples over seeds; a single seed has none.'), make('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Inter-quartile means' }, make('table', { id: 'means', class: facets.length > 1 ? '' : 'single' }, make('thead', {}, heads), make('tbody', {}, ...rows))));
    const plots = facets.map((facet) => scatter(env_name(facet.env), facet.rows.filter((row) => row.return && row.cost).map((row) => ({ ...row, name: of(row.experiment)?.label.text ?? row.algo, colour: colour(of(row.experiment)?.place ?? 0) })), facet.rows[0]?.budget));
    renew(this.pareto, make('h2', {}, 'Return against cost'), make('p', { class: 'note' }, 'Large: inter-quartile means with their intervals; small: seeds. Right of the dashed line is above the budget.'), make('div', { class: 'charts' }, ...plots));
    plots.forEach((plot) => plot.dispatchEvent(new Event('shown')));
  }
}
