use rapier_integration::{ContactSet, SbbkDispatcher};
use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::shape::{SharedShape, TriMesh, TriMeshFlags};
use sbbk_testkit::mesh;

use super::question::triangle_of;
use crate::support::{Pair, Question, counting_of, per_triangle, shape_with};

/// A bent slab of 192 triangles that are two units wide.
fn ground(flags: TriMeshFlags) -> TriMesh {
    let bent = |v: Vector| v + Vector::Y * (0.3 * (0.7 * v.x).sin() + 0.2 * v.z.cos());
    shape_with(&mesh::cuboid(Vector::new(8.0, 0.5, 8.0), 4).mapped(bent), flags)
}

/// Would catch impulses that are lost where a ball rolls on, as in stock, or given to another
/// triangle.
#[test]
fn contacts_keep_their_data_where_a_ball_rolls() {
    let (ground, shape) = (ground(TriMeshFlags::empty()), SharedShape::ball(0.8));
    let dispatcher = per_triangle();
    let mut pair = Pair::<(), u32>::default();
    let (mut kept, mut came) = (0, 0);
    for i in 0..400 {
        let way = 0.01 * i as Real;
        let height = 0.5 + 0.3 * (0.7 * (way - 2.0)).sin() + 0.2 + 0.75;
        let pose = Pose::translation(way - 2.0, height, 0.1);
        let question = Question::new(&ground, &*shape, pose);
        let before: Vec<u32> = pair.manifolds.iter().map(|m| m.subshape1).collect();
        pair.ask(&dispatcher, &question);
        for manifold in &mut pair.manifolds {
            let is_old = before.contains(&manifold.subshape1);
            *(if is_old { &mut kept } else { &mut came }) += 1;
            let data = &mut manifold.points[0].data;
            assert_eq!(*data, if is_old { manifold.subshape1 + 1 } else { 0 });
            *data = manifold.subshape1 + 1;
        }
    }
    assert!(kept > 300 && came > 4, "{kept} kept, {came} came");
}

/// Would catch a pair that is forgotten where soft CCD varies the prediction distance.
#[test]
fn another_prediction_distance_is_no_new_pair() {
    let (ground, shape) = (ground(TriMeshFlags::empty()), SharedShape::ball(0.8));
    let dispatcher = counting_of(ContactSet::Surfaces);
    let mut pair = Pair::<(), u32>::default();
    for (i, prediction) in [0.02, 3.0, 0.02, 1.0, 0.05, 8.0].into_iter().enumerate() {
        let question = Question::new(&ground, &*shape, Pose::translation(0.3, 1.3, 0.1));
        pair.ask(&dispatcher, &question.within(prediction));
        let deepest = pair.manifolds.iter_mut().map(|m| &mut m.points[0]);
        let deepest = deepest.min_by(|a, b| a.dist.total_cmp(&b.dist)).unwrap();
        assert_eq!(deepest.data, i as u32);
        deepest.data = i as u32 + 1;
    }
    assert_eq!(dispatcher.stats().pairs, 1);
}

/// Would catch manifolds of a mesh that is gone, and of another dispatcher those that are dropped.
#[test]
fn without_a_workspace_no_manifold_survives() {
    let (mesh, shape) = (ground(TriMeshFlags::empty()), SharedShape::ball(0.8));
    let question = Question::new(&mesh, &*shape, Pose::translation(0.3, 1.4, 0.1)).within(0.2);
    let dispatcher = SbbkDispatcher::default();
    let mut pair = Pair::<(), u32>::default();
    pair.ask(&dispatcher, &question);
    assert!(!pair.manifolds.is_empty());
    pair.manifolds.iter_mut().for_each(|m| m.points[0].data = 7);
    pair.ask(&SbbkDispatcher::default(), &question);
    assert!(pair.manifolds.iter().all(|m| m.points[0].data == 7));
    pair.workspace = None;
    pair.ask(&dispatcher, &question);
    assert!(pair.manifolds.iter().all(|m| m.points[0].data == 0));
}

/// Would catch finite triangles lost because others are not finite, and contacts of the latter.
#[test]
fn whole_triangles_of_a_broken_mesh_are_touched() {
    let mut mesh = ground(TriMeshFlags::DEFORMABLE);
    let (pose, shape) = (Pose::translation(0.3, 1.4, 0.1), SharedShape::ball(0.8));
    let touched = |mesh: &TriMesh| {
        let question = Question::new(mesh, &*shape, pose).within(0.2);
        let found = question.fresh(&SbbkDispatcher::default());
        let mut touched: Vec<u32> = found.iter().map(|m| triangle_of(&question, m)).collect();
        touched.sort_unstable();
        touched
    };
    let before = touched(&mesh);
    assert!(before.len() > 1);
    for broken in 0..mesh.vertices().len() as u32 {
        let whole = mesh.clone();
        mesh.update_vertices(|vertices| vertices[broken as usize] = Vector::NAN);
        let is_whole = |triangle: &&u32| !mesh.indices()[**triangle as usize].contains(&broken);
        let expected: Vec<u32> = before.iter().filter(is_whole).copied().collect();
        assert_eq!(touched(&mesh), expected);
        mesh = whole;
    }
}
