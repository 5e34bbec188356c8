//! The episode's panel below the game.

use crate::Stage;
use hasard_media::{Picture, text};

const GROUND: [u8; 3] = [20, 22, 26];
const INK: [u8; 3] = [225, 228, 234];
const PALE: [u8; 3] = [140, 146, 156];
const GOOD: [u8; 3] = [70, 190, 110];
const BAD: [u8; 3] = [226, 72, 72];
const EMPTY: [u8; 3] = [52, 56, 64];

/// What the panel tells.
#[derive(Clone, PartialEq, Debug)]
pub struct Panel {
    /// Seconds since the episode's start, at 35 tics a second.
    pub seconds: f64,
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

    /// The panel of a stage.
    #[must_use]
    pub fn of(stage: &Stage, message: impl Into<String>) -> Panel {
        let env = stage.env();
        let episode = env.episode();
        let budget = env.id().safety_budget(env.options().rules, env.options().hard);
        Panel {
            seconds: f64::from(episode.length * env.options().frame_skip) / 35.0,
            episode_return: episode.episode_return,
            cost: episode.cost,
            budget,
            message: message.into(),
        }
    }
}

/// The picture with the panel under it: first line time, return and cost, second line the message,
/// between them a bar of the cost against the budget.
#[must_use]
pub fn with_panel(game: &Picture, panel: &Panel) -> Picture {
    let height = game.height() + Panel::HEIGHT;
    let mut picture = Picture::filled(game.width(), height + height % 2, GROUND);
    picture.paste(game, 0, 0);
    let over = panel.cost > panel.budget;
    let top = game.height() + 4;
    let parts = [
        (format!("time {:.1}", panel.seconds), INK),
        (format!("return {:.2}", panel.episode_return), INK),
        (format!("cost {:.2} of {:.0}", panel.cost, panel.budget), if over { BAD } else { GOOD }),
    ];
    let column = game.width() / parts.len();
    for (index, (words, colour)) in parts.iter().enumerate() {
        text::draw(&mut picture, (index * column + 8) as isize, top as isize, words, *colour);
    }
    let bar_top = top + text::LINE_HEIGHT + 2;
    let bar_width = game.width().saturating_sub(16);
    picture.fill(8, bar_top, bar_width, 6, EMPTY);
    // The budget ends at three quarters of the bar, so that going beyond can be seen.
    let scale = if panel.budget > 0.0 {
        panel.cost / panel.budget * 0.75
    } else {
        f64::from(u8::from(over))
    };
    picture.fill(
        8,
        bar_top,
        (bar_width as f64 * scale.clamp(0.0, 1.0)) as usize,
        6,
        if over { BAD } else { GOOD },
    );
    if panel.budget > 0.0 {
        picture.fill(8 + bar_width * 3 / 4, bar_top - 2, 2, 10, INK);
    }
    text::draw(&mut picture, 8, (bar_top + 10) as isize, &panel.message, PALE);
    picture
}
