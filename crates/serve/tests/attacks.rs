//! What a hostile page, neighbour or file tries, and what it gets.

mod common;

use common::{folder, get, raw, serve, status, write_run};
use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};
use tungstenite::Message;

#[test]
fn another_origin_and_another_name_are_refused() {
    let address = serve(&folder("origin"), None);
    assert_eq!(status(&get(address, "/api/runs", "")), 200);
    assert_eq!(status(&get(address, "/api/runs", &format!("Origin: http://{address}\r\n"))), 200);
    assert_eq!(status(&get(address, "/api/runs", "Origin: http://evil.example\r\n")), 403);
    assert_eq!(status(&get(address, "/api/runs", "Origin: null\r\n")), 403);
    assert_eq!(status(&get(address, "/api/runs", "Sec-Fetch-Site: cross-site\r\n")), 403);
    // DNS rebinding: the name of another site points here.
    assert_eq!(
        status(&raw(
            address,
            "GET /api/runs HTTP/1.1\r\nHost: evil.example:8350\r\nConnection: close\r\n\r\n"
        )),
        403
    );
    let two = "GET /api/runs HTTP/1.1\r\nHost: 127.0.0.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n";
    assert!(matches!(status(&raw(address, two)), 400 | 403));
    // A WebSocket across sites.
    let upgrade = "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n";
    let request = |origin: &str| {
        format!(
            "GET /api/watch?env=RemedyRushLevel1-v0 HTTP/1.1\r\nHost: {address}\r\nConnection: Upgrade\r\n{upgrade}Origin: {origin}\r\n\r\n"
        )
    };
    let mut stream = TcpStream::connect(address).unwrap();
    stream.write_all(request("http://evil.example").as_bytes()).unwrap();
    let mut head = [0; 12];
    stream.read_exact(&mut head).unwrap();
    assert_eq!(&head, b"HTTP/1.1 403");
    // Nothing is written to by anybody.
    assert_eq!(
        status(&raw(
            address,
            &format!(
                "POST /api/runs HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\nContent-Length: 0\r\n\r\n"
            )
        )),
        405
    );
}

#[test]
fn without_the_token_nothing_is_shown() {
    let address = serve(&folder("token"), Some("letmein12345"));
    for path in [
        "/",
        "/api/runs",
        "/app.js",
        "/api/watch?env=RemedyRushLevel1-v0",
        "/?token=wrong",
        "/?token=",
    ] {
        assert_eq!(status(&get(address, path, "")), 401, "{path}");
    }
    // Cookies of a host go to all its ports: those of another server let nobody in.
    let cookie = format!("hasard-token-{}", address.port());
    for wrong in [format!("{cookie}=letmein1234"), "hasard-token-1=letmein12345".into()] {
        assert_eq!(status(&get(address, "/api/runs", &format!("Cookie: {wrong}\r\n"))), 401);
    }
    let given = get(address, "/?token=letmein12345", "");
    assert!(
        status(&given) == 303
            && given.contains(&format!("{cookie}=letmein12345; HttpOnly; SameSite=Strict")),
        "{given}"
    );
    assert_eq!(
        status(&get(address, "/api/runs", &format!("Cookie: a=b; {cookie}=letmein12345\r\n"))),
        200
    );
}

#[test]
fn paths_stay_in_the_given_folders() {
    let folder = folder("paths");
    write_run(&folder, "a", 3);
    std::fs::write(folder.join("secret.episode"), "secret").unwrap();
    std::fs::create_dir_all(folder.join("elsewhere")).unwrap();
    write_run(&folder.join("elsewhere"), "hidden", 3);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(
            folder.join("secret.episode"),
            folder.join("human/link.episode"),
        )
        .unwrap();
        std::os::unix::fs::symlink(folder.join("elsewhere"), folder.join("runs/link")).unwrap();
    }
    let address = serve(&folder, None);
    for name in [
        "../secret.episode",
        "..%2fsecret.episode",
        "%2e%2e%2fsecret.episode",
        "link.episode",
        "/etc/passwd",
        "..%5csecret.episode",
        "a%00.episode",
    ] {
        let answer = get(address, &format!("/api/episode?name={name}"), "");
        assert!(
            matches!(status(&answer), 400 | 404) && !answer.contains("secret\r"),
            "{name}: {answer}"
        );
    }
    for path in [
        "/../Cargo.toml",
        "/%2e%2e/%2e%2e/etc/passwd",
        "/..%2fetc",
        "//etc/passwd",
        "/api/../../etc/passwd",
    ] {
        assert!(matches!(status(&get(address, path, "")), 400 | 404), "{path}");
    }
    assert_eq!(status(&get(address, "/api/heatmap?id=../../etc/passwd", "")), 404);
    let runs = get(address, "/api/runs", "");
    assert!(runs.contains("\"name\":\"a\"") && !runs.contains("hidden"), "{runs}");
}

