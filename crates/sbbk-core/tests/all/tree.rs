//! Trees hold each triangle once in valid volumes, and builds report faults of the input.

use crate::prelude::*;
use sbbk_core::tree::{BuildError, BuildStats};

/// Builds a tree and walks over all its nodes. Would catch a triangle that is lost or in two
/// leaves, and a volume of the wrong layer or with something outside. Also catches nodes out of
/// reach.
pub fn check(soup: &Soup, plan: Option<LayerPlan>) -> Tree {
    let tree = soup.tree(plan);
    assert_eq!(tree.triangle_count() as usize, soup.triangles.len());
    let BuildStats { depth, layers, bytes, .. } = *tree.stats();
    assert_eq!(tree.sphere().is_some(), layers.sphere_root);
    let is_kdop = |depth: u32| layers.kdop_from_depth.is_some_and(|from| depth >= from);
    let mut is_found = vec![false; soup.triangles.len()];
    // The box of the root has a pair of its own.
    let (mut leaves, mut pairs, mut deepest) = (0, [1, 0], 0);
    let mut stack = vec![vec![tree.root()]];
    while let Some(path) = stack.pop() {
        let node = path[path.len() - 1];
        assert_eq!(node.depth() as usize + 1, path.len());
        assert_eq!(node.kdop().is_some(), is_kdop(node.depth()));
        deepest = deepest.max(node.depth());
        if let Some(children) = node.children() {
            assert!(node.leaf().is_none());
            pairs[usize::from(is_kdop(node.depth() + 1))] += 1;
            stack.extend(children.map(|child| [&path[..], &[child]].concat()));
            continue;
        }
        leaves += 1;
        let leaf = node.leaf().expect("no children");
        assert!((1..=BATCH).contains(&leaf.count()));
        for (lane, &triangle) in leaf.triangles().iter().enumerate() {
            assert!(!std::mem::replace(&mut is_found[triangle as usize], true), "found twice");
            let corners = soup.triangles[triangle as usize].map(|v| soup.vertices[v as usize]);
            assert_eq!(leaf.corners(lane), corners, "the leaf holds another triangle");
            for corner in corners {
                let is_around = |node: &Node| {
                    let Aabb { min, max } = node.aabb();
                    corner.cmpge(min).all()
                        && corner.cmple(max).all()
                        && node.kdop().is_none_or(|k| k.contains(corner))
                };
                assert!(path.iter().all(is_around), "{triangle} is outside");
                assert!(tree.sphere().is_none_or(|ball| ball.contains(corner)));
            }
        }
    }
    assert!(is_found.iter().all(|&is_found| is_found));
    assert_eq!(deepest, depth);
    // A pair of boxes has 44 bytes, a pair of k-DOPs 116, a leaf 160.
    assert_eq!(bytes, 44 * pairs[0] + 116 * pairs[1] + 160 * leaves);
    tree
}

/// Each size from one triangle up, so that every shape of small tree occurs.
#[test]
fn trees_of_all_small_sizes_are_valid() {
    let mut random = Random(21);
    for count in 1..=280 {
        let soup = soup(&mut random, count, 0.3);
        let kdop_from_depth = Some(1 + count % 5);
        check(&soup, Some(LayerPlan { sphere_root: true, kdop_from_depth }));
        check(&soup, Some(LayerPlan { sphere_root: true, kdop_from_depth: None }));
    }
}

#[test]
fn large_tree_is_valid_and_shallow() {
    let ball = bumpy_ball(60, 0.1);
    let tree = check(&ball, None);
    assert!(ball.triangles.len() > 14_000 && tree.stats().depth < 25, "{:?}", tree.stats());
}

/// Would catch widths of other slabs, nodes that are not weighed, and a choice that depends on size
/// or place.
#[test]
fn flat_meshes_along_the_axes_get_boxes_and_others_kdops() {
    let floor = |cells: u32| {
        let mut floor = cube(cells);
        floor.triangles.truncate(2 * (cells * cells) as usize);
        floor
    };
    let turned = |mut soup: Soup| {
        let turn = Quat::from_rotation_x(0.3) * Quat::from_rotation_y(0.4);
        soup.vertices.iter_mut().for_each(|vertex| *vertex = turn * *vertex);
        soup
    };
    for (soup, cut, kdop_from_depth) in [
        (floor(30), -0.001..0.001, None),
        (cube(5), 0.01..0.03, None),
        (cube(20), 0.01..0.03, None),
        (turned(floor(30)), 0.1..0.2, Some(4)),
        (turned(cube(5)), 0.1..0.2, Some(4)),
        (turned(cube(2)), 0.1..0.2, Some(3)),
        (bumpy_ball(30, 0.2), 0.1..0.3, Some(4)),
    ] {
        for (size, place) in [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 100.0)] {
            let vertices = soup.vertices.iter().map(|v| size * *v + Vec3::splat(place)).collect();
            let soup = Soup { vertices, triangles: soup.triangles.clone() };
            let stats = *check(&soup, None).stats();
            let found = stats.kdop_cut.expect("no plan was given");
            assert!(cut.contains(&found), "{found} is not in {cut:?}");
            assert_eq!(stats.layers, LayerPlan { sphere_root: true, kdop_from_depth });
        }
    }
}

#[test]
fn a_chosen_tree_is_the_tree_of_its_plan() {
    let mut random = Random(24);
    for soup in [cube(7), bumpy_ball(9, 0.1), soup(&mut random, 300, 0.1)] {
        let chosen = check(&soup, None);
        let again = check(&soup, None);
        assert_eq!(format!("{chosen:?}"), format!("{again:?}"));
        let layers = Some(chosen.stats().layers);
        let told = check(&soup, layers);
        assert_eq!(told.stats().kdop_cut, None);
        let mut expected = *told.stats();
        expected.kdop_cut = chosen.stats().kdop_cut;
        assert_eq!(*chosen.stats(), expected);
    }
}

