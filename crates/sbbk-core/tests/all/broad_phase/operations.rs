//! Random operations on a broad phase, against brute force after every step.

use super::model::{Checked, between, cube};
use glamx::Vec3;
use proptest::prelude::*;
use sbbk_core::broad_phase::{Bounds, StaleHandle, UpdateError};

#[derive(Clone, Debug)]
enum Operation {
    Insert(Bounds),
    Remove(usize),
    /// Moves by the given amount.
    Move(usize, Vec3),
    /// Takes any bounds.
    Teleport(usize, Bounds),
    /// Updates with the bounds it has.
    Stay(usize),
    Step,
}

/// Coordinates, sizes and shifts of one kind of world.
#[derive(Clone, Copy, Debug)]
enum World {
    /// All numbers are multiples of a half, so that touching is exact and frequent.
    Lattice,
    /// No two numbers are related.
    Chaos,
    /// Far from the origin, where neighbouring floats are a sixteenth apart.
    FarAway,
    /// Sizes from a thousandth to ten.
    MixedSizes,
    /// All centres equal; sizes may be zero.
    OnePlace,
    /// Up to the largest and down to the smallest floats.
    Extremes,
}

impl World {
    fn coordinate(self) -> BoxedStrategy<f32> {
        match self {
            World::Lattice => (-4..=4).prop_map(|half| 0.5 * half as f32).boxed(),
            World::Chaos => between(-3.0, 3.0).boxed(),
            World::FarAway => (0..40).prop_map(|i| 1e6 + 0.0625 * i as f32).boxed(),
            World::MixedSizes => between(-10.0, 10.0).boxed(),
            World::OnePlace => Just(7.5).boxed(),
            World::Extremes => prop::sample::select(vec![
                0.0,
                1e-45,
                -1e-40,
                1e19,
                -1e19,
                3e38,
                f32::MAX,
                f32::MIN,
            ])
            .boxed(),
        }
    }

    fn size(self) -> BoxedStrategy<f32> {
        match self {
            World::Lattice => (0..=2).prop_map(|half| 0.5 * half as f32).boxed(),
            World::Chaos => between(0.05, 1.0).boxed(),
            World::FarAway => (0..8).prop_map(|i| 0.0625 * i as f32).boxed(),
            World::MixedSizes => between(-3.0, 1.0).prop_map(|e| 10_f32.powf(e)).boxed(),
            World::OnePlace => prop_oneof![Just(0.0), between(0.0, 2.0)].boxed(),
            World::Extremes => {
                prop::sample::select(vec![0.0, 1e-45, 1.0, 1e18, 1e30, f32::MAX]).boxed()
            }
        }
    }

    fn position(self) -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(self.coordinate()).prop_map(Vec3::from_array)
    }

    fn bounds(self) -> impl Strategy<Value = Bounds> {
        let sphere = (self.position(), self.size());
        (sphere, self.size()).prop_map(|((centre, radius), half_extent)| {
            let bounds = cube(centre, half_extent, radius);
            let finite = |corner: Vec3| corner.clamp(Vec3::MIN, Vec3::MAX);
            Bounds { min: finite(bounds.min), max: finite(bounds.max), ..bounds }
        })
    }

    fn operation(self) -> impl Strategy<Value = Operation> {
        let any = any::<prop::sample::Index>().prop_map(|index| index.index(usize::MAX));
        let shift = (self.position(), self.position()).prop_map(|(a, b)| 0.25 * a - 0.25 * b);
        prop_oneof![
            6 => self.bounds().prop_map(Operation::Insert),
            2 => any.clone().prop_map(Operation::Remove),
            6 => (any.clone(), shift).prop_map(|(i, shift)| Operation::Move(i, shift)),
            2 => (any.clone(), self.bounds()).prop_map(|(i, b)| Operation::Teleport(i, b)),
            1 => any.prop_map(Operation::Stay),
            3 => Just(Operation::Step),
        ]
    }
}

fn world_and_operations() -> impl Strategy<Value = (f32, Vec<Operation>)> {
    let worlds = vec![
        World::Lattice,
        World::Chaos,
        World::FarAway,
        World::MixedSizes,
        World::OnePlace,
        World::Extremes,
    ];
    prop::sample::select(worlds).prop_flat_map(|world| {
        let margin = prop_oneof![Just(0.0), Just(0.5), Just(0.02)];
        (margin, prop::collection::vec(world.operation(), 1..150))
    })
}

fn apply(checked: &mut Checked, operation: Operation) {
    match operation {
        Operation::Insert(bounds) => {
            checked.insert(&bounds);
        }
        Operation::Step => {
            checked.step();
        }
        Operation::Remove(position) => {
            let Some(handle) = checked.nth(position) else {
                return;
            };
            let bounds = checked.bounds(handle);
            checked.remove(handle);
            let stale = StaleHandle(handle);
            assert_eq!(checked.phase.remove(handle), Err(stale));
            let update = checked.phase.update(handle, &bounds);
            assert_eq!(update, Err(UpdateError::Stale(stale)));
        }
        Operation::Move(position, _)
        | Operation::Teleport(position, _)
        | Operation::Stay(position) => {
            let Some(handle) = checked.nth(position) else {
                return;
            };
            let old = checked.bounds(handle);
            let new = match operation {
                Operation::Move(_, shift) => moved(&old, shift),
                Operation::Teleport(_, bounds) => bounds,
                _ => old,
            };
            checked.update(handle, &new);
        }
    }
}

fn moved(bounds: &Bounds, shift: Vec3) -> Bounds {
    let shifted = |point: Vec3| (point + shift).clamp(Vec3::MIN, Vec3::MAX);
    Bounds {
        centre: shifted(bounds.centre),
        radius: bounds.radius,
        min: shifted(bounds.min),
        max: shifted(bounds.max),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Catches any pair lost, invented, reported twice, kept after it ended or of which the event
    /// names another object, and a handle that outlives its object.
    #[test]
    fn pairs_and_events_equal_brute_force_after_any_operations(
        (margin, operations) in world_and_operations()
    ) {
        let mut checked = Checked::new(margin);
        for operation in operations {
            apply(&mut checked, operation);
        }
        checked.step();
        while let Some(handle) = checked.nth(0) {
            checked.remove(handle);
        }
        prop_assert_eq!(checked.step(), 0);
        prop_assert_eq!(checked.event_counts[0], checked.event_counts[1]);
    }
}
