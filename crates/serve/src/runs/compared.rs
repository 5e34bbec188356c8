//! Experiments side by side: inter-quartile means over seeds, with the report's own intervals.

use super::asked::{Chosen, on_catalogue};
use crate::answer::{aside, json_of};
use crate::asked::Asked;
use crate::shared::Shared;
use axum::extract::State;
use axum::response::Response;
use hasard_report::statistics::{aggregate, interquartile_mean};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Return and cost of each experiment among some runs: of the selected checkpoints where every run
/// of an environment has a closing evaluation, else of recent training episodes. Numbers from two
/// sources do not compare. Each seed of an experiment counts once.
pub(crate) async fn compare(
    State(shared): State<Arc<Shared>>,
    Asked(query): Asked<Chosen>,
) -> Result<Response, Response> {
    let ids = query.ids()?;
    let runs = on_catalogue(shared, move |catalogue| catalogue.results_of(&ids)).await?;
    Ok(json_of(&aside(move || beside(&runs)).await?))
}

fn beside(runs: &[Value]) -> Value {
    let mut envs: BTreeMap<&str, Vec<&Value>> = BTreeMap::new();
    for run in runs {
        envs.entry(run["env"].as_str().unwrap_or_default()).or_default().push(run);
    }
    let facets = envs.into_iter().map(|(env, runs)| {
        let mut experiments: BTreeMap<&str, Vec<&Value>> = BTreeMap::new();
        for run in runs {
            experiments.entry(run["experiment"].as_str().unwrap_or_default()).or_default().push(run);
        }
        let experiments = experiments.into_iter().map(|(name, runs)| {
            let counted = by_seed(&runs);
            (name, runs.len() - counted.len(), counted)
        });
        let experiments: Vec<_> = experiments.collect();
        let evaluated = experiments
            .iter()
            .flat_map(|(_, _, runs)| runs)
            .all(|run| run["evaluation"]["return"]["mean"].is_number());
        let rows = experiments.iter().map(|(experiment, repeats, runs)| {
            let mut row = row(experiment, runs, evaluated);
            row["repeats"] = json!(repeats);
            row
        });
        json!({ "env": env, "source": if evaluated { "evaluation" } else { "training" }, "rows": rows.collect::<Vec<_>>() })
    });
    facets.collect()
}

/// Each seed once: of several runs of a seed the one that got furthest, as in the report. A seed
/// that counted twice would make the interval too narrow.
fn by_seed<'a>(runs: &[&'a Value]) -> Vec<&'a Value> {
    let frames = |run: &Value| run["last"]["frames"].as_f64().unwrap_or(0.0);
    let mut furthest: BTreeMap<&str, &Value> = BTreeMap::new();
    for &run in runs {
        let there = furthest.entry(run["seed"].as_str().unwrap_or_default()).or_insert(run);
        if frames(run) > frames(there) {
            *there = run;
        }
    }
    furthest.into_values().collect()
}

fn row(experiment: &str, runs: &[&Value], evaluated: bool) -> Value {
    let of = |training: &str, evaluation: &str| -> Vec<f64> {
        let value = |run: &&Value| {
            if evaluated {
                run.pointer(evaluation).and_then(Value::as_f64)
            } else {
                run["last"][training].as_f64()
            }
        };
        runs.iter().filter_map(value).collect()
    };
    let iqm = |samples: &[f64]| {
        let found = aggregate(&[samples.to_vec()], interquartile_mean)?;
        Some(
            json!({ "value": found.value, "low": found.interval.map(|ends| ends.0), "high": found.interval.map(|ends| ends.1) }),
        )
    };
    let (returns, costs) = (
        of("return_mean", "/evaluation/return/mean"),
        of("cost_mean", "/evaluation/costs/0/cost/mean"),
    );
    let budget = runs[0]
        .pointer("/evaluation/costs/0/budget")
        .filter(|_| evaluated)
        .unwrap_or(&runs[0]["budget"]);
    json!({
        "experiment": experiment, "algo": runs[0]["algo"], "budget": budget, "n": returns.len(), "return": iqm(&returns),
        "cost": iqm(&costs), "returns": returns, "costs": costs,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evaluations_are_compared_where_all_have_one() {
        let run = |experiment: &str, env: &str, value: f64, evaluated: bool| {
            let evaluation = json!({ "return": { "mean": value }, "costs": [{ "budget": 5.0, "cost": { "mean": 4.0 } }] });
            json!({
                "experiment": experiment, "env": env, "algo": "PPO", "budget": 50.0, "seed": format!("{value} {evaluated}"), "last": { "return_mean": 1.0, "cost_mean": 2.0 },
                "evaluation": if evaluated { evaluation } else { Value::Null },
            })
        };
        let runs = [0.0, 10.0, 20.0, 90.0].map(|value| run("a", "x", value, true));
        let facets = beside(
            &[runs.as_slice(), &[run("b", "y", 3.0, true), run("b", "y", 3.0, false)]].concat(),
        );
        // The middle half of 0, 10, 20, 90 is 10 and 20.
        let x = &facets[0]["rows"][0];
        assert_eq!(
            (&x["return"]["value"], &x["n"], &x["budget"]),
            (&json!(15.0), &json!(4), &json!(5.0))
        );
        assert!(
            x["return"]["low"].as_f64().unwrap() < 15.0
                && x["return"]["high"].as_f64().unwrap() > 15.0
        );
        assert_eq!(
            (&facets[1]["source"], &facets[1]["rows"][0]["return"]["value"]),
            (&json!("training"), &json!(1.0))
        );
    }

    #[test]
    fn a_seed_counts_once_by_the_run_that_got_furthest() {
        let run = |seed: &str, frames: f64, value: f64| {
            let last = json!({ "frames": frames, "return_mean": value, "cost_mean": value });
            json!({ "experiment": "a", "env": "x", "algo": "PPO", "budget": 50.0, "seed": seed, "last": last })
        };
        let runs =
            [run("11", 10.0, 1.0), run("11", 30.0, 3.0), run("11", 20.0, 2.0), run("2", 5.0, 7.0)];
        let row = &beside(&runs)[0]["rows"][0];
        assert_eq!((&row["n"], &row["repeats"]), (&json!(2), &json!(2)));
        assert_eq!(row["returns"], json!([3.0, 7.0]));
        // A repeat without an evaluation does not take the evaluations from those that count.
        let mut runs = [run("1", 10.0, 1.0), run("1", 9.0, 1.0)];
        runs[0]["evaluation"] = json!({ "return": { "mean": 4.0 } });
        assert_eq!(beside(&runs)[0]["source"], "evaluation");
    }
}
