use std::sync::atomic::{AtomicU32, Ordering};

/// Work that steps may spend on meshes that are not registered, in triangles. To build the tree of
/// one triangle takes about 0.2 µs.
///
/// Descents and searches without trees earn. A tree is built if there is enough; hashes and
/// surfaces, which contacts depend on, are always computed and then charged. So the trees of one
/// step take at most 2 ms, and none is built in a step that has many new meshes to analyse.
#[derive(Debug)]
pub(super) struct BuildBudget(AtomicU32);

impl Default for BuildBudget {
    fn default() -> Self {
        Self(AtomicU32::new(Self::LIMIT))
    }
}

impl BuildBudget {
    /// Triangles that can be saved up, and so the largest mesh that gets a tree without `prepare`.
    /// Higher: longer steps where such meshes land; lower: larger meshes have no tree.
    pub(super) const LIMIT: u32 = 8192;
    /// Triangles that a descent without trees earns. It takes 20 µs, twice as long as with trees.
    /// Higher: trees come sooner; lower: they take a smaller share of a step.
    const EARNED: u32 = 64;

    pub(super) fn earn(&self) {
        self.update(|saved| Some((saved + Self::EARNED).min(Self::LIMIT)));
    }

    /// Takes the cost of a tree and returns true, if as much is saved up.
    pub(super) fn spend(&self, triangle_count: usize) -> bool {
        let count = u32::try_from(triangle_count).unwrap_or(u32::MAX);
        self.update(|saved| saved.checked_sub(count))
    }

    /// Takes a cost, even if less is saved up.
    pub(super) fn charge(&self, amount: usize) {
        let amount = u32::try_from(amount).unwrap_or(u32::MAX);
        self.update(|saved| Some(saved.saturating_sub(amount)));
    }

    fn update(&self, change: impl Fn(u32) -> Option<u32>) -> bool {
        self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, change).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn budget_is_spent_and_earned_up_to_its_limit() {
        let (budget, limit) = (BuildBudget::default(), BuildBudget::LIMIT as usize);
        assert!(!budget.spend(limit + 1) && !budget.spend(usize::MAX));
        assert!(budget.spend(limit) && budget.spend(0) && !budget.spend(1));
        let needed = limit.div_ceil(BuildBudget::EARNED as usize);
        (1..needed).for_each(|_| budget.earn());
        assert!(!budget.spend(limit));
        (0..3 * needed).for_each(|_| budget.earn());
        budget.charge(2);
        assert!(!budget.spend(limit - 1) && budget.spend(limit - 2) && !budget.spend(1));
        budget.charge(usize::MAX);
    }
}
