//! The lessons of a run with a curriculum.

use hasard_envs::EnvId;

use crate::config::curriculum::Lesson;
use crate::config::environment::EnvConfig;
use crate::config::train_config::TrainConfig;
use crate::error::LearnError;
use crate::random::{Purpose, Stream};

impl TrainConfig {
    /// Makes the run a curriculum: its length becomes that of the lessons, its environment that of
    /// the last.
    pub fn set_curriculum(&mut self, lessons: Vec<Lesson>) {
        self.frames = lessons.iter().fold(0, |sum, lesson| sum.saturating_add(lesson.frames));
        if let Some(last) = lessons.last() {
            self.env.id = id_at(&self.env, last.level);
        }
        self.curriculum = lessons;
        // Levels of a file may differ in length.
        let longest =
            (0..self.lessons()).filter_map(|one| self.lesson(one).env.own_episode_steps());
        self.episode_steps = longest.max().unwrap_or(self.episode_steps);
    }

    /// Whether its tasks or lessons have episodes of several lengths.
    pub(crate) fn lengths_differ(&self) -> bool {
        let all: Vec<u32> =
            (0..self.lessons()).flat_map(|one| self.lesson(one).env.lengths()).collect();
        all.iter().any(|one| one != &all[0])
    }

    /// Number of lessons; 1 without a curriculum.
    #[must_use]
    pub fn lessons(&self) -> usize {
        self.curriculum.len().max(1)
    }

    /// Refuses lessons whose buttons differ, as those of a file's levels may: one network acts in
    /// all.
    pub(crate) fn check_lessons(&self) -> Result<(), LearnError> {
        let space = |index: usize| self.lesson(index).env.action_space();
        let first = if self.curriculum.is_empty() { None } else { space(0)? };
        for (index, lesson) in self.curriculum.iter().enumerate().skip(1) {
            if first != space(index)? {
                return Err(LearnError::Config(format!(
                    "--curriculum: level {} has other buttons than level {}; give levels of a file the same, or train on one",
                    lesson.level, self.curriculum[0].level
                )));
            }
        }
        Ok(())
    }

    /// The lesson after so many frames. The last one goes on for as long as the run does.
    #[must_use]
    pub fn lesson_at(&self, frames: u64) -> usize {
        let mut end = 0u64;
        let over = self.curriculum.iter().take_while(|lesson| {
            end = end.saturating_add(lesson.frames);
            end <= frames
        });
        over.count().min(self.lessons() - 1)
    }

    /// The settings of one lesson: its level, and a seed of its own, so that lessons do not draw
    /// the same numbers.
    #[must_use]
    pub fn lesson(&self, index: usize) -> TrainConfig {
        let mut config = self.clone();
        if let Some(lesson) = self.curriculum.get(index) {
            config.env.id = id_at(&self.env, lesson.level);
        }
        if index > 0 {
            config.seed = Stream::new(self.seed, Purpose::Lesson, index as u64, 0).bits();
        }
        config
    }

    /// Name of the picture in the run's directory that the heatmaps of a lesson lie on.
    #[must_use]
    pub fn automap(&self, lesson: usize) -> String {
        self.curriculum.get(lesson).map_or_else(
            || "automap.png".into(),
            |lesson| format!("automap-level{}.png", lesson.level),
        )
    }
}

/// The id at another level; unregistered ids, such as those of tests, have none.
fn id_at(env: &EnvConfig, level: u8) -> String {
    env.env_id().map_or_else(|_| env.id.clone(), |id| EnvId { level, ..id }.to_string())
}
