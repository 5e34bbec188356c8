//! A card over the game: what to do and the keys before it begins, how it went when it is over.

use crate::guide::{keys, task};
use crate::overlay::plain;
use crate::{Panel, Rival, Stage};
use hasard_media::{Picture, text};

const GROUND: [u8; 3] = [16, 18, 22];
const INK: [u8; 3] = [232, 235, 240];
const PALE: [u8; 3] = [170, 176, 186];
const GOOD: [u8; 3] = [120, 235, 140];
const BAD: [u8; 3] = [255, 120, 105];
/// Columns of text between the left edge and what stands beside a key.
const INDENT: usize = 20;

/// Lines with their colours.
pub(crate) type Lines = Vec<(String, [u8; 3])>;

/// A text in lines of so many letters.
fn wrapped(words: &str, letters: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in words.split(' ') {
        let last = lines.last_mut().expect("there is a line");
        if !last.is_empty() && last.chars().count() + 1 + word.chars().count() > letters {
            lines.push(word.to_string());
        } else {
            if !last.is_empty() {
                last.push(' ');
            }
            last.push_str(word);
        }
    }
    lines
}

/// How many pixels of a picture a dot of the letters takes.
fn scale(picture: &Picture) -> usize {
    (picture.height() / 400).max(1)
}

/// Letters that a line on a picture may have.
fn letters(picture: &Picture) -> usize {
    ((picture.width() / scale(picture)).saturating_sub(64) / text::width("x")).max(20)
}

/// What the task asks, and its keys.
pub(crate) fn instructions(stage: &Stage, picture: &Picture) -> Lines {
    let id = stage.env().id().to_string();
    let mut lines: Lines = vec![(id.clone(), INK)];
    if let Some(task) = task(&id) {
        let say = |words: String, colour| {
            wrapped(&words, letters(picture)).into_iter().map(move |line| (line, colour))
        };
        lines.extend(say(format!("Do: {}", task.collect), GOOD));
        lines.extend(say(format!("Avoid: {}.", task.avoid), BAD));
    }
    lines.push((String::new(), INK));
    for (key, what) in keys(stage.env().action_space()) {
        lines.push((format!("{key:<INDENT$}{what}"), PALE));
    }
    lines
}

/// How an episode went, and its place among rivals: only what is within the budget has one.
pub(crate) fn ending(panel: &Panel, terminated: bool, rivals: &[Rival], kept: &str) -> Lines {
    let within = panel.cost <= panel.budget;
    let result = format!(
        "return {}, cost {} of {}, {:.1} s",
        plain(panel.episode_return),
        plain(panel.cost),
        plain(panel.budget),
        panel.seconds
    );
    let how = match (within, terminated) {
        (true, false) => "Time is up: within the budget",
        (true, true) => "Over: within the budget",
        (false, false) => "Time is up: over the budget",
        (false, true) => "Over, and over the budget",
    };
    let mut lines: Lines =
        vec![(how.into(), if within { GOOD } else { BAD }), (result, INK), (String::new(), INK)];
    if within {
        let better = rivals.iter().filter(|one| one.episode_return > panel.episode_return).count();
        lines
            .push((format!("Place {} of {} within the budget", better + 1, rivals.len() + 1), INK));
    } else {
        lines.push(("Over the budget: it has no place in the table".into(), PALE));
    }
    for rival in rivals.iter().take(3) {
        let value = plain(rival.episode_return);
        lines.push((format!("{value:>8}  {}", rival.who), PALE));
    }
    lines.push((String::new(), INK));
    if !kept.is_empty() {
        lines.push((format!("Kept as {kept}"), PALE));
    }
    lines.push(("Enter: next episode. R: the same again.".into(), PALE));
    lines
}

