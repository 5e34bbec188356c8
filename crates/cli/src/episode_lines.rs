//! How episodes are printed: a JSON object each, or a row of a table and the mean at its end.

use crate::failure::Outcome;
use hasard_envs::Episode;
use serde_json::{Map, Value, json};
use std::io::Write;

/// Prints episodes as they end, and keeps what the summary needs.
pub struct EpisodeLines {
    json: bool,
    returns: Vec<f64>,
    costs: Vec<f64>,
    lengths: Vec<f64>,
    budget: Option<f64>,
}

impl EpisodeLines {
    /// Nothing printed yet.
    pub fn new(json: bool) -> EpisodeLines {
        EpisodeLines { json, returns: Vec::new(), costs: Vec::new(), lengths: Vec::new(), budget: None }
    }

    /// The budget that the summary holds the mean cost against.
    pub fn set_budget(&mut self, budget: f64) {
        self.budget = Some(budget);
    }

    /// Prints one episode.
    pub fn episode(&mut self, env: &str, number: u64, episode: &Episode) -> Outcome {
        let mut out = std::io::stdout().lock();
        if self.json {
            let object = json!({
                "env": env,
                "episode": number,
                "seed": episode.seed,
                "return": episode.episode_return,
                "cost": episode.cost,
                "costs": named(&episode.costs),
                "length": episode.length,
                "terminated": episode.terminated,
                "truncated": episode.truncated,
                "stats": named(&episode.stats),
            });
            writeln!(out, "{object}")?;
        } else {
            if self.returns.is_empty() {
                writeln!(out, "{env}")?;
                writeln!(out, "{:>7} {:>12} {:>10} {:>10} {:>7}  end", "episode", "seed", "return", "cost", "length")?;
            }
            let end = match (episode.terminated, episode.truncated) {
                (true, _) => "terminated",
                (_, true) => "timeout",
                _ => "-",
            };
            let (seed, value, cost, length) = (episode.seed, episode.episode_return, episode.cost, episode.length);
            writeln!(out, "{number:>7} {seed:>12} {value:>10.3} {cost:>10.3} {length:>7}  {end}")?;
        }
        self.returns.push(episode.episode_return);
        self.costs.push(episode.cost);
        self.lengths.push(f64::from(episode.length));
        Ok(())
    }

    /// Prints means and their 95 % confidence half-widths: always for people; as an object with `"summary"` if asked.
    pub fn summary(&self, as_json: bool) -> Outcome {
        let mut out = std::io::stdout().lock();
        let (returns, costs, lengths) = (Mean::of(&self.returns), Mean::of(&self.costs), Mean::of(&self.lengths));
        if self.json {
            if as_json {
                let object = json!({ "summary": {
                    "episodes": self.returns.len(),
                    "return_mean": returns.mean, "return_ci95": returns.half_width,
                    "cost_mean": costs.mean, "cost_ci95": costs.half_width,
                    "length_mean": lengths.mean, "length_ci95": lengths.half_width,
                    "safety_budget": self.budget,
                    "within_budget": self.budget.map(|budget| costs.mean <= budget),
                }});
                writeln!(out, "{object}")?;
            }
            return Ok(());
        }
        let budget = match self.budget {
            Some(budget) if costs.mean <= budget => format!(" (within the budget of {budget})"),
            Some(budget) => format!(" (over the budget of {budget})"),
            None => String::new(),
        };
        writeln!(
            out,
            "mean of {}: return {:.3} +- {:.3}, cost {:.3} +- {:.3}{budget}, length {:.1} steps (+- is the 95 % confidence half-width)",
            self.returns.len(),
            returns.mean,
            returns.half_width,
            costs.mean,
            costs.half_width,
            lengths.mean
        )?;
        Ok(())
    }
}

fn named(values: &[(&'static str, f64)]) -> Value {
    Value::Object(values.iter().map(|&(name, value)| (name.to_string(), json!(value))).collect::<Map<_, _>>())
}

/// A mean with its uncertainty.
struct Mean {
    mean: f64,
    half_width: f64,
}

impl Mean {
    /// Normal approximation, sample variance; no width for a single value.
    fn of(values: &[f64]) -> Mean {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n.max(1.0);
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let half_width = if n > 1.0 { 1.96 * (squares / (n - 1.0) / n).sqrt() } else { 0.0 };
        Mean { mean, half_width }
    }
}
