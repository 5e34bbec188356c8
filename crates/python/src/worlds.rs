//! The class `Worlds`: a batch of worlds, raw, without Gymnasium.
//!
//! Long because Python sees one class, and `pymethods` of a class stand in one block.

use crate::actions::{read_actions, read_deltas};
use crate::arguments;
use crate::batch::{Arrays, Batch};
use crate::errors::{
    CLOSED, Fault, INVALID_ACTION, INVALID_OPTION, OUT_OF_TURN, RESET_NEEDED, WORLD_PANICKED, raise,
};
use crate::facts::{self, Facts, Task};
use crate::inner::Inner;
use crate::pool::{Pool, array};
use crate::resets::{self, Seeds};
use hasard_envs::{Autoreset, Env, EnvError, EnvId, FinalObservations, LaneState, VecOptions};
use hasard_play::ViewKind;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex};

/// A batch that has been stepped.
enum CameBack {
    /// In its own memory.
    Own(hasard_envs::Batch),
    /// In the caller's: this is the rest, which the bound arrays do not hold.
    Bound(hasard_envs::Batch),
}

/// Worlds(env_id, num_envs, *, num_threads=None, groups=None, autoreset_mode="SameStep",
/// final_observations="every", statistics=False, **arguments)
///
/// A batch of worlds, raw: categorical actions in, arrays out. `hasard_rs.VectorEnv` is Gymnasium's
/// view of one.
///
/// Every call lets the interpreter go while the worlds work. Two threads that use one object take
/// turns.
///
/// Args:
///     env_id: with or without `hasard/`; several, joined by commas, are taken by the lanes in
///         turn, with the buttons, cost terms and statistics of all.
///     num_envs: lanes, 1 to 65536.
///     num_threads: worker threads beside the caller's; None: one for every four lanes, as far as
///         there are processors. No result depends on it.
///     groups: of lanes that `send` and `recv` step on their own, 1 (None) to num_envs.
///     autoreset_mode: "SameStep" (None means it), "NextStep" or "Disabled", or Gymnasium's enum.
///     final_observations: whose last observation a batch holds under "SameStep": "every"
///         episode's, or only those "truncated".
///     statistics: whether batches hold the statistics of every step.
///     arguments: rules, hard_constraint, full_actions, frame_skip, resolution, observation,
///         layout, frame_stack, max_episode_steps, events, seed, safety_budget, maps, iwad,
///         published_depth, published_colours, as in `help(hasard_rs.Env)`.
///
/// Raises:
///     UnknownEnvironment, InvalidOption, InvalidMap, or TypeError for a name that is no argument:
///         before any thread starts.
///
/// Every method raises Closed after `close`, OutOfTurn in a process forked from the one that made
/// threads, and WorldPanicked for a fault of this package, after which the worlds are closed.
#[pyclass(frozen, module = "hasard_rs._core")]
pub struct Worlds {
    pub(crate) facts: Facts,
    inner: Mutex<Option<Inner>>,
    /// Process that the worker threads run in, if there are any.
    process: Option<u32>,
    pub(crate) pool: Arc<Pool>,
    /// Batches to be used again, without their observations.
    spare: Mutex<Vec<hasard_envs::Batch>>,
    /// Of each slot, the caller's arrays that it writes to.
    pub(crate) arrays: Mutex<Vec<Arrays>>,
}

