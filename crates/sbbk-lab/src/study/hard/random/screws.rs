//! A nut that runs down a bolt by its weight, or is locked by friction.

use super::prelude::*;
use crate::mesh::Thread;
use crate::study::hard::machines::Turn;

/// Longest time, in seconds, and pitches that a nut runs.
const SECONDS: f32 = 2.5;
const PITCHES: f32 = 1.8;

pub(super) fn run(draw: &mut Draw, kit: &Kit) -> Figures {
    draw.dt = draw.dt.clamp(1.0 / 120.0, 1.0 / 60.0);
    let [bolt, nut] = threads(draw);
    let meshes = [("bolt", bolt.bolt()), ("nut", nut.nut(0.6))];
    let parts = meshes.map(|(name, mesh)| draw.part(name, mesh.clone(), Part::clean(mesh, None)));
    let radius = 0.5 * (nut.root + bolt.root + bolt.height);
    let lead = bolt.pitch / TAU;
    let lean = (bolt.flank * bolt.pitch / bolt.height).atan();
    let slope = (lead / radius).atan();
    let is_locked = draw.chance(0.3);
    let share = if is_locked { draw.within(1.3, 2.0) } else { draw.within(0.0, 0.6) };
    let friction = share * slope.tan() * lean.cos();
    let slips = slope - (friction / lean.cos()).atan();
    let mass = &parts[1].mass;
    let axes = mass.principal_inertia_local_frame * Vec3::Y;
    let gyration = (axes * axes).dot(mass.principal_inertia()) / mass.mass();
    // By the unrolled thread.
    let pull = draw.gravity / (1.0 + gyration / (lead * radius * slips.tan()));
    let pull = if is_locked { 0.0 } else { pull };
    let start = Pose3::translation(0.0, bolt.pitch * (bolt.turns - nut.turns) as f32, 0.0);
    let [fixed, moving] = parts;
    let bodies = [Body::fixed(fixed, Pose3::IDENTITY), Body::moving(moving, start)];
    let bodies = bodies.map(|body| body.friction(friction));
    let mut stage = Stage::new(draw, kit, &bodies);
    // Threads are small beside the bolt.
    stage.world.integration_parameters.length_unit *= bolt.pitch;
    // Lead angles are of a few degrees: contact clustering takes such normals for one.
    stage.world.integration_parameters.contact_clustering = false;
    watched(&mut stage, bolt.pitch, pull)
}

/// The threads of a bolt, and of a nut with a tenth of a pitch of play, and so much less deep.
fn threads(draw: &mut Draw) -> [Thread; 2] {
    let pitch = draw.within(0.12, 0.3);
    let (height, flank) = (draw.within(0.4, 0.55) * pitch, draw.within(0.1, 0.15));
    // Facets take a tenth of the play at most. Larger ones could lock a nut.
    let least = PI * (0.45 / (0.02 * pitch)).sqrt();
    let segments = least.ceil() as u32 + draw.count(1, 8);
    let bolt = Thread { root: 0.4, height, pitch, flank, thicker: 0.0, turns: 4, segments };
    [bolt, Thread { root: bolt.root + 0.1 * pitch, thicker: 0.05, turns: 1, ..bolt }]
}

/// Runs the nut, which should run down with the acceleration `pull`, in sizes/s². A pull of 0 locks it.
fn watched(stage: &mut Stage, pitch: f32, pull: f32) -> Figures {
    let draw = stage.draw;
    let seconds = (2.0 * PITCHES * pitch / pull.max(1e-6)).sqrt().min(SECONDS);
    let mut turn = Turn::new(&stage.world, stage.handles[1], Vec3::Y);
    // It first falls by the play.
    let settled = draw.steps(3.0 * (0.2 * pitch / draw.gravity).sqrt()) + 1;
    let steps = draw.steps(seconds).max(settled);
    let mut before = [0.0; 2];
    for step in 1..=steps {
        stage.world.step();
        turn.see(&stage.world);
        if step == settled {
            before = [turn.angle, stage.place(1).y];
        }
    }
    let down = (before[1] - stage.place(1).y) / pitch;
    if pull == 0.0 {
        return Figures::default().within("pitches down, locked", down, [-0.05, 0.05]);
    }
    let angle = (turn.angle - before[0]).abs();
    let [first, last] = [settled, steps].map(|step| (step as f32 * draw.dt).powi(2));
    let ideal = f64::from(0.5 * pull * TAU / pitch * (last - first));
    let figures = Figures::default().within("turn", angle, [0.45 * ideal, 1.1 * ideal + 0.2]);
    figures.at_most("off its thread", f64::from((angle / TAU - down).abs()), 0.15)
}
