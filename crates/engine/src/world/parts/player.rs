//! Players: what a human or an agent has beyond its body.

use crate::math::Fixed;
use crate::world::parts::actor::ActorId;
use crate::world::parts::command::Buttons;
use crate::world::parts::face::FaceState;
use crate::world::parts::hands::WeaponState;
use crate::world::tables::kinds::Weapon;
use crate::world::tables::weapons::ammo;

/// Height of the eye above the feet of an upright player.
pub(crate) const VIEW_HEIGHT: Fixed = Fixed::from_int(41);

/// Tics after the start of a map during which bodies neither turn, walk nor jump; scenarios may
/// change a player's count.
pub const SPAWN_FREEZE_TICS: u32 = 8;

/// One layer of the view weapon (the weapon, or its muzzle flash), in 320x200 screen space.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct PlayerSprite {
    /// Index into `assets::SPRITE_NAMES`.
    pub sprite: u8,
    /// Frame, 0 = `A`.
    pub frame: u8,
    /// Full brightness.
    pub bright: bool,
    /// Right, 1/65536 pixels; 0 at rest.
    pub x: Fixed,
    /// Down, 1/65536 pixels; 32.375 at rest, 128 when put away.
    pub y: Fixed,
}

/// A player: view, inventory, timers. The body is an [`Actor`](crate::world::Actor).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
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
    /// Ammunition that left in the last tic: the status bar, which is written before shots are fired,
    /// shows it still.
    pub just_spent: [i32; 4],
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
    /// Tics before the body can turn, walk and jump (the spawn freeze); looking, crouching and
    /// shooting work at once.
    pub freeze_tics: u32,
    /// Health points are 0.
    pub dead: bool,
    /// Buttons of this tic.
    pub buttons: Buttons,
    /// Buttons of the last tic, for edges.
    pub old_buttons: Buttons,
    /// Consecutive tics that any turn button has been down.
    pub turn_held_tics: u32,
    /// Tics left of a half turn.
    pub turn180_tics: u8,
    /// Forward command of this tic, right command: 256ths of the units of the button table.
    pub thrust: [i32; 2],
    /// 0 when a jump may start, negative while in the air after one, positive for a while after
    /// landing.
    pub jump_tics: i32,
    /// A jump pressed while crouched forces getting up: 1 until the next press of crouch.
    pub forced_rise: bool,
    /// 1.0 upright to 0.5 crouched.
    pub crouch: Fixed,
    /// Change of the eye's rest height by crouching, 0 upright to -20.5 map units.
    pub crouch_view_offset: Fixed,
    /// The velocity that the player's own effort gives, map units per tic: what the view bobs by.
    pub bob_velocity: [Fixed; 2],
    /// Feet were on a floor or an actor when the player last thought.
    pub on_ground: bool,
    /// What the hands and the weapon are doing.
    pub weapon_state: WeaponState,
    /// Face of the status bar; the band of health comes from
    /// [`World::face_band`](crate::world::World::face_band).
    pub face_state: FaceState,
    /// Monsters killed.
    pub kills: u32,
}

impl Player {
    /// A player as a map starts it, with its feet at `floor_z`.
    pub(crate) fn new(actor: ActorId, floor_z: Fixed) -> Player {
        Player {
            actor,
            pitch: 0,
            view_height: VIEW_HEIGHT,
            delta_view_height: Fixed::ZERO,
            view_z: floor_z + VIEW_HEIGHT,
            bob: Fixed::ZERO,
            speed: Fixed::ONE,
            armor: 0,
            ammo: [0; 4],
            just_spent: [0; 4],
            max_ammo: ammo::MOST,
            weapons: 0,
            weapon: None,
            sprites: [None; 2],
            extra_light: 0,
            damage_count: 0,
            bonus_count: 0,
            infrared_tics: 0,
            rad_suit_tics: 0,
            blur_tics: 0,
            keys: 0,
            invulnerable: false,
            damage_factor: Fixed::ONE,
            freeze_tics: SPAWN_FREEZE_TICS,
            dead: false,
            buttons: Buttons::default(),
            old_buttons: Buttons::default(),
            turn_held_tics: 0,
            turn180_tics: 0,
            thrust: [0; 2],
            jump_tics: 0,
            forced_rise: false,
            crouch: Fixed::ONE,
            crouch_view_offset: Fixed::ZERO,
            bob_velocity: [Fixed::ZERO; 2],
            on_ground: true,
            weapon_state: WeaponState::default(),
            face_state: FaceState::default(),
            kills: 0,
        }
    }

    /// Forgets all motion: the eye at rest above feet at `z`, nothing held, upright, looking along
    /// `pitch`.
    pub(crate) fn come_to_rest(&mut self, pitch: i32, z: Fixed) {
        let fresh = Player::new(self.actor, z);
        self.pitch = pitch;
        (self.view_height, self.delta_view_height) = (fresh.view_height, fresh.delta_view_height);
        (self.view_z, self.bob, self.bob_velocity) = (fresh.view_z, fresh.bob, fresh.bob_velocity);
        (self.crouch, self.crouch_view_offset, self.forced_rise) =
            (fresh.crouch, fresh.crouch_view_offset, false);
        (self.jump_tics, self.turn_held_tics, self.turn180_tics) = (0, 0, 0);
        (self.buttons, self.old_buttons) = (fresh.buttons, fresh.old_buttons);
    }
}
