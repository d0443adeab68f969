//! Which triangles of two meshes can be near the other mesh at all.

use glamx::{DPose3, DVec3};

/// A mesh in f64: vertices and triangles.
pub(super) type Surface<'a> = (&'a [DVec3], &'a [[u32; 3]]);

/// Some triangles of a mesh.
pub(super) struct Part {
    /// Their indices in the mesh, ascending.
    pub indices: Vec<u32>,
    /// Their vertices.
    pub triangles: Vec<[u32; 3]>,
}

#[derive(Clone, Copy)]
struct Box3 {
    min: DVec3,
    max: DVec3,
}

/// Rounds of narrowing: each leaves the triangles near the box around what the one before left of
/// the other mesh. More than two leave hardly fewer.
const ROUNDS: usize = 2;

/// The parts of both meshes, the second one at `pose`, outside of which no triangle is within
/// `margin` of one of the other mesh. Bodies in touch share a small part of their boxes, so this
/// saves brute force most of its work; it leaves out nothing that boxes do not prove to be far.
pub(super) fn near_parts(surfaces: [Surface; 2], pose: DPose3, margin: f64) -> [Part; 2] {
    let [(vertices1, triangles1), (vertices2, triangles2)] = surfaces;
    let boxes = [
        boxes(triangles1, |i| vertices1[i as usize]),
        boxes(triangles2, |i| pose * vertices2[i as usize]),
    ];
    let mut indices = boxes.each_ref().map(|boxes| (0..boxes.len() as u32).collect::<Vec<_>>());
    for _ in 0..ROUNDS {
        for (kept, other) in [(0, 1), (1, 0)] {
            let bounds = bounds(indices[other].iter().map(|&i| boxes[other][i as usize]));
            indices[kept].retain(|&i| boxes[kept][i as usize].is_near(&bounds, margin));
        }
    }
    let [indices1, indices2] = indices;
    [(indices1, triangles1), (indices2, triangles2)].map(|(indices, all)| Part {
        triangles: indices.iter().map(|&i| all[i as usize]).collect(),
        indices,
    })
}

impl Box3 {
    fn is_near(&self, other: &Self, margin: f64) -> bool {
        // Rounding moves a coordinate by 1e-16 of its magnitude: this is far more.
        let magnitude = self.min.abs().max(self.max.abs()).max_element();
        let reach = DVec3::splat(margin + 1.0e-12 * (margin + magnitude));
        (self.min - reach).cmple(other.max).all() && other.min.cmple(self.max + reach).all()
    }
}

fn boxes(triangles: &[[u32; 3]], vertex: impl Fn(u32) -> DVec3) -> Vec<Box3> {
    let around = |corners: &[u32; 3]| {
        bounds(corners.map(&vertex).into_iter().map(|corner| Box3 { min: corner, max: corner }))
    };
    triangles.iter().map(around).collect()
}

fn bounds(boxes: impl Iterator<Item = Box3>) -> Box3 {
    let nothing = Box3 { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
    boxes.fold(nothing, |a, b| Box3 { min: a.min.min(b.min), max: a.max.max(b.max) })
}

#[cfg(test)]
mod tests {
    use sbbk_core::truth::pairs_within;

    use super::*;
    use crate::mesh;

    /// Would catch a part that leaves out a contact, or one that saves nothing.
    #[test]
    fn parts_hold_every_pair_and_little_else() {
        let ball = mesh::ball(1.0, 8);
        let vertices: Vec<DVec3> = ball.vertices.iter().map(|v| v.as_dvec3()).collect();
        let pose = DPose3::new(DVec3::new(1.0, 1.2, 1.1), DVec3::new(0.3, -0.8, 0.5));
        let surface = (&*vertices, &*ball.triangles);
        let [part1, part2] = near_parts([surface; 2], pose, 0.05);
        let all = pairs_within(&vertices, &ball.triangles, &vertices, &ball.triangles, pose, 0.05);
        let near =
            pairs_within(&vertices, &part1.triangles, &vertices, &part2.triangles, pose, 0.05);
        let by_mesh: Vec<_> = near
            .iter()
            .map(|p| (part1.indices[p.triangle1 as usize], part2.indices[p.triangle2 as usize]))
            .collect();
        let expected: Vec<_> = all.iter().map(|p| (p.triangle1, p.triangle2)).collect();
        assert!(!expected.is_empty());
        assert_eq!(by_mesh, expected);
        for part in [part1, part2] {
            assert!(part.indices.len() < ball.triangle_count() / 3, "{}", part.indices.len());
        }
    }
}