/// Draws lines on a dark card in the middle of a picture.
pub(crate) fn draw(picture: &mut Picture, lines: &Lines) {
    let scale = scale(picture);
    let widest = lines.iter().map(|(line, _)| text::width(line)).max().unwrap_or(0);
    let (width, height) = (widest + 32, lines.len() * (text::LINE_HEIGHT + 2) + 24);
    let left = (picture.width() as isize - (width * scale) as isize) / 2;
    let top = (picture.height() as isize - (height * scale) as isize) / 2;
    for y in top..top + (height * scale) as isize {
        for x in left..left + (width * scale) as isize {
            picture.blend(x, y, GROUND, 218);
        }
    }
    for (number, (line, colour)) in lines.iter().enumerate() {
        let row = 12 + number * (text::LINE_HEIGHT + 2);
        text::each_pixel(line, |x, y, ink| {
            for square in 0..scale * scale {
                let x = left + ((16 + x) * scale + square % scale) as isize;
                let y = top + ((row + y) * scale + square / scale) as isize;
                picture.blend(x, y, *colour, ink);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hasard_envs::EnvOptions;

    fn rival(who: &str, episode_return: f64) -> Rival {
        Rival { who: who.into(), episode_return }
    }

    fn panel(episode_return: f64, cost: f64) -> Panel {
        Panel { seconds: 60.0, whole: 60.0, episode_return, cost, budget: 5.0, message: "".into() }
    }

    fn words(lines: &Lines) -> String {
        lines.iter().map(|(line, _)| format!("{line}\n")).collect()
    }

    #[test]
    fn the_end_names_a_place_only_within_the_budget() {
        let rivals = [rival("PPOPID of the zoo", 36.9), rival("human", 20.0)];
        let said = words(&ending(&panel(30.0, 5.0), false, &rivals, ""));
        assert!(said.contains("Place 2 of 3") && said.contains("PPOPID of the zoo"), "{said}");
        let said = words(&ending(&panel(50.0, 5.5), false, &rivals, "human/a.episode"));
        assert!(said.contains("no place") && said.contains("human/a.episode"), "{said}");
        assert!(words(&ending(&panel(1.0, 0.0), true, &[], "")).contains("Place 1 of 1"));
    }

    #[test]
    fn instructions_fit_the_picture() {
        let picture = Picture::filled(640, 480, [0; 3]);
        for id in hasard_envs::EnvId::every() {
            let stage = Stage::new(&id.to_string(), &EnvOptions::default()).unwrap();
            let lines = instructions(&stage, &picture);
            assert!(words(&lines).contains("Avoid: "), "{id}");
            assert!(lines.len() * (text::LINE_HEIGHT + 2) + 24 <= 480, "{id}: {}", lines.len());
            let fits = |(line, _): &(String, [u8; 3])| text::width(line) + 32 <= 640;
            assert!(lines.iter().all(fits), "{id}");
            let mut drawn = picture.clone();
            draw(&mut drawn, &lines);
            assert_ne!(drawn, picture);
        }
    }

    /// The window's picture before, in and after an episode; kept where `HASARD_KEEP_PICTURES` says.
    #[test]
    fn the_window_says_what_to_do_what_happens_and_how_it_went() {
        use crate::{Overlay, ViewKind, Views, with_panel};
        let mut stage = Stage::new("VolcanicVentureLevel1-v0", &EnvOptions::default()).unwrap();
        stage.reset(task("VolcanicVentureLevel1-v0").unwrap().seed);
        let size = Panel::picture_in(1280, 1017);
        let mut views = Views::new(&stage, size, &[ViewKind::Colour]).unwrap();
        let (mut overlay, mut seen) = (Overlay::default(), Vec::new());
        let mut keep = |name: &str, stage: &Stage, overlay: &Overlay, lines: Option<&Lines>| {
            let mut game = views.draw(stage);
            overlay.draw(&mut game);
            lines.into_iter().for_each(|lines| draw(&mut game, lines));
            let picture = with_panel(&game, &Panel::of(stage, "seed 12; H: keys, P: pause"));
            if let Some(place) = std::env::var_os("HASARD_KEEP_PICTURES") {
                let path = std::path::PathBuf::from(place).join(format!("play_{name}.png"));
                hasard_media::png::write(&picture, &path).unwrap();
            }
            seen.push(picture);
        };
        let lines = instructions(&stage, &Picture::filled(1208, 906, [0; 3]));
        keep("before", &stage, &overlay, Some(&lines));
        let forward = hasard_engine::world::Command {
            buttons: hasard_engine::world::Buttons::MOVE_FORWARD,
            ..hasard_engine::world::Command::default()
        };
        while stage.env().episode().cost == 0.0 && !stage.ended() {
            stage.press(forward);
            let step = stage.tic();
            overlay.tic();
            step.iter().for_each(|step| overlay.step(step));
        }
        (0..3).for_each(|_| overlay.tic());
        keep("within", &stage, &overlay, None);
        let end = ending(&panel(21.0, 3.0), false, &[rival("PPOPID of the zoo", 30.4)], "");
        keep("after", &stage, &Overlay::default(), Some(&end));
        assert!(stage.env().episode().cost > 0.0);
        assert!(seen.iter().all(|one| (one.width(), one.height()) == (1208, 1014)));
        assert!(seen.windows(2).all(|two| two[0] != two[1]));
    }
}
