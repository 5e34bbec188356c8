//! The worlds behind the object that Python holds, without a word about Python.

use crate::lane::{SharedEnv, lock};
use hasard_engine::render::FrameSize;
use hasard_envs::{
    Batch, Env, EnvError, EnvId, EnvOptions, Environment, LaneState, Mixture, VecEnv, VecOptions,
};
use hasard_play::{ViewKind, Views};
use std::mem::ManuallyDrop;
use std::sync::{Arc, Mutex};

/// A picture: width, height, channels (1 or 3) and its bytes.
pub type Drawn = (usize, usize, usize, Vec<u8>);

/// Worlds, and the environments in them for callers that look at one.
pub struct Inner {
    /// Dropped by hand: a child made by `fork` has none of the threads that its end would wait for.
    worlds: ManuallyDrop<VecEnv>,
    envs: Vec<Arc<Mutex<Env>>>,
    /// Process that the threads run in.
    process: u32,
    threads: usize,
    /// While memory is bound: of each slot (the groups, then all lanes) the batch that writes to
    /// it.
    pub bound: Vec<Option<Batch>>,
    /// Episodes have begun.
    pub started: bool,
    /// What drew the last picture, and what it was asked for.
    views: Option<(ViewKind, FrameSize, Views)>,
}

impl Inner {
    /// Worlds of one task, or of several that the lanes take in turn.
    pub fn new(
        ids: &[EnvId],
        env_options: &EnvOptions,
        options: VecOptions,
    ) -> Result<Inner, EnvError> {
        options.check()?;
        let first = |id: &EnvId| {
            let scenario = Some(id.scenario);
            Env::new(&id.to_string(), &EnvOptions { scenario, ..env_options.clone() })
        };
        let firsts = ids.iter().map(first).collect::<Result<Vec<Env>, _>>()?;
        let mut envs = Vec::with_capacity(options.lanes);
        let mut lane = |task: usize| -> Box<dyn Environment> {
            let lane = SharedEnv::new(firsts[task].sibling());
            envs.push(lane.handle());
            Box::new(lane)
        };
        let worlds = if firsts.len() == 1 {
            VecEnv::from_fn(options, |_| Ok(lane(0)))?
        } else {
            VecEnv::mixed(Mixture::of(&firsts)?, options, |task, _| Ok(lane(task)))?
        };
        let (worlds, process) = (ManuallyDrop::new(worlds), std::process::id());
        Ok(Inner {
            worlds,
            envs,
            process,
            threads: options.threads,
            bound: Vec::new(),
            started: false,
            views: None,
        })
    }

    /// The worlds.
    pub fn worlds(&mut self) -> &mut VecEnv {
        &mut self.worlds
    }

    /// Looks at a lane's environment.
    pub fn look<T>(&self, lane: usize, look: impl FnOnce(&mut Env) -> T) -> T {
        look(&mut lock(&self.envs[lane]))
    }

    /// Where every lane is, as bytes.
    pub fn save(&mut self) -> Result<Vec<u8>, EnvError> {
        Ok(LaneState::to_bytes(&self.worlds.save()?))
    }

    /// Draws a lane's present.
    pub fn draw(
        &mut self,
        lane: usize,
        kind: ViewKind,
        size: FrameSize,
    ) -> Result<Drawn, EnvError> {
        let mut env = lock(&self.envs[lane]);
        // The present may have been drawn without these buffers, or be about to be: drawing changes
        // nothing of it.
        let env = &mut *env;
        if self.views.as_ref().is_none_or(|(of, at, _)| (*of, *at) != (kind, size)) {
            let views = Views::of(env, size, &[kind])
                .map_err(|error| EnvError::Saved { why: error.to_string() })?;
            self.views = Some((kind, size, views));
        }
        let Some((_, _, views)) = &mut self.views else {
            unreachable!("views have just been made")
        };
        let picture = views.pictures(env.world()).swap_remove(0);
        let (width, height, rgb) = (picture.width(), picture.height(), picture.rgb());
        Ok(match kind {
            ViewKind::Depth | ViewKind::Labels | ViewKind::Grey => {
                (width, height, 1, rgb.chunks_exact(3).map(|pixel| pixel[0]).collect())
            }
            ViewKind::Colour | ViewKind::Segmented | ViewKind::Phase | ViewKind::Automap => {
                (width, height, 3, rgb.to_vec())
            }
        })
    }
}

impl Drop for Inner {
    fn drop(&mut self) {
        if self.threads == 0 || self.process == std::process::id() {
            // SAFETY: dropped once, here, and not used any more.
            unsafe { ManuallyDrop::drop(&mut self.worlds) };
        }
    }
}
