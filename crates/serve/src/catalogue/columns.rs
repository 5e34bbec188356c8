//! The numbers of a `metrics.jsonl`, a column a name.

use hasard_media::files::open_regular;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Points of a curve that are sent: more than a chart has pixels.
const POINTS: usize = 800;
/// A column that not one row in so many has is sent with rows of its own, so that thinning leaves
/// none of it out.
const SPARSE: usize = 2;
/// Bytes that are read at a time: what is beyond is read when it is asked for next.
const LARGEST_READ: u64 = 64 << 20;
/// Bytes that are compared: more than a row, which holds the time and so is like no other.
const SEAM: usize = 4096;

/// Columns as far as the file was read.
#[derive(Default)]
pub(crate) struct Columns {
    read: u64,
    /// The last bytes that were read: another file in the place of this one has others there.
    seam: Vec<u8>,
    frames: Vec<f64>,
    values: BTreeMap<String, Vec<f32>>,
}

impl Columns {
    /// Reads what was added to the file. A file that is no longer the one that was read (a resumed
    /// run takes rows back, another run takes its place) is read anew; of one that is gone nothing
    /// is left.
    pub fn catch_up(&mut self, path: &Path) -> std::io::Result<()> {
        let opened = open_regular(path);
        if !opened.as_ref().is_ok_and(|file| self.continues(file).unwrap_or(false)) {
            *self = Columns::default();
        }
        let mut file = opened?;
        file.seek(SeekFrom::Start(self.read))?;
        let mut bytes = Vec::new();
        file.take(LARGEST_READ).read_to_end(&mut bytes)?;
        // The last line may be half written.
        let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        for line in bytes[..whole].split(|byte| *byte == b'\n') {
            if let Ok(row) = serde_json::from_slice(line) {
                self.add(&row);
            }
        }
        self.read += whole as u64;
        self.seam.extend_from_slice(&bytes[whole.saturating_sub(SEAM)..whole]);
        self.seam.drain(..self.seam.len().saturating_sub(SEAM));
        Ok(())
    }

    /// Whether a file goes on where this was left off.
    fn continues(&self, mut file: &File) -> std::io::Result<bool> {
        let mut there = vec![0; self.seam.len()];
        file.seek(SeekFrom::Start(self.read - self.seam.len() as u64))?;
        Ok(file.read_exact(&mut there).is_ok() && there == self.seam)
    }

    fn add(&mut self, row: &Map<String, Value>) {
        let Some(frames) = row.get("frames").and_then(Value::as_f64) else { return };
        let rows = self.frames.len();
        self.frames.push(frames);
        let mut put = |name: String, value: f64| {
            let column = self.values.entry(name).or_default();
            column.resize(rows, f32::NAN);
            column.push(value as f32);
        };
        for (name, value) in row.iter().filter(|(name, _)| *name != "frames") {
            match value {
                Value::Number(number) => {
                    number.as_f64().into_iter().for_each(|value| put(name.clone(), value))
                }
                // One number a constraint.
                Value::Array(all) => all
                    .iter()
                    .enumerate()
                    .filter_map(|(at, value)| Some((at, value.as_f64()?)))
                    .for_each(|(at, value)| put(format!("{name}.{at}"), value)),
                _ => {}
            }
        }
    }

    /// Names of the columns.
    pub fn names(&self) -> Vec<String> {
        self.values.keys().cloned().collect()
    }

    /// Some columns with no more points than a chart can show: `frames` and `wall_s` of the rows
    /// that are shown, and a list of values for each name. A column that only few rows have, such
    /// as those of evaluations, has rows of its own: then its entry is an object of `frames`,
    /// `wall_s` and `values`.
    pub fn thinned(&self, names: &[String]) -> Value {
        let every = self.frames.len().div_ceil(POINTS).max(1);
        // The last row is always there: it is where a running curve moves.
        let mut rows: Vec<usize> = (0..self.frames.len()).rev().step_by(every).collect();
        rows.reverse();
        let mut all = Map::new();
        all.insert("frames".into(), rows.iter().map(|row| json!(self.frames[*row])).collect());
        for name in names.iter().map(String::as_str).chain(["wall_s"]) {
            let Some(column) = self.values.get(name) else { continue };
            let finite = |row: usize| column.get(row).is_some_and(|value| value.is_finite());
            let own: Vec<usize> = (0..column.len()).filter(|row| finite(*row)).collect();
            let values = if own.len() * SPARSE < self.frames.len() && own.len() <= POINTS {
                json!({
                    "frames": own.iter().map(|row| self.frames[*row]).collect::<Vec<_>>(),
                    "wall_s": self.picked("wall_s", &own),
                    "values": self.picked(name, &own),
                })
            } else {
                self.picked(name, &rows)
            };
            all.insert(name.to_owned(), values);
        }
        Value::Object(all)
    }

