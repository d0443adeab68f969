//! `Outward` against definitions that look at every axis.

use crate::prelude::*;
use sbbk_core::contact::{Outward, contact, contact_along};

type Triangle = [DVec3; 3];

/// The contact, and if it is extremal.
fn penetration(
    t1: &Triangle,
    t2: &Triangle,
    solid: [bool; 2],
    ends: impl Fn(usize, Feature, DVec3) -> bool,
) -> Option<(TriangleContact, bool)> {
    let pair = Outward::new([t1, t2], solid.map(|is_solid| is_solid.then_some(1.0)), [0.0; 2]);
    let least = |axis: DVec3, least: f64| pair.least(&ends, |normal| normal.dot(axis) >= least);
    let found = least(DVec3::ZERO, 0.0);
    let normal = found.map_or(DVec3::X, |contact| contact.normal);
    for (turned, cosine, counts) in [(0.0, 0.9999, true), (0.2, 0.97, true), (0.3, 0.97, false)] {
        let across = normal.any_orthonormal_vector();
        let axis = normal * f64::cos(turned) + across * f64::sin(turned);
        assert_eq!(least(axis, cosine), found.filter(|_| counts));
    }
    if let Some(found) = found {
        let along = contact_along([t1, t2], found.normal);
        assert_eq!(along, Some(found));
    }
    let extremal = pair.extremal(&ends);
    assert!(extremal.is_none() || extremal == found);
    found.map(|contact| (contact, extremal.is_some()))
}

fn normal([a, b, c]: &Triangle) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

fn size(t1: &Triangle, t2: &Triangle) -> f64 {
    (t1[1] - t1[0]).length() + (t2[1] - t2[0]).length()
}

/// The least and the greatest height of a triangle along an axis.
fn shadow(t: &Triangle, axis: DVec3) -> [f64; 2] {
    let heights = t.map(|corner| corner.dot(axis));
    [heights.into_iter().fold(f64::MAX, f64::min), heights.into_iter().fold(f64::MIN, f64::max)]
}

/// Length of the move along an axis that brings triangle 2 in front of triangle 1.
fn overlap(t1: &Triangle, t2: &Triangle, axis: DVec3) -> f64 {
    shadow(t1, axis)[1] - shadow(t2, axis)[0]
}

