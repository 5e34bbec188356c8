//! Action spaces: groups of exclusive buttons, and delta buttons; and the names of buttons.

use crate::error::{EnvError, excerpt};
use hasard_engine::math::Rng;
use hasard_engine::world::{Buttons, Command};

/// Degrees per tic of a delta button at full deflection.
pub const DELTA_DEGREES: f64 = 7.5;

/// Every button by name, in the order of the original's full action space.
pub const BUTTONS: [(&str, Buttons); 16] = [
    ("MOVE_FORWARD", Buttons::MOVE_FORWARD),
    ("MOVE_BACKWARD", Buttons::MOVE_BACKWARD),
    ("MOVE_RIGHT", Buttons::MOVE_RIGHT),
    ("MOVE_LEFT", Buttons::MOVE_LEFT),
    ("SELECT_NEXT_WEAPON", Buttons::SELECT_NEXT_WEAPON),
    ("SELECT_PREV_WEAPON", Buttons::SELECT_PREV_WEAPON),
    ("ATTACK", Buttons::ATTACK),
    ("SPEED", Buttons::SPEED),
    ("JUMP", Buttons::JUMP),
    ("USE", Buttons::USE),
    ("CROUCH", Buttons::CROUCH),
    ("TURN180", Buttons::TURN180),
    ("TURN_LEFT", Buttons::TURN_LEFT),
    ("TURN_RIGHT", Buttons::TURN_RIGHT),
    ("LOOK_UP", Buttons::LOOK_UP),
    ("LOOK_DOWN", Buttons::LOOK_DOWN),
];

/// A sub-action: 0 presses nothing, `i` presses `buttons[i - 1]`.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct ActionGroup {
    /// The exclusive buttons, with their names.
    pub buttons: Vec<(&'static str, Buttons)>,
}

/// A continuous sub-action in [-1, 1], times 7.5 degrees per tic.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum DeltaButton {
    /// `LOOK_UP_DOWN_DELTA`: positive looks up.
    Look,
    /// `TURN_LEFT_RIGHT_DELTA`: positive turns right.
    Turn,
}

impl DeltaButton {
    /// The button's name in commands.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            DeltaButton::Look => "LOOK_UP_DOWN_DELTA",
            DeltaButton::Turn => "TURN_LEFT_RIGHT_DELTA",
        }
    }
}

/// A tuple of categorical sub-actions followed by a tuple of continuous ones.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct ActionSpace {
    /// The categorical sub-actions.
    pub groups: Vec<ActionGroup>,
    /// The continuous sub-actions; empty for simplified spaces.
    pub deltas: Vec<DeltaButton>,
}

/// The buttons of a level: a part of its table of constants.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Controls {
    /// Groups of exclusive buttons of the simplified space, by name.
    pub simplified: &'static [&'static [&'static str]],
    /// The full space moves the agent...
    pub full_moves: bool,
    /// ...and has SPEED.
    pub full_speed: bool,
}

/// The group that turns.
pub(crate) const TURN: &[&str] = &["TURN_LEFT", "TURN_RIGHT"];
/// The group that walks ahead.
pub(crate) const FORWARD: &[&str] = &["MOVE_FORWARD"];

impl ActionSpace {
    /// All buttons that a level knows.
    pub(crate) fn full(controls: Controls) -> ActionSpace {
        let mut groups: Vec<&[&str]> = Vec::new();
        if controls.full_moves {
            groups.extend([&["MOVE_FORWARD", "MOVE_BACKWARD"][..], &["MOVE_RIGHT", "MOVE_LEFT"]]);
        }
        groups.extend([&["SELECT_NEXT_WEAPON", "SELECT_PREV_WEAPON"][..], &["ATTACK"]]);
        if controls.full_speed {
            groups.push(&["SPEED"]);
        }
        groups.extend([&["JUMP"][..], &["USE"], &["CROUCH"], &["TURN180"]]);
        ActionSpace::new(&groups, &[DeltaButton::Look, DeltaButton::Turn])
    }

    /// The groups of buttons of these names, then the continuous parts.
    pub(crate) fn new(groups: &[&[&str]], deltas: &[DeltaButton]) -> ActionSpace {
        let named = |name: &&str| {
            *BUTTONS
                .iter()
                .find(|(n, _)| n == name)
                .expect("the table names only buttons that exist")
        };
        let groups = groups
            .iter()
            .map(|names| ActionGroup { buttons: names.iter().map(named).collect() })
            .collect();
        ActionSpace { groups, deltas: deltas.to_vec() }
    }

    /// Number of choices of each categorical sub-action.
    #[must_use]
    pub fn sizes(&self) -> Vec<usize> {
        self.groups.iter().map(|group| group.buttons.len() + 1).collect()
    }

