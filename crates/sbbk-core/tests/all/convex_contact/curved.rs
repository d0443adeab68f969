//! Cylinders and cones against searches over the points of the triangle, over directions, or over
//! both.

use super::shape::{Kind, Shape};
use super::truth::{check, gap, size};
use crate::prelude::*;

/// The widest gap in a search over directions: a lower bound, exact for bodies that cross unless
/// the search ends in a local maximum.
fn separation(triangle: &[DVec3; 3], shape: &Shape, rng: &mut Random) -> f64 {
    let [a, b, c] = *triangle;
    let face = (b - a).cross(c - a);
    let mut directions = vec![face, DVec3::Y];
    for (p, q) in [(a, b), (b, c), (c, a)] {
        directions.extend([(q - p).cross(DVec3::Y), DVec3::new(p.x, 0.0, p.z)]);
        directions.extend([(q - p).cross(face), (q - p).cross(face).cross(DVec3::Y)]);
    }
    directions.extend((0..300).map(|_| rng.direction()));
    let all = directions.iter().filter_map(|d| d.try_normalize()).flat_map(|d| [d, -d]);
    let mut found: Vec<_> = all.map(|d| (gap(triangle, shape, d), d)).collect();
    found.sort_by(|x, y| y.0.total_cmp(&x.0));
    let mut widest = found[0].0;
    for (mut open, mut direction) in found.into_iter().take(6) {
        let mut step = 0.2;
        while step > 1.0e-9 {
            let tried = (0..8).map(|_| (direction + step * rng.point()).normalize());
            let tried = tried.map(|d| (gap(triangle, shape, d), d));
            let best = tried.max_by(|x, y| x.0.total_cmp(&y.0)).unwrap();
            if best.0 > open {
                (open, direction) = best;
            } else {
                step *= 0.6;
            }
        }
        widest = widest.max(open);
    }
    widest
}

#[test]
fn contacts_of_cylinders_and_cones_agree_with_searches() {
    for (seed, kind) in Kind::CURVED.into_iter().enumerate() {
        let mut rng = Random(100 + seed as u64);
        let (mut clear, mut deep, mut far) = (0, 0, 0);
        for i in 0..20_000 {
            let (shape, triangle, margin) = rng.case(kind, i);
            let body = shape.truth();
            let size = size(&triangle, &shape);
            let contact = shape.contact(&triangle, margin);
            if let Some(contact) = &contact {
                check(&triangle, &shape, contact, 1.0e-8 * size);
            }
            let distance = contact.map_or(f64::INFINITY, |contact| contact.distance);
            let truth = body.distance(&triangle);
            far += u32::from(contact.is_none());
            clear += u32::from(contact.is_some() && truth > -shape.radius);
            let is_deep = truth <= -shape.radius;
            deep += u32::from(is_deep);
            let is_wrong = match contact {
                Some(_) if is_deep => {
                    // The contact's own move parts the bodies, as checked: no other may be less.
                    let is_searched = i % 8 < 2;
                    (distance - truth).abs() > 1.0e-7 * size
                        || is_searched
                            && separation(&triangle, &shape, &mut rng) > distance + 1.0e-6 * size
                }
                Some(_) => (distance - truth).abs() > 1.0e-7 * size,
                None => truth < margin * 0.999,
            };
            assert!(!is_wrong, "{kind:?} {i}: {truth} {contact:?}\n{shape:?}\n{triangle:?}");
        }
        assert!(clear > 1500 && deep > 500 && far > 1000, "{kind:?}: {clear} {deep} {far}");
    }
}
