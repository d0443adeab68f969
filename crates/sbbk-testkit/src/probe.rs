//! A dispatcher around another one that records its answers about two meshes.

use std::sync::{Arc, Mutex, PoisonError};

use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::query::details::{NormalConstraints, ShapeCastOptions};
use rapier3d::parry::query::{
    ClosestPoints, Contact, ContactManifold, ContactManifoldsWorkspace, NonlinearRigidMotion,
    PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit, ShapeDistance, ShapeIntersection,
    Unsupported,
};
use rapier3d::parry::shape::Shape;

/// Arguments of `contact_manifolds` for two meshes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Question {
    /// [`shape_address`] of both meshes.
    pub shapes: [usize; 2],
    /// Pose of the second mesh in the first one's frame.
    pub pos12: Pose,
    /// The prediction distance of the call.
    pub prediction: Real,
}

/// A pair of triangles with a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reported {
    pub triangle1: u32,
    pub triangle2: u32,
    /// Smallest signed distance among the points of the pair: negative when it penetrates.
    pub distance: Real,
    /// The normals, each in its mesh's frame and out of it.
    pub normals: [Vector; 2],
}

/// A call of `contact_manifolds` for two meshes.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    pub question: Question,
    /// Triangle pairs with a point no farther than the prediction distance. Points beyond it,
    /// which stock Parry keeps from earlier poses, are left out.
    pub reported: Vec<Reported>,
}

impl Question {
    /// The question about two shapes.
    pub fn new(pos12: &Pose, shapes: [&dyn Shape; 2], prediction: Real) -> Self {
        Self { shapes: shapes.map(shape_address), pos12: *pos12, prediction }
    }
}

impl Reported {
    /// Contacts of manifolds within the prediction distance.
    pub fn all<M, C>(manifolds: &[ContactManifold<M, C>], prediction: Real) -> Vec<Self> {
        let reported = manifolds.iter().filter_map(|manifold| {
            let distances = manifold.points.iter().map(|point| point.dist);
            let distance = distances.reduce(Real::min).filter(|d| *d <= prediction)?;
            Some(Self {
                triangle1: manifold.subshape1,
                triangle2: manifold.subshape2,
                distance,
                normals: [manifold.local_n1, manifold.local_n2],
            })
        });
        reported.collect()
    }
}

impl Answer {
    /// The answer held by `manifolds` after the call.
    pub fn new<M, C>(question: Question, manifolds: &[ContactManifold<M, C>]) -> Self {
        Self { reported: Reported::all(manifolds, question.prediction), question }
    }
}

/// Address of a shape, unique as long as the shape lives.
pub fn shape_address(shape: &dyn Shape) -> usize {
    std::ptr::from_ref(shape).cast::<()>().addr()
}

/// Answers of one [`Recording`] dispatcher, while they are recorded; clones share them.
#[derive(Clone, Debug, Default)]
pub struct Probe(Arc<Mutex<Option<Vec<Answer>>>>);

impl Probe {
    /// Keeps the answer of each query of two meshes from now on, until [`Self::take_answers`]. Off at
    /// first: recording allocates, so steps that record are not steps to time.
    pub fn start_recording(&self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(Vec::new());
    }

    /// Stops recording; the answers since [`Self::start_recording`], in the order of the calls.
    pub fn take_answers(&self) -> Vec<Answer> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take().unwrap_or_default()
    }
}

/// Passes every query on unchanged, and records answers about two meshes.
pub struct Recording<D: ?Sized> {
    probe: Probe,
    inner: Arc<D>,
}

impl<D: ?Sized> Recording<D> {
    /// A dispatcher around `inner` that records into `probe`.
    pub fn new(inner: Arc<D>, probe: Probe) -> Self {
        Self { probe, inner }
    }
}

macro_rules! forward {
    ($($name:ident($($argument:ident: $type:ty),*) -> $result:ty;)*) => {$(
        fn $name(&self, $($argument: $type),*) -> Result<$result, Unsupported> {
            self.inner.$name($($argument),*)
        }
    )*};
}

impl<D: QueryDispatcher + ?Sized> QueryDispatcher for Recording<D> {
    forward! {
        intersection_test(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> ShapeIntersection;
        distance(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> ShapeDistance;
        contact(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, near: Real) -> Option<Contact>;
        closest_points(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, near: Real) -> ClosestPoints;
        cast_shapes(
            pos12: &Pose,
            local_vel12: Vector,
            g1: &dyn Shape,
            g2: &dyn Shape,
            options: ShapeCastOptions
        ) -> Option<ShapeCastHit>;
        cast_shapes_nonlinear(
            motion1: &NonlinearRigidMotion,
            g1: &dyn Shape,
            motion2: &NonlinearRigidMotion,
            g2: &dyn Shape,
            start_time: Real,
            end_time: Real,
            stop_at_penetration: bool
        ) -> Option<ShapeCastHit>;
    }
}

impl<M, C, D> PersistentQueryDispatcher<M, C> for Recording<D>
where
    D: PersistentQueryDispatcher<M, C> + ?Sized,
{
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let result =
            (self.inner).contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace);
        let mut answers = self.probe.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(answers) = &mut *answers
            && [g1, g2].iter().all(|shape| shape.as_trimesh().is_some())
        {
            answers.push(Answer::new(Question::new(pos12, [g1, g2], prediction), manifolds));
        }
        result
    }

    forward! {
        contact_manifold_convex_convex(
            pos12: &Pose,
            g1: &dyn Shape,
            g2: &dyn Shape,
            constraints1: Option<&dyn NormalConstraints>,
            constraints2: Option<&dyn NormalConstraints>,
            prediction: Real,
            manifold: &mut ContactManifold<M, C>
        ) -> ();
    }
}
