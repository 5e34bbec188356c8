//! Work dealt out to threads.

use std::ops::Range;

/// Items dealt into at most so many runs as equal as they can be, the longer ones first; none is empty unless all are.
pub fn deal(items: usize, parts: usize) -> impl Iterator<Item = Range<usize>> + Clone {
    let count = parts.min(items).max(1);
    let (length, longer) = (items / count, items % count);
    (0..count).map(move |part| {
        let first = part * length + part.min(longer);
        first..first + length + usize::from(part < longer)
    })
}

/// Does all of the work at once, the first piece on this thread and each other on one of its own.
pub fn in_parallel<W: FnOnce() + Send>(work: impl IntoIterator<Item = W>) {
    std::thread::scope(|scope| {
        let mut work = work.into_iter();
        let own = work.next();
        for other in work {
            scope.spawn(other);
        }
        if let Some(own) = own {
            own();
        }
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
                assert!(dealt.len() <= parts && dealt.iter().all(|run| !run.is_empty() || items == 0));
                assert_eq!(dealt.into_iter().flatten().collect::<Vec<_>>(), (0..items).collect::<Vec<_>>());
            }
        }
    }
}
