//! What the hands and the weapon in them are doing.

use crate::math::Fixed;
use crate::world::tables::kinds::Weapon;

/// Height of the weapon layer when it is put away, screen units.
pub(in crate::world) const PUT_AWAY: Fixed = Fixed::from_int(128);

/// What the hands are doing.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Hands {
    /// Nothing is shown.
    #[default]
    Empty,
    /// Bringing the weapon up.
    Raising,
    /// Ready to fire or to change the weapon.
    Ready,
    /// Putting the weapon away.
    Lowering,
    /// In the fire sequence.
    Firing,
}

/// The state of the weapon layer and of the muzzle flash.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct WeaponState {
    /// The weapon that comes next, if the player changes it.
    pub pending: Option<Weapon>,
    /// What the hands are doing.
    pub hands: Hands,
    /// Frame of the fire sequence.
    pub(in crate::world) step: u8,
    /// Tics left of it.
    pub(in crate::world) tics: i16,
    /// Height of the layer.
    pub(in crate::world) height: Fixed,
    /// Sequence and frame of the muzzle flash.
    pub(in crate::world) flash: Option<(u8, u8)>,
    /// Tics left of that frame.
    pub(in crate::world) flash_tics: i16,
    /// Swing of the weapon, which follows the player's bob by at most 1 a tic.
    pub(in crate::world) swing: Fixed,
    /// The button has been down since a ready weapon last saw it up. It counts as down at the
    /// start, so that a weapon which wants a fresh press does not fire for a button held since
    /// before.
    pub(in crate::world) attack_down: bool,
    /// Shots since the press, the first not counted: only the first is accurate.
    pub(in crate::world) repeats: u32,
}

impl Default for WeaponState {
    fn default() -> WeaponState {
        WeaponState {
            pending: None,
            hands: Hands::Empty,
            step: 0,
            tics: 0,
            height: PUT_AWAY,
            flash: None,
            flash_tics: 0,
            swing: Fixed::ZERO,
            attack_down: true,
            repeats: 0,
        }
    }
}
