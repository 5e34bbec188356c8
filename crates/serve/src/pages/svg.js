// Shapes from data, and pictures of them as files. Colours stand in the shapes themselves, so that a saved file looks as the page did.
import { make, save } from '/dom.js';

const SPACE = 'http://www.w3.org/2000/svg';
export const FONT = 'system-ui, sans-serif';
// Middle tones, which stand out on white and on black alike; from the ninth on they come again dashed, then dotted.
const COLOURS = ['#2f6dbd', '#d1651b', '#2e8b57', '#9a4fb5', '#b8860b', '#c2326e', '#3f8f9b', '#7a6a53'];
const DASHES = ['', '7 4', '2 4'];

export const colour = (index) => COLOURS[index % COLOURS.length];
export const dash = (index) => DASHES[Math.floor(index / COLOURS.length) % DASHES.length];

export function shape(tag, attributes = {}, ...children) {
  const element = document.createElementNS(SPACE, tag);
  for (const [name, value] of Object.entries(attributes)) if (value != null && value !== '') element.setAttribute(name, value);
  element.append(...children.filter((child) => child != null));
  return element;
}

export function text(words, x, y, fill, more = {}) {
  return shape('text', { x, y, fill, 'font-size': 12, 'font-family': FONT, ...more }, words);
}

export function path(points, more) {
  const d = points.map(([x, y], k) => `${k ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(1)}`).join('');
  return shape('path', { d, fill: 'none', ...more });
}

// The page's colours as they are now.
export function inks(element) {
  const style = getComputedStyle(element);
  const of = (name) => style.getPropertyValue(name).trim();
  return { ink: of('--ink'), pale: of('--pale'), line: of('--line'), bad: of('--bad'), good: of('--good'), card: of('--card') };
}

// Draws a picture whenever its place has another size, and when the system goes from light to dark or back: it is drawn in the
// colours of then. Gives a function that ends this.
export function redrawn(svg, place, draw) {
  svg.addEventListener('colours', draw);
  const sized = new ResizeObserver(draw);
  sized.observe(place);
  return () => { sized.disconnect(); svg.removeEventListener('colours', draw); };
}

// One listener for all that are shown: a picture that is replaced needs not be forgotten here.
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  for (const svg of document.querySelectorAll('svg.chart')) svg.dispatchEvent(new Event('colours'));
});

// A picture as a file of its own: on the page's ground, with its title above and what its colours mean below.
export function standalone(svg, title, legend = []) {
  const { card, ink, pale } = inks(svg);
  const [width, height] = [Number(svg.getAttribute('width')), Number(svg.getAttribute('height'))];
  const rows = [];
  let x = width;
  for (const entry of legend) {
    const wide = 40 + entry.name.length * 6.6;
    if (x + wide > width) { rows.push([]); x = 10; }
    rows.at(-1).push({ ...entry, at: x });
    x += wide;
  }
  const total = height + 34 + rows.length * 20 + 6;
  const whole = shape('svg', { xmlns: SPACE, width, height: total, viewBox: `0 0 ${width} ${total}` }, shape('rect', { width, height: total, fill: card }), text(title, 10, 22, ink, { 'font-size': 15, 'font-weight': 600 }));
  const drawn = shape('g', { transform: 'translate(0 34)' }, ...[...svg.childNodes].map((child) => child.cloneNode(true)));
  drawn.querySelectorAll('.pointer').forEach((one) => one.remove());
  whole.append(drawn);
  rows.forEach((row, k) => row.forEach((entry) => {
    const y = height + 44 + 20 * k;
    whole.append(path([[entry.at, y], [entry.at + 22, y]], { stroke: entry.colour, 'stroke-width': 3, 'stroke-dasharray': entry.dash }), text(entry.name, entry.at + 28, y + 4, pale));
  }));
  return whole;
}

const svg_blob = (svg) => new Blob([new XMLSerializer().serializeToString(svg)], { type: 'image/svg+xml' });

async function save_png(svg, name) {
  const picture = new Image();
  picture.src = URL.createObjectURL(svg_blob(svg));
  await picture.decode();
  // Twice the size on the page, so that it is sharp in print.
  const canvas = make('canvas', { width: 2 * svg.getAttribute('width'), height: 2 * svg.getAttribute('height') });
  canvas.getContext('2d').drawImage(picture, 0, 0, canvas.width, canvas.height);
  URL.revokeObjectURL(picture.src);
  canvas.toBlob((blob) => save(blob, name), 'image/png');
}

const cell = (value) => (/[",\n]/.test(value) ? `"${String(value).replaceAll('"', '""')}"` : String(value ?? ''));
export const csv = (rows) => rows.map((row) => row.map(cell).join(',')).join('\n') + '\n';

// Buttons that save a picture and its numbers.
export function downloads(title, name, whole, rows) {
  const button = (kind, onclick) => make('button', { class: 'small', 'aria-label': `Save ${title} as ${kind}`, onclick }, kind);
  return make('span', { class: 'saves' }, button('PNG', () => save_png(whole(), `${name}.png`)), button('SVG', () => save(svg_blob(whole()), `${name}.svg`)),
    button('CSV', () => save(new Blob([csv(rows())], { type: 'text/csv' }), `${name}.csv`)));
}
