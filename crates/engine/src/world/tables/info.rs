//! What every kind of actor is: its body, its strength, what it stops and what stops it.
//!
//! The figures are facts of the original engine; one table, so that a question such as "how high is
//! a barrel" has one answer for movement, rendering and rules alike.

use crate::math::Fixed;
use crate::world::tables::kinds::{ActorKind, Weapon};

/// Properties of an actor, a bit each. Every actor starts with those of its kind; death and scripts
/// change them.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default, Debug)]
pub struct ActorFlags(pub u16);

impl ActorFlags {
    /// Nothing.
    pub const NONE: ActorFlags = ActorFlags(0);
    /// Stops other solid actors.
    pub const SOLID: ActorFlags = ActorFlags(1);
    /// Can be hit, hurt and aimed at.
    pub const SHOOTABLE: ActorFlags = ActorFlags(1 << 1);
    /// Is taken by players who touch it.
    pub const ITEM: ActorFlags = ActorFlags(1 << 2);
    /// Does not fall.
    pub const NO_GRAVITY: ActorFlags = ActorFlags(1 << 3);
    /// Changes height by itself when a step blocks it.
    pub const FLOAT: ActorFlags = ActorFlags(1 << 4);
    /// Explodes on whatever stops it; neither climbs steps nor slows down.
    pub const MISSILE: ActorFlags = ActorFlags(1 << 5);
    /// May walk over a ledge of any height.
    pub const DROP_OFF: ActorFlags = ActorFlags(1 << 6);
    /// Walks by itself and counts as a kill.
    pub const MONSTER: ActorFlags = ActorFlags(1 << 7);
    /// Bullets raise a puff and no blood.
    pub const NO_BLOOD: ActorFlags = ActorFlags(1 << 8);
    /// Is never tested against anything: puffs, smoke, decor without a body.
    pub const NO_INTERACTION: ActorFlags = ActorFlags(1 << 9);
    /// Is a player's body.
    pub const PLAYER: ActorFlags = ActorFlags(1 << 10);
    /// Blasts hurt it, and it hurts by blast, by the older rule in whole units without height
    /// (barrels).
    pub const OLD_BLAST: ActorFlags = ActorFlags(1 << 11);
    /// Takes no damage; is still pushed.
    pub const INVULNERABLE: ActorFlags = ActorFlags(1 << 12);
    /// Was left by a monster: gives half the ammunition.
    pub const DROPPED: ActorFlags = ActorFlags(1 << 13);
    /// Stands on another actor rather than on the floor.
    pub const ON_ACTOR: ActorFlags = ActorFlags(1 << 14);

    /// Whether any of `other` is set.
    #[must_use]
    pub const fn any(self, other: ActorFlags) -> bool {
        self.0 & other.0 != 0
    }

    /// Both.
    #[must_use]
    pub const fn with(self, other: ActorFlags) -> ActorFlags {
        ActorFlags(self.0 | other.0)
    }

    /// Without those of `other`.
    #[must_use]
    pub const fn without(self, other: ActorFlags) -> ActorFlags {
        ActorFlags(self.0 & !other.0)
    }

    /// Sets or clears those of `other`.
    pub const fn set(&mut self, other: ActorFlags, on: bool) {
        *self = if on { self.with(other) } else { self.without(other) };
    }
}

/// The fixed properties of a kind of actor.
#[derive(Clone, Copy, Debug)]
pub struct ActorInfo {
    /// The kind that this row describes.
    pub kind: ActorKind,
    /// Class name of the original engine, as labels and scripts use it.
    pub class_name: &'static str,
    /// Editor number of a map thing, 0 where maps cannot place it.
    pub editor_number: i32,
    /// Half the side of the footprint, whole map units.
    pub radius: i32,
    /// Height, whole map units.
    pub height: i32,
    /// Health points at the start.
    pub health: i32,
    /// Mass; thrust is divided by it.
    pub mass: i32,
    /// Map units per step (monsters) or per tic (missiles).
    pub speed: i32,
    /// Chance in 256 that a hit is felt.
    pub pain_chance: i32,
    /// Damage of a direct hit, times 1 to 8 (missiles).
    pub damage: i32,
    /// Flags at the start.
    pub flags: ActorFlags,
}

