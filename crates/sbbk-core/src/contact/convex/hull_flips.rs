//! Makes a nearly convex surface convex.
//!
//! A host that computes in f32 splits nearly flat faces of a hull in any way, and leaves out points
//! on them. Flips of concave edges make such faces convex, as all of their corners are corners of
//! the hull.

use super::hull_surface::{HullSurface, plane};
use crate::contact::triangle::NEXT;
use glamx::DVec3;

/// Passes over all edges at most. Higher: surfaces farther from convex are mended.
const PASSES: usize = 8;

impl HullSurface {
    /// Flips edges until no triangle rises above the plane of a neighbour by more than `slack`.
    /// `None` if flips do not get there.
    pub fn flip_until_convex(&mut self, slack: f64) -> Option<()> {
        for _ in 0..PASSES {
            let mut is_convex = true;
            for face in 0..self.corners.len() {
                for edge in 0..3 {
                    if self.is_concave(face, edge, slack) {
                        is_convex = false;
                        self.flip(face, edge)?;
                    }
                }
            }
            if is_convex {
                return Some(());
            }
        }
        None
    }

    /// Adds a point if it is outside of the convex surface by more than `slack`. `None` if it is
    /// far outside.
    pub fn include(&mut self, point: DVec3, slack: f64) -> Option<()> {
        let rise = |(normal, height): &(DVec3, f64)| point.dot(*normal) - height;
        let rises = (0..).zip(self.planes.iter().map(rise));
        let (face, most) = rises.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
        if most <= slack {
            return Some(());
        }
        self.split(face, point)?;
        self.flip_until_convex(slack)
    }

    #[inline(always)]
    fn is_concave(&self, face: usize, edge: usize, slack: f64) -> bool {
        let (normal, height) = self.planes[face];
        let corners = &self.corners[usize::from(self.neighbors[face][edge])];
        corners.iter().any(|corner| corner.dot(normal) > height + slack)
    }

    /// Replaces an edge by the other diagonal of its two triangles. `None` if one end has three
    /// edges, and would keep two, or if a new triangle has no plane.
    fn flip(&mut self, face: usize, edge: usize) -> Option<()> {
        let [start, end] = [edge, NEXT[edge]].map(|i| self.corners[face][i]);
        let other = self.neighbors[face][edge];
        let ([a, b, c], [_, bc, ca]) = self.at_corner(face as u8, start);
        let ([_, _, d], [_, ad, db]) = self.at_corner(other, end);
        if ca == ad || bc == db {
            return None;
        }
        self.set(face as u8, [a, d, c], [ad, other, ca])?;
        self.set(other, [d, b, c], [db, bc, face as u8])?;
        self.join(ad, d, face as u8);
        self.join(bc, c, other);
        Some(())
    }

    /// Replaces a triangle by three with a common point. `None` if a triangle would have no plane.
    fn split(&mut self, face: u8, point: DVec3) -> Option<()> {
        let ([a, b, c], [ab, bc, ca]) = self.at_corner(face, self.corners[usize::from(face)][0]);
        let [second, third] = [0, 1].map(|i| self.corners.len() as u8 + i);
        for _ in 0..2 {
            self.planes.push((DVec3::ZERO, 0.0));
            self.corners.push([point; 3]);
            self.neighbors.push([face; 3]);
        }
        self.set(face, [a, b, point], [ab, second, third])?;
        self.set(second, [b, c, point], [bc, third, face])?;
        self.set(third, [c, a, point], [ca, face, second])?;
        self.join(bc, c, second);
        self.join(ca, a, third);
        Some(())
    }

    /// The corners and neighbours of a triangle, from one of its corners on.
    fn at_corner(&self, face: u8, corner: DVec3) -> ([DVec3; 3], [u8; 3]) {
        let first = self.edge_from(face, corner);
        let (face, order) = (usize::from(face), [first, NEXT[first], NEXT[NEXT[first]]]);
        (order.map(|i| self.corners[face][i]), order.map(|i| self.neighbors[face][i]))
    }

    /// The edge of a triangle that starts at one of its corners.
    fn edge_from(&self, face: u8, corner: DVec3) -> usize {
        let corners = &self.corners[usize::from(face)];
        corners.iter().position(|other| *other == corner).unwrap_or(0)
    }

