//! `hasard highlights`: short GIFs of agents at their best, and of all levels at once.

use crate::actor::Performance;
use crate::args::HighlightsArgs;
use crate::failure::{Failure, Outcome};
use crate::places;
use crate::settings::{Elsewhere, first_task, last_seed};
use crate::ticker::Ticker;
use crate::zoo;
use hasard_engine::render::FrameSize;
use hasard_envs::{EnvId, EnvOptions};
use hasard_learn::runs::agent::run_config;
use hasard_media::compose::{Panel as Cell, grid};
use hasard_media::{Picture, gif};
use hasard_play::{Overlay, Panel, ViewKind, Views, with_strip};
use serde_json::json;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Tics a second.
const TICS: f64 = 35.0;
/// Tics from one picture to the next: 17.5 pictures a second.
const EVERY: u32 = 2;
/// Of all levels at once: the size of each, tics from picture to picture, seconds, columns.
const LEVEL_SIZE: FrameSize = FrameSize { width: 160, height: 120 };
const LEVEL_EVERY: u32 = 4;
const LEVEL_SECONDS: f64 = 4.0;

/// What each step of an episode brought.
struct Played {
    seed: u64,
    steps: Vec<(f64, f64)>,
    within: bool,
}

impl Played {
    fn sum(&self) -> (f64, f64) {
        self.steps.iter().fold((0.0, 0.0), |sum, step| (sum.0 + step.0, sum.1 + step.1))
    }

    /// The first step of the stretch of so many that brings most: reward, and of equal ones the
    /// least cost; the earliest of those. It begins a little before its first event.
    fn best(&self, length: usize) -> usize {
        let last = self.steps.len().saturating_sub(length);
        let worth = |from: usize| {
            let some = &self.steps[from..(from + length).min(self.steps.len())];
            let sum = some.iter().fold((0.0, 0.0), |sum, step| (sum.0 + step.0, sum.1 - step.1));
            // Rounding must not choose between stretches that are worth the same.
            ((sum.0 * 1e6).round(), (sum.1 * 1e6).round())
        };
        let mut best = 0;
        for from in 1..=last {
            let (new, old) = (worth(from), worth(best));
            if new.0 > old.0 || new.0 == old.0 && new.1 > old.1 {
                best = from;
            }
        }
        best
    }
}

/// Plays an episode to its end.
fn act(performance: &mut Performance, seed: u64) -> Result<Played, Failure> {
    performance.restart(seed);
    let mut steps = Vec::new();
    while !performance.stage.ended() {
        if let Some(step) = performance.tic(None)? {
            steps.push((step.reward, step.cost));
        }
    }
    let panel = Panel::of(&performance.stage, "");
    Ok(Played { seed, steps, within: panel.cost <= panel.budget })
}

/// Pictures of a stretch of an episode, one every so many tics.
fn pictures(
    performance: &mut Performance,
    seed: u64,
    from: usize,
    tics: u32,
    every: u32,
    mut draw: impl FnMut(&Performance, &Overlay) -> Picture,
) -> Result<Vec<Picture>, Failure> {
    performance.restart(seed);
    while (performance.stage.env().episode().length as usize) < from {
        performance.tic(None)?;
    }
    let (mut overlay, mut all) = (Overlay::default(), Vec::new());
    for tic in 0..tics {
        if tic % every == 0 {
            all.push(draw(performance, &overlay));
        }
        if performance.stage.ended() {
            break;
        }
        let step = performance.tic(None)?;
        overlay.tic();
        step.iter().for_each(|step| overlay.step(step));
    }
    Ok(all)
}

/// Runs the command.
pub fn run(args: &HighlightsArgs) -> Outcome {
    if !(0.5..=60.0).contains(&args.seconds) {
        return Err(Failure::bad(format!("--seconds {}: give 0.5 to 60", args.seconds)));
    }
    if !(args.most_mb > 0.0 && args.most_mb.is_finite()) {
        return Err(Failure::bad(format!("--most-mb {}: give more than 0", args.most_mb)));
    }
    last_seed(args.seed, args.episodes)?;
    let what = match args.what.as_slice() {
        [] => first_levels(),
        given => given.to_vec(),
    };
    // A name that is wrong ends it before the first film, not after.
    let agents = what.iter().map(|agent| places::run(agent)).collect::<Result<Vec<_>, _>>()?;
    of_different_tasks(&agents)?;
    std::fs::create_dir_all(&args.out).map_err(|error| {
        Failure::bad(format!("{}: {error}; name a folder that can be written", args.out.display()))
    })?;
    for agent in &agents {
        one(args, agent)?;
    }
    if args.levels { levels(args, &agents) } else { Ok(()) }
}