const ITEM: ActorFlags = ActorFlags::ITEM;
const GHOST: ActorFlags = ActorFlags::NO_INTERACTION.with(ActorFlags::NO_GRAVITY);
const WALKER: ActorFlags = ActorFlags::SOLID.with(ActorFlags::SHOOTABLE).with(ActorFlags::MONSTER);
const FLOATER: ActorFlags = WALKER.with(ActorFlags::FLOAT).with(ActorFlags::NO_GRAVITY);
const MISSILE: ActorFlags =
    ActorFlags::MISSILE.with(ActorFlags::NO_GRAVITY).with(ActorFlags::DROP_OFF);
const PLAYER: ActorFlags = ActorFlags::SOLID
    .with(ActorFlags::SHOOTABLE)
    .with(ActorFlags::PLAYER)
    .with(ActorFlags::DROP_OFF);
const BARREL: ActorFlags = ActorFlags::SOLID
    .with(ActorFlags::SHOOTABLE)
    .with(ActorFlags::NO_BLOOD)
    .with(ActorFlags::OLD_BLAST);

/// A row with everything that most kinds share: no editor number, 100 mass, harmless.
const fn row(
    kind: ActorKind,
    class_name: &'static str,
    radius: i32,
    height: i32,
    flags: ActorFlags,
) -> ActorInfo {
    ActorInfo {
        kind,
        class_name,
        editor_number: 0,
        radius,
        height,
        health: 1000,
        mass: 100,
        speed: 0,
        pain_chance: 0,
        damage: 0,
        flags,
    }
}

const fn item(kind: ActorKind, class_name: &'static str, editor_number: i32) -> ActorInfo {
    ActorInfo { editor_number, ..row(kind, class_name, 20, 16, ITEM) }
}

const fn decor(
    kind: ActorKind,
    class_name: &'static str,
    editor_number: i32,
    radius: i32,
    height: i32,
) -> ActorInfo {
    ActorInfo { editor_number, ..row(kind, class_name, radius, height, ActorFlags::SOLID) }
}

/// Remains on the floor: no body that anything could touch.
const fn remains(kind: ActorKind, class_name: &'static str, editor_number: i32) -> ActorInfo {
    ActorInfo { editor_number, ..row(kind, class_name, 20, 16, ActorFlags::NO_INTERACTION) }
}

/// Body and strength of a monster; the flags say whether it walks or floats.
#[allow(
    clippy::too_many_arguments,
    reason = "a table row: the columns are those of the original's documentation"
)]
const fn monster(
    kind: ActorKind,
    class_name: &'static str,
    editor_number: i32,
    radius: i32,
    health: i32,
    mass: i32,
    pain_chance: i32,
    speed: i32,
    flags: ActorFlags,
) -> ActorInfo {
    ActorInfo {
        editor_number,
        health,
        mass,
        speed,
        pain_chance,
        ..row(kind, class_name, radius, 56, flags)
    }
}

const fn missile(
    kind: ActorKind,
    class_name: &'static str,
    radius: i32,
    height: i32,
    speed: i32,
    damage: i32,
) -> ActorInfo {
    ActorInfo { speed, damage, ..row(kind, class_name, radius, height, MISSILE) }
}

use ActorKind as K;

