import { ask, choose, field, keepState, make, number } from '/dom.js';
import { Screen } from '/screen.js';

// As in the window of `hasard play`.
const KEYS = { KeyW: 'MOVE_FORWARD', KeyS: 'MOVE_BACKWARD', KeyA: 'MOVE_LEFT', KeyD: 'MOVE_RIGHT', ArrowLeft: 'TURN_LEFT', ArrowRight: 'TURN_RIGHT', Space: 'JUMP', KeyE: 'USE', KeyC: 'CROUCH', ShiftLeft: 'SPEED', ShiftRight: 'SPEED', ControlLeft: 'ATTACK', ControlRight: 'ATTACK', KeyQ: 'SELECT_PREV_WEAPON', KeyT: 'TURN180' };
const TOUCH = [['TURN_LEFT', '↺'], ['MOVE_FORWARD', '↑'], ['TURN_RIGHT', '↻'], ['ATTACK', 'fire'], ['MOVE_LEFT', '←'], ['MOVE_BACKWARD', '↓'], ['MOVE_RIGHT', '→'], ['JUMP', 'jump'], ['SPEED', 'run'], ['USE', 'use']];

export function play(main, query) {
  const now = { env: query.get('env') ?? 'RemedyRushLevel1-v0', seed: query.get('seed') ?? '1', size: query.get('size') ?? '640x480', full: query.get('full') ?? '', hard: query.get('hard') ?? '' };
  let screen = null, paused = true, ended = false, looks = false;
  const form = make('div', { class: 'row' });
  const link = make('p', { class: 'bad', role: 'alert' });
  const canvas = make('canvas', { class: 'view', id: 'game', tabindex: 0, role: 'application', 'aria-label': 'The game. W A S D move, arrows turn, Space jumps, Control fires, P pauses.', width: 640, height: 480 });
  const numbers = make('div', { class: 'numbers', id: 'numbers' });
  const meter = make('meter', { min: 0, max: 1, value: 0, 'aria-label': 'Cost against the budget', style: 'width:100%' });
  const words = make('p', { role: 'status', id: 'words' }, 'Click the picture or press Enter to begin.');
  const task = make('p', { class: 'pale', id: 'task' });
  const table = make('tbody');
  const hold = (name) => ({ onpointerdown: (event) => { event.preventDefault(); begin(); press(name, true); }, onpointerup: () => press(name, false), onpointercancel: () => press(name, false), onpointerleave: () => press(name, false) });
  const touch = make('div', { class: 'touch' }, ...TOUCH.map(([name, text]) => make('button', { ...hold(name), 'aria-label': name }, text)));
  main.append(make('section', { class: 'card' }, make('h1', {}, 'Play'), form, link),
    make('section', { class: 'stage' },
      make('div', { class: 'card' }, canvas, numbers, meter, words, touch,
        make('div', { class: 'row' }, make('button', { class: 'main', id: 'begin', onclick: () => { begin(); canvas.focus(); } }, 'Begin'), make('button', { onclick: () => { screen?.ask({ do: 'again' }); begin(); canvas.focus(); } }, 'Again'), make('button', { onclick: () => { screen?.ask({ do: 'next' }); begin(); canvas.focus(); } }, 'Next seed')),
        task,
        make('p', { class: 'pale' }, 'W A S D move, arrows turn and look, the mouse turns once the picture is clicked (Esc frees it), Space jumps, E uses, C crouches, Shift runs, Ctrl or the left button fires, Q and the wheel change weapons, T turns round, P pauses, R begins again, N is the next seed.')),
      make('div', { class: 'card side' }, make('h2', {}, 'Best within the budget'), make('p', { class: 'pale' }, 'People and agents in this environment: those within the budget first, by return.'), make('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Best within the budget' }, make('table', { id: 'best' }, make('thead', {}, make('tr', {}, ...['who', 'return', 'cost', 'replay', 'download'].map((head) => make('th', { scope: 'col' }, head)))), table)))));

  const press = (key, down) => screen?.ask({ do: down ? 'press' : 'release', key });
  function begin() {
    if (ended) screen?.ask({ do: 'next' });
    screen?.ask({ do: 'go' });
    paused = false;
  }

  function open() {
    keepState('play', now);
    screen?.end();
    link.textContent = '';
    screen = new Screen(() => `/api/play?${new URLSearchParams({ env: now.env, seed: now.seed, size: now.size, full: now.full || 'false', hard: now.hard || 'false' })}`, { colour: canvas }, { onframe, onwords, onlink: (text) => { link.textContent = text; } });
    best();
  }

  function onwords(said) {
    if (said.kind === 'scene') task.textContent = `In this task: ${said.buttons.map((name) => name.replaceAll('_', ' ').toLowerCase()).join(', ')}${said.deltas ? ', and the mouse turns freely' : ''}. Other keys do nothing.`;
    if (said.kind === 'scene') looks = said.deltas > 0 || said.buttons.includes('LOOK_UP');
    else if (said.kind === 'kept') { words.textContent = `The episode is kept as ${said.name}. Enter: next, R: again.`; best(); }
  }

  function onframe(frame) {
    ({ paused, ended } = frame);
    const over = frame.cost > frame.budget;
    const told = (name, value, kind = '') => make('span', {}, name, make('b', { class: kind }, value));
    numbers.replaceChildren(told('time', `${frame.seconds.toFixed(1)} s`), told('return', number(frame.return)), told('cost of budget', `${number(frame.cost)} of ${number(frame.budget)}${over ? ' over' : ''}`, over ? 'bad' : 'good'), told('seed', String(frame.seed)));
    meter.value = frame.budget > 0 ? Math.min(1, (frame.cost / frame.budget) * 0.75) : Number(over);
    if (!ended) words.textContent = paused ? 'Paused. Click the picture or press Enter to go on.' : '';
  }

  async function best() {
    const rows = await ask('/api/best');
    if (!rows) return;
    const here = rows.filter((row) => row.env === now.env).slice(0, 50);
    table.replaceChildren(...here.map((row) => make('tr', {}, make('td', {}, row.who), make('td', { class: 'number' }, number(row.return)), make('td', { class: `number ${row.within ? 'good' : 'bad'}` }, `${number(row.cost)} ${row.within ? 'within' : 'over'}`),
      make('td', {}, make('a', { href: `#watch?agent=${encodeURIComponent(row.agent)}`, 'aria-label': `Watch ${row.who}, return ${number(row.return)}` }, 'watch')),
      make('td', {}, ...(row.episode ? ['episode', 'mp4', 'gif'].flatMap((kind) => [make('a', { href: `/api/episode?name=${encodeURIComponent(row.episode)}&kind=${kind}`, download: true }, `.${kind}`), ' ']) : [])))));
    if (!here.length) table.append(make('tr', {}, make('td', { colspan: 5, class: 'pale' }, 'Nobody yet: finish an episode and you are here.')));
  }

  const down = (event) => {
    if (event.target.matches('input,select,button,a') || event.repeat || event.altKey || event.metaKey) return;
    const key = { ArrowUp: looks ? 'LOOK_UP' : 'MOVE_FORWARD', ArrowDown: looks ? 'LOOK_DOWN' : 'MOVE_BACKWARD' }[event.code] ?? KEYS[event.code];
    if (event.type === 'keyup') { if (key) press(key, false); return; }
    if (key) { press(key, true); event.preventDefault(); }
    else if (event.code === 'Enter') begin();
    else if (event.code === 'KeyP') screen?.ask({ do: paused ? 'go' : 'pause' });
    else if (event.code === 'KeyR') { screen?.ask({ do: 'again' }); begin(); }
    else if (event.code === 'KeyN') { screen?.ask({ do: 'next' }); begin(); }
  };
  const caught = () => document.pointerLockElement === canvas;
  const blur = () => screen?.ask({ do: 'loose' });
  canvas.addEventListener('mousedown', (event) => {
    if (!caught() || paused) { canvas.requestPointerLock?.()?.catch?.(() => {}); begin(); }
    else press(event.button === 2 ? 'USE' : 'ATTACK', true);
  });
  canvas.addEventListener('mouseup', (event) => press(event.button === 2 ? 'USE' : 'ATTACK', false));
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('mousemove', (event) => { if (caught()) screen.ask({ do: 'mouse', right: event.movementX, down: event.movementY }); });
  canvas.addEventListener('wheel', (event) => { if (caught()) { const key = event.deltaY < 0 ? 'SELECT_NEXT_WEAPON' : 'SELECT_PREV_WEAPON'; press(key, true); press(key, false); } }, { passive: true });
  addEventListener('keydown', down);
  addEventListener('keyup', down);
  addEventListener('blur', blur);

  async function controls() {
    const what = await ask('/api/envs');
    if (!what) { setTimeout(controls, 1500); return; }
    const set = (name) => (value) => { now[name] = value; open(); };
    const seed = make('input', { type: 'number', min: 0, value: now.seed, style: 'width:7rem', onchange: () => set('seed')(seed.value || '1') });
    const tick = (name, text) => { const box = make('input', { type: 'checkbox', onchange: () => set(name)(box.checked ? 'true' : '') }); box.checked = now[name] === 'true'; return make('label', { class: 'check' }, box, text); };
    form.replaceChildren(field('environment', choose(what.envs.map((env) => env.id), now.env, set('env'))), field('seed', seed), field('size', choose(['320x240', '640x480', '1280x960'], now.size, set('size'))), tick('full', 'full actions'), tick('hard', 'hard constraint'));
    open();
  }
  controls();
  return () => { screen?.end(); removeEventListener('keydown', down); removeEventListener('keyup', down); removeEventListener('blur', blur); if (caught()) document.exitPointerLock(); };
}
