//! Where monsters walk: goals, directions and what makes them turn.

use crate::world::parts::actor::ActorId;
use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;
use crate::world::tables::kinds::ActorKind;

impl World {
    /// The first patrol point with a thing id.
    #[must_use]
    pub fn patrol_point(&self, tid: i32) -> Option<ActorId> {
        self.living()
            .find(|(_, actor)| tid != 0 && actor.kind == ActorKind::PatrolPoint && actor.tid == tid)
            .map(|(id, _)| id)
    }

    /// Sends every living monster with thing id `tid` to the patrol point with thing id `goal_tid`;
    /// to none where there is no such point: it will stand. Scripts' `Thing_SetGoal`.
    pub fn set_goal(&mut self, tid: i32, goal_tid: i32) {
        let goal = self.patrol_point(goal_tid);
        for actor in self.actors.iter_mut().filter(|actor| !actor.removed && actor.tid == tid) {
            if actor.flags.any(ActorFlags::MONSTER) && actor.flags.any(ActorFlags::SHOOTABLE) {
                (actor.goal, actor.pursuing) = (goal, false);
            }
        }
    }

    /// The same for one monster.
    pub fn set_goal_of(&mut self, monster: ActorId, goal: Option<ActorId>) {
        if let Some(actor) = self.get_mut(monster) {
            (actor.goal, actor.pursuing) = (goal, false);
        }
    }
}
