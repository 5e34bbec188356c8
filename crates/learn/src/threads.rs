//! Work dealt out to threads.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Items dealt into at most so many runs as equal as they can be, the longer ones first; none is
/// empty unless all are.
pub fn deal(items: usize, parts: usize) -> impl Iterator<Item = Range<usize>> + Clone {
    let count = parts.min(items).max(1);
    let (length, longer) = (items / count, items % count);
    (0..count).map(move |part| {
        let first = part * length + part.min(longer);
        first..first + length + usize::from(part < longer)
    })
}

/// A piece of work, with the scratch of the thread that does it.
pub type Piece<'a, S> = Box<dyn FnOnce(&mut S) + Send + 'a>;

/// Pieces that work is best dealt into: more than threads, for when the system holds one of them
/// up; one thread needs one.
pub fn pieces(threads: usize) -> usize {
    if threads <= 1 { 1 } else { 2 * threads }
}

/// Does pieces of work on as many threads as there is scratch, this one among them. Each takes the
/// next piece, in their order, when it is done with one, so that whatever else the machine does
/// delays all of them alike. Threads that the system does not give leave their work to the others.
///
/// # Panics
/// If there is no scratch.
pub fn in_parallel<S: Send, W: FnOnce(&mut S) + Send>(
    scratch: &mut [S],
    work: impl IntoIterator<Item = W, IntoIter: Send>,
) {
    let (own, others) = scratch.split_first_mut().expect("there is a thread");
    let work = work.into_iter();
    if others.is_empty() {
        return work.for_each(|piece| piece(own));
    }
    let work = Mutex::new(work.peekable());
    // The lock is held while a piece is taken, not while it is done.
    let left = || work.lock().unwrap_or_else(PoisonError::into_inner);
    let next = || left().next();
    std::thread::scope(|scope| {
        for scratch in others {
            let all = move || std::iter::from_fn(next).for_each(|piece| piece(scratch));
            let is_over = left().peek().is_none();
            if is_over || std::thread::Builder::new().spawn_scoped(scope, all).is_err() {
                break;
            }
        }
        std::iter::from_fn(next).for_each(|piece| piece(own));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_is_dealt_once() {
        for items in 0..40 {
            for parts in 1..50 {
                let dealt: Vec<Range<usize>> = deal(items, parts).collect();
                assert!(
                    dealt.len() <= parts && dealt.iter().all(|run| !run.is_empty() || items == 0)
                );
                assert_eq!(
                    dealt.into_iter().flatten().collect::<Vec<_>>(),
                    (0..items).collect::<Vec<_>>()
                );
            }
        }
    }

    #[test]
    fn every_piece_is_done_once() {
        for threads in 1..5 {
            for count in 0..20 {
                let mut done = vec![0; count];
                let mut scratch = vec![0; threads];
                in_parallel(
                    &mut scratch,
                    done.iter_mut().map(|done| {
                        move |own: &mut i32| {
                            *done += 1;
                            *own += 1;
                        }
                    }),
                );
                assert!(done.iter().all(|&times| times == 1));
                assert_eq!(scratch.iter().sum::<i32>() as usize, count);
            }
        }
    }
}
