//! A monkey head, for piles of concave objects that are easy to recognise.
//!
//! A sphere is shaped by a list of features, one after the other. Feature `f` has a centre `c` on
//! the unit sphere and a weight `w(u) = (1 - t^a)^b`, where `t = |(u - c) / spread|^2 < 1` and
//! `[a, b]` is its profile, and moves the point `p` that stands for direction `u` to
//!
//! ```text
//! p + w(u) * (pull + stretch * (p - anchor)),    anchor: where f's centre came to lie before f
//! ```
//!
//! `pull` makes bumps and hollows, `stretch` flattens and widens them: that is how a bump at the
//! side of the head becomes an ear. Features off the middle act on both sides alike.
//! Only arithmetic and square roots are used, so that the head is the same on all machines.

use glamx::Vec3;

use super::Mesh;
use super::shapes::octasphere;

/// A step of the shaping, see the formula above.
struct Feature {
    /// A direction, of any length.
    centre: Vec3,
    /// Reach from the centre along each axis, on the unit sphere.
    spread: Vec3,
    /// Powers `a` and `b`: a large `a` makes a plateau, a large `b` a soft rim.
    profile: [i32; 2],
    pull: Vec3,
    stretch: Vec3,
    /// Place of the centre before this feature.
    anchor: Vec3,
}

/// Half axes of the skull before the features, `x` across, `y` up, `z` to the face.
const SKULL: Vec3 = Vec3::new(0.80, 0.88, 0.84);

/// Multiplies the directions of the vertices: gathers them at the ears, whose thin rims need them
/// most. Smaller `y` and `z`: more at the ears, fewer elsewhere.
const SIDE_FOCUS: Vec3 = Vec3::new(1.0, 0.65, 0.75);

/// Added to the directions of the vertices then: gathers them on the face, as the back of the head
/// is smooth. Must stay below the smallest part of [`SIDE_FOCUS`], or the sphere would fold.
const FACE_FOCUS: Vec3 = Vec3::new(0.0, 0.0, 0.45);

/// Profiles: most features have a soft rim, ears a sharp one.
const SOFT: [i32; 2] = [2, 2];
const SHARP: [i32; 2] = [1, 1];

/// Profile, and centre, spread, pull and stretch. From large to small: later features shape what
/// the earlier ones have made.
const FEATURES: [([i32; 2], [[f32; 3]; 4]); 10] = [
    // Jaw, narrower than the skull.
    (SOFT, [[0.0, -0.85, 0.35], [0.9; 3], [0.0, -0.05, 0.10], [-0.25, 0.0, 0.0]]),
    // Flat face below the forehead.
    (SOFT, [[0.0, 0.1, 1.0], [0.75, 0.55, 0.75], [0.0, 0.0, -0.08], [0.0; 3]]),
    // Muzzle.
    (SOFT, [[0.0, -0.50, 0.86], [0.60, 0.45, 0.60], [0.0, -0.06, 0.36], [0.30, 0.15, 0.0]]),
    // Ears.
    (SHARP, [[0.98, 0.12, -0.05], [0.42; 3], [0.52, 0.08, -0.12], [0.0, 1.0, -0.68]]),
    // Hollow of the ears.
    (SOFT, [[0.92, 0.12, 0.24], [0.26; 3], [-0.07, 0.0, -0.09], [0.0; 3]]),
    // Brow, highest above each eye.
    (SOFT, [[0.26, 0.46, 0.86], [0.45, 0.24, 0.45], [0.0, 0.0, 0.13], [0.0; 3]]),
    // Eye sockets.
    (SOFT, [[0.30, 0.12, 0.93], [0.26, 0.26, 0.4], [0.0, 0.0, -0.20], [0.0; 3]]),
    // Eyeballs.
    (SOFT, [[0.30, 0.12, 0.93], [0.17, 0.17, 0.4], [0.0, 0.0, 0.14], [0.0; 3]]),
    // Nose.
    (SOFT, [[0.0, -0.25, 0.97], [0.14, 0.11, 0.3], [0.0, 0.0, 0.08], [0.0; 3]]),
    // Mouth.
    (SOFT, [[0.0, -0.47, 0.88], [0.50, 0.13, 0.6], [0.0, 0.0, -0.13], [0.0; 3]]),
];

/// The monkey head in its usual resolution: 968 triangles, 486 vertices.
pub fn monkey_head() -> Mesh {
    monkey_head_with(11)
}

/// A monkey head of `8 * detail * detail` triangles (`detail` at least 1; from about 6 it looks
/// like one), about the origin, 2 units across its longest side, facing `z`. Closed and oriented,
/// with concave eye sockets and ears.
pub fn monkey_head_with(detail: u32) -> Mesh {
    let mut features = Vec::with_capacity(FEATURES.len());
    for (profile, vectors) in FEATURES {
        let [centre, spread, pull, stretch] = vectors.map(Vec3::from_array);
        let anchor = shaped(centre.normalize(), &features);
        features.push(Feature { centre, spread, profile, pull, stretch, anchor });
    }
    let head = octasphere(detail).mapped(|point| {
        let mirror = Vec3::new(1f32.copysign(point.x), 1.0, 1.0);
        let direction = (point * mirror * SIDE_FOCUS + FACE_FOCUS).normalize();
        shaped(direction, &features) * mirror
    });
    head.centred().scaled_to(2.0).named("monkey head")
}

/// Maps a direction with `x >= 0` by these features.
fn shaped(direction: Vec3, features: &[Feature]) -> Vec3 {
    features.iter().fold(direction * SKULL, |point, feature| {
        let change = feature.pull + feature.stretch * (point - feature.anchor);
        point + feature.weight(direction) * change
    })
}

impl Feature {
    fn weight(&self, direction: Vec3) -> f32 {
        let [plateau, rim] = self.profile;
        let t = ((direction - self.centre.normalize()) / self.spread).length_squared();
        (1.0 - t.powi(plateau)).max(0.0).powi(rim)
    }
}
