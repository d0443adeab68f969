use crate::prelude::*;

/// A bent slab of 192 triangles that are two units wide.
fn ground() -> TriMesh {
    let bent = |v: Vector| v + Vector::Y * (0.3 * (0.7 * v.x).sin() + 0.2 * v.z.cos());
    shape(&mesh::cuboid(Vector::new(8.0, 0.5, 8.0), 4).mapped(bent))
}

/// Would catch impulses that are lost where a ball rolls on, as in stock, or given to another
/// triangle.
#[test]
fn contacts_keep_their_data_where_a_ball_rolls() {
    let (ground, shape) = (ground(), SharedShape::ball(0.8));
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
    let (ground, shape) = (ground(), SharedShape::ball(0.8));
    let dispatcher = having(ContactSet::Surfaces);
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
