//! What an episode brings, where and when it happens: "+1" and "cost 4" that rise over the picture,
//! and a strip below it with return, cost and budget.

use crate::Panel;
use hasard_envs::Step;
use hasard_media::{Picture, text};

const GOOD: [u8; 3] = [120, 235, 140];
const BAD: [u8; 3] = [255, 105, 90];
const SHADE: [u8; 3] = [10, 11, 14];
/// Tics that a number is seen, and those in which it fades.
const LIFE: u32 = 35;
const FADING: u32 = 10;
/// What follows within so many tics is added to the number that is there, for so long at most.
const TOGETHER: u32 = 6;
const GROWING: u32 = 24;

/// A number that rises.
struct Rise {
    is_cost: bool,
    size: f64,
    /// Tics since it appeared, and since it was last added to.
    age: u32,
    still: u32,
}

/// Numbers that rise over the picture where reward or cost comes in.
#[derive(Default)]
pub struct Overlay {
    rises: Vec<Rise>,
}

impl Overlay {
    /// Takes what a step brought.
    pub fn step(&mut self, step: &Step) {
        for (is_cost, size) in [(false, step.reward), (true, step.cost)] {
            if size != 0.0 {
                self.add(is_cost, size);
            }
        }
    }

    fn add(&mut self, is_cost: bool, size: f64) {
        let open = |rise: &&mut Rise| {
            rise.is_cost == is_cost && rise.still < TOGETHER && rise.age < GROWING
        };
        match self.rises.iter_mut().find(open) {
            Some(rise) => {
                rise.size += size;
                rise.still = 0;
            }
            None => self.rises.push(Rise { is_cost, size, age: 0, still: 0 }),
        }
    }

    /// A tic passes.
    pub fn tic(&mut self) {
        for rise in &mut self.rises {
            rise.age += 1;
            rise.still += 1;
        }
        self.rises.retain(|rise| rise.age < LIFE);
    }

    /// Forgets everything: another episode begins.
    pub fn clear(&mut self) {
        self.rises.clear();
    }

    /// Draws the numbers over a picture of the game: rewards left of the middle, costs right of it.
    pub fn draw(&self, picture: &mut Picture) {
        let scale = (picture.height() / 120).clamp(1, 4);
        for rise in &self.rises {
            let words = match rise.is_cost {
                true => format!("cost {}", plain(rise.size)),
                false if rise.size > 0.0 => format!("+{}", plain(rise.size)),
                false => plain(rise.size),
            };
            let colour = if rise.is_cost || rise.size < 0.0 { BAD } else { GOOD };
            let middle = picture.width() * (if rise.is_cost { 2 } else { 1 }) / 3;
            let left = middle as isize - (text::width(&words) * scale / 2) as isize;
            let climbed = picture.height() as u32 / 4 * rise.age / LIFE;
            let top = (picture.height() / 2) as isize - climbed as isize;
            let ink = 255 * (LIFE - rise.age).min(FADING) / FADING;
            draw_large(picture, (left, top), &words, scale, colour, ink as u8);
        }
    }
}

/// Writes a line whose pixels are squares, with a dark edge so that it can be read on any ground.
fn draw_large(
    picture: &mut Picture,
    (left, top): (isize, isize),
    words: &str,
    scale: usize,
    colour: [u8; 3],
    ink: u8,
) {
    let mut stamp = |dx: isize, dy: isize, colour: [u8; 3]| {
        text::each_pixel(words, |column, row, share| {
            // The strokes of the font are thin: their edges count for more.
            let share = (u32::from(share).saturating_mul(2).min(255) * u32::from(ink) / 255) as u8;
            for square in 0..scale * scale {
                let x = left + dx + (column * scale + square % scale) as isize;
                let y = top + dy + (row * scale + square / scale) as isize;
                picture.blend(x, y, colour, share);
            }
        });
    };
    for (dx, dy) in [(-1, 0), (1, 0), (0, -1), (0, 1), (1, 1)] {
        stamp(dx * scale as isize, dy * scale as isize, SHADE);
    }
    stamp(0, 0, colour);
}