    fn set(&mut self, face: u8, corners: [DVec3; 3], neighbors: [u8; 3]) -> Option<()> {
        let face = usize::from(face);
        self.planes[face] = plane(&corners)?;
        (self.corners[face], self.neighbors[face]) = (corners, neighbors);
        Some(())
    }

    /// Notes which triangle is across the edge from a corner.
    fn join(&mut self, face: u8, corner: DVec3, across: u8) {
        let edge = self.edge_from(face, corner);
        self.neighbors[usize::from(face)][edge] = across;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::Random;
    use std::f64::consts::TAU;

    /// A prism with two fans of triangles as ends. Its corners, and the middles of both ends, are
    /// off by up to `noise`.
    fn prism(sides: u32, noise: f64, random: &mut Random) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let at = |i: u32| {
            let (sin, cos) = (TAU * f64::from(i / 2) / f64::from(sides)).sin_cos();
            DVec3::new(cos, sin, f64::from(i % 2))
        };
        let ends = [DVec3::Z * (1.0 + 0.5 * noise), DVec3::Z * (-0.5 * noise)];
        let mut noisy = |point: DVec3| point + noise * random.vector(0.1).as_dvec3();
        let points = (0..2 * sides).map(at).map(&mut noisy).chain(ends).collect();
        let side = |i: u32| {
            let next = (i + 1) % sides;
            let [a, b, c, d] = [2 * i, 2 * i + 1, 2 * next + 1, 2 * next];
            [[a, c, b], [a, d, c]]
        };
        let end = |i: u32| [[1, 2 * i + 1, 2 * i + 3], [0, 2 * i + 2, 2 * i]];
        let triangles = (0..sides).flat_map(side).chain((1..sides - 1).flat_map(end)).collect();
        (points, triangles)
    }

    fn holds(surface: &HullSurface, points: &[DVec3], slack: f64) -> bool {
        let is_below = |(normal, height): &(DVec3, f64)| {
            points.iter().all(|point| point.dot(*normal) <= height + slack)
        };
        surface.planes.iter().all(is_below)
    }

    #[test]
    fn flips_make_rounded_faces_convex_around_all_points() {
        let mut random = Random(5);
        let mut flipped = 0;
        for noise in [0.0, 1.0e-9, 1.0e-7, 1.0e-5] {
            for sides in 3..60 {
                let (points, triangles) = prism(sides, noise, &mut random);
                let surface = HullSurface::from_triangles(&points, &triangles);
                let surface = surface.unwrap_or_else(|| panic!("{sides} sides, {noise}"));
                assert!(holds(&surface, &points, 1.0e-13), "{sides} sides, {noise}");
                let triangles_of = |corners: &[u32; 3]| corners.map(|i| points[i as usize]);
                let kept = triangles.iter().map(triangles_of);
                flipped += kept.filter(|kept| !surface.corners.contains(kept)).count();
                // Each end has its middle if that is outside.
                let count = if noise > 0.0 { 2 * points.len() - 4 } else { triangles.len() };
                assert_eq!(surface.corners.len(), count, "{sides} sides, {noise}");
            }
        }
        assert!(flipped > 1000, "{flipped}");
    }

    #[test]
    fn a_moved_middle_is_within_the_surface() {
        for height in [0.5, 1.5, 9.0] {
            let (mut points, triangles) = prism(8, 0.0, &mut Random(1));
            points[17] = DVec3::new(0.1, 0.0, height);
            let surface = HullSurface::from_triangles(&points, &triangles);
            assert!(surface.is_some_and(|surface| holds(&surface, &points, 1.0e-12)), "{height}");
        }
    }

    #[test]
    fn more_triangles_than_a_hull_has_are_refused() {
        let (points, _) = prism(60, 0.0, &mut Random(1));
        let corners =
            |i: u32| [i, i + 1 + i / 120, i + 40 + i / 120 * 7].map(|corner| corner % 120);
        let triangles: Vec<_> = (0..360).map(corners).collect();
        assert!(HullSurface::from_triangles(&points, &triangles).is_none());
    }

    #[test]
    fn a_corner_within_the_hull_is_refused() {
        let (mut points, triangles) = prism(8, 0.0, &mut Random(1));
        points[3] = DVec3::new(0.0, 0.0, 0.5);
        assert!(HullSurface::from_triangles(&points, &triangles).is_none());
    }
}
