//! The rules of a file at work: what happened is looked up in tables, and what they say is done.
//!
//! Long because it is the one interpreter of all that a file can say.

use super::model::{Of, Trigger, When};
use super::placing::move_player;
use super::program::{Occasion, Program};
use super::walkers::{self, Walker};
use crate::scenarios::Rules;
use crate::scenarios::common::outcome::Outcome;
use crate::scenarios::common::stage;
use hasard_engine::math::Fixed;
use hasard_engine::world::{ActorFlags, ActorKind, Buttons, Event, World};
use std::hash::{Hash, Hasher};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// Most events of a tic that are looked at: rules that hurt raise more of them.
const MOST_EVENTS: usize = 10_000;
/// Most changes of counters that are followed in a tic: rules that count by what was counted could
/// go on for ever.
const MOST_CHANGES: usize = 64;

/// Most places that are tried in a tic, and in the first.
const TRIES: u32 = 20_000;
const OPENING_TRIES: u32 = 500_000;

/// A change of a counter that rules may wait for.
#[derive(Clone, Copy, Hash, Debug)]
struct Change {
    counter: u8,
    before: i32,
    after: i32,
    /// By counting, which may come to a number from above; to be set back is no arrival.
    counted: bool,
}

/// The rules at work.
#[derive(Clone, Debug)]
pub(super) struct OwnRules {
    program: Arc<Program>,
    pub counters: Vec<i32>,
    changes: Vec<Change>,
    /// The tic from which each rule may act again.
    ready: Vec<u32>,
    /// Zones that the agent is in, a bit each.
    zones: u32,
    /// Highest place since its feet were on the floor.
    peak: Fixed,
    jumping: bool,
    using: bool,
    /// What comes back, and when.
    pub returns: Vec<(u32, u8)>,
    pub walkers: Vec<Walker>,
    /// Whether a rule has put the agent elsewhere in this tic: once is all, or two zones that send
    /// it to each other would go on for ever.
    moved: bool,
    /// A rule of a policy step has finished the episode, which is left in the next: nothing more
    /// is paid.
    left: bool,
    /// Places that may still be tried in this tic: a file cannot make a tic last for ever.
    pub tries: u32,
    /// Notes what finds no room: for a rehearsal.
    pub unplaced: Option<Arc<Unplaced>>,
}

/// What found no room.
#[derive(Default, Debug)]
pub(super) struct Unplaced {
    /// Spawns, a bit each.
    pub spawns: AtomicU64,
    pub agent: AtomicBool,
}

/// The tables are no part of a fingerprint.
impl Hash for OwnRules {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (
            &self.counters,
            &self.changes,
            &self.ready,
            self.zones,
            self.peak,
            self.jumping,
            self.using,
            self.left,
        )
            .hash(state);
        (&self.returns, &self.walkers).hash(state);
    }
}

impl OwnRules {
    pub fn new(program: Arc<Program>, counters: usize) -> OwnRules {
        OwnRules {
            counters: vec![0; counters],
            changes: Vec::new(),
            ready: vec![0; program.plan.whens.len()],
            zones: 0,
            peak: Fixed::ZERO,
            jumping: false,
            using: false,
            returns: Vec::new(),
            walkers: Vec::new(),
            moved: false,
            left: false,
            tries: TRIES,
            unplaced: None,
            program,
        }
    }

    /// What happened is put before the rules of its kind that `asked` picks.
    fn dispatch(
        &mut self,
        program: &Program,
        occasion: Occasion,
        amount: f64,
        world: &mut World,
        outcome: &mut Outcome,
        asked: impl Fn(Trigger) -> bool,
    ) {
        for (index, when) in program.rules(occasion) {
            if asked(when.trigger) && self.account(program, index, when, amount, world.tic, outcome)
            {
                self.act(program, when, world, outcome);
            }
        }
    }

    /// Rewards, costs and counts of a rule, if its conditions hold: whether they do.
    fn account(
        &mut self,
        program: &Program,
        index: u16,
        when: &When,
        amount: f64,
        tic: u32,
        outcome: &mut Outcome,
    ) -> bool {
        let within = |(counter, [least, most]): &(u8, [i32; 2])| {
            (*least..=*most).contains(&self.counters[usize::from(*counter)])
        };
        let amount = amount - when.over;
        let held = when.conditions.iter().all(within)
            && when.zone.is_none_or(|zone| self.zones >> zone & 1 == 1);
        if !held || amount <= 0.0 || tic < self.ready[usize::from(index)] {
            return false;
        }
        if when.once {
            self.ready[usize::from(index)] = u32::MAX;
        } else if when.cooldown > 0 {
            self.ready[usize::from(index)] = tic + when.cooldown;
        }
        let times = if when.flat { 1.0 } else { amount };
        outcome.reward += when.reward * times;
        for (term, cost) in &when.costs {
            outcome.costs[usize::from(*term)] += cost * times;
            outcome.finished |= *cost > 0.0 && program.plan.end_on >> term & 1 == 1;
        }
        outcome.finished |= when.end;
        for (counter, number) in &when.counts {
            let before = self.counters[usize::from(*counter)];
            self.change(*counter, before.saturating_add(*number), true);
        }
        for (counter, number) in &when.sets {
            self.change(*counter, *number, false);
        }
        true
    }

