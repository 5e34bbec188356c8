"""Sample-Factory's APPO on a batched environment, with the published package's names and settings.

    pip install '.[sample-factory]'
"""

import sys

from hasard_rs.sample_factory import main

SETTINGS = [
    "--env=volcanic_venture",
    "--level=1",
    "--batched_sampling=True",
    "--num_workers=1",
    "--num_envs_per_worker=1",
    "--env_agents=16",
    "--worker_num_splits=1",
    "--train_for_env_steps=4096",
    "--device=cpu",
    "--serial_mode=True",
    "--normalize_input=True",
    "--train_dir=sample_factory_runs",
]
# Sample-Factory starts processes that import this file.
if __name__ == "__main__":
    sys.argv += SETTINGS
    sys.exit(main())
