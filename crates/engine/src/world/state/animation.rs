//! Actors pass through the frames of their animations and do what each asks for.

use crate::world::parts::actor::Actor;
use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;
use crate::world::tables::kinds::{ActorKind as K, DamageKind};
use crate::world::tables::states::{ANIMATIONS, Action, Phase, Picture, Then, animation, opacity};

impl World {
    /// Starts the idle animation of a new actor; the end of [`World::spawn`]. Nothing is done on
    /// its first frame.
    pub(in crate::world) fn start_animation(&mut self, slot: usize) {
        let actor = &mut self.actors[slot];
        (actor.phase, actor.step) = (Phase::Idle, 0);
        actor.tics = animation(actor.kind, Phase::Idle).frames[0].tics;
    }

    /// One tic of an actor's animation; called every tic after its move, unless the animation is
    /// timed. May remove it.
    pub(in crate::world) fn tick_animation(&mut self, slot: usize) {
        let actor = &mut self.actors[slot];
        if actor.tics < 0 {
            return;
        }
        actor.tics -= 1;
        if actor.tics > 0 {
            return;
        }
        let animation = animation(actor.kind, actor.phase);
        let next = usize::from(actor.step) + 1;
        if next < animation.frames.len() {
            return self.enter_frame(slot, next as u8);
        }
        match animation.then {
            Then::Loop => self.enter_frame(slot, 0),
            Then::Walk => self.set_phase(slot, Phase::Walk),
            Then::Vanish => self.remove(self.id_of(slot)),
        }
    }

    /// Puts an actor into the first frame of a phase and does what that frame does.
    pub(in crate::world) fn set_phase(&mut self, slot: usize, phase: Phase) {
        self.actors[slot].phase = phase;
        self.wake_slot(slot);
        self.enter_frame(slot, 0);
    }

    pub(in crate::world) fn enter_frame(&mut self, slot: usize, step: u8) {
        let actor = &mut self.actors[slot];
        let frame = &animation(actor.kind, actor.phase).frames[usize::from(step)];
        (actor.step, actor.tics) = (step, frame.tics);
        match frame.action {
            Action::None => {}
            Action::Look => self.look(slot),
            Action::Chase => self.chase(slot),
            Action::StopBlocking => self.actors[slot].flags.set(ActorFlags::SOLID, false),
            Action::Smoke => self.leave_smoke(slot),
            Action::Explode => {
                let (kind, origin) = (actor.kind, actor.origin);
                let by = if kind == K::ExplosiveBarrel {
                    DamageKind::Barrel
                } else {
                    DamageKind::Splash
                };
                self.blast(slot, origin, by);
            }
        }
    }

    /// Takes 0 to 3 tics off an actor's frame, but leaves 1, so that puffs and explosions do not
    /// all look alike.
    pub(in crate::world) fn shorten_frame(&mut self, slot: usize) {
        let cut = (self.rng.byte() & 3) as i16;
        let actor = &mut self.actors[slot];
        actor.tics = (actor.tics - cut).max(1);
    }

    /// Puts an actor into a later frame of its animation.
    pub(in crate::world) fn skip_to_frame(&mut self, slot: usize, step: u8) {
        self.enter_frame(slot, step);
    }
}

impl Actor {
    /// What of the actor is drawn after `tic` completed tics of its world.
    #[must_use]
    pub fn picture(&self, tic: u32) -> Picture {
        let (age, animations) = (tic.wrapping_sub(self.spawn_tic), &ANIMATIONS[self.kind as usize]);
        let frames = animations.by_phase[self.phase as usize].frames;
        let frame = if self.phase == Phase::Idle && animations.idle_is_timed {
            let mut left = match animations.idle_period {
                0 => 0,
                period => (age % period) as i16,
            };
            let mut step = 0;
            while left >= frames[step].tics && frames[step].tics > 0 {
                left -= frames[step].tics;
                step += 1;
            }
            &frames[step]
        } else {
            &frames[usize::from(self.step)]
        };
        Picture {
            sprite: frame.sprite,
            frame: frame.frame,
            bright: frame.bright,
            opacity: opacity(self.kind, self.phase, age),
        }
    }

    /// Name of the actor in label lists: the class name, with `Dead` before it once it is dying.
    #[must_use]
    pub fn label_name(&self) -> &'static str {
        match (self.phase, self.kind) {
            (Phase::Death, K::ExplosiveBarrel) => "DeadExplosiveBarrel",
            (Phase::Death, K::Player) => "DeadDoomPlayer",
            (Phase::Death, K::Cacodemon) => "DeadCacodemon",
            (Phase::Death, K::ZombieMan) => "DeadZombieman",
            (Phase::Death, K::ShotgunGuy) => "DeadShotgunGuy",
            (Phase::Death, K::ChaingunGuy) => "DeadChaingunGuy",
            (Phase::Death, K::DoomImp) => "DeadDoomImp",
            (Phase::Death, K::Demon) => "DeadDemon",
            (Phase::Death, K::Revenant) => "DeadRevenant",
            (Phase::Death, K::LostSoul) => "DeadLostSoul",
            _ => self.kind.class_name(),
        }
    }
}