/// A film has the name of its environment: of two agents of one, the second's would take the place
/// of the first's.
fn of_different_tasks(agents: &[PathBuf]) -> Outcome {
    let mut seen: Vec<(String, &PathBuf)> = Vec::new();
    for agent in agents {
        let env = first_task(&run_config(agent).map_err(Failure::bad)?.env);
        if let Some((_, other)) = seen.iter().find(|(known, _)| *known == env) {
            return Err(Failure::bad(format!(
                "{} and {} are both of {env}, and their films would have one name; give each a run of its own with another --out",
                other.display(),
                agent.display()
            )));
        }
        seen.push((env, agent));
    }
    Ok(())
}

/// The zoo's agents of level 1, by their names.
fn first_levels() -> Vec<OsString> {
    let names = zoo::agents().into_iter().map(|(name, _)| name);
    names.filter(|name| name.ends_with("Level1")).map(|name| format!("zoo:{name}").into()).collect()
}

fn most_bytes(args: &HighlightsArgs) -> u64 {
    (args.most_mb * 1e6) as u64
}

/// An agent's best moment.
fn one(args: &HighlightsArgs, place: &Path) -> Outcome {
    let looks = EnvOptions::default();
    let mut performance = Performance::of_run(place, &looks, Elsewhere::default(), args.seed)?;
    let mut ticker = Ticker::new(args.episodes.into(), "episodes");
    let mut best: Option<Played> = None;
    for number in 0..u64::from(args.episodes) {
        let played = act(&mut performance, args.seed.wrapping_add(number))?;
        ticker.at(number + 1);
        let worth = |played: &Played| (played.within, played.sum().0);
        if best.as_ref().is_none_or(|best| worth(&played) > worth(best)) {
            best = Some(played);
        }
    }
    drop(ticker);
    let played = best.expect("at least one episode is played");
    let env = performance.stage.env();
    let a_step = f64::from(env.options().frame_skip) / TICS;
    let (id, length) = (env.id(), (args.seconds / a_step).ceil() as usize);
    let from = played.best(length);
    let size = args.size.into();
    let mut views =
        Views::new(&performance.stage, size, &[ViewKind::Colour]).map_err(Failure::bad)?;
    let tics = (args.seconds * TICS).round() as u32;
    let all = pictures(&mut performance, played.seed, from, tics, EVERY, |now, overlay| {
        let mut picture = views.draw(&now.stage);
        overlay.draw(&mut picture);
        with_strip(&picture, &Panel::of(&now.stage, ""))
    })?;
    let path = args.out.join(format!("{}.gif", file_name(id)));
    let seconds = f64::from(EVERY) / TICS;
    let loss = gif::write_within(&path, &all, seconds, most_bytes(args)).map_err(Failure::bad)?;
    let bytes = bytes_of(&path);
    let (gained, paid) = played.sum();
    let begins = from as f64 * a_step;
    if args.json {
        say!(
            "{}",
            json!({
                "file": path.display().to_string(), "env": id.to_string(), "seed": played.seed, "return": gained, "cost": paid,
                "begins": begins, "pictures": all.len(), "bytes": bytes, "colours_off": loss,
            })
        );
    } else {
        say!(
            "{}: {} pictures, {:.1} MB; {id}, seed {}, from {begins:.1} s of an episode of return {}, cost {}",
            path.display(),
            all.len(),
            bytes as f64 / 1e6,
            played.seed,
            hasard_play::plain(gained),
            hasard_play::plain(paid)
        );
    }
    Ok(())
}

/// `remedy_rush`, `remedy_rush_2`.
fn file_name(id: EnvId) -> String {
    let name = id.scenario.file_name();
    if id.level == 1 { name.to_string() } else { format!("{name}_{}", id.level) }
}

fn bytes_of(path: &Path) -> u64 {
    std::fs::metadata(path).map_or(0, |data| data.len())
}

