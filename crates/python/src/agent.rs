//! A trained agent for Python: arrays in, arrays out, and what it carries from step to step in the
//! caller's hands.

use crate::arguments::choice;
use crate::errors::{INVALID_OPTION, raise};
use crate::pool::array;
use crate::registry::environment;
use hasard_envs::{Env, EnvId, EnvOptions, RuleSet};
use hasard_learn::error::LearnError;
use hasard_learn::networks::distribution::ActionShape;
use hasard_learn::runs::agent::{TrainedPolicy, run_config};
use hasard_learn::runs::checkpoint::{Loaded, Store};
use hasard_learn::runs::evaluate::{Agent as Trained, Choice, Memory, Which};
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard};

/// What an agent carries from step to step. It is handed on, never changed.
#[pyclass(frozen, module = "hasard_rs._core")]
pub struct AgentState {
    memory: Memory,
}

#[pymethods]
impl AgentState {
    /// Number of lanes.
    fn __len__(&self) -> usize {
        self.memory.episodes.len()
    }

    /// of_bytes(data) -> AgentState
    ///
    /// Returns the state that pickle wrote as `data`. Raises ValueError for other bytes.
    #[staticmethod]
    fn of_bytes(data: &[u8]) -> PyResult<AgentState> {
        let memory = Memory::of_bytes(data);
        let memory = memory.ok_or_else(|| PyValueError::new_err("data is no agent's state"))?;
        Ok(AgentState { memory })
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let read = py.get_type::<AgentState>().getattr("of_bytes")?;
        Ok((read, (PyBytes::new(py, &self.memory.bytes()),)))
    }
}

/// TrainedAgent(run, *, best=False, greedy=False)
///
/// The agent of a run directory, an agent's file or the zoo, raw; `hasard_rs.Agent` is what to use.
///
/// Args:
///     run: the directory, the file, or "zoo:NAME".
///     best: the best checkpoint within budget instead of the newest.
///     greedy: the likeliest actions instead of drawn ones.
///
/// Raises:
///     InvalidOption where there is no run, no checkpoint or a spoiled one.
#[pyclass(frozen, module = "hasard_rs._core")]
pub struct TrainedAgent {
    agent: Mutex<Trained>,
    policy: Mutex<TrainedPolicy>,
    choice: Choice,
    options: EnvOptions,
    config: String,
    env_id: String,
    observation: [usize; 3],
    sizes: Vec<usize>,
    deltas: usize,
}

impl TrainedAgent {
    /// The bytes of observations, one a lane.
    fn pixels(&self, observations: &Bound<'_, PyArrayDyn<u8>>, lanes: usize) -> PyResult<Vec<u8>> {
        let [height, width, channels] = self.observation;
        if observations.shape() != [lanes, height, width, channels] {
            let (wanted, given) = ([lanes, height, width, channels], observations.shape());
            return Err(PyValueError::new_err(format!(
                "observations must have shape {wanted:?}, got {given:?}"
            )));
        }
        let readable = observations
            .try_readonly()
            .map_err(|error| PyTypeError::new_err(format!("observations: {error}")))?;
        Ok(readable.as_array().iter().copied().collect())
    }

