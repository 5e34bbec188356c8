//! An episode shown: pause, one tic, speed, jumps to any step.

use super::Performer;
use super::frame::message;
use super::line::{Ask, Line};
use super::query::WatchQuery;
use super::rehearsal::Rehearsal;
use crate::server::Shared;
use hasard_play::{Stage, ViewKind, Views};
use serde_json::json;
use std::time::{Duration, Instant};

/// Tics a second.
const TICS: f64 = 35.0;
/// Time of a tic that acting ahead may take.
const AHEAD: Duration = Duration::from_millis(10);
/// Steps between two tellings of what is known ahead.
const TELL_EVERY: usize = 25;

/// Shows an episode until the viewer is gone.
pub(super) fn show(shared: &Shared, query: &WatchQuery, performer: Performer, mut line: Line) {
    match Show::begin(shared, query, performer) {
        Ok(mut show) => {
            let _ = show.run(&mut line);
        }
        Err(why) => {
            let _ = line.say(&json!({ "kind": "error", "why": why }));
        }
    }
}

struct Show {
    rehearsal: Rehearsal,
    stage: Stage,
    views: Views,
    kinds: Vec<ViewKind>,
    paused: bool,
    speed: f64,
    /// Steps that the viewer was told of.
    told: usize,
    told_over: bool,
    /// The moment has changed since it was drawn.
    fresh: bool,
}

impl Show {
    fn begin(shared: &Shared, query: &WatchQuery, performer: Performer) -> Result<Show, String> {
        let rehearsal = Rehearsal::new(shared, query, performer)?;
        let stage = rehearsal.stage()?;
        let kinds = query.views()?;
        let views = Views::new(&stage, query.size(), &kinds).map_err(|error| error.to_string())?;
        let mut show =
            Show { rehearsal, stage, views, kinds, paused: query.paused, speed: 1.0, told: 0, told_over: false, fresh: true };
        show.jump(query.step as usize);
        Ok(show)
    }

    fn run(&mut self, line: &mut Line) -> Result<(), ()> {
        line.say(&self.rehearsal.scene())?;
        let mut next_tic = Instant::now();
        loop {
            let time = if self.paused || self.ended() {
                // Nothing moves: the thread sleeps until somebody asks, or acts ahead if there is something left.
                if self.told_over { Duration::from_secs(60) } else { Duration::from_millis(1) }
            } else {
                next_tic.saturating_duration_since(Instant::now())
            };
            let time = if self.fresh && line.free() { Duration::ZERO } else { time };
            let mut ask = line.ask_within(time)?;
            while let Some(asked) = ask {
                self.answer(&asked);
                ask = line.ask_within(Duration::ZERO)?;
            }
            self.rehearsal.go_on(AHEAD, usize::MAX);
            self.tell(line)?;
            let now = Instant::now();
            if !self.paused && !self.ended() && now >= next_tic {
                self.tic();
                next_tic += Duration::from_secs_f64(1.0 / (TICS * self.speed));
                // After a stall the show does not run to catch up.
                if now > next_tic + Duration::from_millis(200) {
                    next_tic = now;
                }
            } else if self.paused {
                next_tic = now;
            }
            if self.fresh && line.free() {
                self.draw(line)?;
            }
        }
    }

    fn answer(&mut self, ask: &Ask) {
        match ask {
            Ask::Pause => self.paused = true,
            Ask::Go => {
                if self.ended() {
                    self.jump(0);
                }
                self.paused = false;
            }
            Ask::Tic => {
                self.paused = true;
                self.tic();
            }
            Ask::Speed { value } => self.speed = if value.is_finite() { value.clamp(0.1, 16.0) } else { 1.0 },
            Ask::Jump { step } => self.jump(*step as usize),
            _ => {}
        }
        self.fresh |= !matches!(ask, Ask::Ack);
    }

    fn step(&self) -> usize {
        self.stage.env().episode().length as usize
    }

    fn ended(&self) -> bool {
        self.stage.ended() || self.rehearsal.over() && self.stage.wants_action() && self.step() >= self.rehearsal.steps()
    }

    fn tic(&mut self) {
        if self.ended() {
            return;
        }
        if self.stage.wants_action() {
            let step = self.step();
            self.rehearsal.go_on(Duration::from_secs(1), step + 1);
            match self.rehearsal.command(step) {
                Some(command) => self.stage.press(command),
                None => return,
            }
        }
        self.stage.tic();
        self.fresh = true;
    }

    /// Goes to a step by acting the same again: an episode's worlds without their pictures take some 30 ms.
    fn jump(&mut self, to: usize) {
        self.stage.reset(self.rehearsal.seed);
        while self.step() < to && !self.ended() {
            let before = (self.step(), self.stage.wants_action());
            self.tic();
            if (self.step(), self.stage.wants_action()) == before && before.1 {
                break;
            }
        }
        self.fresh = true;
    }

    /// Tells the viewer what is newly known of the episode.
    fn tell(&mut self, line: &mut Line) -> Result<(), ()> {
        let (steps, over) = (self.rehearsal.steps(), self.rehearsal.over());
        if steps >= self.told + TELL_EVERY || over && !self.told_over {
            line.say(&self.rehearsal.told_from(self.told))?;
            (self.told, self.told_over) = (steps, over);
        }
        Ok(())
    }

    fn draw(&mut self, line: &mut Line) -> Result<(), ()> {
        let mut header = self.rehearsal.moment(self.step());
        header["tic"] = json!(self.stage.world().tic);
        header["paused"] = json!(self.paused);
        header["ended"] = json!(self.ended());
        let pictures = self.views.pictures(self.stage.world());
        let pictures: Vec<_> = self.kinds.iter().copied().zip(pictures).collect();
        self.fresh = false;
        line.frame(message(header, &pictures))
    }
}
