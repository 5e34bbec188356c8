// What is drawn of a run's rows: values against frames, steps or time; smoothed; folded over seeds.

// Student's t at 97.5 %, for 1 to 10 degrees of freedom.
const T = [12.71, 4.3, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26, 2.23];

// A column of /api/curves as x and y. One that few rows have has rows of its own.
export function column(data, name, over = 'frames', skip = 4) {
  const found = data?.[name];
  const own = found && !Array.isArray(found);
  const { frames = [], wall_s = [] } = own ? found : data ?? {};
  const y = own ? found.values : found ?? [];
  const x = over === 'time' ? frames.map((_, k) => wall_s[k] ?? null) : over === 'steps' ? frames.map((one) => one / skip) : frames;
  const whole = x.map((one, k) => [one, y[k]]).filter(([one, value]) => one != null && value != null);
  return { x: whole.map(([one]) => one), y: whole.map(([, value]) => value) };
}

// The exponential moving average: each value is `weight` of the one before and the rest of its own.
export function smoothed(values, weight) {
  if (!weight) return values;
  let last = null;
  return values.map((value) => { last = last == null ? value : weight * last + (1 - weight) * value; return last; });
}

// The value at a place, on the line between the points around it; nothing outside of them.
export function at({ x, y }, place) {
  if (!x.length || place < x[0] || place > x[x.length - 1]) return null;
  let [low, high] = [0, x.length - 1];
  while (high - low > 1) { const middle = (low + high) >> 1; if (x[middle] < place) low = middle; else high = middle; }
  if (x[high] === x[low]) return y[high];
  return y[low] + ((place - x[low]) / (x[high] - x[low])) * (y[high] - y[low]);
}

// The mean of samples and half the width of its 95 % interval (Student's t); no width for a single one.
export function estimate(values) {
  const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
  const variance = values.reduce((sum, value) => sum + (value - mean) ** 2, 0) / (values.length - 1);
  return { mean, half: values.length > 1 ? (T[values.length - 2] ?? 1.96) * Math.sqrt(variance / values.length) : null };
}

// Runs of one experiment, each seed once: of several runs of a seed the one that got furthest counts, as in the report. A seed
// that counted twice would make the interval too narrow.
export function by_seed(runs) {
  const furthest = new Map();
  const frames = (run) => run.last?.frames ?? 0;
  for (const run of runs) if (!furthest.has(run.seed) || frames(run) > frames(furthest.get(run.seed))) furthest.set(run.seed, run);
  const counts = (run) => furthest.get(run.seed) === run;
  return { counted: runs.filter(counts), repeats: runs.filter((run) => !counts(run)) };
}

// Curves of several seeds as their mean with its interval, as far as the shortest goes: beyond, the mean would be of other seeds.
export function folded(curves) {
  const all = curves.filter((curve) => curve.x.length);
  if (all.length < 2) return all[0] ?? { x: [], y: [] };
  const [from, to] = [Math.max(...all.map((curve) => curve.x[0])), Math.min(...all.map((curve) => curve.x.at(-1)))];
  const x = Array.from({ length: 121 }, (_, k) => from + ((to - from) * k) / 120);
  const points = x.map((place) => estimate(all.map((curve) => at(curve, place)).filter((value) => value != null)));
  return { x, y: points.map((point) => point.mean), half: points.map((point) => point.half) };
}
