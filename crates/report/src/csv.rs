//! The numbers behind the report as CSV files: a row an experiment, a run, a point of a curve.

use crate::curve::Curve;
use crate::escape::escape_csv;
use crate::group::{Group, Source};
use crate::published::published;
use crate::run::Kept;
use crate::sections::{Baselines, judged_by, judged_metric};
use crate::statistics::{Estimate, interquartile_mean};
use std::fmt::Write;

fn line(fields: &[String]) -> String {
    fields.iter().map(|field| escape_csv(field)).collect::<Vec<_>>().join(",") + "\n"
}

fn optional(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// A row for each experiment.
#[must_use]
pub fn experiments_csv(groups: &[Group]) -> String {
    let mut text = String::from(
        "env,scenario,level,algorithm,options,safety_budget,cost_scale,frames_asked,frames_reached,seeds,\
         return_mean,return_half_width_95,return_n,return_interquartile_mean,cost_mean,cost_half_width_95,cost_n,cost_interquartile_mean,\
         length_mean,evaluation_return_mean,evaluation_return_half_width_95,evaluation_cost_mean,evaluation_cost_half_width_95,evaluation_n,\
         within_budget,surely_within_budget,paper_return,paper_cost,paper_note\n",
    );
    for group in groups {
        let config = group.config();
        let seeds: Vec<String> = group.runs.iter().map(|run| run.config.seed.to_string()).collect();
        let mut fields = vec![
            config.env.clone(),
            config.scenario.clone(),
            config.level.to_string(),
            config.algo.clone(),
            group.options_line(None),
            config.safety_budget.to_string(),
            config.cost_scale.to_string(),
            optional(config.frames),
            group.frames_span().0.to_string(),
            seeds.join(" "),
        ];
        for metric in ["return_mean", "cost_mean"] {
            let samples = group.final_samples(metric);
            let estimate = Estimate::of(&samples);
            fields.extend([
                optional(estimate.map(|e| e.mean)),
                optional(estimate.and_then(|e| e.half_width)),
                samples.len().to_string(),
                optional(interquartile_mean(&samples)),
            ]);
        }
        let paper = published(config);
        let evaluated = |metric: &str, half: bool| {
            let estimate = group.estimate(Source::Evaluation, metric);
            optional(if half {
                estimate.and_then(|e| e.half_width)
            } else {
                estimate.map(|e| e.mean)
            })
        };
        let headline = group.kept(group.headline());
        let kept = |least: Kept| {
            if headline == Kept::Unknown { String::new() } else { (headline >= least).to_string() }
        };
        fields.extend([
            optional(group.final_estimate("length_mean").map(|e| e.mean)),
            evaluated("return_mean", false),
            evaluated("return_mean", true),
            evaluated("cost_mean", false),
            evaluated("cost_mean", true),
            group.samples(Source::Evaluation, "return_mean").len().to_string(),
            kept(Kept::ByMean),
            kept(Kept::Surely),
            optional(paper.map(|p| p.episode_return)),
            optional(paper.map(|p| p.cost)),
            paper.map(|p| p.note()).unwrap_or_default(),
        ]);
        text += &line(&fields);
    }
    text
}

/// A row for each run. What begins with `judged` is what scores rest on, the scalar cost with the
/// upper 95 % end; that end, and the feasible score, are empty where the cost has no interval, and
/// both scores where an end of their scale is missing.
#[must_use]
pub fn runs_csv(groups: &[Group], baselines: &Baselines) -> String {
    let mut text = String::from(
        "directory,env,algorithm,seed,options,frames,reports,wall_s,fps,return_mean,cost_mean,length_mean,\
         judged_by,judged_return,judged_cost,judged_cost_high,normalised_return,feasible_score\n",
    );
    let scored = groups.iter().flat_map(|group| group.runs.iter().zip(baselines.each(group)));
    for (run, score) in scored {
        let options: Vec<String> =
            run.config.options.iter().map(|(key, value)| format!("{key} {value}")).collect();
        let last = |metric: &str| run.final_mean(metric);
        let cost = judged_metric(run, "cost_mean");
        text += &line(&[
            run.path.display().to_string(),
            run.config.env.clone(),
            run.config.algo.clone(),
            run.config.seed.to_string(),
            options.join(", "),
            run.frames().to_string(),
            run.rows.len().to_string(),
            optional(run.rows.last().and_then(|row| row.get("wall_s"))),
            optional(run.frames_per_second()),
            optional(last("return_mean")),
            optional(last("cost_mean")),
            optional(last("length_mean")),
            judged_by(run).to_owned(),
            optional(judged_metric(run, "return_mean").map(|one| one.mean)),
            optional(cost.map(|one| one.mean)),
            optional(cost.filter(|one| one.half_width.is_some()).map(|one| one.high())),
            optional(score.as_ref().map(|one| one.normalised)),
            optional(score.as_ref().and_then(|one| one.feasible)),
        ]);
    }
    text
}

/// A row for each point of each experiment's mean curves.
#[must_use]
pub fn curves_csv(groups: &[Group]) -> String {
    let mut text = String::from("env,algorithm,options,metric,frames,mean,half_width_95,n\n");
    for group in groups {
        let config = group.config();
        let head = line(&[config.env.clone(), config.algo.clone(), group.options_line(None)]);
        for metric in ["return_mean", "cost_mean"] {
            for point in Curve::of(group, metric).mean {
                let (mean, half) = (point.value.mean, optional(point.value.half_width));
                let _ = writeln!(
                    text,
                    "{},{metric},{:.0},{mean},{half},{}",
                    head.trim_end(),
                    point.frames,
                    point.value.n
                );
            }
        }
    }
    text
}
