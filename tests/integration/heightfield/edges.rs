use super::terrain::{Terrain, place};
use crate::prelude::*;
use rapier_integration::TriangleContacts;
use rapier3d::parry::query::details::NormalConstraints;
use rapier3d::parry::shape::HeightFieldFlags;

/// Would catch constraints of a neighbour, of the wrong shape, or none at all.
#[test]
fn internal_edges_of_the_field_are_fixed() {
    let dispatcher = per_triangle();
    let mut random = Rand32::new(6);
    let mut terrain = Terrain::random(&mut random, [14, 17], Vec3::new(6.0, 0.6, 4.0));
    let mesh = shape_with(&mesh::monkey_head_with(6), TriMeshFlags::FIX_INTERNAL_EDGES);
    let (mut count, mut changed_count) = (0, 0);
    for i in 0..40 {
        let pose = place(&mut random, &terrain, &mesh, 0.05);
        let ask = |terrain: &Terrain| {
            let question = Question::new(&terrain.field, &mesh, pose);
            question.flipped(i % 2 == 1).fresh(&dispatcher)
        };
        terrain.field.set_flags(HeightFieldFlags::empty());
        let free = ask(&terrain);
        terrain.field.set_flags(HeightFieldFlags::FIX_INTERNAL_EDGES);
        let constrained = ask(&terrain);
        changed_count += usize::from(format!("{free:?}") != format!("{constrained:?}"));
        for manifold in &constrained {
            let [one, two] = [manifold.subshape1, manifold.subshape2];
            let [in_mesh, in_field] = if i % 2 == 1 { [one, two] } else { [two, one] };
            let field = terrain.field.triangle_at_id(in_field).unwrap();
            let cones = [
                mesh.triangle_normal_constraints(in_mesh),
                terrain.field.triangle_normal_constraints(in_field),
            ];
            let [of_mesh, of_field] =
                cones.each_ref().map(|cone| cone.as_ref().map(|c| c as &dyn NormalConstraints));
            let triangle = mesh.triangle(in_mesh);
            let mut expected = Manifold::new();
            let (pos12, triangles, cones) = if i % 2 == 1 {
                (pose.inverse(), [&triangle, &field], [of_mesh, of_field])
            } else {
                (pose, [&field, &triangle], [of_field, of_mesh])
            };
            TriangleContacts::default().update(&pos12, triangles, cones, 0.02, &mut expected);
            [expected.subshape1, expected.subshape2] = [one, two];
            assert_same(std::slice::from_ref(manifold), &[expected], 0.0);
            count += 1;
        }
    }
    assert!(count > 150 && changed_count > 20, "{count} manifolds, {changed_count} changed");
}
