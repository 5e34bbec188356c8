//! Viewers that measure a running `hasard serve`: `cargo run --release -p hasard-serve --example
//! viewers -- ADDRESS VIEWERS SIZE SECONDS`.
//!
//! Prints frames a second of each viewer and, playing, the time from a key to the first changed
//! picture. With `soak` as a fifth word, so many at a time come and go instead: some read, some
//! never do, some send rubbish.

use serde_json::Value;
use std::net::TcpStream;
use std::time::{Duration, Instant};
use tungstenite::{Message, WebSocket};

fn connect(address: &str, path: &str) -> Option<WebSocket<TcpStream>> {
    let stream = TcpStream::connect(address).ok()?;
    stream.set_read_timeout(Some(Duration::from_secs(5))).ok()?;
    tungstenite::client(format!("ws://{address}{path}"), stream).ok().map(|(socket, _)| socket)
}

/// Reads until a frame and says that it was seen, and asks for the next episode when this one has
/// ended; its pictures.
fn frame(socket: &mut WebSocket<TcpStream>) -> Option<Vec<u8>> {
    loop {
        if let Message::Binary(bytes) = socket.read().ok()? {
            socket.send(Message::text("{\"do\":\"ack\"}")).ok()?;
            let header = u32::from_le_bytes(bytes[..4].try_into().ok()?) as usize;
            let state: Value = serde_json::from_slice(&bytes[4..4 + header]).ok()?;
            if state["ended"] == true {
                socket.send(Message::text("{\"do\":\"next\"}")).ok()?;
            }
            return Some(bytes[4 + header..].to_vec());
        }
    }
}

fn watch(address: &str, size: &str, seconds: f64, seed: usize) -> f64 {
    let envs = [
        "VolcanicVentureLevel1-v0",
        "RemedyRushLevel2-v0",
        "DetonatorsDilemmaLevel3-v0",
        "ArmamentBurdenLevel1-v0",
    ];
    let path = format!(
        "/api/watch?env={}&agent=sticky:10&seed={seed}&size={size}",
        envs[seed % envs.len()]
    );
    let Some(mut socket) = connect(address, &path) else { return 0.0 };
    frame(&mut socket);
    let (begun, mut frames) = (Instant::now(), 0);
    while begun.elapsed().as_secs_f64() < seconds && frame(&mut socket).is_some() {
        frames += 1;
    }
    f64::from(frames) / begun.elapsed().as_secs_f64()
}

/// Milliseconds from a key to the first picture that shows it, some times over.
fn delays(address: &str, size: &str) -> Option<Vec<f64>> {
    let mut socket =
        connect(address, &format!("/api/play?env=ArmamentBurdenLevel1-v0&size={size}"))?;
    frame(&mut socket)?;
    socket.send(Message::text("{\"do\":\"go\"}")).ok()?;
    let mut all = Vec::new();
    for trial in 0..15 {
        let mut last = frame(&mut socket)?;
        let mut still = 0;
        while still < 8 + trial % 4 {
            let next = frame(&mut socket)?;
            still = if next == last { still + 1 } else { 0 };
            last = next;
        }
        let begun = Instant::now();
        socket.send(Message::text("{\"do\":\"press\",\"key\":\"TURN_LEFT\"}")).ok()?;
        while frame(&mut socket)? == last {}
        all.push(begun.elapsed().as_secs_f64() * 1000.0);
        socket.send(Message::text("{\"do\":\"release\",\"key\":\"TURN_LEFT\"}")).ok()?;
    }
    all.sort_by(f64::total_cmp);
    Some(all)
}

/// Visitors, one after the other, until the time is over; how many.
fn soak(address: &str, seconds: f64, first: usize) -> usize {
    let begun = Instant::now();
    let mut mute = Vec::new();
    let mut visitors = 0;
    while begun.elapsed().as_secs_f64() < seconds {
        visitors += 1;
        match visitors % 10 {
            // One that never reads: a few of these stay.
            0 => mute.push(connect(address, "/api/watch?env=RemedyRushLevel1-v0&size=320x240")),
            5 => {
                if let Some(mut socket) =
                    connect(address, "/api/watch?env=RemedyRushLevel1-v0&size=64x48")
                {
                    let _ = socket.send(Message::binary(vec![7; 1000]));
                }
            }
            _ => drop(watch(address, "320x240", 0.3, first + visitors)),
        }
        if mute.len() > 2 {
            mute.remove(0);
        }
    }
    visitors
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [address, viewers, size, seconds, rest @ ..] = words.as_slice() else {
        eprintln!("ADDRESS VIEWERS SIZE SECONDS [soak]");
        std::process::exit(2);
    };
    let (viewers, seconds): (usize, f64) =
        (viewers.parse().unwrap_or(1), seconds.parse().unwrap_or(5.0));
    if !rest.is_empty() {
        let visitors: usize = std::thread::scope(|scope| {
            let all: Vec<_> = (0..viewers)
                .map(|first| scope.spawn(move || soak(address, seconds, first)))
                .collect();
            all.into_iter().map(|one| one.join().unwrap_or(0)).sum()
        });
        return println!("{visitors} visitors in {seconds:.0} s, {viewers} at a time");
    }
    let rates: Vec<f64> = std::thread::scope(|scope| {
        let all: Vec<_> = (0..viewers)
            .map(|seed| scope.spawn(move || watch(address, size, seconds, seed)))
            .collect();
        all.into_iter().map(|one| one.join().unwrap_or(0.0)).collect()
    });
    println!("frames/s of {viewers} viewers at {size}: {rates:.1?}");
    if let Some(delays) = delays(address, size) {
        println!(
            "key to picture, ms: least {:.0}, median {:.0}, most {:.0}",
            delays[0],
            delays[delays.len() / 2],
            delays[delays.len() - 1]
        );
    }
}
