"""OmniSafe's PPOLag, CPO and FOCOPS on flat pixels. Where safety_gymnasium does not install (CPython 3.11 and newer), a stand-in is enough:
OmniSafe touches it for its own environments alone. Install with `pip install --no-deps omnisafe==0.5.0` and what its imports ask for.

    pip install '.[omnisafe]'      # CPython 3.10
"""

import importlib.util
import sys
import types

import numpy as np

if importlib.util.find_spec("safety_gymnasium") is None:
    stand_in = types.ModuleType("safety_gymnasium")
    stand_in.vector = types.SimpleNamespace(make=None)
    stand_in.make = None
    sys.modules["safety_gymnasium"] = stand_in

import omnisafe  # noqa: E402

import hasard_rs.omnisafe  # noqa: E402, F401

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 4800
for algorithm in sys.argv[2:] or ("PPOLag", "CPO", "FOCOPS"):
    # An epoch must be long enough for episodes to end in: 525 steps in each of the four worlds.
    settings = {
        "train_cfgs": {"total_steps": steps, "vector_env_nums": 4, "torch_threads": 1},
        "algo_cfgs": {"steps_per_epoch": 2400, "update_iters": 2, **({"cost_limit": 50.0} if algorithm == "CPO" else {})},
        "logger_cfgs": {"use_wandb": False, "use_tensorboard": False},
        **({} if algorithm == "CPO" else {"lagrange_cfgs": {"cost_limit": 50.0}}),
    }
    returns, costs, length = omnisafe.Agent(algorithm, "VolcanicVentureLevel1-v0", custom_cfgs=settings).learn()
    print(f"{algorithm} after {steps} steps: return {returns:.2f}, cost {costs:.2f}, length {length:.0f}")
    assert np.isfinite([returns, costs, length]).all()
