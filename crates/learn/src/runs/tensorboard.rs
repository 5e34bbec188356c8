//! Event files that TensorBoard reads: scalars by step.
//!
//! A file is a row of records: length, its masked checksum, payload, its masked checksum. The
//! payload is a protocol buffer `Event` (1: wall time as double, 2: step, 3: file version, 5:
//! summary of 1: values of 1: tag and 2: float, 7: session log of 1: status).
//!
//! A run that goes on from a checkpoint takes back what was written after it: [`until`] cuts the
//! files, and the new file begins with a session log that says from which step on, so that a
//! TensorBoard that is open forgets it as well.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use crate::error::LearnError;
use crate::runs::checksum::crc32c;

/// Ending of the names of our own files: others in the directory are left alone.
const ENDING: &str = "hasard";
/// Bytes of a record beside its payload.
const FRAME: usize = 16;

/// An event file being written.
pub struct EventFile {
    path: PathBuf,
    file: File,
}

impl EventFile {
    /// A new file in a directory, of what comes after these frames; its name is the one TensorBoard
    /// looks for.
    pub fn create(directory: &Path, frames: u64) -> Result<EventFile, LearnError> {
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let name = format!(
            "events.out.tfevents.{:010}.{:06}.{ENDING}",
            since.as_secs(),
            std::process::id() % 1_000_000
        );
        let path = directory.join(name);
        let file = File::options()
            .create(true)
            .append(true)
            .open(&path)
            .map_err(LearnError::file(&path, "create"))?;
        let mut events = EventFile { path, file };
        let mut version = Vec::new();
        bytes_field(&mut version, 3, b"brain.Event:2");
        events.record(&event(0, &version))?;
        if frames > 0 {
            // Status 1 is START.
            let mut start = Vec::new();
            bytes_field(&mut start, 7, &[1 << 3, 1]);
            events.record(&event(frames + 1, &start))?;
        }
        Ok(events)
    }

    /// Writes scalars of a step.
    pub fn scalars(&mut self, step: u64, values: &[(String, f64)]) -> Result<(), LearnError> {
        let mut summary = Vec::new();
        for (tag, value) in values.iter().filter(|(_, value)| value.is_finite()) {
            let mut entry = Vec::new();
            bytes_field(&mut entry, 1, tag.as_bytes());
            entry.push(2 << 3 | 5);
            entry.extend_from_slice(&(*value as f32).to_le_bytes());
            bytes_field(&mut summary, 1, &entry);
        }
        let mut body = Vec::new();
        bytes_field(&mut body, 5, &summary);
        self.record(&event(step, &body))
    }

    fn record(&mut self, payload: &[u8]) -> Result<(), LearnError> {
        let length = (payload.len() as u64).to_le_bytes();
        let mut record = length.to_vec();
        record.extend_from_slice(&masked(&length).to_le_bytes());
        record.extend_from_slice(payload);
        record.extend_from_slice(&masked(payload).to_le_bytes());
        self.file.write_all(&record).map_err(LearnError::file(&self.path, "write"))
    }
}

/// The event files of a run.
#[must_use]
pub fn files(directory: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(directory)
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()));
    let mut files: Vec<PathBuf> = entries
        .filter(|path| {
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            name.starts_with("events.out.tfevents.") && name.ends_with(ENDING) && path.is_file()
        })
        .collect();
    files.sort();
    files
}

/// The whole records of an event file up to a step; what follows a damaged one is lost.
#[must_use]
pub fn until(bytes: &[u8], last: u64) -> Vec<u8> {
    let (mut kept, mut rest) = (Vec::new(), bytes);
    while let Some((record, after)) = first_record(rest) {
        if step_of(&record[12..]).is_some_and(|step| step <= last) {
            kept.extend_from_slice(record);
        }
        rest = after;
    }
    kept
}

