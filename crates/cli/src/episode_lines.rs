//! How episodes are printed: a JSON object each, or a row of a table and the mean at its end.

use crate::failure::{Failure, Outcome};
use hasard_envs::{EnvOptions, Episode, RuleSet};
use hasard_learn::config::Constraint;
use hasard_learn::runs::episode_row::episode_row;
use hasard_learn::runs::evaluate::{Evaluation, Judgement, TaskEvaluation};
use hasard_learn::statistics::{Estimate, Tails};
use hasard_report::document::count;
use serde_json::{Map, Value, json};
use std::io::Write;

/// Prints episodes as they end, and keeps what the summary needs.
pub struct EpisodeLines {
    json: bool,
    episodes: Vec<Episode>,
    constraints: Vec<Constraint>,
    under: Option<Under>,
}

/// What an episode was played under, as far as another episode's return is not comparable.
#[derive(Clone, Copy)]
pub struct Under {
    rules: RuleSet,
    hard: bool,
    full_actions: bool,
    frame_skip: u32,
    early_creatures: bool,
    maps: bool,
}

impl Under {
    /// Of the worlds of these options.
    pub fn of(options: &EnvOptions) -> Under {
        let EnvOptions { rules, hard, full_actions, frame_skip, early_creatures, .. } = *options;
        let maps = options.maps.is_some();
        Under { rules, hard, full_actions, frame_skip, early_creatures, maps }
    }

    /// The same for people: what is not usual, and the rules in any case.
    fn words(self) -> String {
        let mut words = format!(", rules {}", self.rules.name());
        if self.hard {
            words += ", hard";
        }
        if self.full_actions {
            words += ", full actions";
        }
        if self.frame_skip != EnvOptions::default().frame_skip {
            words += &format!(", {} tics an action", self.frame_skip);
        }
        if self.early_creatures {
            words += ", early creatures";
        }
        if self.maps {
            words += ", other maps";
        }
        words
    }

    /// Adds it to an episode's row: rule set and constraint always, the rest where it is not usual.
    pub fn say(self, row: &mut Value) {
        row["rules"] = json!(self.rules.name());
        row["hard"] = json!(self.hard);
        if self.full_actions {
            row["full_actions"] = json!(true);
        }
        if self.frame_skip != EnvOptions::default().frame_skip {
            row["frame_skip"] = json!(self.frame_skip);
        }
        if self.early_creatures {
            row["early_creatures"] = json!(true);
        }
        if self.maps {
            row["maps"] = json!(true);
        }
    }
}

impl EpisodeLines {
    /// Nothing printed yet.
    pub fn new(json: bool) -> EpisodeLines {
        EpisodeLines { json, episodes: Vec::new(), constraints: Vec::new(), under: None }
    }

    /// The constraints that the summary judges by, each by its own term and budget.
    pub fn hold_against(&mut self, constraints: &[Constraint]) {
        self.constraints = constraints.to_vec();
    }

    /// What episodes are played under: their files say it, so that a report compares like with like.
    pub fn played_under(&mut self, options: &EnvOptions) {
        self.under = Some(Under::of(options));
    }

    /// Prints one episode; of several tasks, with the one that it is of.
    pub fn episode(&mut self, env: &str, number: u64, episode: Episode) -> Outcome {
        let mut out = std::io::stdout().lock();
        if self.json {
            let mut row = episode_row(env, number, &episode);
            if let Some(under) = self.under {
                under.say(&mut row);
            }
            writeln!(out, "{row}")?;
        } else {
            if self.episodes.is_empty() {
                let under = self.under.map(Under::words).unwrap_or_default();
                writeln!(out, "{env}{under}")?;
                writeln!(
                    out,
                    "{:>7} {:>12} {:>10} {:>10} {:>7}  end",
                    "episode", "seed", "return", "cost", "length"
                )?;
            }
            let end = match (episode.terminated, episode.truncated) {
                (true, _) => "terminated",
                (_, true) => "timeout",
                _ => "-",
            };
            let (seed, value, cost, length) =
                (episode.seed, episode.episode_return, episode.cost, episode.length);
            let task = episode.task.map_or(String::new(), |task| format!("  {task}"));
            writeln!(
                out,
                "{number:>7} {seed:>12} {value:>10.3} {cost:>10.3} {length:>7}  {end}{task}"
            )?;
        }
        self.episodes.push(episode);
        Ok(())
    }

