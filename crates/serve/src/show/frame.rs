//! A moment as one message: the length of a header (32 bits, little-endian), the header as JSON,
//! the pictures as PNG.

use hasard_play::ViewKind;
use serde_json::{Value, json};

/// Puts a moment together. `header` is an object, to which the list of pictures is added.
pub(super) fn message(mut header: Value, pictures: &[(ViewKind, Vec<u8>)]) -> Vec<u8> {
    header["pictures"] = pictures
        .iter()
        .map(|(kind, file)| json!({ "view": kind.caption(), "bytes": file.len() }))
        .collect();
    let header = header.to_string();
    let length = 4 + header.len() + pictures.iter().map(|(_, file)| file.len()).sum::<usize>();
    let mut bytes = Vec::with_capacity(length);
    bytes.extend((header.len() as u32).to_le_bytes());
    bytes.extend(header.as_bytes());
    pictures.iter().for_each(|(_, file)| bytes.extend(file));
    bytes
}