/// Both normals and the products of two edges, in both directions, with the sine of the angle of
/// the edges.
fn all_axes(t1: &Triangle, t2: &Triangle) -> Vec<(DVec3, f64)> {
    let edges = |t: &Triangle| [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
    let crosses = edges(t1).into_iter().flat_map(|e1| {
        edges(t2).map(|e2| {
            let cross = e1.cross(e2);
            (cross.normalize_or_zero(), cross.length() / (e1.length() * e2.length()))
        })
    });
    let axes = [(normal(t1), 1.0), (normal(t2), 1.0)].into_iter().chain(crosses);
    axes.flat_map(|(axis, sine)| [(axis, sine), (-axis, sine)]).collect()
}

/// Sine of the angle by which an axis leads into the solids; negative if it leads out of both.
fn lean(t1: &Triangle, t2: &Triangle, solid: [bool; 2], axis: DVec3) -> f64 {
    let into = [-normal(t1).dot(axis), normal(t2).dot(axis)];
    let leans = into.into_iter().zip(solid).filter(|&(_, is_solid)| is_solid);
    leans.map(|(into, _)| into).fold(-1.0, f64::max)
}

/// Bounds of the allowed lean.
const LEANS: [f64; 2] = [0.049, 0.051];

const SOLIDS: [[bool; 2]; 4] = [[true, true], [true, false], [false, true], [false, false]];

/// Crossing triangles of any size and shape.
fn crossing_pairs(random: &mut Random) -> impl Iterator<Item = [Triangle; 2]> {
    (0..60_000).filter_map(|_| {
        let size = [1e-3, 1.0, 1e3][(random.bits() % 3) as usize];
        let [t1, t2] = [(); 2].map(|()| {
            let thin = [1.0, 1.0, 0.05][(random.bits() % 3) as usize];
            let turn = random.rotation();
            let centre = random.vector(0.2);
            [(); 3].map(|()| {
                let corner = random.vector(1.0) * glamx::Vec3::new(1.0, thin, 1.0);
                size * (turn * corner + centre).as_dvec3()
            })
        });
        contact(&t1, &t2, 0.0).filter(|c| c.distance < -1e-9 * size).map(|_| [t1, t2])
    })
}

#[test]
fn contacts_lead_out_of_solids_and_separate_the_triangles() {
    let (mut found, mut extremal) = (0, 0);
    for (i, [t1, t2]) in crossing_pairs(&mut Random(51)).enumerate() {
        for solid in SOLIDS {
            // Arbitrary neighbours.
            let seed = Random(i as u64).bits();
            let chance = Random(seed).range(0.0, 1.0);
            let ends = |_, _, direction: DVec3| {
                let bits = direction.x.to_bits() ^ direction.y.to_bits();
                Random(seed ^ bits).range(0.0, 1.0) < chance
            };
            let Some((contact, is_extremal)) = penetration(&t1, &t2, solid, ends) else {
                continue;
            };
            let size = size(&t1, &t2);
            assert!((contact.normal.length() - 1.0).abs() < 1e-9);
            assert!(lean(&t1, &t2, solid, contact.normal) < LEANS[1], "{t1:?} {t2:?} {solid:?}");
            let way = overlap(&t1, &t2, contact.normal);
            let moved = t2.map(|corner| corner + (way + 1e-9 * size) * contact.normal);
            assert!(overlap(&t1, &moved, contact.normal) <= 0.0);
            let left = sbbk_core::contact::contact(&t1, &moved, 1e9 * size).unwrap();
            assert!(left.distance >= 0.0, "{} is left", left.distance);
            // The points show the overlap or a part of it.
            assert!(contact.distance >= -way - 1e-9 * size, "{} of {way}", contact.distance);
            assert!(!is_extremal || contact.distance <= -0.899 * way);
            let end = contact.point1 + contact.distance * contact.normal;
            assert!(end.distance(contact.point2) < 1e-6 * size, "{contact:?}");
            for (t, point) in [(&t1, contact.point1), (&t2, contact.point2)] {
                let height = (point - t[0]).dot(normal(t));
                assert!(height.abs() < 1e-6 * size, "{point} is {height} off {t:?}");
            }
            assert!(contact.features.is_crossing());
            found += 1;
            extremal += usize::from(is_extremal);
        }
    }
    assert!(found > 30_000 && extremal > 5_000, "{found} found, {extremal} extremal");
}

/// Surfaces end everywhere, or nowhere. The overlap is at most the least along outward axes with
/// faces or edges in front. It is at least the least along all outward axes.
#[test]
fn the_overlap_is_the_least_of_all_outward_axes() {
    let mut count = 0;
    for [t1, t2] in crossing_pairs(&mut Random(52)) {
        for (solid, are_ends) in SOLIDS.into_iter().flat_map(|s| [true, false].map(|e| (s, e))) {
            let Some((contact, is_extremal)) = penetration(&t1, &t2, solid, |_, _, _| are_ends)
            else {
                continue;
            };
            assert!(are_ends || !is_extremal);
            let size = size(&t1, &t2);
            let has_front = |t: &Triangle, axis: DVec3| {
                let end = shadow(t, axis)[1];
                t.iter().filter(|corner| corner.dot(axis) > end - 1e-9 * size).count() > 1
            };
            let is_in_front = |axis: DVec3| {
                let mut faces = [normal(&t1), normal(&t2)].into_iter();
                faces.any(|n| n.dot(axis).abs() > 1.0 - 1e-9)
                    || has_front(&t1, axis) && has_front(&t2, -axis)
            };
            let least = |greatest_lean: f64, least_sine: f64| {
                let axes = all_axes(&t1, &t2).into_iter().filter(|&(axis, sine)| {
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

#[test]
fn swapped_triangles_have_the_mirrored_contact() {
    let mut found = 0;
    for [t1, t2] in crossing_pairs(&mut Random(53)) {
        for solid in SOLIDS {
            let ends = |_, _, _| true;
            let one = penetration(&t1, &t2, solid, ends);
            let two = penetration(&t2, &t1, [solid[1], solid[0]], ends);
            assert_eq!(one.is_some(), two.is_some(), "{t1:?} {t2:?} {solid:?}");
            let Some(((one, _), (two, _))) = one.zip(two) else { continue };
            let size = size(&t1, &t2);
            let [way, mirrored] = [one.normal, -two.normal].map(|n| overlap(&t1, &t2, n));
            assert!((way - mirrored).abs() < 1e-9 * size, "{way} {mirrored}");
            if one.normal.dot(-two.normal) > 1.0 - 1e-9 {
                assert!((one.distance - two.distance).abs() < 1e-6 * size);
            }
            found += 1;
        }
    }
    assert!(found > 30_000, "{found} found");
}

#[test]
fn crossing_triangles_that_face_one_way_have_no_contact() {
    let [t1, t2] = [
        [[0.2, -6.7, 3.6], [-7.8, 7.7, -5.1], [0.2, 1.0, -2.0]],
        [[0.8, 0.0, 1.7], [5.4, -6.2, 1.9], [-4.2, -8.1, 3.8]],
    ]
    .map(|corners| corners.map(DVec3::from_array));
    assert!(contact(&t1, &t2, 0.0).is_some_and(|contact| contact.distance < -0.01));
    assert_eq!(penetration(&t1, &t2, [true; 2], |_, _, _| true), None);
}
