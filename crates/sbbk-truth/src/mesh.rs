//! Two meshes: every triangle pair within a margin.

use super::triangle::contact;
use glamx::{DPose3, DVec3};

/// A pair of triangles within the margin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruthPair {
    /// Index of the triangle of mesh 1.
    pub triangle1: u32,
    /// Index of the triangle of mesh 2.
    pub triangle2: u32,
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
/// `pose` takes mesh 2 into the frame of mesh 1.
///
/// Skips pairs whose boxes are farther apart than the margin. Sorting by x finds them: 70,000 by
/// 70,000 small triangles take seconds. A mesh with one triangle as long as all others together
/// takes the product of both counts.
pub fn pairs_within(
    vertices1: &[DVec3],
    triangles1: &[[u32; 3]],
    vertices2: &[DVec3],
    triangles2: &[[u32; 3]],
    pose: DPose3,
    margin: f64,
) -> Vec<TruthPair> {
    let boxes1 = boxes(triangles1, |i| vertices1[i as usize]);
    let mut boxes2 = boxes(triangles2, |i| pose * vertices2[i as usize]);
    boxes2.sort_by(|a, b| a.min.x.total_cmp(&b.min.x));
    let longest2 = boxes2.iter().map(|b| b.max.x - b.min.x).fold(0.0, f64::max);

    let mut pairs = Vec::new();
    for box1 in &boxes1 {
        // Rounding moves a coordinate by 1e-16 of its magnitude: this is far more.
        let reach = margin + 1.0e-12 * (margin + box1.min.abs().max(box1.max.abs()).max_element());
        let first = boxes2.partition_point(|b| b.min.x < box1.min.x - longest2 - reach);
        for box2 in boxes2[first..].iter().take_while(|b| b.min.x <= box1.max.x + reach) {
            let gap = (box1.min - box2.max).max(box2.min - box1.max).max(DVec3::ZERO);
            if gap.length() > reach {
                continue;
            }
            let contact = contact(&box1.triangle, &box2.triangle);
            if contact.distance <= margin {
                pairs.push(TruthPair {
                    triangle1: box1.index,
                    triangle2: box2.index,
                    distance: contact.distance,
                    normal: contact.normal,
                    normal_is_unique: contact.normal_is_unique,
                });
            }
        }
    }
    pairs.sort_by_key(|p| (p.triangle1, p.triangle2));
    pairs
}

fn boxes(triangles: &[[u32; 3]], vertex: impl Fn(u32) -> DVec3) -> Vec<Boxed> {
    let boxed = |(index, corners): (usize, &[u32; 3])| {
        let triangle = corners.map(&vertex);
        let (min, max) = (
            triangle[0].min(triangle[1]).min(triangle[2]),
            triangle[0].max(triangle[1]).max(triangle[2]),
        );
        Boxed { triangle, index: index as u32, min, max }
    };
    triangles.iter().enumerate().map(boxed).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glamx::DQuat;

    /// Triangles of sizes 0.1 to 1 strewn over a cube, and one as large as all.
    fn strewn(seed: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let noise =
            |i: u32, k: f64| ((f64::from(i) * 12.9898 + k * 78.233 + seed).sin() * 43758.5).fract();
        let corner =
            |i: u32, scale: f64| scale * DVec3::new(noise(i, 1.0), noise(i, 2.0), noise(i, 3.0));
        let place =
            |i: u32| if i < 3 { corner(i, 4.0) } else { corner(i / 3, 0.5) + corner(i, 0.5) };
        ((0..240).map(place).collect(), (0..80).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect())
    }

    #[test]
    fn the_sweep_finds_the_pairs_of_two_loops() {
        let ((vertices1, triangles1), (vertices2, triangles2)) = (strewn(0.1), strewn(0.7));
        let pose = DPose3::from_parts(DVec3::new(0.3, -0.2, 0.5), DQuat::from_rotation_y(0.8));
        for margin in [0.0, 0.1, 1.0] {
            let mut expected = Vec::new();
            for (i, t1) in (0..).zip(&triangles1) {
                for (j, t2) in (0..).zip(&triangles2) {
                    let t1 = t1.map(|v| vertices1[v as usize]);
                    let found = contact(&t1, &t2.map(|v| pose * vertices2[v as usize]));
                    if found.distance <= margin {
                        expected.push((i, j, found.distance));
                    }
                }
            }
            let pairs =
                pairs_within(&vertices1, &triangles1, &vertices2, &triangles2, pose, margin);
            let found: Vec<_> =
                pairs.iter().map(|p| (p.triangle1, p.triangle2, p.distance)).collect();
            assert_eq!(found, expected);
            assert!(
                expected.len() > 50 && expected.iter().any(|p| p.2 < 0.0),
                "{}",
                expected.len()
            );
        }
    }
}
