import { make, state } from '/dom.js';
import { runs } from '/runs.js';
import { run } from '/run.js';
import { watch } from '/watch.js';
import { play } from '/play.js';

const pages = { runs, run, watch, play };
const main = document.getElementById('page');
let leave = null;
let shown = null;

function show() {
  const { page, query } = state();
  leave?.();
  leave = null;
  main.replaceChildren();
  for (const link of document.querySelectorAll('nav a')) {
    const here = link.getAttribute('href') === `#${page === 'run' ? 'runs' : page}`;
    if (here) link.setAttribute('aria-current', 'page');
    else link.removeAttribute('aria-current');
  }
  document.title = `hasard – ${page}`;
  const begin = Object.hasOwn(pages, page) ? pages[page] : null;
  if (begin) leave = begin(main, query);
  else main.append(make('p', {}, 'There is no such page.'));
  if (shown !== null) {
    scrollTo(0, 0);
    main.focus({ preventScroll: true });
  }
  shown = page;
}

addEventListener('hashchange', show);
// What stands after the # names a page: the link must not lead to one.
document.querySelector('a.skip').addEventListener('click', (event) => {
  event.preventDefault();
  main.focus();
});
show();
