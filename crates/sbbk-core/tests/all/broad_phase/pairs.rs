//! Whole sets of pairs in worlds where the answer is known, or large enough for every level of
//! the structure.

use super::model::{Checked, Random, cube};
use glamx::Vec3;
use sbbk_core::broad_phase::{Bounds, BroadPhase, ObjectHandle};

const LATTICE_SIDE: usize = 8;

/// A lattice of unit cubes with inscribed spheres.
fn lattice(spacing: f32) -> Vec<Bounds> {
    let place = |i: usize| {
        [1, LATTICE_SIDE, LATTICE_SIDE * LATTICE_SIDE].map(|stride| i / stride % LATTICE_SIDE)
    };
    (0..LATTICE_SIDE.pow(3))
        .map(|i| cube(spacing * Vec3::from_array(place(i).map(|x| x as f32)), 0.5, 0.5))
        .collect()
}

fn face_neighbours() -> Vec<[usize; 2]> {
    let mut pairs = Vec::new();
    for index in 0..LATTICE_SIDE.pow(3) {
        for stride in [1, LATTICE_SIDE, LATTICE_SIDE * LATTICE_SIDE] {
            if index / stride % LATTICE_SIDE + 1 < LATTICE_SIDE {
                pairs.push([index, index + stride]);
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

fn inserted(margin: f32, objects: &[Bounds]) -> (BroadPhase, Vec<ObjectHandle>) {
    let mut phase = BroadPhase::new(margin).unwrap();
    let handles = objects.iter().map(|bounds| phase.insert(bounds).unwrap()).collect();
    phase.step(|_| ());
    (phase, handles)
}

fn index_pairs(phase: &BroadPhase) -> Vec<[usize; 2]> {
    phase.pairs().map(|pair| pair.map(|handle| handle.index())).collect()
}

/// Catches comparisons that are strict, a margin that is halved, doubled or applied to only one
/// of the two volumes, and a sphere stage that is skipped: boxes alone touch across edges and
/// corners too.
#[test]
fn touching_counts_and_the_margin_is_the_gap() {
    for (spacing, margin) in [(1.0, 0.0), (1.5, 0.5), (1.25, 0.25)] {
        let (phase, _) = inserted(margin, &lattice(spacing));
        assert_eq!(index_pairs(&phase), face_neighbours());
    }
    let (phase, _) = inserted(0.499, &lattice(1.5));
    assert_eq!(index_pairs(&phase), Vec::<[usize; 2]>::new());
}

/// Catches a box stage that is skipped: these spheres all overlap, the boxes only in rows.
#[test]
fn boxes_decide_where_spheres_do_not() {
    let mut objects = lattice(1.0);
    for object in &mut objects {
        object.radius = 100.0;
        object.min += Vec3::new(0.25, 0.0, 0.25);
        object.max -= Vec3::new(0.25, 0.0, 0.25);
    }
    let (phase, _) = inserted(0.0, &objects);
    let rows = face_neighbours().into_iter().filter(|[a, b]| b - a == LATTICE_SIDE);
    assert!(index_pairs(&phase).into_iter().eq(rows));
}

/// Catches a mistake with nothing to do: no level, no group, no lane in use.
#[test]
fn none_one_and_none_again() {
    let mut checked = Checked::new(0.1);
    assert_eq!(checked.step(), 0);
    let handle = checked.insert(&cube(Vec3::ONE, 0.0, 0.0));
    assert_eq!(checked.step(), 0);
    checked.update(handle, &cube(Vec3::ZERO, 1.0, 1.0));
    assert_eq!(checked.step(), 0);
    checked.remove(handle);
    assert_eq!(checked.step(), 0);
    assert!(checked.phase.is_empty());
}

/// Catches an object that is paired with its successor in the same place of the table, or an
/// event that names the successor instead of the object that was removed.
#[test]
fn objects_that_come_and_go_between_two_steps() {
    let mut checked = Checked::new(0.0);
    let here = cube(Vec3::ZERO, 1.0, 1.0);
    checked.insert(&here);
    let second = checked.insert(&here);
    assert_eq!(checked.step(), 1);
    checked.remove(second);
    let third = checked.insert(&here);
    assert_eq!(checked.step(), 1);
    let fourth = checked.insert(&here);
    assert_eq!(fourth.index(), second.index());
    assert_eq!(checked.step(), 3);
    checked.remove(fourth);
    checked.remove(third);
    let brief = checked.insert(&here);
    checked.remove(brief);
    assert_eq!(checked.step(), 0);
    assert_eq!(checked.event_counts, [4, 4]);
}

/// Catches a cut of the order that never ends or an empty spread where no axis separates, and a
/// table of pairs too small for all of them.
#[test]
fn all_objects_in_one_place_are_all_pairs() {
    for (count, half_extent) in [(7, 0.0), (9, 1.0), (100, 0.0), (520, 1.0)] {
        let mut checked = Checked::new(0.0);
        let place = Vec3::new(1e6, -3.0, 0.1);
        (0..count).for_each(|_| {
            checked.insert(&cube(place, half_extent, half_extent));
        });
        assert_eq!(checked.step(), count * (count - 1) / 2);
    }
}

/// How a world of a few thousand objects moves.
struct Stir {
    object_count: usize,
    half_side: f32,
    offset: f32,
    /// Sizes are 0.5 times a power of this between 0 and 1.
    size_ratio: f32,
    /// One in so many objects moves in a step.
    moving_every: usize,
    step_count: usize,
}

impl Stir {
    fn object(&self, random: &mut Random) -> Bounds {
        let exponent = 0.5 * (random.vector().x + 1.0);
        let size = 0.5 * self.size_ratio.powf(exponent);
        let centre = self.half_side * random.vector() + self.offset;
        cube(centre, 0.8 * size, size)
    }

    fn run(&self) {
        let random = &mut Random(self.object_count as u64);
        let mut checked = Checked::new(0.02);
        let mut handles: Vec<_> =
            (0..self.object_count).map(|_| checked.insert(&self.object(random))).collect();
        for _ in 0..self.step_count {
            for k in (0..handles.len()).step_by(self.moving_every) {
                let handle = handles[(k + random.below(self.moving_every)) % handles.len()];
                let old = checked.bounds(handle);
                let shift = 0.1 * random.vector();
                let new = Bounds {
                    centre: old.centre + shift,
                    min: old.min + shift,
                    max: old.max + shift,
                    ..old
                };
                checked.update(handle, &new);
            }
            for _ in 0..3 {
                let jumping = handles[random.below(handles.len())];
                checked.update(jumping, &self.object(random));
                let leaving = handles.swap_remove(random.below(handles.len()));
                checked.remove(leaving);
                handles.push(checked.insert(&self.object(random)));
            }
            let pair_count = checked.step();
            assert!(pair_count > self.object_count / 10, "{pair_count} pairs");
        }
        let [started, ended] = checked.event_counts;
        assert!(ended > self.step_count && started > ended);
    }
}

/// Catches mistakes that need several levels: children numbered wrongly, boxes not refitted up to
/// the top, changes not marked there, pairs across groups found twice or never.
#[test]
fn every_level_agrees_with_brute_force_when_all_objects_move() {
    for object_count in [65, 600, 4200] {
        Stir {
            object_count,
            half_side: 0.7 * (object_count as f32).cbrt(),
            offset: 0.0,
            size_ratio: 1.0,
            moving_every: 1,
            step_count: 3 + 6000 / object_count,
        }
        .run();
    }
}

/// Catches a pair of an object at rest that is dropped, or found again, because only its partner
/// moved.
#[test]
fn a_few_moving_among_many_at_rest_agree_with_brute_force() {
    for (object_count, moving_every) in [(600, 20), (600, 200), (1500, 100)] {
        Stir {
            object_count,
            half_side: 0.7 * (object_count as f32).cbrt(),
            offset: 0.0,
            size_ratio: 1.0,
            moving_every,
            step_count: 60,
        }
        .run();
    }
}

/// Catches boxes of nodes that lose an object much larger or smaller than its neighbours, and
/// arithmetic that assumes the origin is near.
#[test]
fn mixed_sizes_far_from_the_origin_agree_with_brute_force() {
    for offset in [0.0, 1e6] {
        Stir {
            object_count: 600,
            half_side: 2.5,
            offset,
            size_ratio: 1e3_f32.recip(),
            moving_every: 2,
            step_count: 20,
        }
        .run();
    }
}

/// Catches results that depend on how the objects came to where they are: one broad phase is
/// filled at once, the other with objects elsewhere that come, go and wander.
#[test]
fn pairs_do_not_depend_on_the_history() {
    let random = &mut Random(5);
    let objects: Vec<_> = (0..600).map(|_| cube(5.0 * random.vector(), 0.4, 0.5)).collect();
    let (direct, _) = inserted(0.02, &objects);

    let scattered: Vec<_> = (0..900).map(|_| cube(50.0 * random.vector(), 2.0, 2.0)).collect();
    let (mut wandering, mut handles) = inserted(0.02, &scattered);
    for removed in [700, 20, 333, 899, 4] {
        wandering.remove(handles[removed]).unwrap();
    }
    wandering.step(|_| ());
    // The lowest free index comes first.
    for index in [4, 20, 333] {
        handles[index] = wandering.insert(&scattered[0]).unwrap();
        assert_eq!(handles[index].index(), index);
    }
    for index in (600..900).filter(|index| ![700, 899].contains(index)) {
        wandering.remove(handles[index]).unwrap();
    }
    for (index, bounds) in objects.iter().enumerate() {
        wandering.update(handles[index], bounds).unwrap();
        if index % 97 == 0 {
            wandering.step(|_| ());
        }
    }
    wandering.step(|_| ());

    assert!(direct.pairs().len() > 500);
    assert_eq!(index_pairs(&wandering), index_pairs(&direct));
}
