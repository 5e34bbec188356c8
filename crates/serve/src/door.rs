//! How many connections there are at a time, and how long one may keep its place without asking for
//! anything or taking what it asked for.

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::time::Sleep;

/// Connections at a time; a browser has some six.
pub(crate) const CONNECTIONS: usize = 512;
/// Time for the whole head of a request, from the connection's beginning or from the end of the
/// answer before it.
const PATIENCE: Duration = Duration::from_secs(10);
/// Time in which a visitor takes some of what is sent to it.
const STALLED: Duration = Duration::from_secs(45);

/// Accepts connections up to a number; the ones beyond are closed at once, so that they queue
/// nowhere.
pub(crate) struct Door {
    pub listener: TcpListener,
    pub places: Arc<Semaphore>,
}

impl Door {
    /// Answers all that come, until the process ends.
    pub async fn serve(self, routes: Router) -> ! {
        let mut http = http1::Builder::new();
        // One byte now and then is no request: the time runs until the head is whole. A WebSocket
        // has had its head, and looks after itself.
        http.timer(TokioTimer::new()).header_read_timeout(PATIENCE);
        loop {
            let visitor = TokioIo::new(self.visitor().await);
            let service = TowerToHyperService::new(routes.clone());
            let served = http.serve_connection(visitor, service).with_upgrades();
            // What a connection brings ends that connection alone.
            tokio::spawn(async move { drop(served.await) });
        }
    }

    async fn visitor(&self) -> Visitor {
        loop {
            match self.listener.accept().await {
                Ok((stream, _)) => {
                    if let Ok(place) = Arc::clone(&self.places).try_acquire_owned() {
                        // Frames are to leave when they are drawn.
                        let _ = stream.set_nodelay(true);
                        return Visitor {
                            stream,
                            takes_within: STALLED,
                            stalled: None,
                            _place: place,
                        };
                    }
                }
                // Out of file descriptors, or a visitor that left in the door.
                Err(_) => tokio::time::sleep(Duration::from_millis(50)).await,
            }
        }
    }
}

/// A connection that holds a place.
struct Visitor {
    stream: TcpStream,
    takes_within: Duration,
    /// Ends a connection that takes nothing of what is sent; `None` while it does.
    stalled: Option<Pin<Box<Sleep>>>,
    _place: OwnedSemaphorePermit,
}

impl AsyncRead for Visitor {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(context, buffer)
    }
}

impl AsyncWrite for Visitor {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let result = Pin::new(&mut self.stream).poll_write(context, bytes);
        if result.is_ready() {
            self.stalled = None;
            return result;
        }
        let time = self.takes_within;
        let stalled = self.stalled.get_or_insert_with(|| Box::pin(tokio::time::sleep(time)));
        stalled.as_mut().poll(context).map(|()| Err(io::ErrorKind::TimedOut.into()))
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Else a few that ask and never read would hold all places.
    #[test]
    fn who_takes_nothing_is_shown_out() {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        let error = runtime.block_on(async {
            let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
            let silent = std::net::TcpStream::connect(listener.local_addr().unwrap()).unwrap();
            let (stream, _) = listener.accept().await.unwrap();
            let place = Arc::new(Semaphore::new(1)).try_acquire_owned().unwrap();
            let takes_within = Duration::from_millis(300);
            let mut visitor = Visitor { stream, takes_within, stalled: None, _place: place };
            let all = async {
                loop {
                    let part = std::future::poll_fn(|context| {
                        Pin::new(&mut visitor).poll_write(context, &[0; 1 << 16])
                    });
                    if let Err(error) = part.await {
                        return error;
                    }
                }
            };
            let error = tokio::time::timeout(Duration::from_secs(20), all).await.unwrap();
            drop(silent);
            error
        });
        assert_eq!(error.kind(), io::ErrorKind::TimedOut);
    }
}
