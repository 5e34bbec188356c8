"""A sweep on a Ray cluster of two nodes of this machine, one of them killed in the middle: every run ends with its results. Then one on submitit's
local executor, which is Slurm's without Slurm, if submitit is installed.

    pip install '.[ray]'
"""

import importlib.util
import json
import os
import sys
import tempfile
import threading
import time
from pathlib import Path

import ray
from ray.cluster_utils import Cluster

from hasard_rs.cli import main

frames = sys.argv[1] if len(sys.argv) > 1 else "0.01"
cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False})
far = cluster.add_node(num_cpus=1)
ray.init(address=cluster.address, log_to_driver=False)
FOLDER = Path(tempfile.mkdtemp(prefix="hasard-sweep-"))


def ended(folder):
    """Frames of each run's last report."""
    return {str(file.parent.relative_to(folder)): json.loads(file.read_text().splitlines()[-1])["frames"] for file in folder.rglob("metrics.jsonl")}


def kill_node():
    # Two runs are under way, one on each node.
    while len(list(FOLDER.rglob("config.json"))) < 2:
        time.sleep(0.05)
    time.sleep(1.0)
    cluster.remove_node(far)
    print("a node is gone, while these were under way:", sorted(str(file.parent.relative_to(FOLDER)) for file in FOLDER.rglob("config.json")), flush=True)


threading.Thread(target=kill_node, daemon=True).start()
code = main(["sweep", "quick", "--scale", frames, "--out", str(FOLDER / "ray"), "--on", "ray"])
lengths = ended(FOLDER / "ray")
print("exit code", code, "frames of each run", lengths)
assert code == 0 and len(lengths) == 5 and len(set(lengths.values())) == 1
ray.shutdown()
cluster.shutdown()
if importlib.util.find_spec("submitit") is not None:
    os.chdir(FOLDER)
    code = main(["sweep", "quick", "--scale", frames, "--out", str(FOLDER / "local"), "--on", "local"])
    assert code == 0 and ended(FOLDER / "local").values() and len(ended(FOLDER / "local")) == 5
    print("submitit's local executor: exit code", code, "frames of each run", ended(FOLDER / "local"))
