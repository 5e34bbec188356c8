// A run's result in one line: return, cost of budget, how often over, which checkpoint, how long.
import { make, number } from '/dom.js';
import { short } from '/scale.js';

export const interval = (one, digits = 2) => (one == null ? '–' : `${number(one.mean, digits)}${one.half == null ? '' : ` ± ${number(one.half, digits)}`}`);

export function duration(seconds) {
  if (seconds == null) return '–';
  const [hours, minutes] = [Math.floor(seconds / 3600), Math.floor((seconds % 3600) / 60)];
  return hours ? `${hours} h ${minutes} min` : minutes ? `${minutes} min` : `${Math.round(seconds)} s`;
}

const KEPT = { surely: ['within', 'good', 'within the budget, with the upper end of the 95 % interval'], mean: ['mean within', 'good', 'the mean is within the budget, the upper end of its 95 % interval is not'], over: ['over', 'bad', 'the mean is above the budget'], unknown: ['–', 'pale', ''] };
export const verdict = (kept) => KEPT[kept] ?? KEPT.unknown;

function tile(name, value, { kind = '', note = '', title = '' } = {}) {
  return make('div', { class: 'tile', title }, make('span', { class: 'pale' }, name), make('b', { class: kind }, value), make('span', { class: 'note' }, note));
}

// Of the selected checkpoint; without one, of the latest training episodes.
export function strip(run, over) {
  const found = run.evaluation;
  const evaluated = found?.return != null;
  const tiles = [];
  if (evaluated) {
    const source = `${found.episodes} closing episodes`;
    tiles.push(tile('return', interval(found.return), { note: source }));
    for (const one of found.costs) {
      const [word, kind, title] = verdict(one.kept);
      tiles.push(tile(found.costs.length > 1 ? `cost: ${one.name}` : 'cost of budget', `${interval(one.cost)} of ${number(one.budget)}`, { kind, note: word, title }));
    }
    tiles.push(tile('episodes over', over == null ? '–' : `${number(100 * over, 0)} %`, { note: over == null ? 'single episodes not kept' : 'cost above the budget' }));
  } else {
    const { return_mean, cost_mean } = run.last;
    const within = cost_mean == null ? 'unknown' : cost_mean <= run.budget ? 'mean' : 'over';
    tiles.push(tile('return', number(return_mean), { note: 'latest training episodes' }));
    tiles.push(tile('cost of budget', cost_mean == null ? '–' : `${number(cost_mean)} of ${number(run.budget)}`, { kind: verdict(within)[1], note: 'latest training episodes' }));
  }
  const frames = run.last.frames;
  tiles.push(tile('selected checkpoint', found ? `${short(found.frames)} frames` : 'none yet', { note: found ? `of ${short(frames)}` : 'chosen at the end of the run' }));
  const left = run.state === 'running' && run.total && run.last.fps ? `${duration((run.total - frames) / run.last.fps)} left` : run.total && frames ? `${number(frames, 0)} of ${number(run.total, 0)} frames` : '';
  tiles.push(tile(run.state, duration(run.last.wall_s), { note: left }));
  return tiles;
}
