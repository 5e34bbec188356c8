"""PPO with a PID Lagrangian in one file: recurrent, any number of constraints, on CPU or CUDA, with TensorBoard.

    pip install '.[torch]'
    python python/examples/ppo_lag_torch.py --env-id hasard/VolcanicVentureLevel1-v0 --total-frames 2000000
    python python/examples/ppo_lag_torch.py --safety-budget 50 --safety-budget jumps=20        # two constraints
    tensorboard --logdir runs

PPO: Schulman et al. 2017. The multipliers follow Stooke, Achiam, Abbeel 2020 (algorithm 2). Settings and formulas are those
that `hasard train --preset quick` had on 2026-11-25; docs/results/torch_example.md has the options that give them, and compares
what both learn. One step of an environment is four frames, as the paper counts them.
"""

from __future__ import annotations

import argparse
import time
from collections import deque
from pathlib import Path

import numpy as np
import torch
from torch import nn
from torch.distributions import Categorical
from torch.utils.tensorboard import SummaryWriter

import hasard_rs


def parse_args() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--env-id", default="hasard/VolcanicVentureLevel1-v0")
    parser.add_argument("--total-frames", type=int, default=2_000_000, help="length of the training, in frames")
    parser.add_argument("--safety-budget", action="append", metavar="COST", help="budget of an episode, or TERM=COST; the scenario's if absent")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--device", default="cuda" if torch.cuda.is_available() else "cpu")
    parser.add_argument("--threads", type=int, default=0, help="threads of torch; 0: all cores")
    parser.add_argument("--out", type=Path, default=None, help="folder of the run; runs/ENV-torch-seedSEED if absent")
    parser.add_argument("--num-envs", type=int, default=32)
    parser.add_argument("--num-steps", type=int, default=32, help="steps of a rollout; gradients flow back through all of them")
    parser.add_argument("--epochs", type=int, default=2)
    parser.add_argument("--minibatches", type=int, default=2)
    parser.add_argument("--learning-rate", type=float, default=5e-4)
    parser.add_argument("--final-learning-rate", type=float, default=1e-4)
    parser.add_argument("--gamma", type=float, default=0.99)
    parser.add_argument("--gae-lambda", type=float, default=0.95)
    parser.add_argument("--clip", type=float, default=0.1, help="ratios are clipped to 1/(1+clip) .. 1+clip")
    parser.add_argument("--clip-value", type=float, default=1.0)
    parser.add_argument("--exploration", type=float, default=0.003, help="weight of the policy's distance from a uniform one")
    parser.add_argument("--value-coefficient", type=float, default=0.5)
    parser.add_argument("--max-grad-norm", type=float, default=4.0)
    parser.add_argument("--budget-share", type=float, default=0.9, help="the multipliers aim at this share of each budget")
    parser.add_argument("--kp", type=float, default=1.5, help="proportional gain: multiplier per cost a step above the aim")
    parser.add_argument("--ki", type=float, default=0.04, help="integral gain: what a rollout adds per cost a step above the aim")
    parser.add_argument("--kd", type=float, default=0.0, help="derivative gain: multiplier per rise of the cost a step between updates")
    return parser.parse_args()


class Moments(nn.Module):
    """Running mean and variance of each column, which put numbers of unknown scale on one; cut off at five deviations."""

    def __init__(self, columns: int) -> None:
        super().__init__()
        for name, value in (("count", torch.ones(())), ("mean", torch.zeros(columns)), ("variance", torch.ones(columns))):
            self.register_buffer(name, value)

    @torch.no_grad()
    def update(self, rows: torch.Tensor) -> None:
        variance, mean = torch.var_mean(rows, 0)
        share, delta = len(rows) / (self.count + len(rows)), mean - self.mean
        self.variance.copy_(self.variance * (1 - share) + variance * share + delta**2 * share * (1 - share))
        self.mean.add_(delta * share)
        self.count.add_(len(rows))

    def normalised(self, values: torch.Tensor) -> torch.Tensor:
        return ((values - self.mean) / (self.variance + 1e-5).sqrt()).clamp(-5, 5)

    def denormalised(self, values: torch.Tensor) -> torch.Tensor:
        return values.clamp(-5, 5) * (self.variance + 1e-5).sqrt() + self.mean


