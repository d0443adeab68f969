use parry3d::math::{Pose, Real, Vector};
use parry3d::shape::{Ball, SharedShape, TriMesh};
use sbbk_core::contact::contact;
use sbbk_core::traverse::DescentCounts;

use super::*;
use crate::SbbkConfig;
use crate::mesh::MeshStore;
use crate::pair::descents::DescentMemory;
use crate::pair::pose::PairPose;
use crate::pair::query::Pair;
use crate::pair::shapes::ShapeView;
use crate::pair::triangles::MeshPair;

/// Balls with triangles as large as the prediction distance, apart and crossing. Would
/// catch contacts that [`TriangleShapes::lateral_culling`] loses.
#[test]
fn triangles_beside_each_other_pass_by() {
    let store = MeshStore::new(None, 1 << 30);
    let shapes = [20, 30].map(|rows| {
        let (mut vertices, triangles) = Ball::new(1.0).to_trimesh(2 * rows, rows);
        for (i, vertex) in (0_u32..).zip(&mut vertices) {
            *vertex *= 1.0 + 0.0001 * (i * i % 31) as Real;
        }
        SharedShape::new(TriMesh::new(vertices, triangles).unwrap())
    });
    let meshes = shapes.each_ref().map(|shape| shape.as_trimesh().unwrap());
    let seen = meshes.map(|mesh| ShapeView::Mesh(store.view(mesh).unwrap()));
    let (config, mut counts) = (&SbbkConfig::default(), [0; 2]);
    for (i, gap) in (1..16).map(|i| (i, [0.0, 0.03, 0.0, -0.03, -0.06][i % 5])) {
        let turn = Vector::new(0.3, 0.1 * i as Real, 0.7);
        let place = turn.normalize() * (2.06 + gap);
        let pose = PairPose::new(&Pose::new(place, turn), 0.08);
        let mesh_pair = MeshPair { pose: &pose, shapes: seen, config };
        for has_trees in [false, true] {
            let registered = has_trees
                .then(|| [0, 1].map(|i| store.register(meshes[i], Some(&shapes[i])).unwrap()));
            let mut known = Default::default();
            mesh_pair.update(&mut known);
            let shapes = mesh_pair.open(&mut known).shapes;
            let mut found = Vec::new();
            let scratch = &mut DescentMemory::default();
            let tests = &mut DescentCounts::default();
            let reach = shapes.reach();
            shapes.descend(1.1 * reach, tests, scratch, &mut found);
            let mut found: Vec<_> = found.iter().map(|of| of.subshapes).collect();
            found.sort_unstable();
            let count = meshes.map(|mesh| mesh.indices().len() as u32);
            for pair in (0..count[0]).flat_map(|i| (0..count[1]).map(move |j| [i, j])) {
                let local = shapes.local(pair).unwrap();
                let [t1, t2] = &local.corners;
                if t1[0].distance(t2[0]) > 1.0 {
                    continue;
                }
                let contact = contact(t1, t2, f64::from(reach));
                let Some(contact) = contact else { continue };
                let filter = SurfaceFilter::new(&shapes, pair, &local).unwrap();
                let may_be_left_out =
                    filter.passes_by(&contact) && !filter.is_local_minimum(&contact);
                let is_found = found.binary_search(&pair).is_ok();
                assert!(is_found || may_be_left_out, "{pair:?}, {contact:?}");
                counts[usize::from(is_found)] += 1;
            }
            drop(registered);
        }
    }
    assert!(counts.into_iter().all(|count| count > 100), "{counts:?}");
}
