// Names for people, without what stands beside them.

// `VolcanicVentureLevel1-v0` as "Volcanic Venture 1"; an id of another shape stays.
export function env_name(id) {
  // Several tasks of one run.
  if (id.includes(',')) return id.split(',').map(env_name).join(' + ');
  const found = /^(?:hasard\/)?([A-Z][A-Za-z]*)Level(\d)-v(\d+)$/.exec(id);
  if (!found) return id;
  const words = found[1].replace(/([a-z])([A-Z])/g, '$1 $2').replace(/^Detonators /, 'Detonator’s ');
  return `${words} ${found[2]}${found[3] === '0' ? '' : ` v${found[3]}`}`;
}

// A run's path without the parts that environment, algorithm and seed say already.
export function path_rest(run) {
  const said = [run.env, run.env.replace(/-v\d+$/, ''), run.algo, `seed${run.seed}`, `seed_${run.seed}`, `seed-${run.seed}`, `s${run.seed}`, String(run.seed)].map((one) => String(one).toLowerCase());
  // As Windows writes it, unless the path is of another system: there a name may hold a \.
  const between = run.name.includes('/') ? '/' : '\\';
  return run.name.split(between).filter((part) => !said.includes(part.toLowerCase())).join(between);
}

// Options that always stand beside an algorithm's name, if a run has them: what matters most first.
const LISTED = ['preset', 'rules', 'hard', 'full_actions', 'observation', 'constraints', 'safety_budget', 'cost_scale', 'curriculum', 'frame_skip', 'frame_stack'];
const word = (name, value) => (name === 'preset' ? value : name === 'rules' ? (value === 'paper' ? '' : `rules ${value}`) : value === 'true' ? name.replaceAll('_', ' ') : `${name.replace(/^.*\./, '').replaceAll('_', ' ')} ${value}`);

// A few words for each experiment: what always stands beside the algorithm, and what distinguishes those that read the same.
export function labels(experiments) {
  const first = experiments.map(({ options }) => LISTED.filter((name) => options[name] != null).map((name) => word(name, options[name])).filter(Boolean));
  const look = (k) => `${experiments[k].env} ${experiments[k].algo} ${first[k]}`;
  const alike = new Map();
  experiments.forEach((_, k) => alike.set(look(k), [...(alike.get(look(k)) ?? []), k]));
  return experiments.map((own, k) => {
    const others = alike.get(look(k)).map((at) => experiments[at]);
    const names = [...new Set(others.flatMap(({ options }) => Object.keys(options)))].sort();
    const differ = others.length < 2 ? [] : names.filter((name) => !LISTED.includes(name) && new Set(others.map(({ options }) => options[name])).size > 1);
    const more = differ.map((name) => word(name, own.options[name] ?? 'not given'));
    if (others.length > 1 && new Set(others.map(({ total }) => total)).size > 1) more.push(`${Intl.NumberFormat('en', { notation: 'compact' }).format(own.total ?? 0)} frames`);
    const shown = [...first[k], ...more.slice(0, 2), ...(more.length > 2 ? [`${more.length - 2} more`] : [])];
    return { algo: own.algo, rest: shown.join(' · '), text: [own.algo, ...shown].join(' · '), full: [...first[k], ...more].join(', ') };
  });
}
