//! The WebSocket of a show. A show draws a frame only while fewer than two are on their way unseen,
//! so that a slow viewer gets fewer frames and never a queue; what a viewer sends is bounded in
//! size and rate.

use crate::shared::Shared;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::response::Response;
use serde::Deserialize;
use serde_json::{Value, json};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TryRecvError, sync_channel};
use std::time::{Duration, Instant};
use tokio::sync::mpsc;
use tokio::time::{MissedTickBehavior, interval};

/// Frames that are on their way at most.
const ON_THEIR_WAY: u32 = 2;
/// Bytes of a message from a viewer.
const LARGEST_COMMAND: usize = 2 << 10;
/// Messages that wait, and messages a second: a mouse moves 125 times a second.
const WAITING: usize = 256;
const RATE: u32 = 500;
/// Time after which a viewer that does not answer is gone.
const GONE: Duration = Duration::from_secs(45);
const PING: Duration = Duration::from_secs(15);
/// Time for the last words.
const LAST_WORDS: Duration = Duration::from_secs(1);

/// What a viewer asks for.
#[derive(Deserialize, Debug)]
#[serde(tag = "do", rename_all = "lowercase")]
pub(super) enum Ask {
    /// A frame was shown.
    Ack,
    Pause,
    Go,
    /// One tic on.
    Tic,
    Speed {
        value: f64,
    },
    Jump {
        step: u32,
    },
    /// Keys down and up, by the names of `Key`, and the mouse.
    Press {
        key: String,
    },
    Release {
        key: String,
    },
    Mouse {
        right: f32,
        down: f32,
    },
    Loose,
    /// The same episode again, or the next one.
    Again,
    Next,
}

/// The show's end of the WebSocket.
pub(super) struct Line {
    asks: Receiver<Ask>,
    out: mpsc::Sender<Message>,
    on_their_way: u32,
}

impl Line {
    /// The next thing that the viewer asks for, if it comes within a time; `Err` when the viewer is
    /// gone.
    pub fn ask_within(&mut self, time: Duration) -> Result<Option<Ask>, ()> {
        let ask = if time.is_zero() {
            match self.asks.try_recv() {
                Ok(ask) => ask,
                Err(TryRecvError::Empty) => return Ok(None),
                Err(TryRecvError::Disconnected) => return Err(()),
            }
        } else {
            match self.asks.recv_timeout(time) {
                Ok(ask) => ask,
                Err(RecvTimeoutError::Timeout) => return Ok(None),
                Err(RecvTimeoutError::Disconnected) => return Err(()),
            }
        };
        if let Ask::Ack = ask {
            self.on_their_way = self.on_their_way.saturating_sub(1);
        }
        Ok(Some(ask))
    }

    /// Whether a frame may be drawn now.
    pub fn free(&self) -> bool {
        self.on_their_way < ON_THEIR_WAY
    }

    /// Sends a frame.
    pub fn frame(&mut self, bytes: Vec<u8>) -> Result<(), ()> {
        self.on_their_way += 1;
        self.out.blocking_send(Message::Binary(bytes.into())).map_err(drop)
    }

    /// Sends words.
    pub fn say(&mut self, words: &Value) -> Result<(), ()> {
        self.out.blocking_send(Message::Text(words.to_string().into())).map_err(drop)
    }
}

/// Takes a viewer in and runs a show for it in a thread; where all places are taken, says so.
pub(super) fn open(
    shared: Arc<Shared>,
    upgrade: WebSocketUpgrade,
    show: impl FnOnce(Line) + Send + 'static,
) -> Response {
    let Ok(place) = Arc::clone(&shared.shows).try_acquire_owned() else {
        let why = "all places are taken; close another page of this server";
        return said(upgrade, json!({ "kind": "error", "why": why, "again": true }));
    };
    bounded(upgrade).on_upgrade(async move |socket| {
        let (asks, received) = sync_channel(WAITING);
        let (out, frames) = mpsc::channel(4);
        let line = Line { asks: received, out, on_their_way: 0 };
        let begun = std::thread::Builder::new().name("show".into()).spawn(move || {
            show(line);
            drop(place);
        });
        if begun.is_ok() {
            pump(socket, asks, frames).await;
        }
    })
}

/// Says to a viewer why there is no show.
pub(super) fn refuse(upgrade: WebSocketUpgrade, why: String) -> Response {
    said(upgrade, json!({ "kind": "error", "why": why }))
}

/// Says some words and ends: it takes no place.
fn said(upgrade: WebSocketUpgrade, words: Value) -> Response {
    bounded(upgrade).on_upgrade(async move |mut socket| {
        let said = async {
            socket.send(Message::Text(words.to_string().into())).await?;
            socket.send(Message::Close(None)).await?;
            // Until the viewer has heard it and ends, too: a connection that is cut may lose it.
            while socket.recv().await.is_some_and(|message| message.is_ok()) {}
            Ok::<(), axum::Error>(())
        };
        let _ = tokio::time::timeout(LAST_WORDS, said).await;
    })
}

fn bounded(upgrade: WebSocketUpgrade) -> WebSocketUpgrade {
    upgrade.max_message_size(LARGEST_COMMAND).max_frame_size(LARGEST_COMMAND)
}

/// Carries frames out and commands in until one side ends.
async fn pump(mut socket: WebSocket, asks: SyncSender<Ask>, mut frames: mpsc::Receiver<Message>) {
    let mut pings = interval(PING);
    pings.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let (mut heard, mut second, mut messages) = (Instant::now(), Instant::now(), 0);
    loop {
        // A viewer that never reads blocks a write for ever: that too is being gone.
        let out = match next(&mut socket, &mut frames, &mut pings).await {
            Next::In(Some(Ok(message))) => {
                heard = Instant::now();
                if second.elapsed() > Duration::from_secs(1) {
                    (second, messages) = (heard, 0);
                }
                messages += 1;
                let ask = match message {
                    Message::Text(text) => serde_json::from_str(&text).ok(),
                    Message::Ping(_) | Message::Pong(_) if messages <= RATE => continue,
                    _ => None,
                };
                // Rubbish, a flood, a full queue: this connection ends, and nothing else.
                match ask {
                    Some(ask) if messages <= RATE => match asks.try_send(ask) {
                        Ok(()) => continue,
                        Err(_) => break,
                    },
                    _ => break,
                }
            }
            Next::In(_) => break,
            Next::Out(Some(message)) => message,
            Next::Out(None) => break,
            Next::Ping if heard.elapsed() > GONE => break,
            Next::Ping => Message::Ping(Vec::new().into()),
        };
        match tokio::time::timeout(GONE, socket.send(out)).await {
            Ok(Ok(())) => {}
            _ => return,
        }
    }
    let _ = tokio::time::timeout(LAST_WORDS, socket.send(Message::Close(None))).await;
}

enum Next {
    In(Option<Result<Message, axum::Error>>),
    Out(Option<Message>),
    Ping,
}

/// Whatever comes first.
async fn next(
    socket: &mut WebSocket,
    frames: &mut mpsc::Receiver<Message>,
    pings: &mut tokio::time::Interval,
) -> Next {
    let mut receive = std::pin::pin!(socket.recv());
    std::future::poll_fn(|context| {
        use std::task::Poll;
        if let Poll::Ready(message) = receive.as_mut().poll(context) {
            return Poll::Ready(Next::In(message));
        }
        if let Poll::Ready(message) = frames.poll_recv(context) {
            return Poll::Ready(Next::Out(message));
        }
        if pings.poll_tick(context).is_ready() {
            return Poll::Ready(Next::Ping);
        }
        Poll::Pending
    })
    .await
}
