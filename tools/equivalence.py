"""Are episodes there and here the same up to a margin? Two one-sided tests (Schuirmann 1987) of the difference of means.

    python equivalence.py THERE.txt HERE.jsonl [THERE.txt HERE.jsonl ...]

THERE holds lines `episode N: return R, cost C, ...` of the scripts beside this one, HERE what `hasard eval --json` or `hasard rollout --json`
print. For return and cost: both means, the difference with its 90 % interval, the margin of a tenth of the mean there, and the smallest
margin within which the two are the same at 5 %: |difference| + 1.645 standard errors. Equivalence holds where that is within the tenth.
"""

import json
import re
import sys
from statistics import NormalDist, mean, stdev

QUANTILE = NormalDist().inv_cdf(0.95)


def there(path):
    with open(path) as file:
        found = re.findall(r"(?:episode|there) \d+: return ([-\d.]+), cost ([-\d.]+)", file.read())
    return [tuple(map(float, pair)) for pair in found]


def here(path):
    with open(path) as file:
        if path.endswith(".txt"):
            return [tuple(map(float, pair)) for pair in re.findall(r"\bhere \d+: return ([-\d.]+), cost ([-\d.]+)", file.read())]
        rows = [json.loads(line) for line in file]
    return [(row["return"], row["cost"]) for row in rows if "return" in row and "episode" in row]


def main():
    print("| pair | episodes there, here | what | there | here | difference (90 %) | smallest margin | of the mean there | within a tenth |")
    print("|---|--:|---|--:|--:|--:|--:|--:|---|")
    for one, other in zip(sys.argv[1::2], sys.argv[2::2]):
        pairs = there(one), here(other)
        for index, what in enumerate(("return", "cost")):
            a, b = ([pair[index] for pair in pairs_of] for pairs_of in pairs)
            error = (stdev(a) ** 2 / len(a) + stdev(b) ** 2 / len(b)) ** 0.5
            difference, middle = mean(b) - mean(a), mean(a)
            least = abs(difference) + QUANTILE * error
            share = f"{100 * least / abs(middle):.1f} %" if middle else "-"
            verdict = "yes" if middle and least <= 0.1 * abs(middle) else "no"
            print(f"| {one.rsplit('/', 1)[-1].rsplit('.', 1)[0]} | {len(a)}, {len(b)} | {what} | {middle:.3f} | {mean(b):.3f} | "
                  f"{difference:+.3f} ({difference - QUANTILE * error:+.3f} to {difference + QUANTILE * error:+.3f}) | {least:.3f} | {share} | {verdict} |")


if __name__ == "__main__":
    main()
