import { ask, choose, fetch_on_click, field, keepState, make, number, wrong_seed } from '/dom.js';
import { Screen } from '/screen.js';
import { env_name, path_rest } from '/names.js';
import { Timeline } from '/timeline.js';
import { Episodes } from '/episodes.js';
import { Pair } from '/pair.js';

const VIEWS = ['depth', 'segmented', 'automap'];
const SPEEDS = [['0.25', '¼ speed'], ['0.5', '½ speed'], ['1', 'normal speed'], ['2', '2 × speed'], ['4', '4 × speed'], ['8', '8 × speed']];
const FIRST = 'VolcanicVentureLevel1-v0';
// What a link holds, and what it is where the link does not say.
const STATE = { env: '', agent: 'random', seed: '1', step: '0', size: '640x480', beside: VIEWS.join(','), best: '', greedy: '', hard: '', full: '', rules: 'paper', paused: '', second: '' };
// What the buttons of a group do together.
const GROUPS = [['turn', /TURN_|TURN180/], ['strafe', /MOVE_LEFT|MOVE_RIGHT/], ['move', /MOVE_/], ['look', /LOOK_/], ['jump', /JUMP/], ['run', /SPEED/], ['attack', /ATTACK/], ['crouch', /CROUCH/], ['use', /USE/], ['weapon', /WEAPON/]];
const run_name = (run) => [`${run.algo}, ${env_name(run.env)}, seed ${run.seed}`, path_rest(run)].filter(Boolean).join(' – ');
export const group_name = (buttons) => (GROUPS.find(([, all]) => buttons.every((name) => all.test(name))) ?? GROUPS.find(([, some]) => buttons.some((name) => some.test(name))) ?? ['buttons'])[0];
// What of the state a second agent shares.
const SHARED = ['seed', 'step', 'size', 'hard', 'full', 'rules', 'paused'];
const has_task = (agent) => /^(run|zoo|episode):/.test(agent);

