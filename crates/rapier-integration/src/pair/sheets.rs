//! The side of a sheet on which a body is.
//!
//! A sheet has two sides, and a body that crosses it leaves to the side of its middle. The nearest point of the sheet
//! to the middle tells that side for all triangles, so they agree on wavy grounds. A body whose middle is a little
//! behind the sheet may come from either side. The contacts of the triangles then hold it, as they push both ways.

use glamx::DVec3;

use super::islands::{Crossing, SAME_SIDE, SheetSide};
use super::query::ContactList;
use super::surface::{LIP, NEARLY_TOUCHING, SurfaceFilter};
use super::triangle_shapes::{OverSheet, TriangleShapes, TriangleSurfaceContact};

/// Greatest depth of a body's middle behind a sheet that still pushes it to the front, in half
/// heights of the body. Higher: bodies from behind are pulled through; lower: bodies that hit a
/// ground fast fall out below.
const LEAN: f64 = 0.33;

impl TriangleShapes<'_> {
    /// Returns the position of the other shape over the nearest point of a sheet, unless that is at a border.
    fn over_sheet(&self, sheet: usize) -> Option<OverSheet> {
        *self.over_sheets[sheet].get_or_init(|| {
            let (body, rotation) = (1 - sheet, self.pose.pos12.rotation);
            let middle = self.pose.in_other(body, self[body].bounds().center());
            let (nearest, behind) = self[sheet].nearest(middle)?;
            let own = -behind.signum() * (middle - nearest).normalize_or_zero();
            let [front, on_body] = match sheet {
                0 => [own, rotation.inverse() * own],
                _ => [rotation * own; 2],
            };
            let distance = f64::from(middle.distance(nearest));
            let is_on_sheet = distance <= NEARLY_TOUCHING * f64::from(middle.abs().max_element());
            (is_on_sheet || f64::from(behind).abs() >= SAME_SIDE).then(|| OverSheet {
                front: front.as_dvec3(),
                height: f64::from((middle - nearest).dot(own)),
                half_height: f64::from(self[body].height(on_body)),
            })
        })
    }

    /// Returns the height over the front of a sheet, with a preference for the front. A triangle with a double that is wound the
    /// other way has no front.
    fn leaning(&self, over: OverSheet, sheet: usize, triangle: u32) -> f64 {
        let has_front = !self[sheet].is_two_sided(triangle);
        if has_front { over.height + LEAN * over.half_height } else { over.height }
    }

    /// Returns the first triangle that crosses a sheet, and the position of the other shape over the sheet.
    fn crossed_sheet(&self, crossings: &[Crossing]) -> Option<([u32; 2], usize, OverSheet)> {
        let sheet_of = |crossing: &Crossing| Some((crossing.pair, crossing.sheet?.shape?));
        let (pair, sheet) = crossings.iter().find_map(sheet_of)?;
        Some((pair, sheet, self.over_sheet(sheet)?))
    }

    /// Returns true if triangles cross a sheet, and the body is a little behind the front and may come from either side. A body
    /// at rest, which sinks in a little, does not.
    pub(super) fn is_side_doubtful(&self, crossings: &[Crossing]) -> bool {
        let Some((pair, sheet, over)) = self.crossed_sheet(crossings) else { return false };
        if self.leaning(over, sheet, pair[sheet]) > 0.0 {
            return false;
        }
        let OverSheet { height, half_height, .. } = over;
        let sunk = half_height - height.abs();
        let is_at_rest = (0.0..=LIP * self.filter_unit()).contains(&sunk);
        !is_at_rest && height.abs() < self.filter_distance
    }

    /// Removes the contacts that push a body through a sheet which its triangles cross.
    pub(super) fn reject_through(
        &self,
        crossings: &[Crossing],
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        let Some((pair, sheet, over)) = self.crossed_sheet(crossings) else { return };
        let height = self.leaning(over, sheet, pair[sheet]);
        let away = [over.front, -over.front][sheet] * height.signum();
        contacts.retain(|(_, hit)| hit.contact.normal.dot(away) > -SAME_SIDE);
    }
}

impl SurfaceFilter<'_> {
    /// Returns the side of a sheet's triangle on which the middle of a solid, or of a smaller sheet,
    /// is. `None` for two solids, and if the solid is larger than the sheet.
    pub(super) fn sheet_side(&self, is_solid: [bool; 2]) -> Option<SheetSide> {
        let smaller = self.smaller();
        let body = match is_solid {
            [true, true] => return None,
            [true, false] => 0,
            [false, true] => 1,
            [false, false] => match smaller {
                Some(smaller) => smaller,
                // The side must not depend on the order of two sheets of one size.
                None => return self.side_between(),
            },
        };
        let sheet = 1 - body;
        if smaller == Some(sheet) {
            return None;
        }
        let (normal, height) = self.height_over(sheet);
        Some(SheetSide { shape: Some(sheet), away: [normal, -normal][sheet], height })
    }

    /// Returns the side of two sheets of one size, by the direction from one middle to the other.
    fn side_between(&self) -> Option<SheetSide> {
        let [middle1, middle2] = [0, 1].map(|i| self.shapes[i].bounds().center());
        let between = self.shapes.pose.placement12.to_frame1(middle2, middle1);
        Some(SheetSide { shape: None, away: between.try_normalize()?, height: between.length() })
    }

    /// Returns the normal of a sheet's triangle, and the height of the other shape's middle over the front.
    fn height_over(&self, sheet: usize) -> (DVec3, f64) {
        let (normal, height) = self.middle_over(sheet);
        let own = self.in_frame(1 - sheet, normal).as_vec3();
        let over = self.shapes.over_sheet(sheet);
        let over = over.map(|over| (over, over.front.dot(normal)));
        let over = match over.filter(|(_, along)| along.abs() > SAME_SIDE) {
            Some((over, along)) => OverSheet { height: along.signum() * over.height, ..over },
            None => {
                let half_height = f64::from(self.shapes[1 - sheet].height(own));
                OverSheet { front: normal, height, half_height }
            }
        };
        (normal, self.shapes.leaning(over, sheet, self.pair[sheet]))
    }
}
