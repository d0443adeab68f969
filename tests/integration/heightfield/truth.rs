use super::terrain::{Terrain, heights, place, terrains};
use crate::prelude::*;
use crate::soft_pairs::assert_same_set;
use crate::truth::{check_all_right, errors_of};
use rapier_integration::{SurfaceKind, TriangleContacts};
use rapier3d::parry::query::details::NormalConstraints;
use rapier3d::parry::shape::{HeightFieldFlags, Triangle};
use sbbk_testkit::judge::Errors;

/// Judges the answer to a question with a field by the terrain as a mesh.
fn errors_on(terrain: &Terrain, question: Question) -> Errors {
    let found = terrain.renumbered(&question, &question.fresh(&per_triangle()));
    errors_of(&terrain.as_mesh(&question), &found)
}

/// Would catch cells cut off too early, triangles mixed up, filled holes, the wrong frame, and
/// rounding.
#[test]
fn contacts_are_those_of_brute_force() {
    let mut random = Rand32::new(2);
    let meshes = [mesh::monkey_head_with(6), mesh::ball(0.7, 6), mesh::cuboid(Vec3::splat(0.6), 1)];
    let meshes = meshes.map(|mesh| shape(&mesh));
    for (index, terrain) in terrains().iter().enumerate() {
        let mut errors = Errors::default();
        for i in 0..36 {
            let mesh = &meshes[i % 3];
            let pose = place(&mut random, terrain, mesh, 0.03);
            let prediction = [0.02, 0.002, 0.1, 0.02][i % 4];
            let question = Question::new(&terrain.field, mesh, pose).within(prediction);
            errors += errors_on(terrain, question.flipped(i % 2 == 1));
        }
        assert!(!terrain.ids.is_empty(), "{index}");
        check_all_right(errors, 300);
    }
}

/// Poses on a lattice against heights on a lattice: faces in one plane, edges on edges.
#[test]
fn lattice_contacts_are_those_of_brute_force() {
    let mut random = Rand32::new(3);
    let terrain = Terrain::lattice(&mut random);
    let cuboid = shape(&mesh::cuboid(Vec3::splat(0.5), 2));
    let mut errors = Errors::default();
    for i in 0..60 {
        let mut coordinate =
            |range: u32| (random.rand_range(0..range) as Real - 0.5 * range as Real) * 0.25;
        let at = Vec3::new(coordinate(30), coordinate(4) + 0.75, coordinate(20));
        let turn = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2 * (i % 4) as Real);
        let question = Question::new(&terrain.field, &cuboid, Pose::from_parts(at, turn));
        errors += errors_on(&terrain, question.within(0.021).flipped(i % 2 == 1));
    }
    check_all_right(errors, 1000);
}

/// Would catch any difference, up to the order, between a terrain as a field and as a mesh.
#[test]
fn contacts_equal_those_of_the_terrain_as_a_mesh() {
    let dispatcher = per_triangle();
    let mut random = Rand32::new(4);
    let head = mesh::monkey_head().trimesh(TriMeshFlags::FIX_INTERNAL_EDGES);
    let mut count = 0;
    for terrain in &terrains() {
        for i in 0..20 {
            let pose = place(&mut random, terrain, &head, 0.05);
            let question = Question::new(&terrain.field, &head, pose);
            let question = question.flipped(i % 2 == 1);
            let found = terrain.renumbered(&question, &question.fresh(&dispatcher));
            assert_same_set(&found, &terrain.as_mesh(&question).fresh(&dispatcher));
            count += found.len();
        }
    }
    assert!(count > 5000, "{count} contacts");
}

/// Would catch neighbours other than those of the mesh, holes taken for ground, and a top that is
/// below.
///
/// A mesh is searched for triangles that nearly touch an edge, and a field is not, so contacts at
/// the steepest spikes differ. The middle of each mesh is above the ground. Contacts deeper than
/// five prediction distances are left out, as several nearest triangles are equally right.
#[test]
fn surfaces_are_those_of_the_terrain_as_a_mesh() {
    let mut random = Rand32::new(6);
    let meshes = [mesh::monkey_head(), mesh::cuboid(Vec3::splat(0.6), 4), mesh::ball(0.7, 12)];
    let meshes = meshes.map(|mesh| shape(&mesh));
    let (mut count, mut deep, mut fewer, mut asked, mut other) = (0, 0, 0, 0, 0);
    let terrains = terrains();
    let kinds = [SurfaceKind::Solid, SurfaceKind::Sheet];
    for (terrain, height_fields) in
        terrains.iter().flat_map(|terrain| kinds.map(|kind| (terrain, kind)))
    {
        let dispatcher = with(|config| {
            config.detail = ContactDetail::Every;
            config.solid_height_fields = height_fields == SurfaceKind::Solid;
        });
        let prepared = dispatcher.prepare(&terrain.mesh).unwrap();
        // A negative scale turns normals down.
        let has_top = terrain.field.scale().x > 0.0;
        prepared.set_surface_kind(if has_top { height_fields } else { SurfaceKind::Sheet });
        for i in 0..60 {
            let mesh = &meshes[i % 3];
            let depth = [0.05, -0.01, 0.005][i / 3 % 3];
            let pose = place(&mut random, terrain, mesh, depth);
            if is_under(terrain, pose * mesh.local_aabb().center()) {
                continue;
            }
            let question = Question::new(&terrain.field, mesh, pose);
            let question = question.flipped(i % 2 == 1);
            let mut found = terrain.renumbered(&question, &question.fresh(&dispatcher));
            let mut expected = terrain.as_mesh(&question).fresh(&dispatcher);
            fewer += question.fresh(&per_triangle()).len().saturating_sub(found.len());
            for manifolds in [&mut found, &mut expected] {
                let all = manifolds.len();
                manifolds.retain(|manifold| distance(manifold) > -5.0 * question.prediction);
                deep += all - manifolds.len();
                manifolds.sort_by_key(triangles);
            }
            asked += 1;
            let is_same = |(found, expected)| is_like(found, expected);
            let are_same = found.iter().zip(&expected).all(is_same);
            other += usize::from(found.len() != expected.len() || !are_same);
            count += found.len();
        }
    }
    assert!(50 * other <= asked, "{other} of {asked} differ");
    assert!(count > 2000 && deep < count / 2, "{count} contacts, {deep} deep");
    assert!(fewer > count, "{fewer} fewer than of triangles");
}

