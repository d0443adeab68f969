//! Trays, rooms and tables, as meshes with flaws or without, and as cuboids for the control.

use super::prelude::*;
use crate::study::hard::heaps::open_box;

/// Thickness of the walls of trays, and of rooms in the control.
const WALL: f32 = 0.5;

/// Boxes, each with its middle and half its sides.
type Boxes = Vec<[Vec3; 2]>;

fn compound(boxes: &Boxes) -> SharedShape {
    let cuboid = |&[at, half]: &[Vec3; 2]| {
        (Pose3::from_translation(at), SharedShape::cuboid(half.x, half.y, half.z))
    };
    SharedShape::compound(boxes.iter().map(cuboid).collect())
}

/// The six walls around a room, or without the one above.
fn walls(halves: Vec3, has_roof: bool) -> Boxes {
    let sides = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    let sides = sides.filter(|side| has_roof || side.y <= 0.0);
    let wall = |side: Vec3| {
        let half = (halves + Vec3::splat(2.0 * WALL)) * (Vec3::ONE - side.abs());
        [side * (halves + Vec3::splat(WALL)), half + WALL * side.abs()]
    };
    sides.map(wall).collect()
}

impl Draw {
    /// A square tray, its bottom at height 0.
    pub fn tray(&mut self) -> Part {
        let [half, rim] = [(2.2, 3.0), (1.5, 4.0)].map(|(low, high)| self.within(low, high));
        let diagonals = [half, half + WALL].map(|half| half * 2.0_f32.sqrt());
        let turn = Pose3::from_rotation(Quat::from_rotation_y(FRAC_PI_4));
        let tray = open_box(diagonals, rim, WALL).posed(&turn);
        let up = 0.5 * rim * Vec3::Y;
        let boxes = walls(Vec3::new(half, 0.5 * rim, half), false);
        let boxes = boxes.into_iter().map(|[at, sides]| [at + up, sides]).collect();
        self.sometimes_flawed("tray", Part::clean(tray, Some(compound(&boxes))))
    }

    /// A closed box about the origin, its faces outward.
    pub fn room(&mut self, halves: Vec3) -> Part {
        let cells = [(); 6].map(|()| self.count(1, 12));
        let room = if self.chance(0.5) {
            mesh::uneven_box(halves, cells)
        } else {
            mesh::cuboid(halves, cells[0])
        };
        self.sometimes_flawed("room", Part::clean(room, Some(compound(&walls(halves, true)))))
    }

    /// A table of a top and four legs, with half their sides, its feet at height 0.
    pub fn table(&mut self, top: Vec3, leg: Vec3) -> Part {
        let at = (top - leg) * 0.95;
        let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]];
        let legs = corners.map(|[x, z]| [Vec3::new(x * at.x, leg.y, z * at.z), leg]);
        let boxes = [&legs[..], &[[(2.0 * leg.y + top.y) * Vec3::Y, top]]].concat();
        // Faces of legs and top lie within the table.
        let meshes = boxes
            .iter()
            .map(|&[at, half]| mesh::cuboid(half, self.count(1, 4)).mapped(|vertex| vertex + at));
        let table = Mesh::merged("table", &meshes.collect::<Vec<Mesh>>());
        self.sometimes_flawed("table", Part::clean(table, Some(compound(&boxes))))
    }
}
