//! Fixed policies: what an agent without a model does.

use crate::error::{EnvError, excerpt};
use crate::policies::carrier::Carrier;
use crate::single::env::Env;
use crate::spaces::action::{Move, parse_command};
use hasard_engine::math::Rng;
use hasard_engine::world::{Buttons, Command};

/// Lane number of the policies' random stream, so that a policy never shares randomness with the
/// world of the same seed.
const POLICY_STREAM: u64 = 0x706F_6C69_6379;

/// A policy of fixed rules, named by a short text.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Policy {
    /// `random`, `sticky:K`: uniform per sub-action of the action space, drawn anew every `K` steps
    /// (1 for `random`).
    Random {
        /// Steps that a drawn action is held.
        hold_steps: u32,
    },
    /// `noop`, `hold:A+B`, `hold-after:K:A+B`: buttons held from a step on, nothing before it.
    Hold {
        /// Steps in which nothing is pressed.
        after_steps: u32,
        /// What is held.
        command: Command,
    },
    /// `shuttle`: to and fro, by the buttons of the published measurements.
    Shuttle,
    /// `carrier`: walks to a weapon that it may carry, and home with it. It alone looks, and only
    /// in Armament Burden.
    Carrier,
}

/// The shuttle's way: buttons by name, and for how many steps. It begins anew at the end.
const SHUTTLE: [(Buttons, u32); 8] = [
    (Buttons::MOVE_FORWARD, 40),
    (Buttons::TURN_LEFT, 13),
    (Buttons(0), 1),
    (Buttons::TURN_LEFT, 1),
    (Buttons::MOVE_FORWARD, 40),
    (Buttons::TURN_RIGHT, 13),
    (Buttons(0), 1),
    (Buttons::TURN_RIGHT, 1),
];

impl std::str::FromStr for Policy {
    type Err = EnvError;

    fn from_str(text: &str) -> Result<Policy, EnvError> {
        let wrong = |why: String| EnvError::Policy { given: excerpt(text), why };
        let steps = |digits: &str, least: u32| match digits.parse::<u32>() {
            Ok(steps) if steps >= least => Ok(steps),
            _ => Err(wrong(format!(
                "'{}' is no number of steps; write a whole number from {least} up",
                excerpt(digits)
            ))),
        };
        let buttons = |names: &str| match parse_command(names) {
            _ if names.is_empty() => {
                Err(wrong("no button is named; write for example hold:MOVE_FORWARD".to_string()))
            }
            Ok(command) => Ok(command),
            Err(error) => Err(wrong(error.to_string())),
        };
        match text.split_once(':') {
            None if text == "random" => Ok(Policy::Random { hold_steps: 1 }),
            None if text == "shuttle" => Ok(Policy::Shuttle),
            None if text == "carrier" => Ok(Policy::Carrier),
            None if text == "noop" => Ok(Policy::Hold { after_steps: 0, command: Command::default() }),
            Some(("sticky", digits)) => Ok(Policy::Random { hold_steps: steps(digits, 1)? }),
            Some(("hold", names)) => Ok(Policy::Hold { after_steps: 0, command: buttons(names)? }),
            Some(("hold-after", rest)) => {
                let (digits, names) = rest
                    .split_once(':')
                    .ok_or_else(|| wrong("it needs steps and buttons; write for example hold-after:1:ATTACK".to_string()))?;
                Ok(Policy::Hold { after_steps: steps(digits, 0)?, command: buttons(names)? })
            }
            _ => Err(wrong(
                "it must be random, sticky:K, noop, hold:BUTTONS, hold-after:K:BUTTONS, shuttle or carrier".to_string(),
            )),
        }
    }
}

/// A fixed policy at work.
#[derive(Clone, Debug)]
pub struct PolicyRun {
    policy: Policy,
    rng: Rng,
    step: u32,
    actions: Vec<u8>,
    deltas: Vec<f32>,
    carrier: Option<Carrier>,
}

impl PolicyRun {
    /// The policy in an environment; its randomness follows from `seed`.
    ///
    /// # Errors
    /// When the policy is for another scenario.
    pub fn new(policy: Policy, env: &Env, seed: u64) -> Result<PolicyRun, EnvError> {
        let space = env.action_space();
        let (actions, deltas) = (vec![0; space.groups.len()], vec![0.0; space.deltas.len()]);
        let carrier = if policy == Policy::Carrier { Some(Carrier::new(env)?) } else { None };
        Ok(PolicyRun {
            policy,
            rng: Rng::for_lane(seed, POLICY_STREAM),
            step: 0,
            actions,
            deltas,
            carrier,
        })
    }

