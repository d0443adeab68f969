//! Steady steps allocate nothing.

use std::f32::consts::TAU;

use super::model::{Random, cube};
use allocation_counter::measure;
use glamx::Vec3;
use sbbk_core::broad_phase::{BroadPhase, ObjectHandle};

const OBJECT_COUNT: usize = 1500;
const FRAME_COUNT: usize = 40;

/// Objects on circles, one circle a cycle; in every frame some of them are replaced.
struct World {
    phase: BroadPhase,
    handles: Vec<ObjectHandle>,
    circle_centres: Vec<Vec3>,
    replaced_per_frame: usize,
}

impl World {
    fn new(replaced_per_frame: usize) -> Self {
        let random = &mut Random(3);
        let circle_centres: Vec<_> = (0..OBJECT_COUNT).map(|_| 8.0 * random.vector()).collect();
        let mut phase = BroadPhase::new(0.02).unwrap();
        let insert = |&centre: &Vec3| phase.insert(&cube(centre, 0.4, 0.5)).unwrap();
        let handles = circle_centres.iter().map(insert).collect();
        Self { phase, handles, circle_centres, replaced_per_frame }
    }

    fn move_or_replace(&mut self, i: usize, frame: usize) {
        let (sin, cos) = (TAU * (frame as f32 / FRAME_COUNT as f32 + 0.1 * i as f32)).sin_cos();
        let centre = self.circle_centres[i] + 3.0 * Vec3::new(cos, sin, 0.0);
        let bounds = cube(centre, 0.4, 0.5);
        if (i + 7 * frame) % OBJECT_COUNT < self.replaced_per_frame {
            self.phase.remove(self.handles[i]).unwrap();
            self.handles[i] = self.phase.insert(&bounds).unwrap();
        } else {
            self.phase.update(self.handles[i], &bounds).unwrap();
        }
    }

    /// One cycle; returns how many events there were, and pairs read.
    fn play(&mut self) -> [usize; 2] {
        let mut counts = [0, 0];
        for frame in 0..FRAME_COUNT {
            (0..OBJECT_COUNT).for_each(|i| self.move_or_replace(i, frame));
            self.phase.step(|_| counts[0] += 1);
            counts[1] += self.phase.pairs().count();
        }
        counts
    }
}

/// Catches memory that is built up and dropped in every step: while objects move, while the
/// structure is packed afresh, and while objects come and go at a constant rate.
#[test]
fn steady_steps_allocate_nothing() {
    for replaced_per_frame in [0, 5] {
        let mut world = World::new(replaced_per_frame);
        let warm_up = measure(|| {
            for _ in 0..3 {
                world.play();
            }
        });
        assert!(warm_up.count_total > 0, "the counter does not count");

        let mut counts = [0; 2];
        let steady = measure(|| counts = world.play());
        assert!(counts[0] > 1000 && counts[1] > 10_000, "{counts:?}");
        assert_eq!(steady.count_total, 0, "{replaced_per_frame} replaced a frame");
    }
}
