"""The policy network of a run's checkpoint in NumPy, for scripts that run nothing of ours.

`python/tests/test_numpy_agent.py` holds its outputs against the program's own.
"""

import glob
import json
import os

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

# Added to a pixel's variance, and the bounds of what enters the network.
PIXEL_EPSILON, MOST = 1e-5, 5


def tensors(path):
    """The arrays of a safetensors file by name."""
    with open(path, "rb") as file:
        data = file.read()
    length = int.from_bytes(data[:8], "little")
    names = json.loads(data[8 : 8 + length])
    names.pop("__metadata__", None)
    kinds = {"F32": np.float32, "F64": np.float64}
    read = lambda info: np.frombuffer(data[8 + length :][slice(*info["data_offsets"])], kinds[info["dtype"]]).reshape(info["shape"])
    return {name: read(info) for name, info in names.items()}


def checkpoint_of(run, latest):
    """The weights that `hasard eval` plays: of the checkpoint that the run selected, where it has one, or the latest."""
    found = lambda name: sorted(glob.glob(os.path.join(run, "checkpoints", name, "weights.safetensors")))
    best = [] if latest else found("best_*")
    return (best or found("frames_*"))[-1]


def of_run(run, listed, latest=False):
    """A run's agent, its environment's settings, and its sub-actions, which the file `listed` has from `hasard envs --json`."""
    with open(os.path.join(run, "config.json")) as file:
        config = json.load(file)
    env = config["env"]
    if env["full_actions"] or env["observation"] != "rgb" or env["frame_stack"] != 1 or env["size"] != [128, 72] or config["network"]["separate"]:
        raise SystemExit(f"{run}: needs an agent of simplified actions that sees one colour frame of 128x72, values and policy in one network")
    with open(listed) as file:
        groups = next(known["actions"]["simplified"] for known in map(json.loads, file) if known["id"] == env["id"])
    return Agent(checkpoint_of(run, latest), config["network"]["convolutions"], [len(group) + 1 for group in groups]), env, groups


def reduced(frame):
    """The nearest-neighbour reduction of 160x120 to 128x72 that learners see."""
    rows, columns = np.arange(72) * 120 // 72, np.arange(128) * 160 // 128
    return frame[rows][:, columns]


def elu(x):
    return np.where(x > 0, x, np.expm1(np.minimum(x, 0)))


def sigmoid(x):
    return 1 / (1 + np.exp(-x))


class Agent:
    """The policy network of a checkpoint, one step at a time."""

    def __init__(self, checkpoint, convolutions, sizes):
        self.weights, self.convolutions, self.sizes = tensors(checkpoint), convolutions, sizes
        if "network0.stage0.convolution.weight" in self.weights:
            raise SystemExit("this example computes plain convolutions, and the run has a residual encoder: train with network.residual=[]")
        if "network0.lstm.hidden_weight" in self.weights:
            raise SystemExit("this example computes GRUs, and the run has an LSTM: train with network.cell=\"gru\"")
        deviation = np.sqrt(self.weights["pixels.variance"] + PIXEL_EPSILON)
        self.scale, self.shift = 1 / (255 * deviation), -self.weights["pixels.mean"] / deviation
        self.forget()

    def layer(self, name, x):
        return x @ self.weights[f"network0.{name}.weight"] + self.weights[f"network0.{name}.bias"]

    def forget(self):
        hidden = self.weights.get("network0.gru.hidden_weight")
        self.state = None if hidden is None else np.zeros(len(hidden), np.float32)

    def logits(self, frame):
        x = (frame.reshape(-1) * self.scale + self.shift).astype(np.float32).clip(-MOST, MOST).reshape(frame.shape)
        for index, convolution in enumerate(self.convolutions):
            kernel, stride = convolution["kernel"], convolution["stride"]
            weights = self.weights[f"network0.convolution{index}.weight"]
            windows = sliding_window_view(x, (kernel, kernel), (0, 1))[::stride, ::stride]
            x = elu(np.einsum("hwcij,ijco->hwo", windows, weights, optimize=True) + self.weights[f"network0.convolution{index}.bias"])
        x, index = x.reshape(-1), 0
        while f"network0.dense{index}.weight" in self.weights:
            x, index = elu(self.layer(f"dense{index}", x)), index + 1
        if self.state is not None:
            of_input = x @ self.weights["network0.gru.input_weight"] + self.weights["network0.gru.input_bias"]
            of_state = self.state @ self.weights["network0.gru.hidden_weight"] + self.weights["network0.gru.hidden_bias"]
            (reset, update, candidate), (more_reset, more_update, share) = np.split(of_input, 3), np.split(of_state, 3)
            update = sigmoid(update + more_update)
            candidate = np.tanh(candidate + sigmoid(reset + more_reset) * share)
            x = self.state = candidate + update * (self.state - candidate)
        return self.layer("head0", x)

    def act(self, frame, rng):
        """A draw of each sub-action, or the likeliest without a generator."""
        rows = np.split(self.logits(frame), np.cumsum(self.sizes)[:-1])
        if rng is None:
            return [int(row.argmax()) for row in rows]
        shares = [np.exp(row - row.max()).astype(np.float64) for row in rows]
        return [int(rng.choice(len(share), p=share / share.sum())) for share in shares]