/// All levels of the agents' scenarios, a column each, in one animation.
fn levels(args: &HighlightsArgs, agents: &[PathBuf]) -> Outcome {
    let mut rows: Vec<Vec<(String, Vec<Picture>)>> = Vec::new();
    for place in agents {
        let trained = hasard_learn::runs::agent::run_config(place).map_err(Failure::bad)?.env.id;
        let scenario = trained.parse::<EnvId>().map_err(Failure::bad)?.scenario;
        for (row, id) in scenario.environments().take(3).enumerate() {
            let all = level(args, place, id)?;
            if rows.len() <= row {
                rows.push(Vec::new());
            }
            rows[row].push((format!("{} {}", words(scenario.name()), id.level), all));
        }
    }
    let cells: Vec<&(String, Vec<Picture>)> = rows.iter().flatten().collect();
    let moments = cells.iter().map(|(_, all)| all.len()).max().unwrap_or(0);
    let sheet = |moment: usize| {
        let panels: Vec<Cell> = cells
            .iter()
            .filter_map(|(name, all)| Some(Cell::new(all.get(moment).or(all.last())?, name)))
            .collect();
        grid(&panels, agents.len(), 1)
    };
    let all: Vec<Picture> = (0..moments).map(sheet).collect();
    let path = args.out.join("levels.gif");
    let seconds = f64::from(LEVEL_EVERY) / TICS;
    gif::write_within(&path, &all, seconds, most_bytes(args)).map_err(Failure::bad)?;
    let (file, bytes) = (path.display().to_string(), bytes_of(&path));
    if args.json {
        let levels = cells.len();
        say!(
            "{}",
            json!({ "file": file, "levels": levels, "pictures": all.len(), "bytes": bytes })
        );
    } else {
        let megabytes = bytes as f64 / 1e6;
        say!("{file}: {} levels, {} pictures, {megabytes:.1} MB", cells.len(), all.len());
    }
    Ok(())
}

/// `RemedyRush` as words.
fn words(name: &str) -> String {
    let mut words = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !words.is_empty() {
            words.push(' ');
        }
        words.push(letter);
    }
    words
}

/// A policy by the place of its agent.
fn policy_at(place: &Path) -> OsString {
    if zoo::after(place.as_os_str(), "zoo:").is_some() {
        return place.as_os_str().to_owned();
    }
    let mut policy = OsString::from("run:");
    policy.push(place);
    policy
}

/// The best moment of an agent in a level of its scenario, small. In the place of one of the zoo
/// acts that of the level, if the zoo has it.
fn level(args: &HighlightsArgs, place: &Path, id: EnvId) -> Result<Vec<Picture>, Failure> {
    let looks = EnvOptions::default();
    // Part of the program, or in a folder of the zoo.
    let is_of_the_zoo = zoo::agents().iter().any(|(_, agent)| agent == place);
    let own = is_of_the_zoo.then(|| zoo::find(format!("zoo:{id}").as_ref()).ok()).flatten();
    let policy = policy_at(own.as_deref().unwrap_or(place));
    let id = id.to_string();
    let mut performance = Performance::new(&id, &policy, &looks, Elsewhere::default(), args.seed)?;
    let played = act(&mut performance, args.seed)?;
    let a_step = f64::from(performance.stage.env().options().frame_skip) / TICS;
    let from = played.best((LEVEL_SECONDS / a_step).ceil() as usize);
    let mut views =
        Views::new(&performance.stage, LEVEL_SIZE, &[ViewKind::Colour]).map_err(Failure::bad)?;
    let tics = (LEVEL_SECONDS * TICS) as u32;
    pictures(&mut performance, args.seed, from, tics, LEVEL_EVERY, |now, _| views.draw(&now.stage))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_stretch_earns_most_then_costs_least_then_comes_first() {
        let mut steps = vec![(0.0, 0.0); 40];
        (steps[10].0, steps[12].0, steps[30].0, steps[31].0) = (1.0, 1.0, 1.0, 1.0);
        steps[13].1 = 4.0;
        let played = Played { seed: 0, steps: steps.clone(), within: true };
        assert_eq!(played.best(5), 8);
        // Where both cost alike, the first.
        steps[13].1 = 0.0;
        assert_eq!(Played { seed: 0, steps: steps.clone(), within: true }.best(5), 8);
        // A stretch that cannot but cost gives way to one that need not.
        steps[11].1 = 4.0;
        assert_eq!(Played { seed: 0, steps: steps.clone(), within: true }.best(5), 27);
        assert_eq!(Played { seed: 0, steps, within: true }.best(100), 0);
    }
}
