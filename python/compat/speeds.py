"""How fast the package is beside the program's own loop, in turn, medians of rounds: `python python/compat/speeds.py [ROUNDS] [PART...]`.

PART: `batch` (VectorEnv of 32 worlds beside `hasard bench`, one and two threads), `work` (the same by processor time on one thread, which programs beside
disturb less), `single` (make(id) beside `hasard bench --envs 1`), `thread` (what a
second Python thread keeps while worlds step), `import`, and `sb3`, `torchrl`, `rllib`: those libraries' own loops with random actions, beside the same
loop of ViZDoom (packages vizdoom and hasard, the latter wherever HASARD_PUBLISHED says that it lies), all on one core, as ViZDoom
is a process that Python wakes with every step (see `beside_published_speed.py`). Wants a machine that does nothing else.
"""

import itertools
import json
import os
import pathlib
import statistics
import subprocess
import sys
import threading
import time

IDS = ("VolcanicVentureLevel1-v0", "RemedyRushLevel1-v0")
SECONDS = 0.5
# What speaks to ViZDoom lies there.
EXAMPLES = str(pathlib.Path(__file__).parents[2] / "crates" / "envs" / "examples")


def rust(env_id, envs, threads, seconds=SECONDS):
    """Policy steps a second of the program's loop."""
    words = ["bench", env_id, "--size", "128x72", "--envs", str(envs), "--threads", str(threads), "--seconds", str(seconds), "--json"]
    done = subprocess.run([sys.executable, "-m", "hasard_rs.cli", *words], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["steps_per_second"]


def rate(step, lanes):
    """Steps a second of a function that steps so many lanes."""
    steps, start = 0, time.perf_counter()
    while time.perf_counter() - start < SECONDS:
        step()
        steps += lanes
    return steps / (time.perf_counter() - start)


def drawn(env_id, lanes):
    """An endless row of random actions, drawn beforehand: the program's loop draws each anew, and a short row over and over walks somewhere else."""
    import numpy as np

    import hasard_rs

    nvec = hasard_rs.spec(env_id).nvec
    return itertools.cycle(np.random.default_rng(0).integers(0, nvec, (4096, *lanes, len(nvec))))


def print_row(what, pairs):
    """A row: medians, and the median of the rounds' ratios."""
    ours, theirs = zip(*pairs, strict=True)
    ratio = statistics.median(a / b for a, b in pairs)
    print(f"| {what} | {statistics.median(ours):,.0f} | {statistics.median(theirs):,.0f} | {ratio:.3f} |", flush=True)


def batch(rounds):
    import hasard_rs

    for env_id in IDS:
        for threads in (1, 2):
            envs = hasard_rs.make_vec(f"hasard/{env_id}", 32, resolution="128x72", num_threads=threads - 1, autoreset_mode="SameStep")
            actions = drawn(env_id, (32,))

            def step(envs=envs, actions=actions):
                envs.step(next(actions))

            def ours(envs=envs, step=step):
                # As the program's loop: the beginning of an episode does not cost what its end does.
                envs.reset(seed=0)
                return rate(step, 32)

            print_row(f"{env_id}, 32 worlds, {threads} thread(s)", [(ours(), rust(env_id, 32, threads)) for _ in range(rounds)])
            envs.close()


def work(rounds):
    import hasard_rs

    def program(env_id, seconds):
        """Steps of a run, and seconds of the processor for them and its start."""
        before = os.times()
        steps = rust(env_id, 32, 1, seconds) * seconds
        after = os.times()
        return steps, after.children_user + after.children_system - before.children_user - before.children_system

    def theirs(env_id):
        # A long run less a short one is without their starts.
        (many, long), (few, short) = program(env_id, 4 * SECONDS), program(env_id, SECONDS)
        return (many - few) / (long - short)

    for env_id in IDS:
        envs = hasard_rs.make_vec(f"hasard/{env_id}", 32, resolution="128x72", num_threads=0, autoreset_mode="SameStep")
        actions = drawn(env_id, (32,))

        def ours(envs=envs, actions=actions):
            envs.reset(seed=0)
            start = time.process_time()
            for _ in range(2048):
                envs.step(next(actions))
            return 2048 * 32 / (time.process_time() - start)

        print_row(f"{env_id}, 32 worlds, steps per second of the processor", [(ours(), theirs(env_id)) for _ in range(rounds)])


def single(rounds):
    import gymnasium

    import hasard_rs  # noqa: F401

    for env_id in IDS:
        env = gymnasium.make(f"hasard/{env_id}", resolution="128x72")
        env.reset(seed=0)
        actions = drawn(env_id, ())

        def step(env=env, actions=actions):
            _, _, terminated, truncated, _ = env.step(next(actions))
            if terminated or truncated:
                env.reset()

        print_row(f"{env_id}, gymnasium.make", [(rate(step, 1), rust(env_id, 1, 1)) for _ in range(rounds)])


def thread(rounds):
    import hasard_rs

    envs = hasard_rs.make_vec(f"hasard/{IDS[0]}", 32, resolution="128x72", num_threads=0)
    envs.reset(seed=0)
    actions = envs.action_space.sample()

    def counted():
        count, start = 0, time.perf_counter()
        while time.perf_counter() - start < SECONDS:
            for _ in range(1000):
                count += 1
        return count / (time.perf_counter() - start)

    def beside_worlds():
        over = threading.Event()

        def work():
            while not over.is_set():
                envs.step(actions)

        worker = threading.Thread(target=work)
        worker.start()
        found = counted()
        over.set()
        worker.join()
        return found

    def beside_a_process():
        looping = subprocess.Popen([sys.executable, "-c", "while True: pass"])
        found = counted()
        looping.kill()
        looping.wait()
        return found

    print_row("a second Python thread's count, while 32 worlds step and alone", [(beside_worlds(), counted()) for _ in range(rounds)])
    # What a second core is worth at all on this machine just now.
    print_row("the same beside a process that only loops, and alone", [(beside_a_process(), counted()) for _ in range(rounds)])


def imported(rounds):
    def seconds(code):
        start = time.perf_counter()
        subprocess.run([sys.executable, "-c", code], check=True)
        return 1e3 * (time.perf_counter() - start)

    print_row("import, ms: hasard_rs with Gymnasium, and Gymnasium alone", [(seconds("import hasard_rs"), seconds("import gymnasium")) for _ in range(2 * rounds)])


def published(level=1):
    """One world of ViZDoom as a Gymnasium environment: its buttons pressed or not, 160x120 reduced to 128x72 by indexing."""
    import gymnasium
    import numpy as np

    from beside_published_speed import open_game, package

    maps = pathlib.Path(os.environ.get("HASARD_PUBLISHED") or package("hasard")) / "envs"

    class Published(gymnasium.Env):
        metadata = {"render_modes": []}

        def __init__(self):
            self.game, self.picked = open_game(maps, "VolcanicVenture", level)
            self.observation_space = gymnasium.spaces.Box(0, 255, (72, 128, 3), np.uint8)
            self.action_space = gymnasium.spaces.MultiDiscrete([2] * len(self.game.get_available_buttons()))

        def seen(self):
            state = self.game.get_state()
            return np.zeros((72, 128, 3), np.uint8) if state is None else np.ascontiguousarray(state.screen_buffer[self.picked])

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            self.game.new_episode()
            return self.seen(), {}

        def step(self, action):
            reward = self.game.make_action([float(one) for one in action], 4)
            return self.seen(), reward, self.game.is_episode_finished(), False, {}

    return Published()


def sb3(rounds):
    import numpy as np
    from stable_baselines3.common.vec_env import DummyVecEnv

    from hasard_rs.sb3 import make_vec_env

    def looped(envs):
        envs.reset()
        actions = [np.array([envs.action_space.sample() for _ in range(envs.num_envs)]) for _ in range(64)]
        turn = iter(range(1 << 62))
        return lambda: rate(lambda: envs.step(actions[next(turn) % 64]), envs.num_envs)

    ours, theirs = looped(make_vec_env(f"hasard/{IDS[0]}", 8, resolution="128x72")), looped(DummyVecEnv([published] * 8))
    print_row("Stable-Baselines3's VecEnv.step, 8 worlds, beside DummyVecEnv of ViZDoom", [(ours(), theirs()) for _ in range(rounds)])


def torchrl(rounds):
    from torchrl.collectors import Collector
    from torchrl.envs import GymWrapper, SerialEnv

    from hasard_rs.torchrl import HasardEnv

    def collected(made):
        collector = iter(Collector(made, None, frames_per_batch=800, total_frames=-1))
        next(collector)
        return lambda: rate(lambda: next(collector), 800)

    ours = collected(HasardEnv(f"hasard/{IDS[0]}", 8, resolution="128x72"))
    theirs = collected(SerialEnv(8, lambda: GymWrapper(published())))
    print_row("TorchRL's Collector with random actions, 8 worlds, beside SerialEnv of ViZDoom", [(ours(), theirs()) for _ in range(rounds)])


def rllib(rounds):
    from ray.rllib.algorithms.ppo import PPOConfig
    from ray.rllib.core.rl_module.default_model_config import DefaultModelConfig
    from ray.rllib.env.single_agent_env_runner import SingleAgentEnvRunner
    from ray.tune.registry import register_env

    register_env("published", lambda _: published())

    def sampled(env, how, **arguments):
        # It is built and not asked: actions are random.
        network = DefaultModelConfig(conv_filters=[[16, 8, 4], [32, 4, 2]])
        config = PPOConfig().environment(env, env_config=arguments).rl_module(model_config=network)
        runner = SingleAgentEnvRunner(config=config.env_runners(num_envs_per_env_runner=8, gym_env_vectorize_mode=how))
        sample = lambda: runner.sample(num_timesteps=800, random_actions=True)  # noqa: E731
        sample()
        return lambda: rate(sample, 800)

    ours, theirs = sampled(f"hasard_rs:hasard/{IDS[0]}", "vector_entry_point", resolution="128x72"), sampled("published", "sync")
    print_row("RLlib's SingleAgentEnvRunner with random actions, 8 worlds, beside ViZDoom's in SyncVectorEnv", [(ours(), theirs()) for _ in range(rounds)])


def sharing_a_core(part):
    """A part that compares with ViZDoom: all on one core."""

    def run(rounds):
        sys.path.insert(0, EXAMPLES)
        from beside_published_speed import on_one_core

        with on_one_core():
            part(rounds)

    return run


PARTS = {"batch": batch, "work": work, "single": single, "thread": thread, "import": imported}
PARTS |= {"sb3": sharing_a_core(sb3), "torchrl": sharing_a_core(torchrl), "rllib": sharing_a_core(rllib)}

if __name__ == "__main__":
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    print("| what | ours, per s | beside it | ratio |\n|---|---:|---:|---:|")
    for part in sys.argv[2:] or PARTS:
        PARTS[part](rounds)
