// Elements from data. Text is always set as text, so that nothing in a run's name or settings is ever markup.
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, '');
    else if (value !== false && value != null) element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child != null));
  return element;
}

// Puts other children into a place. What was scrolled there stays where it was, and what had the focus passes it to what now has
// its name: a page that follows a run is not torn from under the reader with each new row.
export function renew(place, ...children) {
  const name = (one) => `${one.tagName} ${one.getAttribute('aria-label') ?? one.textContent}`;
  const scrolled = () => [...place.querySelectorAll('.scroll')];
  const before = new Map(scrolled().map((one) => [name(one), [one.scrollLeft, one.scrollTop]]));
  const focused = place.contains(document.activeElement) ? name(document.activeElement) : null;
  place.replaceChildren(...children);
  for (const one of scrolled()) [one.scrollLeft, one.scrollTop] = before.get(name(one)) ?? [0, 0];
  if (focused !== null) [...place.querySelectorAll('a,button,input,select,summary,[tabindex]')].find((one) => name(one) === focused)?.focus({ preventScroll: true });
}

// A text in which what stands between two backticks is code.
export function coded(text) {
  return text.split('`').map((part, k) => (k % 2 ? make('code', {}, part) : part));
}

export function field(label, control) {
  return make('label', {}, label, control);
}

export function choose(options, value, onchange) {
  const select = make('select', { onchange: () => onchange?.(select.value) });
  for (const option of options) {
    const [key, text] = Array.isArray(option) ? option : [option, option];
    select.append(make('option', { value: key, selected: key === value }, text));
  }
  return select;
}

export function number(value, digits = 2) {
  if (value == null || Number.isNaN(value)) return '–';
  const text = Number(value).toLocaleString('en', { maximumFractionDigits: digits });
  return text === '-0' ? '0' : text;
}

// What is wrong with a seed; nothing where it is one. They are text: a number of a page does not hold them all.
export function wrong_seed(text) {
  return /^\d{1,20}$/.test(text) && BigInt(text) < 2n ** 64n ? '' : `“${text}” is no seed: give a whole number from 0 to ${2n ** 64n - 1n}.`;
}

// Asks the server; when it is away, says so and tries again until it is back.
const link = document.getElementById('link');
export async function ask(path) {
  let answer;
  try {
    answer = await fetch(path);
    link.textContent = '';
  } catch (error) {
    link.textContent = 'The server does not answer; trying again.';
    return null;
  }
  const body = await answer.json();
  if (!answer.ok) throw new Error(body.error ?? answer.statusText);
  return body;
}

// Keeps bytes as a file.
export function save(blob, name) {
  const link = make('a', { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// Has a link fetch a file that the server makes when it is asked: `said` says that it is in the making, or why there is none. A
// link of the browser's own would drop the reason and seem to do nothing.
export function fetch_on_click(link, said) {
  link.addEventListener('click', async (event) => {
    event.preventDefault();
    if (link.ariaBusy === 'true') return;
    const say = (text, kind) => { said.textContent = text; said.className = kind; };
    link.ariaBusy = 'true';
    say('In the making; some seconds.', 'pale');
    try {
      const answer = await fetch(link.href);
      if (!answer.ok) throw new Error((await answer.json()).error ?? answer.statusText);
      save(await answer.blob(), /filename="([^"]+)"/.exec(answer.headers.get('content-disposition') ?? '')?.[1] ?? '');
      say('', 'pale');
    } catch (error) {
      say(`${link.textContent}: ${error.message}.`, 'bad');
    }
    link.ariaBusy = 'false';
  });
  return link;
}

// Writes to the server; gives its answer or throws its reason.
export async function post(path, body) {
  const answer = await fetch(path, { method: 'POST', headers: { 'content-type': 'application/json' }, body: JSON.stringify(body) });
  const said = await answer.json();
  if (!answer.ok) throw new Error(said.error ?? answer.statusText);
  return said;
}

// The part of the address after the #: a page's name and its state.
export function state() {
  const [page, query] = location.hash.slice(1).split('?');
  return { page: page || 'runs', query: new URLSearchParams(query) };
}

export function keepState(page, query) {
  const kept = new URLSearchParams([...Object.entries(query)].filter(([, value]) => value !== '' && value != null && value !== false));
  history.replaceState(null, '', `#${page}?${kept}`);
}