impl Worlds {
    /// Works with the worlds while other Python threads run.
    pub(crate) fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Inner) -> Result<T, Fault> + Send,
    ) -> PyResult<T> {
        if let Some(process) = self.process.filter(|process| *process != std::process::id()) {
            let why = format!("made in process {process}; make worlds after forking, or use spawn");
            return Err(OUT_OF_TURN.error(py, why));
        }
        let result = py.detach(|| {
            let mut guard = self.inner.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            let Some(inner) = guard.as_mut() else { return Err(Fault::Closed) };
            let result = catch_unwind(AssertUnwindSafe(|| work(inner))).unwrap_or_else(|_| {
                Err(EnvError::Panicked { message: "outside of a step".to_string() }.into())
            });
            if matches!(result, Err(Fault::Env(EnvError::Panicked { .. }))) {
                *guard = None;
            }
            result
        });
        result.map_err(|fault| match fault {
            Fault::Env(error @ EnvError::Panicked { .. }) => WORLD_PANICKED.error(py, error.to_string()),
            // The caller has a single world and has never heard of lanes.
            Fault::Env(error @ EnvError::Action { .. }) if self.facts.lanes == 1 => {
                INVALID_ACTION.error(py, error.to_string().replacen(" of lane 0", "", 1))
            }
            Fault::Env(error) => raise(py, &error),
            Fault::Closed => CLOSED.error(py, "these worlds are closed; make new ones"),
            Fault::NotReset => RESET_NEEDED.error(py, "call reset before the first step"),
            Fault::FirstReset => RESET_NEEDED.error(py, "the first reset must be of all lanes; call reset without a mask"),
            Fault::Resting(_) if self.facts.lanes == 1 => {
                RESET_NEEDED.error(py, "the episode is over; call reset before the next step")
            }
            Fault::Resting(lanes) => {
                let why = format!("the episodes of lanes {lanes:?} are over; reset them first, by reset_mask or mask");
                RESET_NEEDED.error(py, why)
            }
        })
    }

    /// A batch of so many lanes, whose observations go into a buffer of the pool.
    fn scratch(&self, inner: &mut Inner, lanes: usize) -> hasard_envs::Batch {
        let mut spare = self.spare.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        let found = spare.iter().position(|batch| batch.lanes() == lanes);
        let mut batch =
            found.map_or_else(|| inner.worlds().batch_of(lanes), |index| spare.swap_remove(index));
        if found.is_some() {
            let length = lanes * self.facts.shape.iter().product::<usize>();
            batch.observations = self.pool.take(length).into();
        }
        batch
    }

    /// Shows a batch that has come back, and keeps its small buffers.
    fn show(
        &self,
        py: Python<'_>,
        mut batch: hasard_envs::Batch,
        lanes: Vec<i32>,
    ) -> PyResult<Batch> {
        let shown =
            Batch::new(py, &mut batch, lanes, self.facts.shape, &self.pool, Arrays::default())?;
        let mut spare = self.spare.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if spare.len() < 4 {
            spare.push(batch);
        }
        Ok(shown)
    }

    /// Works with a batch of all lanes, in bound memory if there is any, and shows it.
    fn whole(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Inner, &mut hasard_envs::Batch) -> Result<(), Fault> + Send,
    ) -> PyResult<Batch> {
        let slot = self.facts.groups;
        let came_back = self.with(py, |inner| {
            let bound = inner.bound.get_mut(slot).and_then(Option::take);
            let external = bound.is_some();
            let mut batch = bound.unwrap_or_else(|| self.scratch(inner, self.facts.lanes));
            let result = work(inner, &mut batch);
            if !external {
                return result.map(|()| CameBack::Own(batch));
            }
            let rest = self.keep(inner, slot, batch);
            result.map(|()| CameBack::Bound(rest))
        })?;
        self.show_slot(py, slot, came_back)
    }

    /// Shows what a slot's step brought.
    fn show_slot(&self, py: Python<'_>, slot: usize, came_back: CameBack) -> PyResult<Batch> {
        let lanes = self.facts.lanes_of(slot).map(|lane| lane as i32).collect();
        match came_back {
            CameBack::Own(batch) => self.show(py, batch, lanes),
            CameBack::Bound(mut rest) => {
                let arrays = self.arrays.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
                    [slot]
                    .clone_ref(py);
                Batch::new(py, &mut rest, lanes, self.facts.shape, &self.pool, arrays)
            }
        }
    }

    /// Puts a batch of bound memory back and copies the rest, which the bound arrays do not hold.
    fn keep(
        &self,
        inner: &mut Inner,
        slot: usize,
        mut batch: hasard_envs::Batch,
    ) -> hasard_envs::Batch {
        let rest = hasard_envs::Batch {
            statistics: batch.statistics.clone(),
            positions: batch.positions.clone(),
            cost_terms: batch.cost_terms.clone(),
            final_lanes: std::mem::take(&mut batch.final_lanes),
            final_observations: std::mem::take(&mut batch.final_observations),
            episodes: std::mem::take(&mut batch.episodes),
            ..hasard_envs::Batch::default()
        };
        inner.bound[slot] = Some(batch);
        rest
    }

    /// Whether lanes may be stepped.
    fn ready(&self, inner: &mut Inner, lanes: impl Iterator<Item = usize>) -> Result<(), Fault> {
        if !inner.started {
            return Err(Fault::NotReset);
        }
        if self.facts.autoreset == Autoreset::Disabled {
            let resting = inner.worlds().resting();
            let lanes: Vec<usize> =
                lanes.filter(|&lane| resting.get(lane).copied().unwrap_or(false)).collect();
            if !lanes.is_empty() {
                return Err(Fault::Resting(lanes));
            }
        }
        Ok(())
    }

    fn check_group(&self, py: Python<'_>, group: usize) -> PyResult<()> {
        if group < self.facts.groups {
            return Ok(());
        }
        Err(INVALID_OPTION.error(
            py,
            format!("group cannot be {group}; it must be less than {}", self.facts.groups),
        ))
    }

    fn check_lane(&self, lane: usize) -> PyResult<()> {
        if lane < self.facts.lanes {
            return Ok(());
        }
        Err(PyIndexError::new_err(format!("lane {lane} is not one of {} lanes", self.facts.lanes)))
    }

    /// Sub-actions of some lanes.
    fn read(
        &self,
        actions: &Bound<'_, PyAny>,
        deltas: Option<&Bound<'_, PyAny>>,
        count: usize,
        lane: impl Fn(usize) -> usize,
    ) -> PyResult<(Vec<u8>, Vec<f32>)> {
        let space = &self.facts.space;
        let mut categorical = vec![0; count * space.groups.len()];
        let mut continuous = vec![0.0; count * space.deltas.len()];
        let named = |row| (self.facts.lanes > 1).then(|| lane(row));
        read_actions(actions, space, count, named, &mut categorical)?;
        read_deltas(deltas, space, count, &mut continuous)?;
        Ok((categorical, continuous))
    }
}

