//! The kinds of things, weapons and damage by name.

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
    // Decor of the published maps that nothing else knows.
    DeadMarine,
    DeadZombieMan,
    DeadShotgunGuy,
    Candlestick,
    ShortBlueTorch,
    ShortGreenTorch,
    ShortRedTorch,
    ColonGibs,
    BurningTop,
    BurningDebris,
}

/// A weapon that a player can hold, in slot order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[repr(u8)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Weapon {
    Pistol,
    Shotgun,
    SuperShotgun,
    Chaingun,
    RocketLauncher,
    PlasmaRifle,
    Bfg9000,
}

/// What did the damage.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[allow(missing_docs, reason = "the names say it")]
pub enum DamageKind {
    Sector,
    Falling,
    Bullet,
    Rocket,
    Splash,
    Barrel,
    Script,
}