class Agent(nn.Module):
    """Convolutions, a GRU, a policy of several independent choices, and a critic of the reward and of each cost."""

    def __init__(self, shape: tuple[int, int, int], choices: list[int], critics: int) -> None:
        super().__init__()
        height, width, channels = shape
        # Each pixel of each colour by its own moments; returns of the reward and of each cost likewise.
        self.pixels, self.returns = Moments(height * width * channels), Moments(critics)
        layers: list[nn.Module] = []
        for kernel, stride in ((8, 6), (3, 2), (3, 2)):
            layers += [nn.Conv2d(channels, 32, kernel, stride), nn.ELU()]
            channels = 32
        self.convolutions = nn.Sequential(*layers, nn.Flatten())
        with torch.no_grad():
            features = self.convolutions(torch.zeros(1, shape[2], height, width)).shape[1]
        self.dense = nn.Sequential(nn.Linear(features, 256), nn.ELU())
        self.memory = nn.GRUCell(256, 256)
        self.policy, self.critic = nn.Linear(256, sum(choices)), nn.Linear(256, critics)
        self.choices = choices
        for weights in self.parameters():
            nn.init.orthogonal_(weights) if weights.dim() > 1 else nn.init.zeros_(weights)

    def forward(self, pixels: torch.Tensor, state: torch.Tensor, begins: torch.Tensor) -> tuple[list[Categorical], torch.Tensor, torch.Tensor]:
        """Of pixels uint8 [steps, lanes, h, w, c]: the policy, values [steps, lanes, critics] and the state after them. `begins` [steps, lanes] is 1
        where an episode begins, whose state is zero."""
        steps, lanes = pixels.shape[:2]
        flat = self.pixels.normalised(pixels.reshape(steps * lanes, -1) / 255).view(-1, *pixels.shape[2:])
        features = self.dense(self.convolutions(flat.permute(0, 3, 1, 2))).unflatten(0, (steps, lanes))
        rows = []
        for feature, begin in zip(features, begins):
            state = self.memory(feature, state * (1.0 - begin[:, None]))
            rows.append(state)
        hidden = torch.stack(rows)
        return [Categorical(logits=part) for part in self.policy(hidden).split(self.choices, -1)], self.critic(hidden), state


def log_probability(policy: list[Categorical], actions: torch.Tensor) -> torch.Tensor:
    return sum(part.log_prob(actions[..., index]) for index, part in enumerate(policy))


def distance_from_uniform(policy: list[Categorical]) -> torch.Tensor:
    """Mean of the divergences from a uniform policy, one way and the other: it keeps a policy from settling too early."""
    return sum(0.5 * ((part.probs - 1 / part.probs.shape[-1]) * part.logits).sum(-1) for part in policy)


class PidMultipliers:
    """A multiplier for each constraint, moved by what an episode costs above its aim, a step."""

    def __init__(self, args: argparse.Namespace, budgets: np.ndarray, episode_steps: float) -> None:
        self.gains, self.aims, self.steps = (args.kp, args.ki, args.kd), budgets * args.budget_share, episode_steps
        self.integral, self.last, self.values = np.zeros_like(budgets), np.zeros_like(budgets), np.zeros_like(budgets)

    def update(self, fresh: np.ndarray, latest: np.ndarray, rollouts: int) -> None:
        """`fresh`: mean costs of the episodes that ended in so many rollouts, each of which counts once in the integral. `latest`: of as many
        as there are environments, since a few alone are noise to the other parts."""
        kp, ki, kd = self.gains
        self.integral = np.maximum(0.0, self.integral + ki * rollouts * (fresh - self.aims) / self.steps)
        rise = np.maximum(0.0, latest - self.last) / self.steps
        self.values = np.maximum(0.0, kp * (latest - self.aims) / self.steps + self.integral + kd * rise)
        self.last = latest


