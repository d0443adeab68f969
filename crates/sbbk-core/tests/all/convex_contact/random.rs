//! Random poses: apart, touching and deep.

use super::drawn::check_drawn;
use super::shape::Kind;
use super::truth::{check, size};
use crate::prelude::*;
use std::convert::Infallible;

#[test]
fn contacts_of_polytopes_agree_with_brute_force() {
    for (seed, kind) in Kind::POLYTOPES.into_iter().enumerate() {
        let mut rng = Random(seed as u64);
        let (mut apart, mut deep, mut far) = (0, 0, 0);
        for i in 0..20_000 {
            let (shape, triangle, margin) = rng.case(kind, i);
            let truth = shape.truth().distance(&triangle);
            let size = size(&triangle, &shape);
            let Some(contact) = shape.contact(&triangle, margin) else {
                far += 1;
                assert!(truth > margin * 0.999_999, "{i} lost: {shape:?}\n{triangle:?}");
                continue;
            };
            let error = (contact.distance - truth).abs();
            if error > 1.0e-9 * size {
                panic!("{i} {error:e}: {truth} {contact:?}\n{shape:?}\n{triangle:?}");
            }
            check(&triangle, &shape, &contact, 1.0e-9 * size);
            apart += u32::from(truth > 0.0);
            deep += u32::from(truth < 0.0);
        }
        assert!(apart > 1500 && deep > 500 && far > 1000, "{kind:?}: {apart} {deep} {far}");
    }
}

#[test]
fn drawn_contacts_agree_with_brute_force_or_search() {
    let mut rng = Random(11);
    for _ in 0..60_000 {
        let Ok(()) = check_drawn(&mut |n| Ok::<_, Infallible>(rng.below(n)));
    }
}
