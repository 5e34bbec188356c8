"""One run over two machines that share nothing but a cable and a file system: two network namespaces with a Ray node each (Linux, as root, `ip`).

It equals one process; then the cable is cut in the middle of another, and it ends on the machine that is left.
"""

import contextlib
import itertools
import os
import subprocess
import sys
import tempfile
from pathlib import Path

NEAR, FAR = "hasard-near", "hasard-far"
HEAD, OTHER = "10.77.77.1", "10.77.77.2"
UPDATES, LANES, STEPS, SKIP = 20, 32, 32, 4
FRAMES = UPDATES * LANES * STEPS * SKIP
# A node counts as lost after some seconds instead of a minute, and nobody else is on the cable.
WATCHFUL = {"RAY_AUTH_MODE": "disabled", "RAY_health_check_period_ms": "1000", "RAY_health_check_failure_threshold": "5", "RAY_health_check_timeout_ms": "2000"}


def ip(*words):
    subprocess.run(["ip", *words], check=True)


@contextlib.contextmanager
def machines():
    """Two network namespaces and the cable between them."""
    try:
        for name in (NEAR, FAR):
            ip("netns", "add", name)
        ip("link", "add", "cable0", "netns", NEAR, "type", "veth", "peer", "name", "cable1", "netns", FAR)
        for name, device, address in ((NEAR, "cable0", HEAD), (FAR, "cable1", OTHER)):
            ip("-n", name, "address", "add", f"{address}/24", "dev", device)
            ip("-n", name, "link", "set", device, "up")
            ip("-n", name, "link", "set", "lo", "up")
        yield
    finally:
        for name in (NEAR, FAR):
            pids = subprocess.run(["ip", "netns", "pids", name], capture_output=True, text=True, check=False).stdout.split()
            for pid in pids:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(int(pid), 9)
            subprocess.run(["ip", "netns", "delete", name], check=False)


def on(name, *words):
    """Runs a command on one of the machines."""
    subprocess.run(["ip", "netns", "exec", name, *words], check=True, env=os.environ | WATCHFUL)


def driver(out):
    """What the near machine does."""
    import ray

    ray.init(address=f"{HEAD}:6379", log_to_driver=False)
    assert {node["NodeManagerAddress"] for node in ray.nodes()} == {HEAD, OTHER}
    import hasard_rs
    from hasard_rs.ray import train

    every = {"reporting.report_seconds": 0.0, "reporting.checkpoint_seconds": 0.0, "sampling.rollout": STEPS, "learning.epochs": 1, "learning.minibatches": 1}
    settings = {"frames": FRAMES, "envs": LANES, "threads": 1, "size": "64x48", "preset": "quick", "seed": 3, "eval_every": 0, "set": every}

    def run(name, at_report=None, **how):
        reports = []

        def hear(report):
            reports.append(report)
            if at_report is not None:
                at_report(len(reports))

        (train if how else hasard_rs.train)("hasard/RemedyRushLevel1-v0", "PPOLag", out=out / name, callback=hear, **how, **settings)
        return reports

    def cut(heard):
        if heard == 5:
            ip("-n", NEAR, "link", "set", "cable0", "down")
            print("the cable is cut", flush=True)

    alone, both = run("alone"), run("both", workers=2)
    names = [name for name in alone[0] if "loss" in name or name in ("return_mean", "cost_mean", "multiplier", "entropy", "gradient_norm")]
    apart = max(abs(a[name] - b[name]) for (a, b), name in itertools.product(zip(alone, both, strict=True), names) if None not in (a[name], b[name]))
    print(f"two machines against one process over {len(both)} updates: apart by at most {apart:.2g}", flush=True)
    assert apart <= 1e-4
    lost = run("lost", cut, workers=2)
    assert lost[-1]["frames"] == FRAMES
    print(f"the run ended at {lost[-1]['frames']} frames on the machine that was left", flush=True)


if __name__ == "__main__":
    if sys.argv[1:]:
        driver(Path(sys.argv[1]))
    else:
        ray = str(Path(sys.executable).parent / "ray")
        with machines():
            on(NEAR, ray, "start", "--head", f"--node-ip-address={HEAD}", "--port=6379", "--num-cpus=1", "--include-dashboard=false", "--disable-usage-stats")
            on(FAR, ray, "start", f"--address={HEAD}:6379", f"--node-ip-address={OTHER}", "--num-cpus=1", "--disable-usage-stats")
            on(NEAR, sys.executable, __file__, tempfile.mkdtemp(prefix="hasard-cable-"))
