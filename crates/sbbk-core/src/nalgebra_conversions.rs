//! Conversions between this crate's inputs and results and nalgebra's types.

use glamx::Vec3;
use nalgebra::{Matrix4, Point3};

use crate::traverse::Placement;
use crate::volumes::{Aabb, Sphere};

fn point(v: Vec3) -> Point3<f32> {
    Point3::from(v.to_array())
}

fn vector(p: Point3<f32>) -> Vec3 {
    Vec3::from_array(p.coords.into())
}

/// The corners with the smallest and the largest coordinates.
impl From<Aabb> for [Point3<f32>; 2] {
    fn from(aabb: Aabb) -> Self {
        [point(aabb.min), point(aabb.max)]
    }
}

/// From the corners with the smallest and the largest coordinates.
impl From<[Point3<f32>; 2]> for Aabb {
    fn from([min, max]: [Point3<f32>; 2]) -> Self {
        Self { min: vector(min), max: vector(max) }
    }
}

/// Centre and radius.
impl From<Sphere> for (Point3<f32>, f32) {
    fn from(sphere: Sphere) -> Self {
        (point(sphere.centre), sphere.radius)
    }
}

/// From centre and radius.
impl From<(Point3<f32>, f32)> for Sphere {
    fn from((centre, radius): (Point3<f32>, f32)) -> Self {
        Self { centre: vector(centre), radius }
    }
}

/// The affine map as a homogeneous matrix.
impl From<Placement> for Matrix4<f64> {
    fn from(placement: Placement) -> Self {
        let mut matrix = Self::identity();
        for (j, column) in placement.rotation.to_cols_array_2d().into_iter().enumerate() {
            for (i, entry) in column.into_iter().enumerate() {
                matrix[(i, j)] = entry;
            }
        }
        for (i, entry) in placement.translation.to_array().into_iter().enumerate() {
            matrix[(i, 3)] = entry;
        }
        matrix
    }
}

#[cfg(test)]
mod tests {
    use glamx::{Pose3, Quat};

    use super::*;
    use crate::volumes::Volume;

    /// A transposed matrix or swapped corners would be noticed here.
    #[test]
    fn conversions_keep_what_they_convert() {
        let points = [Vec3::new(1.0, -2.0, 3.0), Vec3::new(-4.0, 5.0, 6.0)];
        let aabb = Aabb::fit(&points);
        let corners: [Point3<f32>; 2] = aabb.into();
        assert_eq!(corners[0], Point3::new(-4.0, -2.0, 3.0));
        assert_eq!(Aabb::from(corners), aabb);
        let sphere = Sphere { centre: points[0], radius: 2.0 };
        assert_eq!(Sphere::from(<(Point3<f32>, f32)>::from(sphere)), sphere);

        let pose = Pose3::from_parts(points[1], Quat::from_rotation_z(0.7));
        let matrix: Matrix4<f64> = Placement::new(&pose).into();
        let moved = matrix.transform_point(&point(points[0]).cast());
        let expected = pose.transform_point(points[0]);
        assert!((moved - point(expected).cast()).norm() < 1e-6);
    }
}
