//! Thin bowls, each dropped into the one below.

use std::f32::consts::{FRAC_PI_2, TAU};

use glamx::{Vec2, Vec3};
use rapier3d::dynamics::RigidBodyBuilder;

use super::Trial;
use super::figures::Figures;
use super::kit::{Form, Kit};
use crate::mesh;

const BOWLS: usize = 10;
const RADIUS: f32 = 0.5;
const THICKNESS: f32 = 0.03;
/// Parts of a bowl round its axis, and from its lowest point to its rim.
const SEGMENTS: u32 = 24;
const RINGS: u32 = 8;
/// Between two bowls at the start.
const GAP: f32 = 0.02;
const STEPS: usize = 360;

pub(super) fn trials() -> Vec<Trial> {
    vec![Trial::new("ten nested bowls", run).seeded()]
}

/// Half a hollow ball, its middle at the origin.
fn form() -> Form {
    let point = |radius: f32, ring: u32| {
        let (sin, cos) = (FRAC_PI_2 * ring as f32 / RINGS as f32).sin_cos();
        // Exactly on the axis and on the rim.
        let [sin, cos] = [sin, cos].map(|part| if part.abs() < 1e-6 { 0.0 } else { part });
        radius * Vec2::new(sin, -cos)
    };
    let inner = RADIUS - THICKNESS;
    let outside = (0..=RINGS).map(|ring| point(RADIUS, ring));
    let inside = (0..=RINGS).rev().map(|ring| point(inner, ring));
    let profile: Vec<Vec2> = outside.chain(inside).collect();
    let patches = (0..RINGS).flat_map(|ring| (0..SEGMENTS).map(move |segment| [ring, segment]));
    let patches = patches.map(|[ring, segment]| {
        let corners = [RADIUS, inner].into_iter().flat_map(|radius| {
            [ring, ring + 1].into_iter().flat_map(move |ring| {
                [segment, segment + 1].map(|segment| {
                    let Vec2 { x, y } = point(radius, ring);
                    let (sin, cos) = (TAU * segment as f32 / SEGMENTS as f32).sin_cos();
                    Vec3::new(x * cos, y, x * sin)
                })
            })
        });
        corners.collect()
    });
    Form::parts(mesh::revolved(&profile, SEGMENTS), patches)
}

fn run(kit: &Kit) -> Figures {
    let inner = RADIUS - THICKNESS;
    // A bowl rests on the inner rim of the one below.
    let apart = (RADIUS * RADIUS - inner * inner).sqrt();
    let mut world = kit.world();
    let mut random = kit.random();
    let collider = kit.collider(&form());
    for index in 0..BOWLS {
        // The first stands on nothing: it is fixed.
        let body = match index {
            0 => RigidBodyBuilder::fixed(),
            _ => RigidBodyBuilder::dynamic(),
        };
        let body = body.translation(Vec3::Y * index as f32 * (apart + GAP));
        world.add(body.rotation(Vec3::Y * TAU * random.rand_float()), &collider);
    }
    world.run(STEPS);
    let ends = world.places();
    let steps = ends.windows(2).map(|pair| pair[1] - pair[0]);
    let is_nested = |step: &Vec3| (step.length() - apart).abs() < 0.5 * apart && step.y > 0.0;
    let lost = steps.filter(|step| !is_nested(step)).count();
    Figures::default()
        .none("not nested", lost)
        .at_most("speed", world.top_speed(), 0.25)
        .note("height of one", (ends[BOWLS - 1].y - ends[0].y) / (BOWLS - 1) as f32)
}
