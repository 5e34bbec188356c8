"""A trained agent's network as a `torch.nn.Module`, for those who go on from there.

    network = hasard_rs.torch.load("runs/vv1")
    outputs, state = network(observations, state=None)

`outputs` [n, logits and deltas | value | cost values] are those of our own kernels to 1e-4.
"""

from __future__ import annotations

import json
import os
import struct
from pathlib import Path
from typing import Any

import numpy as np

from hasard_rs import _core
from hasard_rs._extra import need
from hasard_rs.errors import InvalidOption

torch = need("torch", "torch", "torch")

_EPSILON = 1e-5


def read_weights(path: Path) -> dict[str, np.ndarray]:
    """Returns the tensors, by name, of the safetensors file at `path`: a length, a JSON header, the bytes."""
    data = path.read_bytes()
    (length,) = struct.unpack("<Q", data[:8])
    header = json.loads(data[8 : 8 + length])
    body, kinds = data[8 + length :], {"F32": np.float32, "F64": np.float64, "U64": np.uint64, "U8": np.uint8}
    tensors = {}
    for name, entry in header.items():
        if name != "__metadata__":
            start, end = entry["data_offsets"]
            tensors[name] = np.frombuffer(body[start:end], kinds[entry["dtype"]]).reshape(entry["shape"]).copy()
    return tensors


class Network(torch.nn.Module):  # type: ignore[name-defined,misc]
    """Convolutions or a residual encoder, dense layers, a GRU or LSTM if there is one, and linear heads, on one 8-bit image.

    Args:
        weights: arrays by name, of this network.
        settings: the part "network" of the run's config.json.
    """

    def __init__(self, weights: dict[str, np.ndarray], settings: dict[str, Any]) -> None:
        super().__init__()
        layers = {name.rpartition(".")[0] for name in weights}

        def tensor(name: str) -> Any:
            return torch.from_numpy(np.ascontiguousarray(weights[name]))

        def convolution(name: str, stride: int, padding: int) -> Any:
            weight = tensor(f"{name}.weight").permute(3, 2, 0, 1).contiguous()
            layer = torch.nn.Conv2d(weight.shape[1], weight.shape[0], weight.shape[2], stride, padding)
            layer.weight.data, layer.bias.data = weight, tensor(f"{name}.bias")
            return layer

        self.convolutions, self.stages = torch.nn.ModuleList(), torch.nn.ModuleList()
        stages = settings.get("residual", [])
        for index, layer in enumerate([] if stages else settings["convolutions"]):
            self.convolutions.append(convolution(f"convolution{index}", layer["stride"], 0))
        for stage in range(len(stages)):
            names = ["convolution", *(f"block{block}.convolution{index}" for block in range(2) for index in range(2))]
            self.stages.append(torch.nn.ModuleList(convolution(f"stage{stage}.{name}", 1, 1) for name in names))
        self.dense = torch.nn.ModuleList(self._linear(tensor, f"dense{i}") for i in range(sum(name.startswith("dense") for name in layers)))
        self.cell = None
        for kind, module in {"gru": torch.nn.GRUCell, "lstm": torch.nn.LSTMCell}.items():
            if f"{kind}.input_weight" in weights:
                weight, hidden = tensor(f"{kind}.input_weight").T.contiguous(), tensor(f"{kind}.hidden_weight").T.contiguous()
                self.cell = module(weight.shape[1], hidden.shape[1])
                self.cell.weight_ih.data, self.cell.bias_ih.data = weight, tensor(f"{kind}.input_bias")
                self.cell.weight_hh.data, self.cell.bias_hh.data = hidden, tensor(f"{kind}.hidden_bias")
        self.heads = torch.nn.ModuleList(self._linear(tensor, f"head{i}") for i in range(sum(name.startswith("head") for name in layers)))

    @staticmethod
    def _linear(tensor: Any, name: str) -> Any:
        weight = tensor(f"{name}.weight").T.contiguous()
        layer = torch.nn.Linear(weight.shape[1], weight.shape[0])
        layer.weight.data, layer.bias.data = weight, tensor(f"{name}.bias")
        return layer

    def forward(self, images: Any, extra: Any = None, state: Any = None) -> tuple[Any, Any]:
        """Runs the network.

        Args:
            images: normalised, float32 [n, channels, height, width].
            extra: further features, float32 [n, m], or None.
            state: of the GRU, float32 [n, hidden], or of the LSTM, a pair of them (output, cell); None: episodes begin.

        Returns:
            Outputs float32 [n, ...], and the state after.
        """
        values = images
        for layer in self.convolutions:
            values = torch.nn.functional.elu(layer(values))
        for first, *blocks in self.stages:
            values = torch.nn.functional.max_pool2d(first(values), 3, 2, 1)
            for one, two in zip(blocks[::2], blocks[1::2], strict=True):
                values = values + two(torch.relu(one(torch.relu(values))))
        values = torch.relu(values) if self.stages else values
        # Features are stored row by row, channels last.
        values = values.permute(0, 2, 3, 1).reshape(len(values), -1)
        for layer in self.dense:
            values = torch.nn.functional.elu(layer(values))
        if extra is not None:
            values = torch.cat([values, extra], 1)
        if self.cell is not None:
            state = self.cell(values, state)
            values = state[0] if isinstance(state, tuple) else state
        return torch.cat([head(values) for head in self.heads], 1), state


