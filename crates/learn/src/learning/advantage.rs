//! Generalised advantage estimation.

/// One lane's rewards (or costs) and values, in time order.
#[derive(Clone, Copy, Debug)]
pub struct Lane<'a> {
    /// Reward of each step.
    pub rewards: &'a [f32],
    /// Whether the episode ended with the step, for whatever reason.
    pub done: &'a [bool],
    /// What the step's end is still worth if the episode was cut off by the clock: zero elsewhere.
    pub cut_off_values: &'a [f32],
    /// Value of each step's observation, and of the one after the last.
    pub values: &'a [f32],
}

/// Advantages of a lane's steps (Schulman et al. 2016), written to `out`.
///
/// The sum stops at an episode's end; the value of what would have come after a time-out is added
/// to its last reward.
pub fn generalised_advantages(lane: Lane<'_>, gamma: f32, lambda: f32, out: &mut [f32]) {
    let mut later = 0.0;
    for step in (0..lane.rewards.len()).rev() {
        let (next_value, carried) = if lane.done[step] {
            (lane.cut_off_values[step], 0.0)
        } else {
            (lane.values[step + 1], later)
        };
        let surprise = lane.rewards[step] + gamma * next_value - lane.values[step];
        later = surprise + gamma * lambda * carried;
        out[step] = later;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Worked out by hand: gamma 0.99, lambda 0.95, an episode's end after the second step.
    #[test]
    fn advantages_equal_the_recorded_ones() {
        let lane = Lane {
            rewards: &[1.0, 0.0, 2.0],
            done: &[false, true, false],
            cut_off_values: &[0.0; 3],
            values: &[0.5, 0.4, 0.3, 0.2],
        };
        let mut out = [0.0; 3];
        generalised_advantages(lane, 0.99, 0.95, &mut out);
        for (got, expected) in out.iter().zip([0.5198, -0.4, 1.898]) {
            assert!((got - expected).abs() < 1e-6, "{out:?}");
        }
    }

    #[test]
    fn a_time_out_adds_what_would_have_come() {
        let mut lane = Lane {
            rewards: &[1.0, 1.0],
            done: &[true, false],
            cut_off_values: &[3.0, 0.0],
            values: &[0.5, 0.4, 0.2],
        };
        let (mut with, mut without) = ([0.0; 2], [0.0; 2]);
        generalised_advantages(lane, 0.9, 0.5, &mut with);
        lane.cut_off_values = &[0.0; 2];
        generalised_advantages(lane, 0.9, 0.5, &mut without);
        assert!((with[0] - (1.0 + 0.9 * 3.0 - 0.5)).abs() < 1e-6);
        assert!((without[0] - 0.5).abs() < 1e-6);
        assert_eq!(with[1], without[1]);
    }
}