    /// What is done in the next step.
    pub fn next_move(&mut self, env: &Env) -> Move<'_> {
        let step = self.step;
        self.step += 1;
        match self.policy {
            Policy::Random { hold_steps } => {
                if step.is_multiple_of(hold_steps) {
                    env.action_space().sample(&mut self.rng, &mut self.actions, &mut self.deltas);
                }
                Move::Action(&self.actions, &self.deltas)
            }
            Policy::Shuttle => {
                let mut left = step % SHUTTLE.iter().map(|(_, steps)| steps).sum::<u32>();
                let leg = SHUTTLE.iter().find(|(_, steps)| {
                    let here = left < *steps;
                    left = left.saturating_sub(*steps);
                    here
                });
                Move::Buttons(Command {
                    buttons: leg.map_or(Buttons(0), |leg| leg.0),
                    ..Command::default()
                })
            }
            Policy::Carrier => {
                let command = self.carrier.as_mut().map(|carrier| carrier.next(env));
                Move::Buttons(command.unwrap_or_default())
            }
            Policy::Hold { after_steps, command } => {
                Move::Buttons(if step < after_steps { Command::default() } else { command })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::EnvOptions;

    fn env(id: &str, full_actions: bool) -> Env {
        Env::new(id, &EnvOptions { full_actions, ..EnvOptions::default() }).unwrap()
    }

    #[test]
    fn policies_are_read() {
        let hold = |after_steps, buttons| Policy::Hold {
            after_steps,
            command: Command { buttons, ..Command::default() },
        };
        assert_eq!("random".parse(), Ok(Policy::Random { hold_steps: 1 }));
        assert_eq!("sticky:12".parse(), Ok(Policy::Random { hold_steps: 12 }));
        assert_eq!("noop".parse(), Ok(hold(0, Buttons::default())));
        assert_eq!(
            "hold:MOVE_FORWARD+SPEED".parse(),
            Ok(hold(0, Buttons::MOVE_FORWARD | Buttons::SPEED))
        );
        assert_eq!("hold-after:1:ATTACK".parse(), Ok(hold(1, Buttons::ATTACK)));
    }

    #[test]
    fn wrong_policies_are_one_clear_line() {
        for wrong in [
            "",
            "rand",
            "sticky",
            "sticky:",
            "sticky:0",
            "sticky:-1",
            "hold:",
            "hold:FLY",
            "hold-after:ATTACK",
            "hold-after:x:JUMP",
        ] {
            let text = wrong.parse::<Policy>().expect_err(wrong).to_string();
            assert!(text.contains(wrong) && text.lines().count() == 1, "{text}");
        }
    }

    #[test]
    fn random_is_uniform_and_sticky_holds() {
        let env = env("PrecipicePlungeLevel1-v0", true);
        let space = env.action_space();
        let mut counts = vec![[0u32; 3]; space.groups.len()];
        let mut run = PolicyRun::new("random".parse().unwrap(), &env, 1).unwrap();
        let mut sum = 0.0;
        for _ in 0..6000 {
            let Move::Action(actions, deltas) = run.next_move(&env) else {
                panic!("random presses actions")
            };
            assert!(deltas.iter().all(|d| (-1.0..1.0).contains(d)));
            sum += deltas[0];
            actions
                .iter()
                .zip(&mut counts)
                .for_each(|(&action, count)| count[usize::from(action)] += 1);
        }
        assert!(sum.abs() < 200.0);
        for (count, size) in counts.iter().zip(space.sizes()) {
            assert!(
                count[..size].iter().all(|&n| (n as i32 - 6000 / size as i32).abs() < 250),
                "{count:?}"
            );
        }
        let mut sticky = PolicyRun::new("sticky:5".parse().unwrap(), &env, 1).unwrap();
        let moves: Vec<Vec<u8>> = (0..20)
            .map(|_| match sticky.next_move(&env) {
                Move::Action(actions, _) => actions.to_vec(),
                Move::Buttons(_) => panic!("sticky presses actions"),
            })
            .collect();
        assert!(moves.chunks(5).all(|chunk| chunk.iter().all(|m| *m == chunk[0])));
        assert_ne!(moves[0], moves[5]);
    }

    #[test]
    fn hold_after_waits() {
        let env = env("CollateralDamageLevel1-v0", false);
        let mut run = PolicyRun::new("hold-after:2:ATTACK".parse().unwrap(), &env, 1).unwrap();
        let held: Vec<bool> = (0..4)
            .map(
                |_| matches!(run.next_move(&env), Move::Buttons(c) if c.buttons == Buttons::ATTACK),
            )
            .collect();
        assert_eq!(held, [false, false, true, true]);
    }

    /// The measurements' own words: 40 forward, 13 left, 1 nothing, 1 left, 40 forward, 13 right, 1
    /// nothing, 1 right.
    #[test]
    fn the_shuttle_goes_to_and_fro() {
        let env = env("ArmamentBurdenLevel1-v0", false);
        let mut run = PolicyRun::new(Policy::Shuttle, &env, 1).unwrap();
        let held: Vec<Buttons> = (0..220)
            .map(|_| match run.next_move(&env) {
                Move::Buttons(command) => command.buttons,
                Move::Action(..) => panic!("the shuttle holds buttons"),
            })
            .collect();
        let (ahead, left, right) = (Buttons::MOVE_FORWARD, Buttons::TURN_LEFT, Buttons::TURN_RIGHT);
        let back = [vec![ahead; 40], vec![right; 13], vec![Buttons(0)], vec![right]].concat();
        let way = [vec![ahead; 40], vec![left; 13], vec![Buttons(0)], vec![left], back].concat();
        assert_eq!(held, [way.clone(), way].concat());
    }

    #[test]
    fn a_carrier_has_nothing_to_carry_elsewhere() {
        let error = PolicyRun::new(Policy::Carrier, &env("RemedyRushLevel1-v0", false), 1)
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("carrier")
                && error.contains("ArmamentBurden")
                && error.lines().count() == 1,
            "{error}"
        );
    }
}
