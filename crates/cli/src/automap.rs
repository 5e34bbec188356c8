//! The pictures of the map from above that a run's heatmaps lie on.

use crate::failure::Failure;
use hasard_envs::{Env, EnvOptions};
use hasard_learn::config::TrainConfig;
use hasard_media::Picture;
use std::path::Path;

/// Pixels of the longer side.
const SIDE: usize = 720;

/// Draws those of a run's lessons that its directory lacks.
pub fn keep(config: &TrainConfig, options: &EnvOptions, directory: &Path) -> Result<(), Failure> {
    // The places of different maps have no map together.
    if config.env.is_mixed() {
        return Ok(());
    }
    for lesson in 0..config.lessons() {
        let path = directory.join(config.automap(lesson));
        if path.exists() {
            continue;
        }
        let env = Env::new(&config.lesson(lesson).env.id, options).map_err(Failure::bad)?;
        let (map, width, height) = env.top_down_of_extent(SIDE);
        let mut bytes = vec![0; width * height * 3];
        map.draw(env.world(), &mut bytes);
        let picture = Picture::from_rgb(width, height, bytes).map_err(Failure::bad)?;
        hasard_media::png::write(&picture, &path).map_err(Failure::bad)?;
    }
    Ok(())
}
