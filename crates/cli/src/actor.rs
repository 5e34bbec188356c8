//! Who acts in an episode that is shown or recorded.

use crate::commands::eval::Player;
use crate::failure::Failure;
use crate::settings::{self, Elsewhere, scenario_of};
use crate::zoo;
use hasard_envs::{ActionSpace, EnvId, EnvOptions, Move, PolicyRun, Scenario, Step};
use hasard_learn::config::EnvConfig;
use hasard_learn::runs::agent::{Agent, Choice, Which, run_config};
use hasard_play::{Recorder, Stage};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// A source of actions.
pub enum Actor {
    /// A policy that looks at nothing.
    Fixed(Box<PolicyRun>),
    /// A trained agent, and room for what it sees.
    Agent(Box<Agent>, Vec<u8>),
}

/// An episode about to be shown: its stage at the first moment, and who acts on it.
pub struct Performance {
    /// The stage.
    pub stage: Stage,
    actor: Actor,
}

impl Performance {
    /// An environment and a policy by its text: `run:DIR` or one that looks at nothing. `looks` is
    /// the task and what the audience sees of it; an agent sees what it was trained to see.
    pub fn new(
        id: &str,
        policy: &OsStr,
        looks: &EnvOptions,
        elsewhere: Elsewhere<'_>,
        seed: u64,
    ) -> Result<Performance, Failure> {
        if let Some(run) = agent_of(policy)? {
            // The task that was named, whatever file of that name the run was trained on.
            let looks =
                &EnvOptions { scenario: Some(settings::env_id(id)?.scenario), ..looks.clone() };
            return Performance::of_agent(
                id,
                &run,
                &agent_options(id, &run, looks, elsewhere)?,
                looks,
                seed,
            );
        }
        let policy = settings::policy(policy)?;
        let mut stage = Stage::new(id, looks).map_err(Failure::bad)?;
        stage.reset(seed);
        let actor = Actor::Fixed(Box::new(
            PolicyRun::new(policy, stage.env(), seed).map_err(Failure::bad)?,
        ));
        Ok(Performance { stage, actor })
    }

    /// The agent of a run in the environment that it was trained in.
    pub fn of_run(
        run: &Path,
        looks: &EnvOptions,
        elsewhere: Elsewhere<'_>,
        seed: u64,
    ) -> Result<Performance, Failure> {
        let config = run_config(run).map_err(Failure::bad)?;
        let options =
            settings::trained_options(&config.env, pictures_kept(elsewhere, &config.env))?;
        let id = settings::first_task(&config.env);
        if config.env.is_mixed() {
            let run = hasard_media::shell::quote(run);
            note!(
                "hasard: {run}: was trained on several tasks, of which this shows {id}; another: hasard record ENV --policy run:{run}"
            );
        }
        Performance::of_agent(&id, run, &options, looks, seed)
    }

    fn of_agent(
        id: &str,
        run: &Path,
        options: &EnvOptions,
        looks: &EnvOptions,
        seed: u64,
    ) -> Result<Performance, Failure> {
        let player = Player { run, which: Which::Selected, choice: Choice::Sampled };
        Performance::of_player(&player, id, options, looks, seed)
    }

    /// An agent in an environment as it was trained to see it.
    pub fn of_player(
        player: &Player<'_>,
        id: &str,
        options: &EnvOptions,
        looks: &EnvOptions,
        seed: u64,
    ) -> Result<Performance, Failure> {
        let mut stage = Stage::shown_as(id, options, looks).map_err(Failure::bad)?;
        stage.reset(seed);
        let mut agent = player.agent(stage.env())?;
        agent.reset(0, seed);
        let observation = vec![0; stage.env().observation_shape().iter().product()];
        Ok(Performance { stage, actor: Actor::Agent(Box::new(agent), observation) })
    }

    /// Begins another episode of an agent.
    pub fn restart(&mut self, seed: u64) {
        self.stage.reset(seed);
        if let Actor::Agent(agent, _) = &mut self.actor {
            agent.reset(0, seed);
        }
    }

    /// Goes on by a tic, choosing an action where the stage wants one and noting it in `recorder`.
    /// Gives what a step brought at its end.
    pub fn tic(&mut self, recorder: Option<&mut Recorder>) -> Result<Option<Step>, Failure> {
        if self.stage.wants_action() {
            self.choose(recorder)?;
        }
        let step = self.stage.tic();
        if let (Actor::Agent(agent, _), Some(step)) = (&mut self.actor, step) {
            agent.observe_cost(0, step.cost, self.stage.env().step_costs());
        }
        Ok(step)
    }

    fn choose(&mut self, recorder: Option<&mut Recorder>) -> Result<(), Failure> {
        let stage = &mut self.stage;
        let (actions, deltas) = match &mut self.actor {
            Actor::Fixed(policy) => match policy.next_move(stage.env()) {
                Move::Action(actions, deltas) => (actions.to_vec(), deltas.to_vec()),
                Move::Buttons(command) => {
                    stage.press(command);
                    if recorder.is_none() {
                        return Ok(());
                    }
                    stage.env().action_space().action_of(command).ok_or_else(|| {
                        Failure::bad("these buttons are no action of the environment, so an episode file cannot hold them; try --full-actions, or record a video")
                    })?
                }
            },
            Actor::Agent(agent, observation) => {
                stage.observe(observation);
                let action = agent.act(observation).swap_remove(0);
                (action.actions, action.deltas)
            }
        };
        stage.act(&actions, &deltas).map_err(Failure::bad)?;
        recorder.map_or(Ok(()), |recorder| recorder.push(&actions, &deltas)).map_err(Failure::bad)
    }
}

