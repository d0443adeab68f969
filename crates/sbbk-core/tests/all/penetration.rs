//! Contacts that lead out of solids, by definitions that look at every axis.

use crate::support::Random;
use glamx::DVec3;
use sbbk_core::contact::{Feature, ManifoldPoints, TriangleContact, contact};

type Triangle = [DVec3; 3];

/// The contact, and whether it is extremal.
fn outward(
    t1: &Triangle,
    t2: &Triangle,
    solid: [bool; 2],
    ends: impl Fn(usize, Feature, DVec3) -> bool,
) -> Option<(TriangleContact, bool)> {
    let mut points = ManifoldPoints::new();
    let mut ask = |most| {
        sbbk_core::contact::penetration_out_of_solid(t1, t2, solid, &ends, most, &mut points)
    };
    let found = ask(None);
    // The short way has the same, if it is extremal and shallow enough.
    let extremal = ask(Some(1e9));
    assert!(extremal.is_none() || extremal == found);
    for most in [0.001, 0.1, 10.0] {
        assert_eq!(ask(Some(most)), extremal.filter(|contact| contact.distance >= -most));
    }
    found.map(|contact| (contact, extremal.is_some()))
}

fn normal([a, b, c]: &Triangle) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// The least and the greatest height of a triangle along an axis.
fn shadow(t: &Triangle, axis: DVec3) -> [f64; 2] {
    let heights = t.map(|corner| corner.dot(axis));
    [heights.into_iter().fold(f64::MAX, f64::min), heights.into_iter().fold(f64::MIN, f64::max)]
}

/// How far triangle 2 must move along an axis until it is in front of triangle 1.
fn overlap(t1: &Triangle, t2: &Triangle, axis: DVec3) -> f64 {
    shadow(t1, axis)[1] - shadow(t2, axis)[0]
}

