//! Recording of a run, and the first difference of two.

use crate::prelude::*;
use rapier3d::geometry::Collider;

/// Steps of the world for one frame of the page, which puts bodies between two frames where they
/// would be.
pub(super) const STRIDE: usize = 2;
/// At most this many contacts of a frame are kept, evenly chosen.
const CONTACTS: usize = 200;

/// Depths of a pair of bodies that differ by more than this, in units, are not the same contact.
/// It is a fifth of Rapier's prediction distance, which is taken for the distance of pairs without
/// a contact.
const DIFFERS: f32 = 0.004;
const PREDICTION: f32 = 0.02;

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
    /// Deepest contact of each pair of objects, for all steps.
    pub(super) deepest: Vec<HashMap<[usize; 2], Deepest>>,
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

/// The nearest or deepest point of a pair.
#[derive(Clone, Copy, Debug)]
pub(super) struct Deepest {
    pub distance: f32,
    pub point: Vec3,
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
        let contacts = self.contacts(world);
        if self.times.len().is_multiple_of(STRIDE) {
            self.frame(world, contacts);
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
            let is_shape = |known: &SharedShape| shape_address(&**known) == shape_address(&**shape);
            let shape = self.shapes.iter().position(is_shape).unwrap_or_else(|| {
                self.shapes.push(shape.clone());
                self.shapes.len() - 1
            });
            self.objects.push(Object { shape, is_fixed });
            self.objects.len() - 1
        })
    }

    /// Returns all points within the prediction distance, and stores the deepest of each pair.
    fn contacts(&mut self, world: &PhysicsWorld) -> Vec<Vec3> {
        let prediction = world.integration_parameters.prediction_distance();
        let (mut contacts, mut deepest) = (Vec::new(), HashMap::new());
        for pair in world.contact_pairs() {
            let handles = [pair.collider1, pair.collider2];
            let [Some(&one), Some(&other)] = handles.map(|handle| self.places.get(&handle)) else {
                continue;
            };
            let Some(collider) = world.colliders.get(pair.collider1) else { continue };
            for manifold in pair.manifolds() {
                let pose = manifold
                    .subshape_pos1()
                    .map_or(*collider.position(), |inner| *collider.position() * *inner);
                for point in manifold.points.iter().filter(|point| point.dist <= prediction) {
                    let found = Deepest { distance: point.dist, point: pose * point.local_p1 };
                    contacts.push(found.point);
                    let pair = [one.min(other), one.max(other)];
                    let kept = deepest.entry(pair).or_insert(found);
                    if found.distance < kept.distance {
                        *kept = found;
                    }
                }
            }
        }
        self.deepest.push(deepest);
        contacts
    }
}

/// The first contact that is not the same in two runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Difference {
    pub step: usize,
    /// The objects.
    pub pair: [usize; 2],
    /// Where it is.
    pub point: [f32; 3],
    /// The distance in the first run, or none: no contact.
    pub distances: [Option<f32>; 2],
}

impl Difference {
    /// The largest difference of the first step in which there is one.
    pub fn first(one: &Recorder, other: &Recorder) -> Option<Self> {
        let mut steps = one.deepest.iter().zip(&other.deepest).enumerate();
        steps.find_map(|(step, (one, other))| {
            let pairs = one.keys().chain(other.keys().filter(|pair| !one.contains_key(*pair)));
            let differences = pairs.filter_map(|pair| {
                let found = [one.get(pair), other.get(pair)];
                let distances = found.map(|found| found.map(|found| found.distance));
                let [a, b] = distances.map(|distance| distance.unwrap_or(PREDICTION));
                let point = found.into_iter().flatten().next().map_or(Vec3::ZERO, |f| f.point);
                let difference =
                    Self { step: step + 1, pair: *pair, point: point.to_array(), distances };
                ((a - b).abs() > DIFFERS).then_some(((a - b).abs(), difference))
            });
            // Ties go to the first pair, as the order of a map varies.
            let largest = differences
                .max_by(|(a, one), (b, other)| a.total_cmp(b).then(other.pair.cmp(&one.pair)));
            largest.map(|(_, difference)| difference)
        })
    }
}
