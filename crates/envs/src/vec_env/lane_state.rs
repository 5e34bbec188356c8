//! Where a lane is, as a value and as bytes.

use crate::{ActionSpace, EnvError};

/// Where one lane is: enough to bring it back exactly, by repeating its episode.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct LaneState {
    /// State of the stream that the seeds of the episodes to come are drawn from.
    pub seeds: u64,
    /// Seed of the running episode.
    pub seed: u64,
    /// [`crate::Environment::fingerprint`] of the environment that it was saved from; 0 where that
    /// is not known.
    pub env: u64,
    /// Categorical sub-actions of the episode so far.
    pub actions: Vec<u8>,
    /// Continuous sub-actions of the episode so far.
    pub deltas: Vec<f32>,
}

/// What saved lanes begin with: a name, and the version of what follows. The first version did not
/// say of which environment they are.
const HEAD: [u8; 8] = *b"hslanes\x02";
const FORMER: [u8; 8] = *b"hslanes\x01";

impl LaneState {
    /// Lanes as bytes, the same on every platform: a head with the format's version, the number of
    /// lanes, then each lane's two seeds, its environment's fingerprint, the numbers of its sub-actions and the sub-actions;
    /// little-endian.
    #[must_use]
    pub fn to_bytes(lanes: &[LaneState]) -> Vec<u8> {
        let mut bytes = HEAD.to_vec();
        bytes.extend((lanes.len() as u64).to_le_bytes());
        for lane in lanes {
            let lengths = [lane.actions.len() as u64, lane.deltas.len() as u64];
            for number in [lane.seeds, lane.seed, lane.env].into_iter().chain(lengths) {
                bytes.extend(number.to_le_bytes());
            }
            bytes.extend(&lane.actions);
            bytes.extend(lane.deltas.iter().flat_map(|delta| delta.to_le_bytes()));
        }
        bytes
    }

    /// Reads what [`LaneState::to_bytes`] wrote.
    pub fn from_bytes(bytes: &[u8]) -> Result<Vec<LaneState>, EnvError> {
        let mut rest = bytes;
        let head = cut(&mut rest, HEAD.len())?;
        if head[..7] != HEAD[..7] {
            return Err(spoiled("they do not begin as saved lanes do"));
        }
        if head != HEAD && head != FORMER {
            return Err(spoiled(
                "another version wrote them; load them with that version of hasard",
            ));
        }
        let lanes = number(&mut rest)?;
        let former = head == FORMER;
        // A lane takes 32 bytes at least: no list longer than the bytes can fill is ever made.
        if lanes > rest.len() as u64 / 32 {
            return Err(spoiled("they end early"));
        }
        let mut states = Vec::with_capacity(lanes as usize);
        for _ in 0..lanes {
            let [seeds, seed] = [number(&mut rest)?, number(&mut rest)?];
            let env = if former { 0 } else { number(&mut rest)? };
            let [actions, deltas] = [number(&mut rest)?, number(&mut rest)?]
                .map(|count| usize::try_from(count).unwrap_or(usize::MAX));
            let actions = cut(&mut rest, actions)?.to_vec();
            let deltas = cut(&mut rest, deltas.saturating_mul(4))?;
            let deltas = deltas
                .chunks_exact(4)
                .map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]))
                .collect();
            states.push(LaneState { seeds, seed, env, actions, deltas });
        }
        if rest.is_empty() {
            Ok(states)
        } else {
            Err(spoiled("more bytes follow than the lanes take"))
        }
    }

    /// Number of steps of the episode so far; an error if it is not whole or holds an action that
    /// the space has not.
    pub(super) fn check(&self, lane: usize, space: &ActionSpace) -> Result<usize, EnvError> {
        let steps = self.steps(space);
        for i in 0..steps {
            let (actions, deltas) = self.action(i, space);
            space.check(lane, actions, deltas)?;
        }
        if self.actions.len() != steps * space.groups.len()
            || self.deltas.len() != steps * space.deltas.len()
        {
            return Err(EnvError::Action {
                lane,
                why: "a saved episode does not fit the action space".to_string(),
            });
        }
        Ok(steps)
    }

    /// Number of whole steps; spaces may lack categorical parts, or continuous ones, but not both.
    pub(super) fn steps(&self, space: &ActionSpace) -> usize {
        let parts = |given: usize, each: usize| given.checked_div(each).unwrap_or(usize::MAX);
        match parts(self.actions.len(), space.groups.len())
            .min(parts(self.deltas.len(), space.deltas.len()))
        {
            usize::MAX => 0,
            steps => steps,
        }
    }

    /// The action of a step.
    pub(super) fn action(&self, step: usize, space: &ActionSpace) -> (&[u8], &[f32]) {
        let (groups, deltas) = (space.groups.len(), space.deltas.len());
        (
            &self.actions[step * groups..(step + 1) * groups],
            &self.deltas[step * deltas..(step + 1) * deltas],
        )
    }
}

fn spoiled(why: &str) -> EnvError {
    EnvError::Saved { why: format!("these bytes are no saved lanes: {why}") }
}

/// Takes bytes from the front.
fn cut<'a>(rest: &mut &'a [u8], count: usize) -> Result<&'a [u8], EnvError> {
    let (front, back) = rest.split_at_checked(count).ok_or_else(|| spoiled("they end early"))?;
    *rest = back;
    Ok(front)
}

fn number(rest: &mut &[u8]) -> Result<u64, EnvError> {
    let bytes = cut(rest, 8)?;
    Ok(u64::from_le_bytes(bytes.try_into().expect("eight bytes were cut")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lanes() -> Vec<LaneState> {
        let lane = |seed: u64| LaneState {
            seeds: !seed,
            seed,
            env: seed ^ 5,
            actions: vec![1, 2, 3, seed as u8],
            deltas: vec![0.5, -1.0],
        };
        vec![lane(1), LaneState::default(), lane(u64::MAX)]
    }

    #[test]
    fn bytes_read_are_what_was_written() {
        assert_eq!(LaneState::from_bytes(&LaneState::to_bytes(&lanes())), Ok(lanes()));
        assert_eq!(LaneState::from_bytes(&LaneState::to_bytes(&[])), Ok(vec![]));
    }

    /// Of the version that did not name environments: the seeds of the one lane, and its action.
    #[test]
    fn lanes_of_the_former_version_are_read() {
        let mut bytes = b"hslanes\x01".to_vec();
        for number in [1_u64, 7, 9, 1, 0] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.push(2);
        let lane = LaneState { seeds: 7, seed: 9, env: 0, actions: vec![2], deltas: vec![] };
        assert_eq!(LaneState::from_bytes(&bytes), Ok(vec![lane]));
    }

    #[test]
    fn spoiled_bytes_are_refused() {
        let bytes = LaneState::to_bytes(&lanes());
        for length in 0..bytes.len() {
            assert!(LaneState::from_bytes(&bytes[..length]).is_err(), "cut to {length}");
        }
        let longer = [&bytes[..], &[0]].concat();
        assert!(LaneState::from_bytes(&longer).is_err());
        for (at, what) in [
            (0, "do not begin"),
            (7, "version"),
            (15, "end early"),
            (47, "end early"),
            (55, "end early"),
        ] {
            let mut spoiled = bytes.clone();
            spoiled[at] = 0xff;
            let error = LaneState::from_bytes(&spoiled).unwrap_err().to_string();
            assert!(error.contains(what), "{at}: {error}");
        }
    }
}
