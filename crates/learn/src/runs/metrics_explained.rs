//! Every key of `metrics.jsonl`: its unit and what it means. `hasard metrics` prints them.

/// A key of a row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Metric {
    /// Its name; `TERM` stands for a cost term's name, `NAME` for a statistic's.
    pub name: &'static str,
    /// Its unit; empty for texts and plain numbers.
    pub unit: &'static str,
    /// When a row has it; empty for always.
    pub when: &'static str,
    /// What it means.
    pub meaning: &'static str,
}

const fn metric(
    name: &'static str,
    unit: &'static str,
    when: &'static str,
    meaning: &'static str,
) -> Metric {
    Metric { name, unit, when, meaning }
}

const CRITIC: &str = "algorithms with critics of costs";
const SECOND: &str = "TRPO, TRPOLag, TRPOPID, CPO";
const TASKS: &str = "runs of several tasks";
const EVALUATED_TASKS: &str = "rows with an evaluation, runs of several tasks";
const EVALUATED: &str = "rows with an evaluation";
const SEVERAL: &str = "several constraints";
const NAMED: &str = "a constraint on a named cost term";

/// All of them, in the order of a row.
pub const METRICS: &[Metric] = &[
    metric("frames", "frames", "", "Frames learned from so far. 1 step is frame_skip frames."),
    metric("level", "", "curricula", "Level of the lesson at present."),
    metric("updates", "", "", "Steps of the optimiser so far."),
    metric(
        "kernels",
        "",
        "",
        "Instructions that the networks were computed with: amxbf16, avx512bf16, avx512, avx2 or plain; or the device.",
    ),
    metric("threads", "threads", "", "Threads of learner and samplers."),
    metric("wall_s", "s", "", "Seconds of work so far, those before a resume included."),
    metric("fps", "frames/s", "", "Frames per second since the row before."),
    metric("episodes", "episodes", "", "Training episodes that have ended so far."),
    metric(
        "return_mean",
        "reward",
        "",
        "Mean return of the latest training episodes (reporting.window, 100); nothing (null) before the first has ended.",
    ),
    metric("cost_mean", "cost", "", "Mean cost of the same episodes."),
    metric("length_mean", "steps", "", "Mean length of the same episodes."),
    metric("return_min", "reward", "", "Smallest return among them."),
    metric("return_max", "reward", "", "Largest return among them."),
    metric("cost_min", "cost", "", "Smallest cost among them."),
    metric("cost_max", "cost", "", "Largest cost among them."),
    metric("cost_total", "cost", "", "Cost of all training episodes so far, added up."),
    metric(
        "violation_total",
        "cost",
        "",
        "What training episodes cost beyond the first budget, added up: the sum of max(0, cost - budget).",
    ),
    metric("budget", "cost", "", "Budget of the first constraint, an episode."),
    metric(
        "multiplier",
        "reward/cost",
        "",
        "Lagrange multiplier or penalty of the first constraint; nothing (null) for algorithms without one.",
    ),
    metric("budgets", "cost", SEVERAL, "Budget of each constraint."),
    metric("multipliers", "reward/cost", SEVERAL, "Multiplier of each constraint."),
    metric("violation_totals", "cost", SEVERAL, "violation_total of each constraint."),
    metric(
        "constraint_costs",
        "cost",
        NAMED,
        "Mean cost of the latest episodes under each constraint.",
    ),
    metric(
        "eval/return_mean",
        "reward",
        EVALUATED,
        "Mean return of the evaluation episodes of this moment's policy.",
    ),
    metric(
        "eval/return_ci95",
        "reward",
        EVALUATED,
        "Half-width of its 95 % interval (Student's t).",
    ),
    metric("eval/cost_mean", "cost", EVALUATED, "Mean cost of the evaluation episodes."),
    metric("eval/cost_ci95", "cost", EVALUATED, "Half-width of its 95 % interval."),
    metric("eval/length_mean", "steps", EVALUATED, "Mean length of the evaluation episodes."),
    metric("eval/length_ci95", "steps", EVALUATED, "Half-width of its 95 % interval."),
    metric(
        "eval/cost/TERM",
        "cost",
        "rows with an evaluation, a constraint on TERM",
        "Mean cost of the evaluation episodes by that term.",
    ),
    metric(
        "eval/cost_cvar10",
        "cost",
        EVALUATED,
        "Mean cost of the worst tenth of the evaluation episodes.",
    ),
    metric("eval/cost_worst", "cost", EVALUATED, "Cost of the worst evaluation episode."),
    metric(
        "eval/over_budget",
        "share",
        EVALUATED,
        "Share of the evaluation episodes that cost more than the first budget, 0 to 1.",
    ),
    metric(
        "eval/frames",
        "frames",
        EVALUATED,
        "Frames of all evaluations so far. They are not part of frames.",
    ),
    metric("eval/episodes", "episodes", EVALUATED, "Episodes of this evaluation."),
    metric(
        "eval/within_budget",
        "",
        EVALUATED,
        "1 if every constraint's mean cost is within its budget, else 0.",
    ),
    metric(
        "seconds_waiting",
        "s",
        "",
        "Seconds that the learner waited for a rollout, mean since the row before.",
    ),
    metric(
        "policy_lag",
        "updates",
        "",
        "Updates between the policy that acted and the one that learns from it. 0 with --sync.",
    ),
    metric("learning_rate", "", "", "Learning rate of Adam at present."),
    metric(
        "aimed_budget",
        "cost",
        "learning.budget_annealing, budget_margin",
        "Cost of an episode that learning aims at, where budgets come down or leave room for how costs scatter, of a constraint on the whole cost.",
    ),
    metric("aimed_budget/TERM", "cost", NAMED, "The same of the constraint on a named term."),
    metric(
        "explained_variance",
        "share",
        "",
        "Share of the variance of returns that the critic explains: 1 is perfect, 0 no better than the mean.",
    ),
    metric("cost_explained_variance", "share", CRITIC, "The same of the cost critic."),
    metric(
        "cost_explained_variance/TERM",
        "share",
        NAMED,
        "The same of the critic of a named term.",
    ),
    metric("policy_loss", "", "", "Loss of the policy alone, as the algorithm defines it."),
    metric(
        "exploration_loss",
        "",
        "all but TRPO, TRPOLag, TRPOPID and CPO",
        "Exploration term of the loss, with its coefficient.",
    ),
    metric("value_loss", "", "", "Loss of the critic, in units of normalised returns."),
    metric("cost_value_loss", "", CRITIC, "Loss of the cost critic."),
    metric("cost_value_loss/TERM", "", NAMED, "Loss of the critic of a named term."),
    metric(
        "value",
        "",
        "all but TRPO, TRPOLag, TRPOPID and CPO",
        "Mean value that the critic predicts, in normalised returns.",
    ),
    metric("entropy", "nats", "", "Mean entropy of the policy: how random its actions are."),
    metric(
        "kl_divergence",
        "nats",
        "",
        "Mean divergence KL(old, new) of the policy over a minibatch.",
    ),
    metric(
        "approx_kl",
        "nats",
        "",
        "Mean of r - 1 - ln r, the usual estimate of the divergence; r is the ratio of probabilities.",
    ),
    metric(
        "ratio_deviation",
        "",
        "",
        "Mean of |r - 1|: how far ratios are from 1. 0 where each rollout is learned from once, by --sync.",
    ),
    metric(
        "clip_fraction",
        "share",
        "",
        "Share of samples whose ratio is beyond the clip, 0 to 1.",
    ),
    metric(
        "auxiliary_depth_loss",
        "nats",
        "learning.auxiliary_depth",
        "Cross entropy of the predicted depth, mean over cells, without its weight. 2.08 is a guess among eight bands.",
    ),
    metric(
        "auxiliary_labels_loss",
        "nats",
        "learning.auxiliary_labels",
        "The same of the predicted groups of things. 2.40 is a guess among ten groups and none.",
    ),
    metric("loss", "", "", "The whole loss; of TRPO, TRPOLag, TRPOPID and CPO the critics'."),
    metric("gradient_norm", "", "", "Norm of its gradient before it is cut."),
    metric(
        "epochs",
        "",
        "",
        "Epochs over a rollout. Fewer than asked for where target_kl ended them.",
    ),
    metric(
        "value_phase_loss",
        "",
        "learning.value_phase",
        "Half the squared error of all critics in their own epochs, in units of normalised returns.",
    ),
    metric(
        "value_phase_divergence",
        "nats",
        "learning.value_phase",
        "Mean divergence of the policy in these epochs from what it was before them.",
    ),
    metric("value_phase_epochs", "", "learning.value_phase", "Epochs of the critics alone."),
    metric("policy_cost_loss", "", "P3O", "The penalty in the loss."),
    metric("projection_loss", "", "CUP", "Loss of the second step."),
    metric("projection_epochs", "", "CUP", "Epochs of the second step."),
    metric(
        "step_share",
        "share",
        SECOND,
        "Share of the full step that the line search took; 0 where it found none.",
    ),
    metric(
        "recovery",
        "share",
        "CPO",
        "Share of steps that only lower the cost, since none could keep the budget.",
    ),
    metric(
        "seconds_learning",
        "s",
        "",
        "Seconds of learning from a rollout, mean since the row before.",
    ),
    metric(
        "cost/TERM",
        "cost",
        "",
        "Mean cost of the latest training episodes by each cost term, counted or not.",
    ),
    metric(
        "stats/NAME",
        "",
        "",
        "Mean of each of the scenario's statistics over the latest training episodes.",
    ),
    metric(
        "task/ID/return",
        "reward",
        TASKS,
        "Mean return of the latest training episodes of that task.",
    ),
    metric(
        "task/ID/cost",
        "cost",
        TASKS,
        "Mean cost of the latest training episodes of that task.",
    ),
    metric(
        "task/ID/length",
        "steps",
        TASKS,
        "Mean length of the latest training episodes of that task.",
    ),
    metric(
        "eval/task/ID/return",
        "reward",
        EVALUATED_TASKS,
        "Mean return of the evaluation episodes of that task.",
    ),
    metric(
        "eval/task/ID/cost",
        "cost",
        EVALUATED_TASKS,
        "Mean cost of the evaluation episodes of that task.",
    ),
    metric(
        "eval/task/ID/length",
        "steps",
        EVALUATED_TASKS,
        "Mean length of the evaluation episodes of that task.",
    ),
];

