//! Random poses: apart, touching and deep.

use super::drawn::check_drawn;
use super::shape::{Kind, Rng};
use super::truth::{check, size};
use std::convert::Infallible;

/// Would catch a wrong region of a simplex, a proof that proves nothing, or a polytope that stops
/// before its nearest face.
#[test]
fn polytopes() {
    for (seed, kind) in Kind::POLYTOPES.into_iter().enumerate() {
        let mut rng = Rng(seed as u64);
        let (mut apart, mut deep, mut far, mut wrong) = (0, 0, 0, 0);
        for i in 0..20_000 {
            let shape = rng.shape(kind);
            let margin = rng.scale(1.0e-4, 0.1);
            let gap = match i % 4 {
                0 => rng.within(0.0, 2.0 * margin),
                1 => rng.within(-margin, margin),
                2 => 0.0,
                _ => rng.within(-1.0, 0.0),
            };
            let triangle = rng.triangle_beside(&shape, gap);
            let truth = shape.truth().distance(&triangle);
            let size = size(&triangle, &shape);
            let Some(contact) = shape.contact(&triangle, margin) else {
                far += 1;
                wrong += u32::from(truth <= margin * 0.999_999);
                continue;
            };
            let error = (contact.distance - truth).abs();
            if error > 1.0e-9 * size {
                if wrong == 0 {
                    println!(
                        "{kind:?} {i} {error:e}: {truth} {contact:?}\n{shape:?}\n{triangle:?}"
                    );
                }
                wrong += 1;
                continue;
            }
            check(&triangle, &shape, &contact, 1.0e-9 * size);
            apart += u32::from(truth > 0.0);
            deep += u32::from(truth < 0.0);
        }
        println!("{kind:?}: {apart} apart, {deep} deep, {far} far, {wrong} wrong");
        assert_eq!(wrong, 0, "{kind:?}");
        assert!(apart > 1500 && deep > 500 && far > 1000, "{kind:?}: {apart} {deep} {far}");
    }
}

/// What the fuzz target checks, of numbers drawn at random.
#[test]
fn drawn() {
    let mut rng = Rng(11);
    for _ in 0..60_000 {
        let Ok(()) = check_drawn(&mut |n| Ok::<_, Infallible>(rng.below(n)));
    }
}
