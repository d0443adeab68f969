//! Pairs that are heavy enough for several threads.

use crate::prelude::*;
use rayon::ThreadPoolBuilder;

/// Answers of a pair in motion on so many threads: the first one, and those after.
fn answers(
    threads: usize,
    dispatcher: &SbbkDispatcher,
    shapes: &[SharedShape; 2],
    pose: Pose,
) -> Vec<Vec<Manifold>> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let [shape1, shape2] = shapes;
    pool.install(|| {
        let (mut pair, mut random) = (Pair::default(), Rand32::new(3));
        let mut question = Question::new(&**shape1, &**shape2, pose);
        let mut ask = |_| {
            pair.ask(dispatcher, &question);
            question.pose = nudge(&mut random, 1e-4) * question.pose;
            pair.manifolds.clone()
        };
        (0..4).map(&mut ask).collect()
    })
}

/// A torus with so many segments around the tube.
fn torus(tube: u32) -> Mesh {
    mesh::torus(1.0, 0.4, 3 * tube, tube)
}

/// Would catch parts in another order, lost candidates, and sums that depend on the first thread to
/// ask.
#[test]
fn heavy_pairs_have_the_same_bits_on_any_number_of_threads() {
    let on_top = Pose::from_parts(Vec3::new(0.01, 0.79, 0.02), Quat::from_rotation_y(0.2));
    let tip = Pose::from_parts(Vec3::new(0.0, -0.01, 0.0), Quat::IDENTITY);
    let slab = mesh::cuboid(Vec3::new(1.0, 0.2, 1.0), 40).mapped(|v| v - 0.2 * Vec3::Y);
    for (name, meshes, pose, is_prepared) in [
        ("with trees", [torus(60), torus(61)], on_top, true),
        ("with BVHs", [torus(60), torus(61)], on_top, false),
        ("too large to analyse", [torus(150), torus(60)], on_top, false),
        ("a tip", [slab, cone(2000)], tip, true),
    ] {
        let shapes = meshes.each_ref().map(|mesh| mesh.shape());
        let of = |threads| {
            let dispatcher = every();
            let prepared = shapes.iter().filter(|_| is_prepared);
            let _prepared: Vec<_> =
                prepared.map(|shape| dispatcher.prepare_shape(shape).unwrap()).collect();
            answers(threads, &dispatcher, &shapes, pose)
        };
        let expected = of(1);
        for answer in &expected {
            assert!(answer.len() > 500, "{name}: {} contacts are no heavy pair", answer.len());
        }
        for threads in [2, 5] {
            for (step, (found, expected)) in of(threads).iter().zip(&expected).enumerate() {
                assert_bits(found, expected, &format!("{name}, {threads} threads, step {step}"));
            }
        }
    }
}
