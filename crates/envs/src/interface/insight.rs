//! What learners may see of a world beside its picture: never what an agent acts by.

use hasard_engine::world::ActorKind;
use std::ops::Range;

/// Which parts of a world a batch shows beside observations, in a row of bytes a lane: nothing by
/// default.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Insight {
    /// Health, ammunition of the weapon in hand, place, heading and speed: [`STATE`] bytes.
    pub state: bool,
    /// Of each group of things, how much of it is in view, and how near: 2 [`THINGS`] bytes.
    pub in_view: bool,
    /// Mean depth of each cell of a coarse grid over the picture: [`CELLS`] bytes.
    pub depth: bool,
    /// The group of things that each cell shows most of; 0 where it shows none: [`CELLS`] bytes.
    pub labels: bool,
}

/// Bytes of the state: health points; rounds of ammunition; x, y and height between the map's ends;
/// heading, 256 a turn; speed over the ground, a quarter of a map unit a tic; 128 and speed upward,
/// half a map unit a tic.
pub const STATE: usize = 8;
/// Groups of things, numbered from 1: medicine, aids, supplies, light weapons, heavy weapons,
/// creatures that fly, creatures that walk, barrels, missiles, all else.
pub const THINGS: usize = 10;
/// Rows and columns of the grid.
pub const GRID: [usize; 2] = [4, 8];
/// Cells of the grid.
pub const CELLS: usize = GRID[0] * GRID[1];

impl Insight {
    /// Bytes of each part, in the order of a row.
    const fn parts(self) -> [usize; 4] {
        [
            if self.state { STATE } else { 0 },
            if self.in_view { 2 * THINGS } else { 0 },
            if self.depth { CELLS } else { 0 },
            if self.labels { CELLS } else { 0 },
        ]
    }

    /// Bytes of a row.
    #[must_use]
    pub const fn bytes(self) -> usize {
        let [state, in_view, depth, labels] = self.parts();
        state + in_view + depth + labels
    }

    /// Where the state, what is in view, depth and labels lie in a row.
    #[must_use]
    pub fn places(self) -> [Range<usize>; 4] {
        let mut end = 0;
        self.parts().map(|bytes| {
            end += bytes;
            end - bytes..end
        })
    }
}

/// The group that things of a kind belong to, from 1 to [`THINGS`].
#[must_use]
pub const fn thing_group(kind: ActorKind) -> u8 {
    use ActorKind as Kind;
    match kind {
        Kind::HealthBonus | Kind::Stimpack | Kind::Medikit => 1,
        Kind::Infrared | Kind::BlurSphere | Kind::Allmap | Kind::Backpack | Kind::RadSuit => 2,
        Kind::ArmorBonus
        | Kind::RocketAmmo
        | Kind::Shell
        | Kind::Cell
        | Kind::Clip
        | Kind::YellowCard
        | Kind::BlueSkull => 3,
        Kind::Pistol | Kind::Shotgun | Kind::SuperShotgun => 4,
        Kind::Chaingun | Kind::RocketLauncher | Kind::PlasmaRifle | Kind::Bfg9000 => 5,
        Kind::Cacodemon | Kind::LostSoul => 6,
        Kind::ZombieMan
        | Kind::ShotgunGuy
        | Kind::ChaingunGuy
        | Kind::DoomImp
        | Kind::Demon
        | Kind::Revenant => 7,
        Kind::ExplosiveBarrel => 8,
        Kind::Rocket | Kind::PlasmaBall | Kind::BfgBall => 9,
        _ => 10,
    }
}
