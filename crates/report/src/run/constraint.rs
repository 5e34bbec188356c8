//! What a run's cost is held against.

use crate::statistics::Estimate;

/// A cost and the budget of an episode.
#[derive(Clone, PartialEq, Debug)]
pub struct Constraint {
    /// Name of a cost term; `None` for the whole cost.
    pub term: Option<String>,
    /// Cost that an episode may have.
    pub budget: f64,
}

impl Constraint {
    /// The name under which reports have its cost.
    #[must_use]
    pub fn metric(&self) -> String {
        self.term.as_ref().map_or_else(|| "cost_mean".into(), |term| format!("cost/{term}"))
    }

    /// What its cost is called.
    #[must_use]
    pub fn name(&self) -> &str {
        self.term.as_deref().unwrap_or("whole cost")
    }

    /// Its budget, with the term's name if it is of one: `50`, `lava 30`.
    #[must_use]
    pub fn label(&self) -> String {
        self.named(&self.budget.to_string())
    }

    /// What is said of it, with the term's name if it is of one.
    #[must_use]
    pub fn named(&self, text: &str) -> String {
        self.term.as_ref().map_or_else(|| text.to_owned(), |term| format!("{term} {text}"))
    }

    /// How a measured cost stands to the budget.
    #[must_use]
    pub fn kept_by(&self, cost: Option<Estimate>) -> Kept {
        match cost {
            None => Kept::Unknown,
            Some(cost) if cost.half_width.is_some() && cost.high() <= self.budget => Kept::Surely,
            Some(cost) if cost.mean <= self.budget => Kept::ByMean,
            Some(_) => Kept::Over,
        }
    }
}

/// How costs stand to their budgets, the worst first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Default)]
pub enum Kept {
    /// A cost was not measured.
    #[default]
    Unknown,
    /// A mean is above its budget.
    Over,
    /// The means are within their budgets, the upper end of an interval is not (or there is no
    /// interval).
    ByMean,
    /// The upper ends of the 95 % intervals are within.
    Surely,
}
