// Return against cost: experiments as points with intervals both ways, their seeds as small ones, the budget dashed.
import { make } from '/dom.js';
import { scale, short, ticks } from '/scale.js';
import { downloads, inks, path, shape, standalone, text } from '/svg.js';

const LEFT = 62, RIGHT = 16, TOP = 14, BOTTOM = 44, HEIGHT = 280;

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
    for (const row of rows) {
      const [cx, cy] = [x(row.cost.value), y(row.return.value)];
      if (row.n > 1) row.costs.forEach((cost, k) => parts.push(shape('circle', { cx: x(cost), cy: y(row.returns[k]), r: 2.5, fill: row.colour, opacity: 0.6 })));
      if (row.cost.low != null) parts.push(path([[x(row.cost.low), cy], [x(row.cost.high), cy]], { stroke: row.colour, 'stroke-width': 1.5 }));
      if (row.return.low != null) parts.push(path([[cx, y(row.return.low)], [cx, y(row.return.high)]], { stroke: row.colour, 'stroke-width': 1.5 }));
      const end = cx > width - 150;
      parts.push(shape('circle', { cx, cy, r: 6, fill: row.colour, stroke: ink.card, 'stroke-width': 1.5 }, shape('title', {}, `${row.name}: return ${short(row.return.value)}, cost ${short(row.cost.value)}`)), text(row.name, cx + (end ? -9 : 9), cy - 8, ink.ink, { 'text-anchor': end ? 'end' : 'start' }));
    }
    svg.replaceChildren(...parts);
  };
  const sized = new ResizeObserver(draw);
  sized.observe(svg);
  return figure;
}
