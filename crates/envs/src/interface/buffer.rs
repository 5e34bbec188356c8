//! Memory of a batch's outputs: the batch's own, or external memory of the caller's.

use std::fmt;
use std::ops::{Deref, DerefMut};

/// External memory, owned by the caller: anything that is a slice of `T`, stays where it is and may
/// go to another thread, such as a `Box<[T]>`, a mapped file, a page-locked buffer or another
/// library's array.
///
/// It must show the same slice each time it is asked.
pub trait Memory<T>: AsRef<[T]> + AsMut<[T]> + Send + Sync {}

impl<T, M: AsRef<[T]> + AsMut<[T]> + Send + Sync> Memory<T> for M {}

/// A slice that a batch writes to. It owns a vector, unless the caller gives it external memory by
/// [`Buffer::external`]: then the worlds write there and nothing is copied.
///
/// ```
/// use hasard_envs::{Buffer, EnvOptions, VecEnv, VecOptions};
/// let mut worlds = VecEnv::new("RemedyRushLevel1-v0", &EnvOptions::default(), VecOptions::default())?;
/// let mut batch = worlds.whole_batch();
/// let mine: Box<[u8]> = vec![0; batch.observations.len()].into();
/// batch.observations = Buffer::external(mine);
/// worlds.reset(&mut batch)?;
/// assert!(batch.observations.iter().any(|byte| *byte > 0));
/// # Ok::<(), hasard_envs::EnvError>(())
/// ```
pub struct Buffer<T>(Kind<T>);

enum Kind<T> {
    Owned(Vec<T>),
    External(Box<dyn Memory<T>>),
}

impl<T> Buffer<T> {
    /// A buffer over external memory, which it keeps for as long as it lives.
    pub fn external(memory: impl Memory<T> + 'static) -> Buffer<T> {
        Buffer(Kind::External(Box::new(memory)))
    }

    /// Whether the memory is external.
    #[must_use]
    pub const fn is_external(&self) -> bool {
        matches!(self.0, Kind::External(_))
    }
}

impl<T: Clone> Buffer<T> {
    /// The buffer's own vector; external memory is copied into one first, and then let go.
    pub fn to_mut(&mut self) -> &mut Vec<T> {
        if let Kind::External(memory) = &self.0 {
            self.0 = Kind::Owned((**memory).as_ref().to_vec());
        }
        match &mut self.0 {
            Kind::Owned(own) => own,
            Kind::External(_) => unreachable!("external memory has just been replaced"),
        }
    }

    /// The contents as a vector; only external memory is copied.
    #[must_use]
    pub fn into_vec(mut self) -> Vec<T> {
        std::mem::take(self.to_mut())
    }
}

impl<T> From<Vec<T>> for Buffer<T> {
    fn from(own: Vec<T>) -> Buffer<T> {
        Buffer(Kind::Owned(own))
    }
}

impl<T> Default for Buffer<T> {
    fn default() -> Buffer<T> {
        Vec::new().into()
    }
}

impl<T> Deref for Buffer<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        match &self.0 {
            Kind::Owned(own) => own,
            Kind::External(memory) => (**memory).as_ref(),
        }
    }
}

impl<T> DerefMut for Buffer<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        match &mut self.0 {
            Kind::Owned(own) => own,
            Kind::External(memory) => (**memory).as_mut(),
        }
    }
}

/// A copy owns its memory.
impl<T: Clone> Clone for Buffer<T> {
    fn clone(&self) -> Buffer<T> {
        self.to_vec().into()
    }
}

impl<T: fmt::Debug> fmt::Debug for Buffer<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

impl<T: PartialEq> PartialEq for Buffer<T> {
    fn eq(&self, other: &Buffer<T>) -> bool {
        **self == **other
    }
}

impl<'a, T> IntoIterator for &'a Buffer<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}
