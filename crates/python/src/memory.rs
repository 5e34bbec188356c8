//! Arrays of the caller's that batches are written into.

use numpy::{
    Element, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyBufferError;
use pyo3::prelude::*;
use std::ops::Range;

/// The memory of an array, kept alive by a reference to it.
///
/// Python code may look at the array while the worlds write to it, as with every array that
/// native code writes to; what it then sees is undefined, as `bind` says. No Rust code reads it
/// meanwhile.
pub struct External<T> {
    start: *mut T,
    length: usize,
    _array: Py<PyAny>,
}

// SAFETY: the memory belongs to the array, which lives as long as this value, and does not depend
// on a thread.
unsafe impl<T: Send> Send for External<T> {}
// SAFETY: as above; shared references only read.
unsafe impl<T: Sync> Sync for External<T> {}

impl<T> AsRef<[T]> for External<T> {
    fn as_ref(&self) -> &[T] {
        // SAFETY: `bound` has made sure of the length, the alignment and that the values are
        // contiguous.
        unsafe { std::slice::from_raw_parts(self.start, self.length) }
    }
}

impl<T> AsMut<[T]> for External<T> {
    fn as_mut(&mut self) -> &mut [T] {
        // SAFETY: as above; the array is writable, and this value alone writes to it.
        unsafe { std::slice::from_raw_parts_mut(self.start, self.length) }
    }
}

impl<T> External<T> {
    /// The addresses that it takes.
    pub fn place(&self) -> Range<usize> {
        let start = self.start.addr();
        start..start + self.length * size_of::<T>()
    }
}

/// Refuses arrays that share memory: each is written as though nothing else were there.
pub fn apart(places: &[(&str, Range<usize>)]) -> PyResult<()> {
    for (index, (name, place)) in places.iter().enumerate() {
        let shares = |(_, other): &&(&str, Range<usize>)| {
            place.start.max(other.start) < place.end.min(other.end)
        };
        if let Some((other, _)) = places[..index].iter().find(shares) {
            return Err(PyBufferError::new_err(format!(
                "{other} and {name} share memory; give each an array of its own"
            )));
        }
    }
    Ok(())
}

/// The memory of an array that has exactly this type and shape, is contiguous in C order, aligned
/// and writable.
pub fn bound<T: Element>(
    name: &str,
    array: &Bound<'_, PyAny>,
    shape: &[usize],
) -> PyResult<External<T>> {
    let py = array.py();
    let wanted = numpy::dtype::<T>(py);
    let wrong = |given: String| {
        let shape = shape.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        PyBufferError::new_err(format!(
            "{name} must be a writable C-contiguous array of dtype {wanted} and shape [{shape}]; it is {given}"
        ))
    };
    let Ok(untyped) = array.cast::<PyUntypedArray>() else {
        return Err(wrong(format!("a {}", array.get_type().name()?)));
    };
    let flags = array.getattr("flags")?;
    let (writable, aligned): (bool, bool) =
        (flags.getattr("writeable")?.extract()?, flags.getattr("aligned")?.extract()?);
    let fits = untyped.dtype().is_equiv_to(&wanted)
        && untyped.shape() == shape
        && untyped.is_c_contiguous();
    if !(fits && writable && aligned) {
        let kind = if writable { "writable" } else { "read-only" };
        let (shape, strides) = (untyped.shape(), untyped.strides());
        return Err(wrong(format!(
            "a {kind} array of dtype {}, shape {shape:?} and strides {strides:?} bytes",
            untyped.dtype()
        )));
    }
    let typed = array.cast::<PyArrayDyn<T>>()?;
    Ok(External {
        start: typed.data(),
        length: shape.iter().product(),
        _array: array.clone().unbind(),
    })
}
