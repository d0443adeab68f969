//! Vertices where many triangles meet.

use crate::prelude::*;
use std::cell::Cell;

/// A triangulated surface that counts visited triangles.
struct Counted<'a> {
    facets: PlainFacets<'a>,
    visits: Cell<usize>,
    memo: PlaceMemo,
}

impl<'a> Counted<'a> {
    fn new(facets: PlainFacets<'a>) -> Self {
        Self { facets, visits: Cell::new(0), memo: PlaceMemo::default() }
    }
}

impl Facets for Counted<'_> {
    fn twin(&self, half_edge: u32) -> Option<u32> {
        self.visits.set(self.visits.get() + 1);
        self.facets.twin(half_edge)
    }

    fn corner(&self, half_edge: u32, i: usize) -> DVec3 {
        self.facets.corner(half_edge, i)
    }

    fn memo(&self) -> Option<&PlaceMemo> {
        Some(&self.memo)
    }
}

/// Would catch a cone that gets the answers of another cone. Both tips are at one place.
#[test]
fn cones_tip_to_tip_do_not_depend_on_which_is_asked_first() {
    const COUNT: u32 = 400;
    let cone = |wide: f32, side: f32| {
        let rim = (0..COUNT).map(move |i| {
            let (sin, cos) = (side * TAU * i as f32 / COUNT as f32).sin_cos();
            Vec3::new(side, wide * cos, wide * sin)
        });
        [Vec3::ZERO].into_iter().chain(rim)
    };
    let triangles = [0, COUNT + 1]
        .into_iter()
        .flat_map(|tip| (0..COUNT).map(move |i| [tip, tip + 1 + (i + 1) % COUNT, tip + 1 + i]));
    let vertices = cone(0.02, 1.0).chain(cone(2.0, -1.0)).collect();
    let mesh = Soup { vertices, triangles: triangles.collect() };
    let surface = mesh.surface();
    let answers = |order: [u32; 2]| {
        let ring = Around { facets: Counted::new(mesh.facets(&surface)), side: Side::Sheet };
        let is_minimum = |tip: u32| {
            // This triangle is far from those that rise.
            let lowest = tip * COUNT + COUNT / 2;
            ring.is_local_minimum(lowest, Feature::Vertex(0), DVec3::Y, None)
        };
        let mut found = order.map(|tip| (tip, is_minimum(tip)));
        found.sort_unstable();
        found.map(|(_, is_minimum)| is_minimum)
    };
    assert_eq!(answers([0, 1]), [true, false]);
    assert_eq!(answers([1, 0]), [true, false]);
}

/// Each triangle asks for another direction.
#[test]
fn work_at_the_tip_of_a_cone_grows_with_its_triangles() {
    let visits = [500, 8000].map(|count: u32| {
        let rim = |i: u32| {
            let (sin, cos) = (TAU * i as f32 / count as f32).sin_cos();
            Vec3::new(cos, sin, -1.0)
        };
        let vertices = [Vec3::ZERO].into_iter().chain((0..count).map(rim)).collect();
        let triangles = (0..count).map(|i| [0, 1 + i, 1 + (i + 1) % count]).collect();
        let mesh = Soup { vertices, triangles };
        let surface = mesh.surface();
        let ring = Around { facets: Counted::new(mesh.facets(&surface)), side: Side::Outer };
        for triangle in 0..count {
            let up = (rim(triangle).as_dvec3() + 8.0 * DVec3::Z).normalize();
            assert!(ring.is_local_minimum(triangle, Feature::Vertex(0), up, None));
            assert!(ring.points_inside(triangle, Feature::Vertex(0), -up));
        }
        ring.facets.visits.get()
    });
    assert!(visits[1] <= 40 * visits[0], "{visits:?}");
}
