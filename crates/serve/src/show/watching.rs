//! An episode shown: pause, one tic, speed, jumps to any step.

use super::frame::message;
use super::line::{Ask, Line};
use super::performer::Performer;
use super::query::WatchQuery;
use super::rehearsal::Rehearsal;
use crate::shared::Shared;
use hasard_play::{Moment, Stage, Views};
use serde_json::json;
use std::time::{Duration, Instant};

/// Tics a second.
const TICS: f64 = 35.0;
/// Time of a tic that acting ahead may take.
const AHEAD: Duration = Duration::from_millis(10);
/// Steps between two messages of what is known ahead.
const SEND_EVERY: usize = 25;
/// Steps between two moments that are kept to come back to: an episode of 525 has 21, and a jump
/// acts out 25 steps at most.
const KEEP_EVERY: usize = 25;
/// Moments that are kept at most, whatever an episode's length.
const MOST_KEPT: usize = 64;

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

struct Show<'a> {
    shared: &'a Shared,
    query: WatchQuery,
    performer: Performer,
    rehearsal: Rehearsal,
    stage: Stage,
    views: Views,
    paused: bool,
    speed: f64,
    /// Moments of the episode that were passed, by their steps, in order.
    kept: Vec<(usize, Moment)>,
    /// Steps that the viewer knows.
    sent: usize,
    sent_over: bool,
    /// The moment has changed since it was drawn.
    fresh: bool,
}

impl<'a> Show<'a> {
    fn begin(
        shared: &'a Shared,
        query: &WatchQuery,
        performer: Performer,
    ) -> Result<Show<'a>, String> {
        let query = query.clone();
        let rehearsal = Rehearsal::new(shared, &query, &performer)?;
        let stage = rehearsal.stage(shared)?;
        let kinds = query.views()?;
        let views = Views::new(&stage, query.size(), &kinds).map_err(|error| error.to_string())?;
        let (paused, step) = (query.paused, query.step as usize);
        let mut show = Show {
            shared,
            query,
            performer,
            rehearsal,
            stage,
            views,
            paused,
            speed: 1.0,
            kept: Vec::new(),
            sent: 0,
            sent_over: false,
            fresh: true,
        };
        show.jump(step);
        Ok(show)
    }

    /// The episode of the next seed. The agent of a run is loaded anew: its newest checkpoint may
    /// be a newer one.
    fn next_episode(&mut self, line: &mut Line) -> Result<(), ()> {
        if let Performer::Recorded(_) = self.performer {
            self.jump(0);
            self.paused = false;
            return Ok(());
        }
        self.query.seed = self.query.seed.wrapping_add(1);
        let begun = Rehearsal::new(self.shared, &self.query, &self.performer);
        let begun = begun.and_then(|rehearsal| Ok((rehearsal.stage(self.shared)?, rehearsal)));
        match begun {
            Ok((stage, rehearsal)) => (self.stage, self.rehearsal) = (stage, rehearsal),
            Err(why) => {
                line.say(&json!({ "kind": "error", "why": why }))?;
                return Err(());
            }
        }
        self.kept.clear();
        (self.sent, self.sent_over, self.paused, self.fresh) = (0, false, false, true);
        line.say(&self.rehearsal.scene())
    }

    fn run(&mut self, line: &mut Line) -> Result<(), ()> {
        line.say(&self.rehearsal.scene())?;
        let mut next_tic = Instant::now();
        loop {
            let time = if self.paused || self.ended() {
                // Nothing moves: the thread sleeps until somebody asks, or acts ahead if there is
                // something left.
                if self.sent_over { Duration::from_secs(60) } else { Duration::from_millis(1) }
            } else {
                next_tic.saturating_duration_since(Instant::now())
            };
            let time = if self.fresh && line.free() { Duration::ZERO } else { time };
            let mut ask = line.ask_within(time)?;
            while let Some(asked) = ask {
                if let Ask::Next = asked {
                    self.next_episode(line)?;
                } else {
                    self.answer(&asked);
                }
                ask = line.ask_within(Duration::ZERO)?;
            }
            self.rehearsal.go_on(AHEAD, usize::MAX);
            self.send(line)?;
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
            Ask::Speed { value } => {
                self.speed = if value.is_finite() { value.clamp(0.1, 16.0) } else { 1.0 }
            }
            Ask::Jump { step } => self.jump(*step as usize),
            _ => {}
        }
        self.fresh |= !matches!(ask, Ask::Ack);
    }

    fn step(&self) -> usize {
        self.stage.env().episode().length as usize
    }

    fn ended(&self) -> bool {
        self.stage.ended()
            || self.rehearsal.over()
                && self.stage.wants_action()
                && self.step() >= self.rehearsal.steps()
    }

    fn tic(&mut self) {
        if self.ended() {
            return;
        }
        if self.stage.wants_action() {
            let step = self.step();
            if step.is_multiple_of(KEEP_EVERY)
                && self.kept.len() < MOST_KEPT
                && self.kept.last().is_none_or(|(last, _)| *last < step)
            {
                self.kept.push((step, self.stage.moment()));
            }
            self.rehearsal.go_on(Duration::from_secs(1), step + 1);
            match self.rehearsal.command(step) {
                Some(command) => self.stage.press(command),
                None => return,
            }
        }
        self.stage.tic();
        self.fresh = true;
    }

    /// Goes to a step: back to the last moment kept before it, and from there by acting the same
    /// again.
    fn jump(&mut self, to: usize) {
        let from = self.kept.iter().rev().find(|(step, _)| *step <= to);
        // From here on, if this is nearer.
        let near = self.stage.wants_action()
            && self.step() <= to
            && from.is_none_or(|(step, _)| *step <= self.step());
        if !near && from.is_none_or(|(_, moment)| self.stage.come_back(moment).is_err()) {
            self.stage.reset(self.rehearsal.seed);
        }
        while self.step() < to && !self.ended() {
            let before = (self.step(), self.stage.wants_action());
            self.tic();
            if (self.step(), self.stage.wants_action()) == before && before.1 {
                break;
            }
        }
        self.fresh = true;
    }

    /// Sends the viewer what is newly known of the episode.
    fn send(&mut self, line: &mut Line) -> Result<(), ()> {
        let (steps, over) = (self.rehearsal.steps(), self.rehearsal.over());
        if steps >= self.sent + SEND_EVERY || over && !self.sent_over {
            line.say(&self.rehearsal.known_from(self.sent))?;
            (self.sent, self.sent_over) = (steps, over);
        }
        Ok(())
    }

    fn draw(&mut self, line: &mut Line) -> Result<(), ()> {
        let mut header = self.rehearsal.moment(self.step());
        header["tic"] = json!(self.stage.world().tic);
        header["paused"] = json!(self.paused);
        header["ended"] = json!(self.ended());
        let pictures = self.views.png_files(self.stage.world());
        self.fresh = false;
        line.frame(message(header, &pictures))
    }
}
