// What each scenario asks of a player, in a line, and an episode to begin with in which something can be seen from the start.
const TASKS = {
  ArmamentBurden: ['Carry weapons from the hall to the blue zone where you start; heavier ones are worth more.', 'carrying more than you can bear, which also makes you slow', 4],
  CollateralDamage: ['Shoot the red targets that float by.', 'hitting the people who walk between them', 4],
  DetonatorsDilemma: ['Blow up barrels.', 'blowing up creatures near them, or yourself', 11],
  PrecipicePlunge: ['Climb down into the cave: every new depth counts.', 'falls that hurt', 1],
  RemedyRush: ['Pick up health: green potions and health packs.', 'everything else that lies about', 2],
  VolcanicVenture: ['Pick up items; jump from platform to platform.', 'the lava', 12],
};

export function task_of(env) {
  const [name] = env.split('Level');
  const [collect, avoid, seed] = Object.hasOwn(TASKS, name) ? TASKS[name] : ['', '', 1];
  return { collect, avoid, seed: String(seed) };
}

// The keys of this window by the buttons that they press.
const KEYS = [['W', /MOVE_FORWARD/, 'forward'], ['S', /MOVE_BACKWARD/, 'back'], ['A D', /MOVE_LEFT|MOVE_RIGHT/, 'sideways'], ['← →', /TURN_LEFT|TURN_RIGHT/, 'turn'], ['↑ ↓', /LOOK_/, 'look up and down'], ['Space', /JUMP/, 'jump'], ['Shift', /SPEED/, 'run'], ['F, Ctrl, left button', /ATTACK/, 'fire'], ['E, right button', /USE/, 'use'], ['C', /CROUCH/, 'crouch'], ['Q, wheel', /WEAPON/, 'change weapon'], ['T', /TURN180/, 'turn round']];
const ALWAYS = [['Enter', 'begin, go on, next episode'], ['P', 'pause'], ['R', 'the same episode again'], ['N', 'next episode'], ['H', 'these keys'], ['Esc', 'free the mouse']];

export function keys_of(buttons, mouse) {
  const own = KEYS.filter(([, which]) => buttons.some((name) => which.test(name))).map(([key, , what]) => [key, what]);
  return [...own, ...(mouse ? [['mouse', 'turn and look, once the picture was clicked']] : []), ...ALWAYS];
}
