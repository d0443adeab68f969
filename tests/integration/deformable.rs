use crate::edited_mesh::{beside, torus};
use crate::heightfield::terrain::Terrain;
use crate::prelude::*;
use crate::soft_pairs::furniture;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

fn soft_ball() -> TriMesh {
    mesh::ball(1.0, 5).trimesh(TriMeshFlags::DEFORMABLE)
}

/// Would catch one mesh taken for the other.
#[test]
fn two_soft_meshes_keep_apart() {
    let dispatcher = every();
    let mut meshes = [(); 2].map(|()| soft_ball());
    let rest = meshes[0].vertices().to_vec();
    let mut pair: Pair = Pair::default();
    let mut contacts = 0;
    for frame in 0..200 {
        deform(&mut meshes[0], &rest, frame);
        deform(&mut meshes[1], &rest, frame / 2);
        let query = Question::new(&meshes[0], &meshes[1], Pose::translation(1.3, 1.2, 0.3));
        let found = &pair.ask(&dispatcher, &query).manifolds;
        contacts += found.len();
        assert_same(found, &query.fresh(&SbbkDispatcher::default()), 1e-5);
    }
    assert!(contacts > 1000);
    let stats = dispatcher.stats();
    assert_eq!((stats.trees, stats.internals.walks), (0, 200));
}

/// Would catch a race between pairs of one mesh, a deadlock, or a lost contact.
#[test]
fn pairs_on_many_threads_agree() {
    const PAIRS: usize = 8;
    let dispatcher = SbbkDispatcher::default();
    let mut soft = soft_ball();
    let rest = soft.vertices().to_vec();
    let other = torus();
    let mut pairs: [Pair; PAIRS] = Default::default();
    let contacts = AtomicUsize::new(0);
    for frame in 0..50 {
        deform(&mut soft, &rest, frame);
        thread::scope(|scope| {
            for (i, pair) in pairs.iter_mut().enumerate() {
                let (dispatcher, soft, other, contacts) = (&dispatcher, &soft, &other, &contacts);
                scope.spawn(move || {
                    let pose = Pose::translation(0.02 * i as Real, 0.0, 0.0) * beside();
                    let query = Question::new(soft, other, pose);
                    let found = &pair.ask(dispatcher, &query).manifolds;
                    contacts.fetch_add(found.len(), Ordering::Relaxed);
                    assert_same(found, &query.fresh(&SbbkDispatcher::default()), 1e-5);
                });
            }
        });
    }
    assert!(contacts.into_inner() > 50 * PAIRS);
    let stats = dispatcher.stats();
    assert_eq!((stats.trees, stats.internals.walks), (0, 50 * PAIRS as u64));
}

/// Would catch contacts of the triangles before the edit.
#[test]
fn other_triangles_at_the_same_place_are_seen() {
    let dispatcher = SbbkDispatcher::default();
    let mut soft = SharedShape::new(soft_ball());
    let other = torus();
    let mut pair: Pair = Pair::default();
    for _ in 0..4 {
        let mesh = soft.make_mut().as_trimesh_mut().expect("the shape is a mesh");
        mesh.reverse();
        let query = Question::new(soft.as_trimesh().expect("as above"), &other, beside());
        let expected = query.fresh(&SbbkDispatcher::default());
        assert!(!expected.is_empty());
        assert_same(&pair.ask(&dispatcher, &query).manifolds, &expected, 1e-5);
    }
}

/// Would catch impulses lost where a mesh deforms a little: soft bodies would jitter.
#[test]
fn contacts_keep_their_data_while_a_mesh_deforms() {
    let hills = Terrain::random(&mut Rand32::new(3), [16, 14], Vec3::new(4.0, 0.5, 4.0)).field;
    let furniture = furniture(SharedShape::capsule_x(0.5, 0.1));
    for (other, pose) in [
        (&hills as &dyn Shape, Pose::translation(0.05, 0.9, 0.1)),
        (&furniture, Pose::translation(0.05, 1.08, 0.1)),
        (&torus(), beside()),
    ] {
        let dispatcher = SbbkDispatcher::default();
        let mut soft = soft_ball();
        let mut pair = Pair::<(), u32>::default();
        for step in 0..6 {
            if step == 3 {
                // Rapier copies a shared shape before an edit.
                soft = soft.clone();
            }
            soft.update_vertices(|vertices| vertices.iter_mut().for_each(|v| *v *= 1.00001));
            pair.ask(&dispatcher, &Question::new(other, &soft, pose).flipped(true));
            for point in pair.manifolds.iter_mut().flat_map(|manifold| &mut manifold.points) {
                point.data += 1;
            }
        }
        let points = || pair.manifolds.iter().flat_map(|manifold| &manifold.points);
        let (old, all) = (points().filter(|point| point.data == 6).count(), points().count());
        assert!(all > 10 && 10 * old > 8 * all, "{old} of {all}");
    }
}
