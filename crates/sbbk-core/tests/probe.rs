//! One tree against a convex shape, by brute force: never a triangle lost, no bound of distance too
//! high.

mod support;

use std::collections::BTreeMap;

use glamx::{DVec3, Pose3, Quat, Vec3};
use sbbk_core::leaf::ProbeTest;
use sbbk_core::traverse::{
    Convex, DescentCounts, Outline, Placement, Probe, ProbeScratch, Verdict, descend_probe,
};
use sbbk_core::tree::{BuildOptions, LayerPlan, Tree};
use sbbk_core::truth;
use sbbk_core::volumes::{DirectionSet, Directions};
use support::{Random, Soup, bumpy_ball, lattice_soup, soup};

/// All points within a radius of a segment along y: a ball if it has no length.
struct Round {
    half_length: f64,
    radius: f64,
}

impl Convex for Round {
    fn reach(&self, direction: DVec3) -> f64 {
        direction.y.abs() * self.half_length + direction.length() * self.radius
    }

    fn outline(&self) -> Outline {
        Outline::RoundBox {
            centre: DVec3::ZERO,
            half_lengths: DVec3::new(0.0, self.half_length, 0.0),
            radius: self.radius,
            is_exact: true,
        }
    }
}

struct HalfSpace(DVec3);

impl Convex for HalfSpace {
    fn reach(&self, direction: DVec3) -> f64 {
        if direction == self.0 { 0.0 } else { f64::INFINITY }
    }

    fn outline(&self) -> Outline {
        Outline::HalfSpace { normal: self.0 }
    }
}

/// Distance and axis of each triangle that the descent and the leaf test leave. `pose` is that of
/// the mesh in the shape's frame.
fn near<S: Convex, const AXES: usize>(
    tree: &Tree<AXES>,
    pose: &Pose3,
    shape: &S,
    margin: f64,
) -> (BTreeMap<u32, (f64, DVec3)>, DescentCounts)
where
    Directions<AXES>: DirectionSet<AXES>,
{
    let mut probe = Probe::new(tree, &Placement::new(pose), shape, margin);
    let test = ProbeTest::new(&probe);
    let mut counts = DescentCounts::default();
    let mut found = BTreeMap::new();
    descend_probe(tree, &mut probe, &mut ProbeScratch::default(), &mut counts, |batch| {
        test.survivors(batch, |lane, distance, axis| {
            let new = found.insert(batch.triangles()[lane], (distance, axis.as_dvec3()));
            assert!(new.is_none(), "a triangle was visited twice");
        });
        Verdict::Descend
    });
    (found, counts)
}

fn placed(soup: &Soup, pose: &Pose3) -> Vec<[DVec3; 3]> {
    let placement = Placement::new(pose);
    let corner = |i: u32| placement.to_frame1(soup.vertices[i as usize], Vec3::ZERO);
    soup.triangles.iter().map(|triangle| triangle.map(corner)).collect()
}

/// Compares with the true distances of all triangles to a shape; how many were found and how many
/// were not but for the margin. `truth` is negative, by any amount, where they overlap.
fn check<S: Convex, const AXES: usize>(
    soup: &Soup,
    pose: &Pose3,
    shape: &S,
    margin: f64,
    truth: impl Fn(&[DVec3; 3]) -> f64,
) -> [usize; 2]
where
    Directions<AXES>: DirectionSet<AXES>,
{
    let layers = LayerPlan { kdop_from_depth: Some(2), ..LayerPlan::SBBK };
    let options = BuildOptions { layers, ..BuildOptions::default() };
    let tree = Tree::<AXES>::build(&soup.vertices, &soup.triangles, &options).unwrap();
    let (found, counts) = near(&tree, pose, shape, margin);
    assert!(counts.aabb_tests > 0);
    for (index, corners) in placed(soup, pose).iter().enumerate() {
        let distance = truth(corners);
        let Some(&(bound, axis)) = found.get(&(index as u32)) else {
            assert!(distance > margin, "triangle {index} at {distance} is lost");
            continue;
        };
        assert!(bound <= margin, "triangle {index} is beyond the margin by {bound}");
        assert!(bound <= distance.max(0.0), "triangle {index}: bound {bound} of {distance}");
        if bound > 0.0 {
            let lowest = corners.iter().map(|x| axis.dot(*x)).fold(f64::INFINITY, f64::min);
            let gap = (lowest - shape.reach(axis)) / axis.length();
            assert!(gap >= bound, "triangle {index}: {gap} along the axis, not {bound}");
        }
    }
    [found.len(), soup.triangles.len() - found.len()]
}

/// Distance of a triangle to a segment, as a triangle without area.
fn to_segment(corners: &[DVec3; 3], half_length: f64) -> f64 {
    let end = DVec3::new(0.0, half_length, 0.0);
    truth::contact(&[end, -end, -end], corners).distance
}

fn meshes(random: &mut Random) -> Vec<Soup> {
    let mut tiny = bumpy_ball(6, 0.2);
    tiny.vertices.iter_mut().for_each(|v| *v *= 1e-4);
    let mut distant = bumpy_ball(6, 0.1);
    distant.vertices.iter_mut().for_each(|v| *v += Vec3::new(300.0, -20.0, 5.0));
    vec![
        bumpy_ball(8, 0.2),
        tiny,
        distant,
        soup(random, 60, 0.4),
        lattice_soup(random, 60, 4),
        Soup { vertices: vec![Vec3::ZERO; 3], triangles: vec![[0, 1, 2]] },
    ]
}

