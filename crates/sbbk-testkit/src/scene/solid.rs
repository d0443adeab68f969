//! A mesh prepared for many bodies: one shape and one set of mass properties for all of them.

use rapier3d::dynamics::MassProperties;
use rapier3d::geometry::{ColliderBuilder, SharedShape};
use rapier3d::math::Real;

use crate::mesh::Mesh;

/// Mass of a cubic unit of every body. The value is without effect on motion, since all bodies
/// share it.
const DENSITY: Real = 1.0;

/// A mesh that encloses less than this share of its bounding box is taken for an open surface,
/// whose own mass properties would be meaningless. A thin bowl encloses about 5 %; a sheet, 0.
const LEAST_SOLIDITY: f64 = 0.01;

/// A shared triangle-mesh shape with its mass properties.
///
/// The mass properties belong to the enclosed volume, or to the bounding box if the mesh is open or
/// inside out.
#[derive(Clone)]
pub struct Solid {
    shape: SharedShape,
    mass_properties: MassProperties,
}

impl Solid {
    /// Prepares `mesh`.
    pub fn new(mesh: &Mesh) -> Self {
        let shape = mesh.shape();
        let bounds = mesh.bounds();
        let is_solid = mesh.volume() > LEAST_SOLIDITY * f64::from(bounds.volume());
        let mass_properties = if is_solid {
            shape.mass_properties(DENSITY)
        } else {
            let mut properties = MassProperties::from_cuboid(DENSITY, bounds.half_extents());
            properties.local_com = bounds.center();
            properties
        };
        Self { shape, mass_properties }
    }

    /// A collider of this shape; all of them share its memory.
    pub fn collider(&self) -> ColliderBuilder {
        ColliderBuilder::new(self.shape.clone()).mass_properties(self.mass_properties)
    }
}