/// Returns true if two manifolds differ by rounding at most.
fn is_like(one: &Manifold, other: &Manifold) -> bool {
    let turn = one.local_n1.distance(other.local_n1);
    triangles(one) == triangles(other)
        && turn < 1e-4
        && (distance(one) - distance(other)).abs() < 1e-5
}

/// True if a point is behind the nearest triangle of a terrain.
fn is_under(terrain: &Terrain, point: Vec3) -> bool {
    let distance = |triangle: &Triangle| triangle.distance_to_local_point(point, false);
    let triangles = terrain.mesh.triangles();
    let nearest = triangles.min_by(|one, two| distance(one).total_cmp(&distance(two))).unwrap();
    nearest.normal().is_some_and(|normal| normal.dot(point - nearest.a) < 0.0)
}

/// A triangle with a height that is NaN or infinite is a hole; its neighbours are not.
#[test]
fn non_finite_heights_make_holes() {
    let mut random = Rand32::new(5);
    let ball = shape(&mesh::ball(0.7, 6));
    for broken in [Real::NAN, Real::INFINITY, -Real::INFINITY] {
        let heights = heights([14, 14], || match random.rand_range(0..6) {
            0 => broken,
            _ => 0.3 * random.rand_float(),
        });
        let terrain = Terrain::new(HeightField::new(heights, Vec3::new(4.0, 1.0, 4.0)));
        assert!(terrain.ids.len() < 300);
        let mut errors = Errors::default();
        for i in 0..20 {
            let [x, z] = [(); 2].map(|()| 3.0 * random.rand_float() - 1.5);
            let pose = Pose::translation(x, 0.8, z);
            let question = Question::new(&terrain.field, &ball, pose);
            errors += errors_on(&terrain, question.flipped(i % 2 == 1));
        }
        check_all_right(errors, 50);
    }
}

/// Would catch constraints of a neighbour, of the wrong shape, or none at all.
#[test]
fn internal_edges_of_the_field_are_fixed() {
    let dispatcher = per_triangle();
    let mut random = Rand32::new(6);
    let mut terrain = Terrain::random(&mut random, [14, 17], Vec3::new(6.0, 0.6, 4.0));
    let mesh = mesh::monkey_head_with(6).trimesh(TriMeshFlags::FIX_INTERNAL_EDGES);
    let (mut count, mut changed_count) = (0, 0);
    for i in 0..40 {
        let pose = place(&mut random, &terrain, &mesh, 0.05);
        terrain.field.set_flags(HeightFieldFlags::empty());
        let question = Question::new(&terrain.field, &mesh, pose).flipped(i % 2 == 1);
        let free = question.fresh(&dispatcher);
        terrain.field.set_flags(HeightFieldFlags::FIX_INTERNAL_EDGES);
        let question = Question::new(&terrain.field, &mesh, pose).flipped(i % 2 == 1);
        let constrained = question.fresh(&dispatcher);
        changed_count += usize::from(format!("{free:?}") != format!("{constrained:?}"));
        for manifold in &constrained {
            let [in_field, in_mesh] = question.subshapes(manifold);
            let pair = [terrain.field.triangle_at_id(in_field).unwrap(), mesh.triangle(in_mesh)];
            let cones = [
                terrain.field.triangle_normal_constraints(in_field),
                mesh.triangle_normal_constraints(in_mesh),
            ];
            let cones =
                cones.each_ref().map(|cone| cone.as_ref().map(|c| c as &dyn NormalConstraints));
            let (pair, cones) = (question.host_order(pair.each_ref()), question.host_order(cones));
            let mut expected = Manifold::new();
            let pos12 = question.pos12();
            TriangleContacts::default().update(&pos12, pair, cones, 0.02, &mut expected);
            [expected.subshape1, expected.subshape2] = triangles(manifold);
            assert_same(std::slice::from_ref(manifold), &[expected], 0.0);
            count += 1;
        }
    }
    assert!(count > 150 && changed_count > 20, "{count} manifolds, {changed_count} changed");
}
