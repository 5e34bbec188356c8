//! What the settings of `config.json` mean: the comments beside their fields, so that nothing is
//! said twice.

use hasard_envs::edit_distance;

/// A struct of settings: its place in `config.json`, its name, and the file that declares it.
const SOURCES: [(&str, &str, &str); 8] = [
    ("", "TrainConfig", include_str!("train_config.rs")),
    ("env.", "EnvConfig", include_str!("environment.rs")),
    ("network.", "NetworkConfig", include_str!("network.rs")),
    ("sampling.", "SamplingConfig", include_str!("sampling.rs")),
    ("learning.", "LearningConfig", include_str!("learning.rs")),
    ("algorithm_settings.", "AlgorithmConfig", include_str!("algorithm.rs")),
    ("evaluation.", "EvaluationConfig", include_str!("evaluation.rs")),
    ("reporting.", "ReportingConfig", include_str!("reporting.rs")),
];

/// A setting: its name in `config.json`, and what it means.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Explained {
    /// Its name, such as `learning.rate`.
    pub name: String,
    /// Its meaning.
    pub meaning: String,
}

/// Every setting, in the order of the files.
#[must_use]
pub fn settings() -> Vec<Explained> {
    let mut all = Vec::new();
    for (place, structure, source) in SOURCES {
        let head = format!("pub struct {structure} {{");
        let body = source
            .lines()
            .skip_while(|line| !line.starts_with(&head))
            .skip(1)
            .take_while(|line| *line != "}");
        let mut meaning: Vec<&str> = Vec::new();
        for line in body.map(str::trim) {
            if let Some(text) = line.strip_prefix("///") {
                meaning.push(text.trim());
            } else if line.starts_with("pub(") {
                // A field of older files alone is no setting, nor does its comment belong to the next.
                meaning.clear();
            } else if let Some((name, _)) =
                line.strip_prefix("pub ").and_then(|field| field.split_once(':'))
            {
                all.push(Explained { name: format!("{place}{name}"), meaning: meaning.join(" ") });
                meaning.clear();
            }
        }
    }
    all
}

/// The setting whose name is nearest to a text: alike in its last part or as a whole.
#[must_use]
pub fn nearest(text: &str) -> Option<String> {
    let last = |name: &str| name.rsplit('.').next().unwrap_or_default().to_string();
    let distance = |name: &str| {
        let whole = edit_distance(text, name);
        let alike = edit_distance(&last(text), &last(name)) + usize::from(last(name) != last(text));
        whole.min(alike)
    };
    let known = settings()
        .into_iter()
        .map(|one| one.name)
        .chain(SHORT.iter().map(|(short, _)| (*short).to_string()));
    let (found, name) = known.map(|name| (distance(&name), name)).min()?;
    let name = SHORT
        .iter()
        .find(|(short, _)| *short == name)
        .map_or(name.clone(), |(_, setting)| (*setting).to_string());
    (found <= 1 + last(text).len() / 3).then_some(name)
}

/// The setting of exactly a name, which may be its last part alone or what other programs call it.
#[must_use]
pub fn named(text: &str) -> Option<String> {
    if let Some((_, setting)) = SHORT.iter().find(|(short, _)| *short == text) {
        return Some((*setting).to_string());
    }
    settings()
        .into_iter()
        .map(|one| one.name)
        .find(|name| name == text || name.rsplit('.').next() == Some(text))
}

/// Names that other programs have for settings.
const SHORT: [(&str, &str); 14] = [
    ("lr", "learning.rate"),
    ("learning_rate", "learning.rate"),
    ("num_envs", "sampling.lanes"),
    ("n_envs", "sampling.lanes"),
    ("envs", "sampling.lanes"),
    ("n_steps", "sampling.rollout"),
    ("rollout_length", "sampling.rollout"),
    ("n_epochs", "learning.epochs"),
    ("gae_lambda", "learning.gae_lambda"),
    ("ent_coef", "learning.exploration_coefficient"),
    ("vf_coef", "learning.value_coefficient"),
    ("max_grad_norm", "learning.max_gradient_norm"),
    ("clip_range", "learning.clip_ratio"),
    ("total_timesteps", "frames"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, EnvConfig, Preset, TrainConfig};

    #[test]
    fn every_setting_is_explained_and_every_explanation_is_of_a_setting() {
        let mut env = EnvConfig::new("RemedyRushLevel1-v0");
        (env.iwad, env.maps) = (Some("a".into()), Some("a".into()));
        (env.published_depth, env.published_colours) = (true, true);
        let config = TrainConfig::new(AlgorithmKind::PpoLag, Preset::Paper, env).unwrap();
        let written = serde_json::to_value(&config).unwrap();
        let mut names = Vec::new();
        for (name, value) in written.as_object().unwrap() {
            match value.as_object() {
                Some(group) => names.extend(group.keys().map(|inner| format!("{name}.{inner}"))),
                None => names.push(name.clone()),
            }
        }
        let explained = settings();
        for name in names {
            let one = explained
                .iter()
                .find(|one| one.name == name)
                .unwrap_or_else(|| panic!("{name} is not explained"));
            assert!(one.meaning.ends_with('.') && one.meaning.len() > 3, "{one:?}");
        }
        // The comment of a field that only older files have is not the next one's.
        let gains = explained.iter().find(|one| one.name.ends_with("pid_gains")).unwrap();
        assert!(gains.meaning.starts_with("PID: "), "{gains:?}");
    }

    #[test]
    fn other_names_lead_to_ours() {
        for (given, name) in [
            ("learning.lr", "learning.rate"),
            ("rate", "learning.rate"),
            ("lr", "learning.rate"),
            ("learning.gama", "learning.gamma"),
            ("sampling.lane", "sampling.lanes"),
            ("num_envs", "sampling.lanes"),
            ("network.recurent", "network.recurrent"),
        ] {
            assert_eq!(nearest(given).as_deref(), Some(name), "{given}");
        }
        assert_eq!(nearest("the weather in June"), None);
        assert_eq!(named("gamma").as_deref(), Some("learning.gamma"));
        assert_eq!(named("quiet"), None);
    }
}