/// Both normals and the products of two edges, both ways, with the sine of the angle of the edges.
fn all_axes(t1: &Triangle, t2: &Triangle) -> Vec<(DVec3, f64)> {
    let edges = |t: &Triangle| [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
    let (edges1, edges2) = (edges(t1), edges(t2));
    let crosses = edges1.iter().flat_map(|e1| {
        edges2.iter().map(move |e2| {
            let cross = e1.cross(*e2);
            (cross.normalize_or_zero(), cross.length() / (e1.length() * e2.length()))
        })
    });
    let axes = [(normal(t1), 1.0), (normal(t2), 1.0)].into_iter().chain(crosses);
    axes.flat_map(|(axis, sine)| [(axis, sine), (-axis, sine)]).collect()
}

/// How far an axis leads into the solids, as a sine; negative if it leads out of both.
fn lean(t1: &Triangle, t2: &Triangle, solid: [bool; 2], axis: DVec3) -> f64 {
    let into = [-normal(t1).dot(axis), normal(t2).dot(axis)];
    let leans = into.into_iter().zip(solid).filter(|&(_, is_solid)| is_solid);
    leans.map(|(into, _)| into).fold(-1.0, f64::max)
}

/// The lean that is allowed is between these.
const LEANS: [f64; 2] = [0.049, 0.051];

/// Triangles of any size and shape, of which nearly all cross.
fn crossing(random: &mut Random) -> Option<[Triangle; 2]> {
    let size = [1e-3, 1.0, 1e3][(random.bits() % 3) as usize];
    let mut triangle = || {
        let thin = [1.0, 1.0, 0.05][(random.bits() % 3) as usize];
        let turn = random.rotation();
        let centre = random.vector(0.2);
        [(); 3].map(|()| {
            let corner = random.vector(1.0) * glamx::Vec3::new(1.0, thin, 1.0);
            size * (turn * corner + centre).as_dvec3()
        })
    };
    let [t1, t2] = [triangle(), triangle()];
    contact(&t1, &t2, 0.0).filter(|contact| contact.distance < -1e-9 * size).map(|_| [t1, t2])
}

const SOLIDS: [[bool; 2]; 4] = [[true, true], [true, false], [false, true], [false, false]];

/// Would catch a contact that leads into a body, one that does not part the triangles, points that are
/// not on them, or not as far apart as it says, and one called extremal whose points do not show the
/// overlap.
#[test]
fn outward_contacts_lead_out_and_part() {
    let mut random = Random(51);
    let (mut found, mut extremal) = (0, 0);
    for _ in 0..60_000 {
        let Some([t1, t2]) = crossing(&mut random) else { continue };
        for solid in SOLIDS {
            // Neighbours of any kind.
            let seed = random.bits();
            let mut neighbours = Random(seed);
            let chance = neighbours.range(0.0, 1.0);
            let ends = |_, _, direction: DVec3| {
                Random(seed ^ direction.x.to_bits() ^ direction.y.to_bits()).range(0.0, 1.0)
                    < chance
            };
            let Some((contact, is_extremal)) = outward(&t1, &t2, solid, ends) else {
                continue;
            };
            let size = (t1[1] - t1[0]).length() + (t2[1] - t2[0]).length();
            assert!((contact.normal.length() - 1.0).abs() < 1e-9);
            assert!(lean(&t1, &t2, solid, contact.normal) < LEANS[1], "{t1:?} {t2:?} {solid:?}");
            let way = overlap(&t1, &t2, contact.normal);
            let moved = t2.map(|corner| corner + (way + 1e-9 * size) * contact.normal);
            assert!(overlap(&t1, &moved, contact.normal) <= 0.0);
            let left = sbbk_core::contact::contact(&t1, &moved, 1e9 * size).unwrap();
            assert!(left.distance >= 0.0, "{} is left", left.distance);
            // Points show the overlap or a part of it.
            assert!(contact.distance >= -way - 1e-9 * size, "{} of {way}", contact.distance);
            let end = contact.point1 + contact.distance * contact.normal;
            assert!(end.distance(contact.point2) < 1e-6 * size, "{contact:?}");
            for (t, point) in [(&t1, contact.point1), (&t2, contact.point2)] {
                let height = (point - t[0]).dot(normal(t));
                assert!(height.abs() < 1e-6 * size, "{point} is {height} off {t:?}");
            }
            assert!(!is_extremal || contact.distance <= -0.899 * way);
            assert!(contact.features.is_crossing());
            found += 1;
            extremal += usize::from(is_extremal);
        }
    }
    assert!(found > 30_000 && extremal > 5_000, "{found} found, {extremal} extremal");
}

/// Would catch an axis that is left out, taken the wrong way round or measured wrongly: where the
/// surfaces end everywhere, or nowhere, the overlap is at most that of all axes that lead out and have
/// faces or edges in front, and not less than of any other.
#[test]
fn the_overlap_is_the_least_of_all_that_lead_out() {
    let mut random = Random(52);
    let mut count = 0;
    for _ in 0..60_000 {
        let Some([t1, t2]) = crossing(&mut random) else { continue };
        for (solid, are_ends) in SOLIDS.into_iter().flat_map(|s| [true, false].map(|e| (s, e))) {
            let Some((contact, is_extremal)) =
                outward(&t1, &t2, solid, |_, _: Feature, _| are_ends)
            else {
                continue;
            };
            assert!(are_ends || !is_extremal);
            let size = (t1[1] - t1[0]).length() + (t2[1] - t2[0]).length();
            // Whether both a corner and another one are the farthest ones: a face or an edge is in front.
            let has_front = |t: &Triangle, axis: DVec3| {
                let end = shadow(t, axis)[1];
                t.iter().filter(|corner| corner.dot(axis) > end - 1e-9 * size).count() > 1
            };
            let is_in_front = |axis: DVec3| {
                let fronts = [has_front(&t1, axis), has_front(&t2, -axis)];
                let is_face =
                    [normal(&t1), normal(&t2)].iter().any(|n| n.dot(axis).abs() > 1.0 - 1e-9);
                is_face || fronts == [true; 2]
            };
            let least = |greatest_lean: f64, least_sine: f64| {
                let axes = all_axes(&t1, &t2).into_iter();
                let axes = axes.filter(|&(axis, sine)| {
                    axis != DVec3::ZERO
                        && sine > least_sine
                        && (least_sine < 1.0e-3 || is_in_front(axis))
                        && lean(&t1, &t2, solid, axis) < greatest_lean
                });
                axes.map(|(axis, _)| overlap(&t1, &t2, axis)).fold(f64::INFINITY, f64::min)
            };
            let way = overlap(&t1, &t2, contact.normal);
            assert!(way <= least(LEANS[0], 1.1e-3) + 1e-6 * size, "{way}: {t1:?} {t2:?} {solid:?}");
            assert!(way >= least(LEANS[1], 0.9e-3) - 1e-6 * size, "{way}: {t1:?} {t2:?} {solid:?}");
            count += 1;
        }
    }
    assert!(count > 50_000, "{count}");
}

/// Would catch a side that is taken for the other one: asked the other way round the contact is the
/// mirror image. Triangles that face away from each other have none.
#[test]
fn either_triangle_may_come_first() {
    let mut random = Random(53);
    let (mut found, mut none) = (0, 0);
    for _ in 0..60_000 {
        let Some([t1, t2]) = crossing(&mut random) else { continue };
        for solid in SOLIDS {
            let ends = |_, _, _| true;
            let [one, two] =
                [outward(&t1, &t2, solid, ends), outward(&t2, &t1, [solid[1], solid[0]], ends)];
            assert_eq!(one.is_some(), two.is_some(), "{t1:?} {t2:?} {solid:?}");
            let Some([one, two]) = one.zip(two).map(|(one, two)| [one.0, two.0]) else {
                none += 1;
                continue;
            };
            if one.normal == DVec3::ZERO {
                continue;
            }
            let size = (t1[1] - t1[0]).length() + (t2[1] - t2[0]).length();
            let [ways, mirrored] = [(&t1, &t2, one.normal), (&t1, &t2, -two.normal)]
                .map(|(t1, t2, normal)| overlap(t1, t2, normal));
            assert!((ways - mirrored).abs() < 1e-9 * size, "{ways} {mirrored}");
            if one.normal.dot(-two.normal) > 1.0 - 1e-9 {
                assert!((one.distance - two.distance).abs() < 1e-6 * size);
            }
            found += 1;
        }
    }
    assert!(found > 30_000, "{found} found, {none} without");
}

/// Two triangles that cross and face the same way: no axis leads out of both. Would catch a contact
/// without a normal.
#[test]
fn triangles_that_face_one_way_have_no_contact() {
    let [t1, t2] = [
        [[0.2, -6.7, 3.6], [-7.8, 7.7, -5.1], [0.2, 1.0, -2.0]],
        [[0.8, 0.0, 1.7], [5.4, -6.2, 1.9], [-4.2, -8.1, 3.8]],
    ]
    .map(|corners| corners.map(DVec3::from_array));
    assert!(contact(&t1, &t2, 0.0).is_some_and(|contact| contact.distance < -0.01));
    assert_eq!(outward(&t1, &t2, [true; 2], |_, _, _| true), None);

    let mut random = Random(54);
    let pairs = (0..60_000).filter_map(|_| crossing(&mut random));
    let found = pairs.filter_map(|[t1, t2]| outward(&t1, &t2, [true; 2], |_, _, _| true));
    assert_eq!(found.filter(|found| found.0.normal == DVec3::ZERO).count(), 0);
}
