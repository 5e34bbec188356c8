//! An episode played by a person. Every finished one is kept, as by the window of `hasard play`.

use super::frame::message;
use super::line::{Ask, Line};
use super::query::PlayQuery;
use crate::shared::Shared;
use hasard_play::{Controls, Key, Panel, Recorder, Stage, ViewKind, Views, keep_episode};
use serde_json::json;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// A tic lasts a thirty-fifth of a second.
const TIC: Duration = Duration::from_nanos(1_000_000_000 / 35);

/// Lets a person play until the page is closed.
pub(super) fn play(shared: &Shared, query: &PlayQuery, mut line: Line) {
    let begun = Game::begin(shared, query);
    let why = match begun {
        Ok(mut game) => game.run(&mut line).err().flatten(),
        Err(why) => Some(why),
    };
    if let Some(why) = why {
        let _ = line.say(&json!({ "kind": "error", "why": why }));
    }
}

struct Game {
    folder: PathBuf,
    seed: u64,
    stage: Stage,
    views: Views,
    controls: Controls,
    recorder: Option<Recorder>,
    paused: bool,
    fresh: bool,
}

impl Game {
    fn begin(shared: &Shared, query: &PlayQuery) -> Result<Game, String> {
        let stage = shared.stages.stage(&query.env, &query.options())?;
        let folder = shared.episodes.clone();
        let views = Views::new(&stage, query.size(), &[ViewKind::Colour])
            .map_err(|error| error.to_string())?;
        let controls = Controls::default();
        let mut game = Game {
            folder,
            seed: query.seed,
            stage,
            views,
            controls,
            recorder: None,
            paused: true,
            fresh: true,
        };
        game.restart()?;
        Ok(game)
    }

    fn restart(&mut self) -> Result<(), String> {
        self.stage.reset(self.seed);
        self.recorder = Some(
            Recorder::of(self.stage.env(), self.seed, "human")
                .map_err(|error| error.to_string())?,
        );
        self.controls.release_all();
        self.fresh = true;
        Ok(())
    }

    /// Ends with nothing when the player is gone, or with a reason to show.
    fn run(&mut self, line: &mut Line) -> Result<(), Option<String>> {
        let gone = |()| None;
        let space = self.stage.env().action_space();
        let buttons: Vec<&str> = space
            .groups
            .iter()
            .flat_map(|group| group.buttons.iter().map(|(name, _)| *name))
            .collect();
        let scenario = self.stage.env().id().scenario;
        // What the page does not know by itself: how long an episode is, and a task of one's own.
        line.say(&json!({
            "kind": "scene", "buttons": buttons, "deltas": space.deltas.len(), "seconds": Panel::of(&self.stage, "").whole,
            "title": scenario.title, "summary": scenario.summary,
        }))
        .map_err(gone)?;
        let mut next_tic = Instant::now();
        loop {
            let time = match (self.fresh && line.free(), self.paused || self.stage.ended()) {
                (true, _) => Duration::ZERO,
                (false, true) => Duration::from_secs(60),
                (false, false) => next_tic.saturating_duration_since(Instant::now()),
            };
            let mut ask = line.ask_within(time).map_err(gone)?;
            while let Some(asked) = ask {
                self.answer(&asked)?;
                ask = line.ask_within(Duration::ZERO).map_err(gone)?;
            }
            let now = Instant::now();
            if self.paused || self.stage.ended() {
                next_tic = now;
            } else if now >= next_tic {
                self.tic(line)?;
                next_tic += TIC;
                if now > next_tic + 10 * TIC {
                    next_tic = now;
                }
            }
            if self.fresh && line.free() {
                self.draw(line).map_err(gone)?;
            }
        }
    }

    fn answer(&mut self, ask: &Ask) -> Result<(), String> {
        match ask {
            Ask::Pause => self.paused = true,
            Ask::Go => self.paused = false,
            Ask::Press { key } => {
                Key::of_button(key).into_iter().for_each(|key| self.controls.press(key))
            }
            Ask::Release { key } => {
                Key::of_button(key).into_iter().for_each(|key| self.controls.release(key))
            }
            Ask::Mouse { right, down } if right.is_finite() && down.is_finite() => {
                self.controls.move_mouse(right.clamp(-2000.0, 2000.0), down.clamp(-2000.0, 2000.0));
            }
            Ask::Loose => self.controls.release_all(),
            Ask::Again => self.restart()?,
            Ask::Next => {
                self.seed = self.seed.wrapping_add(1);
                self.restart()?;
            }
            _ => {}
        }
        self.fresh |= matches!(ask, Ask::Pause | Ask::Go | Ask::Again | Ask::Next);
        Ok(())
    }

    fn tic(&mut self, line: &mut Line) -> Result<(), Option<String>> {
        let failed = |error: hasard_play::PlayError| Some(error.to_string());
        if self.stage.wants_action() {
            let env = self.stage.env();
            let (actions, deltas) =
                self.controls.action(env.action_space(), env.options().frame_skip);
            self.stage.act(&actions, &deltas).map_err(failed)?;
            if let Some(recorder) = &mut self.recorder {
                recorder.push(&actions, &deltas).map_err(failed)?;
            }
        }
        self.fresh = true;
        if self.stage.tic().is_some_and(|step| step.ended())
            && let Some(recorder) = self.recorder.take()
        {
            let path = keep_episode(&self.folder, self.stage.env(), self.seed, recorder)
                .map_err(failed)?;
            let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
            line.say(&json!({ "kind": "kept", "name": name })).map_err(|()| None)?;
        }
        Ok(())
    }

    fn draw(&mut self, line: &mut Line) -> Result<(), ()> {
        let panel = Panel::of(&self.stage, "");
        let header = json!({
            "tic": self.stage.world().tic, "seconds": panel.seconds, "return": panel.episode_return, "cost": panel.cost,
            "budget": panel.budget, "paused": self.paused, "ended": self.stage.ended(), "seed": self.seed.to_string(),
        });
        let pictures = self.views.png_files(self.stage.world());
        self.fresh = false;
        line.frame(message(header, &pictures))
    }
}
