//! The command that trains a run again, from its settings.

use crate::zoo;
use hasard_learn::config::{EnvConfig, Preset, TrainConfig};
use hasard_media::shell::quote;
use serde_json::{Value, json};
use std::path::Path;

/// The command that trains and selects the same agent: all settings but those of machine and
/// reports.
pub fn command(config: &TrainConfig) -> String {
    let (env, usual) = (&config.env, EnvConfig::new(&config.env.id));
    // A task of the user's is named by its file.
    let named = |id: &str| {
        let known = id.parse::<hasard_envs::EnvId>();
        let file = known.ok().and_then(|id| Some((id.scenario.file?.path, id.level)));
        match file {
            Some((path, level)) if level > 1 => format!("{path}#{level}"),
            Some((path, _)) => path.to_string(),
            None => id.to_string(),
        }
    };
    let task = env.id.split(',').map(named).collect::<Vec<_>>().join(",");
    let task = quote(Path::new(&task));
    let mut words = vec![format!(
        "hasard train {task} --algo {} --preset {} --frames {} --seed {}",
        config.algorithm, config.preset, config.frames, config.seed
    )];
    if let Some(init_from) = &config.init_from {
        words.push(format!("--init-from {}", quote(zoo::name(init_from))));
    }
    // Said always where the preset's own rules might be others.
    if env.rules != usual.rules || config.preset == Preset::Tables {
        words.push(format!("--rules {}", env.rules));
    }
    for (flag, is_on) in [
        ("early-creatures", env.early_creatures),
        ("hard", env.hard),
        ("full-actions", env.full_actions),
        ("published-depth", env.published_depth),
        ("published-colours", env.published_colours),
    ] {
        words.extend(is_on.then(|| format!("--{flag}")));
    }
    for (name, own, usual) in [
        ("frame-skip", env.frame_skip.to_string(), usual.frame_skip.to_string()),
        (
            "size",
            format!("{}x{}", env.size.0, env.size.1),
            format!("{}x{}", usual.size.0, usual.size.1),
        ),
        ("observation", env.observation.clone(), usual.observation),
        ("frame-stack", env.frame_stack.to_string(), usual.frame_stack.to_string()),
    ] {
        words.extend((own != usual).then(|| format!("--{name} {own}")));
    }
    if !config.curriculum.is_empty() {
        let lessons = config.curriculum.iter().map(|one| format!("{}:{}", one.level, one.frames));
        words.push(format!("--curriculum {}", lessons.collect::<Vec<_>>().join(",")));
    }
    // What the preset makes of the same environment.
    if let Ok(mut plain) = TrainConfig::new(config.algorithm, config.preset, env.clone()) {
        plain.seed = config.seed;
        plain.set_frames(config.frames);
        if plain.sampling.lanes != config.sampling.lanes {
            words.push(format!("--envs {}", config.sampling.lanes));
            plain.set_lanes(config.sampling.lanes);
        }
        let plain = plain.begun();
        if plain.constraints != config.constraints {
            words.extend(config.constraints.iter().map(|one| match &one.term {
                None => format!("--safety-budget {}", one.budget),
                Some(term) => format!("--safety-budget {term}={}", one.budget),
            }));
        }
        if config.learning.schedule_frames != Some(config.frames) {
            let frames = json!(config.learning.schedule_frames);
            words.push(format!("--set learning.schedule_frames={frames}"));
        }
        for (name, _, value) in plain.all_unlike(config) {
            match name.as_str() {
                "constraints" | "curriculum" | "init_from" => {}
                "constraint_statistic" => {
                    words.push(format!("--constraint-statistic {}", config.constraint_statistic));
                }
                "sampling.synchronous" => words.push("--async".into()),
                "learning.portable" => words.push("--portable".into()),
                _ => words.push(set(&name, &value)),
            }
        }
        // They change no step of the training, but which of its checkpoints is selected.
        let (usual, own) = (json!(plain.evaluation), json!(config.evaluation));
        let own = own.as_object().into_iter().flatten();
        words.extend(
            own.filter(|(name, value)| usual.get(name) != Some(value))
                .map(|(name, value)| set(&format!("evaluation.{name}"), value)),
        );
    }
    words.join(" ")
}

fn set(name: &str, value: &Value) -> String {
    format!("--set {}", quote(Path::new(&format!("{name}={value}"))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::train_settings::tests::config;
    use hasard_learn::config::InitFrom;

    /// Another machine has the program's agents by their names, not the folder they were read from.
    #[test]
    fn weights_of_the_program_are_named_wherever_they_were_read() {
        let place = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../zoo/RemedyRushLevel1.agent");
        let mut wanted = config("--seed 3").unwrap().begun();
        let read = InitFrom::at(&place, &mut |_| ()).unwrap();
        wanted.init_from = Some(read.clone());
        let words = command(&wanted);
        assert!(words.replace('\'', "").ends_with("--init-from zoo:RemedyRushLevel1"), "{words}");
        let sha256 = "0".repeat(64);
        wanted.init_from = Some(InitFrom { sha256, ..read });
        assert!(command(&wanted).contains(&format!("--init-from {}", quote(&place))));
    }

    /// What it writes, typed again, gives the same settings.
    #[test]
    fn the_command_of_a_run_trains_it_again() {
        for line in [
            "",
            "--preset tables --seed 4 --frames 5000",
            "--preset paper --algo TRPOLag --rules released --hard --full-actions",
            "--init-from zoo:RemedyRushLevel1 --seed 3",
            "--safety-budget 7.5 --observation segmented --size 64x48 --envs 8 --frame-stack 2",
            "--safety-budget 50 --safety-budget zone_visits=2 --constraint-statistic cvar:0.1",
            "--curriculum 1,2,3 --frames 3000 --set learning.gamma=0.5 --set network.dense=[32,16]",
            "--eval-every 500 --set evaluation.candidates=3 --set evaluation.surely=false",
            "--set learning.rate=0.001 --set learning.products=bfloat16 --set algorithm_settings.pid_gains=[1,0.5,0]",
        ] {
            let wanted = config(line).unwrap().begun();
            let words = command(&wanted);
            // A curriculum is of a scenario: the level that its last lesson leaves there is as good.
            let again = config(&words.split_once("-v0").unwrap().1.replace('\'', ""));
            let again = again.unwrap().begun();
            assert_eq!(again.all_unlike(&wanted), [], "{line}: {words}");
            assert_eq!(json!(again.evaluation), json!(wanted.evaluation), "{line}: {words}");
        }
    }
}
