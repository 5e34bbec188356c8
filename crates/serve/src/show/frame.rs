//! A moment as one message: the length of a header (32 bits, little-endian), the header as JSON, the pictures as JPEG.

use hasard_media::Picture;
use hasard_play::ViewKind;
use jpeg_encoder::{ColorType, Encoder, SamplingFactor};
use serde_json::{Value, json};

/// Quality of pictures, 1 to 100, in motion, where coding is most of what a show costs, and at rest, where the eye has time for textures.
const MOVING: u8 = 70;
const STILL: u8 = 90;

/// Puts a moment together. `header` is an object, to which the list of pictures is added; `still` if no other moment is to follow by itself.
pub(super) fn message(mut header: Value, pictures: &[(ViewKind, Picture)], still: bool) -> Vec<u8> {
    let mut coded = Vec::new();
    let mut list = Vec::new();
    for (kind, picture) in pictures {
        let before = coded.len();
        let mut encoder = Encoder::new(&mut coded, if still { STILL } else { MOVING });
        // Classes and maps are thin lines of pure colours: their colour is kept in full.
        let whole = matches!(kind, ViewKind::Segmented | ViewKind::Automap);
        encoder.set_sampling_factor(if whole { SamplingFactor::R_4_4_4 } else { SamplingFactor::R_4_2_0 });
        let (width, height) = (picture.width() as u16, picture.height() as u16);
        // Sizes were checked when the show began; a picture that cannot be coded is left out.
        if encoder.encode(picture.rgb(), width, height, ColorType::Rgb).is_err() {
            coded.truncate(before);
            continue;
        }
        list.push(json!({ "view": kind.caption(), "bytes": coded.len() - before }));
    }
    header["pictures"] = Value::Array(list);
    let header = header.to_string();
    let mut bytes = Vec::with_capacity(4 + header.len() + coded.len());
    bytes.extend((header.len() as u32).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(coded);
    bytes
}