    /// Prints means and their 95 % confidence half-widths: always for people; as an object with
    /// `"summary"` if asked.
    pub fn summary(&self, as_json: bool) -> Outcome {
        self.summary_with(as_json, &[])
    }

    /// The episodes so far.
    pub fn episodes(&self) -> &[Episode] {
        &self.episodes
    }

    /// The same, with further entries of the summary's object.
    pub fn summary_with(&self, as_json: bool, more: &[(&str, Value)]) -> Outcome {
        let all = Evaluation::of(&self.episodes, &self.constraints).map_err(Failure::bad)?;
        let mut out = std::io::stdout().lock();
        if self.json {
            if as_json {
                let mut object = summary_row(&all, &self.episodes);
                for (name, value) in more {
                    object["summary"][name] = value.clone();
                }
                writeln!(out, "{object}")?;
            }
            return Ok(());
        }
        writeln!(
            out,
            "mean of {}: {}, length {:.1} steps ({})",
            all.episodes,
            worth(&all),
            all.length.mean,
            match all.episodes {
                1 => "a single episode has no confidence interval",
                _ => "+- is the 95 % confidence half-width",
            }
        )?;
        // Of a single budget for the whole cost, one line says both.
        let whole = all.constraints.iter().find(|one| one.term.is_none());
        let budget = whole.map(|one| one.budget);
        let tails = whole.map_or(&all.tails, |one| &one.tails);
        writeln!(out, "cost of an episode: {}", tails_text(tails, budget))?;
        for one in &all.tasks {
            let (returns, cost) = (&one.episode_return, &one.cost);
            writeln!(
                out,
                "{}: return {}, cost {}, length {:.1}, {}",
                one.task,
                with_interval(returns, one.episodes),
                with_interval(cost, one.episodes),
                one.length.mean,
                count(one.episodes, "episode")
            )?;
        }
        for (one, term) in all.constraints.iter().filter_map(|one| Some((one, one.term.as_ref()?)))
        {
            writeln!(out, "{term}: {}", tails_text(&one.tails, Some(one.budget)))?;
        }
        let stats: Vec<String> = mean_stats(&self.episodes)
            .as_object()
            .into_iter()
            .flatten()
            .map(|(name, value)| format!("{name} {:.2}", value.as_f64().unwrap_or(0.0)))
            .collect();
        if !stats.is_empty() {
            writeln!(out, "means: {}", stats.join(", "))?;
        }
        Ok(())
    }
}

/// Mean of each statistic that the scenario counts.
fn mean_stats(episodes: &[Episode]) -> Value {
    let mut names: Vec<&'static str> = Vec::new();
    for (name, _) in episodes.iter().flat_map(|one| &one.stats) {
        if !names.contains(name) {
            names.push(name);
        }
    }
    let mean = |name: &str| {
        let values = episodes.iter().flat_map(|one| &one.stats).filter(|(own, _)| *own == name);
        let (count, sum) =
            values.fold((0.0, 0.0), |(count, sum), (_, value)| (count + 1.0, sum + value));
        sum / count
    };
    named(names.into_iter().map(|name| (name, mean(name))))
}

/// By what an interval is: Student's t, or the bootstrap where episodes are skewed.
fn interval_by(estimate: &Estimate) -> &'static str {
    if estimate.bootstrap.is_some() { "bca" } else { "t" }
}

/// How costs spread, as JSON.
fn spread(tails: &Tails) -> Value {
    json!({
        "median": tails.median, "q90": tails.ninety, "worst": tails.worst, "cvar10": tails.cvar, "over_budget": tails.over_budget,
    })
}

/// How costs spread, for people.
fn tails_text(tails: &Tails, budget: Option<f64>) -> String {
    let over = match (tails.over_budget, budget) {
        (Some(share), Some(budget)) => {
            format!(", {:.0} % of episodes over the budget of {budget}", 100.0 * share)
        }
        _ => String::new(),
    };
    format!(
        "median {:.2}, 90 % at most {:.2}, worst {:.2}, mean of the worst tenth {:.2}{over}",
        tails.median, tails.ninety, tails.worst, tails.cvar
    )
}

