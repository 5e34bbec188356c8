//! Actions from Python: integers and numbers in arrays of any type, order and stride.

use crate::errors::INVALID_ACTION;
use hasard_envs::ActionSpace;
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

/// Anything that NumPy can make an array of, as a contiguous array of one type. Only changes that
/// keep every value are made.
fn contiguous<'py, T: numpy::Element>(
    given: &Bound<'py, PyAny>,
    kinds: &str,
    what: &str,
    name: &str,
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    static AS_ARRAY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    static CONTIGUOUS: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let py = given.py();
    if let Ok(ready) = given.cast::<PyArrayDyn<T>>()
        && ready.is_c_contiguous()
    {
        return Ok(ready.clone());
    }
    let function =
        |cell: &'static PyOnceLock<Py<PyAny>>, name: &str| -> PyResult<Bound<'py, PyAny>> {
            Ok(cell
                .get_or_try_init(py, || py.import("numpy")?.getattr(name).map(Bound::unbind))?
                .bind(py)
                .clone())
        };
    let array = match function(&AS_ARRAY, "asarray")?.call1((given,)) {
        Ok(array) => array,
        Err(error) if error.is_instance_of::<PyValueError>(py) => return Err(error),
        Err(error) => {
            return Err(PyTypeError::new_err(format!(
                "{name} cannot be made an array: {}",
                error.value(py)
            )));
        }
    };
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    if !kinds.contains(&kind) {
        let dtype = array.getattr("dtype")?;
        return Err(PyTypeError::new_err(format!("{name} must be {what}, got dtype {dtype}")));
    }
    // NumPy makes a row of a scalar where it is asked for contiguous memory.
    if array.getattr("ndim")?.extract::<usize>()? == 0 {
        return Err(PyTypeError::new_err(format!("{name} must be an array, got a scalar")));
    }
    let typed =
        function(&CONTIGUOUS, "ascontiguousarray")?.call1((array, numpy::dtype::<T>(py)))?;
    Ok(typed.cast_into::<PyArrayDyn<T>>()?)
}

/// Checks that an array has a row a lane and a column a part.
fn rows(shape: &[usize], lanes: usize, parts: usize, name: &str) -> PyResult<()> {
    if shape.is_empty() {
        return Err(PyTypeError::new_err(format!(
            "{name} must be an array of shape ({lanes}, {parts}), got a scalar"
        )));
    }
    if shape != [lanes, parts] {
        return Err(PyValueError::new_err(format!(
            "{name} must have shape ({lanes}, {parts}), got {shape:?}"
        )));
    }
    Ok(())
}

/// Writes categorical sub-actions of lanes, `[lanes, groups]`; `lane` gives the lane of a row for
/// messages, `None` where there is one alone.
pub fn read_actions(
    given: &Bound<'_, PyAny>,
    space: &ActionSpace,
    lanes: usize,
    lane: impl Fn(usize) -> Option<usize>,
    out: &mut [u8],
) -> PyResult<()> {
    let groups = space.groups.len();
    let array = contiguous::<i64>(given, "iub", "integers", "actions")?;
    rows(array.shape(), lanes, groups, "actions")?;
    let readable =
        array.try_readonly().map_err(|error| PyValueError::new_err(format!("actions: {error}")))?;
    let values = readable.as_slice()?;
    for (i, (&value, out)) in values.iter().zip(out).enumerate() {
        let most = space.groups[i % groups].buttons.len();
        if value < 0 || value > most as i64 {
            let (of, part) = (
                lane(i / groups).map_or_else(String::new, |lane| format!(" of lane {lane}")),
                i % groups,
            );
            return Err(INVALID_ACTION.error(
                given.py(),
                format!("action{of}: part {part} is {value}; it must be 0..={most}"),
            ));
        }
        *out = value as u8;
    }
    Ok(())
}

/// Writes continuous sub-actions of lanes, `[lanes, deltas]`; `None` is none at all.
pub fn read_deltas(
    given: Option<&Bound<'_, PyAny>>,
    space: &ActionSpace,
    lanes: usize,
    out: &mut [f32],
) -> PyResult<()> {
    let Some(given) = given else {
        out.fill(0.0);
        return Ok(());
    };
    let array = contiguous::<f32>(given, "fiub", "numbers", "deltas")?;
    rows(array.shape(), lanes, space.deltas.len(), "deltas")?;
    let readable =
        array.try_readonly().map_err(|error| PyValueError::new_err(format!("deltas: {error}")))?;
    out.copy_from_slice(readable.as_slice()?);
    Ok(())
}