#[pymethods]
impl Worlds {
    #[new]
    #[pyo3(signature = (env_id, num_envs, *, num_threads=None, groups=None, autoreset_mode=None, final_observations="every", statistics=false, **arguments))]
    #[allow(clippy::too_many_arguments, reason = "Python's keyword arguments")]
    fn new(
        py: Python<'_>,
        env_id: &str,
        num_envs: &Bound<'_, PyAny>,
        num_threads: Option<&Bound<'_, PyAny>>,
        groups: Option<&Bound<'_, PyAny>>,
        autoreset_mode: Option<&Bound<'_, PyAny>>,
        final_observations: &str,
        statistics: bool,
        arguments: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Worlds> {
        let ids = env_id
            .split(',')
            .map(|id| crate::registry::environment(id.trim()))
            .collect::<Result<Vec<EnvId>, EnvError>>()
            .map_err(|error| raise(py, &error))?;
        let given = arguments::read(py, arguments)?;
        let num_envs = arguments::number("num_envs", num_envs, 1, 65_536)? as usize;
        if num_envs < ids.len() {
            let why = format!(
                "num_envs cannot be {num_envs}; {} tasks need a lane each at least",
                ids.len()
            );
            return Err(INVALID_OPTION.error(py, why));
        }
        let num_threads = num_threads
            .map(|given| arguments::number("num_threads", given, 0, 1024))
            .transpose()?;
        let groups = groups
            .map_or(Ok(1), |given| arguments::number("groups", given, 1, num_envs as u64))?
            as usize;
        let autoreset = autoreset_mode.map_or(Ok(Autoreset::SameStep), arguments::autoreset)?;
        let final_observations = match final_observations {
            "every" => FinalObservations::Every,
            "truncated" => FinalObservations::Truncated,
            other => {
                let why = format!(
                    "final_observations cannot be {other:?}; it must be truncated or every"
                );
                return Err(INVALID_OPTION.error(py, why));
            }
        };
        let spare_cpus = std::thread::available_parallelism().map_or(0, |cpus| cpus.get() - 1);
        let threads =
            num_threads.map_or_else(|| spare_cpus.min(num_envs / 4), |threads| threads as usize);
        let options = VecOptions {
            lanes: num_envs,
            threads,
            groups,
            autoreset,
            final_observations,
            statistics,
            ..VecOptions::default()
        };
        let made = py.detach(|| Inner::new(&ids, &given.options, options));
        let mut inner = made.map_err(|error| raise(py, &error))?;
        let (rules, hard) = (given.options.rules, given.options.hard);
        let worlds = inner.worlds();
        let masks: Vec<Vec<bool>> = worlds.tasks().into_iter().map(|task| task.mask).collect();
        let choices = worlds.action_space().sizes().iter().sum();
        // Lanes take the tasks in turn: the first lanes have one of each.
        let tasks = ids.iter().enumerate().map(|(index, &id)| {
            let (episode_steps, extent) =
                inner.look(index, |env: &mut Env| (env.episode_steps(), env.extent()));
            let mask = masks.get(index).cloned().unwrap_or_else(|| vec![true; choices]);
            let safety_budget =
                given.safety_budget.unwrap_or_else(|| id.safety_budget(rules, hard));
            Task { id, safety_budget, episode_steps, extent, mask }
        });
        let tasks: Vec<Task> = tasks.collect();
        let worlds = inner.worlds();
        let facts = Facts {
            tasks,
            lanes: num_envs,
            groups,
            autoreset,
            space: worlds.action_space().clone(),
            shape: worlds.observation_shape(),
            terms: worlds.cost_terms(),
            statistics: worlds.statistics().to_vec(),
            seed: given.seed,
            kind: facts::kind(&ids, &given.options, autoreset),
        };
        Ok(Worlds {
            facts,
            inner: Mutex::new(Some(inner)),
            process: (threads > 0).then(std::process::id),
            pool: Arc::default(),
            spare: Mutex::default(),
            arrays: Mutex::default(),
        })
    }

    /// reset(seeds=None, mask=None) -> Batch
    ///
    /// Starts the next episode of every lane, or of those that are chosen.
    ///
    /// Args:
    ///     seeds: None goes on with the lanes' streams of seeds; an int s starts the stream of lane
    ///         i anew from s + i; a sequence has one entry a lane (None goes on). Not negative;
    ///         taken modulo 2^64.
    ///     mask: bool [num_envs], the lanes to reset; the others stay as they are. None: all.
    ///
    /// Returns:
    ///     A Batch of all lanes, with rewards and costs 0.
    ///
    /// Raises:
    ///     TypeError or ValueError for seeds or a mask of the wrong kind; ResetNeeded if the first
    ///         reset is of some lanes only.
    #[pyo3(signature = (seeds=None, mask=None))]
    fn reset(
        &self,
        py: Python<'_>,
        seeds: Option<&Bound<'_, PyAny>>,
        mask: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Batch> {
        let seeds = Seeds::read(seeds, self.facts.lanes)?;
        let mask = mask.map(|mask| resets::mask(mask, self.facts.lanes)).transpose()?;
        let fresh = match self.facts.seed {
            Some(seed) => seed,
            None => py
                .import("os")?
                .call_method1("urandom", (8,))?
                .extract::<[u8; 8]>()
                .map(u64::from_le_bytes)?,
        };
        self.whole(py, |inner, batch| {
            // The first episodes follow from a seed in any case.
            let seeds = if inner.started { seeds } else { seeds.or(fresh) };
            if !inner.started && mask.as_ref().is_some_and(|mask| mask.contains(&false)) {
                return Err(Fault::FirstReset);
            }
            let how = resets::restarts(&seeds, mask.as_deref(), self.facts.lanes);
            inner.worlds().restart(&how, batch)?;
            inner.started = true;
            Ok(())
        })
    }

    /// step(actions, deltas=None, *, lanes=None) -> Batch
    ///
    /// Steps every lane, or chosen ones.
    ///
    /// Args:
    ///     actions: integers [m, len(nvec)], a choice for each categorical part; any integer dtype
    ///         and strides, lists too.
    ///     deltas: numbers [m, 2] in [-1, 1], where num_deltas is not 0; None: 0 each.
    ///     lanes: the m lanes to step, each once; None: all of them, in order.
    ///
    /// Returns:
    ///     A Batch of m rows, in the order of lanes.
    ///
    /// Raises:
    ///     InvalidAction, which names lane, part, value and range; TypeError or ValueError for the
    ///         wrong dtype or shape; InvalidOption for a lane that is none, or named twice;
    ///         ResetNeeded before the first reset, or where an episode is over under "Disabled";
    ///         OutOfTurn with a batch under way. Nothing has moved then.
    #[pyo3(signature = (actions, deltas=None, *, lanes=None))]
    fn step(
        &self,
        py: Python<'_>,
        actions: &Bound<'_, PyAny>,
        deltas: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = arguments::lanes)] lanes: Option<Vec<usize>>,
    ) -> PyResult<Batch> {
        let count = lanes.as_ref().map_or(self.facts.lanes, Vec::len);
        let lane = |row: usize| lanes.as_ref().map_or(row, |lanes| lanes[row]);
        let (actions, deltas) = self.read(actions, deltas, count, lane)?;
        let Some(lanes) = lanes else {
            return self.whole(py, |inner, batch| {
                self.ready(inner, 0..count)?;
                (batch.actions, batch.deltas) = (actions, deltas);
                Ok(inner.worlds().step(batch)?)
            });
        };
        let batch = self.with(py, |inner| {
            self.ready(inner, lanes.iter().copied())?;
            let mut batch = self.scratch(inner, count);
            (batch.actions, batch.deltas) = (actions, deltas);
            inner.worlds().step_lanes(&lanes, &mut batch)?;
            Ok(batch)
        })?;
        self.show(py, batch, lanes.into_iter().map(|lane| lane as i32).collect())
    }

