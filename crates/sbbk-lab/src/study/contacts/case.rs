//! What is asked: a mesh, its size, and the prediction distance.

use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;
use serde::Serialize;

use super::approach::Place;

/// One mesh at one size against itself, with one prediction distance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContactCase {
    /// Name of the mesh.
    pub mesh: String,
    /// Its triangles.
    pub triangle_count: usize,
    /// Its longest side, in units.
    pub size: Real,
    /// The prediction distance, in units.
    pub prediction: Real,
}

impl std::fmt::Display for ContactCase {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { mesh, triangle_count, size, prediction } = self;
        write!(f, "{mesh} of {triangle_count} triangles, {size} units, prediction {prediction}")
    }
}

/// A case that can be asked.
pub(super) struct PosedCase {
    pub case: ContactCase,
    /// The mesh, shared with the cases of other prediction distances.
    pub shape: SharedShape,
    /// Where the second copy is.
    pub places: Vec<Place>,
}