#[test]
fn a_script_in_a_name_stays_text() {
    let folder = folder("script");
    let name = "<script>alert(1)<";
    write_run(&folder, name, 2);
    let address = serve(&folder, None);
    let runs = get(address, "/api/runs", "");
    // It is data in a JSON document that no browser takes for a page.
    assert!(
        runs.contains("content-type: application/json")
            && runs.contains("x-content-type-options: nosniff"),
        "{runs}"
    );
    let page = get(address, "/", "");
    assert!(page.contains("default-src 'none'; script-src 'self'") && !page.contains("alert"));
    let id = runs.split("\"id\":\"").nth(1).unwrap().split('"').next().unwrap();
    let report = get(address, &format!("/api/report?runs={id}"), "");
    assert!(
        status(&report) == 200 && !report.contains("<script>alert"),
        "{}",
        &report[..500.min(report.len())]
    );
}

fn connect(address: std::net::SocketAddr, path: &str) -> tungstenite::WebSocket<TcpStream> {
    let stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    tungstenite::client(format!("ws://{address}{path}"), stream).unwrap().0
}

/// Whether the server ends a connection soon.
fn ends(mut socket: tungstenite::WebSocket<TcpStream>) -> bool {
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(60) {
        match socket.read() {
            Ok(Message::Close(_)) | Err(_) => return true,
            Ok(_) => {}
        }
    }
    false
}

#[test]
fn rubbish_ends_its_own_connection_alone() {
    let address = serve(&folder("rubbish"), None);
    let watch = "/api/watch?env=RemedyRushLevel1-v0&size=64x48";
    let mut good = connect(address, watch);
    for message in [
        Message::text("{"),
        Message::text("{\"do\":\"erase\"}"),
        Message::binary(vec![0; 100]),
        Message::text("x".repeat(5000)),
    ] {
        let mut bad = connect(address, watch);
        bad.send(message).unwrap();
        assert!(ends(bad));
    }
    // A frame that says that it is 100 MB long: it is refused by its head.
    let mut bad = connect(address, watch);
    let mut head = vec![0x82, 0x80 | 127];
    head.extend(100_000_000u64.to_be_bytes());
    head.extend([1, 2, 3, 4]);
    bad.get_mut().write_all(&head).unwrap();
    assert!(ends(bad));
    // A flood.
    let mut bad = connect(address, watch);
    for _ in 0..3000 {
        if bad.send(Message::text("{\"do\":\"tic\"}")).is_err() {
            break;
        }
    }
    assert!(ends(bad));
    good.send(Message::text("{\"do\":\"pause\"}")).unwrap();
    let begun = Instant::now();
    let mut frames = 0;
    while frames == 0 {
        assert!(begun.elapsed() < Duration::from_secs(60));
        frames += u32::from(good.read().unwrap().is_binary());
    }
}

/// A viewer that does not say that it saw a frame gets two, and then none.
#[test]
fn a_slow_viewer_gets_fewer_frames_and_no_queue() {
    let address = serve(&folder("slow"), None);
    let mut slow = connect(address, "/api/watch?env=RemedyRushLevel1-v0&size=64x48");
    let mut frames = 0;
    while let Ok(message) = slow.read() {
        frames += u32::from(message.is_binary());
        if frames == 2 {
            // A queue would show itself at once.
            slow.get_mut().set_read_timeout(Some(Duration::from_secs(3))).unwrap();
        }
    }
    assert_eq!(frames, 2);
}