    /// send(actions, deltas=None, *, group=0)
    ///
    /// Hands a group's actions over and comes back at once; the worlds step meanwhile.
    ///
    /// Args:
    ///     actions: integers [num_envs / groups, len(nvec)], as for `step`; the array may be used
    ///         again at once.
    ///     deltas: numbers [num_envs / groups, 2], as for `step`.
    ///     group: 0 to groups - 1.
    ///
    /// Raises:
    ///     What `step` raises; OutOfTurn if the group's last batch was not fetched by `recv`;
    ///         InvalidOption for a group that is none.
    #[pyo3(signature = (actions, deltas=None, *, group=0))]
    fn send(
        &self,
        py: Python<'_>,
        actions: &Bound<'_, PyAny>,
        deltas: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = arguments::group)] group: usize,
    ) -> PyResult<()> {
        self.check_group(py, group)?;
        let lanes = self.facts.lanes_of(group);
        let (actions, deltas) = self.read(actions, deltas, lanes.len(), |row| lanes.start + row)?;
        self.with(py, |inner| {
            self.ready(inner, lanes.clone())?;
            let bound = inner.bound.get_mut(group).and_then(Option::take);
            let external = bound.is_some();
            let mut batch = bound.unwrap_or_else(|| self.scratch(inner, lanes.len()));
            (batch.actions, batch.deltas) = (actions, deltas);
            inner.worlds().send(group, batch).map_err(|error| {
                let kept = inner.worlds().reclaim(group);
                if external {
                    inner.bound[group] = kept;
                }
                Fault::Env(error)
            })
        })
    }

    /// recv(group=0) -> Batch
    ///
    /// Waits until a group's lanes have been stepped.
    ///
    /// Args:
    ///     group: 0 to groups - 1.
    ///
    /// Returns:
    ///     A Batch of the group's lanes.
    ///
    /// Raises:
    ///     OutOfTurn if nothing was sent; InvalidOption for a group that is none.
    #[pyo3(signature = (group=0))]
    fn recv(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::group)] group: usize,
    ) -> PyResult<Batch> {
        self.check_group(py, group)?;
        let came_back = self.with(py, |inner| {
            let batch = inner.worlds().recv(group)?;
            Ok(if inner.bound.is_empty() {
                CameBack::Own(batch)
            } else {
                CameBack::Bound(self.keep(inner, group, batch))
            })
        })?;
        self.show_slot(py, group, came_back)
    }

    /// bind(*, observations, rewards, costs, terminated, truncated, cost_terms=None)
    ///
    /// From now on results are written into arrays of the caller's, in place, and batches show
    /// those. All are C-contiguous and writable. They are kept alive; what Python reads while a
    /// batch is under way is undefined.
    ///
    /// Args:
    ///     observations: uint8 [num_envs, *observation_shape].
    ///     rewards: float32 [num_envs].
    ///     costs: float32 [num_envs].
    ///     terminated: bool [num_envs].
    ///     truncated: bool [num_envs].
    ///     cost_terms: float32 [num_envs, k], or None.
    ///
    /// Raises:
    ///     BufferError, which names the dtype and shape wanted and given; OutOfTurn with a batch
    ///         under way.
    #[pyo3(signature = (*, observations, rewards, costs, terminated, truncated, cost_terms=None))]
    #[allow(clippy::too_many_arguments, reason = "Python's keyword arguments")]
    fn bind(
        &self,
        py: Python<'_>,
        observations: &Bound<'_, PyAny>,
        rewards: &Bound<'_, PyAny>,
        costs: &Bound<'_, PyAny>,
        terminated: &Bound<'_, PyAny>,
        truncated: &Bound<'_, PyAny>,
        cost_terms: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let given =
            crate::bind::Given { observations, rewards, costs, terminated, truncated, cost_terms };
        let (memories, arrays) = crate::bind::cut(&self.facts, &given)?;
        drop(self.with(py, |inner| crate::bind::attach(&self.facts, inner, memories))?);
        let mut bound = self.arrays.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        let replaced = std::mem::replace(&mut *bound, arrays);
        drop(bound);
        drop(replaced);
        Ok(())
    }

    /// unbind()
    ///
    /// Results are given in fresh arrays again, and the bound ones are let go. Raises OutOfTurn
    /// with a batch under way.
    fn unbind(&self, py: Python<'_>) -> PyResult<()> {
        let let_go = self.with(py, |inner| {
            crate::bind::idle(inner)?;
            Ok(std::mem::take(&mut inner.bound))
        })?;
        drop(let_go);
        let arrays = std::mem::take(
            &mut *self.arrays.lock().unwrap_or_else(|poisoned| poisoned.into_inner()),
        );
        drop(arrays);
        Ok(())
    }

    /// save() -> bytes
    ///
    /// Where every lane is: its stream of seeds, its episode's seed and the actions so far.
    ///
    /// Returns:
    ///     Bytes for `load`, of this version of the package and worlds made alike.
    ///
    /// Raises:
    ///     OutOfTurn with a batch under way.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let (lanes, started) = self.with(py, |inner| Ok((inner.save()?, inner.started)))?;
        let mut bytes = facts::pack(&self.facts.kind, &lanes);
        bytes.push(u8::from(started));
        Ok(PyBytes::new(py, &bytes))
    }

    /// load(bytes) -> Batch
    ///
    /// Brings every lane to where it was saved, by repeating its episode.
    ///
    /// Args:
    ///     bytes: what `save` gave, of worlds made alike.
    ///
    /// Returns:
    ///     A Batch that shows the saved moment.
    ///
    /// Raises:
    ///     InvalidOption for bytes that are spoiled, or of other worlds; nothing has changed then.
    fn load(&self, py: Python<'_>, bytes: &[u8]) -> PyResult<Batch> {
        let refused = |why: String| INVALID_OPTION.error(py, why);
        let (started, packed) = bytes
            .split_last()
            .ok_or_else(|| refused("these bytes are no saved worlds".to_string()))?;
        let lanes = facts::unpack(&self.facts.kind, packed).map_err(refused)?;
        let states = LaneState::from_bytes(lanes).map_err(|error| raise(py, &error))?;
        let started = *started != 0;
        self.whole(py, |inner, batch| {
            inner.worlds().restore(states, batch)?;
            inner.started = started;
            Ok(())
        })
    }

    /// render(lane=0, kind="rgb", resolution=(160, 120)) -> ndarray
    ///
    /// Draws the present of a lane, which goes on unchanged.
    ///
    /// Args:
    ///     lane: 0 to num_envs - 1.
    ///     kind: "rgb", "segmented", "automap", "depth" (0 near to 255 far, 7.3 map units a level),
    ///         "labels" or "grey".
    ///     resolution: "WxH" or (width, height), 64x48 to 1920x1080.
    ///
    /// Returns:
    ///     uint8 [height, width, 3] for rgb, segmented and automap, uint8 [height, width] for
    ///     depth, labels and grey.
    ///
    /// Raises:
    ///     InvalidOption for another kind or size, IndexError for a lane that is none, OutOfTurn
    ///         with a batch under way.
    #[pyo3(signature = (lane=0, kind="rgb", resolution=None))]
    fn render<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::lane)] lane: usize,
        kind: &str,
        resolution: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.check_lane(lane)?;
        let view = match kind {
            "rgb" => ViewKind::Colour,
            "depth" => ViewKind::Depth,
            "segmented" => ViewKind::Segmented,
            "labels" => ViewKind::Labels,
            "grey" => ViewKind::Grey,
            "automap" => ViewKind::Automap,
            _ => {
                let why = format!(
                    "kind cannot be {kind:?}; it must be rgb, depth, segmented, labels, grey or automap"
                );
                return Err(INVALID_OPTION.error(py, why));
            }
        };
        let size = resolution.map_or(Ok(hasard_envs::FrameSize::CLASSIC), |given| {
            arguments::size("resolution", given)
        })?;
        let (width, height, channels, bytes) = self.with(py, |inner| {
            crate::bind::idle(inner)?;
            Ok(inner.draw(lane, view, size)?)
        })?;
        if channels == 1 {
            array(py, bytes, &[height, width])
        } else {
            array(py, bytes, &[height, width, channels])
        }
    }

    /// state_hash(lane=0) -> int
    ///
    /// Returns a fingerprint (64 bits) of everything that the future of `lane` depends on, the same
    /// on every platform. Raises IndexError for a lane that is none, OutOfTurn with a batch under
    /// way.
    #[pyo3(signature = (lane=0))]
    fn state_hash(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::lane)] lane: usize,
    ) -> PyResult<u64> {
        self.check_lane(lane)?;
        self.with(py, |inner| {
            crate::bind::idle(inner)?;
            Ok(inner.look(lane, |env| env.state_hash()))
        })
    }

    /// stats(lane=0) -> list[tuple[str, float]]
    ///
    /// Returns the statistics of the episode of `lane` so far, by name. Raises IndexError for a
    /// lane that is none.
    #[pyo3(signature = (lane=0))]
    fn stats(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::lane)] lane: usize,
    ) -> PyResult<Vec<(&'static str, f64)>> {
        self.check_lane(lane)?;
        let own = self.with(py, |inner| Ok(inner.look(lane, |env| env.stats())))?;
        let of = |name: &'static str| {
            (name, own.iter().find(|(known, _)| *known == name).map_or(0.0, |(_, value)| *value))
        };
        Ok(self.facts.statistics.iter().map(|name| of(name)).collect())
    }

    /// Where each lane's player stands, in map units: int32 [num_envs, 2].
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let lanes = self.facts.lanes;
        let places = self.with(py, |inner| {
            Ok((0..lanes)
                .flat_map(|lane| inner.look(lane, |env| env.position()))
                .collect::<Vec<i32>>())
        })?;
        array(py, places, &[lanes, 2])
    }

    /// Seed of each lane's running episode: uint64 [num_envs].
    #[getter]
    fn episode_seeds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let lanes = self.facts.lanes;
        let seeds = self.with(py, |inner| {
            Ok((0..lanes).map(|lane| inner.look(lane, |env| env.seed())).collect::<Vec<u64>>())
        })?;
        array(py, seeds, &[lanes])
    }

    /// Whether episodes have begun: by a reset, or by a load of a moment after one.
    #[getter]
    fn started(&self, py: Python<'_>) -> PyResult<bool> {
        self.with(py, |inner| Ok(inner.started))
    }

    /// Which lanes' episodes are over without the next one having begun: bool [num_envs].
    #[getter]
    fn resting<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let resting = self.with(py, |inner| Ok(inner.worlds().resting().to_vec()))?;
        array(py, resting, &[self.facts.lanes])
    }

    /// close()
    ///
    /// Ends the threads and lets the memory go; closing twice is fine.
    fn close(&self, py: Python<'_>) {
        let forked = self.process.is_some_and(|process| process != std::process::id());
        if forked {
            return;
        }
        let inner =
            py.detach(|| self.inner.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take());
        py.detach(|| drop(inner));
        self.arrays.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).clear();
    }

    fn __enter__(this: Py<Worlds>) -> Py<Worlds> {
        this
    }

    #[pyo3(signature = (*_exception))]
    fn __exit__(&self, py: Python<'_>, _exception: &Bound<'_, PyTuple>) {
        self.close(py);
    }

    /// Whether the worlds are closed.
    #[getter]
    fn closed(&self, py: Python<'_>) -> bool {
        py.detach(|| self.inner.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).is_none())
    }

    /// The environment's id, without `hasard/`; several are joined by commas.
    #[getter]
    fn env_id(&self) -> String {
        let ids: Vec<String> = self.facts.tasks.iter().map(|task| task.id.to_string()).collect();
        ids.join(",")
    }

    /// Which of the tasks, by the place of its id, each lane has: int32 [num_envs].
    #[getter]
    fn lane_tasks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let lanes = self.facts.lanes;
        let tasks: Vec<i32> = (0..lanes).map(|lane| self.facts.task_of(lane) as i32).collect();
        array(py, tasks, &[lanes])
    }

    /// Whether each choice of each sub-action does something in a lane's task, one sub-action after
    /// the other: bool [num_envs, sum(nvec)].
    #[getter]
    fn action_masks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let lanes = self.facts.lanes;
        let mask = |lane| &self.facts.tasks[self.facts.task_of(lane)].mask;
        let masks: Vec<bool> = (0..lanes).flat_map(mask).copied().collect();
        let choices = masks.len() / lanes;
        array(py, masks, &[lanes, choices])
    }

    /// Number of lanes.
    #[getter]
    fn num_envs(&self) -> usize {
        self.facts.lanes
    }

    /// Number of groups.
    #[getter]
    fn groups(&self) -> usize {
        self.facts.groups
    }

    /// Number of choices of each categorical sub-action.
    #[getter]
    fn nvec<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.facts.space.sizes())
    }

    /// Number of continuous sub-actions.
    #[getter]
    fn num_deltas(&self) -> usize {
        self.facts.space.deltas.len()
    }

    /// Shape of one observation.
    #[getter]
    fn observation_shape(&self) -> (usize, usize, usize) {
        self.facts.shape.into()
    }

    /// Name of each cost term, and whether it is part of the cost.
    #[getter]
    fn cost_terms<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.facts.terms.iter().map(|term| (term.name, term.counted)))
    }

    /// Names of the statistics.
    #[getter]
    fn statistics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.facts.statistics)
    }

    /// Cost that an episode may have, of each task.
    #[getter]
    fn safety_budgets<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.facts.tasks.iter().map(|task| task.safety_budget))
    }

    /// Cost that an episode may have, of the first task.
    #[getter]
    fn safety_budget(&self) -> f64 {
        self.facts.tasks[0].safety_budget
    }

    /// Steps of an episode that only time ends, of the task with the longest.
    #[getter]
    fn episode_steps(&self) -> u32 {
        self.facts.tasks.iter().map(|task| task.episode_steps).max().unwrap_or_default()
    }

    /// The map's extent: x from, y from, x to, y to, in map units; None where the tasks have maps
    /// of their own.
    #[getter]
    fn extent(&self) -> Option<(i32, i32, i32, i32)> {
        let [task] = &self.facts.tasks[..] else { return None };
        Some(task.extent.into())
    }

    fn __repr__(&self) -> String {
        format!("<Worlds {} x {}>", self.env_id(), self.facts.lanes)
    }
}
