//! Lines of volumes: all edges, each once, on the boundary, and around all that the volume holds.

use crate::prelude::*;
use sbbk_core::draw;
use sbbk_core::draw::{BOX, KDOP, SPHERE};

fn lines(draw: impl FnOnce(&mut dyn FnMut(Vec3, Vec3))) -> Vec<[Vec3; 2]> {
    let mut lines = Vec::new();
    draw(&mut |a, b| lines.push([a, b]));
    lines
}

fn kdop_lines(kdop: &Kdop) -> Vec<[Vec3; 2]> {
    lines(|line| draw::kdop(kdop, line))
}

/// Distance of a point outside a k-DOP, in units of its coordinates; negative inside.
fn outside(kdop: &Kdop, point: Vec3) -> f64 {
    let slabs = directions::DIRECTIONS;
    let ends = slabs.iter().zip(kdop.min.iter().zip(&kdop.max));
    ends.map(|(direction, (&min, &max))| {
        let x = direction.as_dvec3().dot(point.as_dvec3());
        (f64::from(min) - x).max(x - f64::from(max))
    })
    .fold(f64::NEG_INFINITY, f64::max)
}

/// Clouds of points near and far from the origin. Would catch a lost or misplaced edge.
#[test]
fn kdops_of_clouds_are_drawn_whole() {
    let mut random = Random(5);
    for case in 0..40 {
        let centre = random.vector(if case % 2 == 0 { 1.0 } else { 300.0 });
        let points: Vec<Vec3> = (0..30).map(|_| centre + random.vector(1.0)).collect();
        let kdop = kdop(&points);
        let lines = kdop_lines(&kdop);
        let magnitude = f64::from(centre.abs().max_element() + 1.0);
        for point in lines.iter().flatten() {
            assert!(outside(&kdop, *point).abs() < 1e-6 * magnitude, "{point} is off the boundary");
        }
        for _ in 0..200 {
            let direction = random.vector(1.0);
            let reach = |points: &mut dyn Iterator<Item = Vec3>| {
                points.map(|p| direction.dot(p - centre)).fold(f32::NEG_INFINITY, f32::max)
            };
            let (drawn, held) =
                (reach(&mut lines.iter().flatten().copied()), reach(&mut points.iter().copied()));
            assert!(drawn >= held - 1e-6 * magnitude as f32, "{drawn} does not reach {held}");
        }
    }
}

/// Near the regular body with slabs in general position, where three edges meet at each corner. By
/// Euler's formula, would catch a lost or doubled edge.
#[test]
fn kdops_near_the_regular_one_have_all_edges_once() {
    let mut random = Random(6);
    let slabs = directions::DIRECTIONS;
    for _ in 0..40 {
        let mut end = |axis: usize| slabs[axis].length() * random.range(1.0, 1.1);
        let max = std::array::from_fn(&mut end);
        let min = std::array::from_fn(|axis| -end(axis));
        let lines = kdop_lines(&Kdop { min, max });
        let mut corners: Vec<Vec3> = Vec::new();
        for end in lines.iter().flatten() {
            if !corners.iter().any(|corner| corner.distance(*end) < 1e-6) {
                corners.push(*end);
            }
        }
        assert_eq!(2 * lines.len(), 3 * corners.len());
        assert_eq!(lines.len() + 2 - corners.len(), 2 * SLABS, "faces");
    }
}

/// Bodies whose edges are known, with planes that touch in edges and corners only.
#[test]
fn known_polytopes_have_their_number_of_edges() {
    let ends =
        |face: f32, edge: f32| std::array::from_fn(|axis| if axis < 3 { face } else { edge });
    let symmetric = |face: f32, edge: f32| Kdop { min: ends(-face, -edge), max: ends(face, edge) };
    // Cube, chamfered cube, rhombic dodecahedron. Planes touch whole edges of the cube.
    for (kdop, count) in [(symmetric(1.0, 2.0), 12), (symmetric(1.0, 1.5), 48)] {
        assert_eq!(kdop_lines(&kdop).len(), count);
    }
    assert_eq!(kdop_lines(&symmetric(1.0, 1.0)).len(), 24);
    let flat = Aabb { min: Vec3::new(-1.0, 0.0, -1.0), max: Vec3::new(1.0, 0.0, 1.0) };
    assert_eq!(lines(|line| draw::aabb(&flat, line)).len(), 4);
    let empty = Aabb { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };
    assert!(lines(|line| draw::aabb(&empty, line)).is_empty());
    assert!(kdop_lines(&Kdop::EMPTY).is_empty());
    assert!(lines(|line| draw::sphere(&Sphere::fit(&[]), line)).is_empty());
}

