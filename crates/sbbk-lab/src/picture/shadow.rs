//! The shadow map: depths as seen from the sun, by which light knows what it reaches.

use glamx::{Vec2, Vec3};

use super::camera::View;
use super::raster;

/// Side of the shadow map in texels, memory 4 bytes each. Lower: blocky shadows; higher: slower.
const SIDE: usize = 2048;

/// Half the width of the square of texels averaged for a soft edge, in texels.
const SOFTNESS: i32 = 1;

/// Orthographic depths along the sunlight, around the camera's target.
pub(super) struct ShadowMap {
    /// Unit vector towards the sun.
    pub to_sun: Vec3,
    across: [Vec3; 2],
    centre: Vec3,
    /// Size of a texel, in world units.
    texel: f32,
    /// Height towards the sun of the highest surface over each texel.
    heights: Vec<f32>,
}

impl ShadowMap {
    /// The sun stands behind the camera's left shoulder, so that what is seen is lit from the
    /// side. The map reaches as far around the target as the camera is away from it; beyond, all
    /// is lit.
    pub fn new(view: &View) -> Self {
        let to_sun = (Vec3::Y - 0.5 * view.right - 0.9 * view.forward).normalize();
        let side = to_sun.any_orthonormal_vector();
        let reach = view.eye.distance(view.target);
        Self {
            to_sun,
            across: [side, to_sun.cross(side)],
            centre: view.target,
            texel: 2.0 * reach / SIDE as f32,
            heights: vec![f32::NEG_INFINITY; SIDE * SIDE],
        }
    }

    /// Lets a triangle, in world space, cast its shadow.
    pub fn cast(&mut self, corners: [Vec3; 3]) {
        let heights = Vec3::from_array(corners.map(|p| self.height(p)));
        let texels = corners.map(|p| self.texel_position(p));
        raster::fill(texels, [SIDE; 2], |index, weights| {
            let height = &mut self.heights[index];
            *height = height.max(weights.dot(heights));
        });
    }

    /// Part of the sunlight, in 0..1, that reaches a point on a surface with a unit `normal`.
    pub fn light_at(&self, point: Vec3, normal: Vec3) -> f32 {
        // Lifted off its own surface by the texels averaged, or it would shade itself in stripes.
        let lifted = point + normal * (self.texel * (1.0 + SOFTNESS as f32));
        let position = self.texel_position(lifted).floor();
        let height = self.height(lifted);
        let (mut lit, mut count) = (0, 0);
        for dy in -SOFTNESS..=SOFTNESS {
            for dx in -SOFTNESS..=SOFTNESS {
                let [x, y] = [position.x as i32 + dx, position.y as i32 + dy];
                let inside = [x, y].iter().all(|&k| (0..SIDE as i32).contains(&k));
                let clear = !inside || self.heights[y as usize * SIDE + x as usize] <= height;
                lit += i32::from(clear);
                count += 1;
            }
        }
        lit as f32 / count as f32
    }

    fn height(&self, point: Vec3) -> f32 {
        (point - self.centre).dot(self.to_sun)
    }

    fn texel_position(&self, point: Vec3) -> Vec2 {
        let offset = (point - self.centre) / self.texel;
        Vec2::from_array(self.across.map(|axis| offset.dot(axis))) + 0.5 * SIDE as f32
    }
}
