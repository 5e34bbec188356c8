// Which of the logged metrics are drawn: a list by groups, each with what it means.
import { coded, make } from '/dom.js';

export const USUAL = ['return_mean', 'cost_mean'];
// An evaluation is drawn on the chart of what it evaluates.
const EVALUATED = { return_mean: ['eval/return_mean', 'eval/return_ci95'], cost_mean: ['eval/cost_mean', 'eval/cost_ci95'], length_mean: ['eval/length_mean', 'eval/length_ci95'] };
const TITLES = { return_mean: 'Return', cost_mean: 'Cost', length_mean: 'Length of episodes', fps: 'Frames a second', multiplier: 'Lagrange multiplier', entropy: 'Entropy' };

// Names come from files: one may be that of something that every object has.
const own = (all, name) => (Object.hasOwn(all, name) ? all[name] : null);
export const evaluation_of = (name) => own(EVALUATED, name) ?? (/^(cost|task)\//.test(name) ? [`eval/${name}`, ''] : []);
export const title_of = (name) => own(TITLES, name) ?? name.replace(/^(stats|eval)\//, (whole) => (whole === 'eval/' ? 'evaluation: ' : '')).replaceAll('_', ' ');

// What is drawn at first: return, cost, the multiplier of a run that has one (else how well the critic predicts), how certain the policy is.
export function usual(metrics, last = {}) {
  const more = [(last.multiplier ?? 0) !== 0 ? 'multiplier' : 'explained_variance', 'entropy'];
  return [...USUAL, ...more.filter((wanted) => metrics.some(({ name }) => name === wanted))];
}

// A list that opens; `chosen` is a set that it changes.
export function picker(metrics, chosen, onchange) {
  const groups = new Map();
  for (const metric of metrics) groups.set(metric.group, [...(groups.get(metric.group) ?? []), metric]);
  const one = (metric) => {
    const box = make('input', { type: 'checkbox', 'data-metric': metric.name, onchange: () => { if (box.checked) chosen.add(metric.name); else chosen.delete(metric.name); onchange(); } });
    box.checked = chosen.has(metric.name);
    return make('label', { class: 'check metric' }, box, make('span', {}, make('code', {}, metric.name), metric.unit ? ` (${metric.unit})` : '', make('span', { class: 'note' }, ...coded(metric.meaning))));
  };
  return make('details', { class: 'picker' }, make('summary', {}, `Metrics: ${chosen.size} of ${metrics.length} shown`), make('div', { class: 'groups' }, ...[...groups].map(([name, all]) => make('fieldset', {}, make('legend', {}, name), ...all.map(one)))));
}
