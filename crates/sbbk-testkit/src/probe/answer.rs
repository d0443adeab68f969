//! Recorded queries of two meshes.

use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::query::ContactManifold;
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
