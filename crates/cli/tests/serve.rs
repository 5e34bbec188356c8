//! `hasard serve` from the first training to the link of a moment of cost, in a real browser.

#![cfg(feature = "serve")]

#[path = "../../serve/tests/common/browser.rs"]
mod browser;

use browser::Browser;
use serde_json::json;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

fn hasard() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hasard"));
    command.stdin(Stdio::null()).stderr(Stdio::null());
    command
}

fn folder(name: &str) -> PathBuf {
    let folder =
        std::env::temp_dir().join(format!("hasard-cli-serve-{}-{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(folder.join("runs")).unwrap();
    std::fs::create_dir_all(folder.join("zoo")).unwrap();
    folder
}

/// A process that ends with the test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A server of the folder's runs, and the address that it printed.
fn serve(folder: &Path, listen: &str) -> (Running, String) {
    let mut command = hasard();
    command
        .args(["serve", "runs", "--listen", listen])
        .current_dir(folder)
        .env("HASARD_ZOO", folder.join("zoo"));
    let mut server = Running(command.stdout(Stdio::piped()).spawn().unwrap());
    let mut line = String::new();
    BufReader::new(server.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
    (server, line.trim().trim_end_matches('/').to_owned())
}

/// Whether the page shows these two numbers of an agent.
fn numbers(of_return: &str, of_cost: &str) -> String {
    format!(
        "['{of_return}', '{of_cost}'].every((name) => [...document.querySelectorAll('#numbers > span')].some((one) => one.firstChild.textContent == name && /^-?[0-9.]+$/.test(one.lastChild.innerText)))"
    )
}

#[test]
fn a_training_is_followed_and_its_agent_watched_to_its_cost() {
    let Some(browser) = Browser::open(1280, 1000, false) else { return };
    let folder = folder("agent");
    let (server, address) = serve(&folder, "localhost:0");
    browser.go(&address);
    browser.wait("document.body.innerText.includes('No runs yet')");
    // A training begins; its row appears and moves.
    let mut training = hasard();
    let words = [
        "train",
        "VolcanicVentureLevel1-v0",
        "--preset",
        "quick",
        "--frames",
        "60000",
        "--threads",
        "1",
        "--eval-every",
        "60000",
        "--out",
        "runs/tiny",
    ];
    let mut training =
        Running(training.args(words).stdout(Stdio::null()).current_dir(&folder).spawn().unwrap());
    let progress = "document.querySelector('tbody progress')?.value ?? 0";
    browser.wait_long(&format!("({progress}) > 0"));
    browser.wait_long("document.querySelector('tbody').innerText.includes('done')");
    assert!(training.0.wait().unwrap().success());
    assert_eq!(browser.script(&format!("return ({progress}) >= 1")), json!(true));
    browser.script("document.querySelector('tbody a').click()");
    browser.wait(
        "document.querySelector('h1').innerText.includes('PPOPID in Volcanic Venture 1, seed 1')",
    );
    browser.wait("document.querySelector('.readout').innerText.includes('training')");
    browser.photograph("serve_run_trained");

    // Its agent goes into the zoo.
    let exported = hasard()
        .args(["export-agent", "runs/tiny", "-o", "zoo/Tiny.agent"])
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(exported.status.success());
    // A file of a program that did not say what returns were like has values without a unit.
    let mut older = std::fs::read(folder.join("zoo/Tiny.agent")).unwrap();
    let name = br#"\"returns\":["#;
    let at = older.windows(name.len()).position(|some| some == name).expect("statistics");
    older[at + 2] = b'R';
    std::fs::write(folder.join("zoo/Unitless.agent"), older).unwrap();
    browser.go(&format!("{address}/#watch?agent=zoo:Unitless&seed=3"));
    browser.wait_long(&numbers("return value (normalised)", "cost value (normalised)"));
    browser.go(&format!("{address}/#watch?agent=zoo:Tiny&seed=3"));
    let step = "Number(document.querySelector('#numbers b')?.innerText)";
    browser.wait_long(&format!("{step} > 5"));
    browser.wait("document.querySelector('optgroup[label=\"the zoo\"] option').selected");
    // What it thinks: probabilities that add up to one in every group, and both values.
    browser.script("document.getElementById('go').click()");
    browser.wait("document.getElementById('go').innerText == 'Play'");
    let sums = "[...document.querySelectorAll('#thoughts .group')].map((group) => [...group.querySelectorAll('meter')].reduce((sum, one) => sum + one.value, 0))";
    browser
        .wait(&format!("{sums}.length >= 3 && {sums}.every((sum) => Math.abs(sum - 1) < 0.001)"));
    // Its file says what returns were like in training, so both are in units of return and cost.
    browser.wait(&numbers("expected return", "expected cost"));
    browser.wait_long("document.querySelector('[data-kind=cost]')");
    browser.script("document.querySelector('[data-kind=cost]').click()");
    browser.wait(&format!(
        "{step} == Number(document.querySelector('[data-kind=cost]').dataset.step) - 1"
    ));
    std::thread::sleep(std::time::Duration::from_millis(1000));
    browser.photograph("serve_watch_agent");
    let picture = "document.querySelector('canvas.view').toDataURL()";
    let (at, before) =
        (browser.script(&format!("return {step}")), browser.script(&format!("return {picture}")));
    browser.script("document.getElementById('copy').click()");
    browser.wait("location.hash.includes('paused=true') && location.hash.includes('step=')");
    let link = browser.script("return location.href");
    browser.go(link.as_str().unwrap());
    // The same agent, step and picture.
    browser.wait_long(&format!("{step} == {at} && document.getElementById('go').innerText == 'Play' && {picture} == {before}"));

    // The server dies and comes back: the show stands where it stood.
    drop(server);
    browser.wait("document.querySelector('[role=alert]').innerText.includes('does not answer')");
    let (_server, again) = serve(&folder, address.trim_start_matches("http://"));
    assert_eq!(again, address);
    browser
        .wait_long(&format!("document.querySelector('[role=alert]').innerText == '' && {step} == {at} && {picture} == {before}"));
    // Of its own run the newest checkpoint acts.
    browser.script("const agent = document.querySelector('optgroup[label=runs]').parentElement; agent.value = document.querySelector('optgroup[label=runs] option').value; agent.dispatchEvent(new Event('change'))");
    browser.wait_long(&format!(
        "location.hash.includes('agent=run') && {step} > 3 && document.querySelectorAll('#thoughts meter').length > 3"
    ));
    let seed = "document.querySelector('input[type=number]').value";
    let first = browser.script(&format!("return {seed}"));
    browser.script("document.getElementById('next').click()");
    browser.wait_long(&format!("{seed} == Number({first}) + 1 && {step} > 0"));
    // What is asked while a show is only on its way is not lost.
    browser.script("const size = [...document.querySelectorAll('select')].find((one) => one.value == '640x480'); size.value = '160x120'; size.dispatchEvent(new Event('change')); document.getElementById('next').click()");
    browser.wait(&format!("{seed} == Number({first}) + 2 && {step} > 0"));
    let unreachable = |line: &String| {
        line.contains("ERR_CONNECTION_REFUSED") || line.contains("WebSocket connection")
    };
    assert_eq!(
        browser.errors().into_iter().filter(|line| !unreachable(line)).collect::<Vec<_>>(),
        Vec::<String>::new()
    );
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn places_that_are_not_there_are_refused_at_the_start() {
    let folder = folder("places");
    std::fs::write(folder.join("file"), "").unwrap();
    for (flag, path, problem) in [
        ("--out", "file", "not a directory"),
        ("--out", "file/deeper", "not a directory"),
        ("--maps", "no-maps", "this is not there"),
        ("--iwad", "no.wad", "this is not there"),
    ] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hasard"));
        let output = command
            .args(["serve", "--listen", "127.0.0.1:0", flag, path])
            .current_dir(&folder)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{flag}");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            said.lines().count() == 1
                && said.contains(&format!("{path}: {problem}"))
                && said.contains(flag),
            "{said}"
        );
    }
    // A folder that can be made is made once there is an episode for it.
    let mut command = hasard();
    command.args(["serve", "--listen", "0.0.0.0:0", "--out", "deep/er"]).current_dir(&folder);
    let mut server =
        Running(command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap());
    let (mut line, mut other) = (String::new(), String::new());
    let mut said = BufReader::new(server.0.stdout.take().unwrap());
    said.read_line(&mut line).unwrap();
    assert!(line.starts_with("http://0.0.0.0:"), "{line}");
    assert!(!folder.join("deep").exists());
    // Visitors from elsewhere hear of an address that leads here, or of how to find one.
    BufReader::new(server.0.stderr.take().unwrap()).read_line(&mut other).unwrap();
    let token = line.trim().split_once("?token=").unwrap().1;
    let named = other.contains("http://") && other.contains(token) && !other.contains("//0.0.0.0");
    assert!(
        other.starts_with("hasard: from other machines: ")
            && (named || other.contains("put an address of this one")),
        "{other}"
    );
    drop(server);
    assert!(
        !std::fs::read_dir(&folder)
            .unwrap()
            .flatten()
            .any(|entry| { entry.file_name().to_string_lossy().starts_with(".hasard") })
    );
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_folder_that_is_not_there_is_refused() {
    let folder = folder("none");
    let mut command = Command::new(env!("CARGO_BIN_EXE_hasard"));
    let output = command
        .args(["serve", "no-such", "--listen", "127.0.0.1:0"])
        .current_dir(&folder)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.lines().count() == 1 && said.contains("no-such: there is no such folder"),
        "{said}"
    );
    // Without a name the folder `runs` is waited for, and beyond this machine a token is drawn,
    // another each time.
    std::fs::remove_dir(folder.join("runs")).unwrap();
    let address = || {
        let mut server = Running(
            hasard()
                .args(["serve", "--listen", "0.0.0.0:0"])
                .current_dir(&folder)
                .stdout(Stdio::piped())
                .spawn()
                .unwrap(),
        );
        let mut line = String::new();
        BufReader::new(server.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
        line.trim().split_once("?token=").unwrap().1.to_owned()
    };
    let (one, other) = (address(), address());
    assert!(
        one.len() == 32 && one.bytes().all(|byte| byte.is_ascii_hexdigit()) && one != other,
        "{one} {other}"
    );
    std::fs::remove_dir_all(folder).unwrap();
}
