//! Files that are written whole or not at all.

use crate::MediaError;
use std::collections::BTreeSet;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Temporary names of all files in the making.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every file in the making, and lets none be finished or begun from here on: for a process
/// that ends by a signal, which drops nothing.
pub fn remove_unfinished() {
    let names = unfinished();
    for name in names.iter() {
        let _ = std::fs::remove_file(name).or_else(|_| std::fs::remove_dir_all(name));
    }
    std::mem::forget(names);
}

/// A file or folder that is removed when this is dropped, or when the process ends by a signal.
pub struct Scratch(PathBuf);

impl Scratch {
    /// Takes care of a path at which nothing is yet.
    #[must_use]
    pub fn new(path: PathBuf) -> Scratch {
        unfinished().insert(path.clone());
        Scratch(path)
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0).or_else(|_| std::fs::remove_dir_all(&self.0));
        unfinished().remove(&self.0);
    }
}

/// A file in the making: it carries a temporary name until [`WholeFile::finish`] renames it, so
/// that nobody ever reads half of it and a failed write leaves the former file as it was. Dropped
/// unfinished, it is removed.
pub struct WholeFile {
    path: PathBuf,
    temporary: PathBuf,
    out: Option<BufWriter<std::fs::File>>,
}

impl WholeFile {
    /// Begins the file, making its folder if need be.
    ///
    /// # Errors
    /// When the folder or the temporary file cannot be made.
    pub fn create(path: &Path) -> Result<WholeFile, MediaError> {
        let Some(name) = path.file_name() else {
            return Err(MediaError::format(
                path,
                "is not the name of a file; give one, such as out.png",
            ));
        };
        let kind = std::fs::metadata(path);
        if kind.as_ref().is_ok_and(std::fs::Metadata::is_dir) {
            return Err(MediaError::format(path, "is a folder; name a file in it"));
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder {
            std::fs::create_dir_all(folder)
                .map_err(|e| MediaError::io(folder, "make this folder", e))?;
        }
        let mut temporary_name = std::ffi::OsString::from(".");
        temporary_name.push(name);
        temporary_name.push(format!(".{}.tmp", std::process::id()));
        // What is there but no file (/dev/null, a pipe) is written to and stays: a rename would put
        // a file in its place.
        let device = kind.is_ok_and(|kind| !kind.is_file());
        let temporary = if device { path.to_owned() } else { path.with_file_name(temporary_name) };
        let mut names = unfinished();
        let file =
            std::fs::File::create(&temporary).map_err(|e| MediaError::io(path, "write", e))?;
        if !device {
            names.insert(temporary.clone());
        }
        drop(names);
        Ok(WholeFile {
            path: path.to_owned(),
            temporary,
            out: Some(BufWriter::with_capacity(1 << 16, file)),
        })
    }

    /// How many bytes it has so far.
    ///
    /// # Errors
    /// When they cannot be written.
    pub fn written(&mut self) -> Result<u64, MediaError> {
        let count = self.flush().and_then(|()| std::fs::metadata(&self.temporary));
        count.map(|data| data.len()).map_err(|e| MediaError::io(&self.path, "write", e))
    }

    /// Puts the file in its place.
    ///
    /// # Errors
    /// When the last bytes cannot be written (a full disk) or the file cannot be renamed.
    pub fn finish(mut self) -> Result<(), MediaError> {
        let out = self.out.take().expect("a file is finished once");
        let result = out
            .into_inner()
            .map_err(std::io::IntoInnerError::into_error)
            .and_then(|file| if self.is_device() { Ok(()) } else { file.sync_all() })
            .and_then(|()| {
                if self.is_device() { Ok(()) } else { std::fs::rename(&self.temporary, &self.path) }
            });
        if result.is_err() && !self.is_device() {
            let _ = std::fs::remove_file(&self.temporary);
        }
        unfinished().remove(&self.temporary);
        result.map_err(|e| MediaError::io(&self.path, "write", e))
    }

    fn is_device(&self) -> bool {
        self.temporary == self.path
    }

    /// The name that the file will have.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.out.as_mut().expect("writes end with finish").write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.out.as_mut().expect("writes end with finish").flush()
    }
}

impl std::io::Seek for WholeFile {
    fn seek(&mut self, to: std::io::SeekFrom) -> std::io::Result<u64> {
        self.out.as_mut().expect("writes end with finish").seek(to)
    }
}

impl Drop for WholeFile {
    fn drop(&mut self) {
        if self.out.take().is_some() && !self.is_device() {
            let _ = std::fs::remove_file(&self.temporary);
            unfinished().remove(&self.temporary);
        }
    }
}

/// Writes a whole file, or leaves what was there.
///
/// # Errors
/// When it cannot be written.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), MediaError> {
    let mut file = WholeFile::create(path)?;
    file.write_all(bytes).map_err(|e| MediaError::io(path, "write", e))?;
    file.finish()
}

/// What is wrong with a special file, and what to do.
pub const NO_FILE: &str = "is a pipe or a device; name a regular file";