    /// Draws actions, uniform in every part: `actions` and `deltas` of one lane, or of several, one
    /// lane after the other. Continuous parts lie in [-1, 1).
    pub fn sample(&self, rng: &mut Rng, actions: &mut [u8], deltas: &mut [f32]) {
        let mut deltas = deltas.chunks_mut(self.deltas.len().max(1));
        for actions in actions.chunks_mut(self.groups.len().max(1)) {
            for (action, group) in actions.iter_mut().zip(&self.groups) {
                *action = rng.below(group.buttons.len() as u32 + 1) as u8;
            }
            for delta in deltas.next().unwrap_or_default() {
                // 24 random bits fill an f32's precision over [-1, 1).
                *delta = (rng.next_u64() >> 40) as f32 / (1 << 23) as f32 - 1.0;
            }
        }
    }

    /// What is wrong with an action, if anything.
    pub fn check(&self, lane: usize, actions: &[u8], deltas: &[f32]) -> Result<(), EnvError> {
        if actions.len() != self.groups.len() || deltas.len() != self.deltas.len() {
            let (groups, continuous) = (self.groups.len(), self.deltas.len());
            let why = format!(
                "it has {} categorical and {} continuous parts; the action space has {groups} and {continuous}",
                actions.len(),
                deltas.len()
            );
            return Err(EnvError::Action { lane, why });
        }
        for (i, (&choice, group)) in actions.iter().zip(&self.groups).enumerate() {
            if usize::from(choice) > group.buttons.len() {
                let why = format!("part {i} is {choice}; it must be 0..={}", group.buttons.len());
                return Err(EnvError::Action { lane, why });
            }
        }
        for (&value, delta) in deltas.iter().zip(&self.deltas) {
            if !value.is_finite() {
                return Err(EnvError::Action {
                    lane,
                    why: format!("{} is {value}; it must be a number in [-1, 1]", delta.name()),
                });
            }
        }
        Ok(())
    }

    /// The action that presses exactly these buttons, if the space has it.
    #[must_use]
    pub fn action_of(&self, command: Command) -> Option<(Vec<u8>, Vec<f32>)> {
        let choose = |group: &ActionGroup| {
            group
                .buttons
                .iter()
                .position(|&(_, button)| command.buttons.any(button))
                .map_or(0, |i| i as u8 + 1)
        };
        let actions: Vec<u8> = self.groups.iter().map(choose).collect();
        let deltas = vec![0.0; self.deltas.len()];
        (self.command(&actions, &deltas) == command).then_some((actions, deltas))
    }

    /// The command that an action stands for; continuous parts beyond [-1, 1] count as the nearest
    /// end.
    #[must_use]
    pub fn command(&self, actions: &[u8], deltas: &[f32]) -> Command {
        let mut command = Command::default();
        for (&choice, group) in actions.iter().zip(&self.groups) {
            if let Some(&(_, button)) =
                usize::from(choice).checked_sub(1).and_then(|i| group.buttons.get(i))
            {
                command.buttons |= button;
            }
        }
        for (&value, delta) in deltas.iter().zip(&self.deltas) {
            let units = Command::quantise_delta(f64::from(value.clamp(-1.0, 1.0)) * DELTA_DEGREES);
            match delta {
                DeltaButton::Look => command.look_delta = units,
                DeltaButton::Turn => command.turn_delta = units,
            }
        }
        command
    }
}

/// What a policy does in one step.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Move<'a> {
    /// An action of the action space: categorical and continuous parts.
    Action(&'a [u8], &'a [f32]),
    /// Buttons held through the step, in the action space or not.
    Buttons(Command),
}

