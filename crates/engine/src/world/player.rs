//! Players: what a human or an agent has beyond its body.

use super::ActorId;
use crate::math::Fixed;

/// A weapon that a player can hold, in slot order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[repr(u8)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Weapon {
    Fist,
    Pistol,
    Shotgun,
    SuperShotgun,
    Chaingun,
    RocketLauncher,
    PlasmaRifle,
    Bfg9000,
}

/// One layer of the view weapon (the weapon, or its muzzle flash), in 320x200 screen space.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PlayerSprite {
    /// Index into `assets::SPRITE_NAMES`.
    pub sprite: u8,
    /// Frame, 0 = `A`.
    pub frame: u8,
    /// Full brightness.
    pub bright: bool,
    /// Right, 1/65536 pixels; 1.0 at rest.
    pub x: Fixed,
    /// Down, 1/65536 pixels; 32.375 at rest, 128 when put away.
    pub y: Fixed,
}

/// A player: view, inventory, timers. The body is an [`Actor`](super::Actor).
#[derive(Clone, Debug)]
pub struct Player {
    /// The body.
    pub actor: ActorId,
    /// Look angle, as a signed binary angle: negative looks up; -32 to +56 degrees.
    pub pitch: i32,
    /// Eye height above the feet before bob, map units.
    pub view_height: Fixed,
    /// Change of the eye height, map units per tic.
    pub delta_view_height: Fixed,
    /// The rendered eye, computed before the body's vertical move of the tic: it lags one tic.
    pub view_z: Fixed,
    /// Bob amplitude, 0..=16 map units.
    pub bob: Fixed,
    /// Multiplier of forward and side thrust (the `Speed` property of scripts).
    pub speed: Fixed,
    /// Armour points.
    pub armor: i32,
    /// Ammunition: clip, shells, rockets, cells.
    pub ammo: [i32; 4],
    /// Most ammunition of each type.
    pub max_ammo: [i32; 4],
    /// Weapons owned, a bit each by `Weapon as u8`.
    pub weapons: u16,
    /// Weapon in the hands.
    pub weapon: Option<Weapon>,
    /// Weapon layer and flash layer, when there is something to draw.
    pub sprites: [Option<PlayerSprite>; 2],
    /// Added light of a muzzle flash, 0..=2.
    pub extra_light: u8,
    /// Red flash counter: rises by damage, at most 100, falls by 1 a tic.
    pub damage_count: u8,
    /// Gold flash counter: 6 on a pick-up, falls by 1 a tic.
    pub bonus_count: u8,
    /// Tics left of light amplification (Infrared).
    pub infrared_tics: u32,
    /// Tics left of the radiation suit.
    pub rad_suit_tics: u32,
    /// Tics left of partial invisibility (BlurSphere).
    pub blur_tics: u32,
    /// Keys owned: bit 0 yellow card, bit 1 blue skull.
    pub keys: u8,
    /// No damage is taken (thrust still applies).
    pub invulnerable: bool,
    /// Multiplier of damage taken; zero also stops thrust and flash.
    pub damage_factor: Fixed,
    /// Tics before input has effect (the spawn freeze).
    pub freeze_tics: u32,
    /// Health points are 0.
    pub dead: bool,
    /// Buttons of the last tic, for edges.
    pub buttons: super::Buttons,
    /// Face of the status bar: 0..=4 by health band combined with glance; drawn by the renderer.
    pub face: u8,
    /// Monsters killed.
    pub kills: u32,
}
