use crate::convex::shapes::shapes;
use crate::heightfield::terrain::rolling;
use crate::prelude::*;
use rapier_integration::SbbkConfig;
use rapier3d::control::KinematicCharacterController;
use rapier3d::parry::shape::{Polyline, PolylineFlags};
use rapier3d::pipeline::QueryFilter;

/// Shapes that a mesh can meet. True if SBBK computes their contacts, false if Parry does.
pub fn kinds() -> Vec<(&'static str, SharedShape, bool)> {
    let ball = mesh::ball(0.7, 3);
    let field = SharedShape::new(rolling(4.0, 4, 0.1));
    let part = |shape: SharedShape| vec![(Pose::translation(0.1, 0.0, 0.0), shape)];
    let soft = ball.trimesh(TriMeshFlags::DEFORMABLE);
    // The whole pair is stock's, not half of it.
    let with_field = [part(field.clone()), part(SharedShape::ball(0.5))].concat();
    let line = vec![-Vec3::X, Vec3::X, Vec3::Y];
    let soft_line = Polyline::with_flags(line.clone(), None, PolylineFlags::DEFORMABLE);
    let convex = shapes(1.0).into_iter().map(|(name, shape)| (name, shape, true));
    let others = [
        ("mesh", ball.shape(), true),
        ("deformable mesh", SharedShape::new(soft), true),
        ("height field", field, true),
        ("compound", SharedShape::compound(part(SharedShape::ball(0.5))), true),
        ("compound with another kind", SharedShape::compound(with_field), false),
        ("polyline", SharedShape::polyline(line, None), true),
        ("deformable polyline", SharedShape::new(soft_line), false),
        ("voxels", SharedShape::voxels_from_points(Vec3::splat(0.3), &ball.vertices), false),
    ];
    convex.chain(others).collect()
}

/// Would catch a kind that is computed otherwise than the documentation says, and a forgotten
/// order.
#[test]
fn contacts_of_each_kind_are_computed_as_documented() {
    let pos12 = Pose::translation(0.15, 0.6, 0.1);
    for flags in [TriMeshFlags::empty(), TriMeshFlags::DEFORMABLE] {
        let mesh = mesh::ball(0.8, 4).trimesh(flags);
        for (name, other, by_sbbk) in kinds() {
            for flipped in [false, true] {
                let question = Question::new(&mesh, &*other, pos12).flipped(flipped);
                let dispatcher = every();
                let found = question.fresh(&dispatcher);
                let stats = dispatcher.stats();
                assert_eq!(stats.queries, u64::from(by_sbbk), "{name}: {stats:?}");
                assert_eq!(stats.unsupported_queries, 0, "{name}: {stats:?}");
                if by_sbbk {
                    assert_eq!(stats.descended_queries, 1, "{name} touches: {stats:?}");
                    continue;
                }
                assert_bits(&found, &question.fresh(&DefaultQueryDispatcher), name);
            }
        }
    }
}

