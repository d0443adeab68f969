use std::cmp::Ordering;

use glamx::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};
use sbbk_core::collections::UnionFind;
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
    /// The direction in which mesh 2 leaves mesh 1, where contacts do not agree on one.
    way: Option<DVec3>,
    /// Pairs whose contact pushes the wrong way.
    wrong: FxHashSet<[u32; 2]>,
    /// The triangles of a region, by mesh and triangle.
    regions: UnionFind<Node>,
    /// By the first triangle of a region: what holds it.
    held: FxHashMap<Node, Hold>,
}

/// How many pairs a region has, and how many of them have a contact beyond doubt.
#[derive(Copy, Clone, Default)]
struct Hold {
    pairs: u32,
    good: u32,
    /// Whether a contact was of the far side of a thin body: no others are added.
    is_thin: bool,
    /// The sum of the normals of contacts beyond doubt.
    normals: DVec3,
    /// Off a sheet, to the side that the middle of a solid is on; zero without.
    leave: DVec3,
    /// Whether contacts beyond doubt push off its front and its back.
    sides: [bool; 2],
}

/// How many pairs of a region one contact beyond doubt stands for. Higher: bodies deep in each other
/// under a load turn about the one that there is, and sink (of six chains of rings under 50 times
/// their weight, with 16, the greatest gain of energy was 0.17, with 8 it is 0.09). Lower: contacts
/// that are no local minima push aside, and such a chain may part (one of six in 20 seconds with 6).
const CARRIED: u32 = 8;

