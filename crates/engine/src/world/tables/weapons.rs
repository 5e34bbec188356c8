//! What every weapon is: its ammunition, its rank and its pictures, tic by tic.

use crate::world::tables::kinds::Weapon;
use crate::world::tables::states::sprite;

/// Ammunition types: indices into [`Player::ammo`](crate::world::Player::ammo).
pub mod ammo {
    /// Bullets.
    pub const CLIP: usize = 0;
    /// Shells.
    pub const SHELL: usize = 1;
    /// Rockets.
    pub const ROCKET: usize = 2;
    /// Cells.
    pub const CELL: usize = 3;
    /// Most of each type that a player carries; a backpack doubles it.
    pub const MOST: [i32; 4] = [200, 50, 50, 300];
}

/// What a weapon does on entering a frame of its fire sequence.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::world) enum Shot {
    /// Nothing.
    None,
    /// Shows the muzzle flash.
    Flash,
    /// Fires.
    Fire,
    /// Fires again if the button is still held.
    Again,
}

/// A picture of the weapon, at full brightness only in flash sequences.
#[derive(Clone, Copy, Debug)]
pub(in crate::world) struct WeaponFrame {
    /// Picture, 0 = `A`.
    pub frame: u8,
    /// Tics shown; 0 goes on to the next at once.
    pub tics: i16,
    /// Done on entering it.
    pub shot: Shot,
}

/// A picture of the muzzle flash.
#[derive(Clone, Copy, Debug)]
pub(in crate::world) struct FlashFrame {
    /// Picture, 0 = `A`.
    pub frame: u8,
    /// Tics shown.
    pub tics: i16,
    /// Light that it adds to the view, 0 to 2.
    pub light: u8,
}

/// The fixed properties of a weapon.
#[derive(Clone, Copy, Debug)]
pub(in crate::world) struct WeaponInfo {
    /// Its ammunition.
    pub ammo: usize,
    /// Used by a shot.
    pub ammo_per_shot: i32,
    /// Given with the weapon.
    pub ammo_given: i32,
    /// Preferred over weapons with a larger number when ammunition runs out.
    pub rank: u32,
    /// Needs a fresh press of the button.
    pub fresh_press: bool,
    /// Sprite of the weapon in the hands.
    pub sprite: u8,
    /// From the press to the last tic before the weapon is ready again.
    pub fire: &'static [WeaponFrame],
    /// Sprite of the muzzle flash.
    pub flash_sprite: u8,
    /// The flash sequences: weapons that alternate have two.
    pub flashes: &'static [&'static [FlashFrame]],
}

const fn frame(letter: u8, tics: i16, shot: Shot) -> WeaponFrame {
    WeaponFrame { frame: letter - b'A', tics, shot }
}

const fn show(letter: u8, tics: i16) -> WeaponFrame {
    frame(letter, tics, Shot::None)
}

const fn flash(letter: u8, tics: i16, light: u8) -> FlashFrame {
    FlashFrame { frame: letter - b'A', tics, light }
}

use crate::world::tables::weapons::Shot::{Again, Fire, Flash};

static PISTOL: WeaponInfo = WeaponInfo {
    ammo: ammo::CLIP,
    ammo_per_shot: 1,
    ammo_given: 20,
    rank: 1900,
    fresh_press: false,
    sprite: sprite("PISG"),
    fire: &[show(b'A', 4), frame(b'B', 6, Fire), show(b'C', 4), frame(b'B', 5, Again)],
    flash_sprite: sprite("PISF"),
    flashes: &[&[flash(b'A', 7, 1)]],
};

static SHOTGUN: WeaponInfo = WeaponInfo {
    ammo: ammo::SHELL,
    ammo_per_shot: 1,
    ammo_given: 8,
    rank: 1300,
    fresh_press: false,
    sprite: sprite("SHTG"),
    fire: &[
        show(b'A', 3),
        frame(b'A', 7, Fire),
        show(b'B', 5),
        show(b'C', 5),
        show(b'D', 4),
        show(b'C', 5),
        show(b'B', 5),
        show(b'A', 3),
        frame(b'A', 7, Again),
    ],
    flash_sprite: sprite("SHTF"),
    flashes: &[&[flash(b'A', 4, 1), flash(b'B', 3, 2)]],
};

static SUPER_SHOTGUN: WeaponInfo = WeaponInfo {
    ammo: ammo::SHELL,
    ammo_per_shot: 2,
    ammo_given: 8,
    rank: 400,
    fresh_press: false,
    sprite: sprite("SHT2"),
    fire: &[
        show(b'A', 3),
        frame(b'A', 7, Fire),
        show(b'B', 7),
        show(b'C', 7),
        show(b'D', 7),
        show(b'E', 7),
        show(b'F', 7),
        show(b'G', 6),
        show(b'H', 6),
        frame(b'A', 5, Again),
    ],
    flash_sprite: sprite("SHT2"),
    flashes: &[&[flash(b'I', 4, 1), flash(b'J', 3, 2)]],
};

static CHAINGUN: WeaponInfo = WeaponInfo {
    ammo: ammo::CLIP,
    ammo_per_shot: 1,
    ammo_given: 20,
    rank: 700,
    fresh_press: false,
    sprite: sprite("CHGG"),
    fire: &[frame(b'A', 4, Fire), frame(b'B', 4, Fire), frame(b'B', 0, Again)],
    flash_sprite: sprite("CHGF"),
    flashes: &[&[flash(b'A', 5, 1)], &[flash(b'B', 5, 2)]],
};