export function watch(main, query) {
  const now = Object.fromEntries(Object.entries(STATE).map(([name, usual]) => [name, query.get(name) ?? usual]));
  let names = {}, screen = null, scene = null, paused = false, step = 0, ended = false, gone = false;
  const form = make('div', { class: 'row' });
  const link = make('p', { class: 'bad', role: 'alert' });
  const canvases = Object.fromEntries(['colour', ...VIEWS].map((view) => [view, make('canvas', { class: 'view', role: 'img', 'aria-label': `${view} view`, width: 320, height: 240 })]));
  const figures = Object.fromEntries(VIEWS.map((view) => [view, make('figure', { 'data-view': view }, canvases[view], make('figcaption', {}, view === 'automap' ? 'map' : view))]));
  const filmed = make('span', { role: 'status' });
  const film = fetch_on_click(make('a', { class: 'button', id: 'film', title: 'The whole episode as MP4' }, 'Download film'), filmed);
  const button = (text, title, onclick, more = {}) => make('button', { title, onclick, ...more }, text);
  const pair = new Pair();
  const send = (message) => { screen?.ask(message); pair.ask(message); };
  const episodes = new Episodes((seed) => { Object.assign(now, { seed, step: '0', paused: '', greedy: '', best: now.agent.startsWith('run:') ? 'true' : '' }); controls(); });
  const go = button('Pause', 'Space', () => send({ do: paused || ended ? 'go' : 'pause' }), { class: 'main', id: 'go' });
  const speed = choose(SPEEDS, '1', (value) => send({ do: 'speed', value: Number(value) }));
  speed.setAttribute('aria-label', 'Speed');
  const on = make('input', { type: 'checkbox', id: 'on' });
  const time = new Timeline(jump);
  const numbers = make('div', { class: 'numbers', id: 'numbers' });
  const thoughts = make('div', { id: 'thoughts' });
  const copied = make('span', { role: 'status', class: 'pale' });
  const copy = button('Copy link to this moment', 'The link holds environment, agent, seed and step', async () => {
    keepState('watch', { ...now, step: String(step), paused: paused ? 'true' : '' });
    try { await navigator.clipboard.writeText(location.href); copied.textContent = 'Copied.'; } catch { copied.textContent = 'The address above is the link.'; }
  }, { id: 'copy' });
  const next = button('Next seed', 'Another episode; of a running training, with its newest checkpoint', () => screen?.ask({ do: 'next' }), { id: 'next' });
  main.append(make('section', { class: 'card head' }, make('h1', { class: 'unseen' }, 'Watch'), form, link),
    make('section', { class: 'stage' },
      make('div', { class: 'card' }, make('div', { class: 'pair' }, make('figure', {}, canvases.colour, pair.first), pair.element), numbers, time.slide, time.line, time.key,
        make('div', { class: 'row' }, go, button('+1 frame', '.', () => send({ do: 'tic' }), { id: 'tic' }), button('−1 action', 'Left arrow', () => jump(step - 1)), button('+1 action', 'Right arrow', () => jump(step + 1)), speed, next,
          make('label', { class: 'check' }, on, 'go on with the next seed'), copy, film, copied, filmed),
        make('p', { class: 'pale' }, 'Keys: Space plays and pauses, the full stop shows one frame (a game tic), arrows go an action back and on.')),
      make('div', { class: 'card side' }, make('div', { class: 'beside' }, figures.automap, figures.depth, figures.segmented), episodes.element,
        make('h2', {}, 'Policy'), thoughts, make('h2', {}, 'Events'), make('p', { class: 'pale' }, 'Click one to jump to the moment before it.'), time.events)));

  function jump(to) { send({ do: 'jump', step: Math.max(0, Math.min(to, Number(time.slide.max))) }); }

  function begin() {
    keepState('watch', now);
    link.textContent = wrong_seed(now.seed);
    for (const view of VIEWS) figures[view].hidden = !now.beside.split(',').includes(view);
    const flag = (name) => [name, now[name] || 'false'];
    // After a server was away the show goes on where it was.
    const path = () => `/api/watch?${new URLSearchParams({ ...now, step: String(now.step || 0), ...Object.fromEntries(['best', 'greedy', 'hard', 'full', 'paused'].map(flag)) })}`;
    film.href = path().replace('/api/watch?', '/api/film?');
    screen?.end();
    if (link.textContent) { screen = null; pair.end(); return; }
    screen = new Screen(path, canvases, { onframe, onwords, onlink: (text) => { link.textContent = text; } });
    if (speed.value !== '1') speed.value = '1';
    if (!now.second) pair.end();
    episodes.of(!now.agent.startsWith('episode:') ? new URLSearchParams({ agent: now.agent, env: now.env, best: now.agent.startsWith('run:') ? 'true' : 'false' }).toString() : '', now.seed);
  }

  // The second agent begins where the first is, in its environment.
  function begin_second() {
    if (!now.second) return;
    const shared = Object.fromEntries(SHARED.map((name) => [name, now[name] || (name === 'step' ? '0' : 'false')]));
    pair.begin(names[now.second] ?? now.second, new URLSearchParams({ ...shared, rules: now.rules, env: scene.env, agent: now.second, best: String(now.second.startsWith('run:')) }));
  }

  function onwords(words) {
    if (words.kind === 'scene') {
      scene = words;
      // Another episode begins at its start.
      if (now.seed !== words.seed) Object.assign(now, { seed: words.seed, step: '0', paused: '' });
      const seed = form.querySelector('input[type=number]');
      if (seed) seed.value = now.seed;
      if (speed.value !== '1') screen.ask({ do: 'speed', value: Number(speed.value) });
      time.begin(words);
      episodes.at(now.seed, words.budget);
      begin_second();
    } else if (words.kind === 'steps') time.steps(words);
  }

  function onframe(frame) {
    if (frame.ended && !ended && on.checked) screen.ask({ do: 'next' });
    ({ paused, ended, step } = frame);
    Object.assign(now, { step: String(step), paused: paused ? 'true' : '' });
    go.textContent = ended ? 'Again' : paused ? 'Play' : 'Pause';
    const over = scene && frame.cost > scene.budget;
    pair.first.textContent = `${names[now.agent] ?? now.agent}: step ${step}, return ${number(frame.return)}, cost ${number(frame.cost)} of ${number(scene?.budget)}${over ? ', over' : ''}${ended ? ', ended' : ''}`;
    const entry = (name, value, kind = '', title = '') => make('span', { title }, name.replaceAll('_', ' '), make('b', { class: kind }, value));
    const terms = (scene?.terms ?? []).length > 1 || (scene?.terms ?? [])[0] !== 'cost' ? scene?.terms ?? [] : [];
    // What the critics expect from here on: in units of returns and costs, where those are known.
    const own = frame.expected?.length, several = (frame.cost_values ?? []).length > 1;
    const unit = own ? 'Discounted sum that the critic expects from here on' : 'What the critic expects from here on, in normalised units: this file does not hold the scale';
    const critic = (name, k, plain) => entry(own ? `expected ${name}` : `${name} value (normalised)`, number(own ? frame.expected[k] : plain), '', unit);
    numbers.replaceChildren(entry('step', String(step)), entry('time', `${(frame.tic / 35).toFixed(1)} s`), entry('return', number(frame.return)), entry('cost of budget', `${number(frame.cost)} of ${number(scene?.budget)}${over ? ' over' : ''}`, over ? 'bad' : 'good'),
      ...terms.map((name, k) => entry(name, number(frame.terms[k]))), ...(frame.value == null ? [] : [critic('return', 0, frame.value)]), ...(frame.cost_values ?? []).map((value, k) => critic(several ? `cost ${k + 1}` : 'cost', k + 1, value)));
    think(frame);
    time.at(step);
  }

  function think(frame) {
    const rows = (scene?.groups ?? []).map((names, group) => make('div', { class: 'group', role: 'group', 'aria-label': group_name(names) }, make('b', { class: 'name-of-group' }, group_name(names)), ...['none', ...names].map((name, choice) => {
      const share = frame.probabilities?.[group]?.[choice];
      const taken = frame.actions?.[group] === choice;
      if (share == null && !taken) return null;
      return make('div', { class: 'bar' }, make('span', { class: taken ? '' : 'pale' }, `${taken ? '▸ ' : ''}${name.replaceAll('_', ' ').toLowerCase()}`), share == null ? make('span') : make('meter', { min: 0, max: 1, value: share, 'aria-label': `Probability of ${name}` }), make('span', {}, share == null ? '' : `${Math.round(share * 100)} %`));
    })));
    const hint = frame.probabilities ? null : make('p', { class: 'pale' }, 'This one follows a fixed rule: marked is what it does. A trained agent shows its probabilities here.');
    thoughts.replaceChildren(...rows, ...(hint ? [hint] : []));
  }

  async function controls() {
    const [what, runs, table] = await Promise.all([ask('/api/envs'), ask('/api/runs'), ask('/api/best')]);
    if (gone) return;
    if (!what || !runs || !table) { setTimeout(controls, 1500); return; }
    const groups = { 'fixed policies': what.policies.map((name) => [name, name]), 'the zoo': what.zoo.map((name) => [`zoo:${name}`, name]), runs: runs.runs.slice(0, 500).map((run) => [`run:${run.id}`, run_name(run)]), 'recorded episodes': table.filter((row) => row.episode).slice(0, 200).map((row) => [row.agent, row.episode]) };
    names = Object.fromEntries(groups.runs);
    if (!Object.values(groups).flat().some(([name]) => name === now.agent)) groups['from the link'] = [[now.agent, now.agent]];
    if (!now.env && !has_task(now.agent)) now.env = FIRST;
    const restart = (name) => (value) => {
      Object.assign(now, { [name]: value, step: '0', paused: '' });
      if (name === 'agent') now.env = has_task(value) ? '' : now.env || FIRST;
      controls();
    };
    const redraw = (name) => (value) => { now[name] = value; begin(); };
    const seed = make('input', { type: 'number', min: 0, value: now.seed, style: 'width:7rem', onchange: () => restart('seed')(seed.value || '1') });
    const tick = (name, text) => { const box = make('input', { type: 'checkbox', onchange: () => restart(name)(box.checked ? 'true' : '') }); box.checked = now[name] === 'true'; return make('label', { class: 'check' }, box, text); };
    const besides = VIEWS.map((view) => {
      const box = make('input', { type: 'checkbox', onchange: () => { const set = new Set(now.beside.split(',')); if (box.checked) set.add(view); else set.delete(view); redraw('beside')(VIEWS.filter((one) => set.has(one)).join(',')); } });
      box.checked = now.beside.split(',').includes(view);
      return make('label', { class: 'check' }, box, view === 'automap' ? 'map' : view);
    });
    const of_agent = /^(run|zoo):/.test(now.agent) ? [tick('greedy', 'greedy'), ...(now.agent.startsWith('run:') ? [tick('best', 'selected checkpoint')] : [])] : [];
    const of_task = has_task(now.agent) ? [] : [tick('hard', 'hard constraint'), tick('full', 'full actions'), field('rules', choose(['paper', 'released', 'tables'], now.rules, restart('rules')))];
    const agent = choose([], '', restart('agent'));
    for (const [name, list] of Object.entries(groups)) if (list.length) agent.append(make('optgroup', { label: name }, ...list.map(([key, text]) => make('option', { value: key, selected: key === now.agent }, text))));
    const beside = choose([['', 'nobody']], now.second, (value) => { Object.assign(now, { second: value }); pair.end(); begin(); });
    for (const [name, list] of Object.entries(groups)) if (list.length && name !== 'recorded episodes') beside.append(make('optgroup', { label: name }, ...list.map(([key, text]) => make('option', { value: key, selected: key === now.second }, text))));
    beside.id = 'beside';
    const own = has_task(now.agent) ? [['', 'the agent’s own']] : [];
    form.replaceChildren(field('environment', choose([...own, ...what.envs.map((env) => env.id)], now.env, restart('env'))), field('agent', agent), field('beside it', beside), field('seed', seed), field('size', choose(['160x120', '320x240', '640x480', '1280x960'], now.size, redraw('size'))), ...besides, ...of_agent, ...of_task);
    begin();
  }
  const keys = (event) => {
    if (event.target.matches('input,select,button,a') || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === ' ') { go.click(); event.preventDefault(); } else if (event.key === '.') send({ do: 'tic' });
    else if (event.key === 'ArrowRight') jump(step + 1);
    else if (event.key === 'ArrowLeft') jump(step - 1);
  };
  addEventListener('keydown', keys);
  controls().catch((error) => { link.textContent = error.message; });
  return () => { gone = true; screen?.end(); pair.end(); removeEventListener('keydown', keys); };
}
