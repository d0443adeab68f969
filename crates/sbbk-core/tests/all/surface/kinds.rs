use std::f32::consts::{PI, TAU};

use super::shapes::*;
use crate::support::{Random, Soup, soup};
use glamx::{Quat, Vec3};
use sbbk_core::surface::SurfaceKind::{InsideOut, Sheet, Solid};
use sbbk_core::surface::is_surely_open;

fn half(mesh: Soup) -> Soup {
    mapped(mesh, |v| 0.5 * v)
}

/// Solids that face outward.
fn solids() -> Vec<(&'static str, Soup)> {
    let beside = |mesh: Soup| mapped(mesh, |v| v + 3.0 * Vec3::X);
    vec![
        ("cube", cube()),
        ("cube of 36 vertices", unwelded(&cube())),
        ("ball", ball()),
        ("ball with a seam", lathe(&arc(1.0), TAU, false)),
        ("torus", torus()),
        ("hollow ball", together([ball(), turned_inside_out(half(ball()))])),
        ("two balls", together([ball(), beside(ball())])),
        ("balls in a ball", together([ball(), half(ball()), beside(ball())])),
        ("plate", mapped(cube(), |v| v * Vec3::new(1.0, 1.0, 0.001))),
        ("ball without a triangle", without(ball(), &[300])),
        ("ball with holes", without(ball(), &every_ninth(36))),
        ("ball with a triangle turned", with_turned(ball(), 300)),
        ("bottle", glove(70.0)),
        ("pot with a lid", with_lid(0.93, 0.0)),
        ("pot with a lid in it", with_lid(0.97, -0.02)),
    ]
}

/// Numbers of triangles of a ball, which has 912.
fn every_ninth(count: usize) -> Vec<usize> {
    (0..count).map(|i| 9 * i).collect()
}

fn sheets() -> Vec<(&'static str, Soup)> {
    let flat = |z: f32| sheet(8, move |_, _| z);
    let mut lidless = cube();
    lidless.triangles.drain(2..4);
    // The lid reaches over half of the box.
    let mut half_open = lidless.clone();
    half_open.vertices.extend([Vec3::new(0.0, -0.5, 0.5), Vec3::new(0.0, 0.5, 0.5)]);
    half_open.triangles.extend([[4, 8, 9], [4, 9, 6]]);
    vec![
        ("nothing", Soup { vertices: Vec::new(), triangles: Vec::new() }),
        ("ball with more holes", without(ball(), &every_ninth(100))),
        ("cube with a triangle turned", with_turned(cube(), 3)),
        ("pot with a small lid", with_lid(0.8, 0.0)),
        ("pot with a lid that floats", with_lid(0.95, 0.3)),
        ("pot with a lid upside down", with_lid(-0.95, 0.0)),
        ("glove", glove(4.0)),
        ("bowl", lathe(&arc(0.5), TAU, true)),
        ("deep bowl", lathe(&arc(0.8), TAU, true)),
        ("box without lid", lidless),
        ("half-open box", half_open),
        ("sheet", flat(0.3)),
        ("bent sheet", sheet(8, |x, y| 0.3 * (2.0 * x).sin() + 0.2 * y * y)),
        ("two layers", together([flat(0.0), turned_inside_out(flat(0.0))])),
        ("two layers, one way", together([flat(0.0), flat(0.0)])),
        ("folded sheet", mapped(flat(0.0), |v| v.with_x(-v.x.abs()))),
        ("Moebius strip", moebius()),
        ("soup", soup(&mut Random(44), 300, 0.3)),
        ("tube", tube(TAU, true)),
        ("tube with a seam", tube(TAU, false)),
        ("tube with a slit", tube(0.99 * TAU, false)),
        ("half a tube", tube(PI, false)),
    ]
}

/// Mirrors turn solids inside out. Meshes that are surely open are sheets.
#[test]
fn kinds_are_independent_of_size_place_and_order() {
    let (mut random, mut open) = (Random(45), 0);
    let solids = solids().into_iter().map(|(name, mesh)| (name, mesh, Solid));
    let sheets = sheets().into_iter().map(|(name, mesh)| (name, mesh, Sheet));
    for (name, mesh, kind) in solids.chain(sheets) {
        for size in [1e-3, 1.0, 1e3] {
            let (turn, shift): (Quat, Vec3) = (random.rotation(), random.vector(3.0));
            let mut moved = mapped(mesh.clone(), |v| size * (turn * v + shift));
            for i in (1..moved.triangles.len()).rev() {
                moved.triangles.swap(i, (random.bits() % (i as u64 + 1)) as usize);
            }
            for triangle in &mut moved.triangles {
                triangle.rotate_left((random.bits() % 3) as usize);
            }
            let found = moved.surface().kind();
            assert_eq!(found, kind, "{name}, {size} times as large");
            let is_open = is_surely_open(&moved);
            assert!(!is_open || kind == Sheet, "{name} is no sheet");
            open += u32::from(is_open);
            let mirrored = mapped(moved, |v| v * Vec3::new(-1.0, 1.0, 1.0));
            let found = mirrored.surface().kind();
            let mirror = if kind == Solid { InsideOut } else { Sheet };
            assert_eq!(found, mirror, "{name}, mirrored");
        }
    }
    assert!(open > 20, "{open}");
}

#[test]
fn a_solid_with_a_hole_is_solid_far_from_the_origin() {
    let mut open = ball();
    open.triangles.retain(|corners| corners.iter().all(|&v| open.vertices[v as usize].z < 0.95));
    for away in Vec3::AXES.into_iter().flat_map(|axis| [100.0 * axis, -100.0 * axis]) {
        let moved = mapped(open.clone(), |v| v + away);
        assert_eq!(moved.surface().kind(), Solid, "at {away}");
    }
}
