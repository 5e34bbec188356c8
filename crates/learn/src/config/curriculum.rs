//! A curriculum: the levels of a scenario in turn, each for a number of frames.
//!
//! Weights and normalisers (of pixels and of returns) carry over from a lesson to the next;
//! optimisers, multipliers and the window of latest episodes start anew, as in the published
//! experiment. Counters go on: a curriculum is one run.

use serde::{Deserialize, Serialize};

use crate::error::LearnError;

/// A level, and how long it is trained.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Lesson {
    /// The level, from 1.
    pub level: u8,
    /// Frames.
    pub frames: u64,
}

/// Most lessons of a curriculum.
const MOST_LESSONS: usize = 16;

/// Understands `1,2,3`, where every level has an equal share of `frames`, or
/// `1:400000,2:300000,3:300000`; of a scenario of so many levels.
pub fn parse_curriculum(text: &str, frames: u64, levels: u8) -> Result<Vec<Lesson>, LearnError> {
    let wrong = |why: &str| {
        LearnError::Config(format!(
            "curriculum '{text}': {why}; write levels such as 1,2,3, or LEVEL:FRAMES such as 1:400000,2:600000"
        ))
    };
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    if parts.len() > MOST_LESSONS {
        return Err(wrong("it has too many lessons"));
    }
    let mut lessons = Vec::new();
    for part in &parts {
        let (level, own) =
            part.split_once(':').map_or((*part, None), |(level, frames)| (level, Some(frames)));
        let level = level
            .parse()
            .ok()
            .filter(|level| (1..=levels).contains(level))
            .ok_or_else(|| wrong(&format!("the levels are 1 to {levels}")))?;
        let own = own.map(|own| {
            own.parse()
                .ok()
                .filter(|own| *own > 0)
                .ok_or_else(|| wrong("frames are a whole number from 1"))
        });
        lessons.push((level, own.transpose()?));
    }
    let given = lessons.iter().filter(|(_, own)| own.is_some()).count();
    if given != 0 && given != lessons.len() {
        return Err(wrong("either every level has its frames or none"));
    }
    let share = frames / lessons.len() as u64;
    let mut lessons: Vec<Lesson> = lessons
        .into_iter()
        .map(|(level, own)| Lesson { level, frames: own.unwrap_or(share) })
        .collect();
    if given == 0 {
        // What an equal share leaves over belongs to the last.
        let rest = frames - share * lessons.len() as u64;
        lessons.iter_mut().rev().take(1).for_each(|last| last.frames += rest);
        if share == 0 {
            return Err(wrong("there are fewer frames than levels"));
        }
    }
    Ok(lessons)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, EnvConfig, Preset, TrainConfig};

    #[test]
    fn texts_become_lessons() {
        let lessons = |text: &str| -> Vec<(u8, u64)> {
            parse_curriculum(text, 100, 3)
                .unwrap()
                .iter()
                .map(|lesson| (lesson.level, lesson.frames))
                .collect()
        };
        assert_eq!(lessons("1,2,3"), [(1, 33), (2, 33), (3, 34)]);
        assert_eq!(lessons("2:5, 1:7"), [(2, 5), (1, 7)]);
        // Tasks of files have others.
        assert_eq!(parse_curriculum("4", 100, 4).unwrap(), [Lesson { level: 4, frames: 100 }]);
        for (wrong, word) in [
            ("", "levels are 1 to 3"),
            ("4", "levels are 1 to 3"),
            ("1,2:5", "either"),
            ("1:0", "whole number"),
            ("1,,2", "levels are 1 to 3"),
        ] {
            let message = parse_curriculum(wrong, 100, 3).unwrap_err().to_string();
            assert!(message.contains(word) && !message.contains('\n'), "{wrong}: {message}");
        }
        assert!(parse_curriculum("1,2,3", 2, 3).is_err());
        assert!(parse_curriculum(&"1,".repeat(1000), 2, 3).is_err());
    }

    #[test]
    fn lessons_follow_each_other() {
        let env = EnvConfig::new("RemedyRushLevel1-v0");
        let mut config = TrainConfig::new(AlgorithmKind::PpoPid, Preset::Paper, env).unwrap();
        assert_eq!((config.lessons(), config.lesson_at(0), config.lesson_at(u64::MAX)), (1, 0, 0));
        assert_eq!(config.lesson(0), config);
        config.set_curriculum(parse_curriculum("1:100,2:50,3:10", 0, 3).unwrap());
        assert_eq!((config.frames, config.env.id.as_str()), (160, "RemedyRushLevel3-v0"));
        let at = [0, 99, 100, 149, 150, 160, 9999].map(|frames| config.lesson_at(frames));
        assert_eq!(at, [0, 0, 1, 1, 2, 2, 2]);
        let second = config.lesson(1);
        assert_eq!(second.env.id, "RemedyRushLevel2-v0");
        assert_ne!(second.seed, config.lesson(2).seed);
        assert_eq!(config.lesson(0).seed, config.seed);
        assert_eq!(config.automap(1), "automap-level2.png");
        let text = serde_json::to_string(&config).unwrap();
        assert_eq!(serde_json::from_str::<TrainConfig>(&text).unwrap(), config);
    }
}
