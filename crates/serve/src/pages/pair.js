// A second agent on the same seed, beside the first: it does what the first is told to.
import { make, number } from '/dom.js';
import { Screen } from '/screen.js';

export class Pair {
  constructor() {
    this.canvas = make('canvas', { class: 'view', role: 'img', 'aria-label': 'The second agent', width: 320, height: 240, id: 'second' });
    this.words = make('figcaption', { id: 'second-words' });
    this.element = make('figure', { hidden: true }, this.canvas, this.words);
    this.screen = null;
  }

  // Begins with the same episode at the same step; `name` is who it is.
  begin(name, query) {
    this.end();
    this.element.hidden = false;
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
    this.element.hidden = true;
  }
}
