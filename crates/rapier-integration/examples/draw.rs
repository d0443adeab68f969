//! Draws trees and contacts with Rapier's debug renderer. The lines go to an OBJ file that 3D
//! programs open.
//!
//! ```text
//! cargo run --release -p rapier-integration --example draw -- lines.obj
//! ```

use std::error::Error;
use std::fmt::Write;
use std::process::ExitCode;

use rapier_integration::{SbbkDispatcher, draw};
use rapier3d::parry::shape::Ball;
use rapier3d::pipeline::{DebugColor, DebugRenderBackend, DebugRenderObject, DebugRenderPipeline};
use rapier3d::prelude::*;

/// Layer of the trees that is drawn, from the root.
const LAYER: u32 = 4;
const USAGE: &str = "usage: draw FILE.obj";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match &arguments[..] {
        [option] if option == "--help" || option == "-h" => {
            println!("Writes the trees and contacts of a small world as lines.\n{USAGE}");
            ExitCode::SUCCESS
        }
        [path] if !path.starts_with('-') => match write_lines(path) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("error: {path}: {error}");
                ExitCode::FAILURE
            }
        },
        _ => {
            eprintln!("{USAGE}");
            ExitCode::FAILURE
        }
    }
}

fn write_lines(path: &str) -> Result<(), Box<dyn Error>> {
    let dispatcher = SbbkDispatcher::default();
    let world = world(&dispatcher);

    let mut lines = Lines::default();
    DebugRenderPipeline::default().render(
        &mut lines,
        &world.bodies,
        &world.colliders,
        &world.impulse_joints,
        &world.multibody_joints,
        &world.narrow_phase,
        &world.soft_bodies,
    );
    let stock = lines.0.len();
    draw_sbbk(&world, &dispatcher, &mut lines)?;
    std::fs::write(path, lines.obj()?)?;
    println!("wrote {path}: {stock} lines of Rapier, {} of SBBK", lines.0.len() - stock);
    Ok(())
}

/// Draws contacts, candidates, and a layer of the tree of each mesh on a backend of Rapier's debug
/// renderer.
fn draw_sbbk(
    world: &PhysicsWorld,
    dispatcher: &SbbkDispatcher,
    backend: &mut impl DebugRenderBackend,
) -> Result<(), Box<dyn Error>> {
    let tree = |collider: &Collider| dispatcher.prepare_shape(collider.shared_shape());
    for (handle, collider) in world.colliders.iter() {
        let object = DebugRenderObject::Collider(handle, collider);
        if let Some(prepared) = tree(collider)? {
            draw::layer(prepared.tree(), LAYER, collider.position(), |a, b, colour| {
                backend.draw_line(object, a, b, colour);
            });
        }
    }
    for pair in world.narrow_phase.contact_pairs() {
        let [one, two] = [pair.collider1, pair.collider2].map(|handle| &world.colliders[handle]);
        let object = DebugRenderObject::ContactPair(pair, one, two);
        let poses = [one.position(), two.position()];
        let shapes = [one.shape(), two.shape()];
        let mut line = |a, b, colour| backend.draw_line(object, a, b, colour);
        draw::contacts(pair.manifolds(), poses, 0.1, &mut line);
        draw::patches(pair.manifolds(), poses, &mut line);
        draw::triangles(pair.manifolds(), shapes, poses, &mut line);
        if let (Some(one), Some(two)) = (tree(one)?, tree(two)?) {
            let margin = world.integration_parameters.prediction_distance();
            draw::candidates((one.tree(), two.tree()), poses, margin, &mut line);
        }
    }
    Ok(())
}

/// Two mesh balls on a third, which lies on a floor.
fn world(dispatcher: &SbbkDispatcher) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.narrow_phase.set_query_dispatcher(dispatcher.clone());
    world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::cuboid(5.0, 0.1, 5.0));
    let (vertices, indices) = Ball::new(0.5).to_trimesh(24, 12);
    let ball = SharedShape::trimesh(vertices, indices).expect("it has triangles");
    for (index, place) in [0.0, -0.4, 0.4].into_iter().enumerate() {
        let place = Vector::new(place, 0.61 + 0.9 * index.min(1) as f32, 0.0);
        let body = RigidBodyBuilder::dynamic().translation(place);
        world.insert(body, ColliderBuilder::new(ball.clone()));
    }
    (0..20).for_each(|_| world.step());
    world
}

/// A backend that keeps the lines.
#[derive(Default)]
struct Lines(Vec<[Vector; 2]>);

impl DebugRenderBackend for Lines {
    fn draw_line(&mut self, _: DebugRenderObject, a: Vector, b: Vector, _: DebugColor) {
        self.0.push([a, b]);
    }
}

impl Lines {
    /// Returns an OBJ file of line elements, which have no colours.
    fn obj(&self) -> Result<String, std::fmt::Error> {
        let mut text = String::new();
        for (index, line) in self.0.iter().enumerate() {
            line.iter().try_for_each(|p| writeln!(text, "v {} {} {}", p.x, p.y, p.z))?;
            writeln!(text, "l {} {}", 2 * index + 1, 2 * index + 2)?;
        }
        Ok(text)
    }
}
