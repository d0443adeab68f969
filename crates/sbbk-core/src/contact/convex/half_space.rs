//! A triangle and a half-space.

use super::ConvexContact;
use glamx::DVec3;

/// Returns the contact of a triangle with the half-space below the plane through the origin with
/// this unit normal, at the lowest corner. `None` beyond the margin, or if a number is not finite.
pub fn half_space_contact(
    triangle: &[DVec3; 3],
    normal: DVec3,
    margin: f64,
) -> Option<ConvexContact> {
    let [mut lowest, b, c] = triangle.map(|corner| (corner.dot(normal), corner));
    let sum = lowest.0 + b.0 + c.0;
    for other in [b, c] {
        if other.0 < lowest.0 {
            lowest = other;
        }
    }
    let (distance, on_triangle) = lowest;
    let contact = ConvexContact::new(on_triangle, -normal, distance);
    (sum.is_finite() && contact.is_finite() && distance <= margin).then_some(contact)
}
