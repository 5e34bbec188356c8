//! Bounds on what a file can make the loader do.

use super::IwadError;

/// Largest width and height of a picture.
pub(super) const SIDE_LIMIT: usize = 4096;

/// What is left of the memory and work that a file may take. Freedoom's larger set needs a tenth of
/// either.
pub(super) struct Budget {
    pixels: u64,
    work: u64,
}

impl Budget {
    pub fn new() -> Budget {
        Budget { pixels: 1 << 27, work: 1 << 29 }
    }

    /// Takes the memory of a picture with its mask.
    pub fn keep(&mut self, pixels: usize) -> Result<(), IwadError> {
        spend(&mut self.pixels, pixels)
    }

    /// Takes the time of visiting so many pixels.
    pub fn visit(&mut self, pixels: usize) -> Result<(), IwadError> {
        spend(&mut self.work, pixels)
    }
}

fn spend(left: &mut u64, pixels: usize) -> Result<(), IwadError> {
    *left = left.checked_sub(pixels as u64).ok_or(IwadError::TooLarge)?;
    Ok(())
}