/// One row a kind, in the order of [`ActorKind`].
const INFO: [ActorInfo; ActorKind::COUNT] = [
    ActorInfo {
        editor_number: 1,
        health: 100,
        pain_chance: 255,
        ..row(K::Player, "DoomPlayer", 16, 56, PLAYER)
    },
    item(K::HealthBonus, "HealthBonus", 2014),
    item(K::Stimpack, "Stimpack", 2011),
    item(K::Medikit, "Medikit", 2012),
    item(K::ArmorBonus, "ArmorBonus", 2015),
    item(K::RocketAmmo, "RocketAmmo", 2010),
    item(K::Shell, "Shell", 2008),
    item(K::Cell, "Cell", 2047),
    item(K::Clip, "Clip", 2007),
    item(K::Infrared, "Infrared", 2045),
    item(K::BlurSphere, "BlurSphere", 2024),
    item(K::Allmap, "Allmap", 2026),
    ActorInfo { height: 26, ..item(K::Backpack, "Backpack", 8) },
    ActorInfo { height: 46, ..item(K::RadSuit, "RadSuit", 2025) },
    item(K::YellowCard, "YellowCard", 6),
    item(K::BlueSkull, "BlueSkull", 40),
    item(K::Pistol, "Pistol", 5010),
    item(K::Shotgun, "Shotgun", 2001),
    item(K::SuperShotgun, "SuperShotgun", 82),
    item(K::Chaingun, "Chaingun", 2002),
    item(K::RocketLauncher, "RocketLauncher", 2003),
    item(K::PlasmaRifle, "PlasmaRifle", 2004),
    item(K::Bfg9000, "BFG9000", 2006),
    monster(K::Cacodemon, "Cacodemon", 3005, 31, 400, 400, 128, 8, FLOATER),
    monster(K::ZombieMan, "Zombieman", 3004, 20, 20, 100, 200, 8, WALKER),
    monster(K::ShotgunGuy, "ShotgunGuy", 9, 20, 30, 100, 170, 8, WALKER),
    monster(K::ChaingunGuy, "ChaingunGuy", 65, 20, 70, 100, 170, 8, WALKER),
    monster(K::DoomImp, "DoomImp", 3001, 20, 60, 100, 200, 8, WALKER),
    monster(K::Demon, "Demon", 3002, 30, 150, 400, 180, 10, WALKER),
    monster(K::Revenant, "Revenant", 66, 20, 300, 500, 100, 10, WALKER),
    monster(K::LostSoul, "LostSoul", 3006, 16, 100, 50, 256, 8, FLOATER.with(ActorFlags::NO_BLOOD)),
    ActorInfo {
        health: 20,
        editor_number: 2035,
        ..row(K::ExplosiveBarrel, "ExplosiveBarrel", 10, 42, BARREL)
    },
    missile(K::Rocket, "Rocket", 11, 8, 20, 20),
    row(K::RocketSmokeTrail, "RocketSmokeTrail", 20, 16, GHOST),
    missile(K::PlasmaBall, "PlasmaBall", 13, 8, 25, 5),
    missile(K::BfgBall, "BFGBall", 13, 8, 25, 100),
    row(K::BulletPuff, "BulletPuff", 20, 16, GHOST),
    row(K::Blood, "Blood", 20, 16, ActorFlags::NO_INTERACTION),
    decor(K::TechLamp, "TechLamp", 85, 16, 80),
    decor(K::TechLamp2, "TechLamp2", 86, 16, 60),
    decor(K::ShortRedColumn, "ShortRedColumn", 33, 16, 40),
    decor(K::ShortGreenColumn, "ShortGreenColumn", 31, 16, 40),
    decor(K::HeartColumn, "HeartColumn", 36, 16, 40),
    decor(K::TechPillar, "TechPillar", 48, 16, 128),
    decor(K::TorchTree, "TorchTree", 43, 16, 56),
    decor(K::Stalagtite, "Stalagtite", 47, 16, 40),
    decor(K::BigTree, "BigTree", 54, 32, 108),
    remains(K::Gibs, "Gibs", 24),
    remains(K::GibbedMarine, "GibbedMarine", 10),
    remains(K::SmallBloodPool, "SmallBloodPool", 80),
    remains(K::BrainStem, "BrainStem", 81),
    ActorInfo { editor_number: 9024, ..row(K::PatrolPoint, "PatrolPoint", 8, 8, GHOST) },
    remains(K::DeadMarine, "DeadMarine", 15),
    remains(K::DeadZombieMan, "DeadZombieMan", 18),
    remains(K::DeadShotgunGuy, "DeadShotgunGuy", 19),
    remains(K::Candlestick, "Candlestick", 34),
    decor(K::ShortBlueTorch, "ShortBlueTorch", 55, 16, 37),
    decor(K::ShortGreenTorch, "ShortGreenTorch", 56, 16, 37),
    decor(K::ShortRedTorch, "ShortRedTorch", 57, 16, 37),
    remains(K::ColonGibs, "ColonGibs", 79),
    remains(K::BurningTop, "burning_top", 27001),
    remains(K::BurningDebris, "burning_debris", 27002),
];

