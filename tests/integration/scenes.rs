use crate::prelude::*;
use crate::truth::{check_all_right, errors_of};
use sbbk_testkit::judge::Errors;
use sbbk_testkit::scene::{HelicopterBallDrop, MonkeyPile, Scene};

/// The pairs of meshes that the broad phase has proposed, at their present poses.
fn mesh_pairs(world: &PhysicsWorld) -> impl Iterator<Item = Question<'_>> {
    let prediction = world.integration_parameters.prediction_distance();
    world.contact_pairs().filter_map(move |pair| {
        let [one, two] = [pair.collider1, pair.collider2].map(|handle| &world.colliders[handle]);
        let (mesh1, mesh2) = (one.shape().as_trimesh()?, two.shape().as_trimesh()?);
        let pos12 = one.position().inv_mul(two.position());
        Some(Question::new(mesh1, mesh2, pos12).within(prediction))
    })
}

/// Would catch contacts missed, invented or wrong at the poses that occur in the paper's scenes,
/// moved by stock Rapier.
#[test]
fn contacts_in_stocks_scenes_are_the_truths() {
    let (dispatcher, pile) = (per_triangle(), MonkeyPile::with_heads(40));
    // Steps at which to look: the ball on the rotor, and the pile from its first contacts on.
    let scenes: [(&dyn Scene, [usize; 4]); 2] =
        [(&HelicopterBallDrop, [21, 24, 35, 50]), (&pile, [41, 55, 75, 100])];
    let runs = [true, false].into_iter().flat_map(|has| scenes.map(|scene| (has, scene)));
    for (contact_recycling, (scene, looks)) in runs {
        let mut world = scene.build().world;
        world.integration_parameters.contact_recycling = contact_recycling;
        let mut errors = Errors::default();
        for step in 0..=looks[3] {
            if looks.contains(&step) {
                for query in mesh_pairs(&world).step_by(3) {
                    errors += errors_of(&query, &query.fresh(&dispatcher));
                }
            }
            world.step();
        }
        check_all_right(errors, 200);
    }
}
