//! `hand_out.json`: which checkpoint a run hands out.

use super::Warning;
use serde_json::Value;
use std::path::Path;

/// The checkpoint that a run hands out.
#[derive(Clone, PartialEq, Debug)]
pub struct HandOut {
    /// Frames after which it was taken.
    pub frames: f64,
}

/// Reads the file of a run directory, if there is one; a damaged one is told of.
pub fn read_hand_out(run: &Path, warnings: &mut Vec<Warning>) -> Option<HandOut> {
    let path = run.join("hand_out.json");
    if !path.is_file() {
        return None;
    }
    let problem = match super::read_text(&path) {
        Ok(text) => match understand(&text) {
            Some(hand_out) => return Some(hand_out),
            None => "does not say which checkpoint is handed out; passed over".to_owned(),
        },
        Err(warning) => warning.problem,
    };
    warnings.push(Warning { path, line: 0, problem });
    None
}

fn understand(text: &str) -> Option<HandOut> {
    let value: Value = serde_json::from_str(text).ok()?;
    Some(HandOut { frames: value.get("frames")?.as_f64()? })
}
