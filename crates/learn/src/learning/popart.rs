//! PopArt: heads that keep what they say when the scale of the returns moves (van Hasselt et al.
//! 2016, arXiv 1602.07714).

use crate::learning::normaliser::Moments;
use crate::networks::ModelShape;

/// Changes the weights of a critic's head so that its values in raw units, deviation * output +
/// mean, are under the moments `after` what they were under those `before`: the paper's proposition
/// 1, W' = (s / s') W and b' = (s b + m - m') / s'. Gives the number of the network that it is in.
/// Critic 0 is that of the reward.
pub fn preserve_outputs(
    shape: &ModelShape,
    critic: usize,
    before: &Moments,
    after: &Moments,
    parameters: &mut [f32],
) -> usize {
    let (network, head) = if shape.networks.len() == 1 { (0, 1 + critic) } else { (1 + critic, 0) };
    let parameters = &mut parameters[shape.parameter_range(network)];
    let table = shape.networks[network].parameters();
    let find = |what: &str| {
        let name = format!("head{head}.{what}");
        table
            .iter()
            .find(|parameter| parameter.name == name)
            .expect("every critic has a head")
            .range()
    };
    let factor = before.deviation() / after.deviation();
    let (weights, biases) = (find("weight"), find("bias"));
    for weight in &mut parameters[weights] {
        *weight = (f64::from(*weight) * factor) as f32;
    }
    for (index, bias) in parameters[biases].iter_mut().enumerate() {
        // Of a head with privileged inputs the first output stands alone; the others are slopes,
        // which have no mean.
        let shift = if index == 0 { (before.mean - after.mean) / after.deviation() } else { 0.0 };
        *bias = (f64::from(*bias) * factor + shift) as f32;
    }
    network
}

#[cfg(test)]
mod tests {
    use crate::algorithms::small;
    use crate::config::{AlgorithmKind, ReturnNormaliser};
    use crate::learning::learner::{Learner, Minibatch};
    use crate::learning::loss::Heads;
    use crate::learning::metrics::Means;
    use crate::learning::normaliser::Moments;

    /// A12. Proposition 1 of van Hasselt et al. 2016: s' n'(x) + m' = s n(x) + m for every input x,
    /// of every critic, whether the networks are one or several, though the moments move far.
    #[test]
    fn values_in_raw_units_stay_when_the_moments_move() {
        for algorithm in [AlgorithmKind::PpoLag, AlgorithmKind::Cpo] {
            let mut config = small::config(algorithm);
            config.learning.normaliser = ReturnNormaliser::PopArt;
            let (mut learner, mut rollout) = small::learner(&config);
            rollout.parts[0].rewards.iter_mut().for_each(|reward| *reward = *reward * 40.0 + 300.0);
            rollout.parts[0].costs.iter_mut().for_each(|cost| *cost = *cost * 0.01 - 2.0);
            let prepared = learner.prepare(&rollout);
            let moments = learner.returns.clone();
            assert!(moments.iter().all(|moments| *moments != Moments::default()));
            let mut outputs: Vec<Vec<Vec<f64>>> = Vec::new();
            let mut values = |learner: &mut Learner, moments: &[Moments]| -> Vec<Vec<f64>> {
                let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
                let networks = 0..learner.shape().networks.len();
                let mut seen = Vec::new();
                let loss = |heads: &Heads, _: &Minibatch<'_>, _: &mut Means| {
                    seen = heads.values.iter().map(|column| column.values.clone()).collect();
                    heads.mean_of(&heads.values[0])
                };
                learner.gradient(networks, &mut minibatch, loss, &mut Means::default()).unwrap();
                let raw = |(values, moments): (&Vec<f64>, &Moments)| {
                    values
                        .iter()
                        .map(|value| value * moments.deviation() + moments.mean)
                        .collect::<Vec<f64>>()
                };
                let raw = seen.iter().zip(moments).map(raw).collect();
                outputs.push(seen);
                raw
            };
            let now = values(&mut learner, &moments);
            // The same weights as before the rollout: a learner of the same seed.
            let (mut fresh, _) = small::learner(&config);
            let before = values(&mut fresh, &[Moments::default(), Moments::default()]);
            for (now, before) in now.iter().flatten().zip(before.iter().flatten()) {
                assert!((now - before).abs() < 2e-3, "{algorithm}: {now}, before {before}");
            }
            let (now, before) = (&outputs[0], &outputs[1]);
            assert!(
                now[0].iter().zip(&before[0]).all(|(now, before)| (now - before).abs() > 0.1),
                "the outputs themselves moved"
            );
        }
    }
}
