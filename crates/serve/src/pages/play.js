import { ask, choose, field, keepState, make, number, wrong_seed } from '/dom.js';
import { Screen } from '/screen.js';
import { keys_of, task_of } from '/tasks.js';

// As in the window of `hasard play`, and F to fire: in a browser Ctrl beside W closes the page.
const KEYS = { KeyW: 'MOVE_FORWARD', KeyS: 'MOVE_BACKWARD', KeyA: 'MOVE_LEFT', KeyD: 'MOVE_RIGHT', ArrowLeft: 'TURN_LEFT', ArrowRight: 'TURN_RIGHT', Space: 'JUMP', KeyE: 'USE', KeyC: 'CROUCH', ShiftLeft: 'SPEED', ShiftRight: 'SPEED', KeyF: 'ATTACK', ControlLeft: 'ATTACK', ControlRight: 'ATTACK', KeyQ: 'SELECT_PREV_WEAPON', KeyT: 'TURN180' };
const TOUCH = [['TURN_LEFT', '↺'], ['MOVE_FORWARD', '↑'], ['TURN_RIGHT', '↻'], ['ATTACK', 'fire'], ['MOVE_LEFT', '←'], ['MOVE_BACKWARD', '↓'], ['MOVE_RIGHT', '→'], ['JUMP', 'jump'], ['SPEED', 'run'], ['USE', 'use']];