    fn change(&mut self, counter: u8, after: i32, counted: bool) {
        let before = std::mem::replace(&mut self.counters[usize::from(counter)], after);
        if self.changes.len() < MOST_CHANGES {
            self.changes.push(Change { counter, before, after, counted });
        }
    }

    /// What a rule does to the world.
    fn act(&mut self, program: &Program, when: &When, world: &mut World, outcome: &mut Outcome) {
        if when.hurt > 0 {
            world.damage(
                world.players[0].actor,
                None,
                None,
                when.hurt,
                hasard_engine::world::DamageKind::Script,
            );
        }
        if when.heal > 0 {
            world.heal(0, when.heal, program.plan.player.health.max(100));
        }
        for spawn in &when.spawn {
            self.put(program, *spawn, world);
        }
        for (zone, height, speed) in &when.floors {
            for tag in &program.tags[usize::from(*zone)] {
                // A door that is to close while it opens does, and a floor that swings stops.
                world.stop_floors(*tag);
                world.floor_move_to_value(*tag, *speed, *height);
            }
        }
        for (zone, level) in &when.lights {
            for tag in &program.tags[usize::from(*zone)] {
                world.light_change_to_value(*tag, *level);
            }
        }
        if let Some(place) = when.teleport
            && !std::mem::replace(&mut self.moved, true)
        {
            // Where there is no room it stays.
            let _ =
                move_player(program, place, super::model::Height::Above(0), &mut self.tries, world);
            // A fall is counted from there.
            self.peak = world.get(world.players[0].actor).map_or(self.peak, |body| body.z);
            self.look_around(program, world, outcome);
        }
    }

    /// The rules that wait for counters, in the order in which those changed.
    fn follow_changes(&mut self, program: &Program, world: &mut World, outcome: &mut Outcome) {
        let mut next = 0;
        while next < self.changes.len() {
            let Change { counter, before, after, counted } = self.changes[next];
            next += 1;
            self.dispatch(program, Occasion::Counter, 1.0, world, outcome, |trigger| {
                let Trigger::Counter { counter: of, reaches } = trigger else { return false };
                let risen = before < reaches && after >= reaches;
                of == counter && (risen || counted && before > reaches && after <= reaches)
            });
        }
        self.changes.clear();
    }

    /// Reads what the engine says has happened, from an event on; gives the first that is not read.
    fn read_events(
        &mut self,
        program: &Program,
        from: usize,
        world: &mut World,
        outcome: &mut Outcome,
    ) -> usize {
        let mut next = from;
        while next < world.events.len().min(MOST_EVENTS) {
            let event = world.events[next];
            next += 1;
            let player = world.players[0].actor;
            match event {
                Event::PickedUp { kind, tid, .. } => {
                    self.dispatch(
                        program,
                        Occasion::Pickup,
                        1.0,
                        world,
                        outcome,
                        |trigger| matches!(trigger, Trigger::Pickup(of) if names(of, kind, tid)),
                    );
                    self.bring_back(program, kind, tid, world);
                }
                Event::Hurt { victim, amount, by, .. } if victim == player => {
                    let zones = self.zones;
                    let floor = by == hasard_engine::world::DamageKind::Sector;
                    self.dispatch(
                        program,
                        Occasion::Damage,
                        f64::from(amount),
                        world,
                        outcome,
                        |trigger| match trigger {
                            Trigger::Damage { kinds, zones: of } => {
                                kinds >> (by as u32) & 1 == 1 || (floor && zones & of != 0)
                            }
                            _ => false,
                        },
                    );
                }
                Event::Hurt { victim, amount, source, .. } if source == Some(player) => {
                    let Some((kind, tid)) = world.get(victim).map(|actor| (actor.kind, actor.tid))
                    else {
                        continue;
                    };
                    self.dispatch(
                        program,
                        Occasion::Hit,
                        f64::from(amount),
                        world,
                        outcome,
                        |trigger| matches!(trigger, Trigger::Hit(of) if names(of, kind, tid)),
                    );
                }
                Event::Died { victim, .. } if victim == player => {
                    self.dispatch(program, Occasion::Death, 1.0, world, outcome, |_| true);
                }
                Event::Died { kind, tid, source, .. } => {
                    if source == Some(player) {
                        self.dispatch(
                            program,
                            Occasion::Kill,
                            1.0,
                            world,
                            outcome,
                            |trigger| matches!(trigger, Trigger::Kill(of) if names(of, kind, tid)),
                        );
                    }
                    self.bring_back(program, kind, tid, world);
                }
                Event::Landed { .. } => {
                    let fallen =
                        world.get(player).map_or(0.0, |body| (self.peak - body.z).to_f64());
                    self.dispatch(program, Occasion::Land, fallen, world, outcome, |_| true);
                }
                Event::Fired { .. } => {
                    self.dispatch(program, Occasion::Shot, 1.0, world, outcome, |_| true)
                }
                _ => {}
            }
        }
        next
    }

