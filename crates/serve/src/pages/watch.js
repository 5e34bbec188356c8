import { ask, choose, field, keepState, make, number } from '/dom.js';
import { Screen } from '/screen.js';

const VIEWS = ['depth', 'segmented', 'automap'];

export function watch(main, query) {
  const now = { env: query.get('env') ?? '', agent: query.get('agent') ?? 'random', seed: query.get('seed') ?? '1', step: query.get('step') ?? '0',
    size: query.get('size') ?? '320x240', beside: query.get('beside') ?? 'depth,segmented,automap', best: query.get('best') ?? '', greedy: query.get('greedy') ?? '', paused: query.get('paused') ?? '' };
  let screen = null, scene = null, known = { returns: [], costs: [], events: [] }, paused = false, step = 0, ended = false;
  const form = make('div', { class: 'row' });
  const link = make('p', { class: 'bad', role: 'alert' });
  const canvases = Object.fromEntries(['colour', ...VIEWS].map((view) => [view, make('canvas', { class: 'view', role: 'img', 'aria-label': `${view} view`, width: 320, height: 240 })]));
  const figure = (view) => make('figure', { 'data-view': view }, canvases[view], make('figcaption', {}, view));
  const go = make('button', { class: 'main', id: 'go', onclick: () => screen?.ask({ do: paused || ended ? 'go' : 'pause' }) }, 'Pause');
  const speed = choose([['0.25', '¼ speed'], ['0.5', '½ speed'], ['1', 'normal speed'], ['2', '2 × speed'], ['4', '4 × speed'], ['8', '8 × speed']], '1', (value) => screen?.ask({ do: 'speed', value: Number(value) }));
  const slide = make('input', { type: 'range', min: 0, max: 525, value: 0, 'aria-label': 'Step', style: 'width:100%', oninput: () => jump(Number(slide.value)) });
  const line = make('canvas', { style: 'width:100%;height:70px;cursor:pointer', role: 'img', 'aria-label': 'Time line: return, cost, rewards and harms; click to jump', onclick: (event) => jump(Math.round((event.offsetX / line.clientWidth) * slide.max)) });
  const numbers = make('div', { class: 'numbers', id: 'numbers' });
  const thoughts = make('div');
  const events = make('div', { class: 'events', id: 'events' });
  const copied = make('span', { role: 'status', class: 'pale' });
  const copy = make('button', { id: 'copy', onclick: async () => { remember(); try { await navigator.clipboard.writeText(location.href); copied.textContent = 'Copied.'; } catch { copied.textContent = 'The address above is the link.'; } } }, 'Copy link to this moment');
  main.append(make('section', { class: 'card' }, make('h1', {}, 'Watch'), form, link),
    make('section', { class: 'stage' },
      make('div', { class: 'card' }, figure('colour'), numbers, slide, line,
        make('div', { class: 'row' }, go, make('button', { id: 'tic', onclick: () => screen?.ask({ do: 'tic' }) }, 'One tic'), make('button', { onclick: () => jump(Math.max(0, step - 1)) }, 'Step back'), make('button', { onclick: () => jump(step + 1) }, 'Step on'), field('speed', speed), copy, copied)),
      make('div', { class: 'beside card' }, ...VIEWS.map(figure))),
    make('section', { class: 'card' }, make('h2', {}, 'What it thinks'), thoughts, make('h2', {}, 'Events'), events));

  function remember() { keepState('watch', { ...now, step: String(step), paused: paused ? 'true' : '' }); }
  function jump(to) { screen?.ask({ do: 'jump', step: Math.max(0, Math.min(to, Number(slide.max))) }); }

  function begin() {
    keepState('watch', now);
    known = { returns: [], costs: [], events: [] };
    events.replaceChildren();
    link.textContent = '';
    for (const view of VIEWS) document.querySelector(`[data-view=${view}]`).hidden = !now.beside.includes(view);
    const path = () => {
      const asked = { env: now.env, agent: now.agent, seed: now.seed, step: String(now.step || 0), size: now.size, beside: now.beside, best: now.best || 'false', greedy: now.greedy || 'false', paused: now.paused || 'false' };
      return `/api/watch?${new URLSearchParams(asked)}`;
    };
    if (screen) screen.end();
    screen = new Screen(path, canvases, { onframe, onwords, onlink: (text) => { link.textContent = text; } });
  }

  function onwords(words) {
    if (words.kind === 'scene') {
      scene = words;
      slide.max = words.length;
      known = { returns: [], costs: [], events: [] };
      events.replaceChildren();
    } else if (words.kind === 'steps') {
      known.returns.length = known.costs.length = words.from;
      known.returns.push(...words.returns);
      known.costs.push(...words.costs);
      known.events.push(...words.events);
      events.append(...words.events.slice(0, 300).map((event) => make('button', { class: event.kind === 'harm' ? 'bad' : 'good', 'data-kind': event.kind, onclick: () => jump(event.step - 1) }, `${event.step}: ${event.what} ${number(event.size)}`)));
      if (words.over) slide.max = known.returns.length;
      drawLine();
    }
  }

  function drawLine() {
    const [width, height] = [(line.width = line.clientWidth * devicePixelRatio), (line.height = line.clientHeight * devicePixelRatio)];
    const pen = line.getContext('2d');
    const style = getComputedStyle(line);
    const x = (at) => (at / slide.max) * width;
    const curve = (values, top, colour) => {
      pen.strokeStyle = colour;
      pen.lineWidth = 2;
      pen.beginPath();
      values.forEach((value, k) => pen.lineTo(x(k + 1), height - 14 - (value / top) * (height - 22)));
      pen.stroke();
    };
    const bad = style.getPropertyValue('--bad'), good = style.getPropertyValue('--good');
    curve(known.returns, Math.max(1, ...known.returns), good);
    curve(known.costs, Math.max(scene?.budget ?? 1, 1, ...known.costs), bad);
    for (const event of known.events) {
      pen.fillStyle = event.kind === 'harm' ? bad : good;
      pen.fillRect(x(event.step) - 1, event.kind === 'harm' ? height - 12 : height - 6, 3, 6);
    }
    pen.fillStyle = style.getPropertyValue('--ink');
    pen.fillRect(x(step) - 1, 0, 2, height);
  }

  function onframe(frame) {
    ({ paused, ended, step } = frame);
    go.textContent = ended ? 'Again' : paused ? 'Go on' : 'Pause';
    if (document.activeElement !== slide) slide.value = step;
    const over = scene && frame.cost > scene.budget;
    const told = (name, value, kind = '') => make('span', {}, name, make('b', { class: kind }, value));
    numbers.replaceChildren(told('step', String(step)), told('time', `${(frame.tic / 35).toFixed(1)} s`), told('return', number(frame.return)), told('cost of budget', `${number(frame.cost)} of ${number(scene?.budget)}${over ? ' over' : ''}`, over ? 'bad' : 'good'),
      ...(scene?.terms ?? []).map((name, k) => told(name, number(frame.terms[k]))), ...(frame.value == null ? [] : [told('value', number(frame.value))]), ...(frame.cost_values ?? []).map((value, k) => told(`cost value ${k + 1}`, number(value))));
    const rows = [];
    (scene?.groups ?? []).forEach((names, group) => ['nothing', ...names].forEach((name, choice) => {
      const share = frame.probabilities?.[group]?.[choice];
      const taken = frame.actions?.[group] === choice;
      if (share == null && !taken) return;
      rows.push(make('div', { class: 'bar' }, make('span', { class: taken ? '' : 'pale' }, `${taken ? '▸ ' : ''}${name}`), share == null ? make('span') : make('meter', { min: 0, max: 1, value: share, 'aria-label': `Probability of ${name}` }), make('span', {}, share == null ? '' : `${Math.round(share * 100)} %`)));
    }));
    thoughts.replaceChildren(...rows);
    drawLine();
  }

  async function controls() {
    const [what, runs, table] = await Promise.all([ask('/api/envs'), ask('/api/runs'), ask('/api/best')]);
    if (!what || !runs || !table) { setTimeout(controls, 1500); return; }
    const agents = [...what.policies.map((name) => [name, name]), ...what.zoo.map((name) => [`zoo:${name}`, `zoo: ${name}`]), ...runs.runs.slice(0, 500).map((run) => [`run:${run.id}`, `run: ${run.name}`]), ...table.filter((row) => row.episode).slice(0, 200).map((row) => [row.agent, `episode: ${row.episode}`])];
    if (!agents.some(([name]) => name === now.agent)) agents.push([now.agent, now.agent]);
    const own = now.agent.includes(':') && !/^(sticky|hold)/.test(now.agent);
    if (!now.env && !own) now.env = 'VolcanicVentureLevel1-v0';
    const restart = (name) => (value) => { now[name] = value; now.step = '0'; now.paused = ''; if (name === 'agent' && /^(run|zoo|episode):/.test(value)) now.env = ''; if (name === 'agent' && !now.env && !/^(run|zoo|episode):/.test(value)) now.env = 'VolcanicVentureLevel1-v0'; controls(); };
    const seed = make('input', { type: 'number', min: 0, value: now.seed, style: 'width:7rem', onchange: () => restart('seed')(seed.value || '1') });
    const tick = (name, text) => { const box = make('input', { type: 'checkbox', onchange: () => restart(name)(box.checked ? 'true' : '') }); box.checked = now[name] === 'true'; return make('label', { class: 'check' }, box, text); };
    const besides = VIEWS.map((view) => { const box = make('input', { type: 'checkbox', onchange: () => { const on = new Set(now.beside.split(',').filter(Boolean)); if (box.checked) on.add(view); else on.delete(view); now.beside = VIEWS.filter((one) => on.has(one)).join(','); now.step = String(step); begin(); } }); box.checked = now.beside.includes(view); return make('label', { class: 'check' }, box, view); });
    form.replaceChildren(field('environment', choose([['', 'the agent’s own'], ...what.envs.map((env) => env.id)], now.env, restart('env'))), field('agent', choose(agents, now.agent, restart('agent'))), field('seed', seed), field('size', choose(['160x120', '320x240', '640x480'], now.size, (value) => { now.size = value; now.step = String(step); begin(); })), ...besides, tick('greedy', 'likeliest actions'), tick('best', 'best checkpoint'));
    begin();
  }
  const keys = (event) => {
    if (event.target.matches('input,select,button')) return;
    if (event.key === ' ') { go.click(); event.preventDefault(); } else if (event.key === '.') screen?.ask({ do: 'tic' });
    else if (event.key === 'ArrowRight') jump(step + 1);
    else if (event.key === 'ArrowLeft') jump(Math.max(0, step - 1));
  };
  addEventListener('keydown', keys);
  controls();
  return () => { screen?.end(); removeEventListener('keydown', keys); };
}
