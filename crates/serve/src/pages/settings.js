import { ask, make } from '/dom.js';

// Settings as a flat list of names and values, nested names joined by dots.
export function flat(value, name = '', out = new Map()) {
  if (Array.isArray(value) && value.every((one) => typeof one !== 'object')) out.set(name, value.join(', '));
  else if (value && typeof value === 'object') for (const [key, inner] of Object.entries(value)) flat(inner, name ? `${name}.${key}` : key, out);
  else out.set(name, String(value));
  return out;
}

// A table of settings, a column a run; where runs differ, the row says so. `only`: nothing but those rows.
export async function settingsTable(runs, only) {
  const all = await ask(`/api/settings?runs=${runs.map((run) => run.id).join(',')}`);
  if (!all) return null;
  const columns = runs.map((run) => flat(all[run.id]));
  const names = [...new Set(columns.flatMap((column) => [...column.keys()]))];
  const differs = (name) => new Set(columns.map((column) => column.get(name))).size > 1;
  const rows = names.filter((name) => !only || differs(name)).map((name) => make('tr', { class: differs(name) ? 'differs' : '' },
    make('th', { scope: 'row' }, name, differs(name) && !only ? make('span', { class: 'pale' }, ' differs') : null), ...columns.map((column) => make('td', {}, column.get(name) ?? '–'))));
  if (!rows.length) return make('p', { class: 'pale' }, runs.length > 1 ? 'All settings are equal.' : 'No settings.');
  const heads = make('tr', {}, make('th', { scope: 'col' }, 'setting'), ...runs.map((run) => make('th', { scope: 'col' }, run.name)));
  return make('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Settings' }, make('table', {}, make('thead', {}, heads), make('tbody', {}, ...rows)));
}
