use std::sync::atomic::{AtomicU32, Ordering};

/// What queries may spend on trees, in triangles: to build the tree of one triangle takes about
/// a fifth of a microsecond.
///
/// Queries that do without a tree earn some; a tree that nobody has prepared is built when there is
/// enough. So building never takes more than a share of what queries take, and at most
/// [`MOST`](Self::MOST) at a time, less than two milliseconds, however many meshes land together. What
/// is built when is never part of an answer.
#[derive(Debug)]
pub(super) struct Credit(AtomicU32);

impl Default for Credit {
    fn default() -> Self {
        Self(AtomicU32::new(Self::MOST))
    }
}

impl Credit {
    /// The most that can be saved up, and so the largest mesh that gets a tree unasked. More: longer
    /// steps where such meshes land; less: larger meshes do without a tree.
    pub(super) const MOST: u32 = 8192;
    /// What a descent without trees earns: it takes some 20 µs, a little more than two with trees.
    const EARNED: u32 = 64;

    pub(super) fn earn(&self) {
        let more = |now: u32| Some((now + Self::EARNED).min(Self::MOST));
        // Always succeeds.
        let _ = self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, more);
    }

    /// Takes `amount` if there is as much.
    pub(super) fn spend(&self, amount: usize) -> bool {
        let less = |now: u32| now.checked_sub(u32::try_from(amount).ok()?);
        self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, less).is_ok()
    }

    /// What it takes to hash the content of a mesh.
    pub(super) fn of_hash(triangle_count: usize) -> usize {
        triangle_count.div_ceil(64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Would catch trees that cost nothing, a credit that grows without end, so that many are built
    /// at once, and one that is never earned again.
    #[test]
    fn credit_is_spent_earned_and_no_more_than_the_most() {
        let (credit, most) = (Credit::default(), Credit::MOST as usize);
        assert!(!credit.spend(most + 1) && !credit.spend(usize::MAX));
        assert!(credit.spend(most) && credit.spend(0) && !credit.spend(1));
        let needed = most.div_ceil(Credit::EARNED as usize);
        (1..needed).for_each(|_| credit.earn());
        assert!(!credit.spend(most));
        (0..3 * needed).for_each(|_| credit.earn());
        assert!(credit.spend(most) && !credit.spend(1));
        assert_eq!([1, 64, 65].map(Credit::of_hash), [1, 1, 2]);
    }
}
