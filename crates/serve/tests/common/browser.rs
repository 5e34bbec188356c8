//! A Chromium steered over WebDriver, by as little of the protocol as the tests need.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A browser window; closed when dropped.
pub struct Browser {
    driver: Child,
    port: u16,
    session: String,
}

/// A driver and its port, which it picks: one picked here could be another test's by the time it
/// starts. `None` if it ends before it says one.
fn start_driver() -> Option<(Child, u16)> {
    let mut driver = Command::new("chromedriver")
        .arg("--port=0")
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let said = BufReader::new(driver.stdout.take().unwrap());
    let (send, port) = std::sync::mpsc::channel();
    // Read to its end, so that the driver does not wait for a reader, nor find none.
    std::thread::spawn(move || {
        for line in said.lines().map_while(Result::ok) {
            let port = line.split("successfully on port ").nth(1);
            if let Some(Ok(port)) = port.map(|port| port.trim_end_matches('.').parse()) {
                let _ = send.send(port);
            }
        }
    });
    let Ok(port) = port.recv_timeout(Duration::from_secs(30)) else {
        let _ = driver.kill();
        let _ = driver.wait();
        return None;
    };
    Some((driver, port))
}

impl Browser {
    /// Opens a window, or says why there is none.
    pub fn open(width: u32, height: u32, dark: bool) -> Option<Browser> {
        if Command::new("chromedriver").arg("--version").stdout(Stdio::null()).status().is_err() {
            // Past the capture of the test runner: ./check counts it.
            let _ = writeln!(
                std::io::stderr(),
                "skipped: no chromedriver on this machine (apt-get install chromium chromium-driver)"
            );
            return None;
        }
        // A driver whose port another one takes in the same moment ends without a word.
        let (driver, port) =
            (0..5).find_map(|_| start_driver()).expect("chromedriver says no port");
        let mut browser = Browser { driver, port, session: String::new() };
        let mut args = vec![
            "--headless=new".to_owned(),
            "--no-sandbox".into(),
            "--disable-gpu".into(),
            "--disable-dev-shm-usage".into(),
        ];
        args.push(format!("--window-size={width},{height}"));
        if dark {
            args.push("--force-prefers-color-scheme=dark".into());
            args.push("--blink-settings=preferredColorScheme=0".into());
        }
        let options = json!({ "args": args });
        let wanted =
            json!({ "goog:chromeOptions": options, "goog:loggingPrefs": { "browser": "ALL" } });
        let made =
            browser.ask("POST", "/session", &json!({ "capabilities": { "alwaysMatch": wanted } }));
        browser.session =
            made["sessionId"].as_str().unwrap_or_else(|| panic!("no session: {made}")).to_owned();
        // Headless windows have a least width; the emulation does not.
        let metrics =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        browser.chrome("Emulation.setDeviceMetricsOverride", &metrics);
        browser.colours(dark);
        Some(browser)
    }

    /// Has the system turn dark or light.
    #[allow(dead_code, reason = "each test file uses some of it")]
    pub fn colours(&self, dark: bool) {
        let value = if dark { "dark" } else { "light" };
        let scheme = json!([{ "name": "prefers-color-scheme", "value": value }]);
        self.chrome("Emulation.setEmulatedMedia", &json!({ "features": scheme }));
    }

