//! A broad phase beside the same objects in a map, whose pairs are found by brute force.

use std::collections::{BTreeMap, BTreeSet};

use glamx::Vec3;
use proptest::prelude::*;
use sbbk_core::broad_phase::{Bounds, BroadPhase, ObjectHandle, ObjectPair, PairEvent};

/// Checks every step against brute force: the pairs, and the events with their order.
pub struct Checked {
    pub phase: BroadPhase,
    objects: BTreeMap<ObjectHandle, Bounds>,
    pairs: BTreeSet<ObjectPair>,
    /// Count of events that started, and that ended, so far.
    pub event_counts: [usize; 2],
}

impl Checked {
    pub fn new(margin: f32) -> Self {
        Self {
            phase: BroadPhase::new(margin).unwrap(),
            objects: BTreeMap::new(),
            pairs: BTreeSet::new(),
            event_counts: [0; 2],
        }
    }

    pub fn insert(&mut self, bounds: &Bounds) -> ObjectHandle {
        let handle = self.phase.insert(bounds).unwrap();
        let replaced = self.objects.insert(handle, *bounds);
        assert_eq!(replaced, None, "{handle} was given out twice");
        handle
    }

    pub fn remove(&mut self, handle: ObjectHandle) {
        self.phase.remove(handle).unwrap();
        self.objects.remove(&handle).unwrap();
    }

    pub fn update(&mut self, handle: ObjectHandle, bounds: &Bounds) {
        self.phase.update(handle, bounds).unwrap();
        *self.objects.get_mut(&handle).unwrap() = *bounds;
    }

    /// Handle of the object at a position that wraps around.
    pub fn nth(&self, position: usize) -> Option<ObjectHandle> {
        let wrapped = position.checked_rem(self.objects.len())?;
        self.objects.keys().nth(wrapped).copied()
    }

    pub fn bounds(&self, handle: ObjectHandle) -> Bounds {
        self.objects[&handle]
    }

    /// Steps, and returns the count of pairs.
    pub fn step(&mut self) -> usize {
        let expected = self.brute_force();
        let mut expected_events: Vec<(ObjectPair, bool)> = Vec::new();
        expected_events.extend(expected.difference(&self.pairs).map(|&pair| (pair, true)));
        expected_events.extend(self.pairs.difference(&expected).map(|&pair| (pair, false)));
        expected_events.sort_unstable();

        let mut events = Vec::new();
        self.phase.step(|event| {
            events.push(match event {
                PairEvent::Started(pair) => (pair, true),
                PairEvent::Ended(pair) => (pair, false),
            });
        });
        assert_eq!(events, expected_events);
        assert!(self.phase.pairs().eq(expected.iter().copied()));
        assert_eq!(self.phase.len(), self.objects.len());

        for (_, has_started) in events {
            self.event_counts[usize::from(!has_started)] += 1;
        }
        self.pairs = expected;
        self.pairs.len()
    }

    fn brute_force(&self) -> BTreeSet<ObjectPair> {
        let margin = self.phase.margin();
        let objects: Vec<_> = self.objects.iter().collect();
        let mut pairs = BTreeSet::new();
        for (i, &(&handle1, bounds1)) in objects.iter().enumerate() {
            for &(&handle2, bounds2) in &objects[i + 1..] {
                if bounds1.is_pair_with(bounds2, margin) {
                    pairs.insert([handle1, handle2]);
                }
            }
        }
        pairs
    }
}

/// A cube with a sphere that may be smaller or larger than it.
pub fn cube(centre: Vec3, half_extent: f32, radius: f32) -> Bounds {
    Bounds { centre, radius, min: centre - half_extent, max: centre + half_extent }
}

/// Floats from `low` to `high`. The float ranges of proptest 1.12 fail an assertion of their own
/// about once in a million numbers.
pub fn between(low: f32, high: f32) -> impl Strategy<Value = f32> + Clone {
    (0..=1_u32 << 24).prop_map(move |step| low + (high - low) * (step as f32 / (1 << 24) as f32))
}

/// The splitmix64 generator.
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    pub fn below(&mut self, limit: usize) -> usize {
        self.next() as usize % limit
    }

    /// Each coordinate between −1 and 1.
    pub fn vector(&mut self) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| (self.next() >> 40) as f32 / (1 << 23) as f32 - 1.0))
    }
}
