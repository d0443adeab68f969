//! Welding: one index for each distinct position.

use std::collections::HashMap;

use glamx::Vec3;

use super::Mesh;

impl Mesh {
    /// The same triangles over distinct positions, in order of first use; positions that no
    /// triangle uses are dropped. Positions are equal when all coordinates are (`-0` is `0`):
    /// nothing moves, and no tolerance is involved. Triangles that become degenerate stay.
    pub fn welded(&self) -> Self {
        let mut vertices = Vec::new();
        let mut index_of = HashMap::with_capacity(self.vertices.len());
        let mut weld = |index: u32| {
            let position = self.vertices[index as usize];
            *index_of.entry(key(position)).or_insert_with(|| {
                vertices.push(position);
                (vertices.len() - 1) as u32
            })
        };
        let triangles = self.triangles.iter().map(|t| t.map(&mut weld)).collect();
        Self::new(self.name.clone(), vertices, triangles)
    }

    /// Drops triangles that use a vertex twice, as where a grid row is pulled into one point.
    pub(super) fn without_repeated_corners(mut self) -> Self {
        self.triangles.retain(|&[a, b, c]| a != b && b != c && c != a);
        self
    }
}

/// Bits that are equal exactly for equal positions: adding zero turns `-0` into `0`.
fn key(position: Vec3) -> [u32; 3] {
    (position + Vec3::ZERO).to_array().map(f32::to_bits)
}