/// Boxes have no area here, or an infinite one.
#[test]
fn meshes_without_finite_area_get_boxes() {
    for size in [0.0, 3e38] {
        let corner = |i: u32| size * Vec3::new(i as f32 / 300.0, 0.0, (i % 2) as f32);
        let tree = check(&Soup::apart((0..300).map(corner)), None);
        assert_eq!(tree.stats().layers.kdop_from_depth, None, "{:?}", tree.stats().kdop_cut);
    }
}

/// Equal centroids cannot be separated by a plane: halving keeps the depth logarithmic.
#[test]
fn equal_triangles_make_a_balanced_tree() {
    let soup =
        Soup { vertices: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]; 4096] };
    assert_eq!(check(&soup, None).stats().depth, 10);
}

/// Would catch splits by cost that take one triangle from the rest, level after level.
#[test]
fn trees_are_never_deep() {
    let chain = |count: u32, factor: f64, axes: u32, width: f64| {
        let corner = |i: u32, k: u32| {
            // Towards zero from below: the first bin with anything in it has one triangle.
            let size = factor.powi((i / axes) as i32) * 1e38;
            let mut corner = Vec3::ZERO;
            corner[(i % axes) as usize] = -size as f32;
            corner[((i + k) % 3) as usize] += (width * f64::from(k) * size) as f32;
            corner
        };
        Soup::apart((0..count).flat_map(|i| [0, 1, 2].map(|k| corner(i, k))))
    };
    let mut deepest = 0;
    for (factor, axes, width) in [
        (0.94, 1, 0.0),
        (0.94, 1, 1e-3),
        (0.94, 3, 1e-3),
        (0.97, 3, 0.0),
        (0.5, 2, 0.0),
        (0.5, 1, 0.1),
        (0.999, 1, 0.0),
    ] {
        let soup = chain(3000, factor, axes, width);
        let depth = check(&soup, Some(LayerPlan::SBBK)).stats().depth;
        assert!(depth <= 64 + 12, "{depth} levels: {factor} {axes} {width}");
        deepest = deepest.max(depth);
    }
    assert!(deepest > 64, "no chain needs the bound: {deepest}");
}

/// The vertices are the corners of the root's box, with no room to spare. Would catch a rounding of
/// length or centre that is not given back, near the origin and far from it.
#[test]
fn the_ball_around_a_box_holds_its_corners() {
    let mut random = Random(23);
    for round in 0..2000 {
        let far = [0.0, 1.0, 1e3, 1e6][round % 4];
        let (centre, half) =
            (random.vector(far), random.vector(if round % 3 == 0 { 1.0 } else { 0.1 }));
        let vertices: Vec<Vec3> = (0..8)
            .map(|i| {
                let sign = |bit: u32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
                centre + half * Vec3::new(sign(0), sign(1), sign(2))
            })
            .collect();
        let triangles = (0..6).map(|i| [i, i + 1, i + 2]).collect();
        let soup = Soup { vertices, triangles };
        let layers = Some(LayerPlan::AABB_ONLY);
        let ball = check(&soup, layers).bounding_ball();
        for vertex in soup.vertices {
            let distance = (vertex.as_dvec3() - ball.centre.as_dvec3()).length();
            assert!(distance <= f64::from(ball.radius), "{vertex} is outside of {ball:?}");
        }
    }
}

/// A vertex that no triangle uses widens no volume.
#[test]
fn unused_vertices_do_not_count() {
    let mut ball = bumpy_ball(6, 0.1);
    let radius = |ball: &Soup| check(ball, None).sphere().unwrap().radius;
    // The ball's own unused vertices, at the poles, are in its place.
    let before = radius(&ball);
    ball.vertices.push(Vec3::splat(100.0));
    assert_eq!(radius(&ball), before);
}

/// Zero area, zero extent, lattice ties, and coordinates of very different size are all kept.
#[test]
fn degenerate_triangles_are_kept() {
    let mut random = Random(22);
    let mut soup = lattice_soup(&mut random, 200, 2);
    soup.triangles.push([0, 0, 0]);
    soup.triangles.push([0, 1, 0]);
    check(&soup, None);
    for vertex in &mut soup.vertices {
        *vertex *= random.range(0.0, 1.0).powi(40) * 1e5;
    }
    check(&soup, None);
}

#[test]
fn faults_are_reported_with_their_place() {
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.0, f32::NAN, 0.0)];
    let build = |triangles: &[[u32; 3]]| Tree::build(&vertices, triangles, None).err();
    assert_eq!(build(&[]), Some(BuildError::NoTriangles));
    assert_eq!(
        build(&[[0, 1, 2], [0, 4, 2]]),
        Some(BuildError::IndexOutOfRange { triangle: 1, vertex: 4, vertex_count: 4 })
    );
    let nan = build(&[[0, 1, 3]]).expect("a NaN vertex");
    assert!(matches!(nan, BuildError::NotFinite { vertex: 3, .. }));
    assert_eq!(nan.to_string(), "vertex 3 is not finite: (0, NaN, 0)");
    let plan = LayerPlan { kdop_from_depth: Some(0), ..LayerPlan::SBBK };
    let kdop_at_root = Tree::build(&vertices, &[[0, 1, 2]], Some(plan)).err();
    assert_eq!(kdop_at_root, Some(BuildError::KdopAtRoot));
    // A bad vertex that no triangle uses does no harm.
    assert_eq!(build(&[[0, 1, 2]]), None);
}
