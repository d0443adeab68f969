use glamx::Vec3;

/// An axis-aligned box.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub min: Vec3,
    /// The corner with the largest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// Half of the surface area, the cost of a node in the surface area heuristic. Zero if empty.
    pub fn half_area(&self) -> f32 {
        let d = (self.max - self.min).max(Vec3::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    /// The centre of the box.
    pub fn centre(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// The largest absolute coordinate of the box.
    pub fn magnitude(&self) -> f32 {
        self.min.abs().max(self.max.abs()).max_element()
    }
}