#[test]
fn lines_of_a_sphere_are_on_it() {
    let ball = Sphere { centre: Vec3::new(1.0, 2.0, 3.0), radius: 0.5 };
    let lines = lines(|line| draw::sphere(&ball, line));
    assert!(lines.len() > 30);
    for point in lines.iter().flatten() {
        assert!((point.distance(ball.centre) - 0.5).abs() < 1e-5);
    }
}

/// The volumes of every layer reach as far as the mesh in every direction, at its pose, each kind
/// where the plan has it.
#[test]
fn layers_hold_the_mesh() {
    let ball = bumpy_ball(12, 0.2);
    let tree = ball.tree(LayerPlan { sphere_root: true, kdop_from_depth: Some(3) });
    let mut random = Random(9);
    for depth in 0..=tree.stats().depth {
        let pose: Pose3 = random.pose(3.0);
        let mut lines = Vec::new();
        draw::layer(&tree, depth, &pose, |a, b, colour| lines.push((a, b, colour)));
        let kinds = [(0..=0, SPHERE), (1..=2, BOX), (3..=u32::MAX, KDOP)];
        let (_, colour) = kinds.iter().find(|(depths, _)| depths.contains(&depth)).unwrap();
        assert!(lines.iter().all(|line| line.2 == *colour), "depth {depth}");
        // Circles reach farther than the mesh along the axes of the mesh only.
        let directions: Vec<Vec3> = match depth {
            0 => vec![Vec3::X, Vec3::Y, Vec3::Z],
            _ => (0..50).map(|_| random.vector(1.0)).collect(),
        };
        for direction in directions.into_iter().map(|direction| pose.rotation * direction) {
            let drawn = lines.iter().flat_map(|&(a, b, _)| [a, b]).map(|p| direction.dot(p));
            let held = ball.vertices.iter().map(|&v| direction.dot(pose * v));
            let [drawn, held] =
                [drawn.fold(f32::NEG_INFINITY, f32::max), held.fold(f32::NEG_INFINITY, f32::max)];
            assert!(drawn > held - 1e-5, "depth {depth}: {drawn} does not reach {held}");
        }
    }
}

/// Would catch candidates that are lost, of the wrong mesh or at the wrong pose.
#[test]
fn candidates_are_near_the_contact() {
    let ball = bumpy_ball(12, 0.0);
    let tree = ball.tree(None);
    let mut random = Random(10);
    for _ in 0..20 {
        let pose1: Pose3 = random.pose(3.0);
        let way = random.vector(1.0).normalize();
        let pose2 = Pose3::from_translation(1.95 * way) * pose1;
        let mut lines = Vec::new();
        let line = |a, b, colour| lines.push((a, b, colour));
        draw::candidates((&tree, &tree), [&pose1, &pose2], 0.1, line);
        for colour in draw::CANDIDATES {
            let of = lines.iter().filter(|line| line.2 == colour);
            assert!(of.clone().count() > 0 && of.count() < 3 * ball.triangles.len() / 3);
        }
        let middle = pose1.translation + 0.975 * way;
        for &(a, b, colour) in &lines {
            assert!(a.distance(middle) < 0.9 && b.distance(middle) < 0.9, "{a} {b} {middle}");
            let pose = if colour == draw::CANDIDATES[0] { &pose1 } else { &pose2 };
            assert!((a.distance(pose.translation) - 1.0).abs() < 1e-4);
        }
    }
    let far = Pose3::translation(2.1, 0.0, 0.0);
    draw::candidates((&tree, &tree), [&Pose3::IDENTITY, &far], 0.02, |_, _, _| unreachable!());
}
