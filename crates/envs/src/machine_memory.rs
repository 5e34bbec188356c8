//! How much memory this machine has: asked before anything large is made, since the system ends a
//! program that runs out of memory without a word.

use crate::EnvError;
use sysinfo::{MemoryRefreshKind, RefreshKind, System};

/// Bytes of memory of this machine, or of the group of processes that this one is in; `None` where
/// the system does not say.
#[must_use]
pub fn machine_memory() -> Option<u64> {
    let kind = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    let system = System::new_with_specifics(kind);
    let whole = system.cgroup_limits().map_or(system.total_memory(), |limits| limits.total_memory);
    (whole > 0).then_some(whole)
}

/// Refuses so many environments where their observations alone are more than `memory` bytes.
pub(crate) fn check(
    lanes: usize,
    observation: [usize; 3],
    memory: Option<u64>,
) -> Result<(), EnvError> {
    // A system that does not say how much it has refuses nothing.
    let Some(memory) = memory else { return Ok(()) };
    let most = memory / observation.iter().product::<usize>().max(1) as u64;
    if lanes as u64 <= most {
        return Ok(());
    }
    let [first, second, third] = observation;
    let gigabytes = memory as f64 / 1e9;
    Err(EnvError::Option {
        option: "the number of environments",
        given: lanes.to_string(),
        allowed: format!(
            "at most {most}: observations of {first} x {second} x {third} bytes fill the {gigabytes:.0} GB of this machine's \
             memory; give fewer environments or a smaller size"
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{EnvOptions, FrameSize, VecEnv, VecOptions};

    #[test]
    fn as_many_fit_as_the_memory_holds() {
        let observation = [72, 128, 3];
        let memory = Some(1000 * 72 * 128 * 3);
        assert_eq!(check(1000, observation, memory), Ok(()));
        let refused = check(1001, observation, memory).unwrap_err().to_string();
        assert!(refused.contains("cannot be 1001; it must be at most 1000"), "{refused}");
        assert_eq!(check(65_536, observation, None), Ok(()));
    }

    /// Before a world is made for each lane, which would take minutes.
    #[test]
    fn a_batch_larger_than_the_memory_is_refused() {
        let size = FrameSize { width: 1920, height: 1080 };
        let options = EnvOptions { size, frame_stack: 16, ..EnvOptions::default() };
        let lanes = VecOptions { lanes: 65_536, ..VecOptions::default() };
        let refused = VecEnv::new("RemedyRushLevel1-v0", &options, lanes).err().unwrap();
        assert!(refused.to_string().contains("1080 x 1920 x 48 bytes fill"), "{refused}");
    }
}
