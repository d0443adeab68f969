use oorandom::Rand32;
use rapier_integration::{ContactSet, SbbkDispatcher};
use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::query::DefaultQueryDispatcher;
use rapier3d::parry::shape::{SharedShape, TriMesh, TriMeshFlags};
use sbbk_testkit::mesh;

use super::question::{bits, touches, triangle_of};
use crate::support::{Manifold, Pair, Question, counting_of, per_triangle, rotation, shape_with};

/// Of 192 triangles, two units wide, bent.
fn ground(flags: TriMeshFlags) -> TriMesh {
    let bent = |v: Vector| v + Vector::Y * (0.3 * (0.7 * v.x).sin() + 0.2 * v.z.cos());
    shape_with(&mesh::cuboid(Vector::new(8.0, 0.5, 8.0), 4).mapped(bent), flags)
}

/// Balls so large as a triangle or smaller. Would catch a contact that is lost, another than stock's,
/// or in another order; one that depends on where the ball was; and manifolds without points.
#[test]
fn balls_on_large_triangles_touch_as_with_stock() {
    let mut count = 0;
    for flags in [TriMeshFlags::empty(), TriMeshFlags::FIX_INTERNAL_EDGES] {
        let ground = ground(flags);
        for (seed, radius) in [0.05, 0.4, 1.0].into_iter().enumerate() {
            let (dispatcher, unaware) = (counting_of(ContactSet::Triangles), per_triangle());
            let shape = SharedShape::ball(radius);
            let mut random = Rand32::new(seed as u64);
            let mut pairs: [Pair; 2] = Default::default();
            for i in 0..300 {
                let way = 0.05 * i as Real;
                let height = 0.5 + 0.3 * (0.7 * (way - 7.0)).sin() + 0.2 * (0.6 * way - 4.0).cos();
                // Every other one within the prediction distance, about.
                let depth = 0.1 * radius * random.rand_float() - 0.02 * (i % 2) as Real;
                let at = Vector::new(way - 7.0, height + radius - depth, 0.6 * way - 4.0);
                let pose = Pose::from_parts(at, rotation(&mut random));
                for (pair, flipped) in pairs.iter_mut().zip([false, true]) {
                    let (mesh, shape) = (&ground, &shape);
                    let question = Question::new(mesh, &**shape, pose).flipped(flipped);
                    let all = |found: &[Manifold]| found.iter().map(bits).collect::<Vec<_>>();
                    let found = all(&pair.ask(&dispatcher, &question).manifolds);
                    assert_eq!(found, all(&question.fresh(&unaware)), "{radius}, {i}");
                    let mut stock = question.fresh(&DefaultQueryDispatcher);
                    stock.retain(|manifold| touches(manifold, question.prediction));
                    assert_eq!(found, all(&stock), "{radius}, {i}");
                    count += found.len();
                }
            }
            let stats = dispatcher.stats();
            assert!(stats.pairs == 2 && stats.descended_queries > 500, "{stats:?}");
        }
    }
    assert!(count > 2000, "{count} contacts");
}

/// Balls as far above a floor as the prediction distance, to the last digit. Would catch a box that is
/// rounded to less than the ball's.
#[test]
fn balls_at_the_prediction_distance_touch_as_with_stock() {
    let ground = shape_with(&mesh::floor(64.0, 8), TriMeshFlags::empty());
    let mut random = Rand32::new(3);
    let mut counts = [0, 0];
    for _ in 0..2000 {
        let [radius, prediction, x, z] =
            [1.0, 0.1, 20.0, 20.0].map(|most: Real| most * (0.1 + 0.9 * random.rand_float()));
        let shape = SharedShape::ball(radius);
        let mut height = radius + prediction;
        (0..random.rand_range(0..4)).for_each(|_| height = height.next_down());
        let pose = Pose::from_parts(Vector::new(x, height, z), rotation(&mut random));
        for flipped in [false, true] {
            let question =
                Question::new(&ground, &*shape, pose).within(prediction).flipped(flipped);
            let mut stock = question.fresh(&DefaultQueryDispatcher);
            stock.retain(|manifold| touches(manifold, prediction));
            assert_eq!(question.fresh(&SbbkDispatcher::default()).len(), stock.len());
            counts[usize::from(!stock.is_empty())] += 1;
        }
    }
    assert!(counts.iter().all(|&count| count > 300), "{counts:?} above and touching");
}

/// What a host stores with each contact point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Impulse(u32);

/// Would catch impulses that are lost where a ball rolls on, as in stock, or given to another
/// triangle.
#[test]
fn contacts_keep_their_data_where_a_ball_rolls() {
    let (ground, shape) = (ground(TriMeshFlags::empty()), SharedShape::ball(0.8));
    let dispatcher = per_triangle();
    let mut pair = Pair::<(), Impulse>::default();
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
            let data = &mut manifold.points[0].data.0;
            assert_eq!(*data, if is_old { manifold.subshape1 + 1 } else { 0 });
            *data = manifold.subshape1 + 1;
        }
    }
    assert!(kept > 300 && came > 4, "{kept} kept, {came} came");
}

/// Would catch manifolds of a mesh that is gone, and of another dispatcher those that are dropped.
#[test]
fn without_a_workspace_no_manifold_survives() {
    let (mesh, shape) = (ground(TriMeshFlags::empty()), SharedShape::ball(0.8));
    let question = Question::new(&mesh, &*shape, Pose::translation(0.3, 1.4, 0.1)).within(0.2);
    let dispatcher = SbbkDispatcher::default();
    let mut pair = Pair::<(), Impulse>::default();
    pair.ask(&dispatcher, &question);
    assert!(!pair.manifolds.is_empty());
    pair.manifolds.iter_mut().for_each(|m| m.points[0].data = Impulse(7));
    pair.ask(&SbbkDispatcher::default(), &question);
    assert!(pair.manifolds.iter().all(|m| m.points[0].data == Impulse(7)));
    pair.workspace = None;
    pair.ask(&dispatcher, &question);
    assert!(pair.manifolds.iter().all(|m| m.points[0].data == Impulse(0)));
}

/// Would catch whole triangles that are lost since others of the mesh are not finite, and contacts of
/// those.
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
