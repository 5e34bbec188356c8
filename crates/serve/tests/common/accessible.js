// What a page lacks for people who cannot see it well: names of controls and pictures, contrast of every text (WCAG 2 AA).
const found = [];
const seen = (element) => element.getClientRects().length > 0 && getComputedStyle(element).visibility !== 'hidden' && !element.closest('.unseen, .skip');
const name = (element) => element.getAttribute('aria-label') || [...(element.labels ?? [])].map((label) => label.textContent).join('') || element.textContent;
for (const element of document.querySelectorAll('button, a, input, select, canvas, meter, progress, svg[role=img]')) {
  const own = element.matches('select') ? element.getAttribute('aria-label') || [...element.labels].map((label) => label.textContent.replace(element.textContent, '')).join('') : name(element);
  if (seen(element) && !element.closest('[aria-hidden=true]') && !own?.trim()) found.push(`no name: ${element.outerHTML.slice(0, 120)}`);
}
for (const element of document.querySelectorAll('[role=region]')) if (!element.getAttribute('aria-label')) found.push('a region without a name');
if (document.querySelectorAll('h1').length < 1) found.push('no heading');
const pen = Object.assign(document.createElement('canvas'), { width: 1, height: 1 }).getContext('2d', { willReadFrequently: true });
const rgba = (colour) => { pen.clearRect(0, 0, 1, 1); pen.fillStyle = colour; pen.fillRect(0, 0, 1, 1); return [...pen.getImageData(0, 0, 1, 1).data]; };
const light = (rgb) => rgb.slice(0, 3).map((v) => v / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)).reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
const ground = (element) => { for (let at = element; at; at = at.parentElement) { const colour = rgba(getComputedStyle(at).backgroundColor); if (colour[3] === 255) return colour; } return [255, 255, 255, 255]; };
const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
const reported = new Set();
for (let node = walk.nextNode(); node; node = walk.nextNode()) {
  const element = node.parentElement;
  if (!node.textContent.trim() || !seen(element) || element.closest('option, optgroup, [aria-hidden=true], :disabled')) continue;
  const style = getComputedStyle(element);
  const [a, b] = [light(rgba(style.color)), light(ground(element))];
  const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  const size = parseFloat(style.fontSize), large = size >= 24 || (size >= 18.66 && style.fontWeight >= 700);
  const words = `contrast ${contrast.toFixed(2)} of ${style.color}: ${node.textContent.trim().slice(0, 40)}`;
  if (contrast < (large ? 3 : 4.5) && !reported.has(style.color)) { reported.add(style.color); found.push(words); }
}
return found;