/// Reads buttons by name, joined by `+`: `MOVE_FORWARD+SPEED`, delta buttons as
/// `TURN_LEFT_RIGHT_DELTA=2.5` (degrees per tic; a bare delta name means 1). `noop` and the empty
/// text press nothing.
pub fn parse_command(text: &str) -> Result<Command, EnvError> {
    let mut command = Command::default();
    if text.is_empty() || text == "noop" {
        return Ok(command);
    }
    for part in text.split('+') {
        let unknown = || EnvError::UnknownButton { given: excerpt(part) };
        let (name, value) =
            part.split_once('=').map_or((part, None), |(name, value)| (name, Some(value)));
        let delta =
            [DeltaButton::Look, DeltaButton::Turn].into_iter().find(|delta| delta.name() == name);
        if let Some(delta) = delta {
            let degrees: f64 = value.map_or(Ok(1.0), str::parse).map_err(|_| unknown())?;
            if !(-360.0..=360.0).contains(&degrees) {
                return Err(unknown());
            }
            let units = Command::quantise_delta(degrees);
            match delta {
                DeltaButton::Look => command.look_delta = units,
                DeltaButton::Turn => command.turn_delta = units,
            }
        } else {
            let found = BUTTONS.iter().find(|(n, _)| *n == name).ok_or_else(unknown)?;
            if value.is_some_and(|value| value != "1") {
                return Err(unknown());
            }
            command.buttons |= found.1;
        }
    }
    Ok(command)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::scenario::EnvId;
    use crate::scenarios::common::rule_set::RuleSet;
    use crate::scenarios::common::scenario::Scenario;

    fn space(id: &str, full: bool) -> ActionSpace {
        ActionSpace::of(id.parse().unwrap(), RuleSet::Paper, false, full)
    }

    /// Number of actions of each scenario's first level.
    fn counts(rules: RuleSet, hard: bool, full: bool) -> [usize; 6] {
        Scenario::ALL.map(|scenario| {
            let id = EnvId { scenario, level: 1 };
            ActionSpace::of(id, rules, hard, full).sizes().iter().product()
        })
    }

    /// Every choice comes, and several lanes at once are lanes one after the other.
    #[test]
    fn samples_are_actions_of_the_space() {
        let space = space("ArmamentBurdenLevel1-v0", true);
        let (groups, parts, lanes) = (space.groups.len(), space.deltas.len(), 200);
        assert!(groups > 0 && parts > 0);
        let (mut actions, mut deltas) = (vec![9; lanes * groups], vec![9.0; lanes * parts]);
        space.sample(&mut Rng::new(3), &mut actions, &mut deltas);
        let mut alone = Rng::new(3);
        for (actions, deltas) in actions.chunks(groups).zip(deltas.chunks(parts)) {
            space.check(0, actions, deltas).unwrap();
            let (mut own, mut parts) = (vec![0; groups], vec![0.0; parts]);
            space.sample(&mut alone, &mut own, &mut parts);
            assert_eq!((own.as_slice(), parts.as_slice()), (actions, deltas));
        }
        for (group, size) in space.sizes().into_iter().enumerate() {
            let drawn = actions.iter().skip(group).step_by(groups);
            let all: std::collections::BTreeSet<u8> = drawn.copied().collect();
            assert_eq!(all.len(), size, "{group}");
        }
    }

    #[test]
    fn spaces_have_the_published_numbers_of_actions() {
        for rules in [RuleSet::Paper, RuleSet::Released] {
            for hard in [false, true] {
                assert_eq!(counts(rules, hard, false), [24, 6, 48, 54, 24, 24]);
                assert_eq!(counts(rules, hard, true), [864, 192, 1728, 1728, 1728, 1728]);
            }
        }
    }

    /// The code of the paper's tables: its full spaces have no SPEED in three scenarios, and its
    /// hard table had three spaces of its own.
    #[test]
    fn the_tables_have_spaces_of_their_own() {
        assert_eq!(counts(RuleSet::Tables, false, false), [24, 6, 48, 54, 24, 24]);
        assert_eq!(counts(RuleSet::Tables, true, false), [6, 6, 48, 9, 6, 24]);
        for hard in [false, true] {
            assert_eq!(counts(RuleSet::Tables, hard, true), [864, 192, 1728, 1728, 864, 864]);
        }
        let last = |rules| {
            let space =
                ActionSpace::of("RemedyRushLevel2-v0".parse().unwrap(), rules, false, false);
            space.groups[2..].iter().map(|group| group.buttons[0].0).collect::<Vec<_>>()
        };
        assert_eq!(last(RuleSet::Released), ["SPEED", "JUMP"]);
        assert_eq!(last(RuleSet::Tables), ["JUMP", "SPEED"]);
    }

    #[test]
    fn an_action_becomes_its_buttons() {
        let command = space("VolcanicVentureLevel1-v0", false).command(&[2, 1, 0, 1], &[]);
        assert_eq!(command.buttons, Buttons::TURN_RIGHT | Buttons::MOVE_FORWARD | Buttons::SPEED);
        let command = space("VolcanicVentureLevel1-v0", true).command(&[0; 9], &[-1.0, 1.0]);
        assert_eq!((command.look_delta, command.turn_delta), (-1366, 1365));
    }

    #[test]
    fn wrong_actions_are_named() {
        let space = space("CollateralDamageLevel1-v0", true);
        assert!(space.check(0, &[0; 7], &[0.0, 0.0]).is_ok());
        assert!(space.check(0, &[0; 6], &[0.0, 0.0]).is_err());
        assert!(space.check(0, &[3, 0, 0, 0, 0, 0, 0], &[0.0, 0.0]).is_err());
        assert!(space.check(0, &[0; 7], &[f32::NAN, 0.0]).is_err());
    }

    #[test]
    fn buttons_are_read_by_name() {
        assert_eq!(
            parse_command("MOVE_FORWARD+SPEED").unwrap().buttons,
            Buttons::MOVE_FORWARD | Buttons::SPEED
        );
        assert_eq!(parse_command("TURN_LEFT_RIGHT_DELTA=-7.5").unwrap().turn_delta, -1366);
        assert_eq!(
            parse_command("LOOK_UP_DOWN_DELTA").unwrap().look_delta,
            Command::quantise_delta(1.0)
        );
        assert_eq!(parse_command("noop").unwrap(), Command::default());
        for wrong in [
            "FORWARD",
            "MOVE_FORWARD+",
            "TURN_LEFT_RIGHT_DELTA=x",
            "JUMP=2",
            "TURN_LEFT_RIGHT_DELTA=nan",
        ] {
            assert!(parse_command(wrong).is_err(), "{wrong}");
        }
    }
}
