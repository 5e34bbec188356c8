//! Validated settings made from raw flags.

use crate::args::{EnvArgs, Observation, Rules, Size};
use crate::failure::Failure;
use hasard_engine::assets::Assets;
use hasard_envs::{EnvId, EnvOptions, FrameSize, Layout, ObservationKind, RuleSet};
use hasard_learn::config::EnvConfig;
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
        map: None,
        assets: assets(args.iwad.as_deref())?,
    })
}

/// The environment of a training run from flags, in the words of its `config.json`.
pub fn env_config(id: &str, args: &EnvArgs) -> EnvConfig {
    let mut env = EnvConfig::new(id);
    env.rules = match args.rules {
        Rules::Paper => "paper",
        Rules::Released => "released",
    }
    .into();
    env.observation = match args.observation {
        Observation::Rgb => "rgb",
        Observation::RgbDepth => "rgb+depth",
        Observation::Segmented => "segmented",
        Observation::Grey => "grey",
    }
    .into();
    (env.hard, env.full_actions, env.frame_skip) = (args.hard, args.full_actions, args.frame_skip);
    env.frame_stack = usize::from(args.frame_stack);
    if let Some(size) = args.size {
        env.size = (size.width, size.height);
    }
    env
}

/// Where Debian's package puts Freedoom, for `--iwad auto`.
const FREEDOOM: [&str; 2] = ["/usr/share/games/doom/freedoom2.wad", "/usr/share/games/doom/freedoom1.wad"];

/// Largest IWAD that is read, bytes.
const LARGEST_IWAD: u64 = 256 << 20;

/// The pictures of `--iwad`, or none for the embedded set.
pub fn assets(iwad: Option<&Path>) -> Result<Option<Arc<Assets>>, Failure> {
    let Some(given) = iwad else { return Ok(None) };
    let path = if given == Path::new("auto") {
        FREEDOOM.iter().map(Path::new).find(|path| path.exists()).ok_or_else(|| {
            Failure::bad(format!("--iwad auto: nothing at {}; install Debian's package freedoom, or name a file", FREEDOOM[0]))
        })?
    } else {
        given
    };
    let bytes = hasard_media::files::read_limited(path, LARGEST_IWAD).map_err(Failure::bad)?;
    let assets = Assets::from_iwad(&bytes).map_err(|error| Failure::bad(format!("{}: {error}", path.display())))?;
    Ok(Some(Arc::new(assets)))
}