/// Whether it is neither a file nor a folder, but a pipe, a device or a socket: opening one may
/// wait for ever, and its length says nothing of what comes out of it.
#[must_use]
pub fn is_special(kind: &std::fs::Metadata) -> bool {
    !kind.is_file() && !kind.is_dir()
}

/// What lies at a path, if anything does.
///
/// # Errors
/// When the system does not say, as below a folder that is closed to us: unlike `exists`, this takes
/// no such thing for one that is not there.
pub fn what_lies_at(path: &Path) -> Result<Option<std::fs::Metadata>, MediaError> {
    use std::io::ErrorKind::{InvalidFilename, NotADirectory, NotFound};
    match std::fs::metadata(path) {
        Ok(kind) => Ok(Some(kind)),
        // Below a file nothing lies, nor under a name that no file system takes.
        Err(e) if matches!(e.kind(), NotFound | NotADirectory | InvalidFilename) => Ok(None),
        Err(e) => Err(MediaError::io(path, "read", e)),
    }
}

/// Opens a regular file. A pipe in its place would be waited for, and with it whatever is locked
/// meanwhile.
///
/// # Errors
/// When it cannot be opened, or is no regular file.
pub fn open_regular(path: &Path) -> std::io::Result<std::fs::File> {
    if std::fs::metadata(path)?.is_file() {
        std::fs::File::open(path)
    } else {
        Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, NO_FILE))
    }
}

/// Whether another process has a lock on a regular file.
#[must_use]
pub fn is_locked(path: &Path) -> bool {
    // Shared, and let go at once: a process that locks it this very moment is hardly ever in its way.
    open_regular(path)
        .is_ok_and(|file| matches!(file.try_lock_shared(), Err(std::fs::TryLockError::WouldBlock)))
}

/// Reads a file that must not be larger than `limit` bytes, so that a wrong name cannot fill the
/// memory.
///
/// # Errors
/// When it cannot be read or is larger.
pub fn read_limited(path: &Path, limit: u64) -> Result<Vec<u8>, MediaError> {
    use std::io::Read;
    let kind = std::fs::metadata(path).map_err(|e| MediaError::io(path, "read", e))?;
    if kind.is_dir() {
        return Err(MediaError::format(path, "is a folder; name a file"));
    }
    if is_special(&kind) {
        return Err(MediaError::format(path, NO_FILE));
    }
    let file = std::fs::File::open(path).map_err(|e| MediaError::io(path, "read", e))?;
    let mut bytes = Vec::new();
    file.take(limit + 1).read_to_end(&mut bytes).map_err(|e| MediaError::io(path, "read", e))?;
    if bytes.len() as u64 > limit {
        return Err(MediaError::format(
            path,
            format!("is larger than {limit} bytes; is it the right file?"),
        ));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unfinished_file_leaves_the_former_one() {
        let folder = std::env::temp_dir().join(format!("hasard-files-{}", std::process::id()));
        let path = folder.join("deep").join("a.txt");
        write_whole(&path, b"first").unwrap();
        let mut second = WholeFile::create(&path).unwrap();
        second.write_all(b"half").unwrap();
        drop(second);
        assert_eq!(read_limited(&path, 100).unwrap(), b"first");
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
        assert!(read_limited(&path, 4).unwrap_err().to_string().contains("larger than 4 bytes"));
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_written_to_and_not_replaced() {
        use std::os::unix::fs::FileTypeExt;
        write_whole(Path::new("/dev/null"), b"gone").unwrap();
        assert!(std::fs::metadata("/dev/null").unwrap().file_type().is_char_device());
        let error = write_whole(Path::new("/dev/full"), b"x").unwrap_err().to_string();
        assert!(error.contains("/dev/full: cannot write"), "{error}");
        assert!(Path::new("/dev/full").exists());
        let error = write_whole(&std::env::temp_dir(), b"x").unwrap_err().to_string();
        assert!(error.contains("is a folder; name a file in it"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_regular_file_is_not_read() {
        for path in ["/dev/zero", "/dev/null"] {
            let error = read_limited(Path::new(path), 10).unwrap_err().to_string();
            assert_eq!(error, format!("{path}: {NO_FILE}"));
        }
    }

    /// A link to itself: the system says to nobody what lies there.
    #[cfg(unix)]
    #[test]
    fn what_the_system_does_not_say_is_not_taken_for_absent() {
        let folder = std::env::temp_dir().join(format!("hasard-lies-{}", std::process::id()));
        write_whole(&folder.join("file"), b"").unwrap();
        std::os::unix::fs::symlink("circle", folder.join("circle")).unwrap();
        assert!(what_lies_at(&folder).unwrap().unwrap().is_dir());
        for absent in ["none", "file/below", &"a".repeat(300)] {
            assert!(what_lies_at(&folder.join(absent)).unwrap().is_none(), "{absent}");
        }
        let error = what_lies_at(&folder.join("circle")).unwrap_err().to_string();
        assert!(error.contains("circle: cannot read: "), "{error}");
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_folder_in_the_way_is_named() {
        let error = write_whole(Path::new("/dev/null/x/y.png"), b"").unwrap_err().to_string();
        assert!(error.contains("/dev/null/x"), "{error}");
    }
}
