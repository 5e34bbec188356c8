//! Keys of the keyboard as keys of the game.

use crate::Key;
use winit::keyboard::KeyCode;

/// What a key presses; where the task has no buttons to look with, the arrows walk.
pub(super) fn of(code: KeyCode, can_look: bool) -> Option<Key> {
    Some(match code {
        KeyCode::KeyW => Key::Forward,
        KeyCode::KeyS => Key::Backward,
        KeyCode::KeyA => Key::Left,
        KeyCode::KeyD => Key::Right,
        KeyCode::ArrowLeft => Key::TurnLeft,
        KeyCode::ArrowRight => Key::TurnRight,
        KeyCode::ArrowUp if can_look => Key::LookUp,
        KeyCode::ArrowDown if can_look => Key::LookDown,
        KeyCode::ArrowUp => Key::Forward,
        KeyCode::ArrowDown => Key::Backward,
        KeyCode::Space => Key::Jump,
        KeyCode::KeyE => Key::Use,
        KeyCode::KeyC => Key::Crouch,
        KeyCode::ShiftLeft | KeyCode::ShiftRight => Key::Speed,
        KeyCode::ControlLeft | KeyCode::ControlRight => Key::Attack,
        KeyCode::KeyQ => Key::PreviousWeapon,
        KeyCode::KeyT => Key::TurnRound,
        _ => return None,
    })
}
