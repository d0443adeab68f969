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
/// Subdivision of primitive balls.
const BALL_DETAIL: u32 = 12;

impl SceneWorld {
    /// The world as it is now: meshes and balls, on the cuboid floor or on the ground.
    pub fn portrait(&self, width: u32, height: u32) -> Picture {
        let colliders = || self.world.colliders.iter().map(|(_, collider)| collider);
        let shown = colliders().filter(|collider| drawn_mesh(collider).is_some());
        let bounds = shown.map(Collider::compute_aabb);
        let bounds = bounds.reduce(|a, b| a.merged(&b)).unwrap_or(Aabb::new_invalid());
        let radius = bounds.half_extents().length();
        let distance = DISTANCE * radius;
        let eye = bounds.center() + distance * DIRECTION.normalize();
        let picture = Picture::new(width, height, Camera::looking(eye, bounds.center()));
        let floor = colliders().find(|collider| collider.shape().as_cuboid().is_some());
        let ground = floor.map_or(bounds.mins.y, |floor| floor.compute_aabb().maxs.y);
        let mut picture = picture.with_ground(ground);
        let mut meshes = HashMap::new();
        let mut colours = COLOURS.into_iter().cycle();
        for collider in colliders() {
            let is_moving = collider.parent().is_some_and(|body| self.watched.contains(&body));
            let mesh = meshes
                .entry(shape_address(collider.shape()))
                .or_insert_with(|| drawn_mesh(collider));
            if let Some(mesh) = mesh {
                let colour = if is_moving { colours.next() } else { None };
                picture.draw(mesh, *collider.position(), colour.unwrap_or(FIXED));
            }
        }
        picture
    }
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