/// A pose at which a vertex of the mesh is near the origin of the shape's frame.
fn pose(random: &mut Random, soup: &Soup, away: f32) -> Pose3 {
    let turn = random.rotation();
    let vertex = soup.vertices[(random.bits() % soup.vertices.len() as u64) as usize];
    Pose3::from_parts(random.vector(away) - turn * vertex, turn)
}

/// Largest coordinate, for sizes and margins.
fn size(soup: &Soup) -> f32 {
    let low = soup.vertices.iter().fold(Vec3::INFINITY, |low, &x| low.min(x));
    let high = soup.vertices.iter().fold(Vec3::NEG_INFINITY, |high, &x| high.max(x));
    (high - low).max_element().max(1e-3)
}

fn check_all<const AXES: usize>(seed: u64)
where
    Directions<AXES>: DirectionSet<AXES>,
{
    let mut random = Random(seed);
    let (mut found, mut dropped) = (0, 0);
    let mut add = |[near, far]: [usize; 2]| {
        found += near;
        dropped += far;
    };
    for _ in 0..30 {
        for soup in meshes(&mut random) {
            let size = size(&soup);
            let pose = pose(&mut random, &soup, 0.5 * size);
            let margin = f64::from(size * [0.0, 0.02, 0.3][(random.bits() % 3) as usize]);
            let radius = f64::from(size * random.range(0.0, 0.4));
            for half_length in [0.0, f64::from(0.3 * size)] {
                let shape = Round { half_length, radius };
                let truth = |corners: &_| to_segment(corners, half_length) - radius;
                add(check::<_, AXES>(&soup, &pose, &shape, margin, truth));
            }
            let hull = [(); 3].map(|()| random.vector(0.4 * size));
            let truth = |corners: &_| truth::contact(&hull.map(Vec3::as_dvec3), corners).distance;
            add(check::<_, AXES>(&soup, &pose, &hull, margin, truth));
            let normal = Vec3::new(0.48, -0.6, 0.64).as_dvec3();
            let truth = |corners: &[DVec3; 3]| {
                corners.iter().map(|x| normal.dot(*x)).fold(f64::INFINITY, f64::min)
            };
            add(check::<_, AXES>(&soup, &pose, &HalfSpace(normal), margin, truth));
        }
    }
    assert!(found > 2000 && dropped > 2000, "{found} found, {dropped} dropped");
}

/// Would catch a rounding bound that is forgotten, an interval with the wrong sign, a k-DOP slab of
/// another direction, a distance that is not a lower bound, and an axis that does not show it.
#[test]
fn no_triangle_is_lost_and_no_bound_is_too_high() {
    check_all::<7>(1);
    check_all::<9>(2);
    check_all::<13>(3);
}

/// Would catch a test of balls that is one of boxes: the distance to a ball is exact.
#[test]
fn distances_to_balls_are_exact() {
    let mut random = Random(4);
    let mesh = bumpy_ball(8, 0.2);
    let tree: Tree =
        Tree::build(&mesh.vertices, &mesh.triangles, &BuildOptions::default()).unwrap();
    let mut checked = 0;
    for _ in 0..50 {
        let pose = random.pose(1.5);
        let ball = Round { half_length: 0.0, radius: 0.3 };
        let (found, _) = near(&tree, &pose, &ball, 0.2);
        let placed = placed(&mesh, &pose);
        for (triangle, (bound, _)) in found {
            let distance = to_segment(&placed[triangle as usize], 0.0) - 0.3;
            assert!((distance - bound).abs() < 1e-4, "{bound} of {distance}");
            checked += 1;
        }
    }
    assert!(checked > 200, "{checked} distances");
}

/// Would catch a descent that tests a turned floor on the axes of the tree only: it then visits
/// every leaf.
#[test]
fn a_large_turned_floor_is_met_where_it_is() {
    let mesh = bumpy_ball(20, 0.1);
    let tree: Tree =
        Tree::build(&mesh.vertices, &mesh.triangles, &BuildOptions::default()).unwrap();
    let floor =
        [-50.0, 50.0].map(|x| [-50.0, 50.0].map(|z| [-0.5, 0.0].map(|y| Vec3::new(x, y, z))));
    let floor: [Vec3; 8] = std::array::from_fn(|i| floor[i & 1][i >> 1 & 1][i >> 2]);
    let turn = Quat::from_xyzw(0.5, 0.3, -0.4, 0.7).normalize();
    let pose = Pose3::from_parts(Vec3::new(20.0, 1.0, -13.0), turn);
    let (found, counts) = near(&tree, &pose, &floor, 0.02);
    assert!(!found.is_empty());
    assert!(counts.leaf_pairs < u64::from(tree.leaf_count()) / 8, "{counts:?}");
}

/// Would catch a panic, an endless loop, or contacts at poses that are none.
#[test]
fn poses_that_are_none_meet_nothing() {
    let mesh = bumpy_ball(6, 0.2);
    let tree: Tree =
        Tree::build(&mesh.vertices, &mesh.triangles, &BuildOptions::default()).unwrap();
    let ball = Round { half_length: 0.0, radius: 1.0 };
    for broken in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let shift = Pose3::from_parts(Vec3::new(0.0, broken, 0.0), Quat::IDENTITY);
        let turn = Pose3::from_parts(Vec3::ZERO, Quat::from_xyzw(broken, 0.0, 0.0, 1.0));
        for pose in [shift, turn] {
            assert_eq!(near(&tree, &pose, &ball, 0.1).0.len(), 0, "{pose:?}");
        }
    }
    assert_eq!(near(&tree, &Pose3::IDENTITY, &ball, f64::NAN).0.len(), 0);
}