/// A number as short as it can be said: whole ones without a point, others with two digits at most.
#[must_use]
pub fn plain(value: f64) -> String {
    let words = format!("{value:.2}");
    let words = words.trim_end_matches('0').trim_end_matches('.');
    if words == "-0" { "0".into() } else { words.into() }
}

/// The picture with a strip below: return, a bar of the cost against the budget, cost and budget.
#[must_use]
pub fn with_strip(game: &Picture, panel: &Panel) -> Picture {
    let height = game.height() + text::LINE_HEIGHT + 4;
    let mut picture = Picture::filled(game.width(), height + height % 2, super::panel::GROUND);
    picture.paste(game, 0, 0);
    let top = game.height() + 2;
    let gained = format!("return {}", plain(panel.episode_return));
    let paid = format!("cost {} of {}", plain(panel.cost), plain(panel.budget));
    let over = panel.cost > panel.budget;
    let (ink, colour) = (super::panel::INK, if over { BAD } else { GOOD });
    text::draw(&mut picture, 4, top as isize, &gained, ink);
    let right = game.width().saturating_sub(text::width(&paid) + 4);
    text::draw(&mut picture, right as isize, top as isize, &paid, colour);
    let left = text::width(&gained).max(text::width("return 00.00")) + 12;
    super::panel::bar(&mut picture, (left, top + 5), (right.saturating_sub(left + 8), 7), panel);
    picture
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(reward: f64, cost: f64) -> Step {
        Step { reward, cost, ..Step::default() }
    }

    #[test]
    fn numbers_are_short() {
        let said = [1.0, 0.5, 0.126, 12.0, -0.001, 100.0, -2.5].map(plain);
        assert_eq!(said, ["1", "0.5", "0.13", "12", "0", "100", "-2.5"]);
    }

    #[test]
    fn what_comes_at_once_is_one_number_and_goes() {
        let mut overlay = Overlay::default();
        overlay.step(&step(0.0, 0.0));
        assert!(overlay.rises.is_empty());
        for _ in 0..3 {
            overlay.step(&step(1.0, 4.0));
            (0..4).for_each(|_| overlay.tic());
        }
        let sizes: Vec<(bool, f64)> =
            overlay.rises.iter().map(|rise| (rise.is_cost, rise.size)).collect();
        assert_eq!(sizes, [(false, 3.0), (true, 12.0)]);
        (0..TOGETHER).for_each(|_| overlay.tic());
        overlay.step(&step(1.0, 0.0));
        assert_eq!(overlay.rises.len(), 3);
        (0..LIFE).for_each(|_| overlay.tic());
        assert!(overlay.rises.is_empty());
    }

    #[test]
    fn rewards_and_costs_are_seen_at_their_sides() {
        let black = Picture::filled(320, 240, [0; 3]);
        let changed = |reward: f64, cost: f64| {
            let mut overlay = Overlay::default();
            overlay.step(&step(reward, cost));
            let mut picture = black.clone();
            overlay.draw(&mut picture);
            let lit = |x: usize| (0..240).any(|y| picture.get(x, y).iter().any(|byte| *byte > 90));
            ((0..150).any(lit), (170..320).any(lit))
        };
        assert_eq!(changed(0.0, 0.0), (false, false));
        assert_eq!(changed(1.0, 0.0), (true, false));
        assert_eq!(changed(0.0, 4.0), (false, true));
    }

    #[test]
    fn the_strip_has_a_bar_of_the_budget() {
        let panel = Panel {
            seconds: 3.0,
            whole: 60.0,
            episode_return: 7.0,
            cost: 4.0,
            budget: 5.0,
            message: String::new(),
        };
        let black = Picture::filled(320, 240, [0; 3]);
        let within = with_strip(&black, &panel);
        assert_eq!((within.width(), within.height()), (320, 260));
        let over = with_strip(&black, &Panel { cost: 6.0, ..panel });
        assert_ne!(within, over);
    }
}
