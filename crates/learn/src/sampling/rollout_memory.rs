//! Whether the pictures of a rollout fit into the machine's memory: asked before anything is made, since
//! the system ends a program that runs out of memory without a word.

use hasard_envs::{EnvOptions, machine_memory};

use crate::config::TrainConfig;
use crate::error::LearnError;

/// Refuses a rollout whose pictures alone are more than the memory of this machine, or of the group
/// of processes that this one is in. `lanes` are those that are played here.
pub fn check(config: &TrainConfig, lanes: usize) -> Result<(), LearnError> {
    let options = config.env.options()?;
    // A system that does not say how much it has refuses nothing.
    machine_memory().map_or(Ok(()), |memory| fits(config, lanes, picture(&options), memory))
}

/// Bytes of one observation.
fn picture(options: &EnvOptions) -> usize {
    let pixels = usize::from(options.size.width) * usize::from(options.size.height);
    pixels * options.observation.channels() * options.frame_stack
}

fn fits(config: &TrainConfig, lanes: usize, picture: usize, memory: u64) -> Result<(), LearnError> {
    let steps = config.sampling.rollout;
    // At most 2^16 worlds, 2^13 steps and 2^27 bytes: no overflow.
    let needed = (lanes as u64) * (steps as u64 + 1) * picture as u64;
    if needed <= memory {
        return Ok(());
    }
    let gigabytes = |bytes: u64| bytes as f64 / 1e9;
    Err(LearnError::Config(format!(
        "the pictures of a rollout, {lanes} worlds of {steps} steps, take {:.0} GB, and this machine has {:.0}; give a smaller \
         sampling.lanes, sampling.rollout or env.size",
        gigabytes(needed),
        gigabytes(memory),
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, EnvConfig, Preset};

    #[test]
    fn a_rollout_larger_than_the_memory_is_refused_and_the_largest_that_fits_is_not() {
        let env = EnvConfig::new("RemedyRushLevel1-v0");
        let mut config = TrainConfig::new(AlgorithmKind::Ppo, Preset::Quick, env).unwrap();
        config.sampling.rollout = 31;
        let options = config.env.options().unwrap();
        assert_eq!(picture(&options), 128 * 72 * 3);
        let memory = 32 * 27_648 * 1000;
        assert!(fits(&config, 1000, picture(&options), memory).is_ok());
        let message = fits(&config, 1001, picture(&options), memory).unwrap_err().to_string();
        assert!(message.contains("1001 worlds of 31 steps") && message.contains("sampling.lanes"));
    }

    #[test]
    fn frames_that_are_stacked_count_each() {
        let mut env = EnvConfig::new("RemedyRushLevel1-v0");
        (env.observation, env.frame_stack) = ("rgb+depth".into(), 4);
        assert_eq!(picture(&env.options().unwrap()), 128 * 72 * 4 * 4);
    }

    #[test]
    fn a_usual_rollout_fits_here() {
        let env = EnvConfig::new("RemedyRushLevel1-v0");
        let config = TrainConfig::new(AlgorithmKind::Ppo, Preset::Quick, env).unwrap();
        assert!(check(&config, config.sampling.lanes).is_ok());
        assert!(check(&config, 1 << 40).is_err());
    }
}