    /// Reads all events from one on. What the rules did, such as hurt the agent, has happened too.
    fn read_all(
        &mut self,
        program: &Program,
        from: usize,
        world: &mut World,
        outcome: &mut Outcome,
    ) {
        let mut read = from;
        while read < world.events.len().min(MOST_EVENTS) {
            read = self.read_events(program, read, world, outcome);
            self.follow_changes(program, world, outcome);
        }
    }

    /// What was taken or killed comes back, if it is of those that do.
    fn bring_back(&mut self, program: &Program, kind: ActorKind, tid: i32, world: &mut World) {
        let spawn = match tid {
            0 => program.comes_back.iter().find(|(of, _)| *of == kind).map(|(_, spawn)| *spawn),
            _ => u8::try_from(tid - 1)
                .ok()
                .filter(|spawn| usize::from(*spawn) < program.plan.spawns.len()),
        };
        let Some(spawn) = spawn else { return };
        match program.plan.spawns[usize::from(spawn)].respawn {
            Some(0) => drop(self.put(program, spawn, world)),
            Some(tics) => self.returns.push((world.tic + tics, spawn)),
            None => {}
        }
    }

    /// Zones that the agent has come into or left.
    fn look_around(&mut self, program: &Program, world: &mut World, outcome: &mut Outcome) {
        let Some(body) = world.get(world.players[0].actor) else { return };
        let mut zones = program.zones_of[body.sector.0 as usize];
        for (zone, [west, south, east, north]) in &program.rectangles {
            let within = (*west..=*east).contains(&body.x) && (*south..=*north).contains(&body.y);
            zones |= u32::from(within) << zone;
        }
        let before = std::mem::replace(&mut self.zones, zones);
        if before != zones {
            let (come, gone) = (zones & !before, before & !zones);
            self.dispatch(
                program,
                Occasion::Leave,
                1.0,
                world,
                outcome,
                |trigger| matches!(trigger, Trigger::Leave(zone) if gone >> zone & 1 == 1),
            );
            self.dispatch(
                program,
                Occasion::Enter,
                1.0,
                world,
                outcome,
                |trigger| matches!(trigger, Trigger::Enter(zone) if come >> zone & 1 == 1),
            );
        }
    }

    /// What the agent does with its body.
    fn read_player(&mut self, program: &Program, world: &mut World, outcome: &mut Outcome) {
        let player = &world.players[0];
        let (jumping, using) = (player.jump_tics < 0, player.buttons.any(Buttons::USE));
        if jumping && !std::mem::replace(&mut self.jumping, jumping) {
            self.dispatch(program, Occasion::Jump, 1.0, world, outcome, |_| true);
        }
        if using && !std::mem::replace(&mut self.using, using) {
            self.dispatch(program, Occasion::Use, 1.0, world, outcome, |_| true);
        }
        (self.jumping, self.using) = (jumping, using);
        if let Some(body) = world.get(world.players[0].actor) {
            // By the body: the player's own flag stands still while an episode's input does.
            let on_ground = body.z <= body.floor_z || body.flags.any(ActorFlags::ON_ACTOR);
            self.peak = if on_ground { body.z } else { self.peak.max(body.z) };
        }
        if program.has(Occasion::In) {
            let zones = self.zones;
            self.dispatch(
                program,
                Occasion::In,
                1.0,
                world,
                outcome,
                |trigger| matches!(trigger, Trigger::In(zone) if zones >> zone & 1 == 1),
            );
        }
        if program.has(Occasion::Near) {
            self.read_near(program, world, outcome);
        }
    }

