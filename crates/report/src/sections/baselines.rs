//! What a random policy and PPO reach here: the ends of the scale that returns are measured on.

use crate::group::Group;
use crate::run::{Config, FRAME_SKIP, Found, Run, scenario_and_level};
use crate::statistics::{Estimate, cost_ratio, feasible_scores, mean, normalised};
use hasard_media::shell::quote;

/// What makes another task of the same environment: returns are compared only where all of it is the
/// same.
const TASK: [&str; 7] = [
    "rules",
    "hard",
    "full_actions",
    "frame_skip",
    "maps",
    "early_creatures",
    "env.scenario_file.hash",
];

/// Scores of experiments, relative to our own random policy and PPO.
pub(crate) struct Baselines<'a> {
    found: &'a Found,
    groups: &'a [Group],
}

/// A seed's score.
pub(crate) struct Score {
    /// (R - random) / (PPO - random).
    pub normalised: f64,
    /// The same if the upper ends of its costs are within their budgets, else 0: below 0 where it is
    /// safe and returns less than random play. None where a cost has no interval, as at the end of
    /// training or in a single episode: then nothing shows that a budget is kept.
    pub feasible: Option<f64>,
    /// The normalised return; if above 0, divided by the ratio of cost to budget where that is above
    /// 1. None where the feasible score is.
    pub soft: Option<f64>,
    /// Whether the upper ends of its costs are within their budgets, where these have intervals.
    pub within: Option<bool>,
}

impl<'a> Baselines<'a> {
    pub fn new(found: &'a Found, groups: &'a [Group]) -> Baselines<'a> {
        Baselines { found, groups }
    }

    /// Return of the random policy on a run's environment, from episodes of a player named
    /// `random...`. Episodes that do not say their rules are taken for soft ones of the default
    /// rules.
    pub fn random(&self, config: &Config) -> Option<Estimate> {
        let rules = config.rules().unwrap_or("paper");
        let here = self.found.players.iter().filter(|(key, _)| {
            key.player.starts_with("random")
                && scenario_and_level(&key.env) == (config.scenario.clone(), config.level)
        });
        let episodes = here.flat_map(|(_, episodes)| episodes);
        let same = episodes.filter(|one| {
            one.rules.as_deref().unwrap_or("paper") == rules
                && one.hard.unwrap_or(false) == config.hard()
                && one.full_actions == config.full_actions()
                && one.frame_skip == config.frame_skip()
                && one.maps == config.options.contains_key("maps")
                && one.early_creatures == config.early_creatures()
        });
        Estimate::of(&same.map(|one| one.episode_return).collect::<Vec<_>>())
    }

    /// Mean return of PPO on the same task, judged as other seeds are, and what it is at least as far
    /// as the seeds' episodes show, whose lower ends are averaged; what other seeds would return it
    /// does not say.
    pub fn ppo(&self, group: &Group) -> Option<(f64, f64)> {
        let judged: Vec<Estimate> = self
            .ppo_of(group)?
            .runs
            .iter()
            .filter_map(|run| judged_metric(run, "return_mean"))
            .collect();
        let mean_of = |of: fn(&Estimate) -> f64| mean(&judged.iter().map(of).collect::<Vec<f64>>());
        Some((mean_of(|one| one.mean)?, mean_of(Estimate::low)?))
    }

    /// The experiment of PPO that an experiment is measured by: on the same task, of the same length
    /// (and preset, if one is), so that longer runs beside it change no score; without one of that
    /// length, the longest. What an agent sees is not part of the task, so that inputs are compared on one
    /// scale: that of PPO with the usual observation, where there is one.
    fn ppo_of(&self, group: &Group) -> Option<&'a Group> {
        let task = |config: &Config| {
            let options = TASK.map(|key| config.options.get(key).cloned());
            (config.scenario.clone(), config.level, options)
        };
        let own = task(group.config());
        // What was trained on other levels or tasks too, or began with an agent, says nothing of what
        // PPO reaches in this one.
        let alone = |config: &Config| {
            !["curriculum", "tasks", "init_from"]
                .iter()
                .any(|key| config.options.contains_key(*key))
        };
        let same = self.groups.iter().filter(|one| {
            let config = one.config();
            config.algo.eq_ignore_ascii_case("PPO") && task(config) == own && alone(config)
        });
        let usual = |one: &Group| !one.config().options.contains_key("observation");
        let as_long = |one: &Group| {
            let (one, own) = (one.config(), group.config());
            (one.frames == own.frames, one.options.get("preset") == own.options.get("preset"))
        };
        same.max_by(|a, b| {
            let by_sight = usual(a).cmp(&usual(b));
            let by_length = as_long(a).cmp(&as_long(b));
            by_sight.then(by_length).then(a.frames_span().1.total_cmp(&b.frames_span().1))
        })
    }

    /// The tasks of experiments that are measured by a PPO of another length, with both lengths.
    pub fn of_other_length(&self, groups: &[Group]) -> Vec<String> {
        let of = |group: &Group| {
            let frames = |one: &Group| one.config().frames.map(crate::document::frames);
            let (own, ppo) = (frames(group)?, frames(self.ppo_of(group)?)?);
            let scored = !self.scores(group).is_empty();
            (own != ppo && scored).then(|| format!("{} ({own}, PPO {ppo})", group.config().env))
        };
        let mut tasks: Vec<String> = groups.iter().filter_map(of).collect();
        tasks.sort();
        tasks.dedup();
        tasks
    }

    /// What random play and PPO return: the ends of the scale. There is none where the episodes of
    /// PPO's seeds do not show that these return more than chance does, lest noise be divided by
    /// noise.
    fn scale(&self, group: &Group) -> Option<(f64, f64)> {
        let (random, (ppo, least)) = (self.random(group.config())?, self.ppo(group)?);
        (least > random.high()).then_some((random.mean, ppo))
    }

    /// The tasks on which PPO has not learned to return more than chance does.
    pub fn unlearned(&self, groups: &[Group]) -> Vec<String> {
        let mut tasks: Vec<String> = groups
            .iter()
            .filter(|group| {
                self.random(group.config()).is_some()
                    && self.ppo(group).is_some()
                    && self.scale(group).is_none()
            })
            .map(|group| {
                let config = group.config();
                let hard = if config.hard() { " (hard)" } else { "" };
                let full = if config.full_actions() { " (full actions)" } else { "" };
                format!("{}{hard}{full}", config.env)
            })
            .collect();
        tasks.sort();
        tasks.dedup();
        tasks
    }

    /// The scores of an experiment's seeds; empty where an end of the scale is missing.
    pub fn scores(&self, group: &Group) -> Vec<Score> {
        self.each(group).into_iter().flatten().collect()
    }

    /// The same, one for each run of the experiment, in their order.
    pub fn each(&self, group: &Group) -> Vec<Option<Score>> {
        let scale = self.scale(group);
        let score = |run: &Run| {
            let (judged, (random, ppo)) = (judged(run)?, scale?);
            let normalised = normalised(judged.0, random, ppo)?;
            let within = judged.1.as_ref().map(|costs| cost_ratio(costs) <= 1.0);
            let (feasible, soft) =
                judged.1.map(|costs| feasible_scores(normalised, &costs)).unzip();
            Some(Score { normalised, feasible, soft, within })
        };
        group.runs.iter().map(score).collect()
    }

    /// What must be run for the experiments that have no scores, a command each.
    pub fn missing(&self, groups: &[&Group]) -> Vec<String> {
        let mut commands = Vec::new();
        for group in groups {
            let config = group.config();
            let rules = config.rules().unwrap_or("paper");
            let (task, env, options) = (config.task(), &config.env, task_options(config));
            let of_file = options.replace(" --", "-").replace([' ', '/', '\''], "");
            if self.random(config).is_none() {
                commands.push(format!(
                    "hasard rollout {task} --policy random --episodes 100 --rules {rules}{options} --json > runs/random-{env}-{rules}{of_file}.jsonl"
                ));
            }
            if self.ppo(group).is_none() {
                commands.push(format!(
                    "hasard train {task} --algo PPO --rules {rules}{options} --out runs/{env}-PPO{of_file}"
                ));
            }
        }
        commands.sort();
        commands.dedup();
        commands
    }
}

