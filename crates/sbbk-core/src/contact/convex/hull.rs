//! The hull of many points.

use super::ConvexContact;
use super::faces::HullFaces;
use super::support::SupportMap;
use crate::simd::bits;
use crate::volumes::rounding::gamma;
use glamx::{DVec3, Vec3};
use std::sync::OnceLock;
use wide::f32x4;

/// Lanes of four points whose heights are stored between both passes; those of further points are
/// computed twice.
const KEPT: usize = 16;

/// The convex hull of points in f32, for many support queries. The hull of no points is the origin.
///
/// Heights are compared in f32, in lanes; points within rounding of the greatest height are
/// compared in f64. The result is the first of the farthest points.
#[derive(Clone, Debug, Default)]
pub struct HullPoints {
    points: Vec<Vec3>,
    /// The faces according to the host.
    triangles: Vec<[u32; 3]>,
    lanes: Vec<[f32x4; 3]>,
    /// The largest absolute coordinate along each axis.
    greatest: DVec3,
    /// Computed when a triangle first crosses the hull; `None` if rounding determines the faces.
    faces: OnceLock<Option<HullFaces>>,
}

impl HullPoints {
    /// Builds the hull of some points.
    pub fn new(points: impl IntoIterator<Item = Vec3>) -> Self {
        Self::with_faces(points, [])
    }

    /// Builds a hull whose depths are always found by search. Faces take longer than the search for
    /// a few triangles.
    pub fn without_faces(points: impl IntoIterator<Item = Vec3>) -> Self {
        Self { faces: OnceLock::from(None), ..Self::new(points) }
    }

    /// Builds the hull with its probable faces: triangles of point indices, counterclockwise from
    /// outside. They are checked, and mended where rounding makes them concave, when a triangle
    /// first crosses the hull. Good faces save three quarters of the time to build the hull's
    /// surface.
    pub fn with_faces(
        points: impl IntoIterator<Item = Vec3>,
        triangles: impl IntoIterator<Item = [u32; 3]>,
    ) -> Self {
        let points: Vec<Vec3> = points.into_iter().collect();
        let lanes = points.chunks(4).map(|four| {
            // The first point pads the lanes.
            let at = |i: usize| *four.get(i).unwrap_or(&four[0]);
            let axis = |axis: usize| f32x4::new([0, 1, 2, 3].map(|i| at(i)[axis]));
            [axis(0), axis(1), axis(2)]
        });
        let lanes = lanes.collect();
        let greatest = points.iter().fold(Vec3::ZERO, |most, point| most.max(point.abs()));
        let triangles = triangles.into_iter().collect();
        let greatest = greatest.as_dvec3();
        Self { points, triangles, lanes, greatest, faces: OnceLock::new() }
    }

    /// The first of the points that are farthest along a direction, in f64.
    #[cold]
    fn farthest(&self, direction: DVec3) -> DVec3 {
        let mut points = self.points.iter().map(|point| point.as_dvec3());
        let first = points.next().unwrap_or_default();
        let farther = |a: DVec3, b: DVec3| if b.dot(direction) > a.dot(direction) { b } else { a };
        points.fold(first, farther)
    }
}

impl SupportMap for HullPoints {
    #[inline(always)]
    fn support(&self, direction: DVec3) -> DVec3 {
        // Scaled, since f32 needs a length of about one.
        let scaled = direction * (1.0 / direction.abs().max_element());
        let [x, y, z] = scaled.as_vec3().to_array().map(f32x4::splat);
        let height = |lanes: &[f32x4; 3]| lanes[0] * x + lanes[1] * y + lanes[2] * z;
        let mut kept = [f32x4::ZERO; KEPT];
        let mut most = f32x4::splat(f32::NEG_INFINITY);
        for (i, lanes) in self.lanes.iter().enumerate() {
            let height = height(lanes);
            most = most.fast_max(height);
            if i < KEPT {
                kept[i] = height;
            }
        }
        let [a, b, c, d] = most.to_array();
        let most = f64::from(a.max(b).max(c.max(d)));
        // The direction rounds once, products and sums five times; below the least normal number
        // they lose more.
        let lost = self.greatest.dot(scaled.abs()) * f64::from(gamma(8))
            + self.greatest.element_sum() * f64::from(f32::MIN_POSITIVE);
        let least = (most - 2.0 * lost) as f32;
        if !least.is_finite() {
            return self.farthest(direction);
        }
        let least = f32x4::splat(least.next_down());
        let (mut farthest, mut most) = (Vec3::ZERO, f64::NEG_INFINITY);
        for (i, lanes) in self.lanes.iter().enumerate() {
            let height = if i < KEPT { kept[i] } else { height(lanes) };
            for lane in bits(height.simd_ge(least).to_bitmask()) {
                // Padding has no index; it is no farther than the first point.
                let point = self.points.get(4 * i + lane);
                let along = point.map_or(f64::NEG_INFINITY, |p| p.as_dvec3().dot(direction));
                if along > most {
                    (farthest, most) = (*point.expect("it has a height"), along);
                }
            }
        }
        farthest.as_dvec3()
    }

    fn penetration(&self, triangle: &[DVec3; 3], size: f64) -> Option<ConvexContact> {
        let faces = self.faces.get_or_init(|| {
            let points: Vec<DVec3> = self.points.iter().map(|point| point.as_dvec3()).collect();
            HullFaces::new(&points, &self.triangles)
        });
        faces.as_ref()?.penetration(triangle, size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::convex::convex_contact;
    use crate::support::Random;

    #[test]
    fn depths_by_search_equal_those_by_faces() {
        let mut random = Random(3);
        let points: Vec<Vec3> = (0..66).map(|_| random.vector(1.0).normalize()).collect();
        let hulls = [HullPoints::new(points.clone()), HullPoints::without_faces(points)];
        for _ in 0..100 {
            let triangle = [(); 3].map(|()| random.vector(0.9).as_dvec3());
            let [by_faces, by_search] =
                hulls.each_ref().map(|hull| convex_contact(&triangle, hull, 0.0));
            let depths = [by_faces, by_search].map(|contact| contact.map_or(1.0, |c| c.distance));
            assert!((depths[0] - depths[1]).abs() < 1.0e-9, "{depths:?}");
        }
        assert!(hulls[0].faces.get().is_some_and(Option::is_some));
        assert!(hulls[1].faces.get().is_some_and(Option::is_none));
    }
}
