//! `hasard record` and `hasard replay`: episodes as video, GIF or episode file.

use crate::actor::Actor;
use crate::args::{Buffer, EnvArgs, RecordArgs, ReplayArgs, Rules, Size};
use crate::failure::{Failure, Outcome};
use crate::{commands::render, settings};
use hasard_envs::{Env, Policy, PolicyRun, RuleSet};
use hasard_media::AnimationWriter;
use hasard_media::Picture;
use hasard_media::compose::{Panel, side_by_side, with_footer};
use hasard_media::episode::{self, EpisodeFile, Header};
use std::collections::BTreeMap;
use std::path::Path;

/// Runs `hasard record`.
pub fn run(args: &RecordArgs) -> Outcome {
    let options = settings::env_options(&args.env_args, Size { width: 320, height: 240 })?;
    let policy: Policy = args.policy.parse().map_err(Failure::bad)?;
    let mut env = Env::new(&args.env, &options).map_err(Failure::bad)?;
    env.reset(args.seed);
    let actor = Actor::Fixed(Box::new(PolicyRun::new(policy, env.action_space(), args.seed)));
    if args.out.extension().is_some_and(|ending| ending == "episode") {
        return record_episode(&mut env, actor, &args.policy, args.seed, &args.out);
    }
    show(&mut env, actor, &args.out, &args.beside, args.steps)
}

/// Runs `hasard replay`.
pub fn replay(args: &ReplayArgs) -> Outcome {
    let file = EpisodeFile::read(&args.file).map_err(Failure::bad)?;
    let header = file.header().clone();
    let flags = flags_of(&header, &args.file)?;
    let mut options = settings::env_options(&flags, args.size.unwrap_or(Size { width: 320, height: 240 }))?;
    options.assets = settings::assets(args.iwad.as_deref())?;
    let mut env = Env::new(&header.env, &options).map_err(Failure::bad)?;
    file.check_actions(&env.action_space().sizes(), env.action_space().deltas.len(), &args.file).map_err(Failure::bad)?;
    env.reset(header.seed);
    let actor = Actor::Recording(Box::new(file), 0);
    match &args.out {
        Some(out) => show(&mut env, actor, out, &args.beside, u32::MAX)?,
        None => {
            let mut actor = actor;
            while actor.step(&mut env, None)?.is_some() {}
        }
    }
    let episode = env.episode();
    say!("{}: return {:.3}, cost {:.3}, {} steps", header.env, episode.episode_return, episode.cost, episode.length);
    match header.outcome {
        Some(outcome) if outcome.state_hash.is_some_and(|hash| hash != env.state_hash()) => Err(Failure::Negative(format!(
            "{}: recorded by hasard {} with return {} and cost {}, but it plays otherwise in this version: return {}, cost {}",
            args.file.display(),
            header.program,
            outcome.episode_return,
            outcome.cost,
            episode.episode_return,
            episode.cost
        ))),
        _ => Ok(()),
    }
}

/// Plays an episode to its end and writes what is needed to play it again.
fn record_episode(env: &mut Env, mut actor: Actor, player: &str, seed: u64, out: &Path) -> Outcome {
    let header = header_of(env, player, seed);
    let mut file = EpisodeFile::new(header).map_err(Failure::bad)?;
    while let Some(step) = actor.step(env, Some(&mut file))? {
        if step.ended() {
            break;
        }
    }
    let played = env.episode();
    file.set_outcome(episode::Outcome {
        episode_return: played.episode_return,
        cost: played.cost,
        costs: played.costs.iter().map(|&(name, cost)| (name.to_string(), cost)).collect(),
        terminated: played.terminated,
        truncated: played.truncated,
        state_hash: Some(env.state_hash()),
    });
    file.write(out).map_err(Failure::bad)?;
    say!("{}: {} steps, return {:.3}, cost {:.3}", out.display(), played.length, played.episode_return, played.cost);
    Ok(())
}

/// The header of a recording about to begin.
fn header_of(env: &Env, player: &str, seed: u64) -> Header {
    let options = env.options();
    let mut named = BTreeMap::new();
    named.insert("rules".to_string(), if options.rules == RuleSet::Released { "released" } else { "paper" }.to_string());
    named.insert("frame-skip".to_string(), options.frame_skip.to_string());
    for (name, given) in [("hard", options.hard), ("full-actions", options.full_actions)] {
        if given {
            named.insert(name.to_string(), "true".to_string());
        }
    }
    Header {
        env: env.id().to_string(),
        options: named,
        seed,
        program: env!("CARGO_PKG_VERSION").to_string(),
        player: player.to_string(),
        steps: 0,
        groups: env.action_space().groups.len() as u8,
        deltas: env.action_space().deltas.len() as u8,
        outcome: None,
    }
}

/// The flags that make the environment of a recording.
fn flags_of(header: &Header, name: &Path) -> Result<EnvArgs, Failure> {
    let mut flags = EnvArgs::default();
    for (option, value) in &header.options {
        let wrong = || {
            Failure::bad(format!(
                "{}: its option {option} = {value} is unknown here; use the hasard that recorded it",
                name.display()
            ))
        };
        match option.as_str() {
            "rules" => {
                flags.rules = match value.as_str() {
                    "paper" => Rules::Paper,
                    "released" => Rules::Released,
                    _ => return Err(wrong()),
                }
            }
            "frame-skip" => flags.frame_skip = value.parse().map_err(|_| wrong())?,
            "hard" => flags.hard = value.parse().map_err(|_| wrong())?,
            "full-actions" => flags.full_actions = value.parse().map_err(|_| wrong())?,
            _ => return Err(wrong()),
        }
    }
    Ok(flags)
}

/// Plays and writes a moving picture, one frame a policy step.
fn show(env: &mut Env, mut actor: Actor, out: &Path, beside: &[Buffer], most_steps: u32) -> Outcome {
    let first = frame(env, beside)?;
    let rate = (35, env.options().frame_skip);
    let mut writer = AnimationWriter::create(out, first.width(), first.height(), rate).map_err(Failure::bad)?;
    writer.push(&first).map_err(Failure::bad)?;
    let mut frames = 1;
    while frames <= most_steps {
        let Some(step) = actor.step(env, None)? else { break };
        writer.push(&frame(env, beside)?).map_err(Failure::bad)?;
        frames += 1;
        if step.ended() {
            break;
        }
    }
    writer.finish().map_err(Failure::bad)?;
    say!("{}: {frames} frames of {}x{}", out.display(), first.width(), first.height());
    Ok(())
}

/// The present moment: what the player sees, other buffers beside it, and the sums of the episode below.
fn frame(env: &mut Env, beside: &[Buffer]) -> Result<Picture, Failure> {
    let view = render::picture(env, Buffer::Rgb)?;
    let others: Vec<(Picture, &str)> =
        beside.iter().map(|&buffer| Ok((render::picture(env, buffer)?, buffer.caption()))).collect::<Result<_, Failure>>()?;
    let mut panels = vec![Panel::new(&view, if others.is_empty() { "" } else { "view" })];
    panels.extend(others.iter().map(|(picture, caption)| Panel::new(picture, *caption)));
    let episode = env.episode();
    let seconds = f64::from(env.world().tic) / 35.0;
    let line = format!("{seconds:5.1} s   return {:.2}   cost {:.2}", episode.episode_return, episode.cost);
    let row = if panels.len() == 1 { view } else { side_by_side(&panels, 1) };
    Ok(with_footer(&row, &line))
}
