//! How an environment is made.

use crate::error::EnvError;
use crate::maps::folder::Maps;
use crate::scenarios::common::rule_set::RuleSet;
use crate::scenarios::common::scenario::Scenario;
use crate::spaces::action::ActionSpace;
use hasard_engine::render::FrameSize;

/// What the learner sees.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum ObservationKind {
    /// Red, green, blue.
    #[default]
    Rgb,
    /// Red, green, blue, depth (0 near to 255 far, 7.3 map units a level).
    RgbDepth,
    /// One fixed colour per class.
    Segmented,
    /// One channel of luminance.
    Grey,
}

impl ObservationKind {
    /// Bytes of a pixel.
    #[must_use]
    pub fn channels(self) -> usize {
        match self {
            ObservationKind::Rgb | ObservationKind::Segmented => 3,
            ObservationKind::RgbDepth => 4,
            ObservationKind::Grey => 1,
        }
    }
}

/// Order of an observation's axes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Layout {
    /// Height, width, channels: what people and Gymnasium expect.
    #[default]
    Hwc,
    /// Channels, height, width: what convolutions expect.
    Chw,
}

/// Everything that a user may choose about an environment beside its id.
#[derive(Clone, Debug)]
pub struct EnvOptions {
    /// The scenario that the id is of, where it must not be looked for in the registry, which may
    /// have another of the same name.
    pub scenario: Option<Scenario>,
    /// Which constants.
    pub rules: RuleSet,
    /// Detonator's Dilemma 1 under [`RuleSet::Tables`] with the creatures that the first of the
    /// paper's runs met (PPO, PPOCost, PPOLag) rather than those of the later ones.
    pub early_creatures: bool,
    /// Levels that no training has seen, in tasks that make a new map in every episode and train on
    /// a number of them.
    pub test_seeds: bool,
    /// Hard constraint: harm ends the episode.
    pub hard: bool,
    /// The full action space instead of the simplified one.
    pub full_actions: bool,
    /// Whose action space, by rules and hard constraint, if another than the world's own: an agent
    /// keeps the buttons that it was trained with.
    pub actions_of: Option<(RuleSet, bool)>,
    /// The space of an agent that was trained elsewhere: on several tasks, which have one space
    /// together ([`ActionSpace::together`]), or in another scenario. A button that this environment
    /// does not have does nothing in it. `None` for its own space.
    pub together: Option<ActionSpace>,
    /// Tics that each action is held; 1..=35.
    pub frame_skip: u32,
    /// Policy steps after which an episode is cut off, where that is sooner than its scenario's
    /// time-out; 1 or more.
    pub max_episode_steps: Option<u32>,
    /// Frame size.
    pub size: FrameSize,
    /// What is drawn.
    pub observation: ObservationKind,
    /// Axis order of observations.
    pub layout: Layout,
    /// Number of last frames stacked along the channel axis, oldest first; 1..=16.
    pub frame_stack: usize,
    /// Depth of walls ends where ViZDoom's does, not at 255.
    pub published_depth: bool,
    /// Segmented frames have the published colours, some of which several classes share.
    pub published_colours: bool,
    /// Notes what happens in each step: see [`crate::Environment::happenings`].
    pub events: bool,
    /// Maps to play in instead of the built-in ones, from files: the published ones, or a user's
    /// own.
    pub maps: Option<std::sync::Arc<Maps>>,
    /// One map to play in, before any other: it needs a player start and the sector tags that the
    /// scenario's rules change.
    pub map: Option<std::sync::Arc<hasard_engine::map::MapSource>>,
    /// Pictures to draw with; the embedded set if `None`. Maps that come with an IWAD are drawn
    /// with theirs.
    pub assets: Option<std::sync::Arc<hasard_engine::assets::Assets>>,
}

/// Tics that each action is held where nothing else is said.
pub const FRAME_SKIP: u32 = 4;

impl Default for EnvOptions {
    fn default() -> EnvOptions {
        EnvOptions {
            scenario: None,
            rules: RuleSet::Paper,
            early_creatures: false,
            test_seeds: false,
            hard: false,
            full_actions: false,
            actions_of: None,
            together: None,
            frame_skip: FRAME_SKIP,
            max_episode_steps: None,
            size: FrameSize::CLASSIC,
            observation: ObservationKind::Rgb,
            layout: Layout::Hwc,
            frame_stack: 1,
            published_depth: false,
            published_colours: false,
            events: false,
            maps: None,
            map: None,
            assets: None,
        }
    }
}

impl EnvOptions {
    /// Whose action space it is, by rules and hard constraint.
    pub(crate) fn actions_of(&self) -> (RuleSet, bool) {
        self.actions_of.unwrap_or((self.rules, self.hard))
    }

    /// The first option, by name, in which another environment lives otherwise than this; those
    /// that only colour its pictures do not count.
    pub(crate) fn difference(&self, other: &EnvOptions) -> Option<&'static str> {
        let frames = |options: &EnvOptions| {
            (options.size, options.observation, options.layout, options.frame_stack)
        };
        fn place(options: &EnvOptions) -> Option<&std::path::Path> {
            options.maps.as_ref().map(|maps| maps.place())
        }
        [
            ("rules", self.rules == other.rules),
            ("early_creatures", self.early_creatures == other.early_creatures),
            ("test_seeds", self.test_seeds == other.test_seeds),
            ("hard", self.hard == other.hard),
            ("full_actions", self.full_actions == other.full_actions),
            ("frame_skip", self.frame_skip == other.frame_skip),
            ("max_episode_steps", self.max_episode_steps == other.max_episode_steps),
            ("the kind of observation", frames(self) == frames(other)),
            ("the map", self.map == other.map),
            ("the folder of maps", place(self) == place(other)),
        ]
        .into_iter()
        .find_map(|(name, same)| (!same).then_some(name))
    }

    /// What is wrong with the options, if anything.
    pub fn check(&self) -> Result<(), EnvError> {
        let within = |option, given: usize, least: usize, most: usize| {
            let allowed = format!("{least}..={most}");
            let fits = (least..=most).contains(&given);
            if fits {
                Ok(())
            } else {
                Err(EnvError::Option { option, given: given.to_string(), allowed })
            }
        };
        within("frame_skip", self.frame_skip as usize, 1, 35)?;
        within("frame_stack", self.frame_stack, 1, 16)?;
        if let Some(steps) = self.max_episode_steps {
            within("max_episode_steps", steps as usize, 1, u32::MAX as usize)?;
        }
        let allowed = "64x48 to 1920x1080".to_string();
        self.size.check().map_err(|_| EnvError::Option {
            option: "the frame size",
            given: self.size.to_string(),
            allowed,
        })
    }
}
