//! Monsters on their way: to random places, after the agent, or from zone to zone.

use super::model::{Goal, Height, Place};
use super::placing::{body, drawn_place};
use super::program::Program;
use hasard_engine::world::{ActorId, ActorKind, World};

/// Tics between two looks at a monster.
const LOOK_TICS: u32 = 8;
/// Who has not arrived after so many tics sets out for another place.
const PATIENCE_TICS: u32 = 350;

/// A monster on its way.
#[derive(Clone, Hash, Debug)]
pub(super) struct Walker {
    who: ActorId,
    spawn: u8,
    /// The point that it walks to, where that is no body.
    point: Option<ActorId>,
    /// How far it is on its patrol.
    stage: u8,
    /// When it gives up.
    until: u32,
}

/// Sends those on who have arrived or given up, and forgets the dead.
pub(super) fn lead(walkers: &mut Vec<Walker>, program: &Program, world: &mut World) {
    if !world.tic.is_multiple_of(LOOK_TICS) {
        return;
    }
    walkers.retain_mut(|walker| {
        let Some(actor) = world.get(walker.who).filter(|actor| actor.health > 0) else {
            walker.point.into_iter().for_each(|point| world.remove(point));
            return false;
        };
        if actor.goal.is_none() || world.tic >= walker.until {
            walker.choose(program, world);
        }
        true
    });
}

impl Walker {
    /// A new monster, which will set out.
    pub(super) fn new(who: ActorId, spawn: u8) -> Walker {
        Walker { who, spawn, point: None, stage: 0, until: 0 }
    }

    /// Sets out for the next goal.
    fn choose(&mut self, program: &Program, world: &mut World) {
        let place = match &program.plan.spawns[usize::from(self.spawn)].goal {
            Goal::None => return,
            Goal::Chase => {
                let agent = body(world);
                world.set_goal_of(self.who, Some(agent));
                self.until = world.tic + PATIENCE_TICS;
                return;
            }
            Goal::Wander => program.plan.spawns[usize::from(self.spawn)].place,
            Goal::Patrol(zones) => {
                let zone = zones[usize::from(self.stage) % zones.len()];
                self.stage = ((usize::from(self.stage) + 1) % zones.len()) as u8;
                Place::Zone(zone)
            }
        };
        let found =
            (0..20).find_map(|_| drawn_place(program, place, Height::Above(0), false, world));
        let Some([x, y, z]) = found else { return };
        if let Some(old) = self.point.take() {
            world.remove(old);
        }
        let point = world.spawn(ActorKind::PatrolPoint, x, y, z);
        self.point = Some(point);
        world.set_goal_of(self.who, Some(point));
        self.until = world.tic + PATIENCE_TICS;
    }
}