class Model(torch.nn.Module):  # type: ignore[name-defined,misc]
    """The whole model of a run: one network, or one for the policy and for each critic. Made by `load`.

    Args:
        weights: arrays by name, of a checkpoint.
        settings: the part "network" of the run's config.json.
    """

    def __init__(self, weights: dict[str, np.ndarray], settings: dict[str, Any]) -> None:
        super().__init__()
        factor = 1.0 / np.sqrt(weights["pixels.variance"] + _EPSILON)
        self.register_buffer("scale", torch.from_numpy((factor / 255.0).astype(np.float32)))
        self.register_buffer("shift", torch.from_numpy((-weights["pixels.mean"] * factor).astype(np.float32)))
        count = 1 + max(int(name.split(".")[0].removeprefix("network")) for name in weights if name.startswith("network"))
        own = [{name.partition(".")[2]: value for name, value in weights.items() if name.startswith(f"network{i}.")} for i in range(count)]
        self.networks = torch.nn.ModuleList(Network(part, settings) for part in own)

    def forward(self, observations: Any, state: Any = None, extra: Any = None) -> tuple[Any, list[Any]]:
        """Runs the model.

        Args:
            observations: uint8 [n, height, width, channels].
            state: each network's; None: episodes begin.
            extra: what is left of the budget, float32 [n, 1], for PPOSaute's agents.

        Returns:
            Outputs float32 [n, logits and deltas | value | cost values], and each network's state after.
        """
        count, shape = len(observations), observations.shape[1:]
        pixels = (observations.reshape(count, -1).float() * self.scale + self.shift).clamp(-5.0, 5.0)
        images = pixels.reshape(count, *shape).permute(0, 3, 1, 2)
        states = [None] * len(self.networks) if state is None else state
        results = [network(images, extra, own) for network, own in zip(self.networks, states, strict=True)]
        return torch.cat([outputs for outputs, _ in results], 1), [after for _, after in results]


def load(run: str | os.PathLike[str], *, best: bool = False) -> Model:
    """The network of a trained agent.

    Args:
        run: the directory that `hasard_rs.train`, or the program, wrote.
        best: the best checkpoint within budget instead of the newest; the newest too of a run without one, as `Agent.load`.

    Returns:
        A `Model`, on the CPU.

    Raises:
        InvalidOption where no checkpoint was written, or the best one is spoiled; of others the newest whole one counts.
    """
    checkpoint = _core.checkpoint_of(run, best)
    if checkpoint is None:
        raise InvalidOption(f"{run}: no checkpoint was written there; give the directory of a run")
    settings = json.loads((Path(run) / "config.json").read_text())["network"]
    return Model(read_weights(Path(checkpoint) / "weights.safetensors"), settings)
