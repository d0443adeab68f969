//! Recording of a run.

use crate::prelude::*;
use rapier3d::geometry::Collider;

/// Steps of the world for one frame of the page, which puts bodies between two frames where they
/// would be.
pub(super) const STRIDE: usize = 2;
/// At most this many contacts of a frame are kept, evenly chosen.
const CONTACTS: usize = 200;

/// Poses, contacts and times of a run.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    pub(super) name: String,
    /// Colliders in the order of insertion.
    pub(super) objects: Vec<Object>,
    places: HashMap<ColliderHandle, usize>,
    pub(super) shapes: Vec<SharedShape>,
    pub(super) frames: Vec<Frame>,
    /// Times of all steps, in milliseconds.
    pub(super) times: Vec<f32>,
}

/// A collider.
#[derive(Clone, Copy, Debug)]
pub(super) struct Object {
    pub shape: usize,
    pub is_fixed: bool,
}

/// Poses and contacts at one time.
#[derive(Clone, Debug, Default)]
pub(super) struct Frame {
    /// Poses of the objects; `None` for removed ones.
    pub poses: Vec<Option<Pose>>,
    pub contacts: Vec<Vec3>,
}

impl Recorder {
    /// Starts the recording of a world before its first step.
    pub fn new(name: impl ToString, world: &PhysicsWorld) -> Self {
        let mut recorder = Self { name: name.to_string(), ..Self::default() };
        recorder.frame(world, Vec::new());
        recorder
    }

    /// Steps a world once, and records it.
    pub fn step(&mut self, world: &mut PhysicsWorld) {
        let clock = Instant::now();
        world.step();
        self.times.push(1e3 * clock.elapsed().as_secs_f32());
        if self.times.len().is_multiple_of(STRIDE) {
            self.frame(world, Self::contacts(world));
        }
    }

    fn frame(&mut self, world: &PhysicsWorld, contacts: Vec<Vec3>) {
        let mut poses = vec![None; self.objects.len()];
        for (handle, collider) in world.colliders.iter() {
            let object = self.object(world, handle, collider);
            poses.resize(poses.len().max(object + 1), None);
            let is_drawn = collider.is_enabled() && !collider.is_sensor();
            poses[object] = is_drawn.then(|| *collider.position());
        }
        let stride = contacts.len().div_ceil(CONTACTS).max(1);
        let contacts = contacts.into_iter().step_by(stride).collect();
        self.frames.push(Frame { poses, contacts });
    }

    fn object(&mut self, world: &PhysicsWorld, handle: ColliderHandle, it: &Collider) -> usize {
        *self.places.entry(handle).or_insert_with(|| {
            let body = it.parent().and_then(|body| world.bodies.get(body));
            let is_fixed = body.is_none_or(|body| body.is_fixed());
            let shape = it.shared_shape();
            let is_shape = |known: &SharedShape| Arc::ptr_eq(&known.0, &shape.0);
            let shape = self.shapes.iter().position(is_shape).unwrap_or_else(|| {
                self.shapes.push(shape.clone());
                self.shapes.len() - 1
            });
            self.objects.push(Object { shape, is_fixed });
            self.objects.len() - 1
        })
    }

    /// Returns all points within the prediction distance.
    fn contacts(world: &PhysicsWorld) -> Vec<Vec3> {
        let prediction = world.integration_parameters.prediction_distance();
        let mut contacts = Vec::new();
        for pair in world.contact_pairs() {
            let Some(collider) = world.colliders.get(pair.collider1) else { continue };
            for manifold in pair.manifolds() {
                let pose = manifold
                    .subshape_pos1()
                    .map_or(*collider.position(), |inner| *collider.position() * *inner);
                let near = manifold.points.iter().filter(|point| point.dist <= prediction);
                contacts.extend(near.map(|point| pose * point.local_p1));
            }
        }
        contacts
    }
}
