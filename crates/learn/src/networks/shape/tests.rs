use super::*;

/// Totals of the original, counted in a replica of its modules: PPO on Remedy Rush and Volcanic
/// Venture has 2,874,090 parameters, on the spaces with eleven logits 2,875,116, on Collateral
/// Damage 2,872,038, 513 more with a cost critic, 2,048 more with depth.
#[test]
fn parameter_counts_are_those_of_the_original() {
    let count = |logits, values: usize, channels| {
        let mut shape = NetworkShape::default();
        shape.image.channels = channels;
        shape.heads = std::iter::once(logits).chain(std::iter::repeat_n(1, values)).collect();
        shape.check().unwrap();
        shape.parameter_count()
    };
    assert_eq!(count(9, 1, 3), 2_874_090);
    assert_eq!(count(11, 1, 3), 2_875_116);
    assert_eq!(count(5, 1, 3), 2_872_038);
    assert_eq!(count(9, 2, 3), 2_874_090 + 513);
    assert_eq!(count(9, 1, 4), 2_874_090 + 2_048);
    assert_eq!(NetworkShape::default().features(), 2304);
}

/// The paper's network: 59 MFLOP a training sample, 22 an inference.
#[test]
fn arithmetic_is_what_the_bound_counts() {
    let shape = NetworkShape::default();
    assert!((shape.forward_flop() / 1e6 - 22.0).abs() < 1.0, "{}", shape.forward_flop());
    assert!((shape.training_flop() / 1e6 - 59.0).abs() < 2.5, "{}", shape.training_flop());
}

#[test]
fn impossible_shapes_are_refused_by_name() {
    let refuse = |change: fn(&mut NetworkShape), word: &str| {
        let mut shape = NetworkShape::default();
        change(&mut shape);
        let message = shape.check().unwrap_err().to_string();
        assert!(message.contains(word), "{message}");
    };
    refuse(|s| s.image.height = 20, "does not fit");
    refuse(|s| s.dense = vec![100], "100 units");
    refuse(|s| s.convolutions[1].channels = 30, "30 channels");
    refuse(|s| s.convolutions[0].stride = 9, "stride 9");
    refuse(|s| s.heads = vec![], "head");
    refuse(|s| s.residual = vec![32], "not both");
    refuse(|s| (s.convolutions, s.residual) = (vec![], vec![32, 16]), "16 channels");
    refuse(|s| (s.convolutions, s.residual) = (vec![], vec![32; 13]), "too large");
    refuse(|s| s.dense = vec![1 << 40], "too large");
    refuse(|s| s.dense = vec![32; 65], "too large");
    refuse(|s| s.dense = vec![1 << 16, 1 << 16], "too large");
    refuse(|s| s.convolutions[2].channels = usize::MAX / 32 * 32, "too large");
}
