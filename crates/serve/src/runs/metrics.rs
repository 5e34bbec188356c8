//! The numbers of a run's rows, in groups: what each means is the trainer's to say.

use hasard_learn::runs::metrics_explained::explain;
use serde_json::{Value, json};

/// Groups in the order in which they are listed, with their numbers in order; one that ends in `*`
/// stands for all that begin so.
const GROUPS: [(&str, &[&str]); 10] = [
    (
        "training episodes",
        &[
            "return_mean",
            "cost_mean",
            "length_mean",
            "return_min",
            "return_max",
            "cost_min",
            "cost_max",
            "episodes",
            "level",
        ],
    ),
    (
        "evaluation",
        &["eval/return_mean", "eval/cost_mean", "eval/over_budget", "eval/cost_cvar10", "eval/*"],
    ),
    ("tasks", &["task/*"]),
    (
        "constraints",
        &[
            "multiplier*",
            "budget*",
            "aimed_budget*",
            "violation_total*",
            "cost_total",
            "constraint_costs*",
            "recovery",
        ],
    ),
    ("cost terms", &["cost/*"]),
    ("task", &["stats/*"]),
    (
        "policy",
        &[
            "entropy",
            "kl_divergence",
            "approx_kl",
            "clip_fraction",
            "ratio_deviation",
            "step_share",
            "policy_loss",
            "policy_cost_loss",
            "projection_loss",
            "exploration_loss",
        ],
    ),
    (
        "critics",
        &[
            "explained_variance",
            "cost_explained_variance*",
            "value_loss",
            "cost_value_loss*",
            "value",
            "value_phase_loss",
            "value_phase_divergence",
            "value_phase_epochs",
            "auxiliary_depth_loss",
            "auxiliary_labels_loss",
        ],
    ),
    (
        "optimiser",
        &[
            "loss",
            "gradient_norm",
            "learning_rate",
            "epochs",
            "projection_epochs",
            "updates",
            "policy_lag",
        ],
    ),
    ("speed", &["fps", "wall_s", "seconds_waiting", "seconds_learning", "threads"]),
];

fn fits(pattern: &str, name: &str) -> bool {
    pattern.strip_suffix('*').map_or(pattern == name, |beginning| name.starts_with(beginning))
}

/// Its group and its place within; those of no group come last.
pub(crate) fn place(name: &str) -> (usize, usize) {
    let found = GROUPS.iter().enumerate().find_map(|(group, (_, patterns))| {
        Some((group, patterns.iter().position(|pattern| fits(pattern, name))?))
    });
    found.unwrap_or((GROUPS.len(), 0))
}

/// A number for the page's list: name, group, unit, meaning.
pub(crate) fn listed(name: &str) -> Value {
    // Numbers of one constraint of several have its place in the list for an ending.
    let explained = explain(name).or_else(|| explain(name.rsplit_once('.')?.0));
    let group = GROUPS.get(place(name).0).map_or("other", |(group, _)| group);
    json!({
        "name": name, "group": group, "unit": explained.map_or("", |one| one.unit),
        "meaning": explained.map_or("", |one| one.meaning),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use hasard_learn::runs::metrics_explained::METRICS;

    #[test]
    fn every_number_of_a_row_has_its_group() {
        for metric in METRICS.iter().filter(|metric| !["frames", "kernels"].contains(&metric.name))
        {
            assert_ne!(listed(metric.name)["group"], "other", "{}", metric.name);
        }
        assert_eq!(listed("multipliers.1")["meaning"], "Multiplier of each constraint.");
        let mut names = ["fps", "cost/lava", "cost_mean", "eval/cost_mean", "return_mean"];
        names.sort_by_key(|name| place(name));
        assert_eq!(names, ["return_mean", "cost_mean", "eval/cost_mean", "cost/lava", "fps"]);
    }
}
