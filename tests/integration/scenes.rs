use rapier3d::geometry::{Collider, ContactPair};
use rapier3d::math::Real;
use rapier3d::pipeline::PhysicsWorld;
use sbbk_testkit::scene::{HelicopterBallDrop, MonkeyPile, Scene};

use crate::support::{Question, per_triangle};
use crate::truth::Tally;

/// A pair of meshes as Rapier asks about it at the start of a step.
struct Asked {
    colliders: [Collider; 2],
    prediction: Real,
}

impl Asked {
    fn query(&self) -> Question<'_> {
        let [one, two] = &self.colliders;
        let [mesh1, mesh2] = [one, two].map(|c| c.shape().as_trimesh().expect("a mesh"));
        let pos12 = one.position().inv_mul(two.position());
        Question::new(mesh1, mesh2, pos12).within(self.prediction)
    }
}

/// The pairs of meshes that the broad phase has proposed, at their present poses.
fn mesh_pairs(world: &PhysicsWorld) -> Vec<Asked> {
    let asked = |pair: &ContactPair| {
        let colliders = [pair.collider1, pair.collider2].map(|c| world.colliders[c].clone());
        let prediction = world.integration_parameters.prediction_distance();
        let are_meshes = colliders.iter().all(|c| c.shape().as_trimesh().is_some());
        are_meshes.then_some(Asked { colliders, prediction })
    };
    world.contact_pairs().filter_map(asked).collect()
}

fn scenes(contact_recycling: bool) -> [(Box<dyn Scene>, [usize; 4]); 2] {
    let pile = MonkeyPile { contact_recycling, ..MonkeyPile::with_heads(40) };
    // Steps at which to look: the ball on the rotor, and the pile from its first contacts on.
    [(Box::new(HelicopterBallDrop), [21, 24, 35, 50]), (Box::new(pile), [41, 55, 75, 100])]
}

/// Would catch contacts missed, invented or wrong at the poses that occur in the paper's scenes,
/// moved by stock Rapier.
#[test]
fn contacts_in_stocks_scenes_are_the_truths() {
    let dispatcher = per_triangle();
    let runs = [true, false].into_iter().flat_map(|has| scenes(has).map(|scene| (has, scene)));
    for (contact_recycling, (scene, looks)) in runs {
        let mut world = scene.build().world;
        world.integration_parameters.contact_recycling = contact_recycling;
        let mut tally = Tally::default();
        for step in 0..=looks[3] {
            if looks.contains(&step) {
                for asked in mesh_pairs(&world).iter().step_by(3) {
                    let query = asked.query();
                    tally.add(&query, &query.fresh(&dispatcher));
                }
            }
            world.step();
        }
        tally.check_all_right(200);
    }
}
