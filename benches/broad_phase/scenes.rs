//! Scenes as lists of frames; two frames in a row are a sixtieth of a second apart.

use glamx::Vec3;
use sbbk_core::broad_phase::Bounds;

/// Played forwards, then backwards, so that no object jumps.
pub const FRAME_COUNT: usize = 16;

const TIME_STEP: f32 = 1.0 / 60.0;

/// A scene: its name and how it places an object, of `count`, at the start.
pub struct Scene {
    pub name: &'static str,
    place: fn(&mut Random, usize, usize) -> Body,
    /// One in so many objects moves.
    moving_every: usize,
}

struct Body {
    position: Vec3,
    velocity: Vec3,
    radius: f32,
}

pub const SCENES: [Scene; 6] = [
    Scene { name: "pile", place: pile, moving_every: 1 },
    Scene { name: "uniform", place: uniform, moving_every: 1 },
    Scene { name: "row", place: row, moving_every: 1 },
    Scene { name: "mixed", place: mixed, moving_every: 1 },
    Scene { name: "clustered", place: clustered, moving_every: 1 },
    Scene { name: "pile_1_percent_awake", place: pile, moving_every: 100 },
];

impl Scene {
    pub fn frames(&self, count: usize) -> Vec<Vec<Bounds>> {
        let mut random = Random(0x9e37_79b9_7f4a_7c15);
        let bodies: Vec<Body> = (0..count).map(|i| (self.place)(&mut random, i, count)).collect();
        let frame = |f: usize| {
            let turn = f.min(2 * FRAME_COUNT - f) as f32;
            let bounds = bodies.iter().enumerate().map(|(i, body)| {
                let is_moving = i % self.moving_every == 0;
                let time = if is_moving { turn * TIME_STEP } else { 0.0 };
                body.at(time)
            });
            bounds.collect()
        };
        (0..2 * FRAME_COUNT).map(frame).collect()
    }
}

impl Body {
    /// The box is a little flatter than the sphere, so that both stages decide pairs.
    fn at(&self, time: f32) -> Bounds {
        let centre = self.position + time * self.velocity;
        let half_extents = self.radius * Vec3::new(0.9, 0.7, 0.9);
        Bounds {
            centre,
            radius: self.radius,
            min: centre - half_extents,
            max: centre + half_extents,
        }
    }
}

/// Objects of about one unit, packed touching, falling and jostling; a heap as wide as high.
fn pile(random: &mut Random, index: usize, count: usize) -> Body {
    let side = (count as f32).cbrt().ceil() as usize;
    let cell = [index % side, index / side % side, index / (side * side)].map(|c| c as f32);
    Body {
        position: 0.95 * (Vec3::from_array(cell) + 0.3 * random.vector()),
        velocity: Vec3::new(0.0, -3.0 * cell[1] / side as f32, 0.0) + random.vector(),
        radius: random.between(0.45, 0.65),
    }
}

/// About one pair an object.
fn uniform(random: &mut Random, _: usize, count: usize) -> Body {
    Body {
        position: (count as f32).cbrt() * 0.8 * random.vector(),
        velocity: 3.0 * random.vector(),
        radius: random.between(0.4, 0.6),
    }
}

/// Along the last axis, the two others giving a sweep nothing.
fn row(random: &mut Random, index: usize, _: usize) -> Body {
    Body {
        position: Vec3::new(0.0, 0.0, 0.9 * index as f32) + 0.3 * random.vector(),
        velocity: 2.0 * random.vector(),
        radius: random.between(0.4, 0.6),
    }
}

/// Sizes from 0.01 to 10, each octave as frequent as any other.
fn mixed(random: &mut Random, _: usize, count: usize) -> Body {
    Body {
        position: (count as f32).cbrt() * 2.5 * random.vector(),
        velocity: random.vector(),
        radius: 0.01 * 1000_f32.powf(random.between(0.0, 1.0)),
    }
}

/// Forty dense clumps, far apart.
fn clustered(random: &mut Random, index: usize, count: usize) -> Body {
    let mut clump = Random(1 + (index % 40) as u64);
    let spread = (count as f32 / 40.0).cbrt();
    let offset = random.vector() + random.vector() + random.vector();
    Body {
        position: 1000.0 * clump.vector() + 0.5 * spread * offset,
        velocity: 2.0 * clump.vector() + random.vector(),
        radius: random.between(0.4, 0.6),
    }
}

/// The splitmix64 generator: scenes do not depend on the version of a crate.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * (self.next() >> 40) as f32 / (1 << 24) as f32
    }

    /// Each coordinate between −1 and 1.
    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }
}
