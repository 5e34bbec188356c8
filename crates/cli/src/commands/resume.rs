//! `hasard train --resume`: a flag that contradicts the run in the directory changes the run where
//! a run may change, and is refused instead of ignored elsewhere.

use super::train_settings::configuration;
use crate::args::TrainArgs;
use crate::failure::Failure;
use clap::ArgMatches;
use clap::parser::ValueSource;
use hasard_learn::config::TrainConfig;
use hasard_learn::config::settings::{may_change, setting_pointer};
use serde_json::Value;
use std::path::Path;

/// Flags of `train`, as clap names them, and the settings that each decides, as pointers into
/// `config.json`.
const DECIDES: &[(&str, &[&str])] = &[
    ("frames", &["/frames"]),
    ("eval_every", &["/evaluation/every"]),
    ("algo", &["/algorithm"]),
    ("preset", &["/preset"]),
    ("curriculum", &["/curriculum"]),
    ("safety_budget", &["/constraints"]),
    ("constraint_statistic", &["/constraint_statistic"]),
    ("cost_scale", &["/algorithm_settings/penalty_scale"]),
    ("device", &["/device"]),
    ("sync", &["/sampling/synchronous"]),
    ("asynchronous", &["/sampling/synchronous"]),
    ("threads", &["/learning/threads", "/sampling/samplers"]),
    ("portable", &["/learning/portable"]),
    ("envs", &["/sampling/lanes"]),
    ("seed", &["/seed"]),
    ("rules", &["/env/rules"]),
    ("early_creatures", &["/env/early_creatures"]),
    ("hard", &["/env/hard"]),
    ("full_actions", &["/env/full_actions"]),
    ("frame_skip", &["/env/frame_skip"]),
    ("size", &["/env/size"]),
    ("iwad", &["/env/iwad"]),
    ("maps", &["/env/maps"]),
    ("observation", &["/env/observation"]),
    ("frame_stack", &["/env/frame_stack"]),
    ("published_depth", &["/env/published_depth"]),
    ("published_colours", &["/env/published_colours"]),
];

/// The flag of `train` that decides a setting, without dashes.
pub fn flag_of(setting: &str) -> Option<String> {
    let pointer = setting_pointer(setting);
    DECIDES.iter().find(|(_, pointers)| pointers.contains(&&*pointer)).map(|(id, _)| word_of(id))
}

fn word_of(id: &str) -> String {
    if id == "asynchronous" { "async".into() } else { id.replace('_', "-") }
}

/// Refuses a fresh run of which a flag and `--set` decide the same; and a seed by `--set`, which
/// the folder's name would not have.
pub fn check_said_once(args: &TrainArgs, typed: &ArgMatches) -> Result<(), Failure> {
    for text in &args.set {
        let name = text.split('=').next().unwrap_or_default();
        if name == "seed" {
            return Err(Failure::bad("--set seed: write --seed, by which the run is named"));
        }
        let pointer = setting_pointer(name);
        let same = DECIDES.iter().find(|(id, pointers)| {
            typed.value_source(id) == Some(ValueSource::CommandLine)
                && pointers.contains(&&*pointer)
        });
        if let Some((id, _)) = same {
            return Err(Failure::bad(format!(
                "--set {name} and --{} decide the same; leave one of them out",
                word_of(id)
            )));
        }
    }
    Ok(())
}