/// What a key of a row means; `eval/cost/lava` is explained as `eval/cost/TERM`.
#[must_use]
pub fn explain(key: &str) -> Option<&'static Metric> {
    METRICS.iter().find(|metric| {
        let pattern = metric.name;
        let placeholder = ["TERM", "NAME", "ID"].iter().find_map(|word| pattern.split_once(word));
        match placeholder {
            Some((head, tail)) => key
                .strip_prefix(head)
                .and_then(|rest| rest.strip_suffix(tail))
                .is_some_and(|name| !name.is_empty() && !name.contains('/')),
            None => key == pattern,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_explained_once_and_in_sentences() {
        for (index, metric) in METRICS.iter().enumerate() {
            assert!(metric.meaning.ends_with('.') && metric.meaning.len() > 10, "{metric:?}");
            assert!(METRICS[..index].iter().all(|other| other.name != metric.name), "{metric:?}");
        }
        assert_eq!(explain("eval/cost/lava").unwrap().name, "eval/cost/TERM");
        assert_eq!(explain("cost/lava").unwrap().name, "cost/TERM");
        let of_task = explain("eval/task/RemedyRushLevel1-v0/cost").unwrap();
        assert_eq!(of_task.name, "eval/task/ID/cost");
        assert_eq!(explain("frames").unwrap().unit, "frames");
        assert!(["eval/cost/", "cost/a/b", "fram", ""].iter().all(|key| explain(key).is_none()));
    }
}