/// The run directory or file of the agent that a policy's text names: `run:DIR`, `FILE.agent`
/// (`run:` may stand before it) or `zoo:NAME`.
pub fn agent_of(policy: &OsStr) -> Result<Option<PathBuf>, Failure> {
    if zoo::after(policy, "zoo:").is_some() {
        return zoo::find(policy).map(Some);
    }
    let file =
        || Some(PathBuf::from(policy)).filter(|path| path.extension() == Some("agent".as_ref()));
    zoo::after(policy, "run:").or_else(file).map(|run| zoo::find(run.as_os_str())).transpose()
}

/// What a command that films says of places: its maps are those that are played in, but its
/// pictures are the audience's, and the agent's only where its own are lost.
fn pictures_kept<'a>(elsewhere: Elsewhere<'a>, env: &EnvConfig) -> Elsewhere<'a> {
    Elsewhere { maps: elsewhere.maps, ..elsewhere.where_missing(env) }
}

/// What the agent of a run is to see in an environment: as it was trained, under the rules and
/// constraint of `task`, with the buttons that it knows. Says so where it was trained in another
/// scenario.
pub fn agent_options(
    id: &str,
    run: &Path,
    task: &EnvOptions,
    elsewhere: Elsewhere<'_>,
) -> Result<EnvOptions, Failure> {
    let env = run_config(run).map_err(Failure::bad)?.env;
    if env.tasks().iter().all(|task| scenario_of(&task.id) != scenario_of(id)) {
        note!("hasard: {}: was trained in {}, not in {id}", run.display(), env.id);
    }
    let trained = settings::trained_options(&env, pictures_kept(elsewhere, &env))?;
    let own = settings::env_id(&settings::first_task(&env))?;
    in_task(&trained, own, settings::env_id(id)?, task).map_err(Failure::bad)
}

/// What an agent that was trained in `own`, as `trained` says, sees and presses in the environment
/// `id` under the rules and constraint of `task`: pictures and buttons are those that it knows.
///
/// # Errors
/// One line where the environment lacks a button of the agent's. (One of several tasks is used to
/// buttons that do nothing.)
pub fn in_task(
    trained: &EnvOptions,
    own: EnvId,
    id: EnvId,
    task: &EnvOptions,
) -> Result<EnvOptions, String> {
    let options = EnvOptions {
        scenario: task.scenario.or(trained.scenario),
        rules: task.rules,
        hard: task.hard,
        early_creatures: task.early_creatures,
        test_seeds: task.test_seeds,
        actions_of: Some((trained.rules, trained.hard)),
        ..trained.clone()
    };
    if options.together.is_some() {
        return Ok(options);
    }
    let buttons = |id: EnvId, of: Option<Scenario>| {
        let of_name = of.filter(|scenario| scenario.name == id.scenario.name);
        let id = EnvId { scenario: of_name.unwrap_or(id.scenario), ..id };
        ActionSpace::of(id, trained.rules, trained.hard, trained.full_actions)
    };
    let (known, there) = (buttons(own, trained.scenario), buttons(id, options.scenario));
    if known.names() == there.names() {
        return Ok(options);
    }
    // Two tasks may have as many buttons and call them in another order.
    let missing = there.lacking(&known);
    if !missing.is_empty() {
        return Err(format!(
            "an agent of {own} cannot act in {id}: its buttons are others, there is no {}; play it in its own scenario",
            missing.join(", ")
        ));
    }
    Ok(EnvOptions { together: Some(known), ..options })
}

#[cfg(test)]
mod tests {
    use super::*;
    use hasard_envs::{Env, RuleSet};

    fn played(own: &str, id: &str, trained: &EnvOptions) -> Result<EnvOptions, String> {
        let task = EnvOptions { rules: RuleSet::Tables, ..EnvOptions::default() };
        in_task(trained, own.parse().unwrap(), id.parse().unwrap(), &task)
    }

    /// Both have SPEED and JUMP, in another order: an agent's third output is SPEED in either.
    #[test]
    fn an_agent_presses_the_buttons_that_it_knows() {
        let trained = EnvOptions::default();
        let (own, id) = ("RemedyRushLevel1-v0", "VolcanicVentureLevel1-v0");
        let options = played(own, id, &trained).unwrap();
        let space =
            |id: &str, options: &EnvOptions| Env::new(id, options).unwrap().action_space().clone();
        assert_eq!(space(id, &options), space(own, &trained));
        assert_ne!(space(id, &trained).groups, space(own, &trained).groups);
        // Of the same scenario nothing is written of them, whatever the level.
        assert_eq!(played(own, "RemedyRushLevel3-v0", &trained).unwrap().together, None);
    }

    /// They have as many buttons, but one of the one's is none of the other's.
    #[test]
    fn an_agent_does_not_act_without_its_buttons() {
        let error =
            played("ArmamentBurdenLevel1-v0", "VolcanicVentureLevel1-v0", &EnvOptions::default());
        let error = error.unwrap_err();
        assert!(error.contains("there is no USE;"), "{error}");
        let several = EnvOptions {
            together: ActionSpace::named("TURN_LEFT|TURN_RIGHT USE"),
            ..EnvOptions::default()
        };
        played("ArmamentBurdenLevel1-v0", "VolcanicVentureLevel1-v0", &several).unwrap();
    }
}
