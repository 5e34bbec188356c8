//! Words that live as long as the program: names of registered scenarios, each kept once.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

/// The same word, for ever.
pub(crate) fn intern(word: &str) -> &'static str {
    static WORDS: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut words = WORDS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = words.get(word) {
        return known;
    }
    let kept: &'static str = Box::leak(word.to_owned().into_boxed_str());
    words.insert(kept);
    kept
}
