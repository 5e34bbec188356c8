//! What happened in a step, as a structured array.

use crate::pool::array;
use hasard_engine::world::{ActorKind, DamageKind};
use hasard_envs::{DAMAGE_CAUSES, Happening, HappeningKind};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyDict};

/// The fields of a row, in NumPy's words; the rows are packed.
const FIELDS: [(&str, &str); 9] = [
    ("tic", "<u4"),
    ("kind", "<i2"),
    ("what", "<i2"),
    ("by", "<i2"),
    ("player", "<i2"),
    ("cause", "<i2"),
    ("x", "<f4"),
    ("y", "<f4"),
    ("amount", "<f4"),
];

/// NumPy's type of a row.
fn row_type(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    static TYPE: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let made = TYPE.get_or_try_init(py, || {
        let fields: Vec<(&str, &str)> = FIELDS.to_vec();
        let made = py.import("numpy")?.call_method1("dtype", (fields,))?;
        Ok::<_, PyErr>(made.unbind())
    })?;
    Ok(made.bind(py).clone())
}

/// Rows of a batch's events, and where each lane's begin and the last one's end.
pub fn arrays(py: Python<'_>, batch: &hasard_envs::Batch) -> PyResult<[Py<PyAny>; 2]> {
    let mut bytes = Vec::with_capacity(batch.happenings.len() * 26);
    for one in &batch.happenings {
        row(one, &mut bytes);
    }
    let numpy = py.import("numpy")?;
    let rows = match bytes.len() {
        0 => numpy.call_method1("empty", (0, row_type(py)?))?,
        _ => numpy.call_method1("frombuffer", (PyBytes::new(py, &bytes), row_type(py)?))?,
    };
    let offsets: Vec<i64> = batch.happening_offsets.iter().map(|&offset| offset as i64).collect();
    let count = offsets.len();
    Ok([rows.unbind(), array(py, offsets, &[count])?.unbind()])
}

fn row(one: &Happening, bytes: &mut Vec<u8>) {
    let numbers = [
        one.kind as i16,
        one.what as i16,
        one.by.map_or(-1, |kind| kind as i16),
        one.player.map_or(-1, i16::from),
        one.cause.map_or(-1, |cause| cause as i16),
    ];
    bytes.extend(one.tic.to_le_bytes());
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    let amounts = [one.place[0], one.place[1], one.amount];
    bytes.extend(amounts.iter().flat_map(|amount| amount.to_le_bytes()));
}

/// event_names() -> dict[str, dict[str, int]]
///
/// Returns the numbers of the kinds, things and causes of events, by name.
#[pyfunction]
pub fn event_names(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let dict = |names: Vec<(String, i16)>| -> PyResult<Bound<'_, PyDict>> {
        let dict = PyDict::new(py);
        names.iter().try_for_each(|(name, number)| dict.set_item(name, number))?;
        Ok(dict)
    };
    let kinds = HappeningKind::NAMES.iter().zip(0..).map(|(name, i)| (name.to_string(), i));
    let causes = DAMAGE_CAUSES.iter().zip(DamageKind::Sector as i16..);
    let things = ActorKind::all().map(|kind| (format!("{kind:?}"), kind as i16));
    let names = PyDict::new(py);
    names.set_item("kinds", dict(kinds.collect())?)?;
    names.set_item("things", dict(things.collect())?)?;
    names.set_item("causes", dict(causes.map(|(name, i)| (name.to_string(), i)).collect())?)?;
    Ok(names)
}
