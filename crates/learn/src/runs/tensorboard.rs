//! Event files that TensorBoard reads: scalars by step.
//!
//! A file is a row of records: length, its masked checksum, payload, its masked checksum. The payload is a protocol
//! buffer `Event` (1: wall time as double, 2: step, 3: file version, 5: summary of 1: values of 1: tag and 2: float).

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use crate::error::LearnError;
use crate::runs::checksum::crc32c;

/// An event file being written.
pub struct EventFile {
    path: PathBuf,
    file: File,
}

impl EventFile {
    /// A new file in a directory; its name is the one TensorBoard looks for.
    pub fn create(directory: &Path) -> Result<EventFile, LearnError> {
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let name = format!("events.out.tfevents.{:010}.{:06}.hasard", since.as_secs(), std::process::id() % 1_000_000);
        let path = directory.join(name);
        let file = File::options().create(true).append(true).open(&path).map_err(LearnError::file(&path, "create"))?;
        let mut events = EventFile { path, file };
        let mut version = Vec::new();
        bytes_field(&mut version, 3, b"brain.Event:2");
        events.record(&event(0, &version))?;
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
        let mut events = EventFile::create(&directory).unwrap();
        events.scalars(300, &[("return".into(), 1.5), ("nothing".into(), f64::NAN)]).unwrap();
        let bytes = std::fs::read(&events.path).unwrap();
        let mut at = 0;
        let mut payloads = Vec::new();
        while at < bytes.len() {
            let length = u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
            let check = u32::from_le_bytes(bytes[at + 8..at + 12].try_into().unwrap());
            assert_eq!(check, masked(&bytes[at..at + 8]));
            let payload = &bytes[at + 12..at + 12 + length];
            let check = u32::from_le_bytes(bytes[at + 12 + length..at + 16 + length].try_into().unwrap());
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
        std::fs::remove_dir_all(&directory).unwrap();
    }
}
