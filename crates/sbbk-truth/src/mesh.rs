//! Two meshes: every triangle pair within a margin.

use super::triangle::{TruthContact, contact};
use glamx::{DPose3, DVec3};

/// A pair of triangles within the margin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruthPair {
    /// Indices of a triangle of mesh 1 and of one of mesh 2.
    pub triangles: [u32; 2],
    /// The distance, or minus the depth.
    pub distance: f64,
    /// Unit direction from triangle 1 to triangle 2, in the frame of mesh 1.
    pub normal: DVec3,
    /// See [`TruthContact::normal_is_unique`](super::TruthContact::normal_is_unique).
    pub normal_is_unique: bool,
}

struct Boxed {
    triangle: [DVec3; 3],
    index: u32,
    min: DVec3,
    max: DVec3,
}

/// All triangle pairs of two meshes at a distance of at most `margin`, sorted by both indices.
/// `pose` takes mesh 2 into the frame of mesh 1. Meshes are the corners of their triangles.
///
/// Skips pairs whose boxes are farther apart than the margin. Sorting by x finds them: 70,000 by
/// 70,000 small triangles take seconds. A mesh with one triangle as long as all others together
/// takes the product of both counts.
pub fn pairs_within(
    [mesh1, mesh2]: [impl IntoIterator<Item = [DVec3; 3]>; 2],
    pose: DPose3,
    margin: f64,
) -> Vec<TruthPair> {
    let placed = |corners: [DVec3; 3]| corners.map(|corner| pose * corner);
    let mut boxes2 = boxes(mesh2.into_iter().map(placed));
    boxes2.sort_by(|a, b| a.min.x.total_cmp(&b.min.x));
    let longest2 = boxes2.iter().map(|b| b.max.x - b.min.x).fold(0.0, f64::max);

    let mut pairs = Vec::new();
    for box1 in boxes(mesh1) {
        // Rounding moves a coordinate by 1e-16 of its magnitude: this is far more.
        let reach = margin + 1.0e-12 * (margin + box1.min.abs().max(box1.max.abs()).max_element());
        let first = boxes2.partition_point(|b| b.min.x < box1.min.x - longest2 - reach);
        for box2 in boxes2[first..].iter().take_while(|b| b.min.x <= box1.max.x + reach) {
            let gap = (box1.min - box2.max).max(box2.min - box1.max).max(DVec3::ZERO);
            if gap.length() > reach {
                continue;
            }
            let TruthContact { distance, normal, normal_is_unique } =
                contact(&box1.triangle, &box2.triangle);
            if distance <= margin {
                let triangles = [box1.index, box2.index];
                pairs.push(TruthPair { triangles, distance, normal, normal_is_unique });
            }
        }
    }
    pairs.sort_by_key(|pair| pair.triangles);
    pairs
}

fn boxes(mesh: impl IntoIterator<Item = [DVec3; 3]>) -> Vec<Boxed> {
    let boxed = |(index, triangle): (u32, [DVec3; 3])| {
        let [a, b, c] = triangle;
        Boxed { triangle, index, min: a.min(b).min(c), max: a.max(b).max(c) }
    };
    (0..).zip(mesh).map(boxed).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glamx::DQuat;

    /// Triangles of sizes 0.1 to 1 strewn over a cube, and one as large as all.
    fn strewn(seed: f64) -> Vec<[DVec3; 3]> {
        let noise =
            |i: u32, k: f64| ((f64::from(i) * 12.9898 + k * 78.233 + seed).sin() * 43758.5).fract();
        let corner =
            |i: u32, scale: f64| scale * DVec3::new(noise(i, 1.0), noise(i, 2.0), noise(i, 3.0));
        let place =
            |i: u32| if i < 3 { corner(i, 4.0) } else { corner(i / 3, 0.5) + corner(i, 0.5) };
        (0..80).map(|t| [3 * t, 3 * t + 1, 3 * t + 2].map(place)).collect()
    }

    #[test]
    fn the_sweep_finds_the_pairs_of_two_loops() {
        let meshes = [0.1, 0.7].map(strewn);
        let pose = DPose3::from_parts(DVec3::new(0.3, -0.2, 0.5), DQuat::from_rotation_y(0.8));
        for margin in [0.0, 0.1, 1.0] {
            let mut expected = Vec::new();
            for (i, t1) in (0..).zip(&meshes[0]) {
                for (j, t2) in (0..).zip(&meshes[1]) {
                    let found = contact(t1, &t2.map(|v| pose * v));
                    if found.distance <= margin {
                        expected.push(([i, j], found.distance));
                    }
                }
            }
            let pairs = pairs_within(meshes.clone(), pose, margin);
            let found: Vec<_> = pairs.iter().map(|p| (p.triangles, p.distance)).collect();
            assert_eq!(found, expected);
            let crosses = expected.iter().any(|p| p.1 < 0.0);
            assert!(expected.len() > 50 && crosses, "{}", expected.len());
        }
    }
}