    /// Another environment, other rules or both, as the agent sees them and with its own buttons.
    fn elsewhere(
        &self,
        py: Python<'_>,
        env_id: Option<&str>,
        rules: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<(Option<EnvId>, EnvOptions)> {
        let own = &self.options;
        let id = environment(env_id.unwrap_or(&self.env_id)).map_err(|error| raise(py, &error))?;
        let rules = match rules {
            Some(given) => {
                choice("rules", given, &RuleSet::ALL.map(|rules| (rules.name(), rules)))?
            }
            None => own.rules,
        };
        let scenario = env_id.map_or(own.scenario, |_| Some(id.scenario));
        let task = EnvOptions { scenario, rules, ..own.clone() };
        let trained_in = environment(&self.env_id).map_err(|error| raise(py, &error))?;
        let options = hasard_cli::in_task(own, trained_in, id, &task)
            .map_err(|why| INVALID_OPTION.error(py, why))?;
        Ok((Some(id), options))
    }

    fn agent(&self) -> MutexGuard<'_, Trained> {
        self.agent.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

/// checkpoint_of(run, best) -> str or None
///
/// Returns the folder of the checkpoint that an agent of this `run` acts by: with `best` the
/// selected one, else, and where none was ever judged, the newest whole one. Raises InvalidOption
/// where the selected one is spoiled.
#[pyfunction]
pub fn checkpoint_of(py: Python<'_>, run: PathBuf, best: bool) -> PyResult<Option<PathBuf>> {
    let store = Store::new(&run, 1);
    if best {
        let spoiled = |error: LearnError| INVALID_OPTION.error(py, error.to_string());
        if let Some((selected, _)) = store.read_selected().map_err(spoiled)? {
            return Ok(Some(selected));
        }
    }
    Ok(store.all().into_iter().find(|path| Loaded::read(path).is_ok()))
}

#[pymethods]
impl TrainedAgent {
    /// Loads the agent of a run directory: its newest checkpoint, or the best within budget;
    /// drawing its actions, or greedy.
    #[new]
    #[pyo3(signature = (run, *, best=false, greedy=false))]
    fn new(py: Python<'_>, run: PathBuf, best: bool, greedy: bool) -> PyResult<TrainedAgent> {
        let mut warnings: Vec<String> = Vec::new();
        let made = py.detach(|| {
            let run = hasard_cli::agent_place(&run)?;
            let (env_id, options) = hasard_cli::environment_of_run(&run)?;
            let env = Env::new(&env_id, &options).map_err(|error| error.to_string())?;
            let (space, observation) = (env.action_space(), env.observation_shape());
            let (sizes, deltas) = (space.sizes(), space.deltas.len());
            let action = ActionShape { sizes: sizes.clone(), deltas };
            let which = if best { Which::Selected } else { Which::Latest };
            let choice = if greedy { Choice::Greedy } else { Choice::Sampled };
            let policy = TrainedPolicy::load(&run, which, observation, action, &mut |text| {
                warnings.push(text)
            })
            .map_err(|error| error.to_string())?;
            // The policy's own settings say where it acts, not where it was trained.
            let config = run_config(&run).map_err(|error| error.to_string())?;
            let config = serde_json::to_string(&config).map_err(|error| error.to_string())?;
            let (agent, policy) = (Mutex::new(policy.agent(choice, 1)), Mutex::new(policy));
            Ok(TrainedAgent {
                agent,
                policy,
                choice,
                options,
                config,
                env_id,
                observation,
                sizes,
                deltas,
            })
        });
        let made = made.map_err(|line: String| INVALID_OPTION.error(py, line))?;
        // A damaged checkpoint is passed over: another acts than the newest.
        for text in warnings {
            py.import("warnings")?
                .call_method1("warn", (text, py.get_type::<PyUserWarning>(), 2))?;
        }
        Ok(made)
    }

    /// begin(seeds) -> AgentState
    ///
    /// Returns what an agent carries when episodes of these `seeds` begin, a lane each.
    fn begin(&self, py: Python<'_>, seeds: Vec<u64>) -> AgentState {
        py.detach(|| AgentState { memory: self.agent().blank(&seeds) })
    }

    /// act(observations, state, costs, over, cost_terms=None) -> (actions int64 [n, groups], deltas
    /// float32 [n, 2], state)
    ///
    /// Args:
    ///     observations: uint8 [n, height, width, channels].
    ///     state: what the agent carries, from `begin` or the last call.
    ///     costs: of the step before, a number a lane, which agents that watch their budget need;
    ///         None in the first step.
    ///     over: bool a lane, those whose episode has ended; they begin a new one, whose seed
    ///         follows the old one's.
    ///     cost_terms: a row of k numbers a lane, which agents that watch one of the terms need.
    ///
    /// Returns:
    ///     Choices, continuous parts, and what the agent carries then.
    ///
    /// Raises:
    ///     ValueError for the wrong number of lanes or shape of observations, or cost_terms that
    ///         are missing.
    #[pyo3(signature = (observations, state, costs, over, cost_terms=None))]
    fn act<'py>(
        &self,
        py: Python<'py>,
        observations: &Bound<'py, PyArrayDyn<u8>>,
        state: &AgentState,
        costs: Option<Vec<f64>>,
        over: Option<Vec<bool>>,
        cost_terms: Option<Vec<Vec<f64>>>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>, AgentState)> {
        let lanes = state.memory.episodes.len();
        let pixels = self.pixels(observations, lanes)?;
        let lengths = [
            ("costs", costs.as_ref().map(Vec::len)),
            ("over", over.as_ref().map(Vec::len)),
            ("cost_terms", cost_terms.as_ref().map(Vec::len)),
        ];
        for (name, given) in lengths {
            if given.is_some_and(|given| given != lanes) {
                return Err(PyValueError::new_err(format!(
                    "{name} must have one entry for each of {lanes} lanes"
                )));
            }
        }
        if let Some(term) = self.agent().watched().filter(|_| costs.is_some())
            && cost_terms.iter().flatten().next().is_none_or(|terms| terms.len() <= term)
        {
            let why = "this agent watches one of the cost terms: give cost_terms too (infos=\"full\" has them)";
            return Err(PyValueError::new_err(why));
        }
        let acted = py.detach(|| {
            let mut agent = self.agent();
            agent.remember(state.memory.clone())?;
            for lane in 0..lanes {
                if over.as_ref().is_some_and(|over| over[lane]) {
                    agent.reset(lane, state.memory.episodes[lane].0.wrapping_add(1));
                } else if let Some(costs) = &costs {
                    let terms = cost_terms.as_ref().map_or(&[][..], |terms| &terms[lane]);
                    agent.observe_cost(lane, costs[lane], terms);
                }
            }
            let actions = agent.act(&pixels);
            Ok((actions, agent.memory()))
        });
        let (chosen, memory) = acted.map_err(|error: hasard_learn::error::LearnError| {
            INVALID_OPTION.error(py, error.to_string())
        })?;
        let actions: Vec<i64> =
            chosen.iter().flat_map(|one| one.actions.iter().map(|&part| i64::from(part))).collect();
        let deltas: Vec<f32> = chosen.into_iter().flat_map(|one| one.deltas).collect();
        Ok((
            array(py, actions, &[lanes, self.sizes.len()])?,
            array(py, deltas, &[lanes, self.deltas])?,
            AgentState { memory },
        ))
    }

    /// outputs(observations, state) -> (rows float32 [n, outputs], state)
    ///
    /// What the network says, without choosing.
    ///
    /// Args:
    ///     observations: uint8 [n, height, width, channels].
    ///     state: what the agent carries, from `begin` or the last call.
    ///
    /// Returns:
    ///     Rows of logits and parameters of the actions, the value, and the cost critics' values;
    ///         and what the agent carries then.
    ///
    /// Raises:
    ///     ValueError for the wrong number of lanes or shape of observations.
    fn outputs<'py>(
        &self,
        py: Python<'py>,
        observations: &Bound<'py, PyArrayDyn<u8>>,
        state: &AgentState,
    ) -> PyResult<(Bound<'py, PyAny>, AgentState)> {
        let lanes = state.memory.episodes.len();
        let pixels = self.pixels(observations, lanes)?;
        let seen = py.detach(|| {
            let mut agent = self.agent();
            agent.remember(state.memory.clone())?;
            let rows = agent.rows(&pixels).to_vec();
            Ok((rows, agent.memory()))
        });
        let (rows, memory) = seen.map_err(|error: hasard_learn::error::LearnError| {
            INVALID_OPTION.error(py, error.to_string())
        })?;
        let width = rows.len().checked_div(lanes).unwrap_or(0);
        Ok((array(py, rows, &[lanes, width])?, AgentState { memory }))
    }