/// The first record, if it is whole, and what follows it.
fn first_record(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let length = usize::try_from(u64::from_le_bytes(bytes.get(..8)?.try_into().ok()?)).ok()?;
    let end = length.checked_add(FRAME).filter(|&end| end <= bytes.len())?;
    let (record, after) = bytes.split_at(end);
    let check = u32::from_le_bytes(record[end - 4..].try_into().ok()?);
    (check == masked(&record[12..end - 4])).then_some((record, after))
}

/// The step of an event as [`event`] lays it out; 0 where it has none.
fn step_of(payload: &[u8]) -> Option<u64> {
    let rest = payload.get(9..)?;
    let (tag, number) = rest.split_first()?;
    if *tag != 2 << 3 {
        return Some(0);
    }
    let mut step = 0u64;
    for (place, byte) in number.iter().enumerate().take(10) {
        step |= u64::from(byte & 127).checked_shl(7 * place as u32)?;
        if byte & 128 == 0 {
            return Some(step);
        }
    }
    None
}

fn masked(bytes: &[u8]) -> u32 {
    crc32c(bytes).rotate_right(15).wrapping_add(0xA282_EAD8)
}

fn event(step: u64, body: &[u8]) -> Vec<u8> {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs_f64();
    let mut event = vec![1 << 3 | 1];
    event.extend_from_slice(&now.to_le_bytes());
    event.push(2 << 3);
    varint(&mut event, step);
    event.extend_from_slice(body);
    event
}

fn bytes_field(out: &mut Vec<u8>, number: u8, bytes: &[u8]) {
    out.push(number << 3 | 2);
    varint(out, bytes.len() as u64);
    out.extend_from_slice(bytes);
}

fn varint(out: &mut Vec<u8>, mut value: u64) {
    while value >= 128 {
        out.push(value as u8 | 128);
        value >>= 7;
    }
    out.push(value as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads a file back by the format's own rules.
    #[test]
    fn records_are_framed_and_hold_their_scalars() {
        let directory = std::env::temp_dir().join(format!("hasard-events-{}", std::process::id()));
        std::fs::create_dir_all(&directory).unwrap();
        let mut events = EventFile::create(&directory, 0).unwrap();
        events.scalars(300, &[("return".into(), 1.5), ("nothing".into(), f64::NAN)]).unwrap();
        let bytes = std::fs::read(&events.path).unwrap();
        let mut at = 0;
        let mut payloads = Vec::new();
        while at < bytes.len() {
            let length = u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
            let check = u32::from_le_bytes(bytes[at + 8..at + 12].try_into().unwrap());
            assert_eq!(check, masked(&bytes[at..at + 8]));
            let payload = &bytes[at + 12..at + 12 + length];
            let check =
                u32::from_le_bytes(bytes[at + 12 + length..at + 16 + length].try_into().unwrap());
            assert_eq!(check, masked(payload));
            payloads.push(payload.to_vec());
            at += 16 + length;
        }
        assert_eq!(payloads.len(), 2);
        assert!(payloads[0].ends_with(b"brain.Event:2"));
        // Step 300 as a varint, then the summary with tag and float.
        assert_eq!(payloads[1][9..12], [0x10, 0xAC, 0x02]);
        let mut expected = vec![0x2A, 15, 0x0A, 13, 0x0A, 6];
        expected.extend_from_slice(b"return");
        expected.push(0x15);
        expected.extend_from_slice(&1.5f32.to_le_bytes());
        assert_eq!(payloads[1][12..], expected);
        // Cut after a step: the version and the step stay; a record that is half there goes.
        events.scalars(301, &[("return".into(), 2.5)]).unwrap();
        let longer = std::fs::read(&events.path).unwrap();
        assert_eq!(until(&longer, 300), bytes);
        assert_eq!(until(&longer[..longer.len() - 1], 301), bytes);
        assert_eq!(until(&longer, 301), longer);
        std::fs::remove_dir_all(&directory).unwrap();
    }
}
