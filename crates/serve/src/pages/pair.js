// A second agent on the same seed, beside the first: it does what the first is asked to.
import { make, number } from '/dom.js';
import { Screen } from '/screen.js';

export class Pair {
  constructor() {
    this.canvas = make('canvas', { class: 'view', role: 'img', 'aria-label': 'The second agent', width: 320, height: 240, id: 'second' });
    this.words = make('figcaption', { id: 'second-words' });
    this.element = make('figure', { hidden: true }, this.canvas, this.words);
    // Who the first one is: said only where there are two.
    this.first = make('figcaption', { id: 'first-words', hidden: true });
    this.screen = null;
  }

  // Begins with the same episode at the same step; `name` is who it is.
  begin(name, query) {
    this.end();
    this.show(true);
    let budget = 0;
    const say = (text) => { this.words.textContent = `${name}${text}`; };
    say('');
    const onframe = (frame) => say(`: step ${frame.step}, return ${number(frame.return)}, cost ${number(frame.cost)} of ${number(budget)}${frame.cost > budget ? ', over' : ''}${frame.ended ? ', ended' : ''}`);
    const onwords = (words) => { if (words.kind === 'scene') budget = words.budget; };
    this.screen = new Screen(() => `/api/watch?${query}`, { colour: this.canvas }, { onframe, onwords, onlink: (text) => text && say(`: ${text}`) });
  }

  ask(message) { this.screen?.ask(message); }

  end() {
    this.screen?.end();
    this.screen = null;
    this.show(false);
  }

  // Two pictures have more room than one.
  show(on) {
    this.element.hidden = this.first.hidden = !on;
    this.element.closest('.stage')?.classList.toggle('two', on);
  }
}
