use std::cmp::Ordering;

use glamx::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};
use sbbk_core::contact::TriangleContact;

/// Where two surfaces cross, what pushes them apart, and where nothing does.
///
/// *Regions* are the pairs of triangles that hang together: the curve along which two surfaces cross
/// goes from one pair to the next through a triangle that both have.
#[derive(Default)]
pub(crate) struct Regions {
    found: Vec<Crossing>,
    /// Whether contacts in doubt are still put off.
    is_first_round: bool,
    /// Pairs whose contact pushes the wrong way.
    wrong: FxHashSet<[u32; 2]>,
    /// By mesh and triangle: another one of the same region, or itself.
    above: FxHashMap<Node, Node>,
    /// By the node at the top of a region: whether it has a contact beyond doubt.
    held: FxHashMap<Node, bool>,
    /// By the node at the top of a region.
    torn: FxHashMap<Node, Torn>,
}

/// Where a solid crosses a sheet.
#[derive(Default)]
struct Torn {
    /// The sum of the heights of its middle.
    height: f64,
    /// Whether it is pushed to each side.
    to_front: bool,
    to_back: bool,
}

/// A triangle of mesh 1 (0) or 2 (1).
type Node = (usize, u32);

/// A pair of triangles that cross.
#[derive(Copy, Clone)]
struct Crossing {
    pair: [u32; 2],
    /// Whether its contact is beyond doubt, but for others of its triangles.
    is_good: bool,
    /// Of such a contact, from mesh 1 to mesh 2.
    normal: DVec3,
    depth: f64,
    /// If one of the two is a sheet, and the other a solid.
    sheet: Option<Sheet>,
}

/// How a solid lies to a triangle of a sheet that it crosses.
#[derive(Copy, Clone)]
pub(super) struct Sheet {
    /// The normal of contacts that push the solid off the front of the triangle.
    pub(super) away: DVec3,
    /// How far in front the middle of the solid is.
    pub(super) height: f64,
}

impl Crossing {
    /// To which side of a sheet its contact pushes the solid: 1 to the front, -1 to the back, 0 neither.
    fn side(&self) -> f64 {
        let along = self.sheet.map_or(0.0, |sheet| sheet.away.dot(self.normal));
        if along.abs() > SAME_SIDE { along.signum() } else { 0.0 }
    }
}

/// The cosine of normals that push to one side.
const SAME_SIDE: f64 = 0.5;

impl Regions {
    /// Begins the first round of a query.
    pub(crate) fn begin(&mut self) {
        self.found.clear();
        self.wrong.clear();
        self.is_first_round = true;
    }

    pub(super) fn is_first_round(&self) -> bool {
        self.is_first_round
    }

    /// Notes a pair that crosses, with its contact if that is beyond doubt.
    pub(super) fn add(
        &mut self,
        pair: [u32; 2],
        good: Option<&TriangleContact>,
        sheet: Option<Sheet>,
    ) {
        let (normal, depth) =
            good.map_or_else(Default::default, |good| (good.normal, -good.distance));
        self.found.push(Crossing { pair, is_good: good.is_some(), normal, depth, sheet });
    }

    /// Ends the first round. Whether there are regions that nothing holds, or contacts that push the
    /// wrong way.
    pub(super) fn close(&mut self) -> bool {
        if !std::mem::take(&mut self.is_first_round) {
            return false;
        }
        self.find_wrong();
        self.found.sort_unstable_by_key(|found| found.pair);
        let is_on = |side: f64| self.found.iter().any(|found| found.side() == side);
        let is_torn = is_on(1.0) && is_on(-1.0);
        if !is_torn && self.found.iter().all(|found| self.is_fine(found)) {
            return false;
        }
        self.above.clear();
        self.held.clear();
        for i in 0..self.found.len() {
            let [triangle1, triangle2] = self.found[i].pair;
            let [top1, top2] = [(0, triangle1), (1, triangle2)].map(|node| self.top(node));
            self.above.insert(top1.max(top2), top1.min(top2));
        }
        if is_torn {
            self.find_torn();
        }
        for i in 0..self.found.len() {
            let found = self.found[i];
            let (top, is_fine) = (self.top((0, found.pair[0])), self.is_fine(&found));
            *self.held.entry(top).or_default() |= is_fine;
        }
        !self.wrong.is_empty() || self.held.values().any(|is_held| !is_held)
    }

    /// Whether a second round changes nothing for a pair.
    pub(super) fn is_settled(&self, pair: [u32; 2]) -> bool {
        if self.is_first_round {
            return false;
        }
        let found = self.found.binary_search_by_key(&pair, |found| found.pair);
        found.is_ok_and(|at| self.is_fine(&self.found[at])) || found.is_err()
    }

    /// Whether a contact is good, and pushes the right way.
    fn is_fine(&self, found: &Crossing) -> bool {
        found.is_good && !self.wrong.contains(&found.pair)
    }

    /// Whether the region of a pair has no contact beyond doubt.
    pub(super) fn is_lost(&mut self, [triangle1, _]: [u32; 2]) -> bool {
        let top = self.top((0, triangle1));
        self.held.get(&top).is_some_and(|is_held| !is_held)
    }

    /// A triangle that is in a thin body, or has a thin one around it, has both its sides near, which
    /// push against each other. The one that is farther away is wrong.
    fn find_wrong(&mut self) {
        for side in 0..2 {
            self.found.sort_unstable_by_key(|found| (found.pair[side], found.pair));
            for of_one in self.found.chunk_by(|a, b| a.pair[side] == b.pair[side]) {
                for found in of_one.iter().filter(|found| found.is_good) {
                    let deepest = |sign: f64| {
                        let like = |other: &&Crossing| {
                            other.is_good && sign * other.normal.dot(found.normal) > SAME_SIDE
                        };
                        of_one.iter().filter(like).map(|other| other.depth).max_by(f64::total_cmp)
                    };
                    let is_nearer = deepest(-1.0).partial_cmp(&deepest(1.0));
                    if deepest(-1.0).is_some() && is_nearer == Some(Ordering::Less) {
                        self.wrong.insert(found.pair);
                    }
                }
            }
        }
    }

    /// A thin solid in the midst of a sheet is pushed to both sides of it, and held there. It goes to
    /// the side that its middle is on, as seen from where it crosses the sheet.
    fn find_torn(&mut self) {
        self.torn.clear();
        for i in 0..self.found.len() {
            let found = self.found[i];
            let top = self.top((0, found.pair[0]));
            let torn = self.torn.entry(top).or_default();
            torn.height += found.sheet.map_or(0.0, |sheet| sheet.height);
            torn.to_front |= found.side() > 0.0;
            torn.to_back |= found.side() < 0.0;
        }
        for i in 0..self.found.len() {
            let found = self.found[i];
            let top = self.top((0, found.pair[0]));
            let torn = self.torn.get(&top).filter(|torn| torn.to_front && torn.to_back);
            if torn.is_some_and(|torn| found.side() * torn.height < 0.0) {
                self.wrong.insert(found.pair);
            }
        }
    }

    /// The node at the top of a region.
    fn top(&mut self, mut node: Node) -> Node {
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
