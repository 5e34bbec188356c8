//! Numbers worth reporting, averaged until they are.

use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Means by name, in the order of first mention.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize)]
pub struct Means {
    sums: Vec<(Cow<'static, str>, f64, u64)>,
}

impl Means {
    /// Adds a value; those that are no numbers are left out.
    pub fn add(&mut self, name: impl Into<Cow<'static, str>>, value: f64) {
        let name = name.into();
        if !value.is_finite() {
            return;
        }
        match self.sums.iter_mut().find(|(other, ..)| *other == name) {
            Some((_, sum, count)) => {
                *sum += value;
                *count += 1;
            }
            None => self.sums.push((name, value, 1)),
        }
    }

    /// Whether nothing was added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sums.is_empty()
    }

    /// Mean of a name, if anything was added to it.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<f64> {
        self.sums
            .iter()
            .find(|(other, ..)| *other == name)
            .map(|(_, sum, count)| sum / *count as f64)
    }

    /// Adds everything that was added to others.
    pub fn absorb(&mut self, others: Means) {
        for (name, sum, count) in others.sums {
            match self.sums.iter_mut().find(|(own, ..)| *own == name) {
                Some((_, own, times)) => (*own, *times) = (*own + sum, *times + count),
                None => self.sums.push((name, sum, count)),
            }
        }
    }

    /// All means, and a fresh start.
    pub fn take(&mut self) -> Vec<(Cow<'static, str>, f64)> {
        self.sums.drain(..).map(|(name, sum, count)| (name, sum / count as f64)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_taken_by_name_and_start_anew() {
        let mut means = Means::default();
        means.add("a", 1.0);
        means.add("b", 5.0);
        means.add("a", 3.0);
        means.add("a", f64::NAN);
        assert_eq!(means.get("a"), Some(2.0));
        let mut more = Means::default();
        more.absorb(means.clone());
        more.absorb(means.clone());
        assert_eq!(more.get("a"), Some(2.0));
        assert_eq!(means.take(), [("a".into(), 2.0), ("b".into(), 5.0)]);
        assert_eq!(means.get("a"), None);
    }
}
