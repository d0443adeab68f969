//! Where two surfaces cross, and where nothing parts them.

use rustc_hash::FxHashMap;

/// The pairs of triangles of a query that cross, in regions that hang together: the curve along
/// which two surfaces cross goes from one pair to the next through a triangle that both have.
#[derive(Default)]
pub(crate) struct Regions {
    /// Each with whether its contact is beyond doubt.
    pairs: Vec<([u32; 2], bool)>,
    /// Whether contacts in doubt are still put off.
    is_collecting: bool,
    /// By mesh and triangle: another one of the same region, or itself.
    above: FxHashMap<(usize, u32), (usize, u32)>,
    /// Regions with a contact that is beyond doubt, by their roots.
    held: FxHashMap<(usize, u32), bool>,
}

impl Regions {
    /// Begins the first round of a query.
    pub(crate) fn begin(&mut self) {
        self.pairs.clear();
        self.is_collecting = true;
    }

    pub(super) fn is_first_round(&self) -> bool {
        self.is_collecting
    }

    /// Notes a pair that crosses.
    pub(super) fn add(&mut self, pair: [u32; 2], is_good: bool) {
        if self.is_collecting {
            self.pairs.push((pair, is_good));
        }
    }

    /// Ends the first round. Whether some regions have no contact beyond doubt.
    pub(super) fn close(&mut self) -> bool {
        let was_collecting = std::mem::take(&mut self.is_collecting);
        if !was_collecting || self.pairs.iter().all(|&(_, is_good)| is_good) {
            return false;
        }
        self.above.clear();
        self.held.clear();
        for i in 0..self.pairs.len() {
            let ([triangle1, triangle2], _) = self.pairs[i];
            let [root1, root2] = [(0, triangle1), (1, triangle2)].map(|node| self.root(node));
            self.above.insert(root1.max(root2), root1.min(root2));
        }
        for i in 0..self.pairs.len() {
            let ([triangle1, _], is_good) = self.pairs[i];
            let root = self.root((0, triangle1));
            *self.held.entry(root).or_default() |= is_good;
        }
        self.held.values().any(|is_held| !is_held)
    }

    /// Whether the region of a pair has no contact beyond doubt.
    pub(super) fn is_lost(&mut self, [triangle1, _]: [u32; 2]) -> bool {
        let root = self.root((0, triangle1));
        self.held.get(&root).is_some_and(|is_held| !is_held)
    }

    fn root(&mut self, mut node: (usize, u32)) -> (usize, u32) {
        loop {
            let above = *self.above.entry(node).or_insert(node);
            if above == node {
                return node;
            }
            let next = *self.above.get(&above).unwrap_or(&above);
            self.above.insert(node, next);
            node = above;
        }
    }
}
