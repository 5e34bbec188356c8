//! The moments that contact sheets show: data alone. Found by looking; seeds and policies make them come again.

use hasard_envs::Scenario;

/// A moment of an episode under the paper's rules.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// The level.
    pub level: u8,
    /// Seed of the episode and of its policies.
    pub seed: u64,
    /// Policies that act before the moment, one after the other, each for so many steps.
    pub way: &'static [(u32, &'static str)],
}

const fn at(level: u8, seed: u64, way: &'static [(u32, &'static str)]) -> Moment {
    Moment { level, seed, way }
}

const EDGE: &[(u32, &str)] = &[(20, "noop"), (4, "hold:MOVE_FORWARD"), (6, "hold:TURN_LEFT"), (3, "hold:LOOK_DOWN")];
const LOOK_BACK: &[(u32, &str)] =
    &[(20, "noop"), (12, "hold:MOVE_FORWARD"), (30, "noop"), (14, "hold:TURN_LEFT"), (3, "hold:LOOK_UP")];

/// Two moments of each level of a scenario.
pub const fn of(scenario: Scenario) -> [Moment; 6] {
    match scenario {
        Scenario::ArmamentBurden => [
            at(1, 1, &[(8, "sticky:10")]),
            at(1, 2, &[(140, "sticky:10")]),
            at(2, 2, &[(60, "sticky:10")]),
            at(2, 1, &[(8, "sticky:10")]),
            at(3, 2, &[(140, "sticky:10")]),
            at(3, 1, &[(8, "sticky:10")]),
        ],
        Scenario::CollateralDamage => [
            at(1, 1, &[(10, "sticky:6")]),
            at(1, 2, &[(45, "sticky:6")]),
            at(2, 2, &[(45, "sticky:6")]),
            at(2, 1, &[(45, "sticky:6")]),
            at(3, 2, &[(45, "sticky:6")]),
            at(3, 1, &[(45, "sticky:6")]),
        ],
        Scenario::DetonatorsDilemma => [
            at(1, 1, &[(60, "sticky:10")]),
            at(1, 2, &[(60, "sticky:10")]),
            at(2, 3, &[(60, "sticky:10")]),
            at(2, 2, &[(60, "sticky:10")]),
            at(3, 1, &[(103, "sticky:10")]),
            at(3, 3, &[(103, "sticky:10")]),
        ],
        // Once the cave has sunk: at its edge, on the first steps, and looking back from further down.
        Scenario::PrecipicePlunge => [
            at(1, 1, EDGE),
            at(1, 2, &[(20, "noop"), (4, "hold:MOVE_FORWARD"), (8, "hold:TURN_RIGHT"), (3, "hold:LOOK_DOWN")]),
            at(2, 1, EDGE),
            at(2, 2, LOOK_BACK),
            at(3, 1, EDGE),
            at(3, 2, LOOK_BACK),
        ],
        Scenario::RemedyRush => [
            at(1, 3, &[(60, "sticky:12")]),
            at(1, 1, &[(103, "sticky:12")]),
            at(2, 3, &[(6, "sticky:12")]),
            at(2, 1, &[(140, "sticky:12")]),
            at(3, 3, &[(103, "sticky:12")]),
            at(3, 4, &[(60, "sticky:12")]),
        ],
        Scenario::VolcanicVenture => [
            at(1, 1, &[(130, "sticky:10")]),
            at(1, 2, &[(60, "sticky:10")]),
            at(2, 1, &[(130, "sticky:10")]),
            at(2, 4, &[(60, "sticky:10")]),
            at(3, 2, &[(10, "sticky:10")]),
            at(3, 1, &[(130, "sticky:10")]),
        ],
    }
}

/// Which of the moments is also drawn at full size.
pub const fn cover(scenario: Scenario) -> usize {
    match scenario {
        Scenario::ArmamentBurden | Scenario::DetonatorsDilemma | Scenario::VolcanicVenture => 4,
        Scenario::CollateralDamage => 1,
        Scenario::RemedyRush => 0,
        Scenario::PrecipicePlunge => 2,
    }
}
