import { ask, coded, make } from '/dom.js';

const said = (value) => (value == null ? '–' : Array.isArray(value) ? value.map((one) => (typeof one === 'object' && one ? Object.entries(one).map(([key, inner]) => `${key} ${inner}`).join(' ') : String(one))).join(', ') || 'none' : typeof value === 'object' ? JSON.stringify(value) : String(value));

function table(heads, rows, label) {
  const head = make('tr', {}, ...heads.map((name) => make('th', { scope: 'col' }, name)));
  return make('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': label }, make('table', { class: 'settings' }, make('thead', {}, head), make('tbody', {}, ...rows)));
}

const name_cell = (row) => make('th', { scope: 'row' }, make('code', {}, row.name), make('span', { class: 'note' }, ...coded(row.meaning ?? '')));

// The settings of one run: first those that are not as in its preset, then all others, folded.
export function ownSettings(settings, preset) {
  const differ = settings.filter((row) => row.differs), rest = settings.filter((row) => !row.differs);
  const line = (row) => make('tr', {}, name_cell(row), make('td', {}, said(row.value)), make('td', { class: 'pale' }, said(row.preset)));
  const heads = ['setting', 'this run', `preset ${preset}`];
  const first = differ.length ? table(heads, differ.map(line), 'Settings that differ from the preset') : make('p', { class: 'pale' }, `Every setting is as in the preset ${preset}.`);
  const other = make('details', {}, make('summary', {}, `The other ${rest.length} settings`), table(heads, rest.map(line), 'The other settings'));
  return make('div', { id: 'settings' }, first, ...(rest.length ? [other] : []));
}

// Settings of several runs that differ, a column a run.
export async function settingsTable(runs) {
  const all = await ask(`/api/settings?runs=${runs.map((run) => run.id).join(',')}`);
  if (!all) return null;
  const columns = runs.map((run) => new Map(all[run.id].map((row) => [row.name, row])));
  const names = [...new Set(columns.flatMap((column) => [...column.keys()]))].filter((name) => !['seed', 'version', 'changes'].includes(name));
  const rows = names.filter((name) => new Set(columns.map((column) => said(column.get(name)?.value))).size > 1)
    .map((name) => make('tr', {}, name_cell(columns.find((column) => column.has(name)).get(name)), ...columns.map((column) => make('td', {}, said(column.get(name)?.value)))));
  if (!rows.length) return make('p', { class: 'pale' }, 'All settings are equal.');
  return table(['setting', ...runs.map((run) => run.label ?? run.name)], rows, 'Settings that differ');
}
