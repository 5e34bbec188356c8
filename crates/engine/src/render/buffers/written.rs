//! Whether the buffers beside the colours are written, as types: what is compiled for a frame
//! without them has no branch and no store for them.

/// Whether depth is written.
pub(crate) trait DepthBuffer {
    /// Whether it is.
    const WRITTEN: bool;
}

/// Depth is written.
pub(crate) struct WithDepth;

/// Depth is not written.
pub(crate) struct NoDepth;

impl DepthBuffer for WithDepth {
    const WRITTEN: bool = true;
}

impl DepthBuffer for NoDepth {
    const WRITTEN: bool = false;
}

/// Whether each pixel's class is written: what kind of thing it shows.
pub(crate) trait ClassBuffer {
    /// Whether it is.
    const WRITTEN: bool;
}

/// Classes are written.
pub(crate) struct WithClass;

/// Classes are not written.
pub(crate) struct NoClass;

impl ClassBuffer for WithClass {
    const WRITTEN: bool = true;
}

impl ClassBuffer for NoClass {
    const WRITTEN: bool = false;
}