/// Would catch queries that should be Parry's to the last bit, and trees that are not needed.
#[test]
fn queries_of_each_kind_are_computed_as_documented() {
    let pos12 = Pose::translation(2.5, 0.2, 0.1);
    let near = Pose::translation(1.5, 0.2, 0.1);
    let still = NonlinearRigidMotion::identity();
    let moving = NonlinearRigidMotion::new(pos12, Vec3::ZERO, -Vec3::X, 0.1 * Vec3::Y);
    type Ask<'a> = &'a dyn Fn(&dyn QueryDispatcher, &dyn Shape, &dyn Shape) -> String;
    let options = ShapeCastOptions::with_max_time_of_impact(2.0);
    let queries: [(&str, Ask); 6] = [
        // Boxes that are apart need no tree.
        ("intersection_test", &|d, g1, g2| format!("{:?}", d.intersection_test(&near, g1, g2))),
        ("distance", &|d, g1, g2| format!("{:?}", d.distance(&pos12, g1, g2))),
        ("closest_points", &|d, g1, g2| format!("{:?}", d.closest_points(&pos12, g1, g2, 9.0))),
        ("contact", &|d, g1, g2| format!("{:?}", d.contact(&pos12, g1, g2, 9.0))),
        ("cast_shapes", &|d, g1, g2| {
            format!("{:?}", d.cast_shapes(&pos12, -Vec3::X, g1, g2, options))
        }),
        ("cast_shapes_nonlinear", &|d, g1, g2| {
            let casts = [true, false]
                .map(|stop| d.cast_shapes_nonlinear(&still, g1, &moving, g2, 0.0, 2.0, stop));
            format!("{casts:?}")
        }),
    ];
    let rigid = shape(&mesh::ball(0.8, 4));
    let soft = mesh::ball(0.8, 4).trimesh(TriMeshFlags::DEFORMABLE);
    for (query, ask) in queries {
        for (name, other, _) in kinds() {
            for mesh in [&rigid, &soft] {
                let dispatcher = SbbkDispatcher::default();
                let answer = ask(&dispatcher, mesh, &*other);
                let is_ours = name == "mesh" && std::ptr::eq(mesh, &rigid);
                let trees = dispatcher.stats().internals.tree_builds;
                let has_trees = is_ours && query != "intersection_test";
                assert_eq!(trees, if has_trees { 2 } else { 0 }, "{query} of {name}");
                let is_convex = match query {
                    "cast_shapes" | "cast_shapes_nonlinear" => other.is_convex(),
                    _ => other.is_convex() && name != "ball",
                };
                let is_searched = is_convex && std::ptr::eq(mesh, &rigid);
                if !is_ours && !is_searched {
                    assert_eq!(
                        answer,
                        ask(&DefaultQueryDispatcher, mesh, &*other),
                        "{query} of {name}"
                    );
                }
            }
        }
    }
}

/// Would catch a disabled kind that SBBK computes.
#[test]
fn disabled_kinds_are_left_to_stock() {
    let ground = shape(&mesh::cuboid(Vec3::new(8.0, 0.5, 8.0), 4));
    let is_ours = |dispatcher: &SbbkDispatcher, ground: &TriMesh, other: &dyn Shape| {
        let pos12 = Pose::translation(0.3, 0.95, 0.2);
        let before = dispatcher.stats().queries;
        let question = Question::new(ground, other, pos12);
        let found = question.fresh(dispatcher);
        let is_ours = dispatcher.stats().queries > before;
        if !is_ours {
            assert_bits(&found, &question.fresh(&DefaultQueryDispatcher), "as stock");
        }
        is_ours
    };
    let all = counting_patches();
    let none = with(|SbbkConfig { kinds, .. }| {
        (kinds.meshes, kinds.height_fields) = (false, false);
        (kinds.convex_shapes, kinds.composites) = (false, false);
    });
    for (name, other, by_sbbk) in kinds() {
        assert_eq!(is_ours(&all, &ground, &*other), by_sbbk, "{name}");
        assert!(!is_ours(&none, &ground, &*other), "{name}");
    }
}

/// Rapier's character controller stands on the ground by casts alone: the dispatcher is never asked
/// for its contacts. Would catch documentation that says otherwise, and a Rapier that asks.
#[test]
fn character_controllers_ask_for_no_contacts() {
    let dispatcher = every();
    let floor = mesh::floor(4.0, 4).shape();
    let mut world = world_of([ColliderBuilder::new(floor.clone())], dispatcher.clone());
    world.step();
    let (capsule, controller) =
        (SharedShape::capsule_y(0.4, 0.3), KinematicCharacterController::default());
    let mut pose = Pose::translation(0.1, 0.9, 0.2);
    let mut is_grounded = false;
    for _ in 0..30 {
        let queries = world.query_pipeline_with_filter(QueryFilter::default());
        let way = Vec3::new(0.01, -0.05, 0.0);
        let moved = controller.move_shape(1.0 / 60.0, &queries, &*capsule, &pose, way, |_| ());
        pose.translation += moved.translation;
        is_grounded = moved.grounded;
    }
    assert!(is_grounded && pose.translation.y > 0.69, "{pose:?}");
    assert_eq!(dispatcher.stats().queries, 0);
    let at = Pose::translation(0.1, 0.7, 0.2);
    Question::new(&*floor, &*capsule, at).fresh(&dispatcher);
    assert_eq!(dispatcher.stats().queries, 1);
}
