"""PufferLib 3's backends over its arrays. It does not build without its games, so its sdist is unpacked and its Python part used:
PYTHONPATH=pufferlib-3.0.0, with psutil and gym 0.23.1."""

import numpy as np
import pufferlib.vector

import hasard_rs
from hasard_rs.pufferlib import HasardPuffer

ENV = "hasard/RemedyRushLevel1-v0"
SMALL = {"resolution": "64x48", "max_episode_steps": 15}
STEPS = 40


def rolled(vec, lanes):
    """What random steps bring, and how many episodes ended."""
    observations, _ = vec.reset(seed=3)
    results, ends, rng = [observations.copy()], 0, np.random.default_rng(0)
    for _ in range(STEPS):
        observations, rewards, terminals, truncations, infos = vec.step(rng.integers(0, 2, (lanes, 4)))[:5]
        assert observations.shape == (lanes, 3, 48, 64)
        results.append(tuple(np.array(one) for one in (observations, rewards, terminals, truncations)))
        ends += len(infos)
    vec.close()
    return results, ends


def main():
    made = {"env_kwargs": {"env_id": ENV, "num_envs": 6, **SMALL}}
    results, ends = rolled(pufferlib.vector.make(HasardPuffer, backend=pufferlib.PufferEnv, **made), 6)
    assert ends == 12
    worlds, rng = hasard_rs.Worlds(ENV, 6, layout="chw", **SMALL), np.random.default_rng(0)
    assert np.array_equal(worlds.reset(3).observations, results[0])
    for found in results[1:]:
        batch = worlds.step(rng.integers(0, 2, (6, 4)))
        expected = (batch.observations, batch.rewards, batch.terminated, batch.truncated)
        assert all(np.array_equal(one, other) for one, other in zip(found, expected, strict=True))
    for backend, how in ((pufferlib.vector.Serial, {}), (pufferlib.vector.Multiprocessing, {"num_workers": 2, "overwork": True})):
        _, ends = rolled(pufferlib.vector.make(HasardPuffer, backend=backend, num_envs=2, **how, **made), 12)
        assert ends == 24
    print("PufferEnv equal to Worlds to the bit over", STEPS, "steps; Serial and Multiprocessing: 24 episodes each")


if __name__ == "__main__":
    main()