/// The settings that are to be others from here on, each as `NAME=VALUE`. Flags that were typed and
/// say something else than the run's settings are refused where a run cannot change; those that
/// repeat them are welcome: a sweep resumes a run with the command that began it.
pub fn settings(
    args: &TrainArgs,
    typed: &ArgMatches,
    saved: &TrainConfig,
    directory: &Path,
) -> Result<Vec<String>, Failure> {
    let given = |id: &str| typed.value_source(id) == Some(ValueSource::CommandLine);
    // What the command asks for, with the run's own settings wherever other defaults hang on them.
    let mut args = args.clone();
    if !given("algo") {
        args.algo = saved.algorithm.name().into();
    }
    if !given("preset") {
        args.preset = saved.preset.name().into();
    }
    if !given("frames") {
        args.frames = Some(saved.frames);
    }
    args.env.clone_from(&saved.env.id);
    if !given("device") {
        args.device.clone_from(&saved.device);
    }
    let asked = serde_json::to_value(configuration(&args)?).map_err(Failure::bad)?;
    let was = serde_json::to_value(saved).map_err(Failure::bad)?;
    let flags = DECIDES.iter().filter(|(id, _)| given(id));
    let mut places: Vec<(String, String)> = flags
        .flat_map(|(id, pointers)| {
            let flag = format!("--{}", word_of(id));
            pointers.iter().map(move |pointer| (flag.clone(), (*pointer).to_string()))
        })
        .collect();
    // A card is asked for all worlds at once, the processor's threads each have a share.
    if args.device != saved.device {
        let dealt = ["/sampling/samplers", "/sampling/world_threads"];
        places.extend(dealt.map(|pointer| ("--device".into(), pointer.into())));
    } else if args.device != "cpu" && given("threads") {
        places.push(("--threads".into(), "/sampling/world_threads".into()));
    }
    for text in &args.set {
        let name = text.split('=').next().unwrap_or_default();
        places.push((format!("--set {name}"), setting_pointer(name)));
        if name == "learning.rate" {
            // It decides the end of the schedule too.
            places.push((format!("--set {name}"), setting_pointer("learning.final_rate")));
        }
    }
    let mut changes = Vec::new();
    for (flag, pointer) in places {
        let (there, wanted) = (was.pointer(&pointer), asked.pointer(&pointer));
        if there == wanted {
            continue;
        }
        let name = pointer.trim_start_matches('/').replace('/', ".");
        // A run without maps or pictures of its own does not get any.
        if !may_change(&name) || there.is_none() {
            return Err(Failure::bad(format!(
                "{flag}: the run in {} has {}, not {}; leave {flag} out to go on with it, or begin another with --out",
                directory.display(),
                word(&name, there),
                word(&name, wanted),
            )));
        }
        let change = format!("{name}={}", wanted.unwrap_or(&Value::Null));
        if !changes.contains(&change) {
            changes.push(change);
        }
    }
    Ok(changes)
}

/// A setting as the flag that decides it has it: `--sync` and `--async` are of one.
fn word(name: &str, value: Option<&Value>) -> String {
    match (name, value.and_then(Value::as_bool)) {
        ("sampling.synchronous", Some(true)) => "sampling and learning in turn".into(),
        ("sampling.synchronous", Some(false)) => "sampling and learning side by side".into(),
        _ if name == "env.size" => show(value).replace(',', "x"),
        _ => show(value),
    }
}

