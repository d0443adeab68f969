//! Volumes contain what they are fitted to; directions and their correspondence; the exact minimal
//! sphere.

use crate::prelude::*;
use glamx::DMat3;
use proptest::prelude::*;

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        -10.0f32..10.0,
        (-4i8..=4).prop_map(f32::from),
        -1e-3f32..1e-3,
        (-1.0f32..1.0).prop_map(|x| 1e5 + x),
    ]
}

fn point() -> impl Strategy<Value = Vec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from_array)
}

fn points() -> impl Strategy<Value = Vec<Vec3>> {
    prop::collection::vec(point(), 1..20)
}

proptest! {
    /// A volume contains what it was fitted to. A merged one contains the points of both sides.
    /// `contains` computes in f64, so this holds exactly.
    #[test]
    fn volumes_contain_their_points(a in points(), b in points()) {
        let (sphere, fitted) = (Sphere::fit(&a), kdop(&a));
        for &p in &a {
            prop_assert!(sphere.contains(p), "{sphere:?} lacks {p:?}");
            prop_assert!(fitted.contains(p), "{fitted:?} lacks {p:?}");
        }
        let merged = fitted.merge(&kdop(&b));
        for &p in a.iter().chain(&b) {
            prop_assert!(merged.contains(p), "merge: {merged:?} lacks {p:?}");
        }
        prop_assert_eq!(Kdop::EMPTY.merge(&fitted), fitted);
        prop_assert!(!Kdop::EMPTY.contains(a[0]));
    }

    /// Would catch coefficients whose sum is another direction, a bound below a point, and a loose
    /// one: a direction of the set gets coefficient 1.
    #[test]
    fn correspondence_is_conservative(seed in any::<u64>(), cloud in points()) {
        check_correspondence(seed, &cloud)?;
    }
}

fn check_correspondence(seed: u64, cloud: &[Vec3]) -> Result<(), TestCaseError> {
    let directions = directions::DIRECTIONS;
    let mut random = Random(seed);
    let rotation = random.rotation().as_dquat();
    let lattice = DVec3::from_array([0; 3].map(|_| (random.bits() % 5) as f64 - 2.0));
    let rotated = directions.map(|d| rotation * d.as_dvec3());
    for direction in rotated.into_iter().chain([lattice]) {
        let terms = directions::correspondence(direction);
        let sum: DVec3 = terms.iter().map(|&(slab, c)| directions[slab].as_dvec3() * c).sum();
        prop_assert!((sum - direction).length() < 1e-12, "{terms:?} is not {direction:?}");
        // The slab's interval times the signed coefficient bounds from above what `direction` sees.
        let seen = |d: DVec3| cloud.iter().map(|p| d.dot(p.as_dvec3())).fold(f64::MIN, f64::max);
        let bound: f64 = terms
            .iter()
            .map(|&(slab, c)| c.abs() * seen(directions[slab].as_dvec3() * c.signum()))
            .sum();
        prop_assert!(bound >= seen(direction) - 1e-6, "{bound} < {}", seen(direction));
    }
    for (slab, direction) in directions.into_iter().enumerate() {
        let terms = directions::correspondence(direction.as_dvec3());
        let used: Vec<_> = terms.into_iter().filter(|&(_, c)| c != 0.0).collect();
        prop_assert_eq!(used, vec![(slab, 1.0)]);
    }
    Ok(())
}

/// Projections and distances that round, the latter with squares that underflow too. Would catch
/// fitted volumes that are too small in their last digits: the loose tests above seldom come so
/// close.
#[test]
fn volumes_contain_their_points_to_the_last_digit() {
    let mut random = Random(13);
    for i in 0..20_000 {
        let size = [1.0, 1.0e-3, 1.0e-22, 1.0e-23][i % 4];
        let place = random.vector(1.0) * [1.0, 1.0e4, 0.0][i % 3];
        let cloud = [(); 3].map(|()| place + size * random.vector(1.0));
        let (fitted, sphere) = (kdop(&cloud), Sphere::fit(&cloud));
        for p in cloud {
            assert!(fitted.contains(p), "{fitted:?} lacks {p:?}");
            assert!(sphere.contains(p), "{sphere:?} lacks {p:?}");
        }
    }
}

/// No point is in a volume of none, or in one that is not a number.
#[test]
fn empty_and_nan_contain_nothing() {
    let bad = Vec3::splat(f32::NAN);
    assert!(!Sphere::fit(&[]).contains(Vec3::ZERO));
    assert!(!Sphere { centre: bad, radius: 1.0 }.contains(Vec3::ZERO));
    for volume in [Kdop { min: [f32::NAN; SLABS], max: [f32::NAN; SLABS] }, Kdop::EMPTY] {
        assert!(!volume.contains(Vec3::ZERO));
    }
}

/// The sphere through at most four support points, by Welzl's algorithm in f64: the exact minimum.
fn minimal_sphere(points: &[DVec3], support: &mut Vec<DVec3>) -> (DVec3, f64) {
    if points.is_empty() || support.len() == 4 {
        return sphere_through(support);
    }
    let (last, rest) = points.split_last().expect("not empty");
    let (centre, radius) = minimal_sphere(rest, support);
    if centre.distance(*last) <= radius + 1e-9 {
        return (centre, radius);
    }
    support.push(*last);
    let sphere = minimal_sphere(rest, support);
    support.pop();
    sphere
}

fn sphere_through(support: &[DVec3]) -> (DVec3, f64) {
    let Some((&first, rest)) = support.split_first() else { return (DVec3::ZERO, -1.0) };
    // The centre is first + Σ λ_i e_i with 2 e_j·(centre - first) = e_j².
    let edges: Vec<_> = rest.iter().map(|&p| p - first).collect();
    let mut gram = DMat3::IDENTITY;
    let mut right = DVec3::ZERO;
    for (i, a) in edges.iter().enumerate() {
        for (j, b) in edges.iter().enumerate() {
            gram.col_mut(j)[i] = 2.0 * a.dot(*b);
        }
        right[i] = a.length_squared();
    }
    let weights = if gram.determinant() == 0.0 { DVec3::ZERO } else { gram.inverse() * right };
    let offset: DVec3 = edges.iter().enumerate().map(|(i, &e)| e * weights[i]).sum();
    (first + offset, offset.length())
}

/// "Within 5 % of the exact minimal sphere."
#[test]
fn spheres_are_near_minimal() {
    let mut random = Random(12);
    let mut worst = 1.0f64;
    for i in 0..300 {
        let count = 1 + (random.bits() % 60) as usize;
        let stretch = [Vec3::ONE, Vec3::new(1.0, 0.2, 0.05), Vec3::new(1.0, 1.0, 0.01)][i % 3];
        let cloud: Vec<Vec3> = (0..count)
            .map(|_| match i % 4 {
                0 => random.vector(1.0).normalize_or(Vec3::X) * stretch,
                _ => random.vector(1.0) * stretch,
            })
            .collect();
        let sphere = Sphere::fit(&cloud);
        let mut exact: Vec<DVec3> = cloud.iter().map(|p| p.as_dvec3()).collect();
        exact.dedup();
        let (_, minimum) = minimal_sphere(&exact, &mut Vec::new());
        if minimum > 0.0 {
            worst = worst.max(f64::from(sphere.radius) / minimum);
        }
    }
    assert!(worst < 1.05, "the worst sphere is {worst} times the minimum");
    assert!(worst > 1.0, "no sphere was compared");
}