    /// A column's values in some rows; `null` where a row has none.
    fn picked(&self, name: &str, rows: &[usize]) -> Value {
        let column = self.values.get(name);
        let value = |row: &usize| {
            json!(column.and_then(|column| column.get(*row)).filter(|value| value.is_finite()))
        };
        rows.iter().map(value).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn rows_are_read_from_where_they_were_left_off() {
        let path =
            std::env::temp_dir().join(format!("hasard-serve-columns-{}", std::process::id()));
        std::fs::write(&path, "{\"frames\":1,\"cost_mean\":null,\"fps\":5}\n{\"frames\":2,\"cost_mean\":3.5,\"fps\":6}\n{\"fra")
            .unwrap();
        let mut columns = Columns::default();
        columns.catch_up(&path).unwrap();
        assert_eq!(
            columns.thinned(&["cost_mean".into(), "none".into()]),
            json!({"frames": [1.0, 2.0], "cost_mean": [null, 3.5]})
        );
        std::fs::OpenOptions::new()
            .append(true)
            .open(&path)
            .unwrap()
            .write_all(b"mes\":9,\"cost_mean\":1}\nrubbish\n")
            .unwrap();
        columns.catch_up(&path).unwrap();
        assert_eq!(
            columns.thinned(&["cost_mean".into(), "fps".into()])["fps"],
            json!([5.0, 6.0, null])
        );
        assert_eq!(columns.frames, [1.0, 2.0, 9.0]);
        // The run was resumed from before: its later rows are gone.
        std::fs::write(&path, "{\"frames\":1,\"fps\":7}\n").unwrap();
        columns.catch_up(&path).unwrap();
        assert_eq!((&columns.frames, columns.values["fps"].as_slice()), (&vec![1.0], &[7.0][..]));
        // Another run took its place, and is longer.
        std::fs::write(&path, "{\"frames\":4,\"fps\":7}\n{\"frames\":5,\"fps\":8}\n").unwrap();
        columns.catch_up(&path).unwrap();
        assert_eq!(columns.frames, [4.0, 5.0]);
        std::fs::rename(&path, path.with_extension("gone")).unwrap();
        assert!(columns.catch_up(&path).is_err() && columns.frames.is_empty());
        std::fs::rename(path.with_extension("gone"), &path).unwrap();
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn long_curves_are_thinned_and_keep_their_end() {
        let mut columns = Columns::default();
        for k in 0..5000 {
            columns.add(json!({"frames": k, "fps": k}).as_object().unwrap());
        }
        let curve = columns.thinned(&["fps".into()]);
        let fps = curve["fps"].as_array().unwrap();
        assert!(fps.len() <= POINTS && fps.last() == Some(&json!(4999.0)));
    }

    #[test]
    fn what_few_rows_have_is_sent_whole() {
        let mut columns = Columns::default();
        for k in 0..5000 {
            let mut row = json!({"frames": k, "wall_s": k * 2, "multipliers": [k, 2 * k]});
            // No evaluation falls on a row that thinning would keep.
            if k % 1000 == 123 {
                row["eval/cost_mean"] = json!(k + 1);
            }
            columns.add(row.as_object().unwrap());
        }
        let sent = columns.thinned(&["eval/cost_mean".into(), "multipliers.1".into()]);
        let evaluations = json!({"frames": [123.0, 1123.0, 2123.0, 3123.0, 4123.0], "wall_s": [246.0, 2246.0, 4246.0, 6246.0, 8246.0],
            "values": [124.0, 1124.0, 2124.0, 3124.0, 4124.0]});
        assert_eq!(sent["eval/cost_mean"], evaluations);
        assert_eq!(sent["multipliers.1"].as_array().unwrap().last(), Some(&json!(9998.0)));
        assert_eq!(
            sent["wall_s"].as_array().unwrap().len(),
            sent["frames"].as_array().unwrap().len()
        );
    }
}
