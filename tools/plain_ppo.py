"""Plain PPO on frames, for scripts that hold an agent of another library against this project's: as short as it can be."""

import numpy as np
import torch
from torch import nn
from torch.distributions import Categorical

GAMMA, LAMBDA, CLIP, RATE, ENTROPY, EPOCHS, BATCHES, STEPS = 0.99, 0.95, 0.1, 4e-4, 0.01, 3, 4, 128


class Policy(nn.Module):
    """Logits of all sub-actions, one group beside another, and a value."""

    def __init__(self, sizes):
        super().__init__()
        self.sizes = sizes
        layers = [nn.Conv2d(3, 16, 8, 4), nn.ReLU(), nn.Conv2d(16, 32, 4, 2), nn.ReLU(), nn.Conv2d(32, 32, 3, 2), nn.ReLU(), nn.Flatten()]
        self.encoder = nn.Sequential(*layers, nn.LazyLinear(256), nn.ReLU())
        self.policy, self.value = nn.Linear(256, sum(sizes)), nn.Linear(256, 1)

    def forward(self, frames):
        """Distributions and values of frames, bytes of (number, rows, columns, 3)."""
        x = self.encoder(frames.permute(0, 3, 1, 2).float() / 255)
        return [Categorical(logits=part) for part in self.policy(x).split(self.sizes, 1)], self.value(x)[:, 0]

    @torch.no_grad()
    def act(self, frames):
        """Drawn actions, their log-probabilities and values."""
        choices, values = self(torch.as_tensor(frames))
        actions = torch.stack([choice.sample() for choice in choices], 1)
        return actions, log_probability(choices, actions), values


def log_probability(choices, actions):
    return sum(choice.log_prob(action) for choice, action in zip(choices, actions.T))


def train(worlds, sizes, frames, skip=4):
    """Learns to maximise reward; a world has reset() -> frame and step(action) -> frame, reward, cost, over."""
    policy = Policy(sizes)
    seen = np.stack([world.reset() for world in worlds])
    policy.act(seen)  # makes the lazy layer
    with torch.no_grad():
        policy.policy.weight *= 0.01
    optimiser = torch.optim.Adam(policy.parameters(), RATE, eps=1e-5)
    sums, finished = np.zeros((len(worlds), 2)), []
    updates = frames // (STEPS * len(worlds) * skip)
    for update in range(updates):
        rows = []
        for _ in range(STEPS):
            actions, logs, values = policy.act(seen)
            results = [world.step(action) for world, action in zip(worlds, actions.numpy())]
            rewards, over = [torch.tensor([float(result[index]) for result in results]) for index in (1, 3)]
            rows.append((torch.as_tensor(seen), actions, logs, values, rewards, over))
            sums += [result[1:3] for result in results]
            for lane, result in enumerate(results):
                if result[3]:
                    finished.append(sums[lane].copy())
                    sums[lane] = 0
            seen = np.stack([world.reset() if result[3] else result[0] for world, result in zip(worlds, results)])
        learn(policy, optimiser, rows, policy.act(seen)[2])
        if finished:
            means = "{:.2f} @ {:.2f}".format(*np.mean(finished[-32:], 0))
            print(f"{(update + 1) * STEPS * len(worlds) * skip} frames: return @ cost of the last episodes {means}", flush=True)
    return policy


def learn(policy, optimiser, rows, last_value):
    frames, actions, logs, values, rewards, over = map(torch.stack, zip(*rows))
    advantages, advantage, following = torch.zeros_like(values), 0.0, last_value
    for step in reversed(range(len(rows))):
        goes_on = 1 - over[step]
        error = rewards[step] + GAMMA * following * goes_on - values[step]
        advantage = error + GAMMA * LAMBDA * goes_on * advantage
        advantages[step], following = advantage, values[step]
    flat = [x.flatten(0, 1) for x in (frames, actions, logs, advantages, advantages + values)]
    for _ in range(EPOCHS):
        for part in torch.randperm(len(flat[0])).chunk(BATCHES):
            frames, actions, logs, advantages, returns = (x[part] for x in flat)
            choices, values = policy(frames)
            ratio = (log_probability(choices, actions) - logs).exp()
            advantages = (advantages - advantages.mean()) / (advantages.std() + 1e-8)
            gain = torch.min(ratio * advantages, ratio.clamp(1 - CLIP, 1 + CLIP) * advantages).mean()
            entropy = sum(choice.entropy() for choice in choices).mean()
            loss = 0.5 * (returns - values).pow(2).mean() - gain - ENTROPY * entropy
            optimiser.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(policy.parameters(), 0.5)
            optimiser.step()