/// The kinds by number, where a constant is needed.
pub(in crate::world) const fn kinds() -> [ActorKind; ActorKind::COUNT] {
    let mut kinds = [K::Player; ActorKind::COUNT];
    let mut i = 0;
    while i < kinds.len() {
        kinds[i] = INFO[i].kind;
        i += 1;
    }
    kinds
}

impl ActorKind {
    /// Number of kinds.
    pub const COUNT: usize = ActorKind::BurningDebris as usize + 1;

    /// The fixed properties of the kind.
    #[must_use]
    pub fn info(self) -> &'static ActorInfo {
        &INFO[self as usize]
    }

    /// Every kind, in order.
    pub fn all() -> impl Iterator<Item = ActorKind> {
        INFO.iter().map(|info| info.kind)
    }

    /// Class name of the original engine, as labels and scripts use it.
    #[must_use]
    pub fn class_name(self) -> &'static str {
        self.info().class_name
    }

    /// The kind of a class name, whatever its case (scripts write `ZombieMan`, labels `Zombieman`).
    #[must_use]
    pub fn from_class_name(name: &str) -> Option<ActorKind> {
        INFO.iter().find(|info| info.class_name.eq_ignore_ascii_case(name)).map(|info| info.kind)
    }

    /// The kind that a map thing with an editor number is.
    #[must_use]
    pub fn from_editor_number(number: i32) -> Option<ActorKind> {
        INFO.iter().find(|info| number != 0 && info.editor_number == number).map(|info| info.kind)
    }

    /// Half the side of the footprint.
    #[must_use]
    pub fn radius(self) -> Fixed {
        Fixed::from_int(self.info().radius)
    }

    /// Height.
    #[must_use]
    pub fn height(self) -> Fixed {
        Fixed::from_int(self.info().height)
    }

    /// The weapon that an item of this kind is.
    #[must_use]
    pub fn weapon(self) -> Option<Weapon> {
        Some(match self {
            K::Pistol => Weapon::Pistol,
            K::Shotgun => Weapon::Shotgun,
            K::SuperShotgun => Weapon::SuperShotgun,
            K::Chaingun => Weapon::Chaingun,
            K::RocketLauncher => Weapon::RocketLauncher,
            K::PlasmaRifle => Weapon::PlasmaRifle,
            K::Bfg9000 => Weapon::Bfg9000,
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_kinds() {
        for (i, info) in INFO.iter().enumerate() {
            assert_eq!(info.kind as usize, i, "{}", info.class_name);
            assert_eq!(ActorKind::from_class_name(info.class_name), Some(info.kind));
            if info.editor_number != 0 {
                assert_eq!(ActorKind::from_editor_number(info.editor_number), Some(info.kind));
            }
        }
        assert_eq!(ActorKind::from_class_name("ZombieMan"), Some(ActorKind::ZombieMan));
        assert_eq!(ActorKind::from_editor_number(0), None);
    }
}