/// Means of episodes and their 95 % confidence half-widths as JSON.
pub fn summary_row(all: &Evaluation, episodes: &[Episode]) -> Value {
    let constraints: Vec<Value> =
        all.constraints.iter().map(|one| judgement(one, episodes_of(all, one))).collect();
    let known = |number: f64| of_several(number, all.episodes);
    let whole = all.constraints.iter().find(|one| one.term.is_none());
    let mut row = json!({ "summary": {
        "episodes": all.episodes,
        "return_mean": all.episode_return.mean, "return_ci95": known(all.episode_return.half_width),
        "cost_mean": all.cost.mean, "cost_ci95": known(all.cost.half_width),
        "cost_interval": [known(all.cost.low()), known(all.cost.high())], "cost_interval_by": interval_by(&all.cost),
        "cost_tails": spread(whole.map_or(&all.tails, |one| &one.tails)),
        "stats": mean_stats(episodes),
        "length_mean": all.length.mean, "length_ci95": known(all.length.half_width),
        "safety_budget": all.constraints.first().map(|one| one.budget),
        "within_budget": (!all.constraints.is_empty()).then(|| all.within()),
        "constraints": constraints,
    }});
    if !all.tasks.is_empty() {
        let task = |one: &TaskEvaluation| {
            let known = |number: f64| of_several(number, one.episodes);
            json!({
                "task": one.task, "episodes": one.episodes,
                "return_mean": one.episode_return.mean, "return_ci95": known(one.episode_return.half_width),
                "cost_mean": one.cost.mean, "cost_ci95": known(one.cost.half_width),
                "length_mean": one.length.mean,
            })
        };
        row["summary"]["tasks"] = all.tasks.iter().map(task).collect();
    }
    row
}

/// A number of an interval, which a single episode does not have.
fn of_several(number: f64, episodes: usize) -> Option<f64> {
    (episodes > 1).then_some(number)
}

/// A mean with its half-width, if it has one.
fn with_interval(estimate: &Estimate, episodes: usize) -> String {
    match of_several(estimate.half_width, episodes) {
        None => format!("{:.3}", estimate.mean),
        Some(half_width) => format!("{:.3} +- {half_width:.3}", estimate.mean),
    }
}

/// Return and costs with their half-widths, each constraint beside its budget, for people.
pub fn worth(all: &Evaluation) -> String {
    let (returns, cost) = (all.episode_return, all.cost);
    let of_all = |one: &Estimate| with_interval(one, all.episodes);
    let mut text = format!("return {}, cost {}", of_all(&returns), of_all(&cost));
    for one in &all.constraints {
        let kept = if one.within() { "within" } else { "over" };
        match &one.term {
            None => text += &format!(" ({kept} the budget of {})", one.budget),
            Some(term) => {
                let cost = with_interval(&one.cost, episodes_of(all, one));
                text += &format!(", {term} {cost} ({kept} its budget of {})", one.budget);
            }
        }
    }
    text
}

/// The episodes that a constraint was judged by: of one of several tasks, those of this task.
fn episodes_of(all: &Evaluation, one: &Judgement) -> usize {
    let task = all.tasks.iter().find(|task| one.term.as_ref() == Some(&task.task));
    task.map_or(all.episodes, |task| task.episodes)
}

/// A constraint as JSON.
fn judgement(one: &Judgement, episodes: usize) -> Value {
    let known = |number: f64| of_several(number, episodes);
    json!({
        "term": one.term, "budget": one.budget, "cost_mean": one.cost.mean, "cost_ci95": known(one.cost.half_width),
        "cost_interval": [known(one.cost.low()), known(one.cost.high())], "cost_interval_by": interval_by(&one.cost),
        "tails": spread(&one.tails), "within_budget": one.within(),
    })
}

fn named(values: impl Iterator<Item = (&'static str, f64)>) -> Value {
    Value::Object(
        values.map(|(name, value)| (name.to_string(), json!(value))).collect::<Map<_, _>>(),
    )
}
