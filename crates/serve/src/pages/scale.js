// Numbers on axes: round values, their texts, and where they lie.
const compact = Intl.NumberFormat('en', { notation: 'compact', maximumSignificantDigits: 3 });

export function short(value) {
  if (value == null || Number.isNaN(value)) return '–';
  const size = Math.abs(value);
  if (size >= 10000) return compact.format(value);
  return size && size < 0.001 ? value.toExponential(1) : Number(value.toPrecision(3)).toLocaleString('en', { maximumFractionDigits: 6 });
}

// Round values from below `low` to above `high`, four to nine of them.
export function ticks(low, high) {
  const rough = (high - low) / 5 || 1;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 2.5, 5, 10].find((one) => one * power >= rough * 0.999) ?? 10);
  const first = Math.floor(low / step + 1e-9);
  // Whole multiples, so that a tick at 0.3 is not at 0.30000000000000004.
  return Array.from({ length: Math.ceil(high / step - 1e-9) - first + 1 }, (_, k) => Number(((first + k) * step).toPrecision(12)));
}

// Powers of ten, and what lies between them where they are few; round values where even those are: an axis with one number says
// little.
export function logTicks(low, high) {
  const [from, to] = [Math.floor(Math.log10(low)), Math.ceil(Math.log10(high))];
  const inside = (all) => all.filter((one) => one > 0 && one >= low * 0.999 && one <= high * 1.001);
  const powers = (between) => inside(Array.from({ length: to - from + 1 }, (_, k) => between.map((one) => one * 10 ** (from + k))).flat());
  const choices = [...(to - from <= 2 ? [] : [powers([1])]), powers([1, 2, 5]), inside(ticks(low, high))];
  return choices.find((all) => all.length >= 3) ?? choices.at(-1);
}

// Where a value lies between two pixels, and back.
export function scale([low, high], [from, to], log = false) {
  const turn = log ? Math.log10 : (value) => value;
  const [a, b] = [turn(low), turn(high)];
  const place = (value) => from + ((turn(value) - a) / (b - a || 1)) * (to - from);
  place.back = (pixel) => { const at = a + ((pixel - from) / (to - from)) * (b - a); return log ? 10 ** at : at; };
  return place;
}

// What is counted along a horizontal axis: frames of the game, steps of the policy, or time of training.
export const AXES = [['frames', 'frames'], ['steps', 'policy steps'], ['time', 'time']];
export function axis(name, most) {
  if (name === 'steps') return { title: 'policy steps', per: 1 };
  if (name !== 'time') return { title: 'frames (1 frame = 1 game tic)', per: 1 };
  if (most > 7200 * 2) return { title: 'time of training (hours)', per: 3600 };
  return most > 300 ? { title: 'time of training (minutes)', per: 60 } : { title: 'time of training (seconds)', per: 1 };
}
