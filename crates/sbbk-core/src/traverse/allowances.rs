//! Comparisons of nodes in f32 against f64, at places where f32 rounds most. No bound exceeds the
//! exact value, and rounding uses a fair share of each allowance.

use glamx::{DVec3, Pose3, Vec3};
use wide::f32x4;

use super::gaps::Bound;
use super::{NodeLanes, PairFrame, Placement, Toward};
use crate::simd::{Inner, Outer, each};
use crate::support::Random;
use crate::tree::{BATCH, Children, Intervals, LayerPlan, Slot, Tree};
use crate::volumes::{SLABS, directions};

/// The largest rounding error towards false separations, as a share of its allowance.
struct Loss {
    worst: f64,
}

impl Loss {
    fn none() -> Self {
        Self { worst: f64::NEG_INFINITY }
    }

    /// Adds a lower bound that was reduced by `allowance`.
    fn add(&mut self, bound: f32, exact: f64, allowance: f32) {
        assert!(f64::from(bound) <= exact, "{bound} is claimed of {exact}, less {allowance}");
        self.worst = self.worst.max((f64::from(bound) - exact) / f64::from(allowance) + 1.0);
    }

    /// Fails for allowances that are needlessly large.
    fn is_more_than(&self, share: f64) {
        assert!(self.worst > share, "{} of the allowance is lost at most", self.worst);
    }
}

/// Two trees of two different triangles each, as k-DOPs under their roots.
struct Pair {
    trees: [Tree; 2],
    pos12: Pose3,
}

impl Pair {
    /// Near each other, near the origin of their frames or far from it.
    fn random(random: &mut Random, i: usize) -> Self {
        let layers = LayerPlan { sphere_root: true, kdop_from_depth: Some(1) };
        let far = [0.0, 1.0, 30.0, 1.0e3][i % 4];
        let places = [(); 2].map(|()| random.vector(1.0) * far);
        let trees = places.map(|place| {
            let corner = |k: u32| place + 0.3 * random.vector(1.0) + Vec3::X * (k / 3) as f32;
            let corners = [0, 1, 2, 3, 4, 5].map(corner);
            let leaves = [[[0, 1, 2]; BATCH], [[3, 4, 5]; BATCH]];
            Tree::build(&corners, leaves.as_flattened(), Some(layers)).unwrap()
        });
        let scale = [1.0, 0.9, 1.2, 1.0][i / 4 % 4];
        let turn = random.rotation() * scale;
        let between = random.vector(2.0);
        let translation = places[0] - Pose3::from_rotation(turn) * places[1] + between;
        Self { trees, pos12: Pose3::from_parts(translation, turn) }
    }

    fn frame(&self, margin: f32) -> PairFrame {
        PairFrame::new((&self.trees[0], &self.trees[1]), Placement::new(&self.pos12), margin)
    }

    fn children(&self) -> [Children<'_>; 2] {
        let [one, two] = &self.trees;
        [one, two].map(|tree| tree.children(tree.link(Slot::ROOT).index()))
    }

    /// The children of both trees as a descent compares them.
    fn nodes(&self) -> NodeLanes<'_, Outer, Inner> {
        let [one, two] = self.children();
        NodeLanes::new((one, Outer), (two, Inner), 0b1111)
    }

    /// The corners of the triangles in a lane, in frame 1.
    fn corners(&self, lane: usize) -> [[DVec3; 3]; 2] {
        let placement = self.frame(0.0).placement;
        let [children1, children2] = self.children();
        let leaf = |tree: &Tree, children: &Children<'_>, child: usize| {
            tree.leaf(children.links[child].index()).corners(0)
        };
        [
            leaf(&self.trees[0], &children1, lane >> 1).map(Vec3::as_dvec3),
            leaf(&self.trees[1], &children2, lane & 1).map(|x| placement.to_frame1(x, Vec3::ZERO)),
        ]
    }

    /// The gaps of a lane in f64: boxes along the axes of frame 1 and frame 2, and k-DOPs along all
    /// slabs of tree 1.
    fn exact(&self, lane: usize) -> ([DVec3; 2], [f64; SLABS]) {
        let placement = self.frame(0.0).placement;
        let [children1, children2] = self.children();
        let read = |values: Intervals<'_, 3>, child: usize| {
            let extent = |i: usize| f64::from(f32::from(values.extent[i][child]));
            let centre = DVec3::from_array(each(|i| values.centre[i][child].into()));
            (centre, DVec3::from_array(each(extent)))
        };
        let ((c1, e1), (c2, e2)) =
            (read(children1.boxes, lane >> 1), read(children2.boxes, lane & 1));
        let offset = placement.rotation * c2 + (placement.translation - c1);
        let boxes = [
            offset.abs() - (e1 + placement.rotation.abs() * e2),
            (placement.inverse * offset).abs() - (e2 + placement.inverse.abs() * e1),
        ];
        let (kdops1, kdops2) = (children1.kdops.unwrap(), children2.kdops.unwrap());
        let slabs = std::array::from_fn(|slab| {
            let direction = directions::DIRECTIONS[slab].as_dvec3();
            let at = |kdops: Intervals<'_, SLABS>, slab: usize, child: usize| {
                let extent = f32::from(kdops.extent[slab][child]);
                (f64::from(kdops.centre[slab][child]), f64::from(extent))
            };
            let (centre, mut reach) = at(kdops1, slab, lane >> 1);
            let mut offset = direction.dot(placement.translation) - centre;
            let seen = placement.rotation.transpose() * direction;
            for (slab, coefficient) in directions::correspondence(seen) {
                let (centre, extent) = at(kdops2, slab, lane & 1);
                offset += coefficient * centre;
                reach += coefficient.abs() * extent;
            }
            (offset.abs() - reach) / direction.length()
        });
        (boxes, slabs)
    }
}

