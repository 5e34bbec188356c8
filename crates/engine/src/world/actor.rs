//! Actors: every thing that stands, lies, flies or walks in a world.

use crate::math::{Angle, Fixed};

/// What an actor is. Class names are those of the original engine.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[repr(u8)]
#[allow(missing_docs, reason = "the variants are the engine's class names")]
pub enum ActorKind {
    Player,
    // Items.
    HealthBonus,
    Stimpack,
    Medikit,
    ArmorBonus,
    RocketAmmo,
    Shell,
    Cell,
    Clip,
    Infrared,
    BlurSphere,
    Allmap,
    Backpack,
    RadSuit,
    YellowCard,
    BlueSkull,
    Pistol,
    Shotgun,
    SuperShotgun,
    Chaingun,
    RocketLauncher,
    PlasmaRifle,
    Bfg9000,
    // Monsters.
    Cacodemon,
    ZombieMan,
    ShotgunGuy,
    ChaingunGuy,
    DoomImp,
    Demon,
    Revenant,
    LostSoul,
    // Things that burst, fly or fade.
    ExplosiveBarrel,
    Rocket,
    RocketSmokeTrail,
    PlasmaBall,
    BfgBall,
    BulletPuff,
    Blood,
    // Decor.
    TechLamp,
    TechLamp2,
    ShortRedColumn,
    ShortGreenColumn,
    HeartColumn,
    TechPillar,
    TorchTree,
    Stalagtite,
    BigTree,
    Gibs,
    GibbedMarine,
    SmallBloodPool,
    BrainStem,
    // Invisible.
    PatrolPoint,
}

/// Names an actor: its slot and the slot's generation, so that the name of a removed actor never means another.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct ActorId {
    /// Index into `World::actors`.
    pub slot: u16,
    /// Number of actors that used the slot before.
    pub generation: u16,
}

/// One thing. Positions are of the centre of its square footprint, at its feet.
#[derive(Clone, Debug)]
pub struct Actor {
    /// What it is.
    pub kind: ActorKind,
    /// The generation of its slot.
    pub generation: u16,
    /// The slot is free.
    pub removed: bool,
    /// East, map units.
    pub x: Fixed,
    /// North, map units.
    pub y: Fixed,
    /// Height of the feet, map units.
    pub z: Fixed,
    /// Velocity east, map units per tic.
    pub vx: Fixed,
    /// Velocity north, map units per tic.
    pub vy: Fixed,
    /// Velocity up, map units per tic.
    pub vz: Fixed,
    /// Facing.
    pub angle: Angle,
    /// Half the side of the footprint, map units.
    pub radius: Fixed,
    /// Height, map units.
    pub height: Fixed,
    /// Highest floor under the footprint.
    pub floor_z: Fixed,
    /// Lowest ceiling over the footprint.
    pub ceiling_z: Fixed,
    /// Lowest floor under the footprint.
    pub dropoff_z: Fixed,
    /// Sector under the centre.
    pub sector: crate::map::SectorId,
    /// Health points.
    pub health: i32,
    /// Thing id for scripts, 0 for none.
    pub tid: i32,
    /// Index into `sprite::NAMES`-like list of sprite names, see `assets::SPRITE_NAMES`; 255 draws nothing.
    pub sprite: u8,
    /// Frame of the sprite, 0 = `A`.
    pub frame: u8,
    /// Drawn at full brightness whatever the sector's light.
    pub bright: bool,
}
