"""One run over several Ray workers, on two nodes of this machine: equal to one process, equal to itself, and alive after a worker and a node are killed.

    pip install '.[ray]'
"""

import itertools
import os
import signal
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import ray
from ray.cluster_utils import Cluster

import hasard_rs

# What is printed is seen at once, in files and pipes too.
sys.stdout.reconfigure(line_buffering=True)
updates = int(sys.argv[1]) if len(sys.argv) > 1 else 20
cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 2, "include_dashboard": False})
far = cluster.add_node(num_cpus=2)
ray.init(address=cluster.address, log_to_driver=False)

from hasard_rs.ray import train  # noqa: E402

ENV = "hasard/RemedyRushLevel1-v0"
FOLDER = Path(tempfile.mkdtemp(prefix="hasard-ray-"))
LANES, STEPS, SKIP = 32, 32, 4
PER_ROLLOUT = LANES * STEPS * SKIP
# Every rollout is reported and kept, so that runs can be compared, and killed anywhere.
EVERY = {"reporting.report_seconds": 0.0, "reporting.checkpoint_seconds": 0.0, "sampling.rollout": STEPS, "learning.epochs": 1, "learning.minibatches": 1}
SETTINGS = {"frames": updates * PER_ROLLOUT, "envs": LANES, "threads": 1, "size": "64x48", "preset": "quick", "seed": 3, "eval_every": 0, "set": EVERY}


def run(name, workers=None, at_report=None):
    """A run's reports, its last weights, and frames a second: with its start, and from the first report to the last."""
    reports, times = [], []

    def hear(report):
        reports.append(report)
        times.append(time.perf_counter())
        if at_report is not None:
            at_report(len(reports))

    began = time.perf_counter()
    how = {} if workers is None else {"workers": workers}
    ended = (hasard_rs.train if workers is None else train)(ENV, "PPOLag", out=FOLDER / name, callback=hear, **how, **SETTINGS)
    newest = max((ended.directory / "checkpoints").glob("frames_*"))
    rates = len(reports) * PER_ROLLOUT / (time.perf_counter() - began), (len(reports) - 1) * PER_ROLLOUT / (times[-1] - times[0])
    return reports, (newest / "weights.safetensors").read_bytes(), rates


def workers_here():
    """The processes of workers, which only a test wants to know."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if (process / "cmdline").read_bytes().startswith(b"ray::Worker"):
                found.append(int(process.name))
        except OSError:
            pass
    return sorted(found)


def kill_one(heard):
    if heard == 5:
        os.kill(workers_here()[-1], signal.SIGKILL)


def kill_node(heard):
    if heard == 5:
        cluster.remove_node(far)


print("| | frames/s with its start | after it |")
alone, _, rates = run("alone")
print(f"| one process | {rates[0]:,.0f} | {rates[1]:,.0f} |")
all_weights = {}
for workers in (1, 2, 4):
    reports, all_weights[workers], rates = run(f"{workers}", workers)
    print(f"| {workers} Ray workers | {rates[0]:,.0f} | {rates[1]:,.0f} |")
    assert len(reports) == len(alone) == updates
    names = [name for name in alone[0] if "loss" in name or name in ("return_mean", "cost_mean", "multiplier", "entropy", "gradient_norm")]
    apart = max(abs(a[name] - b[name]) for (a, b), name in itertools.product(zip(alone, reports), names) if None not in (a[name], b[name]))
    print(f"{workers} workers against one process over {updates} updates: losses ({', '.join(names)}) apart by at most {apart:.2g}")
    assert apart <= 1e-4 and np.isfinite(apart)
_, again, _ = run("2-again", 2)
first = all_weights[2]
assert first == again
print("two runs of 2 workers: weights equal to the bit")
_, killed, _ = run("killed", 2, kill_one)
print("a worker was killed: the run ended,", "weights equal to the bit" if killed == first else "weights differ")
assert killed == first
reports, _, _ = run("lost", 4, kill_node)
assert reports[-1]["frames"] == updates * PER_ROLLOUT
print(f"a node was killed: the run of 4 workers ended at {reports[-1]['frames']} frames with those that were left")
ray.shutdown()
cluster.shutdown()