const PAIRS: usize = 4000;

/// Would catch a wrong sign, lane or frame, and boxes whose rounding is not allowed for.
#[test]
fn gaps_of_boxes_are_below_those_in_f64() {
    let mut losses = [Loss::none(), Loss::none()];
    let random = &mut Random(1);
    for i in 0..PAIRS {
        let pair = Pair::random(random, i);
        let (frame, nodes) = (pair.frame(0.7), pair.nodes());
        let rounding = frame.rounding.map(f32x4::splat);
        let in_frame1 = frame.along1(&nodes, rounding[0]);
        let in_frame2 = frame.along2(&nodes, in_frame1.offset, rounding[1]);
        for lane in 0..4 {
            let (exact, _) = pair.exact(lane);
            for (k, along) in [in_frame1, in_frame2].into_iter().enumerate() {
                for (axis, gap) in along.gaps().into_iter().enumerate() {
                    losses[k].add(gap.to_array()[lane], exact[k][axis], frame.rounding[k]);
                }
            }
        }
    }
    losses.iter().for_each(|loss| loss.is_more_than(0.03));
}

/// Would catch slabs whose rounding is not allowed for, and a direction of the wrong length.
#[test]
fn gaps_of_kdops_are_below_those_in_f64() {
    let mut loss = Loss::none();
    let random = &mut Random(2);
    for i in 0..PAIRS {
        let pair = Pair::random(random, i);
        let (mut frame, nodes) = (pair.frame(0.7), pair.nodes());
        let rounding = 6.0 * frame.rounding[0];
        let gaps = frame.correspondence().gaps(&nodes.kdops.unwrap(), 0).to_array();
        for lane in 0..4 {
            let (_, slabs) = pair.exact(lane);
            let exact = slabs.into_iter().fold(f64::NEG_INFINITY, f64::max);
            // The next test covers the difference and the length.
            let exact = exact + 1.0e-7 * exact.abs();
            loss.add(gaps[lane], exact, rounding);
        }
    }
    loss.is_more_than(0.02);
}

/// The bound of any gaps along axes, of any size. Would catch a norm that is too long in its last
/// digits, and one that is infinite.
#[test]
fn bounds_are_below_those_in_f64() {
    let random = &mut Random(3);
    let mut is_equal = 0;
    for i in 0..PAIRS {
        let size = [1.0, 1.0e-12, 1.0e12, 1.0e38][i % 4];
        let shift = [0.0, -0.5, -1.0][i % 3];
        let gaps = (random.vector(0.5) + Vec3::splat(0.5 + shift)) * size;
        let unit = random.range(0.5, 2.0);
        let [x, y, z] = gaps.to_array().map(f32x4::splat);
        let bound = Bound::of_axes([x, y, z], f32x4::splat(unit)).signed().to_array()[0];
        let (gaps, unit) = (gaps.as_dvec3(), f64::from(unit));
        let along = gaps.max_element();
        let exact = unit * if along > 0.0 { gaps.max(DVec3::ZERO).length() } else { along };
        assert!(f64::from(bound) <= exact, "{bound} of {exact}");
        let is_near = f64::from(bound) >= exact - 1.0e-6 * exact.abs();
        is_equal += u32::from(is_near);
        assert!(is_near || !(1.0e-11..=1.0e37).contains(&size), "{bound} of {exact}");
    }
    assert!(is_equal > 1000);
}

