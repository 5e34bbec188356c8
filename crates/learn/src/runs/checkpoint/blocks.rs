//! Named blocks of numbers, as safetensors hold them.

use crate::error::LearnError;
use safetensors::tensor::{Dtype, TensorView, View, serialize};
use std::borrow::Cow;

/// A named block of numbers.
pub(super) struct Block {
    pub(super) kind: Dtype,
    pub(super) shape: Vec<usize>,
    pub(super) bytes: Vec<u8>,
}

impl View for &Block {
    fn dtype(&self) -> Dtype {
        self.kind
    }

    fn shape(&self) -> &[usize] {
        &self.shape
    }

    fn data(&self) -> Cow<'_, [u8]> {
        Cow::Borrowed(&self.bytes)
    }

    fn data_len(&self) -> usize {
        self.bytes.len()
    }
}

/// Refuses a block of another kind or number of values.
pub(super) fn check_block(
    view: &TensorView<'_>,
    kind: Dtype,
    length: usize,
    name: &str,
) -> Result<(), String> {
    let count = 8 * view.data().len() / kind.bitsize();
    if view.dtype() != kind || count != length {
        return Err(format!("'{name}' has {count} values of {:?}, not {length}", view.dtype()));
    }
    Ok(())
}

macro_rules! block {
    ($name:ident, $parse:ident, $type:ty, $kind:ident) => {
        pub(super) fn $name(values: &[$type], shape: Vec<usize>) -> Block {
            Block {
                kind: Dtype::$kind,
                shape,
                bytes: values.iter().flat_map(|value| value.to_le_bytes()).collect(),
            }
        }

        pub(super) fn $parse(
            view: &TensorView<'_>,
            length: usize,
            name: &str,
        ) -> Result<Vec<$type>, String> {
            check_block(view, Dtype::$kind, length, name)?;
            let (chunks, _) = view.data().as_chunks::<{ size_of::<$type>() }>();
            Ok(chunks.iter().map(|bytes| <$type>::from_le_bytes(*bytes)).collect())
        }
    };
}

block!(floats, parse_floats, f32, F32);
block!(doubles, parse_doubles, f64, F64);
block!(words, parse_words, u64, U64);

pub(super) fn serialise(blocks: &[(String, Block)]) -> Result<Vec<u8>, LearnError> {
    serialize(blocks.iter().map(|(name, block)| (name.as_str(), block)), None).map_err(|error| {
        LearnError::Config(format!("weights cannot be written as safetensors: {error}"))
    })
}