static ROCKET_LAUNCHER: WeaponInfo = WeaponInfo {
    ammo: ammo::ROCKET,
    ammo_per_shot: 1,
    ammo_given: 2,
    rank: 2500,
    fresh_press: true,
    sprite: sprite("MISG"),
    fire: &[frame(b'B', 8, Flash), frame(b'B', 12, Fire), frame(b'B', 0, Again)],
    flash_sprite: sprite("MISF"),
    flashes: &[&[flash(b'A', 3, 1), flash(b'B', 4, 1), flash(b'C', 4, 2), flash(b'D', 4, 2)]],
};

static PLASMA_RIFLE: WeaponInfo = WeaponInfo {
    ammo: ammo::CELL,
    ammo_per_shot: 1,
    ammo_given: 40,
    rank: 100,
    fresh_press: false,
    sprite: sprite("PLSG"),
    fire: &[frame(b'A', 3, Fire), frame(b'B', 20, Again)],
    flash_sprite: sprite("PLSF"),
    flashes: &[&[flash(b'A', 4, 1)], &[flash(b'B', 4, 1)]],
};

static BFG9000: WeaponInfo = WeaponInfo {
    ammo: ammo::CELL,
    ammo_per_shot: 40,
    ammo_given: 40,
    rank: 2800,
    fresh_press: true,
    sprite: sprite("BFGG"),
    fire: &[show(b'A', 20), frame(b'B', 10, Flash), frame(b'B', 10, Fire), frame(b'B', 20, Again)],
    flash_sprite: sprite("BFGF"),
    flashes: &[&[flash(b'A', 11, 1), flash(b'B', 6, 2)]],
};

impl Weapon {
    /// Number of weapons.
    pub const COUNT: usize = Weapon::Bfg9000 as usize + 1;

    /// Every weapon, in slot order.
    pub const ALL: [Weapon; Weapon::COUNT] = [
        Weapon::Pistol,
        Weapon::Shotgun,
        Weapon::SuperShotgun,
        Weapon::Chaingun,
        Weapon::RocketLauncher,
        Weapon::PlasmaRifle,
        Weapon::Bfg9000,
    ];

    /// The kind of ammunition that the weapon fires: an index of the player's.
    #[must_use]
    pub fn ammo(self) -> usize {
        self.info().ammo
    }

    /// The fixed properties of the weapon.
    pub(in crate::world) fn info(self) -> &'static WeaponInfo {
        match self {
            Weapon::Pistol => &PISTOL,
            Weapon::Shotgun => &SHOTGUN,
            Weapon::SuperShotgun => &SUPER_SHOTGUN,
            Weapon::Chaingun => &CHAINGUN,
            Weapon::RocketLauncher => &ROCKET_LAUNCHER,
            Weapon::PlasmaRifle => &PLASMA_RIFLE,
            Weapon::Bfg9000 => &BFG9000,
        }
    }

    /// Index into [`Player::ammo`](crate::world::Player::ammo) of the weapon's ammunition.
    #[must_use]
    pub fn ammo_type(self) -> usize {
        self.info().ammo
    }

    /// The weapon's bit in [`Player::weapons`](crate::world::Player::weapons).
    #[must_use]
    pub const fn bit(self) -> u16 {
        1 << self as u16
    }

    /// The key that selects it, 2 to 7.
    #[must_use]
    pub const fn slot(self) -> u8 {
        match self {
            Weapon::Pistol => 2,
            Weapon::Shotgun | Weapon::SuperShotgun => 3,
            Weapon::Chaingun => 4,
            Weapon::RocketLauncher => 5,
            Weapon::PlasmaRifle => 6,
            Weapon::Bfg9000 => 7,
        }
    }
}

/// How far bullets scatter: bits by which a triangular draw of -255..=255 is shifted.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::world) struct Spread {
    /// Sideways, 0 for none: 18 gives 5.6 degrees at most, 19 twice that.
    pub yaw_shift: u32,
    /// Up and down too.
    pub vertical: bool,
}

impl Spread {
    /// Every bullet where the weapon points.
    pub const NONE: Spread = Spread { yaw_shift: 0, vertical: false };
    /// Sideways by 5.6 degrees at most.
    pub const NARROW: Spread = Spread { yaw_shift: 18, vertical: false };
    /// Sideways by 11.2 degrees, up and down by 7 degrees at most.
    pub const WIDE: Spread = Spread { yaw_shift: 19, vertical: true };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::Assets;

    #[test]
    fn every_frame_of_every_weapon_is_painted() {
        let assets = Assets::embedded();
        for weapon in Weapon::ALL {
            let info = weapon.info();
            let fire = info.fire.iter().map(|shown| (info.sprite, shown.frame));
            let flashes = info
                .flashes
                .iter()
                .copied()
                .flatten()
                .map(|shown| (info.flash_sprite, shown.frame));
            // The first frame is the weapon at rest.
            for (sprite, frame) in fire.chain(flashes).chain([(info.sprite, 0)]) {
                assert!(
                    usize::from(frame) < assets.sprites[usize::from(sprite)].frames.len(),
                    "{weapon:?}: frame {frame}"
                );
            }
        }
    }
}
