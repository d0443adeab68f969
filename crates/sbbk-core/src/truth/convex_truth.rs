use glamx::DVec3;

/// How a triangle and a convex body meet.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexTruth {
    /// The distance, to 1e-9 of the size of the pair; minus the least translation that parts them
    /// when they cross.
    pub distance: f64,
    /// The directions from the triangle to the body along which that is so: one, but where moves
    /// along several are least. None for cores that touch.
    pub normals: Vec<DVec3>,
}
