// What is set for all charts of a page: the axis, smoothing, a logarithmic scale.
import { choose, field, make } from '/dom.js';
import { AXES } from '/scale.js';

export function tools(shared, query, onchange) {
  Object.assign(shared, { over: AXES.some(([name]) => name === query.get('x')) ? query.get('x') : 'frames', smooth: Math.min(0.98, Math.max(0, Number(query.get('smooth')) || 0)), log: query.get('log') === 'true' });
  const said = make('output', {});
  const say = () => { said.textContent = shared.smooth ? `moving average, weight ${shared.smooth} (pale: as reported)` : 'none'; };
  const smooth = make('input', { type: 'range', min: 0, max: 0.98, step: 0.02, value: shared.smooth, 'aria-label': 'Smoothing: weight of the exponential moving average', oninput: () => { shared.smooth = Number(smooth.value); say(); shared.draw(); onchange(false); } });
  const log = make('input', { type: 'checkbox', onchange: () => { shared.log = log.checked; shared.draw(); onchange(false); } });
  log.checked = shared.log;
  say();
  const over = choose(AXES, shared.over, (value) => { shared.over = value; shared.range = null; onchange(true); });
  return make('div', { class: 'row tools' }, field('horizontal axis', over), make('label', {}, 'smoothing', make('span', { class: 'row middle' }, smooth, said)), make('label', { class: 'check' }, log, 'log scale'));
}

// What of them a link holds.
export const kept = (shared) => ({ x: shared.over === 'frames' ? '' : shared.over, smooth: shared.smooth || '', log: shared.log || '' });
