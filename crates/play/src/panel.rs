//! The episode's panel below the game.

use crate::Stage;
use crate::overlay::plain;
#[cfg(any(feature = "window", test))]
use hasard_engine::render::FrameSize;
use hasard_media::{Picture, text};

pub(crate) const GROUND: [u8; 3] = [20, 22, 26];
pub(crate) const INK: [u8; 3] = [225, 228, 234];
const PALE: [u8; 3] = [140, 146, 156];
const GOOD: [u8; 3] = [70, 190, 110];
const BAD: [u8; 3] = [226, 72, 72];
const EMPTY: [u8; 3] = [52, 56, 64];

/// What the panel shows.
#[derive(Clone, PartialEq, Debug)]
pub struct Panel {
    /// Seconds since the episode's start, at 35 tics a second.
    pub seconds: f64,
    /// Seconds that the episode may last.
    pub whole: f64,
    /// Return and cost so far, as of the last whole step.
    pub episode_return: f64,
    /// Cost so far.
    pub cost: f64,
    /// Cost that the episode may have.
    pub budget: f64,
    /// Words at the right: a pause, the end, how to begin.
    pub message: String,
}

impl Panel {
    /// Height of the panel in pixels.
    pub const HEIGHT: usize = 2 * text::LINE_HEIGHT + 22;

    /// How large the panel's letters are under a picture so wide: twice as large under a large one.
    const fn scale(width: usize) -> usize {
        if width >= 1200 { 2 } else { 1 }
    }

    /// Rows of the panel under a picture so wide.
    #[cfg(feature = "window")]
    pub(crate) const fn height_under(width: usize) -> usize {
        Panel::HEIGHT * Panel::scale(width)
    }

    /// The largest picture of the game, four to three, that fits into a window with the panel below.
    #[cfg(any(feature = "window", test))]
    pub(crate) fn picture_in(width: u32, height: u32) -> FrameSize {
        let unit = |scale: usize| {
            let rows = height.saturating_sub((Panel::HEIGHT * scale) as u32 + 1);
            // By fours, so that both sides are whole; the engine draws at most 1080 rows.
            (width / 4).min(rows / 3).clamp(80, 360)
        };
        let unit = unit(Panel::scale(4 * unit(1) as usize));
        FrameSize { width: (4 * unit) as u16, height: (3 * unit) as u16 }
    }

    /// The panel of a stage.
    #[must_use]
    pub fn of(stage: &Stage, message: impl Into<String>) -> Panel {
        let env = stage.env();
        let episode = env.episode();
        let budget = env.id().safety_budget(env.options().rules, env.options().hard);
        Panel {
            seconds: f64::from(episode.length * env.options().frame_skip) / 35.0,
            whole: f64::from(env.episode_steps() * env.options().frame_skip) / 35.0,
            episode_return: episode.episode_return,
            cost: episode.cost,
            budget,
            message: message.into(),
        }
    }
}

fn state(panel: &Panel) -> [u8; 3] {
    if panel.cost > panel.budget { BAD } else { GOOD }
}

/// A bar of the cost. The budget ends at three quarters of it, so that going beyond can be seen;
/// twice the budget and more fill it, striped.
pub(crate) fn bar(
    picture: &mut Picture,
    (left, top): (usize, usize),
    (width, height): (usize, usize),
    panel: &Panel,
) {
    picture.fill(left, top, width, height, EMPTY);
    let over = panel.cost > panel.budget;
    let share = if panel.budget > 0.0 { panel.cost / panel.budget } else { 2.0 * f64::from(over) };
    let filled = match share {
        share if share <= 1.0 => 0.75 * share.max(0.0),
        share => 0.75 + 0.25 * (share - 1.0).min(1.0),
    };
    picture.fill(left, top, (width as f64 * filled) as usize, height, state(panel));
    if share >= 2.0 {
        for stripe in (0..width).step_by(12) {
            picture.fill(left + stripe, top + height / 3, 4, height.div_ceil(3), INK);
        }
    }
    if panel.budget > 0.0 {
        picture.fill(left + width * 3 / 4, top.saturating_sub(2), 2, height + 4, INK);
    }
}

/// The picture with the panel under it: first line time, return and cost, second line the message,
/// between them a bar of the cost against the budget.
#[must_use]
pub fn with_panel(game: &Picture, panel: &Panel) -> Picture {
    let scale = Panel::scale(game.width());
    let below = strip(game.width() / scale, panel).enlarged(scale);
    let height = game.height() + below.height();
    let mut picture = Picture::filled(game.width(), height + height % 2, GROUND);
    picture.paste(game, 0, 0);
    picture.paste(&below, 0, game.height());
    picture
}

/// The panel alone.
fn strip(width: usize, panel: &Panel) -> Picture {
    let mut picture = Picture::filled(width.max(1), Panel::HEIGHT, GROUND);
    let parts = [
        (format!("time {:.1} of {:.0}", panel.seconds, panel.whole), INK),
        (format!("return {}", plain(panel.episode_return)), INK),
        (format!("cost {} of {}", plain(panel.cost), plain(panel.budget)), state(panel)),
    ];
    let column = width / parts.len();
    for (index, (words, colour)) in parts.iter().enumerate() {
        text::draw(&mut picture, (index * column + 8) as isize, 4, words, *colour);
    }
    let bar_top = 4 + text::LINE_HEIGHT + 2;
    bar(&mut picture, (8, bar_top), (width.saturating_sub(16), 6), panel);
    text::draw(&mut picture, 8, (bar_top + 10) as isize, &panel.message, PALE);
    picture
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picture_takes_the_room_there_is() {
        let sides = |width, height| {
            let size = Panel::picture_in(width, height);
            (size.width, size.height)
        };
        assert_eq!(sides(960, 780), (960, 720));
        assert_eq!(sides(1280, 1016), (1208, 906));
        assert_eq!(sides(1920, 1080), (1292, 969));
        assert_eq!(sides(3840, 2160), (1440, 1080));
        assert_eq!(sides(10, 10), (320, 240));
    }
}
