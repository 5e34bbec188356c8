//! Which actors touch which moving sector, so that a sector that moves under nobody costs nothing
//! more.

use crate::map::SectorId;
use crate::math::Fixed;
use crate::world::parts::actor::NO_BLOCK;
use crate::world::parts::riders::Footing;
use crate::world::parts::riders::Moved;
use crate::world::parts::riders::for_each_sector_under;

use crate::world::parts::sector::Busy;
use crate::world::state::world::World;

impl World {
    /// An actor has moved, or is in no block any more.
    pub(crate) fn forget_footing(&mut self, slot: usize) {
        if let Some(footing) = self.footings.get_mut(slot) {
            let listed = std::mem::replace(footing, Footing::UNKNOWN);
            self.riders.forget(slot as u16, listed);
        }
    }

    /// Lists the actors that touch a busy sector. Actors keep their places while movers run, so
    /// that the lists stay true.
    pub(crate) fn list_riders(&mut self) {
        let swings = self.movers.swings_made();
        // While planes move, which sectors are busy changes; swings come and go together.
        if self.movers.move_planes()
            || self.footings.len() != self.actors.len()
            || self.riders.made_for != Some(swings)
        {
            return self.list_all_riders(swings);
        }
        for at in 0..self.riders.moved.len() {
            let Moved { slot, listed } = self.riders.moved[at];
            for &sector in &listed.sectors[..usize::from(listed.count)] {
                if let Some(mover) = self.movers.swing_of(SectorId(u32::from(sector))) {
                    self.riders.take(usize::from(sector), slot, mover);
                }
            }
            self.list_rider(usize::from(slot));
        }
        self.riders.moved.clear();
    }

    fn list_all_riders(&mut self, swings: u32) {
        self.riders.clear(self.sectors.len());
        self.riders.made_for = Some(swings);
        self.footings.resize(self.actors.len(), Footing::UNKNOWN);
        for slot in 0..self.actors.len() {
            self.list_rider(slot);
        }
    }

    /// Enters an actor into the lists of the busy sectors under it.
    fn list_rider(&mut self, slot: usize) {
        let World { riders, footings, sectors, actors, map, movers, .. } = self;
        let footing = &mut footings[slot];
        // Only what is in a block has a known footing: most actors need not be looked at.
        if footing.count == 0 {
            let actor = &actors[slot];
            if actor.removed || actor.block == NO_BLOCK {
                return;
            }
            *footing = Footing::of(map, actor);
        }
        // The short list of swings first: the sectors of a whole world would come into the cache
        // for a bit each.
        let planes = movers.move_planes();
        let mut add = |sector: usize| {
            let mover = movers.swing_of(SectorId(sector as u32));
            if mover.is_some() || (planes && sectors[sector].busy.any(Busy::PLANES)) {
                riders.add(sector, slot as u16, mover);
            }
        };
        let Footing { count, sectors: under } = *footing;
        under[..usize::from(count)].iter().for_each(|&sector| add(usize::from(sector)));
        if count == 0 {
            for_each_sector_under(map, &actors[slot], |sector| add(sector.0 as usize));
            riders.made_for = None;
        }
    }

    /// The highest floor, lowest ceiling and lowest floor under an actor whose footing is known, as
    /// they are now.
    pub(crate) fn planes_under(&self, slot: usize) -> Option<(Fixed, Fixed, Fixed)> {
        let Footing { count, sectors } = self.footings[slot];
        let planes = sectors[..usize::from(count)].iter().map(|&sector| {
            let floor = self.floor_of(SectorId(u32::from(sector)));
            (floor, self.sectors[usize::from(sector)].ceiling, floor)
        });
        planes.reduce(|a, b| (a.0.max(b.0), a.1.min(b.1), a.2.min(b.2)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Map, MapBuilder, Style, TileGrid};
    use crate::math::Rng;
    use crate::world::monsters::patrol_tests::STYLE;
    use crate::world::parts::command::{Buttons, Command};
    use crate::world::tables::kinds::ActorKind;
    use std::sync::Arc;

    /// A hall of tiles with tags from 1.
    fn hall() -> World {
        let tag = |column, row| (row * 6 + column) as i32 + 1;
        let grid =
            TileGrid::new((0, 0), 64, 6, 4, |column, row| Style { tag: tag(column, row), ..STYLE });
        let mut builder = MapBuilder::new();
        grid.paint(&mut builder);
        builder.thing(1, 96.0, 96.0, 0);
        World::new(Arc::new(Map::build(&builder.finish().unwrap(), "hall", &[]).unwrap()), 5)
    }

    /// The slots on each sector, and the movers that are ridden.
    fn lists(world: &World) -> (Vec<Vec<usize>>, Vec<u32>) {
        let of_sector = |sector: u32| {
            let mut next = world.riders.first(SectorId(sector));
            std::iter::from_fn(|| {
                let (slot, following) = world.riders.entry(next?);
                next = following;
                Some(slot)
            })
            .collect()
        };
        ((0..world.sectors.len() as u32).map(of_sector).collect(), world.riders.ridden.clone())
    }

    /// A tic in which something or other may happen first.
    fn disturb(world: &mut World, rng: &mut Rng, tic: u32) {
        let (x, y) = (Fixed::from_int(rng.between(20, 360)), Fixed::from_int(rng.between(20, 230)));
        match rng.below(60) {
            0 => world.floor_waggle(
                rng.between(1, 24),
                64,
                64,
                rng.between(0, 63),
                rng.between(0, 2),
            ),
            1 => world.stop_floors(rng.between(1, 24)),
            2 => world.floor_lower_by_value(
                rng.between(1, 24),
                rng.between(1, 64),
                rng.between(-8, 40),
            ),
            3..8 => _ = world.spawn(ActorKind::ArmorBonus, x, y, Fixed::ZERO),
            8 => _ = world.set_position(world.players[0].actor, x, y, Fixed::from_int(40)),
            9..14 => {
                let any = world
                    .living()
                    .map(|(id, _)| id)
                    .filter(|&id| id != world.players[0].actor)
                    .last();
                any.into_iter().for_each(|id| world.remove(id));
            }
            _ => {}
        }
        let buttons =
            if tic % 40 < 20 { Buttons::MOVE_FORWARD | Buttons::SPEED } else { Buttons::TURN_LEFT };
        world.run_thinkers(&[Command { buttons, ..Command::default() }]);
        world.finish_tic();
    }

    #[test]
    fn movers_run_when_needed_do_what_movers_run_always_do() {
        let (mut world, mut always, mut rng) = (hall(), hall(), Rng::new(8));
        let mut lagging = 0;
        for tic in 0..4000 {
            always.movers.run_all_next();
            disturb(&mut always, &mut rng.clone(), tic);
            disturb(&mut world, &mut rng, tic);
            lagging += (0..world.movers.list.len())
                .filter(|&index| world.movers.ahead(index).is_some())
                .count();
            assert_eq!(world.state_hash(), always.state_hash(), "tic {tic}");
        }
        assert!(lagging > 1000, "{lagging} floors lagged behind");
    }

    #[test]
    fn lists_that_are_kept_are_those_made_anew() {
        let (mut world, mut rng) = (hall(), Rng::new(6));
        let mut kept = 0;
        for tic in 0..2000 {
            disturb(&mut world, &mut rng, tic);
            kept += u32::from(world.riders.made_for == Some(world.movers.swings_made()));
            let mut anew = world.clone();
            world.list_riders();
            anew.list_riders();
            assert_eq!(lists(&world), lists(&anew), "tic {tic}");
        }
        assert!((500..2000).contains(&kept), "{kept} times lists were kept");
    }
}
