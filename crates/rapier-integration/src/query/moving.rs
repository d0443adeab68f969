//! A mesh and a convex shape on their ways.
//!
//! Along a floor the distance over the greatest speed is a short time, however often it is taken. But
//! a triangle and the shape are convex: as long as the plane between them, which does not turn, is
//! crossed by neither, they do not meet, and along its normal they hardly approach. So each triangle
//! that may be met within some time is advanced by itself, and the bodies by as much as the soonest:
//! at once to the impact, if there is one, else by a time that is doubled.

use parry3d::math::{Real, Vector};
use sbbk_core::query::{Advance, AdvanceOptions, Bodies, PartPair, advance};
use sbbk_core::traverse::Placement;
use sbbk_core::volumes::Sphere;

use super::nonlinear::NonlinearCast;
use super::touch::Touch;
use crate::pair::{ConvexSearch, FoundTriangle, MeshPlace, PlacedPart};

/// Steps by the distance alone, before triangles are advanced by themselves. Most casts need no more and
/// take a third of the time; with 8 or 24 casts take up to 1.4 times as long as with 16.
const PLAIN_STEPS: usize = 16;

/// How far ahead triangles are advanced by themselves at first, as a multiple of the time in which the
/// nearest may be met. A matter of time alone.
const AHEAD: f64 = 4.0;

/// Steps of a triangle by itself; then others may be sooner.
const STEP_LIMIT: usize = 20;

/// A mesh and a convex shape.
pub(super) struct MovingConvex<'a, 'q> {
    search: ConvexSearch<'a>,
    mesh_place: MeshPlace,
    cast: &'q NonlinearCast<'q>,
    options: AdvanceOptions,
    /// Triangles that the shape touches at the start, if that is asked.
    touching: Vec<u32>,
    /// Steps taken.
    steps: usize,
    /// For how long triangles were advanced by themselves in the last step. At least doubled each
    /// step.
    ahead: f64,
}

impl<'a, 'q> MovingConvex<'a, 'q> {
    pub(super) fn new(
        search: ConvexSearch<'a>,
        mesh_place: MeshPlace,
        cast: &'q NonlinearCast<'q>,
    ) -> Self {
        search.search_depths();
        let options = cast.options(mesh_place.swap(search.balls()));
        Self { search, mesh_place, cast, options, touching: Vec::new(), steps: 0, ahead: 0.0 }
    }

    /// The first impact. What is left out as it touches at the start and does not approach is looked
    /// at again: a shape that turns may come down with another end.
    pub(super) fn first_impact(&mut self) -> Option<Advance<FoundTouch>> {
        let (cast, options, thickness) = (self.cast, self.options, self.search.thickness());
        let found = cast.first_impact(self, options, thickness, |found, _| found.touch);
        if found.is_some_and(|found| found.time == options.start) {
            return found;
        }
        self.touching.iter().fold(found, |found, &triangle| {
            let end = found.map_or(options.end, |found| found.time);
            let again = self.meets_again(triangle, thickness, end);
            again.filter(|again| again.time < end || found.is_none()).or(found)
        })
    }

    /// When, until some time, the shape meets a triangle that it touches at the start: from one of some
    /// times on, as Parry has it, after which it would come out behind it.
    fn meets_again(&self, triangle: u32, thickness: Real, end: f64) -> Option<Advance<FoundTouch>> {
        let Self { cast, options, .. } = self;
        let mut one = MovingTriangle::new(self, triangle);
        cast.looks(thickness).take_while(|&time| time <= end).find_map(|time| {
            let placement = cast.placement_at(time);
            let pair = one.nearest(&placement, f64::INFINITY, &[])?;
            if !cast.approaches(&pair.touch, time, f64::from(thickness) + pair.distance.max(0.0)) {
                return None;
            }
            let options = AdvanceOptions { start: time, end, ..*options };
            advance(&mut one, |time| cast.placement_at(time), options)
        })
    }

    fn place(&mut self, placement: &Placement) {
        self.search.place(self.mesh_place, placement);
    }
}

/// A triangle and the shape, where they are nearest.
#[derive(Copy, Clone)]
pub(super) struct FoundTouch {
    name: [u32; 2],
    distance: f64,
    pub(super) touch: Touch,
}

impl FoundTouch {
    fn new(found: &FoundTriangle, placed: &PlacedPart, mesh_place: MeshPlace) -> Self {
        Self {
            name: mesh_place.swap([found.triangle, 0]),
            distance: found.contact.distance,
            touch: Touch {
                points: mesh_place.swap(found.points(placed)),
                normals: mesh_place.swap(found.normals(placed)),
            },
        }
    }
}

impl PartPair for FoundTouch {
    fn distance(&self) -> f64 {
        self.distance
    }

    fn name(&self) -> [u32; 2] {
        self.name
    }
}

impl Bodies for MovingConvex<'_, '_> {
    type Pair = FoundTouch;

