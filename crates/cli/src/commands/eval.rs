//! `hasard eval`, and `rollout --policy run:DIR`: a trained agent at work.

use super::record::{GIF_SIZE, is_gif};
use crate::actor::Performance;
use crate::args::{EvalArgs, Size, View};
use crate::episode_lines::EpisodeLines;
use crate::failure::{Failure, Outcome, warn};
use crate::places;
use crate::settings::last_seed;
use crate::ticker::Ticker;
use hasard_envs::{Env, EnvOptions, Episode, RuleSet, VecEnv};
use hasard_learn::config::{Constraint, TrainConfig};
use hasard_learn::networks::distribution::ActionShape;
use hasard_learn::runs::agent::{Agent, Choice, TrainedPolicy, Which, run_config};
use hasard_learn::runs::calibration::{calibrate, predictions};
use hasard_learn::runs::checkpoint::Store;
use hasard_learn::runs::evaluate::{Trace, play_traced};
use hasard_learn::runs::session::MakeWorlds;
use hasard_media::files::{WholeFile, is_special, write_whole};
use hasard_play::Film;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::fs::metadata;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Episodes that are played before they are printed.
const AT_ONCE: usize = 64;

/// Runs the command.
pub fn run(args: &EvalArgs) -> Outcome {
    let film = args
        .worst
        .map(|count| (usize::from(count), args.out.as_deref().unwrap_or(Path::new("worst.mp4"))));
    if let Some((_, out)) = film
        && !out.extension().is_some_and(|ending| {
            ending.eq_ignore_ascii_case("mp4") || ending.eq_ignore_ascii_case("gif")
        })
    {
        return Err(Failure::bad(format!(
            "--out {}: give a name that ends in .mp4 or .gif",
            out.display()
        )));
    }
    if let Some(path) = &args.calibration
        && !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"))
        && !metadata(path).is_ok_and(|kind| is_special(&kind))
    {
        return Err(Failure::bad(format!(
            "--calibration {}: give a name that ends in .csv",
            path.display()
        )));
    }
    if let Some((count, _)) = film
        && count > args.episodes as usize
    {
        return Err(Failure::bad(format!(
            "--worst {count}: more than --episodes {}; lower the one or raise the other",
            args.episodes
        )));
    }
    last_seed(args.seed, args.episodes)?;
    let run = places::run(&args.run)?;
    // A place that cannot be written ends it before the first episode, not after the last.
    let written = film.map(|(_, out)| out).into_iter().chain(args.calibration.as_deref());
    for path in written.filter(|path| !metadata(path).is_ok_and(|kind| is_special(&kind))) {
        drop(WholeFile::create(path).map_err(Failure::bad)?);
    }
    let mut config = run_config(&run).map_err(Failure::bad)?;
    let actions_of = args.rules.map(|rules| play_under(&mut config, rules.into())).transpose()?;
    let config = config;
    let mut lines = EpisodeLines::new(args.json);
    lines.hold_against(&config.constraints);
    let options = crate::settings::trained_options(&config.env, args.places.elsewhere())?;
    let options = EnvOptions { test_seeds: args.test_seeds, actions_of, ..options };
    lines.played_under(&options);
    let player = Player {
        run: &run,
        which: if args.latest { Which::Latest } else { Which::Selected },
        choice: if args.greedy { Choice::Greedy } else { Choice::Sampled },
    };
    let env =
        Env::new(&crate::settings::first_task(&config.env), &options).map_err(Failure::bad)?;
    let mut traces = Vec::new();
    let mut gamma = 1.0;
    if args.calibration.is_some() {
        let policy = player.policy(&env)?;
        gamma = policy.cost_gamma();
        if policy.cost_units().is_empty() {
            return Err(Failure::bad(format!(
                "--calibration: {}: has no critics of costs whose units are known and that see no more than an agent at work; give \
                 the run directory, or an agent newly exported, of an algorithm that has them, such as PPOPID",
                args.run.to_string_lossy()
            )));
        }
    }
    let make = |_: &_, worlds| config.env.worlds(&options, worlds);
    let numbers = (args.episodes, args.seed);
    player.play_traced(&env, &make, &config.env.id, numbers, &mut lines, &mut |trace| {
        if args.calibration.is_some() {
            traces.push(trace);
        }
    })?;
    // By which a report sees that the run has gone on since.
    let mut more = vec![("run_frames", json!(Store::new(&run, 1).frames()))];
    if let Some(path) = &args.calibration {
        let played: Vec<(Episode, Trace)> = lines.episodes().iter().cloned().zip(traces).collect();
        more.push(("calibration", write_calibration(path, &played, &config, gamma)?));
    }
    if let Some((count, out)) = film {
        let worst = worst_of(lines.episodes(), config.constraints.first(), count)?;
        let seeds = film_worst(&player, &config, &options, &worst, out)?;
        more.push(("filmed", json!({ "file": out.display().to_string(), "seeds": seeds })));
    }
    lines.summary_with(true, &more)?;
    if !args.json {
        for (what, value) in more {
            match what {
                "filmed" => say!(
                    "{}: episodes of the seeds {}",
                    value["file"].as_str().unwrap_or_default(),
                    value["seeds"]
                ),
                "calibration" => print_calibration(&value)?,
                _ => {}
            }
        }
    }
    Ok(())
}

