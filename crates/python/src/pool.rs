//! Memory of observations: NumPy arrays borrow it, and it comes back when the last of them is gone.

use numpy::ndarray::ArrayView;
use numpy::{Element, IxDyn, PyArray, PyArrayDyn};
use pyo3::prelude::*;
use std::sync::{Arc, Mutex};

/// Most buffers that wait to be used again: as many as a program that looks a few steps back keeps
/// in flight.
const MOST_SPARE: usize = 8;

/// Spare buffers of one size.
#[derive(Default)]
pub struct Pool {
    spare: Mutex<Vec<Vec<u8>>>,
}

impl Pool {
    /// A buffer of a length; its contents are whatever was in it last.
    pub fn take(&self, length: usize) -> Vec<u8> {
        let mut spare = self.spare.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        match spare.iter().position(|buffer| buffer.len() == length) {
            Some(index) => spare.swap_remove(index),
            None => vec![0; length],
        }
    }

    fn put(&self, buffer: Vec<u8>) {
        let mut spare = self.spare.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if spare.len() < MOST_SPARE {
            spare.push(buffer);
        }
    }
}

/// What keeps a buffer alive while NumPy arrays show it.
#[pyclass(frozen)]
struct Lease {
    buffer: Vec<u8>,
    pool: Arc<Pool>,
}

impl Drop for Lease {
    fn drop(&mut self) {
        self.pool.put(std::mem::take(&mut self.buffer));
    }
}

/// A writable array over a buffer of the pool; the buffer goes back when nothing refers to the
/// array any more.
pub fn pooled<'py>(
    py: Python<'py>,
    mut buffer: Vec<u8>,
    shape: &[usize],
    pool: &Arc<Pool>,
) -> PyResult<Bound<'py, PyArrayDyn<u8>>> {
    let start = buffer.as_mut_ptr();
    assert_eq!(buffer.len(), shape.iter().product::<usize>(), "a buffer as long as its shape");
    let lease = Bound::new(py, Lease { buffer, pool: Arc::clone(pool) })?;
    // SAFETY: the vector's heap memory stays where it is while the lease lives, nobody reaches it
    // but through the array, and the array's base object is the lease.
    Ok(unsafe {
        let view = ArrayView::from_shape_ptr(IxDyn(shape), start);
        PyArray::borrow_from_array(&view, lease.into_any())
    })
}

/// A fresh array of a shape that owns its memory.
pub fn array<'py, T: Element>(
    py: Python<'py>,
    values: Vec<T>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    let flat = PyArray::from_vec(py, values);
    if shape.len() == 1 {
        Ok(flat.into_any())
    } else {
        Ok(numpy::PyArrayMethods::reshape(&flat, shape)?.into_any())
    }
}
