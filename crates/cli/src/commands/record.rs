//! `hasard record` and `hasard replay`: episodes as video, GIF, picture or episode file.

use crate::actor::Performance;
use crate::args::{FilmArgs, RecordArgs, ReplayArgs, Size, View};
use crate::failure::{Failure, Outcome};
use crate::number::env_id;
use crate::places;
use crate::settings;
use crate::ticker::Ticker;
use crate::zoo;
use hasard_envs::{Env, EnvError, EnvId, EnvOptions, FrameSize, edit_distance, own};
use hasard_media::episode::EpisodeFile;
use hasard_media::files::what_lies_at;
use hasard_media::shell::quote;
use hasard_play::{Film, Recorder, Replay, Stage, Views};
use serde_json::json;
use std::ffi::OsString;
use std::path::Path;

/// What a file's name says it is to be.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Film,
    Picture,
    Episode,
}

impl Kind {
    /// By the ending of the name, if it is one of `allowed`.
    fn of(path: &Path, allowed: &[(&str, Kind)]) -> Result<Kind, Failure> {
        let ending = path
            .extension()
            .and_then(|ending| ending.to_str())
            .unwrap_or_default()
            .to_ascii_lowercase();
        allowed.iter().find(|(known, _)| *known == ending).map(|(_, kind)| *kind).ok_or_else(|| {
            let endings: Vec<String> =
                allowed.iter().map(|(known, _)| format!(".{known}")).collect();
            Failure::bad(format!(
                "--out {}: give a name that ends in {}{}",
                path.display(),
                if endings.len() == 1 { "" } else { "one of " },
                endings.join(", ")
            ))
        })
    }
}

/// Whether a command that draws one picture can write it under this name.
pub(super) fn is_png(path: &Path) -> Outcome {
    // What writes the file has a remedy of its own for a folder.
    if path.is_dir() {
        return Ok(());
    }
    Kind::of(path, &[("png", Kind::Picture)]).map(drop)
}

pub(super) fn is_gif(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gif"))
}

/// Size of a GIF where none is asked for: that of a whole episode stays below 5 MB.
pub(super) const GIF_SIZE: Size = Size { width: 160, height: 120 };

/// Runs `hasard record`.
pub fn run(args: &RecordArgs) -> Outcome {
    let kind = Kind::of(
        &args.out,
        &[("mp4", Kind::Film), ("gif", Kind::Film), ("episode", Kind::Episode)],
    )?;
    if let Some(flag) = without_use(&args.film, args.env_args.size, Some(kind)) {
        return Err(Failure::bad(format!(
            "{flag}: an .episode holds seed and actions and no picture; leave it out, or give an --out that ends in .mp4 or .gif"
        )));
    }
    let usual = if is_gif(&args.out) { GIF_SIZE } else { Size { width: 320, height: 240 } };
    let looks = settings::env_options(&args.env_args, usual)?;
    let looks = settings::looking(looks, &args.film.looks);
    let agent = zoo::is_agent(&args.what);
    let what = &zoo::find(&args.what)?;
    if what.is_file() && !agent && !hasard_envs::own::is_file(&args.what.to_string_lossy()) {
        return record_replay(args, kind, what, &looks);
    }
    let (mut performance, player) = if agent || what.is_dir() {
        if args.policy.is_some() || args.env_args.changes_rules() {
            let mut policy =
                OsString::from(if zoo::after(&args.what, "zoo:").is_some() { "" } else { "run:" });
            policy.push(&args.what);
            return Err(Failure::bad(format!(
                "{}: a run's agent is shown in its own environment; to choose otherwise: hasard record ENV --policy {}",
                args.what.display(),
                quote(policy)
            )));
        }
        let run = &places::run(&args.what)?;
        let performance = Performance::of_run(run, &looks, args.env_args.elsewhere(), args.seed)?;
        let named = args.what.to_string_lossy();
        (
            performance,
            if zoo::after(&args.what, "zoo:").is_some() {
                named.into_owned()
            } else {
                format!("run:{named}")
            },
        )
    } else {
        let policy = args.policy.clone().unwrap_or_else(|| "random".into());
        let id = env_id(&args.what.to_string_lossy()).map_err(Failure::bad)?;
        if let Err(error) = id.parse::<EnvId>()
            && what_lies_at(what).map_err(Failure::bad)?.is_none()
        {
            // Of a word that is like no id the nearest says nothing.
            let remedy = match error {
                EnvError::UnknownId { nearest, .. }
                    if !nearest.is_empty()
                        && edit_distance(&id, &nearest) <= 1 + nearest.len() / 3 =>
                {
                    format!("did you mean {nearest}?")
                }
                _ => {
                    "`hasard envs` lists environments, and `hasard train ENV --out DIR` makes a run"
                        .into()
                }
            };
            return Err(Failure::bad(format!(
                "{} is neither an environment, a run nor a file; {remedy}",
                what.display()
            )));
        }
        let performance =
            Performance::new(&id, &policy, &looks, args.env_args.elsewhere(), args.seed)?;
        (performance, policy.to_string_lossy().into_owned())
    };
    let mut recorder = match kind {
        Kind::Episode => {
            Some(Recorder::of(performance.stage.env(), args.seed, &player).map_err(Failure::bad)?)
        }
        _ => None,
    };
    let mut film = match kind {
        Kind::Episode => None,
        _ => Some(begin(&performance.stage, &args.out, looks.size, &args.film)?),
    };
    let mut steps = 0;
    let mut ticker = Ticker::new(longest(performance.stage.env(), args.steps), "steps");
    while !performance.stage.ended() && args.steps.is_none_or(|most| steps < most) {
        ticker.at(steps.into());
        steps += u32::from(performance.tic(recorder.as_mut())?.is_some());
        if let Some(film) = &mut film {
            film.tic(&performance.stage).map_err(Failure::bad)?;
        }
    }
    drop(ticker);
    let env = performance.stage.env();
    if let Some(recorder) = recorder {
        recorder.finish(env).write(&args.out).map_err(Failure::bad)?;
    }
    finish(env, args.json, Some(&args.out), film)
}

