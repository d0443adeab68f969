//! Trees built ahead of the first query that is timed.

use rapier_integration::PreparedTree;
use rapier3d::geometry::SharedShape;

use super::Dispatcher;

/// The trees of some meshes, as a user prepares them at load time: building is measured on its own,
/// so that times of queries and steps do not hold it.
pub struct Primed(#[expect(dead_code, reason = "kept alive")] Vec<PreparedTree>);

impl Primed {
    /// Prepares the meshes among `shapes`; those that cannot have a tree stay without one.
    pub fn new<'a>(
        dispatcher: &Dispatcher,
        shapes: impl IntoIterator<Item = &'a SharedShape>,
    ) -> Self {
        let prepare = |shape| dispatcher.sbbk.as_ref()?.prepare_shape(shape).ok()?;
        Self(shapes.into_iter().filter_map(prepare).collect())
    }
}
