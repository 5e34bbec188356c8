// Return against cost: experiments as points with intervals both ways, their seeds as small ones, the budget dashed.
import { make } from '/dom.js';
import { scale, short, ticks } from '/scale.js';
import { downloads, inks, path, redrawn, shape, standalone, text } from '/svg.js';

const LEFT = 62, RIGHT = 16, TOP = 14, BOTTOM = 44, HEIGHT = 280;
// Height of a line of words, and the mean width of a letter in it.
const LINE = 15, LETTER = 6.8;

// Where names stand so that none covers another: beside its point, above or below, then further up or down. `points` are
// [x, y, name]; `taken` are boxes of other words, [left, top, right, bottom].
export function places(points, width, taken = []) {
  const boxes = [...taken, ...points.map(([x, y]) => [x - 6, y - 6, x + 6, y + 6])];
  const meets = (one) => boxes.some((box) => one[0] < box[2] && one[2] > box[0] && one[1] < box[3] && one[3] > box[1]);
  return points.map(([x, y, name]) => {
    const long = name.length * LETTER;
    const rows = Array.from({ length: 12 }, (_, k) => (k % 2 ? LINE + 4 : -8) + (k % 2 ? 1 : -1) * Math.floor(k / 2) * LINE);
    const sides = x + 9 + long > width ? [-9] : x - 9 - long < LEFT ? [9] : [9, -9];
    const choices = rows.flatMap((row) => sides.map((side) => ({ x: x + side, y: y + row, anchor: side < 0 ? 'end' : 'start' })));
    const box = (one) => [one.anchor === 'end' ? one.x - long : one.x, one.y - 11, one.anchor === 'end' ? one.x : one.x + long, one.y + 3];
    const inside = (one) => one.y > TOP + 8 && one.y < HEIGHT - BOTTOM;
    const found = choices.find((one) => inside(one) && !meets(box(one))) ?? choices[0];
    boxes.push(box(found));
    return found;
  });
}

export function scatter(title, rows, budget) {
  const svg = shape('svg', { class: 'chart', role: 'img', height: HEIGHT, 'aria-label': `Return against cost, ${title}: ${rows.map((row) => `${row.name} returns ${short(row.return.value)} at cost ${short(row.cost.value)}`).join('; ')}` });
  const file = `pareto-${title}`.replace(/\W+/g, '-');
  const table = () => [['experiment', 'return', 'return low', 'return high', 'cost', 'cost low', 'cost high', 'budget', 'seeds'], ...rows.map((row) => [row.name, row.return.value, row.return.low, row.return.high, row.cost.value, row.cost.low, row.cost.high, row.budget, row.n])];
  const saves = downloads(`return against cost, ${title}`, file, () => standalone(svg, `Return against cost, ${title}`, rows), table);
  const figure = make('figure', {}, make('figcaption', {}, make('span', { class: 'row' }, make('b', {}, title), saves)), svg);
  const draw = () => {
    const width = svg.clientWidth;
    if (!width) return;
    svg.setAttribute('width', width);
    const ink = inks(svg);
    const ends = (one) => [one.value, one.low ?? one.value, one.high ?? one.value];
    const costs = rows.flatMap((row) => [...ends(row.cost), ...row.costs]), returns = rows.flatMap((row) => [...ends(row.return), ...row.returns]);
    const [across, up] = [ticks(Math.min(0, ...costs), Math.max(...costs, budget ?? 0, 1e-9) * 1.05), ticks(Math.min(0, ...returns), Math.max(...returns, 1e-9) * 1.08)];
    const x = scale([across[0], across.at(-1)], [LEFT, width - RIGHT]), y = scale([up[0], up.at(-1)], [HEIGHT - BOTTOM, TOP]);
    const parts = [];
    for (const value of up) parts.push(path([[LEFT, y(value)], [width - RIGHT, y(value)]], { stroke: ink.line }), text(short(value), LEFT - 6, y(value) + 4, ink.pale, { 'text-anchor': 'end' }));
    for (const value of across) parts.push(path([[x(value), HEIGHT - BOTTOM], [x(value), HEIGHT - BOTTOM + 4]], { stroke: ink.pale }), text(short(value), x(value), HEIGHT - BOTTOM + 17, ink.pale, { 'text-anchor': 'middle' }));
    parts.push(text('cost per episode', (LEFT + width) / 2, HEIGHT - 8, ink.pale, { 'text-anchor': 'middle' }), text('return per episode', 0, 0, ink.pale, { 'text-anchor': 'middle', transform: `translate(14 ${(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)` }));
    if (budget != null) parts.push(path([[x(budget), TOP], [x(budget), HEIGHT - BOTTOM]], { stroke: ink.bad, 'stroke-width': 1.5, 'stroke-dasharray': '6 4' }), text(`budget ${short(budget)}`, x(budget) + (x(budget) > width - 90 ? -5 : 5), TOP + 10, ink.bad, { 'text-anchor': x(budget) > width - 90 ? 'end' : 'start' }));
    const left = budget != null && x(budget) > width - 90;
    const named = budget == null ? [] : [[x(budget) - (left ? 85 : 0), TOP - 2, x(budget) + (left ? 0 : 85), TOP + 14]];
    const labels = places(rows.map((row) => [x(row.cost.value), y(row.return.value), row.name]), width, named);
    for (const [k, row] of rows.entries()) {
      const [cx, cy, label] = [x(row.cost.value), y(row.return.value), labels[k]];
      if (row.n > 1) row.costs.forEach((cost, k) => parts.push(shape('circle', { cx: x(cost), cy: y(row.returns[k]), r: 2.5, fill: row.colour, opacity: 0.6 })));
      if (row.cost.low != null) parts.push(path([[x(row.cost.low), cy], [x(row.cost.high), cy]], { stroke: row.colour, 'stroke-width': 1.5 }));
      if (row.return.low != null) parts.push(path([[cx, y(row.return.low)], [cx, y(row.return.high)]], { stroke: row.colour, 'stroke-width': 1.5 }));
      parts.push(shape('circle', { cx, cy, r: 6, fill: row.colour, stroke: ink.card, 'stroke-width': 1.5 }, shape('title', {}, `${row.name}: return ${short(row.return.value)}, cost ${short(row.cost.value)}`)), text(row.name, label.x, label.y, ink.ink, { 'text-anchor': label.anchor }));
    }
    svg.replaceChildren(...parts);
  };
  redrawn(svg, svg, draw);
  return figure;
}