/// `hasard record FILE.episode`: a recorded episode as a film.
fn record_replay(args: &RecordArgs, kind: Kind, file: &Path, looks: &EnvOptions) -> Outcome {
    if kind == Kind::Episode {
        let what = args.what.display();
        let problem = format!(
            "{what}: is a recorded episode already; give an --out that ends in .mp4 or .gif"
        );
        return Err(Failure::bad(problem));
    }
    if args.policy.is_some() || args.env_args.changes_rules() {
        return Err(Failure::bad(format!(
            "{}: a recorded episode has its own environment and actions; leave those options out",
            args.what.display()
        )));
    }
    let mut replay = open(file, looks)?;
    let film = play_out(&mut replay, &args.out, looks.size, &args.film, args.steps)?;
    finish(replay.stage().env(), args.json, Some(&args.out), Some(film))?;
    compared(&replay, file)
}

/// An error where a replay came to its end and to another than the recording's; a line where there is
/// no recorded end.
fn compared(replay: &Replay, file: &Path) -> Outcome {
    if replay.file().header().outcome.is_none() {
        let name = file.display();
        note!("hasard: {name}: the recording stops within its episode; there is no end to compare");
    }
    let difference = replay.over().then(|| replay.difference()).flatten();
    difference.map_or(Ok(()), |difference| Err(Failure::Negative(difference)))
}

/// Runs `hasard replay`.
pub fn replay(args: &ReplayArgs) -> Outcome {
    let looks = settings::looking(
        crate::sources::looks(args.maps.as_deref(), args.iwad.as_deref())?,
        &args.film.looks,
    );
    let allowed = [("mp4", Kind::Film), ("gif", Kind::Film), ("png", Kind::Picture)];
    let kind = args.out.as_deref().map(|out| Kind::of(out, &allowed)).transpose()?;
    if args.step.is_some() && kind != Some(Kind::Picture) {
        return Err(Failure::bad(
            "--step: is for a single picture; give an --out that ends in .png",
        ));
    }
    if let Some(flag) = without_use(&args.film, args.size, kind) {
        return Err(Failure::bad(format!(
            "{flag}: is for what --out writes; {}",
            match kind {
                None => "give an --out that ends in .mp4, .gif or .png",
                Some(_) => "a .png is one picture, so leave it out",
            }
        )));
    }
    let mut replay = open(&args.file, &looks)?;
    let usual = if args.out.as_deref().is_some_and(is_gif) {
        GIF_SIZE
    } else {
        Size { width: 640, height: 480 }
    };
    let size = args.size.unwrap_or(usual).into();
    match (&args.out, kind) {
        (Some(out), Some(Kind::Picture)) => {
            replay.skip_to(args.step.unwrap_or(u32::MAX));
            let length = replay.stage().env().episode().length;
            if let Some(step) = args.step.filter(|step| *step > length) {
                return Err(Failure::bad(format!(
                    "--step {step}: the episode ends at step {length}; give a smaller one"
                )));
            }
            let kinds = settings::views(View::Rgb, &args.film.beside);
            let mut views = Views::new(replay.stage(), size, &kinds).map_err(Failure::bad)?;
            hasard_media::png::write(&views.draw(replay.stage()), out).map_err(Failure::bad)?;
            finish(replay.stage().env(), args.json, Some(out), None)?;
            return compared(&replay, &args.file);
        }
        (Some(out), _) => {
            let film = play_out(&mut replay, out, size, &args.film, None)?;
            finish(replay.stage().env(), args.json, Some(out), Some(film))?;
        }
        _ => {
            while replay.tic() {}
            finish(replay.stage().env(), args.json, None, None)?;
        }
    }
    compared(&replay, &args.file)
}