    fn read_near(&mut self, program: &Program, world: &mut World, outcome: &mut Outcome) {
        let Some(body) = world.get(world.players[0].actor).copied() else { return };
        for (index, when) in program.rules(Occasion::Near) {
            let Trigger::Near { of, within } = when.trigger else { continue };
            let near = world.living().any(|(id, actor)| {
                let there = names(of, actor.kind, actor.tid) && id != world.players[0].actor;
                let dead = actor.flags.any(ActorFlags::MONSTER) && actor.health <= 0;
                let [dx, dy] =
                    [actor.x - body.x, actor.y - body.y].map(|side| i64::from(side.0 >> 8));
                there
                    && !dead
                    && dx * dx + dy * dy <= i64::from(within << 8) * i64::from(within << 8)
            });
            if near && self.account(program, index, when, 1.0, world.tic, outcome) {
                self.act(program, when, world, outcome);
            }
        }
    }

    /// What is due by the clock: timers, supplies, and what comes back.
    fn read_clock(&mut self, program: &Program, world: &mut World, outcome: &mut Outcome) {
        let tic = world.tic;
        let due = |every: u32, first: u32| match every {
            0 => tic == first,
            _ => tic >= first && (tic - first).is_multiple_of(every),
        };
        if program.has(Occasion::Timer) {
            self.dispatch(
                program,
                Occasion::Timer,
                1.0,
                world,
                outcome,
                |trigger| matches!(trigger, Trigger::Timer { every, first } if due(every, first)),
            );
        }
        for (index, spawn) in program.plan.spawns.iter().enumerate() {
            if spawn.every > 0 && due(spawn.every, spawn.first) {
                let _ = (0..spawn.each)
                    .try_for_each(|_| self.put(program, index as u8, world).map(drop));
            }
        }
        if self.returns.iter().any(|(when, _)| *when <= tic) {
            let back: Vec<u8> = self
                .returns
                .iter()
                .filter(|(when, _)| *when <= tic)
                .map(|(_, spawn)| *spawn)
                .collect();
            self.returns.retain(|(when, _)| *when > tic);
            for spawn in back {
                self.put(program, spawn, world);
            }
        }
    }
}

/// Whether a thing is among those.
fn names(of: Of, kind: ActorKind, tid: i32) -> bool {
    of.kinds >> (kind as u32) & 1 == 1
        || ((1..=64).contains(&tid) && of.spawns >> (tid - 1) & 1 == 1)
}

impl Rules for OwnRules {
    fn prepare(&self, world: &mut World) {
        for (tag, [points, tics]) in &self.program.damages {
            world.set_sector_damage(*tag, *points, *tics, 0);
        }
    }

    fn green_goggles(&self) -> bool {
        self.program.plan.green_goggles
    }

    fn pays_the_opening(&self) -> bool {
        true
    }

    fn script(&mut self, world: &mut World, outcome: &mut Outcome) {
        let program = Arc::clone(&self.program);
        self.tries = if world.tic == 0 { OPENING_TRIES } else { TRIES };
        self.moved = false;
        if world.tic == 0 {
            self.open(&program, world);
            self.look_around(&program, world, outcome);
            self.moved = false;
            self.dispatch(&program, Occasion::Start, 1.0, world, outcome, |_| true);
        }
        let read = self.read_events(&program, 0, world, outcome);
        self.look_around(&program, world, outcome);
        self.read_player(&program, world, outcome);
        self.read_clock(&program, world, outcome);
        self.follow_changes(&program, world, outcome);
        self.read_all(&program, read, world, outcome);
        if program.walkers {
            walkers::lead(&mut self.walkers, &program, world);
        }
    }

    fn last_words(&mut self, world: &mut World, outcome: &mut Outcome) {
        let program = Arc::clone(&self.program);
        self.read_all(&program, 0, world, outcome);
    }

    fn end_step(&mut self, world: &World, _over: bool, outcome: &mut Outcome) {
        if self.program.has(Occasion::Step) && !self.left {
            let finished = outcome.finished;
            let program = Arc::clone(&self.program);
            for (index, when) in program.rules(Occasion::Step) {
                self.account(&program, index, when, 1.0, world.tic, outcome);
            }
            self.left = outcome.finished && !finished;
        }
    }

    fn stats(&self, world: &World, stats: &mut Vec<(&'static str, f64)>) {
        let counted = self.program.names.iter().zip(&self.counters);
        stats.extend(counted.map(|(name, count)| (*name, f64::from(*count))));
        stats.push(("health", f64::from(stage::health(world).max(0))));
    }
}
