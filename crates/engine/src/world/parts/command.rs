//! What an agent asks of its player for one tic.

/// Buttons held, a bit each, in the order of the full action space.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default, Debug)]
pub struct Buttons(pub u32);

#[allow(missing_docs, reason = "the names of the buttons say it")]
impl Buttons {
    pub const MOVE_FORWARD: Buttons = Buttons(1);
    pub const MOVE_BACKWARD: Buttons = Buttons(1 << 1);
    pub const MOVE_RIGHT: Buttons = Buttons(1 << 2);
    pub const MOVE_LEFT: Buttons = Buttons(1 << 3);
    pub const SELECT_NEXT_WEAPON: Buttons = Buttons(1 << 4);
    pub const SELECT_PREV_WEAPON: Buttons = Buttons(1 << 5);
    pub const ATTACK: Buttons = Buttons(1 << 6);
    pub const SPEED: Buttons = Buttons(1 << 7);
    pub const JUMP: Buttons = Buttons(1 << 8);
    pub const USE: Buttons = Buttons(1 << 9);
    pub const CROUCH: Buttons = Buttons(1 << 10);
    pub const TURN180: Buttons = Buttons(1 << 11);
    pub const TURN_LEFT: Buttons = Buttons(1 << 12);
    pub const TURN_RIGHT: Buttons = Buttons(1 << 13);
    pub const LOOK_UP: Buttons = Buttons(1 << 14);
    pub const LOOK_DOWN: Buttons = Buttons(1 << 15);

    /// Whether any button of `other` is held.
    #[must_use]
    pub const fn any(self, other: Buttons) -> bool {
        self.0 & other.0 != 0
    }
}

impl std::ops::BitOr for Buttons {
    type Output = Buttons;
    fn bitor(self, other: Buttons) -> Buttons {
        Buttons(self.0 | other.0)
    }
}

impl std::ops::BitOrAssign for Buttons {
    fn bitor_assign(&mut self, other: Buttons) {
        self.0 |= other.0;
    }
}

/// One player's input for one tic.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Command {
    /// Buttons held.
    pub buttons: Buttons,
    /// `LOOK_UP_DOWN_DELTA`, up positive, in 65536ths of a turn: `floor(degrees / 180 * 32768)`.
    pub look_delta: i32,
    /// `TURN_LEFT_RIGHT_DELTA`, right positive, in the same unit.
    pub turn_delta: i32,
}

impl Command {
    /// Quantises a delta button's degrees per tic to 65536ths of a turn, rounding down as the
    /// original does.
    #[must_use]
    #[allow(
        clippy::float_arithmetic,
        reason = "the border where a policy's number becomes a whole one"
    )]
    pub fn quantise_delta(degrees: f64) -> i32 {
        (degrees / 180.0 * 32768.0).floor() as i32
    }
}
