//! The window of `hasard play` on a screen in memory (Xvfb), where there is one.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Ends a program with the test.
struct Ended(Child);

impl Drop for Ended {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The picture filled 640x480 of a window of 1148x916 until somebody changed its size, wherever the
/// desktop did not do so at once.
#[test]
fn the_picture_fills_the_window_and_the_window_the_screen() {
    let screen = Command::new("Xvfb")
        .args(["-displayfd", "1", "-screen", "0", "1280x800x24"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn();
    let grabs = Command::new("import").arg("-version").output().is_ok();
    let (Ok(mut screen), true) = (screen, grabs) else {
        // Past the capture of the test runner: ./check counts it.
        let _ = writeln!(
            std::io::stderr(),
            "skipped: no Xvfb or no import here (apt-get install xvfb imagemagick)"
        );
        return;
    };
    let mut number = String::new();
    BufReader::new(screen.stdout.take().unwrap()).read_line(&mut number).unwrap();
    let _screen = Ended(screen);
    let display = format!(":{}", number.trim());
    let _game = Ended(
        Command::new(env!("CARGO_BIN_EXE_hasard"))
            .args(["play", "RemedyRushLevel1-v0"])
            .current_dir(std::env::temp_dir())
            .env("DISPLAY", &display)
            .env_remove("WAYLAND_DISPLAY")
            .spawn()
            .unwrap(),
    );
    // Most of the screen, 4:3 and below it the panel: more than the picture of 640x480 was.
    let begun = Instant::now();
    let mut filled = 0;
    while filled < 1280 * 800 / 2 && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(300));
        let grabbed = Command::new("import")
            .args(["-display", &display, "-window", "root", "-depth", "8", "rgb:-"])
            .output()
            .unwrap();
        filled = grabbed.stdout.chunks_exact(3).filter(|pixel| **pixel != [0; 3]).count();
    }
    assert!(filled >= 1280 * 800 / 2, "{filled} pixels of the screen show something");
}
