//! Pictures of worlds.

use std::collections::HashMap;

use glamx::Vec3;
use rapier3d::geometry::{Collider, TypedShape};
use rapier3d::parry::bounding_volume::{Aabb, BoundingVolume};

use super::SceneWorld;
use crate::backend::shape_address;
use crate::mesh::{self, Mesh};
use crate::picture::{Camera, Colour, Picture};

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
/// From the middle of the scene to the camera.
const DIRECTION: Vec3 = Vec3::new(0.55, 0.45, 1.0);
/// Distance of the camera, in radii of the scene's bounds: near enough to fill the picture, and to
/// cut off a corner of a scene that is as deep as it is wide.
const DISTANCE: f32 = 2.5;
/// The same for the moving bodies alone, so that they are large.
const CLOSE_DISTANCE: f32 = 2.2;
/// Subdivision of primitive balls.
const BALL_DETAIL: u32 = 12;

impl SceneWorld {
    /// The world as it is now: meshes and balls, on the cuboid floor or on the ground.
    pub fn portrait(&self, width: u32, height: u32) -> Picture {
        let bounds = self.bounds(|_| true);
        self.drawn(width, height, camera(&bounds, DIRECTION, DISTANCE), &bounds)
    }

    /// The same, of the moving bodies, which fill the picture; seen along `direction`.
    pub fn close_up(&self, width: u32, height: u32, direction: Vec3) -> Picture {
        let bounds = self.bounds(|collider| self.is_moving(collider));
        let camera = camera(&bounds, -direction, CLOSE_DISTANCE);
        self.drawn(width, height, camera, &self.bounds(|_| true))
    }

    fn is_moving(&self, collider: &Collider) -> bool {
        collider.parent().is_some_and(|body| self.watched.contains(&body))
    }

    /// The box around all that is drawn and wanted.
    fn bounds(&self, is_wanted: impl Fn(&Collider) -> bool) -> Aabb {
        let colliders = self.world.colliders.iter().map(|(_, collider)| collider);
        let wanted = colliders.filter(|c| is_wanted(c) && drawn_mesh(c).is_some());
        let bounds = wanted.map(Collider::compute_aabb);
        bounds.reduce(|a, b| a.merged(&b)).unwrap_or(Aabb::new_invalid())
    }

    /// From the camera. Where there is no floor, the ground is as low as `bounds` of the whole scene.
    fn drawn(&self, width: u32, height: u32, camera: Camera, bounds: &Aabb) -> Picture {
        let colliders = || self.world.colliders.iter().map(|(_, collider)| collider);
        let picture = Picture::new(width, height, camera);
        let floor = colliders().find(|collider| collider.shape().as_cuboid().is_some());
        let ground = floor.map_or(bounds.mins.y, |floor| floor.compute_aabb().maxs.y);
        let mut picture = picture.with_ground(ground);
        let mut meshes = HashMap::new();
        let mut colours = COLOURS.into_iter().cycle();
        for collider in colliders() {
            let mesh = meshes
                .entry(shape_address(collider.shape()))
                .or_insert_with(|| drawn_mesh(collider));
            if let Some(mesh) = mesh {
                let colour = if self.is_moving(collider) { colours.next() } else { None };
                picture.draw(mesh, *collider.position(), colour.unwrap_or(FIXED));
            }
        }
        picture
    }
}

fn camera(bounds: &Aabb, direction: Vec3, distance: f32) -> Camera {
    let distance = distance * bounds.half_extents().length();
    Camera::looking(bounds.center() + distance * direction.normalize(), bounds.center())
}

/// What to draw for a collider; `None` for floors and shapes that no scene has.
fn drawn_mesh(collider: &Collider) -> Option<Mesh> {
    match collider.shape().as_typed_shape() {
        TypedShape::TriMesh(mesh) => {
            Some(Mesh::new("collider", mesh.vertices().to_vec(), mesh.indices().to_vec()))
        }
        TypedShape::HeightField(field) => {
            let (vertices, indices) = field.to_trimesh();
            Some(Mesh::new("terrain", vertices, indices))
        }
        TypedShape::Ball(ball) => Some(mesh::ball(ball.radius, BALL_DETAIL)),
        _ => None,
    }
}