#[test]
fn ten_thousand_sockets_do_not_lock_others_out_for_long() {
    let folder = folder("sockets");
    let address = serve(&folder, None);
    // Ten thousand at a time, all silent, or as many as this process may open. The server's places
    // are all taken then.
    let mut open = Vec::new();
    for _ in 0..10_000 {
        match TcpStream::connect_timeout(&address, Duration::from_secs(5)) {
            Ok(stream) => open.push(stream),
            Err(_) if open.len() > 600 => {
                // No more files: room for the test itself, and on with others.
                open.drain(..100);
            }
            Err(_) => {}
        }
    }
    assert!(open.len() > 600, "{} sockets are no attack; raise `ulimit -n`", open.len());
    // The silent ones are shown out: somebody who asks is answered while they are all still held.
    let begun = Instant::now();
    while status(&try_get(address, "/api/runs")) != 200 {
        assert!(begun.elapsed() < Duration::from_secs(90), "nobody is answered any more");
        std::thread::sleep(Duration::from_millis(200));
    }
    drop(open);
    assert_eq!(status(&get(address, "/", "")), 200);
}

/// A byte is no request, nor is an open connection after an answer: neither keeps its place.
#[test]
fn who_asks_for_nothing_more_is_shown_out() {
    let address = serve(&folder("bytes"), Some("letmein12345"));
    let keeps = |request: &str| {
        let mut stream = TcpStream::connect(address).unwrap();
        let _ = stream.write_all(request.as_bytes());
        stream
    };
    let answered = format!("GET / HTTP/1.1\r\nHost: {address}\r\n\r\n");
    // More than there are places, in two ways; the ones beyond are turned away.
    let open: Vec<TcpStream> =
        (0..600).map(|k| keeps(if k % 2 == 0 { "G" } else { &answered })).collect();
    let begun = Instant::now();
    while status(&try_get(address, "/api/runs")) != 401 {
        assert!(begun.elapsed() < Duration::from_secs(60), "nobody is answered any more");
        std::thread::sleep(Duration::from_millis(200));
    }
    // One byte after the other does not draw it out.
    let mut slow = keeps("G");
    slow.set_read_timeout(Some(Duration::from_millis(500))).unwrap();
    let begun = Instant::now();
    let over = |stream: &mut TcpStream| match stream.read(&mut [0; 64]) {
        Ok(bytes) => bytes == 0,
        Err(error) => !matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut),
    };
    while !over(&mut slow) {
        assert!(begun.elapsed() < Duration::from_secs(60), "a byte at a time keeps a place");
        let _ = slow.write_all(b"E");
    }
    drop(open);
}

/// As `get`, of a server that may turn one away: then nothing.
fn try_get(address: std::net::SocketAddr, path: &str) -> String {
    let asked = || -> std::io::Result<String> {
        let mut stream = TcpStream::connect(address)?;
        stream.set_read_timeout(Some(Duration::from_secs(20)))?;
        stream.write_all(
            format!("GET {path} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n")
                .as_bytes(),
        )?;
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    };
    asked().unwrap_or_default()
}

/// A viewer of a show that never reads holds no more than its two frames, and every place is given
/// back.
#[test]
fn places_are_given_back_by_viewers_that_never_read_or_send_rubbish() {
    let address = serve(&folder("places"), None);
    let watch = "/api/watch?env=RemedyRushLevel1-v0&size=64x48";
    let visit = || {
        let begun = Instant::now();
        loop {
            let mut socket = connect(address, watch);
            if socket.read().is_ok_and(|message| message.to_string().contains("scene")) {
                return socket;
            }
            // Those before are still leaving.
            assert!(begun.elapsed() < Duration::from_secs(60), "no place is given back");
            std::thread::sleep(Duration::from_millis(50));
        }
    };
    // Far more than there are places at a time.
    for turn in 0..150 {
        let mut socket = if turn % 3 == 2 { connect(address, watch) } else { visit() };
        if turn % 3 == 0 {
            let _ = socket.send(Message::binary(vec![7; 100]));
        } else if turn % 3 == 1 {
            let _ = socket.read();
        }
        // The third kind goes without having read anything.
    }
    // All of them left: a show begins.
    let mut last = visit();
    assert!((0..5).any(|_| last.read().is_ok_and(|message| message.is_binary())));
}
