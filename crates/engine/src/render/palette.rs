//! The palette of a frame: the set's colours, blended towards the screen flashes of the moment.

use crate::world::Player;

/// What tints the screen.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Tint {
    /// Counter of the gold flash of a pick-up.
    bonus: u8,
    /// Counter of the red flash of damage.
    damage: u8,
    /// The radiation suit's green.
    suit: bool,
    /// The goggles' green hue.
    goggles: bool,
}

/// Gold of a pick-up.
const BONUS: [u8; 3] = [215, 186, 69];
/// Part of gold in 255 for each step of the counter.
const BONUS_ALPHA: i32 = 8;
/// Red of damage.
const DAMAGE: [u8; 3] = [255, 0, 0];
/// Part of red in 255 by damage counter; between the points it is linear.
const DAMAGE_ALPHA: [(i32, i32); 12] =
    [(0, 0), (1, 8), (2, 16), (5, 36), (10, 62), (20, 100), (30, 128), (40, 149), (50, 167), (60, 182), (80, 206), (100, 226)];
/// Most red.
const DAMAGE_ALPHA_LIMIT: i32 = 228;
/// Green of the radiation suit, an eighth of the whole.
const SUIT: [u8; 3] = [0, 255, 0];
const SUIT_ALPHA: i32 = 32;
/// Power-ups blink in their last tics, by this bit of what is left.
const BLINK_TICS: u32 = 128;
const BLINK_BIT: u32 = 8;

/// Whether a power-up with `tics` left shows: it blinks before it ends.
pub(super) fn power_shows(tics: u32) -> bool {
    tics > BLINK_TICS || tics & BLINK_BIT != 0
}

impl Tint {
    /// What tints a player's screen; `green_goggles` gives light amplification its hue.
    pub fn of_player(player: &Player, green_goggles: bool) -> Tint {
        Tint {
            bonus: player.bonus_count.min(31),
            damage: player.damage_count,
            suit: power_shows(player.rad_suit_tics),
            goggles: green_goggles && power_shows(player.infrared_tics),
        }
    }

    /// The tinted palette.
    pub fn apply(self, colours: &[[u8; 3]; 256]) -> [[u8; 3]; 256] {
        let mut palette = *colours;
        if self.goggles {
            palette = palette.map(green);
        }
        let flashes = [
            (BONUS, BONUS_ALPHA * i32::from(self.bonus)),
            (DAMAGE, damage_alpha(i32::from(self.damage))),
            (SUIT, if self.suit { SUIT_ALPHA } else { 0 }),
        ];
        for (flash, alpha) in flashes.into_iter().filter(|&(_, alpha)| alpha > 0) {
            for colour in &mut palette {
                for (channel, &to) in colour.iter_mut().zip(&flash) {
                    let blend = i32::from(*channel) * (255 - alpha) + i32::from(to) * alpha;
                    *channel = ((blend + 127) / 255) as u8;
                }
            }
        }
        palette
    }
}

fn damage_alpha(counter: i32) -> i32 {
    let after = DAMAGE_ALPHA.partition_point(|&(at, _)| at < counter);
    let alpha = match (DAMAGE_ALPHA.get(after.wrapping_sub(1)), DAMAGE_ALPHA.get(after)) {
        (_, Some(&(at, alpha))) if at == counter => alpha,
        (Some(&(low, from)), Some(&(high, to))) => from + (to - from) * (counter - low) / (high - low),
        _ => DAMAGE_ALPHA_LIMIT,
    };
    alpha.min(DAMAGE_ALPHA_LIMIT)
}

/// A colour as green goggles show it: its luminance in green, with a quarter of the other channels left.
fn green(colour: [u8; 3]) -> [u8; 3] {
    let luminance = super::convert::luminance(colour);
    [colour[0] / 4, luminance.max(colour[1]), colour[2] / 4]
}

#[cfg(test)]
mod tests {
    use super::*;

    const GREY: [[u8; 3]; 256] = [[100, 100, 100]; 256];

    #[test]
    fn no_tint_is_the_sets_palette() {
        assert_eq!(Tint::default().apply(&GREY), GREY);
    }

    #[test]
    fn red_follows_the_measured_points() {
        for (counter, alpha) in [(0, 0), (1, 8), (10, 62), (15, 81), (100, 226), (120, 228)] {
            assert_eq!(damage_alpha(counter), alpha, "counter {counter}");
        }
    }

    #[test]
    fn flashes_compose_one_over_the_other() {
        let both = Tint { bonus: 6, damage: 100, ..Tint::default() }.apply(&GREY)[0];
        // Gold first: 100 * 207/255 + 215 * 48/255 = 121.6, then red: 122 * 29/255 + 226 = 239.9; green 116 * 29/255.
        assert_eq!(both[0], 240);
        assert_eq!(both[1], 13);
    }

    #[test]
    fn goggles_are_green() {
        let [r, g, b] = Tint { goggles: true, ..Tint::default() }.apply(&GREY)[0];
        assert!(g > 3 * r && g > 3 * b);
    }
}