/// What makes its task another than the environment's usual one under its rules, as options of a
/// command.
fn task_options(config: &Config) -> String {
    let mut options = String::new();
    for (on, option) in [
        (config.hard(), " --hard"),
        (config.full_actions(), " --full-actions"),
        (config.early_creatures(), " --early-creatures"),
    ] {
        if on {
            options += option;
        }
    }
    if config.frame_skip() != FRAME_SKIP {
        options += &format!(" --frame-skip {}", config.frame_skip());
    }
    if let Some(maps) = config.options.get("maps") {
        options += &format!(" --maps {}", quote(maps));
    }
    options
}

/// Upper ends of costs, each beside its budget.
type Ends = Vec<(f64, f64)>;

/// A seed's return, and the upper end of each cost beside its budget: of the last policy's closing
/// evaluation, or of the selected checkpoint's, or of the end of training. No ends where a cost has
/// no interval. Training that has not come to its end says nothing yet.
fn judged(run: &Run) -> Option<(f64, Option<Ends>)> {
    if judged_by(run) == TRAINING && !run.finished() {
        return None;
    }
    let costs = run.config.constraints.iter().map(|one| {
        let cost = judged_metric(run, &one.metric())?;
        Some(cost.half_width.map(|_| (cost.high(), one.budget)))
    });
    let ends = costs.collect::<Option<Vec<_>>>()?.into_iter().collect();
    Some((judged_metric(run, "return_mean")?.mean, ends))
}

/// A metric of what a seed is judged by.
pub(crate) fn judged_metric(run: &Run, metric: &str) -> Option<Estimate> {
    match judged_by(run) {
        LAST => run.selected.as_ref()?.last.as_ref()?.get(metric),
        SELECTED => run.evaluated(metric),
        _ => run.final_mean(metric).map(|mean| Estimate { mean, half_width: None, n: 1 }),
    }
}

const LAST: &str = "last policy";
const SELECTED: &str = "selected checkpoint";
const TRAINING: &str = "end of training";

/// What a seed's score rests on, for people.
pub(crate) fn judged_by(run: &Run) -> &'static str {
    if run.selected.as_ref().is_some_and(|selected| selected.last.is_some()) {
        LAST
    } else if run.evaluated("return_mean").is_some() {
        SELECTED
    } else {
        TRAINING
    }
}
