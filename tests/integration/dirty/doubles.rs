use glamx::Vec3;
use oorandom::Rand32;
use rapier3d::parry::shape::TriMesh;
use sbbk_testkit::mesh::{self, Mesh};

use crate::support::{Pair, Question, assert_same, every, shape, touching};

/// The mesh with all its triangles a number of times.
fn repeated(mesh: &Mesh, times: usize) -> Mesh {
    Mesh::new(mesh.name.clone(), mesh.vertices.clone(), mesh.triangles.repeat(times))
}

/// Asks for the contacts of two meshes with themselves, three times. Panics if they differ.
fn check(meshes: [&TriMesh; 2], random: &mut Rand32, depth: f32) -> usize {
    let (dispatchers, mut pairs) =
        ([0, 1].map(|_| every()), [0, 1].map(|_| Pair::<(), ()>::default()));
    let pose = touching(random, [meshes[0]; 2], depth);
    // The first query descends Parry's BVHs, the others descend trees.
    for _ in 0..3 {
        for i in 0..2 {
            pairs[i].ask(&dispatchers[i], &Question::new(meshes[i], meshes[i], pose));
        }
        let [of_clean, of_doubled] = pairs.each_ref().map(|pair| &pair.manifolds);
        assert_same(of_clean, of_doubled, 0.0);
    }
    pairs[0].manifolds.len()
}

/// Would catch doubles with contacts, and doubles that hide the neighbours of a triangle.
#[test]
fn doubles_change_no_contact() {
    let (mut random, mut contacts) = (Rand32::new(5), 0);
    for clean in [mesh::torus(0.5, 0.2, 24, 12), mesh::cuboid(Vec3::new(0.5, 0.4, 0.3), 4)] {
        for times in [2, 3] {
            let [clean, doubled] = [&clean, &repeated(&clean, times)].map(shape);
            for depth in [-0.01, 0.002, 0.02, 0.1].repeat(8) {
                contacts += check([&clean, &doubled], &mut random, depth);
            }
        }
    }
    assert!(contacts > 500, "{contacts}");
}
