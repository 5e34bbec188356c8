//! What a run's cost is held against.

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
        self.term.as_ref().map_or_else(|| self.budget.to_string(), |term| format!("{term} {}", self.budget))
    }
}
