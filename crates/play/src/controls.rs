//! Keys and mouse as actions.

use hasard_envs::{ActionSpace, DELTA_DEGREES, DeltaButton};

/// What a player can hold down, by what it is for.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
#[expect(missing_docs, reason = "named after the buttons of the environments")]
pub enum Key {
    Forward,
    Backward,
    Right,
    Left,
    TurnLeft,
    TurnRight,
    LookUp,
    LookDown,
    Attack,
    Use,
    Jump,
    Crouch,
    Speed,
    NextWeapon,
    PreviousWeapon,
    TurnRound,
}

impl Key {
    /// Every key.
    const ALL: [Key; 16] = [
        Key::Forward,
        Key::Backward,
        Key::Right,
        Key::Left,
        Key::TurnLeft,
        Key::TurnRight,
        Key::LookUp,
        Key::LookDown,
        Key::Attack,
        Key::Use,
        Key::Jump,
        Key::Crouch,
        Key::Speed,
        Key::NextWeapon,
        Key::PreviousWeapon,
        Key::TurnRound,
    ];

    /// The key that presses the button of a name.
    #[must_use]
    pub fn of_button(name: &str) -> Option<Key> {
        Key::ALL.into_iter().find(|key| key.button() == name)
    }

    /// Name of the button that it presses.
    #[must_use]
    pub const fn button(self) -> &'static str {
        match self {
            Key::Forward => "MOVE_FORWARD",
            Key::Backward => "MOVE_BACKWARD",
            Key::Right => "MOVE_RIGHT",
            Key::Left => "MOVE_LEFT",
            Key::TurnLeft => "TURN_LEFT",
            Key::TurnRight => "TURN_RIGHT",
            Key::LookUp => "LOOK_UP",
            Key::LookDown => "LOOK_DOWN",
            Key::Attack => "ATTACK",
            Key::Use => "USE",
            Key::Jump => "JUMP",
            Key::Crouch => "CROUCH",
            Key::Speed => "SPEED",
            Key::NextWeapon => "SELECT_NEXT_WEAPON",
            Key::PreviousWeapon => "SELECT_PREV_WEAPON",
            Key::TurnRound => "TURN180",
        }
    }
}

/// Degrees that a picture point of mouse movement turns.
const DEGREES_A_POINT: f32 = 0.12;
/// Degrees of mouse movement in a step that press a turn or look button where the action space has
/// no finer way.
const DEGREES_A_PRESS: f32 = 1.5;
/// Degrees a tic that keys turn and look where the action space has no buttons for that.
const KEY_DEGREES: f32 = 3.5;

/// What is held and how the mouse moved, turned into actions of an action space.
#[derive(Clone, Debug, Default)]
pub struct Controls {
    /// Held keys; the latest last, which wins among exclusive ones.
    held: Vec<Key>,
    /// Keys that were pressed and let go since the last action: a short press still counts.
    tapped: Vec<Key>,
    /// Degrees that the mouse asks for and did not get yet, right and up.
    turn: f32,
    look: f32,
}

impl Controls {
    /// A key goes down.
    pub fn press(&mut self, key: Key) {
        if !self.held.contains(&key) {
            self.held.push(key);
            self.tapped.push(key);
        }
    }

    /// A key goes up.
    pub fn release(&mut self, key: Key) {
        self.held.retain(|held| *held != key);
    }

    /// Everything goes up: the window lost its focus.
    pub fn release_all(&mut self) {
        *self = Controls::default();
    }

    /// The mouse moved by picture points, right and down.
    pub fn move_mouse(&mut self, right: f32, down: f32) {
        self.turn += right * DEGREES_A_POINT;
        self.look -= down * DEGREES_A_POINT;
    }

    /// The action of the next step of `tics` tics. In each group of exclusive buttons the latest
    /// key wins. Turning goes by the finest way that the space has; what the mouse asked for beyond
    /// what a step can turn waits for the next.
    pub fn action(&mut self, space: &ActionSpace, tics: u32) -> (Vec<u8>, Vec<f32>) {
        let mut keys: Vec<Key> =
            self.tapped.drain(..).filter(|key| !self.held.contains(key)).collect();
        keys.extend(&self.held);
        let has = |name: &str| {
            space.groups.iter().any(|group| group.buttons.iter().any(|(known, _)| *known == name))
        };
        let mut names: Vec<&str> = Vec::new();
        for key in &keys {
            names.push(match key {
                // Without side steps, the keys for them turn.
                Key::Left if !has("MOVE_LEFT") => "TURN_LEFT",
                Key::Right if !has("MOVE_RIGHT") => "TURN_RIGHT",
                other => other.button(),
            });
        }
        let mut deltas = Vec::with_capacity(space.deltas.len());
        for delta in &space.deltas {
            let (wanted, less, more) = match delta {
                DeltaButton::Turn => (&mut self.turn, "TURN_LEFT", "TURN_RIGHT"),
                DeltaButton::Look => (&mut self.look, "LOOK_DOWN", "LOOK_UP"),
            };
            let keyed =
                f32::from(i8::from(names.contains(&more)) - i8::from(names.contains(&less)))
                    * KEY_DEGREES;
            let limit = DELTA_DEGREES as f32;
            let a_tic = (*wanted / tics.max(1) as f32 + keyed).clamp(-limit, limit);
            *wanted = (*wanted - (a_tic - keyed) * tics as f32).clamp(-90.0, 90.0);
            deltas.push(a_tic / limit);
        }
        for (delta, wanted, less, more) in [
            (DeltaButton::Turn, &mut self.turn, "TURN_LEFT", "TURN_RIGHT"),
            (DeltaButton::Look, &mut self.look, "LOOK_DOWN", "LOOK_UP"),
        ] {
            if !space.deltas.contains(&delta) {
                if wanted.abs() > DEGREES_A_PRESS {
                    names.push(if *wanted > 0.0 { more } else { less });
                }
                *wanted = 0.0;
            }
        }
        let choice = |group: &hasard_envs::ActionGroup| {
            let latest = names
                .iter()
                .rev()
                .find_map(|name| group.buttons.iter().position(|(known, _)| known == name));
            latest.map_or(0, |at| at as u8 + 1)
        };
        (space.groups.iter().map(choice).collect(), deltas)
    }
}
