//! Where the lanes of a run begin: each somewhere else in its first episode. Otherwise all episodes
//! of a scenario that always runs into the clock would end at once, and constraints would hear of
//! their cost once in an age.

use super::{Newest, Sampler};
use crate::error::LearnError;
use crate::random::{Purpose, Stream};
use crate::sampling::rollout::Part;

/// Steps that are gathered at once: what they show is thrown away, and takes memory until then.
const AT_ONCE: u64 = 16;

impl Sampler {
    /// Of all `total` lanes of the run, each starts after so many random steps that their episodes
    /// end spread over the time of one.
    pub fn spread_out(&mut self, total: usize, episode_steps: u32) -> Result<(), LearnError> {
        let mut saved = self.save()?;
        let action = &self.shape.action;
        for (lane, world) in saved.worlds.iter_mut().enumerate() {
            let number = (self.first_lane + lane) as u64;
            let mut stream = Stream::new(self.seed, Purpose::FirstSteps, number, 0);
            for _ in 0..first_steps(number, total, episode_steps) {
                for &size in &action.sizes {
                    world.actions.push((stream.uniform() * size as f64) as u8);
                }
                for _ in 0..action.deltas {
                    world.deltas.push((2.0 * stream.uniform() - 1.0) as f32);
                }
            }
        }
        self.restore(saved)
    }

    /// The same, but the policy itself takes these steps. It is for runs that begin with one that
    /// has learned something: random steps in its first episodes would cost what it does not, and
    /// multipliers would rise by that until it has forgotten what it knew.
    pub fn play_apart(
        &mut self,
        total: usize,
        episode_steps: u32,
        newest: &Newest,
    ) -> Result<(), LearnError> {
        let mut begun = self.save()?;
        let recording = std::mem::replace(&mut self.recording, false);
        let trajectory = std::mem::replace(&mut self.trajectory_steps, usize::MAX);
        let mut part = Part::default();
        for lane in 0..self.lanes() {
            let until = first_steps((self.first_lane + lane) as u64, total, episode_steps);
            while self.steps < until {
                self.fill(&mut part, AT_ONCE.min(until - self.steps) as usize, newest)?;
            }
            begun.take(lane, &self.save()?);
        }
        (self.recording, self.trajectory_steps) = (recording, trajectory);
        // As far for every sampler of the run, and no draw of an action is made twice.
        begun.steps = u64::from(episode_steps);
        self.restore(begun)
    }
}

/// Steps before the first that counts, of a lane of all.
fn first_steps(lane: u64, total: usize, episode_steps: u32) -> u64 {
    lane * u64::from(episode_steps) / total as u64
}