def constraints_of(args: argparse.Namespace, envs: hasard_rs.VectorEnv) -> tuple[list[str | None], np.ndarray]:
    """Term and budget of each constraint; the term None is the scalar cost."""
    given = args.safety_budget or [str(envs.safety_budget)]
    pairs, known = [text.rpartition("=") for text in given], [term.name for term in envs.cost_terms]
    for term, _, _ in pairs:
        if term and term not in known:
            raise SystemExit(f"--safety-budget {term}=...: the cost terms are {', '.join(known)}")
    return [term or None for term, _, _ in pairs], np.array([float(budget) for _, _, budget in pairs])


def main() -> None:
    args = parse_args()
    torch.manual_seed(args.seed)
    if args.threads:
        torch.set_num_threads(args.threads)
    device = torch.device(args.device)
    envs = hasard_rs.make_vec(args.env_id, args.num_envs, resolution="128x72", autoreset_mode="SameStep", infos="full")
    terms, budgets = constraints_of(args, envs)
    columns = [None if term is None else [one.name for one in envs.cost_terms].index(term) for term in terms]
    frame_skip, episode_steps = envs.frame_skip, envs.max_episode_steps
    out = args.out or Path("runs") / f"{args.env_id.split('/')[-1]}-torch-seed{args.seed}"
    writer = SummaryWriter(str(out))

    shape, choices, critics = envs.single_observation_space.shape, [int(n) for n in envs.single_action_space.nvec], 1 + len(budgets)
    agent = Agent(shape, choices, critics).to(device)
    optimiser = torch.optim.Adam(agent.parameters(), lr=args.learning_rate, eps=1e-6)
    multipliers = PidMultipliers(args, budgets, episode_steps)
    steps, lanes = args.num_steps, args.num_envs
    pixels = torch.zeros((steps, lanes, *shape), dtype=torch.uint8, device=device)
    begins, log_probabilities = (torch.zeros((steps, lanes), device=device) for _ in range(2))
    actions = torch.zeros((steps, lanes, len(choices)), dtype=torch.long, device=device)
    # Column 0 is the reward, the others are the constraints' costs.
    gains, values = (torch.zeros((steps, lanes, critics), device=device) for _ in range(2))
    ends = torch.zeros((steps, lanes), device=device)

    def of_step(rewards: np.ndarray, infos: dict) -> np.ndarray:
        costs = [infos["cost"] if column is None else infos["cost_terms"][:, column] for column in columns]
        return np.stack([rewards, *costs], -1).astype(np.float32)

    observation, _ = envs.reset(seed=args.seed)
    envs.action_space.seed(args.seed)
    # Lanes begin at different moments, so that their episodes do not all end in one rollout.
    for step in range(episode_steps - 1):
        observation, *_ = envs.step(envs.action_space.sample())
        due = np.arange(lanes) * episode_steps // lanes == step
        if due.any():
            observation, _ = envs.reset(options={"reset_mask": due})
    observation = torch.as_tensor(observation, device=device)
    state, begin = torch.zeros((lanes, 256), device=device), torch.ones(lanes, device=device)
    running, finished, latest = np.zeros((lanes, critics)), [], deque(maxlen=100)
    # Whether a lane's episode was seen from its beginning: others say nothing of what episodes cost.
    whole = np.zeros(lanes, dtype=bool)
    frames, rollouts, waited, began, said = 0, 0, 0, time.time(), 0.0
    while frames < args.total_frames:
        share = frames / args.total_frames
        optimiser.param_groups[0]["lr"] = args.learning_rate + share * (args.final_learning_rate - args.learning_rate)
        first_state = state
        for step in range(steps):
            pixels[step], begins[step] = observation, begin
            with torch.no_grad():
                policy, value, state = agent(observation[None], state, begin[None])
            action = torch.stack([part.sample()[0] for part in policy], -1)
            actions[step], values[step] = action, value[0]
            log_probabilities[step] = log_probability(policy, action[None])[0]
            observation, rewards, terminated, truncated, infos = envs.step(action.cpu().numpy())
            observation = torch.as_tensor(observation, device=device)
            gain = of_step(rewards, infos)
            running += gain
            over = terminated | truncated
            gains[step], ends[step] = torch.as_tensor(gain, device=device), torch.as_tensor(over, dtype=torch.float32, device=device)
            begin = ends[step].clone()
            if truncated.any():
                # A time-out only cuts an episode off: what would have come is worth what the critic says of its last picture.
                cut = np.flatnonzero(truncated & ~terminated)
                last = torch.as_tensor(np.stack([infos["final_obs"][lane] for lane in cut]), device=device)
                with torch.no_grad():
                    _, beyond, _ = agent(last[None], state[cut], torch.zeros((1, len(cut)), device=device))
                gains[step, cut] += args.gamma * agent.returns.denormalised(beyond[0])
            finished += [running[lane].copy() for lane in np.flatnonzero(over & whole)]
            running[over], whole = 0.0, whole | over
        frames, rollouts, waited = frames + steps * lanes * frame_skip, rollouts + 1, waited + 1
        if finished:
            latest.extend(finished)
            multipliers.update(np.mean(finished, 0)[1:], np.mean(list(latest)[-lanes:], 0)[1:], waited)
            finished, waited = [], 0

        with torch.no_grad():
            _, value, _ = agent(observation[None], state, begin[None])
            estimates, following = agent.returns.denormalised(values), agent.returns.denormalised(value[0])
            advantages, later = torch.zeros_like(gains), 0.0
            for step in reversed(range(steps)):
                goes_on = (1.0 - ends[step])[:, None]
                surprise = gains[step] + args.gamma * following * goes_on - estimates[step]
                later = surprise + args.gamma * args.gae_lambda * goes_on * later
                advantages[step], following = later, estimates[step]
            returns = advantages + estimates
            agent.returns.update(returns.flatten(0, 1))
            targets = agent.returns.normalised(returns)
            agent.pixels.update(pixels.view(steps * lanes, -1) / 255)
            prices = torch.as_tensor(multipliers.values, dtype=torch.float32, device=device)
            mixed = advantages[..., 0] - (advantages[..., 1:] * prices).sum(-1)

        for _ in range(args.epochs):
            for part in torch.randperm(lanes, device=device).chunk(args.minibatches):
                policy, value, _ = agent(pixels[:, part], first_state[part], begins[:, part])
                ratio = (log_probability(policy, actions[:, part]) - log_probabilities[:, part]).exp()
                advantage = mixed[:, part]
                advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
                clipped = ratio.clamp(1.0 / (1.0 + args.clip), 1.0 + args.clip)
                policy_loss = -torch.min(ratio * advantage, clipped * advantage).mean()
                near = values[:, part] + (value - values[:, part]).clamp(-args.clip_value, args.clip_value)
                errors = torch.max((value - targets[:, part]) ** 2, (near - targets[:, part]) ** 2)
                loss = policy_loss + args.value_coefficient * errors.mean((0, 1)).sum() + args.exploration * distance_from_uniform(policy).mean()
                optimiser.zero_grad()
                loss.backward()
                norm = nn.utils.clip_grad_norm_(agent.parameters(), args.max_grad_norm)
                optimiser.step()

        entropy = sum(one.entropy() for one in policy).mean()
        row = {"loss": loss.item(), "policy_loss": policy_loss.item(), "entropy": entropy.item(), "gradient_norm": norm.item()}
        row |= {"learning_rate": optimiser.param_groups[0]["lr"], "fps": frames / (time.time() - began)}
        row |= {f"multiplier/{term or 'cost'}": price for term, price in zip(terms, multipliers.values)}
        if latest:
            means = np.mean(latest, 0)
            row |= {"return_mean": means[0]} | {f"cost_mean/{term or 'cost'}": cost for term, cost in zip(terms, means[1:])}
        for name, number in row.items():
            writer.add_scalar(name, number, frames)
        if latest and (time.time() - said > 10 or frames >= args.total_frames):
            costs = ", ".join(f"{t or 'cost'} {c:.1f} of {b:g} (multiplier {m:.3f})" for t, c, b, m in zip(terms, means[1:], budgets, multipliers.values))
            print(f"{frames:,} frames at {row['fps']:,.0f}/s: return {means[0]:.2f}, {costs}", flush=True)
            said = time.time()
    torch.save({"agent": agent.state_dict(), "args": {name: str(value) for name, value in vars(args).items()}}, out / "agent.pt")
    writer.close()
    envs.close()


if __name__ == "__main__":
    main()