    fn ask(&self, method: &str, path: &str, body: &Value) -> Value {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(120))).unwrap();
        let body = if method == "POST" { body.to_string() } else { String::new() };
        let head = format!(
            "{method} {path} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: close\r\nContent-Length: {}\r\n\r\n",
            self.port,
            body.len()
        );
        stream.write_all((head + &body).as_bytes()).unwrap();
        // The driver keeps connections open whatever it is asked: the length in its head ends the
        // answer.
        let (mut bytes, mut part) = (Vec::new(), [0; 1 << 16]);
        let head_end =
            |bytes: &[u8]| bytes.windows(4).position(|four| four == b"\r\n\r\n").map(|at| at + 4);
        let length = |head: &[u8]| -> Option<usize> {
            let head = String::from_utf8_lossy(head).to_ascii_lowercase();
            head.split("content-length:").nth(1)?.split("\r\n").next()?.trim().parse().ok()
        };
        let at = loop {
            let read = stream.read(&mut part).unwrap_or(0);
            bytes.extend(&part[..read]);
            match head_end(&bytes) {
                Some(at)
                    if read == 0
                        || length(&bytes[..at])
                            .is_some_and(|length| bytes.len() >= at + length) =>
                {
                    break at;
                }
                None if read == 0 => break 0,
                _ => {}
            }
        };
        let answer: Value = serde_json::from_slice(&bytes[at..]).unwrap_or(Value::Null);
        answer["value"].clone()
    }

    fn here(&self, method: &str, path: &str, body: &Value) -> Value {
        self.ask(method, &format!("/session/{}{path}", self.session), body)
    }

    fn chrome(&self, command: &str, params: &Value) {
        self.here("POST", "/goog/cdp/execute", &json!({ "cmd": command, "params": params }));
    }

    /// Goes to an address.
    pub fn go(&self, address: &str) {
        self.here("POST", "/url", &json!({ "url": "about:blank" }));
        self.here("POST", "/url", &json!({ "url": address }));
    }

    /// What a script returns.
    pub fn script(&self, text: &str) -> Value {
        self.here("POST", "/execute/sync", &json!({ "script": text, "args": [] }))
    }

    /// Forgets all cookies of the page.
    #[allow(dead_code, reason = "each test file uses some of it")]
    pub fn forget(&self) {
        self.here("DELETE", "/cookie", &Value::Null);
    }

    /// Waits until a script returns true: three minutes, for a busy machine takes more than one.
    pub fn wait(&self, text: &str) {
        self.wait_for(text, Duration::from_secs(180));
    }

    /// The same for what takes a training or the making of a film.
    #[allow(dead_code, reason = "each test file uses some of it")]
    pub fn wait_long(&self, text: &str) {
        self.wait_for(text, Duration::from_secs(600));
    }

    fn wait_for(&self, text: &str, time: Duration) {
        let begun = Instant::now();
        while self.script(&format!("return Boolean({text})")) != json!(true) {
            let body = "return document.body.innerText";
            assert!(
                begun.elapsed() < time,
                "not in {time:?}: {text}; the page says {}",
                self.script(body)
            );
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// The picture of a canvas, once it has stayed the same for half a second.
    #[allow(dead_code, reason = "each test file uses some of it")]
    pub fn resting(&self, canvas: &str) -> Value {
        let look = format!("return document.querySelector('{canvas}').toDataURL()");
        let (begun, mut picture, mut since) = (Instant::now(), self.script(&look), Instant::now());
        while since.elapsed() < Duration::from_millis(500) {
            assert!(begun.elapsed() < Duration::from_secs(60), "{canvas} does not come to rest");
            std::thread::sleep(Duration::from_millis(100));
            let now = self.script(&look);
            if now != picture {
                (picture, since) = (now, Instant::now());
            }
        }
        picture
    }

    /// Presses keys one after the other (`down`) or lets them go.
    #[allow(dead_code, reason = "each test file uses some of it")]
    pub fn keys(&self, keys: &[&str], down: bool) {
        let kind = if down { "keyDown" } else { "keyUp" };
        let actions: Vec<Value> =
            keys.iter().map(|key| json!({ "type": kind, "value": key })).collect();
        self.here(
            "POST",
            "/actions",
            &json!({ "actions": [{ "type": "key", "id": "keys", "actions": actions }] }),
        );
    }

    /// As on a tablet: fingers, and nothing that hovers.
    #[allow(dead_code, reason = "each test file uses some of it")]
    pub fn touched(&self) {
        let fingers = json!({ "cmd": "Emulation.setTouchEmulationEnabled", "params": { "enabled": true, "maxTouchPoints": 5 } });
        self.here("POST", "/goog/cdp/execute", &fingers);
    }

    /// Moves a pointer (`mouse` or `touch`) to the middle of the element that `selector` finds, or
    /// by some pixels from where it is, and presses or releases it there.
    #[allow(dead_code, reason = "each test file uses some of it")]
    pub fn pointer(&self, kind: &str, to: Result<&str, [i32; 2]>, press: Option<bool>) {
        let mut actions = vec![match to {
            Ok(selector) => {
                let found = self.here(
                    "POST",
                    "/element",
                    &json!({ "using": "css selector", "value": selector }),
                );
                json!({ "type": "pointerMove", "duration": 0, "origin": found, "x": 0, "y": 0 })
            }
            Err([x, y]) => {
                json!({ "type": "pointerMove", "duration": 100, "origin": "pointer", "x": x, "y": y })
            }
        }];
        actions.extend(press.map(
            |down| json!({ "type": if down { "pointerDown" } else { "pointerUp" }, "button": 0 }),
        ));
        let pointer = json!({ "type": "pointer", "id": kind, "parameters": { "pointerType": kind }, "actions": actions });
        self.here("POST", "/actions", &json!({ "actions": [pointer] }));
    }

    /// Errors that the console shows.
    pub fn errors(&self) -> Vec<String> {
        let log = self.here("POST", "/se/log", &json!({ "type": "browser" }));
        let lines = log.as_array().cloned().unwrap_or_default();
        lines
            .iter()
            .filter(|line| line["level"] == "SEVERE")
            .map(|line| line["message"].to_string())
            .collect()
    }

    /// Keeps a picture of the window where `HASARD_KEEP_PICTURES` says.
    pub fn photograph(&self, name: &str) {
        let Some(place) = std::env::var_os("HASARD_KEEP_PICTURES").map(PathBuf::from) else {
            return;
        };
        let picture = self.here("GET", "/screenshot", &Value::Null);
        std::fs::write(place.join(format!("{name}.png")), base64(picture.as_str().unwrap()))
            .unwrap();
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        self.here("DELETE", "", &Value::Null);
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}

fn base64(text: &str) -> Vec<u8> {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut bytes = Vec::with_capacity(text.len() * 3 / 4);
    let (mut bits, mut count) = (0u32, 0);
    for value in text.bytes().filter_map(|letter| LETTERS.iter().position(|one| *one == letter)) {
        bits = bits << 6 | value as u32;
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    bytes
}
