//! The surface at a place where many triangles meet. A direction takes logarithmic time there.

use glamx::DVec3;

use super::slopes::{Bend, FLAT, Heights, RISE_TO_FACE, Slopes};

/// Ways that are compared one by one. Higher: slower at fans. Lower: more memory.
const LEAF: usize = 8;

/// Ratio up to which slopes count as equal. Higher: rises are less exact. Lower: all ways are
/// compared where these rise equally.
const EQUAL: f64 = 1.01;

/// The surface at a place, for all directions.
pub(super) struct Crowd {
    /// Unit ways from the place to the corners, in the order of a balanced tree.
    ways: Vec<DVec3>,
    /// Boxes around the ways of each node. Node `i` has the children `2 i + 1` and `2 i + 2`.
    boxes: Vec<[DVec3; 2]>,
    heights: Heights,
    bend: Bend,
}

impl Crowd {
    /// The surface with some ways to corners, their heights, and their bend.
    pub(super) fn new(mut ways: Vec<DVec3>, heights: Heights, bend: Bend) -> Self {
        ways.iter_mut().for_each(|way| *way = way.normalize_or_zero());
        let mut boxes = Vec::new();
        build(&mut ways, 0, &mut boxes);
        Self { ways, boxes, heights, bend }
    }

    /// Returns the surface seen along a unit direction. A rise below [`FLAT`] is returned as
    /// [`FLAT`]. One above [`RISE_TO_FACE`] need not be the greatest.
    pub(super) fn slopes(&self, direction: DVec3) -> Slopes {
        let rise = self.greatest(&self.ways, 0, direction, FLAT).powi(2);
        Slopes { rise, height: self.heights.along(direction), bend: Some(self.bend.doubled()) }
    }

    /// Returns the greatest slope of the ways of a node, or `known` if none is much greater.
    fn greatest(&self, ways: &[DVec3], node: usize, direction: DVec3, known: f64) -> f64 {
        let [low, high] = self.boxes[node];
        let most = (low * direction).max(high * direction).element_sum();
        if most <= EQUAL * known || known > RISE_TO_FACE {
            return known;
        }
        if ways.len() <= LEAF {
            return ways.iter().map(|way| way.dot(direction)).fold(known, f64::max);
        }
        let (left, right) = ways.split_at(ways.len() / 2);
        let known = self.greatest(left, 2 * node + 1, direction, known);
        self.greatest(right, 2 * node + 2, direction, known)
    }
}

/// Sorts the ways of a node, and stores their boxes.
fn build(ways: &mut [DVec3], node: usize, boxes: &mut Vec<[DVec3; 2]>) {
    let low = ways.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = ways.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    boxes.resize(boxes.len().max(node + 1), [DVec3::ZERO; 2]);
    boxes[node] = [low, high];
    if ways.len() > LEAF {
        let (axis, middle) = ((high - low).max_position(), ways.len() / 2);
        ways.select_nth_unstable_by(middle, |a, b| a[axis].total_cmp(&b[axis]));
        let (left, right) = ways.split_at_mut(middle);
        build(left, 2 * node + 1, boxes);
        build(right, 2 * node + 2, boxes);
    }
}

/// Triangles at a place.
#[derive(Default)]
pub(super) struct Found {
    pub(super) heights: Heights,
    /// Sum of the area vectors.
    pub(super) area: DVec3,
    pub(super) count: usize,
}

impl Found {
    /// Adds a triangle by its area vector out of the body, and the angle that the triangle has at
    /// the place.
    pub(super) fn add(&mut self, area: DVec3, angle: f64) {
        self.heights.add(area, angle);
        self.area += area;
        self.count += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Would catch a box that leaves out a way.
    #[test]
    fn the_greatest_slope_is_that_of_all_ways() {
        let mut moderate = 0;
        let place = |i: u32| {
            let [x, y, z] = [7, 11, 13].map(|step| f64::from(i * i * step % 101) - 50.0);
            DVec3::new(x, y, z)
        };
        for count in [0, 1, 8, 9, 100, 1000] {
            // Close to a plane, so that rises are moderate.
            let ways = (0..count).map(|i| place(i) * DVec3::new(1.0, 1.0, 0.2));
            let ways: Vec<DVec3> = ways.collect();
            let bend = Bend::from(DVec3::Z);
            let crowd = Crowd::new(ways.clone(), Heights::default(), bend);
            for tilt in (2000..2100).map(|i| 0.004 * place(i)) {
                let direction = (tilt + DVec3::Z).normalize();
                let mut all = Slopes::default();
                ways.iter().for_each(|way| all.add(*way, direction));
                let [found, all] = [crowd.slopes(direction).rise, all.rise].map(f64::sqrt);
                moderate += u32::from((FLAT..RISE_TO_FACE).contains(&all));
                let least = all.clamp(FLAT, RISE_TO_FACE) / EQUAL;
                assert!((least..=all.max(FLAT) + 1e-12).contains(&found), "{found} {all}");
            }
        }
        assert!(moderate > 50, "{moderate}");
    }
}