/// A flag of films or pictures that changes nothing of what is written.
fn without_use(args: &FilmArgs, size: Option<Size>, kind: Option<Kind>) -> Option<&'static str> {
    let film = kind == Some(Kind::Film);
    let drawn = film || kind == Some(Kind::Picture);
    [
        ("--size", size.is_some() && !drawn),
        ("--beside", !args.beside.is_empty() && !drawn),
        ("--frame-every", args.frame_every.is_some() && !film),
        ("--quality", args.quality.is_some() && !film),
        ("--published-depth", args.looks.published_depth && !drawn),
        ("--published-colours", args.looks.published_colours && !drawn),
    ]
    .into_iter()
    .find_map(|(flag, without)| without.then_some(flag))
}

fn open(file: &Path, looks: &EnvOptions) -> Result<Replay, Failure> {
    let episode = EpisodeFile::read(file).map_err(Failure::bad)?;
    let replay = Replay::new(episode, file, looks).map_err(Failure::bad)?;
    let scenario = replay.stage().env().id().scenario;
    if let Some(changed) = own::changed(scenario, "the episode was recorded", "episode") {
        note!("hasard: {changed}");
    }
    Ok(replay)
}

fn begin(stage: &Stage, out: &Path, size: FrameSize, args: &FilmArgs) -> Result<Film, Failure> {
    let every = args.frame_every.unwrap_or(if is_gif(out) { 5 } else { 1 });
    let views = settings::views(View::Rgb, &args.beside);
    Film::begin_at(args.quality.unwrap_or_default(), stage, out, size, &views, every)
        .map_err(Failure::bad)
}

/// Steps that a film has at most.
fn longest(env: &Env, steps: Option<u32>) -> u64 {
    steps.map_or(env.episode_steps(), |most| most.min(env.episode_steps())).into()
}

/// Films a replay to its end, or to a number of steps.
fn play_out(
    replay: &mut Replay,
    out: &Path,
    size: FrameSize,
    args: &FilmArgs,
    steps: Option<u32>,
) -> Result<Film, Failure> {
    let mut film = begin(replay.stage(), out, size, args)?;
    let mut ticker = Ticker::new(longest(replay.stage().env(), steps), "steps");
    while steps.is_none_or(|most| replay.stage().env().episode().length < most) {
        ticker.at(replay.stage().env().episode().length.into());
        let more = replay.tic();
        film.tic(replay.stage()).map_err(Failure::bad)?;
        if !more {
            break;
        }
    }
    Ok(film)
}

/// Ends the film, if there is one, and prints how the episode went.
fn finish(env: &Env, as_json: bool, out: Option<&Path>, film: Option<Film>) -> Outcome {
    let film = film.map(Film::finish).transpose().map_err(Failure::bad)?;
    let episode = env.episode();
    let file = out.map(|out| out.display().to_string());
    if as_json {
        let (frames, size) = film.unzip();
        say!(
            "{}",
            json!({
                "env": env.id().to_string(), "seed": episode.seed, "return": episode.episode_return, "cost": episode.cost,
                "length": episode.length, "terminated": episode.terminated, "truncated": episode.truncated,
                "file": file, "frames": frames, "size": size,
            })
        );
        return Ok(());
    }
    let written = match (file, film) {
        (Some(file), Some((frames, (width, height)))) => {
            format!("{file}: {frames} frames of {width}x{height}; ")
        }
        (Some(file), None) => format!("{file}: "),
        _ => String::new(),
    };
    let (id, steps) = (env.id(), episode.length);
    say!(
        "{written}{id}, {steps} steps, return {:.3}, cost {:.3}",
        episode.episode_return,
        episode.cost
    );
    Ok(())
}
