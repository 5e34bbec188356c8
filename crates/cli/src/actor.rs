//! Who acts in an episode that is shown or recorded.

use crate::failure::Failure;
use hasard_engine::world::Command;
use hasard_envs::{ActionSpace, Env, Move, PolicyRun, Step};
use hasard_media::episode::EpisodeFile;

/// A source of actions.
pub enum Actor {
    /// A policy that looks at nothing.
    Fixed(Box<PolicyRun>),
    /// A recorded episode and the next step of it.
    Recording(Box<EpisodeFile>, usize),
}

impl Actor {
    /// Takes one step, noting its action in `record`. `None` when a recording is over.
    pub fn step(&mut self, env: &mut Env, record: Option<&mut EpisodeFile>) -> Result<Option<Step>, Failure> {
        let (actions, deltas) = match self {
            Actor::Fixed(policy) => match policy.next_move() {
                Move::Action(actions, deltas) => (actions.to_vec(), deltas.to_vec()),
                Move::Buttons(command) => {
                    if record.is_none() {
                        return Ok(Some(env.step_buttons(command)));
                    }
                    let found = action_of(env.action_space(), command);
                    found.ok_or_else(|| {
                        Failure::bad("these buttons are no action of the environment, so an episode file cannot hold them; try --full-actions, or record a video")
                    })?
                }
            },
            Actor::Recording(file, next) => match file.step(*next) {
                Some((actions, deltas)) => {
                    *next += 1;
                    (actions.to_vec(), deltas.to_vec())
                }
                None => return Ok(None),
            },
        };
        if let Some(record) = record {
            record.push(&actions, &deltas).map_err(Failure::bad)?;
        }
        Ok(Some(env.step(&actions, &deltas)))
    }
}

/// The action that presses exactly these buttons, if the space has it.
fn action_of(space: &ActionSpace, command: Command) -> Option<(Vec<u8>, Vec<f32>)> {
    let choose = |group: &hasard_envs::ActionGroup| {
        group.buttons.iter().position(|&(_, button)| command.buttons.any(button)).map_or(0, |i| i as u8 + 1)
    };
    let actions: Vec<u8> = space.groups.iter().map(choose).collect();
    let deltas = vec![0.0; space.deltas.len()];
    (space.command(&actions, &deltas) == command).then_some((actions, deltas))
}