/// Would catch an overlap test whose margin lacks its rounding: nodes exactly the margin apart
/// meet.
#[test]
fn nodes_the_margin_apart_meet() {
    let random = &mut Random(4);
    let (mut by_boxes, mut by_slabs) = (0, 0);
    for i in 0..PAIRS {
        let pair = Pair::random(random, i);
        let nodes = pair.nodes();
        let unit2 = pair.frame(0.0).placement.rotation.x_axis.length();
        for lane in 0..4 {
            let (boxes, slabs) = pair.exact(lane);
            let box_gap = boxes[0].max_element().max(unit2 * boxes[1].max_element());
            let slab_gap = slabs[3..].iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let gap = box_gap.max(slab_gap);
            if gap <= 0.0 {
                continue;
            }
            let count = if box_gap > slab_gap { &mut by_boxes } else { &mut by_slabs };
            *count += 1;
            let mut frame = pair.frame((gap as f32).next_up());
            assert!(frame.boxes_meet(&nodes) >> lane & 1 != 0, "{gap}");
            let kdops = nodes.kdops.unwrap();
            let meeting = frame.correspondence().kdops_meet(&kdops, 0b1111);
            assert!(meeting >> lane & 1 != 0, "{gap}");
            assert!(frame.overlaps(&nodes).to_array()[lane] <= 0.0, "{gap}");
        }
    }
    assert!(by_boxes > 1000 && by_slabs > 1000, "{by_boxes} and {by_slabs}");
}

/// Would catch a wrong sign, slab, lane or frame, a rounding without allowance, and a useless
/// bound.
#[test]
fn bounds_are_below_those_of_corners_and_not_far_below() {
    let random = &mut Random(5);
    let mut losses = [(); 3].map(|()| Loss::none());
    let mut tightest = [f64::INFINITY; 4];
    for i in 0..PAIRS {
        let pair = Pair::random(random, i);
        let (mut frame, nodes) = (pair.frame(0.7), pair.nodes());
        let normal = random.vector(1.0).as_dvec3().normalize();
        let toward = Toward::new(&frame, normal, f64::INFINITY).unwrap();
        let [of_kdops, of_boxes] =
            [nodes.kdops, None].map(|kdops| toward.gaps(&NodeLanes { kdops, ..nodes }).to_array());
        let signed = frame.signed_gaps(&nodes).to_array();
        for lane in 0..4 {
            let [one, two] = pair.corners(lane);
            let ends = |corners: [DVec3; 3], end: fn(f64, f64) -> f64| {
                corners.map(|x| normal.dot(x)).into_iter().reduce(end).unwrap()
            };
            let between = ends(two, f64::min) - ends(one, f64::max);
            let [children1, children2] = pair.children();
            let leaves = toward.gap_of_leaves(
                pair.trees[0].leaf(children1.links[lane >> 1].index()),
                pair.trees[1].leaf(children2.links[lane & 1].index()),
            );
            let rounding = frame.rounding[0];
            losses[0].add(of_kdops[lane], between, 6.0 * rounding);
            losses[1].add(of_boxes[lane], between, 6.0 * rounding);
            losses[2].add(leaves, between, rounding);
            let corners = one.iter().flat_map(|&x| two.map(|y| x.distance(y)));
            let distance = corners.fold(f64::INFINITY, f64::min);
            assert!(f64::from(signed[lane]) <= distance);
            let along = [of_kdops[lane], of_boxes[lane], leaves].map(|bound| (bound, between));
            let shares = along.into_iter().chain([(signed[lane], distance)]);
            for (tightest, (bound, truth)) in tightest.iter_mut().zip(shares) {
                if truth > 0.1 {
                    *tightest = tightest.min((truth - f64::from(bound)) / truth);
                }
            }
        }
    }
    losses[2].is_more_than(0.03);
    let [of_kdops, of_boxes, leaves, signed] = tightest;
    let is_tight = of_kdops < 0.05 && of_boxes < 0.05 && leaves < 1.0e-4 && signed < 0.05;
    assert!(is_tight, "{tightest:?}");
}

/// Would catch projections that overflow, of which nothing follows.
#[test]
fn there_is_no_direction_where_projections_may_overflow() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|corner| 2.0e38 * corner);
    let tree = Tree::build(&corners, &[[0, 1, 2]], None).unwrap();
    let frame = PairFrame::new((&tree, &tree), Placement::new(&Pose3::IDENTITY), 0.0);
    assert!(Toward::new(&frame, DVec3::X, 1.0).is_none());
}
