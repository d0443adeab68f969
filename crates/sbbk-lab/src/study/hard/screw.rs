//! A nut that runs down a bolt by its weight.

use std::f32::consts::TAU;

use glamx::Vec3;
use rapier3d::dynamics::RigidBodyBuilder;

use super::Trial;
use super::figures::Figures;
use super::gears::Turn;
use super::kit::{Form, Kit};
use crate::mesh::Thread;

const BOLT: Thread = Thread::BOLT;
/// With a tenth of a pitch of play, and so much less deep.
const NUT: Thread = Thread { root: 0.92, thicker: 0.05, turns: 2, ..BOLT };
const NUT_RADIUS: f32 = 1.2;
const STEPS: usize = 720;

pub(super) fn trials() -> Vec<Trial> {
    let trial = |(friction, name): (f32, &str)| {
        Trial::new(name, move |kit| run(kit, friction)).without_control()
    };
    let names = ["nut runs down a bolt, friction 0.01", "nut is locked, friction 0.05"];
    [0.01, 0.05].into_iter().zip(names).map(trial).collect()
}

/// Runs the nut. Contact clustering is off, as it merges normals within five degrees.
fn run(kit: &Kit, friction: f32) -> Figures {
    let mut world = kit.world();
    world.integration_parameters.contact_clustering = false;
    let bolt = kit.collider(&Form::mesh(BOLT.bolt()));
    world.fix(Vec3::ZERO, bolt.friction(friction));
    let nut = kit.collider(&Form::mesh(NUT.nut(NUT_RADIUS)));
    let start = BOLT.pitch * (BOLT.turns - NUT.turns) as f32;
    let body = RigidBodyBuilder::dynamic().translation(Vec3::Y * start).can_sleep(false);
    let body = world.add(body, &nut.friction(friction));
    let mut turn = Turn::new(&world, body, Vec3::Y);
    // It first falls by the play of the thread.
    let (mut settled, mut place) = ([0.0; 2], start);
    for step in 1..=STEPS {
        world.step();
        turn.see(&world);
        place = world.bodies[body].translation().y;
        if step == SETTLED {
            settled = [turn.angle, place];
        }
        // Before it leaves the bolt.
        if place <= BOLT.pitch {
            break;
        }
    }
    let descent = (settled[1] - place) / BOLT.pitch;
    let turns = (settled[0] - turn.angle) / TAU;
    let figures = Figures::default();
    match friction > 0.03 {
        true => figures.within("pitches down", descent, -0.1, 0.3),
        false => figures.within("pitches down", descent, 1.0, f64::from(BOLT.turns)).within(
            "turns a pitch",
            turns / descent,
            0.98,
            1.02,
        ),
    }
}

/// Steps until it rests on the thread.
const SETTLED: usize = 30;
