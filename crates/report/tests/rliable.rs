//! The aggregates of many tasks against the field's own library: matrices and what rliable 1.2.0
//! (with SciPy 1.17.1) says of them lie in `data/rliable.json`; scores are `[runs][tasks]`.

use hasard_report::statistics::{
    interquartile_mean, mean, optimality_gap, performance_profile, probability_of_improvement,
};
use serde_json::Value;

fn matrix(case: &Value, key: &str) -> Vec<Vec<f64>> {
    let rows: Vec<Vec<f64>> = case[key].as_array().unwrap().iter().map(numbers).collect();
    // One list of runs for each task.
    (0..rows[0].len()).map(|task| rows.iter().map(|row| row[task]).collect()).collect()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

#[test]
fn point_estimates_agree_with_rliable() {
    let cases: Value = serde_json::from_str(include_str!("data/rliable.json")).unwrap();
    let cases = cases.as_array().unwrap();
    assert_eq!(cases.len(), 5);
    for case in cases {
        let (scores, other) = (matrix(case, "scores"), matrix(case, "other"));
        let all = scores.concat();
        let same = |name: &str, ours: Option<f64>, theirs: &Value| {
            let (ours, theirs) = (ours.unwrap(), theirs.as_f64().unwrap());
            assert!(
                (ours - theirs).abs() < 1e-9,
                "{} of {}: {ours} here, {theirs} there",
                name,
                case["name"]
            );
        };
        same("mean", mean(&all), &case["mean"]);
        same("iqm", interquartile_mean(&all), &case["iqm"]);
        same("optimality gap", optimality_gap(&all, 1.0), &case["optimality_gap"]);
        let better = probability_of_improvement(&scores, &other);
        same("probability of improvement", better, &case["probability_of_improvement"]);
        for (tau, share) in
            numbers(&case["taus"]).into_iter().zip(case["profile"].as_array().unwrap())
        {
            same("performance profile", performance_profile(&all, tau), share);
        }
    }
}
