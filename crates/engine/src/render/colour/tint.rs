//! The palette of a frame: the set's colours, blended towards the screen flashes of the moment.

use crate::world::Player;

/// What tints the screen.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) struct Tint {
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
/// Parts of gold, of 255, for each step of the counter, and at most.
const BONUS_ALPHA: i64 = 8;
const BONUS_ALPHA_LIMIT: i64 = 128;
/// Red of damage.
const DAMAGE: [u8; 3] = [255, 0, 0];
/// Parts of red, of 255, by damage counter, as measured at every one; a player's counter ends
/// at 100.
const DAMAGE_ALPHA: [u8; 101] = [
    0, 8, 16, 23, 30, 36, 42, 47, 53, 58, 62, 67, 71, 75, 79, 83, 87, 90, 94, 97, 100, 103, 107,
    109, 112, 115, 118, 120, 123, 125, 128, 130, 133, 135, 137, 139, 141, 143, 145, 147, 149, 151,
    153, 155, 157, 159, 160, 162, 164, 165, 167, 169, 170, 172, 173, 175, 176, 178, 179, 181, 182,
    183, 185, 186, 187, 189, 190, 191, 192, 194, 195, 196, 197, 198, 200, 201, 202, 203, 204, 205,
    206, 207, 209, 210, 211, 212, 213, 214, 215, 216, 217, 218, 219, 220, 221, 221, 222, 223, 224,
    225, 226,
];
/// Green of the radiation suit, an eighth of the whole and cut to 31 parts of 255, as measured.
const SUIT: [u8; 3] = [0, 255, 0];
const SUIT_ALPHA: i64 = 31;
/// Power-ups blink in their last tics, by this bit of what is left.
const BLINK_TICS: u32 = 128;
const BLINK_BIT: u32 = 8;

/// Whether a power-up with `tics` left shows: it blinks before it ends.
pub(crate) fn power_shows(tics: u32) -> bool {
    tics > BLINK_TICS || tics & BLINK_BIT != 0
}

impl Tint {
    /// What tints a player's screen; `green_goggles` gives light amplification its hue.
    pub fn of_player(player: &Player, green_goggles: bool) -> Tint {
        Tint {
            bonus: player.bonus_count,
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
            (SUIT, if self.suit { SUIT_ALPHA } else { 0 }),
            (BONUS, (BONUS_ALPHA * i64::from(self.bonus)).min(BONUS_ALPHA_LIMIT)),
            (DAMAGE, damage_alpha(self.damage)),
        ];
        // Several flashes are one: each covers its part of what the ones before left together.
        let (mut flash, mut cover) = ([0; 3], 0);
        for (colour, alpha) in flashes.into_iter().filter(|&(_, alpha)| alpha > 0) {
            let own = (alpha << 16) / 255;
            let both = cover + ((((1 << 16) - cover) * own) >> 16);
            let before = (cover << 16) / both;
            flash = std::array::from_fn(|i| {
                (flash[i] * before + (i64::from(colour[i]) << 16) * ((1 << 16) - before)) >> 16
            });
            cover = both;
        }
        let (part, flash) = ((cover * 256) >> 16, flash.map(|channel| channel >> 16));
        if part > 0 {
            for (channel, to) in palette.iter_mut().flat_map(|colour| colour.iter_mut().zip(flash))
            {
                *channel = ((i64::from(*channel) * (256 - part) + to * part) >> 8) as u8;
            }
        }
        palette
    }
}

fn damage_alpha(counter: u8) -> i64 {
    i64::from(DAMAGE_ALPHA[usize::from(counter).min(DAMAGE_ALPHA.len() - 1)])
}

/// A colour as green goggles show it: its luminance in green, with a quarter of the other channels
/// left.
fn green(colour: [u8; 3]) -> [u8; 3] {
    let luminance = crate::render::colour::palette::luminance(colour);
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
        for (counter, alpha) in
            [(0, 0), (1, 8), (10, 62), (15, 83), (41, 151), (100, 226), (120, 226)]
        {
            assert_eq!(damage_alpha(counter), alpha, "counter {counter}");
        }
    }

    #[test]
    fn flashes_compose_one_over_the_other() {
        let both = Tint { bonus: 6, damage: 100, ..Tint::default() }.apply(&GREY)[0];
        // Gold covers 48/255 = 0.1882, red 226/255 of what is left, together 0.9077 or 232/256. Of
        // that gold is 0.2074, so that the colour is 215 * 0.2074 + 255 * 0.7926 = 246 red and
        // 186 * 0.2074 = 38 green.
        assert_eq!(both[0], ((100 * 24 + 246 * 232) >> 8) as u8);
        assert_eq!(both[1], ((100 * 24 + 38 * 232) >> 8) as u8);
    }

    #[test]
    fn a_suit_tints_greys_as_measured() {
        for (grey, [red, green]) in
            [(0, [0, 30]), (19, [16, 47]), (47, [41, 72]), (55, [48, 79]), (107, [94, 124])]
        {
            let tinted = Tint { suit: true, ..Tint::default() }.apply(&[[grey; 3]; 256])[0];
            assert_eq!(tinted, [red, green, red]);
        }
    }

    #[test]
    fn goggles_are_green() {
        let [r, g, b] = Tint { goggles: true, ..Tint::default() }.apply(&GREY)[0];
        assert!(g > 3 * r && g > 3 * b);
    }
}
