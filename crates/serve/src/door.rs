//! How many connections there are at a time, and how long one may be silent before it asks for
//! anything.

use axum::serve::Listener;
use std::io;
use std::net::SocketAddr;
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
/// Time for the first byte of a request.
const PATIENCE: Duration = Duration::from_secs(10);

/// Accepts connections up to a number; the ones beyond are closed at once, so that they queue
/// nowhere.
pub(crate) struct Door {
    pub listener: TcpListener,
    pub places: Arc<Semaphore>,
}

/// A connection that holds a place.
pub(crate) struct Visitor {
    stream: TcpStream,
    /// Ends a connection that says nothing; `None` once it has.
    silence: Option<Pin<Box<Sleep>>>,
    _place: OwnedSemaphorePermit,
}

impl Listener for Door {
    type Io = Visitor;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Visitor, SocketAddr) {
        loop {
            match self.listener.accept().await {
                Ok((stream, address)) => {
                    if let Ok(place) = Arc::clone(&self.places).try_acquire_owned() {
                        // Frames are to leave when they are drawn.
                        let _ = stream.set_nodelay(true);
                        let silence = Some(Box::pin(tokio::time::sleep(PATIENCE)));
                        return (Visitor { stream, silence, _place: place }, address);
                    }
                }
                // Out of file descriptors, or a visitor that left in the door.
                Err(_) => tokio::time::sleep(Duration::from_millis(50)).await,
            }
        }
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

impl AsyncRead for Visitor {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let result = Pin::new(&mut self.stream).poll_read(context, buffer);
        if result.is_ready() {
            self.silence = None;
        } else if self
            .silence
            .as_mut()
            .is_some_and(|silence| silence.as_mut().poll(context).is_ready())
        {
            return Poll::Ready(Err(io::ErrorKind::TimedOut.into()));
        }
        result
    }
}

impl AsyncWrite for Visitor {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.stream).poll_write(context, bytes)
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}