impl Hold {
    fn is_enough(self) -> bool {
        self.good > 0 && (self.is_thin || self.pairs <= CARRIED * self.good)
    }
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
    /// If one of the two is a sheet, and the other a smaller solid.
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
        self.way = None;
        self.is_first_round = true;
    }

    /// Gives back memory beyond so many pairs, between queries.
    pub(crate) fn shrink_to(&mut self, limit: usize) {
        if self.found.capacity() > limit {
            *self = Self::default();
        }
    }

    /// Whether a way is known that one body leaves the other.
    pub(super) fn has_way(&self) -> bool {
        self.way.is_some()
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

    /// Whether contacts beyond doubt push about as much one way as the other: what goes through a solid
    /// and sticks out on both sides would stay.
    pub(super) fn is_undecided(&self) -> bool {
        let good = self.found.iter().filter(|found| found.is_good);
        let (count, sum) =
            good.fold((0, DVec3::ZERO), |(count, sum), found| (count + 1, sum + found.normal));
        let is_none_better = sum.length() <= SAME_SIDE * f64::from(count);
        self.is_first_round && !self.found.is_empty() && is_none_better
    }

    /// Ends the first round. Whether there are regions that too little holds, or contacts that push the
    /// wrong way: also those against the `way` that mesh 2 leaves mesh 1, if it is known.
    pub(super) fn close(&mut self, way: Option<DVec3>) -> bool {
        if !std::mem::take(&mut self.is_first_round) {
            return false;
        }
        self.find_wrong();
        self.way = way;
        let is_against = |found: &&Crossing| {
            found.is_good && way.is_some_and(|way| found.normal.dot(way) < -SAME_SIDE)
        };
        self.wrong.extend(self.found.iter().filter(is_against).map(|found| found.pair));
        self.found.sort_unstable_by_key(|found| found.pair);
        let is_on = |side: f64| self.found.iter().any(|found| found.side() == side);
        let is_torn = is_on(1.0) && is_on(-1.0);
        if !is_torn && self.found.iter().all(|found| self.is_fine(found)) {
            return false;
        }
        self.regions.clear();
        self.held.clear();
        for &Crossing { pair: [triangle1, triangle2], .. } in &self.found {
            self.regions.join((0, triangle1), (1, triangle2));
        }
        self.find_held();
        let has_sheet = self.found.iter().any(|found| found.sheet.is_some());
        if has_sheet && self.find_torn() {
            self.held.clear();
            self.find_held();
        }
        !self.wrong.is_empty() || self.held.values().any(|hold| !hold.is_enough())
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

    /// Whether the contacts beyond doubt of the region of a pair are too few to hold it.
    pub(super) fn is_lost(&mut self, pair: [u32; 2]) -> bool {
        let first = self.first_of(pair);
        self.held.get(&first).is_some_and(|hold| !hold.is_enough())
    }

    /// Whether no contact beyond doubt holds the region of a pair.
    pub(super) fn is_unheld(&mut self, pair: [u32; 2]) -> bool {
        let first = self.first_of(pair);
        self.held.get(&first).is_some_and(|hold| hold.good == 0)
    }

    /// Whether a contact of a region does not push against those beyond doubt, nor through a sheet.
    /// Without: plates at 30 m/s that a spike stops come through on it.
    pub(super) fn agrees(&mut self, pair: [u32; 2], normal: DVec3) -> bool {
        let first = self.first_of(pair);
        self.way.is_none_or(|way| way.dot(normal) >= -SAME_SIDE)
            && self
                .held
                .get(&first)
                .is_none_or(|hold| hold.normals.dot(normal) >= 0.0 && hold.leave.dot(normal) >= 0.0)
    }

    /// A triangle that is in a thin body, or has a thin one around it, has both its sides near, which
    /// push against each other. The one that is farther away is wrong. (Of a solid on a sheet the side is
    /// one for a region: triangles by themselves let four times as many slabs through large triangles.)
    fn find_wrong(&mut self) {
        for side in 0..2 {
            self.found.sort_unstable_by_key(|found| (found.pair[side], found.pair));
            for of_one in self.found.chunk_by(|a, b| a.pair[side] == b.pair[side]) {
                let of_bodies = |found: &&Crossing| found.is_good && found.sheet.is_none();
                for found in of_one.iter().filter(of_bodies) {
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

    /// Says what holds the regions.
    fn find_held(&mut self) {
        for i in 0..self.found.len() {
            let found = self.found[i];
            let (first, is_fine) = (self.first_of(found.pair), self.is_fine(&found));
            let hold = self.held.entry(first).or_default();
            hold.pairs += 1;
            hold.good += u32::from(is_fine);
            hold.normals += if is_fine { found.normal } else { DVec3::ZERO };
            // Of a sheet it is known which way that is.
            hold.is_thin |= found.sheet.is_none() && self.wrong.contains(&found.pair);
            hold.leave += found.sheet.map_or(DVec3::ZERO, |sheet| sheet.height * sheet.away);
            hold.sides[0] |= is_fine && found.side() > 0.0;
            hold.sides[1] |= is_fine && found.side() < 0.0;
        }
    }

    /// A thin solid in the midst of a sheet is pushed to both sides of it, and held there, or by too
    /// few. It goes to the side that its middle is on, as seen from where it crosses the sheet. Whether
    /// contacts push the other way.
    fn find_torn(&mut self) -> bool {
        let before = self.wrong.len();
        for i in 0..self.found.len() {
            let found = self.found[i];
            let first = self.first_of(found.pair);
            let is_doubtful = |hold: &&Hold| hold.sides == [true; 2] || !hold.is_enough();
            let leave = self.held.get(&first).filter(is_doubtful).map(|hold| hold.leave);
            let is_against = |leave: DVec3| found.normal.dot(leave) < -SAME_SIDE * leave.length();
            if found.is_good && leave.is_some_and(is_against) {
                self.wrong.insert(found.pair);
            }
        }
        self.wrong.len() > before
    }

    /// The first triangle of the region of a pair.
    fn first_of(&mut self, [triangle1, _]: [u32; 2]) -> Node {
        self.regions.first((0, triangle1))
    }
}

#[cfg(test)]
mod tests {
    use sbbk_core::contact::{Feature, FeaturePair};

    use super::*;

    fn pushing(normal: DVec3, depth: f64) -> TriangleContact {
        let (point, features) = (DVec3::ZERO, FeaturePair::new(Feature::Face, Feature::Face));
        TriangleContact { normal, distance: -depth, point1: point, point2: point, features }
    }

    /// Would catch regions that are not joined through the triangles that their pairs share, one that
    /// is held taken for lost, and pairs that a second round decides anew without need.
    #[test]
    fn regions_without_a_good_contact_are_lost() {
        let good = pushing(DVec3::Y, 0.1);
        let mut regions = Regions::default();
        for _ in 0..2 {
            regions.begin();
            // One region is held by a contact far along it, one is not.
            for (pair, contact) in [
                ([1, 1], None),
                ([1, 2], None),
                ([3, 2], Some(&good)),
                ([7, 7], None),
                ([7, 8], None),
            ] {
                regions.add(pair, contact, None);
                assert!(!regions.is_settled(pair));
            }
            assert!(regions.is_first_round() && regions.close(None));
            assert!(!regions.is_first_round() && !regions.close(None));
            let held = [[1, 1], [1, 2], [3, 2]].map(|pair| regions.is_lost(pair));
            assert_eq!(held, [false; 3]);
            assert!(regions.is_lost([7, 7]) && regions.is_lost([7, 8]));
            assert!(!regions.is_lost([9, 9]), "it does not cross");
            let settled = [[3, 2], [9, 9], [1, 1], [7, 8]].map(|pair| regions.is_settled(pair));
            assert_eq!(settled, [true, true, false, false]);
        }
        regions.begin();
        regions.add([1, 1], Some(&good), None);
        assert!(!regions.close(None), "all is good");
        regions.begin();
        regions.add([1, 1], None, None);
        regions.add([1, 2], Some(&good), None);
        assert!(!regions.close(None), "the region is held");
    }

    /// Would catch a thin body that is pushed both ways, whichever of the two meshes it is.
    #[test]
    fn of_two_sides_of_a_thin_body_the_nearer_one_counts() {
        for pair in [|thin, other| [thin, other], |thin, other| [other, thin]] {
            let mut regions = Regions::default();
            regions.begin();
            regions.add(pair(5, 1), Some(&pushing(DVec3::Y, 0.1)), None);
            regions.add(pair(5, 2), Some(&pushing(-DVec3::Y, 0.3)), None);
            assert!(regions.close(None));
            assert!(regions.is_settled(pair(5, 1)) && !regions.is_settled(pair(5, 2)));
        }
    }

    /// Would catch a large region that turns about its only contact beyond doubt, small ones that are
    /// looked at twice, contacts beyond doubt that a second round decides anew, and others that push
    /// against them.
    #[test]
    fn one_contact_does_not_hold_a_large_region() {
        let good = pushing(DVec3::Y, 0.1);
        let is_lost = |pairs: u32, contacts: u32| {
            let mut regions = Regions::default();
            regions.begin();
            for i in 0..pairs {
                regions.add([1, i], Some(&good).filter(|_| i < contacts), None);
            }
            let needs_more = regions.close(None);
            assert_eq!(needs_more, regions.held.get(&(0, 1)).is_some_and(|hold| !hold.is_enough()));
            assert!(!needs_more || regions.is_settled([1, 0]));
            assert!(regions.agrees([1, 0], DVec3::new(1.0, 0.1, 0.0)));
            assert!(!regions.agrees([1, 0], -DVec3::Y));
            needs_more && regions.is_lost([1, pairs - 1])
        };
        assert_eq!([8, 9].map(|pairs| is_lost(pairs, 1)), [false, true]);
        assert_eq!([16, 17].map(|pairs| is_lost(pairs, 2)), [false, true]);
    }

    /// Would catch a body that goes through a solid and is held there, one whose way out is asked for
    /// though its contacts agree, and contacts along or across the way that are dropped.
    #[test]
    fn of_contacts_both_ways_those_along_the_way_stay() {
        let regions = |normals: &[DVec3]| {
            let mut regions = Regions::default();
            regions.begin();
            for (i, &normal) in (1..).zip(normals) {
                regions.add([i, i], Some(&pushing(normal, 0.1)), None);
            }
            regions
        };
        let aslant = DVec3::new(0.9, -0.4, 0.0).normalize();
        assert!(!regions(&[DVec3::Y, DVec3::Y, aslant]).is_undecided());
        assert!(!regions(&[]).is_undecided());
        let mut both = regions(&[DVec3::Y, -DVec3::Y, aslant]);
        assert!(both.is_undecided() && !both.has_way());
        assert!(both.close(Some(DVec3::Y)) && both.has_way());
        assert_eq!([1, 2, 3].map(|i| both.is_settled([i, i])), [true, false, true]);
        assert!(both.is_lost([2, 2]) && !both.agrees([2, 2], -DVec3::Y));
        assert!(both.agrees([2, 2], DVec3::X) && both.agrees([2, 2], aslant));
        let mut none = Regions::default();
        none.begin();
        none.add([1, 1], None, None);
        assert!(none.is_undecided(), "none is good");
    }

    /// Would catch a thin body that is pushed both ways, or by its farther side.
    #[test]
    fn of_two_sides_that_push_against_each_other_the_nearer_one_stays() {
        let both = |up: f64, down: f64, lean: f64| {
            let mut regions = Regions::default();
            regions.begin();
            let leaning = DVec3::new(lean.sin(), -lean.cos(), 0.0);
            regions.add([1, 1], Some(&pushing(DVec3::Y, up)), None);
            regions.add([1, 2], Some(&pushing(leaning, down)), None);
            regions.close(None).then(|| [[1, 1], [1, 2]].map(|pair| regions.is_settled(pair)))
        };
        assert_eq!(both(0.1, 0.3, 0.0), Some([true, false]));
        assert_eq!(both(0.3, 0.1, 0.5), Some([false, true]));
        assert_eq!(both(0.2, 0.2, 0.0), None, "neither is nearer");
        assert_eq!(both(0.1, 0.3, 1.2), None, "they do not push against each other");
    }

    /// Would catch a thin body that is held in a sheet, one that goes to the side where less of it is,
    /// and contacts lost where all push to one side, whichever that is.
    #[test]
    fn a_region_pushed_to_both_sides_of_a_sheet_keeps_one() {
        let pushed = |heights: [f64; 2], normals: [DVec3; 2]| {
            let mut regions = Regions::default();
            regions.begin();
            for (i, (height, normal)) in (1..).zip(heights.into_iter().zip(normals)) {
                let sheet = Some(Sheet { away: DVec3::Y, height });
                regions.add([i, 1], Some(&pushing(normal, 0.1)), sheet);
            }
            // Far from these, all the same way.
            let sheet = Some(Sheet { away: DVec3::Y, height: 1.0 });
            regions.add([7, 7], Some(&pushing(-DVec3::Y, 0.1)), sheet);
            regions.close(None);
            [[1, 1], [2, 1], [7, 7]].map(|pair| regions.is_settled(pair))
        };
        let both = [DVec3::Y, -DVec3::Y];
        assert_eq!(pushed([0.2, -0.1], both), [true, false, true]);
        assert_eq!(pushed([0.1, -0.2], both), [false, true, true]);
        assert_eq!(pushed([-0.1; 2], [DVec3::Y; 2]), [true; 3]);
    }

    /// Would catch a thin solid that the few good contacts of a large region push through a sheet, and
    /// others that do so.
    #[test]
    fn few_contacts_do_not_push_through_a_sheet() {
        let down = pushing(-DVec3::Y, 0.1);
        let close = |height: f64, pairs: u32| {
            let mut regions = Regions::default();
            regions.begin();
            for i in 0..pairs {
                let good = Some(&down).filter(|_| i == 0);
                regions.add([1, i], good, Some(Sheet { away: DVec3::Y, height }));
            }
            let needs_more = regions.close(None);
            (needs_more && regions.is_lost([1, 0]), regions.is_settled([1, 0]), regions)
        };
        let (is_lost, is_settled, mut regions) = close(0.01, CARRIED + 1);
        assert!(is_lost && !is_settled);
        assert!(regions.agrees([1, 0], DVec3::Y) && !regions.agrees([1, 0], -DVec3::Y));
        let (is_lost, is_settled, mut regions) = close(-0.01, CARRIED + 1);
        assert!(is_lost && is_settled && !regions.agrees([1, 0], DVec3::Y));
        assert!(!close(0.01, CARRIED).0, "it is held");
    }
}
