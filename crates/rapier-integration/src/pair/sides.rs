//! Tells on which side of a sheet a body is, and whether a body is in a room.
//!
//! A sheet has two sides, and a body that crosses it leaves to the side of its middle. The nearest
//! point of the sheet to the middle tells that side for all triangles, so they agree on wavy
//! grounds. A body whose middle is a little behind the sheet may come from either side. The
//! contacts of the triangles then hold it, as they push both ways.
//!
//! A mesh inside a larger one is in a room, or in a solid that pushes it out.

use parry3d::math::{Real, Vector};
use parry3d::query::{PointQuery, Ray};
use sbbk_core::surface::SurfaceKind;
use sbbk_core::traverse::Placement;
use sbbk_core::volumes::Sphere;

use super::islands::Crossing;
use super::pose::PairPose;
use super::query::ContactList;
use super::shapes::{
    NEARLY_TOUCHING, OverSheet, Room, TriangleHit, TriangleShape, TriangleShapes,
    TriangleSurfaceContact, filter_distance, filter_unit,
};
use super::tuning::{LIP, ROOM_DEPTH, SAME_SIDE, SLAB, STICKS_OUT, SURE_SIDE};
use crate::mesh::{BEHIND, LazySurface, MeshView, is_covered};

impl TriangleShapes<'_> {
    /// Returns the position of the other shape over the nearest point of a sheet, unless that is at
    /// a border.
    pub(super) fn over_sheet(&self, sheet: usize) -> Option<OverSheet> {
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

    /// Returns the height over the front of a sheet, with a preference for the front, if there is
    /// one.
    pub(super) fn leaning(&self, over: OverSheet, sheet: usize, triangle: u32) -> f64 {
        let has_front = self[sheet].has_front(triangle);
        over.height + if has_front { f64::from(STICKS_OUT) * over.half_height } else { 0.0 }
    }

    /// Returns the first triangle that crosses a sheet, and the position of the other shape over
    /// the sheet.
    fn crossed_sheet(&self, crossings: &[Crossing]) -> Option<([u32; 2], usize, OverSheet)> {
        let sheet_of = |crossing: &Crossing| Some((crossing.pair, crossing.sheet?.shape?));
        let (pair, sheet) = crossings.iter().find_map(sheet_of)?;
        Some((pair, sheet, self.over_sheet(sheet)?))
    }

    /// Returns true if triangles cross a sheet, and the body may come from either side. Its middle
    /// is a little behind the front, or the sheet has no front there. A body that hovers, or sinks in
    /// a little at rest, is not in doubt.
    pub(super) fn is_side_doubtful(&self, crossings: &[Crossing]) -> bool {
        let Some((pair, sheet, over)) = self.crossed_sheet(crossings) else { return false };
        let OverSheet { height, half_height, .. } = over;
        if height > -SURE_SIDE * half_height && self[sheet].has_front(pair[sheet]) {
            return false;
        }
        let sunk = half_height - height.abs();
        sunk > LIP * self.filter_unit() && height.abs() < self.filter_distance
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

/// Share of an f32 distance that is a lower bound of the exact one.
const SURE: f64 = 0.99;

/// Last result of the test whether the smaller mesh is inside the larger one. Spares most queries a
/// test.
#[derive(Clone, Debug, Default)]
pub(crate) struct InsideTest {
    /// [`Room::No`] if a point of the smaller mesh was outside, or if the larger mesh is no solid.
    room: Room,
    /// Placement of the smaller mesh; `None` before a test.
    placement: Option<Placement>,
    /// Motion for which the larger mesh stays such a room.
    slack: f64,
}

impl InsideTest {
    /// The larger mesh stays such a room for a motion of `slack`.
    fn new(room: Room, placement: &Placement, slack: f32) -> Self {
        Self { room, placement: Some(*placement), slack: SURE * f64::from(slack) }
    }

    /// Returns the room that holds a mesh. `None` if the last result does not hold for a mesh with
    /// points in `ball`.
    fn known(&self, ball: Sphere, placement: &Placement) -> Option<Room> {
        (self.rest(ball, placement) > 0.0).then_some(self.room)
    }

    /// Returns the motion for which the last result still holds.
    fn rest(&self, ball: Sphere, placement: &Placement) -> f64 {
        self.placement.as_ref().map_or(0.0, |before| {
            self.slack - placement.motion_bound(before, ball.centre, ball.radius)
        })
    }
}

/// A mesh, and a larger one that may hold it.
pub(super) struct HeldMesh<'a> {
    pose: &'a PairPose,
    held: &'a MeshView<'a>,
    holder: &'a MeshView<'a>,
    /// Surface of the holder.
    surface: &'a LazySurface<'a>,
    /// 0 if the holder is shape 1, else 1.
    outer: usize,
    room: Room,
}

impl<'a> HeldMesh<'a> {
    /// Returns `None` unless two meshes have contacts of surfaces.
    pub(super) fn of(shapes: &'a TriangleShapes<'_>) -> Option<Self> {
        let outer = shapes.larger;
        let (held, holder) = (shapes[1 - outer].mesh()?, shapes[outer].mesh()?);
        let TriangleShape { surface, room, .. } = &shapes[outer];
        let (pose, surface) = (shapes.pose, surface.as_ref()?);
        Some(Self { pose, held, holder, surface, outer, room: *room })
    }

    /// Returns a motion for which a mesh without contacts is not pushed out.
    pub(super) fn calm(&self, in_room: &InsideTest, inside: &InsideTest) -> f64 {
        let test = if self.room == Room::No { inside } else { in_room };
        test.rest(self.held.ball(), self.placement())
    }

    /// Returns the room that the larger mesh is for the smaller one. The middle of the smaller one
    /// is in it.
    pub(super) fn room(&self, test: &mut InsideTest) -> Room {
        let Self { held, holder, .. } = self;
        if !held.sorted_extents().cmplt(holder.sorted_extents()).all() {
            return Room::No;
        }
        let (ball, placement) = (held.ball(), self.placement());
        if let Some(room) = test.known(ball, placement) {
            return room;
        }
        let middle = self.in_holder(ball.centre);
        let Some((exit, room)) = self.room_around(middle, test) else {
            return if self.is_behind_wall(middle, test) { Room::FacingIn } else { Room::No };
        };
        let slack = match room {
            Room::FacingOut => self.slack_in_room(middle, exit),
            _ => self.slack_in_inward_room(middle, exit),
        };
        if let Some(slack) = slack.filter(|slack| *slack > 0.0) {
            *test = InsideTest::new(room, placement, slack);
        }
        if slack.is_some() { room } else { Room::No }
    }

    /// Returns true if the middle of the held mesh is a little behind a wall of a room whose faces
    /// lead in. A fast body is there after a step. Low rooms may be flat solids that are inside
    /// out. `middle` is outside.
    fn is_behind_wall(&self, middle: Vector, test: &mut InsideTest) -> bool {
        let most = f64::from(STICKS_OUT * self.held.ball().radius);
        if test.rest(self.held.ball(), self.placement()) > most {
            test.slack -= most;
            return false;
        }
        if self.surface.kind() != SurfaceKind::InsideOut {
            return false;
        }
        *test = InsideTest::default();
        let Some((_, wall, behind)) = self.surface.nearest(middle) else { return false };
        let distance = wall.distance(middle);
        // A ray from the wall itself may meet the wall.
        let within = wall + self.holder.rounding() * (wall - middle).normalize_or_zero();
        behind <= -BEHIND
            && distance < STICKS_OUT * self.held.height(self.way_to(wall), distance / STICKS_OUT)
            && !self.is_lower(self.least_height(), within, wall, -1.0)
    }

    /// Returns a motion for which a mesh whose faces lead out stays a room. `None` if the mesh is
    /// no room. The held mesh hardly sticks out of a room. A long tube is a room although its ends
    /// are open. Flat solids are no rooms, nor are solids that thin bodies have just sunk in.
    fn slack_in_room(&self, middle: Vector, exit: Vector) -> Option<Real> {
        let depth = exit.distance(middle);
        let height = self.held.height(self.way_to(exit), depth / (1.0 - STICKS_OUT));
        let unit = filter_unit(self.pose, filter_distance(true, self.held.ball().radius));
        let is_in_room = depth >= (1.0 - STICKS_OUT) * height
            && f64::from(depth + height) >= ROOM_DEPTH * unit
            && !self.is_lower(self.least_height(), middle, exit, 1.0)
            && !self.surface.is_declared_solid();
        // No test above depends on more than this depth. At half the height of a room, the other
        // half is beyond.
        let radius = self.held.ball().radius;
        let enough = ((1.0 - STICKS_OUT) * radius).max(0.5 * self.least_height());
        is_in_room.then_some(depth - enough)
    }

    /// Returns a motion for which a mesh whose faces lead in stays a room. `None` if the mesh is no
    /// room. Bodies that fit in a low hall are in a room. Thin bodies have just sunk in a flat
    /// solid that is inside out.
    fn slack_in_inward_room(&self, middle: Vector, exit: Vector) -> Option<Real> {
        let depth = exit.distance(middle);
        let fits = || {
            let height = self.held.height(self.way_to(exit), 0.0);
            depth + height >= self.pose.prediction
                && !self.is_lower(2.0 * height, middle, exit, -1.0)
        };
        let is_room = !self.is_lower(self.least_height(), middle, exit, -1.0) || fits();
        // From this depth on, the result stays the same.
        let enough = self.held.ball().radius.min(0.5 * self.least_height());
        is_room.then_some(depth - enough)
    }

    /// Returns the direction from the middle of the held mesh to a point of the holder, in the
    /// frame of the held mesh.
    fn way_to(&self, point: Vector) -> Vector {
        (self.pose.in_other(self.outer, point) - self.held.ball().centre).normalize_or_zero()
    }

    /// Returns the placement of the held mesh in the frame of the holder.
    fn placement(&self) -> &'a Placement {
        self.pose.placement_of(1 - self.outer)
    }

    /// Least height of a room.
    fn least_height(&self) -> Real {
        SLAB * 2.0 * self.holder.sorted_extents().y
    }

    /// Returns a point of the held mesh in the frame of the holder.
    fn in_holder(&self, point: Vector) -> Vector {
        self.pose.in_other(1 - self.outer, point)
    }

    /// Returns true if the larger mesh is thinner than a height at `point`, measured along the line
    /// through `exit`, its nearest point. `outward` is the sign with which normals lead out of the
    /// mesh.
    fn is_lower(&self, height: Real, point: Vector, exit: Vector, outward: f64) -> bool {
        let most = height - exit.distance(point);
        let ray = Ray::new(point, (point - exit).normalize_or_zero());
        self.holder.exit(&ray, Some(outward)).is_some_and(|(length, _)| length < most)
    }

    /// Returns the nearest point of the larger mesh, and the room that it may be, if a point of the
    /// smaller one is inside. `point` is in the frame of the larger mesh.
    fn room_around(&self, point: Vector, test: &mut InsideTest) -> Option<(Vector, Room)> {
        let Self { holder, surface, .. } = self;
        let placement = self.placement();
        let from_box = holder.root().distance_to_local_point(point, true);
        if from_box > 0.0 {
            *test = InsideTest::new(Room::No, placement, from_box);
            return None;
        }
        let is_covered = is_covered(holder.mesh, point);
        let (_, near, behind) = surface.nearest(point)?;
        let kind = surface.kind();
        let is_behind = behind >= BEHIND && (is_covered || kind != SurfaceKind::Sheet);
        let sign = is_covered.then(|| surface.winding_sign(point)).flatten().unwrap_or(0);
        let room = match sign {
            1.. => Room::FacingOut,
            ..0 => Room::FacingIn,
            // A ray may leave through a hole, or through the open end of a tube.
            0 if !is_behind => Room::No,
            0 if kind == SurfaceKind::InsideOut => Room::FacingIn,
            0 => Room::FacingOut,
        };
        if room == Room::No && (behind < -BEHIND || !is_covered) {
            *test = InsideTest::new(Room::No, placement, near.distance(point));
        }
        (room != Room::No).then_some((near, room))
    }

    /// Returns the contact that leads the held mesh out of a solid, by the shortest way from its
    /// middle.
    ///
    /// Tests one vertex: a mesh that pierces the surface has contacts.
    pub(super) fn push_out(&self, test: &mut InsideTest) -> Option<TriangleHit> {
        let Self { pose, held, holder, surface, outer, room } = *self;
        let vertex = self.in_holder(held.corners(0)[0]);
        let known = test.known(held.ball(), self.placement());
        if room != Room::No || known == Some(Room::No) {
            return None;
        }
        self.room_around(vertex, test)?;
        if surface.kind() == SurfaceKind::Sheet {
            *test = InsideTest::new(Room::No, self.placement(), Real::INFINITY);
            return None;
        }
        let middle = self.in_holder(held.ball().centre);
        let (triangle, exit, from) = [middle, vertex].into_iter().find_map(|from| {
            let (triangle, exit, behind) = surface.nearest(from)?;
            (behind >= BEHIND).then_some((triangle, exit, from))
        })?;
        let mut subshapes = [0; 2];
        subshapes[outer] = triangle;
        let first = if outer == 0 { holder } else { held };
        let origin = first.corners(subshapes[0])[0];
        let mut points = [exit, from].map(|point| pose.in_local(outer, point, origin));
        if outer == 1 {
            points.reverse();
        }
        let [point1, point2] = points;
        let normal = (point1 - point2).try_normalize()?;
        let distance = (point2 - point1).dot(normal);
        holder.store.counters.push_outs.raise();
        Some((subshapes, TriangleSurfaceContact::push_out(normal, distance, points)))
    }
}