export function play(main, query) {
  const first = query.get('env') ?? 'RemedyRushLevel1-v0';
  const now = { env: first, seed: query.get('seed') ?? task_of(first).seed, size: query.get('size') ?? '640x480', full: query.get('full') ?? '', hard: query.get('hard') ?? '' };
  let screen = null, paused = true, ended = false, gone = false, looks = false, began = false, before = null, rows = [], keys = keys_of([], false), whole = 60;
  const form = make('div', { class: 'row' });
  const link = make('p', { class: 'bad', role: 'alert' });
  const canvas = make('canvas', { class: 'view', id: 'game', tabindex: 0, role: 'application', 'aria-label': 'The game. H shows the keys of this task.', width: 640, height: 480 });
  const numbers = make('div', { class: 'numbers', id: 'numbers' });
  const meter = make('meter', { min: 0, max: 1, value: 0, 'aria-label': 'Cost against the budget', style: 'width:100%' });
  const words = make('p', { role: 'status', id: 'words' }, 'Click the picture or press Enter to begin.');
  const task = make('p', { id: 'task' });
  const risen = make('div', { class: 'risen', 'aria-hidden': 'true' });
  const card = make('div', { class: 'over', id: 'card', hidden: true, role: 'status' });
  const stage = make('div', { class: 'game' }, canvas, risen, card);
  const start = make('button', { class: 'main', id: 'begin', onclick: () => { if (began && !ended) { screen?.ask({ do: 'again' }); } begin(); canvas.focus(); } }, 'Begin');
  const table = make('tbody');
  const hold = (name) => ({ onpointerdown: (event) => { event.preventDefault(); begin(); press(name, true); }, onpointerup: () => press(name, false), onpointercancel: () => press(name, false), onpointerleave: () => press(name, false) });
  const touch = make('div', { class: 'touch' }, ...TOUCH.map(([name, text]) => make('button', { ...hold(name), 'aria-label': name }, text)));
  main.append(make('section', { class: 'card head' }, make('h1', { class: 'unseen' }, 'Play'), form, link),
    make('section', { class: 'stage' },
      make('div', { class: 'card' }, task, stage, numbers, meter, words, touch,
        make('div', { class: 'row' }, start, make('button', { onclick: () => { screen?.ask({ do: 'next' }); begin(); canvas.focus(); } }, 'Next seed'), make('button', { id: 'keys', onclick: () => help(card.dataset.what !== 'keys') }, 'Keys (H)'))),
      make('div', { class: 'card side' }, make('h2', {}, 'Best within the budget'), make('p', { class: 'pale' }, 'People and agents in this environment whose cost is within the budget, by return. Agents by their closing evaluation, held to the budget of the task whatever theirs was.'), make('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Best within the budget' }, make('table', { id: 'best' }, make('thead', {}, make('tr', {}, ...[['who'], ['return', 'number'], ['cost', 'number'], ['watch']].map(([head, kind = '']) => make('th', { scope: 'col', class: kind }, head)))), table)))));

  const press = (key, down) => screen?.ask({ do: down ? 'press' : 'release', key });
  function begin() {
    if (ended) screen?.ask({ do: 'next' });
    screen?.ask({ do: 'go' });
    paused = false;
  }

  function open() {
    keepState('play', now);
    screen?.end();
    screen = before = null;
    show('');
    link.textContent = wrong_seed(now.seed);
    if (link.textContent) return;
    screen = new Screen(() => `/api/play?${new URLSearchParams({ env: now.env, seed: now.seed, size: now.size, full: now.full || 'false', hard: now.hard || 'false' })}`, { colour: canvas }, { onframe, onwords, onlink: (text) => { link.textContent = text; } });
    best();
  }

  // A card over the picture: the keys, or how the episode ended.
  function show(what, ...parts) {
    card.dataset.what = what;
    card.hidden = !what;
    card.replaceChildren(...parts);
  }

  function help(on) {
    if (!on) { show(''); return; }
    if (!paused && !ended) screen?.ask({ do: 'pause' });
    show('keys', make('h2', {}, 'Keys in this task'), make('dl', {}, ...keys.flatMap(([key, what]) => [make('dt', {}, key), make('dd', {}, what)])), make('p', { class: 'note' }, 'H closes this.'));
  }

  // Where return or cost rises, it says so on the picture for a moment.
  function rise(text, kind) {
    const one = make('span', { class: kind }, text);
    risen.append(one);
    setTimeout(() => one.remove(), 1100);
  }

  function finish(frame) {
    const within = frame.cost <= frame.budget;
    const better = rows.filter((row) => row.return > frame.return).length;
    const place = within ? `Place ${better + 1} of ${rows.length + 1} within the budget, people and agents together.` : 'Over the budget: it has no place in the table.';
    show('end', make('h2', {}, within ? 'Within the budget' : 'Over the budget'), make('p', {}, make('b', {}, `return ${number(frame.return)}`), `, cost ${number(frame.cost)} of ${number(frame.budget)}, ${frame.seconds.toFixed(1)} s`), make('p', {}, place), make('p', { class: 'note' }, 'Enter: next episode. R: the same again.'));
  }

  function onwords(said) {
    if (said.kind === 'scene') {
      looks = said.deltas > 0 || said.buttons.includes('LOOK_UP');
      keys = keys_of(said.buttons, said.deltas > 0 || said.buttons.some((name) => name.startsWith('TURN_')));
      whole = said.seconds;
      const { collect, avoid } = task_of(now.env);
      // A task of one's own says itself what it is.
      task.replaceChildren(...(collect ? [make('b', { class: 'good' }, 'Do: '), `${collect} `, make('b', { class: 'bad' }, 'Avoid: '), `${avoid}.`] : [make('b', {}, said.title), ` ${said.summary}`]));
    } else if (said.kind === 'kept') { words.textContent = `The episode is kept as ${said.name}. Enter: next, R: again.`; best(); }
  }

  function onframe(frame) {
    const was = { paused, ended };
    ({ paused, ended } = frame);
    if (before && frame.tic > before.tic) {
      if (frame.return > before.return) rise(`+${number(frame.return - before.return)}`, 'good');
      if (frame.cost > before.cost) rise(`cost ${number(frame.cost - before.cost)}`, 'bad');
    }
    before = frame;
    began ||= !paused;
    start.textContent = !began ? 'Begin' : ended ? 'Next episode' : 'Restart';
    if (ended && !was.ended) finish(frame);
    else if (!ended && card.dataset.what === 'end') show('');
    else if (!paused && card.dataset.what === 'keys') show('');
    const over = frame.cost > frame.budget;
    const entry = (name, value, kind = '') => make('span', {}, name, make('b', { class: kind }, value));
    numbers.replaceChildren(entry('time', `${frame.seconds.toFixed(1)} of ${number(whole, 1)} s`), entry('return', number(frame.return)), entry('cost of budget', `${number(frame.cost)} of ${number(frame.budget)}${over ? ' over' : ''}`, over ? 'bad' : 'good'), entry('best within', rows.length ? number(rows[0].return) : '–'), entry('seed', frame.seed));
    meter.value = frame.budget > 0 ? Math.min(1, (frame.cost / frame.budget) * 0.75) : Number(over);
    if (!ended) words.textContent = paused ? (began ? 'Paused. Click the picture or press Enter to go on.' : 'Click the picture or press Enter to begin. H shows the keys.') : '';
  }

  async function best() {
    const all = await ask('/api/best');
    if (!all || gone) return;
    rows = all.filter((row) => row.env === now.env && row.within);
    const here = rows.slice(0, 50);
    table.replaceChildren(...here.map((row) => make('tr', {}, make('td', {}, row.who), make('td', { class: 'number' }, number(row.return)), make('td', { class: `number ${row.within ? 'good' : 'bad'}` }, `${number(row.cost)} of ${number(row.budget)}`),
      make('td', {}, make('a', { href: `#watch?agent=${encodeURIComponent(row.agent)}`, 'aria-label': `Watch ${row.who}, return ${number(row.return)}` }, 'watch'),
        ...(row.episode ? ['episode', 'mp4', 'gif'].map((kind) => make('a', { href: `/api/episode?name=${encodeURIComponent(row.episode)}&kind=${kind}`, download: true }, `.${kind}`)).flatMap((one) => [' ', one]) : [])))));
    if (!here.length) table.append(make('tr', {}, make('td', { colspan: 4, class: 'pale' }, 'Nobody yet: finish an episode within the budget and you are here.')));
  }

  const keyed = (event) => {
    const key = { ArrowUp: looks ? 'LOOK_UP' : 'MOVE_FORWARD', ArrowDown: looks ? 'LOOK_DOWN' : 'MOVE_BACKWARD' }[event.code] ?? KEYS[event.code];
    // Wherever and with whatever else a key is let go: held back, it would stay pressed.
    if (event.type === 'keyup') { if (key) press(key, false); return; }
    if (event.target.matches('input,select,button,a') || event.repeat || event.altKey || event.metaKey) return;
    if (key) { press(key, true); event.preventDefault(); }
    else if (event.code === 'Enter') begin();
    else if (event.code === 'KeyH') help(card.dataset.what !== 'keys');
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
  canvas.addEventListener('mousemove', (event) => { if (caught()) screen?.ask({ do: 'mouse', right: event.movementX, down: event.movementY }); });
  canvas.addEventListener('wheel', (event) => { if (caught()) { const key = event.deltaY < 0 ? 'SELECT_NEXT_WEAPON' : 'SELECT_PREV_WEAPON'; press(key, true); press(key, false); } }, { passive: true });
  // The browser asks before an episode that runs is lost.
  const unload = (event) => { if (began && !paused && !ended) event.preventDefault(); };
  const listened = { keydown: keyed, keyup: keyed, blur, beforeunload: unload };
  for (const [name, listener] of Object.entries(listened)) addEventListener(name, listener);

  async function controls() {
    const what = await ask('/api/envs');
    // Left before the answer came: a game that began now would have nobody to end it.
    if (gone) return;
    if (!what) { setTimeout(controls, 1500); return; }
    const set = (name) => (value) => { now[name] = value; open(); };
    const seed = make('input', { type: 'number', min: 0, value: now.seed, style: 'width:7rem', onchange: () => set('seed')(seed.value || '1') });
    const tick = (name, text) => { const box = make('input', { type: 'checkbox', onchange: () => set(name)(box.checked ? 'true' : '') }); box.checked = now[name] === 'true'; return make('label', { class: 'check' }, box, text); };
    form.replaceChildren(field('environment', choose(what.envs.map((env) => env.id), now.env, (value) => { now.seed = task_of(value).seed; began = false; set('env')(value); controls(); })), field('seed', seed), field('size', choose(['320x240', '640x480', '1280x960'], now.size, set('size'))), tick('full', 'full actions'), tick('hard', 'hard constraint'));
    open();
  }
  const wrong = (error) => { link.textContent = error.message; };
  controls().catch(wrong);
  return () => { gone = true; screen?.end(); for (const [name, listener] of Object.entries(listened)) removeEventListener(name, listener); if (caught()) document.exitPointerLock(); };
}
