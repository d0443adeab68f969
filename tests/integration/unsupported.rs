use crate::prelude::*;
use crate::who_answers::kinds;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A ball with one vertex that is not a number.
fn broken_ball() -> TriMesh {
    let mut ball = mesh::ball(1.0, 4);
    let lowest = (0..ball.vertices.len())
        .min_by(|&i, &j| ball.vertices[i].y.total_cmp(&ball.vertices[j].y))
        .unwrap();
    ball.vertices[lowest].x = Real::NAN;
    shape(&ball)
}

#[test]
fn a_nan_vertex_is_an_error_of_prepare_and_leaves_the_other_triangles() {
    let dispatcher = SbbkDispatcher::default();
    let (broken, whole) = (broken_ball(), shape(&mesh::ball(1.0, 4)));
    let reason = dispatcher.prepare(&broken).unwrap_err().to_string();
    for part in ["cannot prepare", "vertex", "is not finite", "NaN", "repair"] {
        assert!(reason.contains(part), "{reason}");
    }
    assert!(dispatcher.prepare(&whole).is_ok());
    // The lowest vertex of the lower ball is out of the way.
    let question = Question::new(&broken, &whole, Pose::translation(0.1, 1.9, 0.05));
    for question in [question, question.flipped(true)] {
        let found = question.fresh(&dispatcher);
        assert!(found.iter().any(|manifold| !manifold.points.is_empty()));
    }
    assert_eq!(dispatcher.stats().unsupported_queries, 0);
}

#[test]
fn a_deformable_mesh_is_an_error_of_prepare() {
    let soft = mesh::ball(1.0, 4).trimesh(TriMeshFlags::DEFORMABLE);
    let reason = SbbkDispatcher::default().prepare(&soft).unwrap_err().to_string();
    assert!(reason.contains("`DEFORMABLE`"), "{reason}");
}

/// Meshes without a finite coordinate along some axes.
fn endless_meshes() -> Vec<TriMesh> {
    let ball = shape(&mesh::ball(1.0, 4));
    let (nan, inf) = (Real::NAN, Real::INFINITY);
    let changes: [&dyn Fn(Vector) -> Vector; 6] = [
        &|_| Vector::splat(nan),
        &|v| Vector::new(nan, v.y, v.z),
        &|_| Vector::splat(inf),
        &|_| Vector::splat(-inf),
        &|v| v.signum() * inf,
        &|v| Vector::new(v.x, v.y.signum() * inf, v.z),
    ];
    changes
        .iter()
        .map(|change| {
            let vertices = ball.vertices().iter().map(|&vertex| change(vertex)).collect();
            TriMesh::new(vertices, ball.indices().to_vec()).expect("Parry takes any numbers")
        })
        .collect()
}

/// Would catch a panic over the box of such a mesh, and results that are not stock's or not
/// counted.
#[test]
fn a_mesh_without_a_finite_box_is_answered_by_stock_and_counted() {
    let whole = shape(&mesh::ball(1.0, 4));
    let pos12 = Pose::translation(0.1, 0.6, 0.05);
    let mut answered = 0;
    for (name, other, by_sbbk) in kinds() {
        for (number, endless) in endless_meshes().iter().enumerate() {
            for is_first in [true, false] {
                let dispatcher = SbbkDispatcher::default();
                let ask = |d: &dyn PersistentQueryDispatcher, mesh: &TriMesh, pair: &mut Pair| {
                    let shapes: [&dyn Shape; 2] =
                        if is_first { [mesh, &*other] } else { [&*other, mesh] };
                    let Pair { manifolds, workspace } = pair;
                    d.contact_manifolds(&pos12, shapes[0], shapes[1], 0.02, manifolds, workspace)
                        .map_err(|_| "unsupported")
                };
                let case = format!("{name}, mesh {number}, first: {is_first}");
                let mut pairs: [Pair; 2] = Default::default();
                let is_answered = catch_unwind(AssertUnwindSafe(|| {
                    let mut pair = Pair::default();
                    (0..2).for_each(|_| _ = ask(&DefaultQueryDispatcher, endless, &mut pair));
                }))
                .is_ok();
                answered += usize::from(is_answered);
                if !is_answered {
                    // Parry answers or panics as without SBBK.
                    continue;
                }
                for repeat in 1..3 {
                    let [ours, stocks] = &mut pairs;
                    let expected = ask(&DefaultQueryDispatcher, endless, stocks);
                    assert_eq!(ask(&dispatcher, endless, ours), expected, "{case}");
                    let [ours, stocks] = pairs.each_ref().map(|p| format!("{:?}", p.manifolds));
                    assert_eq!(ours, stocks, "{case}");
                    let count = if by_sbbk { repeat } else { 0 };
                    assert_eq!(dispatcher.stats().unsupported_queries, count, "{case}");
                }
                let mut pair: Pair = Pair::default();
                for mesh in [&whole, endless, endless, &whole] {
                    let _ = ask(&dispatcher, mesh, &mut pair);
                }
                let count = if by_sbbk { 4 } else { 0 };
                assert_eq!(dispatcher.stats().unsupported_queries, count, "{case}");
                let mut first: Pair = Pair::default();
                let _ = ask(&dispatcher, &whole, &mut first);
                let [again, first] = [&pair, &first].map(|pair| pair.manifolds.len());
                assert_eq!(again, first, "{case}: whole again");
            }
        }
    }
    assert!(answered > 200, "stock answers {answered} cases only");
}