    /// evaluate(seeds, env_id=None, rules=None) -> str
    ///
    /// Plays an episode of each of the `seeds` (int) with the weights that were loaded, in worlds
    /// as it was trained in, or in the environment `env_id` under the rule set `rules`.
    ///
    /// Returns:
    ///     A JSON list, of an object an episode and the summary, as `hasard eval --json` prints
    ///         them.
    ///
    /// Raises:
    ///     UnknownEnvironment for no such `env_id`; InvalidOption for worlds that cannot be made or
    ///         have other actions; what a signal's handler raises, such as KeyboardInterrupt.
    #[pyo3(signature = (seeds, env_id=None, rules=None))]
    fn evaluate(
        &self,
        py: Python<'_>,
        seeds: Vec<u64>,
        env_id: Option<&str>,
        rules: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<String> {
        let (elsewhere, options) = match (env_id, rules) {
            (None, None) => (None, self.options.clone()),
            _ => self.elsewhere(py, env_id, rules)?,
        };
        let mut raised = None;
        let played = py.detach(|| {
            let policy = self.policy.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            let interrupted = || match Python::attach(|py| py.check_signals()) {
                Ok(()) => false,
                Err(error) => {
                    raised = Some(error);
                    true
                }
            };
            hasard_cli::evaluate(&policy, self.choice, &options, elsewhere, &seeds, interrupted)
        });
        match (played, raised) {
            (_, Some(error)) => Err(error),
            (Ok(rows), _) => Ok(serde_json::Value::from(rows).to_string()),
            (Err(line), _) => Err(INVALID_OPTION.error(py, line.unwrap_or_default())),
        }
    }

    /// Settings of the run that the agent comes from: JSON, as in config.json.
    #[getter]
    fn config(&self) -> &str {
        &self.config
    }

    /// The environment that the agent was trained in, without `hasard/`.
    #[getter]
    fn env_id(&self) -> &str {
        &self.env_id
    }

    /// Shape of an observation: height, width, channels.
    #[getter]
    fn observation_shape(&self) -> (usize, usize, usize) {
        self.observation.into()
    }
}
