"""The native vector environment."""

from __future__ import annotations

import copy
import secrets
from typing import Any, ClassVar

import numpy as np
from gymnasium import logger, spaces
from gymnasium.vector.utils import batch_space

from hasard_rs import arguments as _arguments
from hasard_rs import columns as _columns
from hasard_rs._core import Batch, Worlds
from hasard_rs.common import Shared, frame_size
from hasard_rs.errors import InvalidOption, OutOfTurn
from hasard_rs.infos import Infos, row, summary
from hasard_rs.own import names_kept, scenario_and_level
from hasard_rs.spaces import action_format
from hasard_rs.turns import Result, Turns
from hasard_rs.wrappers.drawable import coloured

try:
    from gymnasium.vector import AutoresetMode
    from gymnasium.vector import VectorEnv as _Base
except ImportError:
    AutoresetMode = None  # type: ignore[assignment,misc]
    _Base = object  # type: ignore[assignment,misc]

_CALLS = ("render", "position", "episode_seed", "state_hash", "action_masks")
# Of all lanes at once: a call a lane would do them as often as there are lanes.
_OF_ALL = ("reset", "step", "send", "recv", "save", "load", "close", "close_extras", "call", "get_attr", "set_attr")


class VectorEnv(Shared, _Base):  # type: ignore[misc,valid-type]
    """A batch of worlds, as Gymnasium's vector environment; stepped by Rust threads while the interpreter is free.

    Made by `hasard_rs.make_vec(id, num_envs, **arguments)` or `gymnasium.make_vec`. Gymnasium 1.1 or newer.

    Args:
        num_envs: lanes, 1 to 65536.
        num_threads: worker threads beside the caller's; 0: none. None: one for every four lanes, as far as there are processors. No result
            depends on it.
        autoreset_mode: "NextStep", "SameStep" or "Disabled", or Gymnasium's enum.
        batch_size: 0: every step is of all lanes. Otherwise it divides num_envs, and lanes are stepped in groups of so many, in turn: `send`
            takes the actions of the group that has waited longest, `recv` gives the next group; `step` does both.
        copy: False: every call writes over the last one's arrays. Unsafe but for measurements.
        arguments: those of `help(hasard_rs.Env)`.

    Raises:
        UnknownEnvironment, InvalidOption, InvalidMap, or TypeError for a name that is no argument; ImportError with an older Gymnasium.

    A batch of different tasks, `make_vec(["hasard/RemedyRushLevel1-v0", "my_task.toml"], 64)`, has the buttons, cost terms and statistics of all
    of them; lane i has task i modulo their number. A button that a task does not have does nothing there (`action_masks`), infos have "task",
    and scenario_name, level are tuples, safety_budget an array of one a lane.

    Attributes:
        tasks: ids of the tasks. lane_tasks: int32 [num_envs], which of them each lane has. action_masks: bool [num_envs, sum of the
        sub-actions' choices], which choices do something in each lane.
        single_observation_space, single_action_space: as of an `Env`. observation_space, action_space: batches of them.
        autoreset_mode: Gymnasium's enum, in `metadata` too. cost_terms, safety_budget, max_episode_steps, extent, scenario_name, level,
        hard_constraint, frame_skip, spec: as of an `Env`.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["rgb_array", "depth_array"], "render_fps": 8.75}  # type: ignore[misc]

    def __init__(
        self,
        *,
        num_envs: int = 1,
        num_threads: int | None = None,
        autoreset_mode: Any = "NextStep",
        batch_size: int = 0,
        copy: bool = True,
        **arguments: Any,
    ) -> None:
        if AutoresetMode is None:
            raise ImportError("VectorEnv needs Gymnasium 1.1 or newer: pip install -U gymnasium; Env and hasard_rs.Worlds work with older ones")
        self.closed = False
        with names_kept(arguments):
            self._build(arguments, num_envs, num_threads, autoreset_mode, batch_size, copy)

    def _build(self, arguments: dict[str, Any], num_envs: int, num_threads: int | None, autoreset_mode: Any, batch_size: int, copy: bool) -> None:
        given = _arguments.read(arguments, vector=True)
        _arguments.check_no_bools({"num_envs": num_envs, "num_threads": num_threads})
        if not isinstance(copy, (bool, np.bool_)):
            raise InvalidOption(f"copy cannot be {copy!r}; it must be True or False")
        self._arguments = {**arguments, "num_envs": num_envs, "num_threads": num_threads, "batch_size": batch_size, "copy": copy}
        self._given = given
        if autoreset_mode is None:
            raise InvalidOption("autoreset_mode cannot be None; it must be 'NextStep', 'SameStep' or 'Disabled'")
        if not _arguments.is_whole(batch_size):
            raise InvalidOption(f"batch_size cannot be {batch_size!r}; it must be a whole number")
        # Whether num_envs is a number is for the worlds to say.
        if batch_size and _arguments.is_whole(num_envs) and (batch_size < 0 or num_envs % batch_size):
            raise InvalidOption(f"batch_size cannot be {batch_size}; it must divide num_envs ({num_envs}), or be 0 for all lanes")
        groups = num_envs // batch_size if batch_size and _arguments.is_whole(num_envs) else 1
        self._worlds = Worlds(
            given.env_id,
            num_envs,
            num_threads=num_threads,
            groups=groups,
            autoreset_mode=autoreset_mode,
            statistics=given.env_stats,
            **given.world,
        )
        mode = getattr(autoreset_mode, "value", autoreset_mode)
        self.autoreset_mode = AutoresetMode({"next_step": "NextStep", "same_step": "SameStep", "disabled": "Disabled"}.get(mode, mode))
        self._arguments["autoreset_mode"] = self.autoreset_mode.value
        self._format = action_format(given.action_format, self._worlds.nvec, self._worlds.num_deltas, given.delta_bins)
        self._infos = Infos(self._worlds, scenario_and_level(given.env_id)[0], given.infos, given.env_stats)
        self._same_step = self.autoreset_mode == AutoresetMode.SAME_STEP
        # The lanes that a NEXT_STEP step will reset.
        self._over = np.zeros(num_envs, dtype=np.bool_)
        self._groups, self._turns = groups, Turns(groups)
        self.num_envs = num_envs
        self.batch_size = batch_size or num_envs
        self.single_observation_space = spaces.Box(0, 255, self._worlds.observation_shape, np.uint8)
        self.single_action_space = self._format.space
        self.observation_space = batch_space(self.single_observation_space, self.batch_size)
        self.action_space = batch_space(self.single_action_space, self.batch_size)
        self._describe(autoreset_mode=self.autoreset_mode)
        if not copy:
            self._bind()

    @property
    def tasks(self) -> tuple[str, ...]:
        """The ids of the tasks, one where all lanes have the same."""
        return tuple(f"hasard/{env_id}" for env_id in self._worlds.env_id.split(","))

    @property
    def lane_tasks(self) -> np.ndarray:
        """Which of the tasks each lane has: int32 [num_envs]."""
        return self._worlds.lane_tasks

    @property
    def action_masks(self) -> np.ndarray:
        """Which choices of each sub-action, one sub-action after the other, do something in each lane's task: bool [num_envs, choices]."""
        return self._worlds.action_masks

    @property
    def worlds(self) -> Worlds:
        """The raw worlds below."""
        return self._worlds

    def _bind(self) -> None:
        """Results go to the same arrays in every step."""
        n = self.num_envs
        self._worlds.bind(
            observations=np.zeros((n, *self._worlds.observation_shape), np.uint8),
            rewards=np.zeros(n, np.float32),
            costs=np.zeros(n, np.float32),
            terminated=np.zeros(n, np.bool_),
            truncated=np.zeros(n, np.bool_),
        )

    def reset(  # type: ignore[override]
        self, *, seed: Any = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Starts episodes.

        Args:
            seed: an int s seeds lane i with s + i, a sequence has one entry a lane; None goes on with the lane's stream, or
                begins it by the argument `seed`. Not negative.
            options: `options["reset_mask"]` (bool [num_envs]) resets those lanes only; the others are returned as they are.

        Returns:
            Observations, uint8 [num_envs, ...], and infos: arrays float64, int32, uint64 with first axis num_envs, and for each key a mask
            bool [num_envs] under "_key". With `batch_size`: of the first group, or, with a mask, of the group that has waited longest
            for actions; the others come by `recv`.

            Steps under way are given up with their episodes. A mask gives none up: `recv` brings them, lanes that were reset with their first
            observation and no reward.

        Raises:
            TypeError or ValueError for seeds or a mask of the wrong kind; ResetNeeded for a first reset of some lanes only; OutOfTurn for a
            mask after `send`, where rewards and costs would be lost; Closed after `close`. Nothing has changed then.
        """
        seeds = self._seeds(seed)
        mask = self._mask(options)
        chosen = np.ones(self.num_envs, np.bool_) if mask is None else mask
        turns = self._turns
        if chosen.all():
            for group in sorted(turns.under_way):
                self._worlds.recv(group)
                turns.under_way.discard(group)
            turns.back.clear()
        elif not turns.due and (turns.under_way or turns.back):
            raise OutOfTurn("a step is under way, whose rewards and costs a reset_mask would lose; call recv first")
        else:
            self._wait()
        if isinstance(seeds, int):
            super().reset(seed=seeds)
        batch = self._worlds.reset(seeds, mask)
        self._over[chosen] = False
        self._infos.begin(chosen)
        infos: dict[str, Any] = {}
        for key, column in self._infos.step(batch).items():
            _columns.put(infos, key, column, chosen)
        if self._groups == 1:
            turns.due = [0]
            return batch.observations, infos
        rests = {group: self._at_rest(batch, infos, group) for group in range(self._groups)}
        # What was returned is returned again; what waits to be fetched keeps its rewards.
        back = {group: self._with_resets(result, rests[group], chosen[self._lanes(group)]) for group, result in turns.back.items()}
        first = 0 if chosen.all() else turns.due[0]
        observations, *_, infos = turns.restart({**rests, **back}, first)
        return observations, infos

    def _seeds(self, seed: Any) -> Any:
        if seed is None:
            if self._worlds.started:
                return None
            return self._given.seed if self._given.seed is not None else secrets.randbits(64)
        if _arguments.is_number(seed):
            return _arguments.check_seed(seed)
        if not hasattr(seed, "__iter__"):
            raise TypeError(f"a seed must be an integer, or a sequence with one for each lane, got {seed!r:.60}")
        seeds = [None if one is None else _arguments.check_seed(one) for one in seed]
        if len(seeds) != self.num_envs:
            raise ValueError(
                f"If seeds are passed as a list the length must match num_envs={self.num_envs} but got length={len(seeds)}."
            )
        first = self._given.seed
        if first is not None and not self._worlds.started:
            return [_arguments.check_seed(first + lane) if one is None else one for lane, one in enumerate(seeds)]
        return seeds

    def _mask(self, options: dict[str, Any] | None) -> np.ndarray | None:
        # The mask stays in the caller's dict: Gymnasium's wrappers read it after us.
        if options is None or "reset_mask" not in options:
            return None
        mask = options["reset_mask"]
        if not isinstance(mask, np.ndarray):
            raise TypeError(f"`options['reset_mask']` must be a numpy array, got {type(mask)}")
        if mask.shape != (self.num_envs,):
            raise ValueError(f"`options['reset_mask']` must have shape `({self.num_envs},)`, got {mask.shape}")
        if mask.dtype != np.bool_:
            raise TypeError(f"`options['reset_mask']` must have `dtype=np.bool_`, got {mask.dtype}")
        if not np.any(mask):
            raise ValueError(
                f"`options['reset_mask']` must contain a boolean array with at least one True value, got reset_mask={mask}"
            )
        return mask

    def step(self, actions: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Steps every lane; with `batch_size`, those that have waited longest for actions.

        Args:
            actions: of action_space: for "multi_discrete" integers [n, parts].

        Returns:
            (observations uint8 [n, ...], rewards float64 [n], terminations bool [n], truncations bool [n], infos); with `batch_size`, of the next
            group. `infos["cost"]` (float64 [n]) is the cost of the step just made under every autoreset mode. Where episodes end,
            "episode_summary" holds arrays by name; under SAME_STEP "final_obs" (object [n], arrays or None) and "final_info" too.

        Raises:
            InvalidAction, which names lane, part, value and range; TypeError or ValueError for the wrong dtype or shape; ResetNeeded before the
            first reset, or where a lane's episode is over under DISABLED; Closed after `close`. Nothing has moved then.
        """
        if self._groups > 1:
            # Once the actions are sent there is something to receive: a refused step has moved nothing.
            self.send(actions)
            return self.recv()
        if not self._turns.due and self._worlds.started:
            raise OutOfTurn("a step is under way; call recv first")
        return self._result(self._worlds.step(*self._format.many(actions, self.num_envs)))

    def send(self, actions: Any) -> None:
        """Hands over actions and comes back at once.

        Args:
            actions: for batch_size lanes, as for `step`: those that have waited longest since `reset`, `step` or `recv` returned them.

        Raises:
            What `step` raises; OutOfTurn if no lanes wait for actions.
        """
        turns = self._turns
        rows = self._format.many(actions, self.batch_size)
        # Worlds that were never reset, or are closed, say so themselves.
        if not turns.due and self._worlds.started:
            raise OutOfTurn("no lanes wait for actions; fetch what is under way by recv first")
        group = turns.due[0] if turns.due else 0
        self._worlds.send(*rows, group=group)
        turns.due.remove(group)
        turns.under_way.add(group)

    def recv(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Waits for the next group's step, round robin.

        Returns:
            What `step` returns; the first time after a reset, that group's reset.

        Raises:
            OutOfTurn if nothing was sent to it; Closed after `close`.
        """
        turns = self._turns
        if turns.coming in turns.back:
            return turns.take()
        if turns.coming not in turns.under_way and turns.due and not self._worlds.closed:
            lanes = self._lanes(turns.coming)
            raise OutOfTurn(f"lanes {lanes.start}..={lanes.stop - 1} wait for actions; send them first")
        result = self._result(self._worlds.recv(turns.coming))
        turns.under_way.discard(turns.coming)
        turns.mark_returned()
        return result

    def _wait(self) -> None:
        """Waits for all that is under way, and keeps it for `recv`."""
        for group in sorted(self._turns.under_way):
            # A copy: with `copy=False` the next call writes over it.
            self._turns.back[group] = copy.deepcopy(self._result(self._worlds.recv(group)))
            self._turns.under_way.discard(group)

    def _lanes(self, group: int) -> slice:
        return slice(group * self.batch_size, (group + 1) * self.batch_size)

    def _at_rest(self, batch: Batch, infos: dict[str, Any], group: int) -> Result:
        """A group as it is, without a step."""
        own = self._lanes(group)
        nothing = np.zeros(self.batch_size, np.bool_)
        group_infos = {**_columns.cut(infos, own), **self._env_ids(batch.lanes[own])}
        return batch.observations[own].copy(), np.zeros(self.batch_size), nothing, nothing.copy(), group_infos

    def _with_resets(self, result: Result, rest: Result, mask: np.ndarray) -> Result:
        """A group's step that was not fetched yet, with first observations where lanes were reset since."""
        observations, rewards, terminated, truncated, infos = result
        observations[mask] = rest[0][mask]
        return observations, np.where(mask, 0.0, rewards), terminated & ~mask, truncated & ~mask, _columns.replaced(infos, rest[4], mask)

    def _env_ids(self, lanes: np.ndarray) -> dict[str, np.ndarray]:
        return {"env_id": lanes, "_env_id": np.ones(len(lanes), np.bool_)} if self._groups > 1 else {}

    def _result(self, batch: Batch) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        count = len(batch.lanes)
        everywhere = np.ones(count, np.bool_)
        if self._infos.env_stats:
            self._infos.begin(batch.lanes[self._over[batch.lanes]])
        infos: dict[str, Any] = {}
        columns = self._infos.step(batch)
        for key, column in columns.items():
            _columns.put(infos, key, column, everywhere)
        if batch.episodes:
            self._end(infos, columns, batch)
        if not self._same_step:
            self._over[batch.lanes] = batch.terminated | batch.truncated
        infos.update(self._env_ids(batch.lanes))
        return batch.observations, batch.rewards.astype(np.float64), batch.terminated, batch.truncated, infos

    def _end(self, infos: dict[str, Any], columns: dict[str, Any], batch: Batch) -> None:
        """Adds what is known of the episodes that ended."""
        count, first = len(batch.lanes), int(batch.lanes[0])
        lasts = dict(zip(batch.final_lanes.tolist(), batch.final_observations, strict=True))
        for episode in batch.episodes:
            index = episode["lane"] - first
            ended = np.zeros(count, np.bool_)
            ended[index] = True
            ending = {"episode_summary": summary(episode)}
            if not self._same_step:
                _columns.add(infos, ending, index, count)
                continue
            final = {**row(columns, index), **ending}
            if "episode_seed" in final:
                final["episode_seed"] = np.uint64(episode["seed"])
            if "final_obs" not in infos:
                infos["final_obs"] = np.full(count, None, dtype=object)
                infos["_final_obs"] = np.zeros(count, np.bool_)
            infos["final_obs"][index], infos["_final_obs"][index] = lasts[index].copy(), True
            _columns.add(infos, {"final_info": final}, index, count)
            # The new episode's place and statistics; the cost stays that of the step just made.
            self._infos.begin(episode["lane"])
            for key, value in self._infos.now(episode["lane"]).items():
                _columns.add(infos, {key: value}, index, count)

    def render(self) -> tuple[np.ndarray, ...] | None:
        """Draws the present of every lane as `render_mode` says.

        Returns:
            For each lane uint8 [height, width, 3], of "depth_array" three equal channels (0 near to 255 far), so that Gymnasium's wrappers can
            show and film it; None, after a warning, without a render mode.
        """
        if self.render_mode is None:
            logger.warn("render() needs render_mode='rgb_array' or 'depth_array' when the environments are made; nothing is drawn")
            return None
        self._wait()
        kind, size = "rgb" if self.render_mode == "rgb_array" else "depth", frame_size(self._worlds, self._given)
        return tuple(coloured(self._worlds.render(lane, kind, size)) for lane in range(self.num_envs))

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """Asks each lane.

        Args:
            name: "render", "position" (int32 [2], map units), "episode_seed", "state_hash", "action_masks" (bool, one for each choice of the
                action space), or an attribute of this object.
            args: for an attribute that is called.
            kwargs: the same.

        Returns:
            An answer a lane.

        Raises:
            AttributeError for another name, and for what is of all lanes at once, such as "reset".
        """
        if name in _OF_ALL:
            raise AttributeError(f"'{name}' is of all lanes at once; call it on the batch")
        if name in _CALLS:
            self._wait()
        if name == "render":
            return self.render() or (None,) * self.num_envs
        if name == "position":
            return tuple(self._worlds.positions)
        if name == "episode_seed":
            return tuple(self._worlds.episode_seeds)
        if name == "state_hash":
            return tuple(self._worlds.state_hash(lane) for lane in range(self.num_envs))
        if name == "action_masks":
            return tuple(self._format.masks(self.action_masks))
        if len(self.tasks) > 1 and name in ("safety_budget", "scenario_name", "level"):
            value = getattr(self, name)
            return tuple(value.tolist() if name == "safety_budget" else (value[task] for task in self.lane_tasks))
        if name.startswith("_") or not hasattr(self, name):
            raise AttributeError(f"'{name}' is none of {', '.join(_CALLS)}, nor an attribute of the environment")
        value = getattr(self, name)
        return tuple(value(*args, **kwargs) if callable(value) else value for _ in range(self.num_envs))

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """Returns the attribute `name`, once a lane; as `call`."""
        return self.call(name)

    def set_attr(self, name: str, values: Any) -> None:
        """Sets an attribute, which all lanes share.

        Args:
            name: of the attribute.
            values: one value, or a list of one a lane, all equal.

        Raises:
            ValueError for values that differ, or of another number.
        """
        if isinstance(values, (list, tuple)):
            if len(values) != self.num_envs:
                raise ValueError(
                    "Values must be a list or tuple with length equal to the number of environments. "
                    f"Got `{len(values)}` values for {self.num_envs} environments."
                )
            if not all(value is values[0] or np.array_equal(value, values[0]) for value in values):
                raise ValueError(f"{name} is shared by all lanes; its values must be equal")
            values = values[0]
        setattr(self, name, values)

    def save(self) -> bytes:
        """Returns where every lane is, to come back to by `load`: bytes of this version. Raises OutOfTurn with `batch_size`."""
        if self._groups > 1:
            raise OutOfTurn("worlds in groups have no moment that all of them are at; make them without batch_size, or pickle them")
        return self._infos.save()

    def load(self, state: bytes) -> np.ndarray:
        """Comes back to a saved moment, by repeating the episodes.

        Args:
            state: what `save` gave, of worlds made alike.

        Returns:
            Observations of that moment.

        Raises:
            InvalidOption for bytes that are spoiled, or of other worlds; OutOfTurn with `batch_size`. Nothing has changed then.
        """
        if self._groups > 1:
            raise OutOfTurn("worlds in groups have no moment that all of them are at; make them without batch_size")
        batch = self._infos.load(state)
        self._over[:] = batch.terminated | batch.truncated
        self._turns.due = [0] if self._worlds.started else []
        return batch.observations

    def close_extras(self, **kwargs: Any) -> None:
        """Ends the threads and lets the worlds go; `close` calls it.

        Args:
            kwargs: ignored.
        """
        if hasattr(self, "_worlds"):
            self._worlds.close()
            self._turns = Turns(self._groups)

    def __getstate__(self) -> dict[str, Any]:
        self._wait()
        return {"arguments": self._arguments, "saved": self._infos.save(), "kept": copy.deepcopy(self._kept())}

    def __setstate__(self, state: dict[str, Any]) -> None:
        # Not by a subclass's constructor, which has other arguments.
        VectorEnv.__init__(self, **state["arguments"])
        self._infos.load(state["saved"])
        # A copy: arrays that came through shared memory, as Ray's do, cannot be written to.
        self.__dict__.update(copy.deepcopy(state["kept"]))