/// A setting as a flag has it: a budget as `5` or `lava=3`, a lesson as `LEVEL:FRAMES`.
fn show(value: Option<&Value>) -> String {
    let joined =
        |items: &[Value]| items.iter().map(|item| show(Some(item))).collect::<Vec<_>>().join(",");
    match value {
        None | Some(Value::Null) => "none".into(),
        // Most settings are single-precision; more digits would be noise.
        Some(Value::Number(number)) if number.is_f64() => {
            (number.as_f64().unwrap_or_default() as f32).to_string()
        }
        Some(Value::String(text)) => text.clone(),
        Some(Value::Array(items)) => joined(items),
        Some(item @ Value::Object(fields)) => {
            let field = |name: &str| fields.get(name).map(|value| show(Some(value)));
            match (field("term").as_deref(), field("budget"), field("level"), field("frames")) {
                (Some("none"), Some(budget), ..) => budget,
                (Some(term), Some(budget), ..) => format!("{term}={budget}"),
                (_, _, Some(level), Some(frames)) => format!("{level}:{frames}"),
                _ => item.to_string(),
            }
        }
        Some(other) => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::Cli;
    use crate::commands::train_settings::tests::train;
    use clap::CommandFactory;

    #[test]
    fn flags_that_contradict_the_run_change_it_or_are_refused() {
        let began = "hasard train RemedyRushLevel1-v0 --algo PPOPID --preset quick --seed 3 --frames 9000 --curriculum 1,2 \
                     --safety-budget 7 --threads 1 --hard --set learning.gamma=0.9";
        let saved = configuration(&train(began).0).unwrap();
        let check = |line: &str| {
            let (args, typed) = train(line);
            settings(&args, &typed, &saved, Path::new("run"))
        };
        for fine in [
            "",
            "--algo ppopid --seed 3",
            "--hard --threads 1 --sync --device cpu",
            "--json --quiet",
        ] {
            let changes =
                check(&format!("hasard train RemedyRushLevel1-v0 --resume --out run {fine}"))
                    .unwrap();
            assert!(changes.is_empty(), "{fine}: {changes:?}");
        }
        assert!(check(&format!("{began} --resume --out run")).unwrap().is_empty());
        for (changed, expected) in [
            ("--frames 20000", &["frames=20000"][..]),
            ("--seed 1", &["seed=1"]),
            ("--threads 2", &["learning.threads=2", "sampling.samplers=2"]),
            ("--eval-every 4096", &["evaluation.every=4096"]),
            (
                "--device vulkan --threads 2",
                &["device=\"vulkan\"", "learning.threads=2", "sampling.world_threads=2"],
            ),
            ("--set learning.rate=0.0001", &["learning.rate=0.0001", "learning.final_rate=null"]),
        ] {
            let changes =
                check(&format!("hasard train RemedyRushLevel1-v0 --resume --out run {changed}"))
                    .unwrap();
            assert_eq!(changes, expected, "{changed}");
            saved.resumed_with(&changes, 4096).unwrap();
        }
        let on_a_card = configuration(&train(&format!("{began} --device vulkan")).0).unwrap();
        let (args, typed) =
            train("hasard train RemedyRushLevel1-v0 --resume --out run --threads 6");
        assert_eq!(
            settings(&args, &typed, &on_a_card, Path::new("run")).unwrap(),
            ["learning.threads=6", "sampling.world_threads=6"]
        );
        for (wrong, named) in [
            ("--algo PPOLag", "--algo: the run in run has PPOPID, not PPOLag"),
            ("--preset paper", "--preset: the run in run has quick, not paper"),
            ("--safety-budget 5", "--safety-budget: the run in run has 7, not 5;"),
            (
                "--safety-budget harmful_items=5",
                "--safety-budget: the run in run has 7, not harmful_items=5;",
            ),
            (
                "--curriculum 2:64,3:64",
                "--curriculum: the run in run has 1:4500,2:4500, not 2:64,3:64;",
            ),
            (
                "--async",
                "--async: the run in run has sampling and learning in turn, not sampling and learning side by side",
            ),
            ("--frame-skip 8", "--frame-skip: the run in run has 4, not 8"),
            ("--frame-skip 4 --size 64x48", "--size: the run in run has 128x72, not 64x48"),
            ("--set learning.gamma=0.99", "--set learning.gamma: the run in run has 0.9, not 0.99"),
            ("--iwad /some.wad", "--iwad: the run in run has none, not /some.wad"),
        ] {
            let line = format!("hasard train RemedyRushLevel1-v0 --resume --out run {wrong}");
            match check(&line) {
                Err(Failure::BadInput(message)) => {
                    assert!(message.starts_with(named), "{wrong}: {message}")
                }
                other => panic!("{wrong}: {other:?}"),
            }
        }
    }

    /// A flag that is added to `train` must be thought of here.
    #[test]
    fn every_flag_of_train_is_known_to_decide_something_or_nothing() {
        let harmless =
            ["env", "out", "resume", "init_from", "set", "json", "quiet", "help", "version"];
        let command = Cli::command();
        for argument in command.find_subcommand("train").unwrap().get_arguments() {
            let id = argument.get_id().as_str();
            assert!(
                harmless.contains(&id) != DECIDES.iter().any(|(known, _)| *known == id),
                "{id}"
            );
        }
    }
}
