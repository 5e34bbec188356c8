// What people say of a run: note, tags, put aside or thrown away. Only where the server was begun with --edit can it be changed.
import { ask, field, make, post } from '/dom.js';

export class NotesCard {
  constructor(id) {
    Object.assign(this, { id, known: '', can: null, said: make('p', { class: 'pale', role: 'status' }) });
    this.element = make('div', { id: 'notes', hidden: true });
    ask('/api/envs').then((what) => { this.can = Boolean(what?.edit); if (this.run) this.show(this.run); }).catch(() => {});
  }

  show(run) {
    this.run = run;
    const face = JSON.stringify([run.notes, run.name, this.can]);
    // What is being written stays.
    if (face === this.known || this.can === null || this.element.contains(document.activeElement)) return;
    this.known = face;
    const { note = '', tags = [], archived = false } = run.notes ?? {};
    this.element.hidden = !this.can && !run.notes;
    if (!this.can) {
      this.element.replaceChildren(make('p', { class: 'pale' }, [archived ? 'Archived.' : '', tags.map((tag) => `#${tag}`).join(' '), note].filter(Boolean).join(' ')));
      return;
    }
    const { said } = this;
    const text = make('textarea', { rows: 2, id: 'note' }, note);
    const words = make('input', { value: tags.join(', '), id: 'tags', placeholder: 'separated by commas' });
    const aside = make('input', { type: 'checkbox', id: 'aside' });
    aside.checked = archived;
    const send = async (what, done) => {
      try { const answer = await post('/api/edit', { id: this.id, ...what }); said.textContent = done(answer); return true; } catch (error) { said.textContent = error.message; return false; }
    };
    const save = () => send({ note: text.value, tags: words.value.split(','), archived: aside.checked }, () => 'Saved.');
    const sure = make('span', { class: 'row', hidden: true });
    const away = make('button', { id: 'away', onclick: () => { sure.hidden = false; yes.focus(); } }, 'Throw away');
    const yes = make('button', { class: 'bad', id: 'sure', onclick: async () => { if (await send({ throw_away: run.name }, (answer) => `Moved to ${answer.moved_to}.`)) setTimeout(() => { location.hash = '#runs'; }, 800); } }, `Yes, move ${run.name} to the trash`);
    sure.append(yes, make('button', { onclick: () => { sure.hidden = true; away.focus(); } }, 'No'));
    this.element.replaceChildren(make('details', { open: Boolean(note || tags.length || archived) }, make('summary', {}, 'Notes'), make('div', { class: 'row' }, field('note', text), field('tags', words), make('label', { class: 'check' }, aside, 'archived'), make('button', { id: 'save', onclick: save }, 'Save'), away, sure), said));
  }
}
