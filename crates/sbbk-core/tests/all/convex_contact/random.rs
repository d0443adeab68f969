//! Random poses, apart, touching and deep, and corners on a small lattice: coplanar faces, parallel
//! edges, shared vertices, exact contact.

use super::drawn::check_drawn;
use super::shape::{Core, Kind, Shape};
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

impl Random {
    /// A point with whole coordinates from -2 to 2.
    fn lattice_point(&mut self) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.below(5) as f64 - 2.0))
    }

    fn lattice_shape(&mut self) -> Shape {
        let half = |rng: &mut Self| 0.5 * rng.below(5) as f64;
        let core = match self.below(6) {
            0 => Core::Point(self.lattice_point()),
            1 => Core::Segment([0; 2].map(|_| self.lattice_point())),
            2 => Core::Triangle([0; 3].map(|_| self.lattice_point())),
            3 => Core::Cuboid(DVec3::from_array([0; 3].map(|_| half(self)))),
            _ => Core::Hull((0..4 + self.below(4)).map(|_| self.lattice_point()).collect()),
        };
        Shape { core, radius: 0.25 * self.below(3) as f64 }
    }
}

#[test]
fn exact_and_near_ties_on_a_lattice_agree_with_brute_force() {
    let mut rng = Random(7);
    for nudge in [0.0, 1.0e-15, 1.0e-13, 1.0e-11, 1.0e-9, 1.0e-6] {
        let (mut apart, mut touching, mut deep) = (0, 0, 0);
        for _ in 0..20_000 {
            let shape = rng.lattice_shape();
            let triangle = [0; 3].map(|_| rng.lattice_point() + rng.point() * nudge);
            let truth = shape.truth().distance(&triangle);
            let contact = shape.contact(&triangle, 20.0).expect("within the margin");
            let error = (contact.distance - truth).abs();
            let tolerance = 1.0e-9 * size(&triangle, &shape).max(1.0);
            assert!(error <= tolerance, "{truth} {contact:?}\n{shape:?}\n{triangle:?}");
            check(&triangle, &shape, &contact, tolerance);
            // Corners that met on the lattice are apart by the nudge at most.
            let met = tolerance + 10.0 * nudge;
            apart += u32::from(truth > met);
            touching += u32::from(truth.abs() <= met);
            deep += u32::from(truth < -met);
        }
        assert!(apart > 2000 && touching > 500 && deep > 2000, "{apart} {touching} {deep}");
    }
}