/// Puts a run's environment under another rule set. A budget that its own rules had by default
/// becomes that of these; one that was asked for stays. Gives whose buttons the agent keeps.
fn play_under(config: &mut TrainConfig, rules: RuleSet) -> Result<(RuleSet, bool), Failure> {
    let own = config.env.options().map_err(Failure::bad)?;
    for task in config.env.tasks() {
        let id = task.env_id().map_err(Failure::bad)?;
        let (before, now) =
            (id.safety_budget(own.rules, own.hard), id.safety_budget(rules, own.hard));
        let on = config.env.is_mixed().then_some(task.id);
        let usual = config.constraints.iter_mut().filter(|one| one.term == on);
        usual.filter(|one| one.budget == before).for_each(|one| one.budget = now);
    }
    config.env.rules = rules.name().into();
    Ok((own.rules, own.hard))
}

/// The most costly episodes under a constraint, the worst first.
fn worst_of(
    episodes: &[Episode],
    constraint: Option<&Constraint>,
    count: usize,
) -> Result<Vec<Episode>, Failure> {
    let cost = |episode: &Episode| {
        constraint.map_or(Ok(Some(episode.cost)), |one| one.cost_of(episode)).map_err(Failure::bad)
    };
    let mut all: Vec<(f64, &Episode)> = Vec::new();
    for one in episodes {
        all.extend(cost(one)?.map(|cost| (cost, one)));
    }
    // Of equal cost, the earlier comes first.
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    Ok(all.into_iter().take(count).map(|(_, episode)| episode.clone()).collect())
}

/// Films episodes one after the other; gives their seeds.
fn film_worst(
    player: &Player<'_>,
    config: &TrainConfig,
    options: &EnvOptions,
    worst: &[Episode],
    out: &Path,
) -> Result<Vec<u64>, Failure> {
    let size = if is_gif(out) { GIF_SIZE } else { Size { width: 320, height: 240 } };
    let looks = EnvOptions { size: size.into(), ..options.clone() };
    let id_of = |episode: &Episode| episode.task.unwrap_or(&config.env.id).to_string();
    let Some(first) = worst.first() else { return Ok(Vec::new()) };
    let perform = |episode: &Episode| {
        Performance::of_player(player, &id_of(episode), options, &looks, episode.seed)
    };
    let mut performance = perform(first)?;
    let every = if is_gif(out) { 5 } else { 1 };
    let views = crate::settings::views(View::Rgb, &[]);
    let mut film =
        Film::begin(&performance.stage, out, looks.size, &views, every).map_err(Failure::bad)?;
    for episode in worst {
        if performance.stage.env().id().to_string() == id_of(episode) {
            performance.restart(episode.seed);
        } else {
            performance = perform(episode)?;
        }
        while !performance.stage.ended() {
            performance.tic(None)?;
            film.tic(&performance.stage).map_err(Failure::bad)?;
        }
        let shown = performance.stage.env().episode();
        if (shown.episode_return, shown.cost) != (episode.episode_return, episode.cost) {
            let problem = format!(
                "the episode of seed {} is another one when it is filmed; please report it",
                episode.seed
            );
            return Err(Failure::Negative(problem));
        }
    }
    film.finish().map_err(Failure::bad)?;
    Ok(worst.iter().map(|episode| episode.seed).collect())
}

