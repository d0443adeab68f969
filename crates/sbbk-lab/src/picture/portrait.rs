//! Pictures of worlds.

use glamx::Vec3;
use rapier3d::geometry::{Collider, TypedShape};
use rapier3d::parry::bounding_volume::{Aabb, BoundingVolume};

use super::{Camera, Colour, Picture};
use crate::mesh::Mesh;
use crate::scene::SceneWorld;

/// Colours of moving bodies, one after the other.
const COLOURS: [Colour; 6] = [
    [214, 160, 96],
    [120, 160, 210],
    [170, 190, 110],
    [205, 120, 110],
    [160, 140, 190],
    [225, 200, 120],
];
/// Colour of fixed bodies.
const FIXED: Colour = [176, 180, 186];
/// Direction of the view of the whole scene.
const VIEW: Vec3 = Vec3::new(-0.55, -0.45, -1.0);
/// Distance of the camera, in radii of the bounds: near enough to fill the picture, and to cut off
/// a corner of a scene that is as deep as it is wide.
const DISTANCE: f32 = 2.5;
/// The same for the moving bodies alone, so that they are large.
const CLOSE_DISTANCE: f32 = 2.2;
/// Segments of balls, around and from pole to pole.
const BALL_SEGMENTS: u32 = 32;

impl SceneWorld {
    /// The world as it is now: meshes and balls, on the cuboid floor or on the ground.
    pub fn portrait(&self, width: u32, height: u32) -> Picture {
        self.drawn(width, height, camera(&self.bounds(|_| true), VIEW, DISTANCE))
    }

    /// The same, of the moving bodies, which fill the picture; seen along `direction`.
    pub fn close_up(&self, width: u32, height: u32, direction: Vec3) -> Picture {
        let bounds = self.bounds(|collider| self.is_moving(collider));
        self.drawn(width, height, camera(&bounds, direction, CLOSE_DISTANCE))
    }

    fn colliders(&self) -> impl Iterator<Item = &Collider> {
        self.world.colliders.iter().map(|(_, collider)| collider)
    }

    fn is_moving(&self, collider: &Collider) -> bool {
        collider.parent().is_some_and(|body| self.watched.contains(&body))
    }

    /// The box around all that is wanted and drawn: all but cuboids.
    fn bounds(&self, is_wanted: impl Fn(&Collider) -> bool) -> Aabb {
        let wanted = self.colliders().filter(|c| is_wanted(c) && c.shape().as_cuboid().is_none());
        let bounds = wanted.map(Collider::compute_aabb);
        bounds.reduce(|a, b| a.merged(&b)).unwrap_or(Aabb::new_invalid())
    }

    /// Where there is no floor, the ground is as low as the lowest body.
    fn drawn(&self, width: u32, height: u32, camera: Camera) -> Picture {
        let floor = self.colliders().find(|collider| collider.shape().as_cuboid().is_some());
        let ground = match floor {
            Some(floor) => floor.compute_aabb().maxs.y,
            None => self.bounds(|_| true).mins.y,
        };
        let mut picture = Picture::new(width, height, camera).with_ground(ground);
        let mut colours = COLOURS.into_iter().cycle();
        for collider in self.colliders() {
            let colour = if self.is_moving(collider) { colours.next() } else { None };
            if let Some(mesh) = mesh(collider) {
                picture.draw(&mesh, collider.position(), colour.unwrap_or(FIXED));
            }
        }
        picture
    }
}

fn camera(bounds: &Aabb, direction: Vec3, distance: f32) -> Camera {
    let distance = distance * bounds.half_extents().length();
    let target = bounds.center();
    Camera { eye: target - distance * direction.normalize(), target }
}

/// What to draw for a collider; `None` for floors and shapes that no scene has.
fn mesh(collider: &Collider) -> Option<Mesh> {
    let (vertices, triangles) = match collider.shape().as_typed_shape() {
        TypedShape::TriMesh(mesh) => (mesh.vertices().to_vec(), mesh.indices().to_vec()),
        TypedShape::HeightField(field) => field.to_trimesh(),
        TypedShape::Ball(ball) => ball.to_trimesh(BALL_SEGMENTS, BALL_SEGMENTS),
        _ => return None,
    };
    Some(Mesh::new("collider", vertices, triangles))
}