    fn nearest(
        &mut self,
        placement: &Placement,
        reach: f64,
        besides: &[[u32; 2]],
    ) -> Option<FoundTouch> {
        self.place(placement);
        let Self { search, mesh_place, .. } = self;
        let counts = |triangle| !has(besides, *mesh_place, triangle);
        let found = search.nearest_where(reach, counts)?;
        Some(FoundTouch::new(&found, &search.placed, *mesh_place))
    }

    fn within(&mut self, placement: &Placement, reach: f64, mut found: impl FnMut(FoundTouch)) {
        self.place(placement);
        let Self { search, mesh_place, touching, .. } = self;
        search.within(reach, |triangle| {
            touching.push(triangle.triangle);
            found(FoundTouch::new(&triangle, &search.placed, *mesh_place));
        });
    }

    fn clear_time(&mut self, nearest: &FoundTouch, time: f64, besides: &[[u32; 2]]) -> f64 {
        self.steps += 1;
        if self.steps <= PLAIN_STEPS {
            return 0.0;
        }
        let AdvanceOptions { end, speed_bound, .. } = self.options;
        self.ahead = (AHEAD * nearest.distance / speed_bound).max(2.0 * self.ahead);
        let ahead = self.ahead.min(end - time);
        let Self { search, mesh_place, cast, options, .. } = &*self;
        let mesh_place = *mesh_place;
        let soonest = search.soonest(ahead, speed_bound, |triangle, limit| {
            if has(besides, mesh_place, triangle) {
                return None;
            }
            let mut one = MovingTriangle::new(self, triangle);
            let end = time + limit;
            let options = AdvanceOptions { start: time, end, step_limit: STEP_LIMIT, ..*options };
            let found = advance(&mut one, |time| cast.placement_at(time), options)?;
            Some(found.time - time)
        });
        if soonest.is_none() && ahead < self.ahead {
            return f64::INFINITY;
        }
        // Compared in f32: another triangle may be sooner by a rounding.
        soonest.unwrap_or(ahead) * (1.0 - 1.0e-6)
    }
}

/// Whether a triangle is among those named, in ascending order.
fn has(names: &[[u32; 2]], mesh_place: MeshPlace, triangle: u32) -> bool {
    names.binary_search(&mesh_place.swap([triangle, 0])).is_ok()
}

/// One triangle of the mesh and the shape.
struct MovingTriangle<'a> {
    moving: &'a MovingConvex<'a, 'a>,
    triangle: u32,
    placed: Option<PlacedPart>,
    /// How far triangle and shape reach from the centres of their motions, in the order of the pair.
    reaches: [f64; 2],
}

impl<'a> MovingTriangle<'a> {
    fn new(moving: &'a MovingConvex<'a, 'a>, triangle: u32) -> Self {
        let MovingConvex { search, mesh_place, cast, .. } = moving;
        let [mesh_body, shape_body] = mesh_place.swap([0, 1]);
        let centre = cast.motions[mesh_body].local_center;
        let arm = |corner: Vector| (corner - centre).as_dvec3().length();
        let reach = search.mesh.corners(triangle).map(arm).into_iter().fold(0.0, f64::max);
        let [_, ball] = search.balls();
        let reaches = mesh_place.swap([reach, cast.reach(shape_body, &ball)]);
        Self { moving, triangle, placed: None, reaches }
    }
}

impl Bodies for MovingTriangle<'_> {
    type Pair = FoundTouch;

    fn nearest(&mut self, placement: &Placement, reach: f64, _: &[[u32; 2]]) -> Option<FoundTouch> {
        let MovingConvex { search, mesh_place, .. } = self.moving;
        let placed = self.placed.insert(search.placed.moved(*mesh_place, placement));
        let found = search.triangle(placed, self.triangle, reach)?;
        Some(FoundTouch::new(&found, placed, *mesh_place))
    }

    fn within(&mut self, placement: &Placement, reach: f64, found: impl FnMut(FoundTouch)) {
        self.nearest(placement, reach, &[]).into_iter().for_each(found);
    }

    fn clear_time(&mut self, nearest: &FoundTouch, time: f64, _: &[[u32; 2]]) -> f64 {
        let MovingConvex { search, mesh_place, cast, .. } = self.moving;
        let Some(placed) = &self.placed else { return 0.0 };
        let [_, shape_body] = mesh_place.swap([0, 1]);
        let axis = nearest.touch.normals[shape_body];
        let gap = search.gap(placed, self.triangle, axis).max(0.0);
        let clear = gap / cast.approach_bound(shape_body, axis, time, self.reaches);
        // The shape stays in a ball around the centre of its motion, which does not turn.
        let centre = cast.motions[shape_body].local_center;
        let radius = (self.reaches[shape_body] * (1.0 + 1.0e-6)) as Real;
        let around = Sphere { centre, radius };
        let gap = search.gap_of_ball(placed, self.triangle, axis, &around).max(0.0);
        let mut reaches = self.reaches;
        reaches[shape_body] = 0.0;
        // Of numbers and NaN the numbers: 0 may be divided by 0.
        clear.max(gap / cast.approach_bound(shape_body, axis, time, reaches))
    }
}