/// Writes the table of predictions, and gives what the summary says of them.
fn write_calibration(
    path: &Path,
    played: &[(Episode, Trace)],
    config: &TrainConfig,
    gamma: f64,
) -> Result<Value, Failure> {
    let all = predictions(played, config, gamma);
    let mut text = String::from("episode,seed,step,term,predicted,observed,cut\n");
    for one in &all {
        let term = config.constraints[one.constraint].term.as_deref().unwrap_or("cost");
        let seed = played[one.episode].0.seed;
        let _ = writeln!(
            text,
            "{},{seed},{},{term},{},{},{}",
            one.episode, one.step, one.predicted, one.observed, one.cut
        );
    }
    write_whole(path, text.as_bytes()).map_err(Failure::bad)?;
    Ok(json!(calibrate(&all, config, gamma)))
}

fn print_calibration(all: &Value) -> Outcome {
    for one in all.as_array().into_iter().flatten() {
        let term = one["term"].as_str().unwrap_or("cost");
        say!(
            "{term} to come, predicted and observed ({} steps; bias {:.3}):",
            one["steps"],
            one["bias"].as_f64().unwrap_or(0.0)
        );
        for bin in one["bins"].as_array().into_iter().flatten() {
            let number = |name: &str| bin[name].as_f64().unwrap_or(0.0);
            say!("{:>10.3} {:>10.3}", number("predicted"), number("observed"));
        }
    }
    Ok(())
}

/// Which agent acts, and how.
pub struct Player<'a> {
    /// Its run directory, or its file.
    pub run: &'a Path,
    /// Which of its checkpoints.
    pub which: Which,
    /// How it chooses.
    pub choice: Choice,
}

impl Player<'_> {
    /// Its policy, for worlds like this one.
    fn policy(&self, env: &Env) -> Result<TrainedPolicy, Failure> {
        let action = ActionShape::from(env.action_space());
        TrainedPolicy::load(self.run, self.which, env.observation_shape(), action, &mut warn)
            .map_err(Failure::bad)
    }

    /// The agent, for one world like this one.
    pub fn agent(&self, env: &Env) -> Result<Agent, Failure> {
        Ok(self.policy(env)?.agent(self.choice, 1))
    }

    /// Plays episodes seeded `seed`, `seed + 1`, ... in one environment, on all cores, and prints
    /// them in order.
    pub fn play(
        &self,
        id: &str,
        options: &EnvOptions,
        episodes: u32,
        seed: u64,
        lines: &mut EpisodeLines,
    ) -> Outcome {
        let env = Env::new(id, options).map_err(Failure::bad)?;
        let make = |_: &_, worlds| VecEnv::new(id, options, worlds);
        let numbers = (episodes, seed);
        self.play_traced(&env, &make, id, numbers, lines, &mut |_| {})
    }

    /// The same in the worlds that `make` makes, giving away what the agent's critics expected.
    fn play_traced(
        &self,
        env: &Env,
        make: &MakeWorlds<'_>,
        id: &str,
        (episodes, seed): (u32, u64),
        lines: &mut EpisodeLines,
        traced: &mut dyn FnMut(Trace),
    ) -> Outcome {
        let policy = self.policy(env)?;
        let threads = crate::settings::cores();
        let numbers: Vec<u32> = (0..episodes).collect();
        let mut ticker = Ticker::new(episodes.into(), "episodes");
        // Of several tasks, each number has the one that it has in a single turn.
        let at_once = AT_ONCE.next_multiple_of(policy.config().env.tasks().len());
        for some in numbers.chunks(at_once) {
            ticker.at(some[0].into());
            let seeds: Vec<u64> =
                some.iter().map(|&number| seed.wrapping_add(number.into())).collect();
            let never = AtomicBool::new(false);
            let played = play_traced(&never, &policy, self.choice, make, &seeds, threads)
                .map_err(Failure::bad)?;
            let played = played.unwrap_or_default();
            ticker.clear();
            for (&number, (episode, trace)) in some.iter().zip(played) {
                lines.episode(id, number.into(), episode)?;
                traced(trace);
            }
        }
        Ok(())
    }
}
