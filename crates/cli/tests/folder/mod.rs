//! A folder in which the program runs.

#![allow(dead_code, reason = "each test uses some of it")]

use std::path::PathBuf;
use std::process::{Command, Output};

/// A folder that is gone after the test; commands run in it.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("hasard-cli-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    pub fn run(&self, line: &str) -> Output {
        self.run_with(line, &[])
    }

    /// The same with variables of the environment.
    pub fn run_with(&self, line: &str, variables: &[(&str, &str)]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_hasard"))
            .args(line.split_whitespace())
            .envs(variables.iter().copied())
            .current_dir(&self.0)
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .output()
            .unwrap()
    }

    /// Standard output of a command that must succeed.
    pub fn ok(&self, line: &str) -> String {
        self.both(line).0
    }

    /// Standard output and standard error of a command that must succeed.
    pub fn both(&self, line: &str) -> (String, String) {
        let output = self.run(line);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{line}: {error}");
        (String::from_utf8(output.stdout).unwrap(), error)
    }

    /// The one line of a command that must be refused.
    pub fn refused(&self, line: &str) -> String {
        let output = self.run(line);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {error}");
        assert_eq!(error.lines().count(), 1, "{line}: {error}");
        assert!(error.starts_with("hasard: ") && !error.contains("panicked"), "{line}: {error}");
        error
    }

    /// Puts a text in the place of another in a file, which has it.
    pub fn replace(&self, name: &str, from: &str, to: &str) {
        let text = String::from_utf8(self.read(name)).unwrap();
        assert!(text.contains(from));
        self.file(name, text.replace(from, to).as_bytes());
    }

    pub fn file(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.0.join(name), bytes).unwrap();
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.0.join(name)).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
