//! A helicopter, to drop things on: thin blades, tubes and a round body in one mesh.
//!
//! Each part is a loft through elliptical rings: a closed solid of its own. Parts reach into each
//! other where they are joined, as parts of such models do. Frame: `x` forwards, `y` up, the rotor
//! turns about the `y` axis, and the skids stand on `y = 0`.

use std::f32::consts::{FRAC_PI_2, TAU};

use glamx::{Pose3, Quat, Vec3};

use super::Mesh;
use super::shapes::{Ring, loft};

/// Height of the middle of the rotor above the ground.
const ROTOR_HEIGHT: f32 = 1.95;

/// The helicopter, 5.9 units long with its rotor of four blades.
pub fn helicopter() -> Mesh {
    let mut parts = hull();
    parts.extend(tail());
    for side in [-1.0, 1.0] {
        parts.extend(landing_gear(side));
    }
    let centre = Vec3::Y * ROTOR_HEIGHT;
    parts.push(tube(&[centre - Vec3::Y * 0.07, centre + Vec3::Y * 0.07], 0.14, 12));
    parts.extend(blades(4, 2.4, 0.13).map(|blade| blade.mapped(|point| point + centre)));
    Mesh::merged("helicopter", &parts)
}

/// Cabin, engine housing and mast.
fn hull() -> Vec<Mesh> {
    let cabin = [
        [-1.15, 1.22, 0.10, 0.08],
        [-1.00, 1.17, 0.21, 0.18],
        [-0.70, 1.08, 0.36, 0.34],
        [-0.35, 1.02, 0.47, 0.46],
        [0.05, 1.00, 0.53, 0.52],
        [0.45, 0.99, 0.54, 0.53],
        [0.80, 0.95, 0.49, 0.49],
        [1.10, 0.88, 0.39, 0.41],
        [1.32, 0.81, 0.27, 0.29],
        [1.45, 0.77, 0.14, 0.15],
        [1.50, 0.75, 0.04, 0.05],
    ];
    let housing = [
        [-0.85, 1.40, 0.06, 0.08],
        [-0.60, 1.45, 0.15, 0.19],
        [-0.15, 1.50, 0.18, 0.24],
        [0.25, 1.50, 0.15, 0.21],
        [0.45, 1.46, 0.06, 0.10],
    ];
    let mast = [Vec3::Y * 1.5, Vec3::Y * ROTOR_HEIGHT];
    vec![along_x(&cabin, 20), along_x(&housing, 14), tube(&mast, 0.06, 10)]
}

/// Boom, fin, stabiliser and tail rotor.
fn tail() -> Vec<Mesh> {
    let boom = [
        [-3.00, 1.32, 0.07, 0.06],
        [-2.40, 1.30, 0.10, 0.08],
        [-1.70, 1.27, 0.13, 0.11],
        [-0.70, 1.22, 0.19, 0.17],
    ];
    // Upwards: position along the length, height, half chord; thin across.
    let fin = [[-2.85, 1.12, 0.12], [-2.90, 1.32, 0.20], [-3.05, 1.65, 0.16], [-3.20, 2.00, 0.10]]
        .map(|[x, y, chord]| Ring {
            centre: Vec3::new(x, y, 0.0),
            half_axes: [Vec3::Z * 0.025, Vec3::X * chord],
        });
    let stabiliser = [-0.65, -0.3, 0.3, 0.65].map(|z| Ring {
        centre: Vec3::new(-2.25, 1.30, z),
        half_axes: [Vec3::X * 0.14, Vec3::Y * 0.02],
    });
    let rotor_centre = Vec3::new(-3.0, 1.36, 0.16);
    let axle = [rotor_centre - Vec3::Z * 0.16, rotor_centre + Vec3::Z * 0.04];
    let mut parts =
        vec![along_x(&boom, 12), loft(&fin, 10), loft(&stabiliser, 10), tube(&axle, 0.04, 8)];
    let turned = Quat::from_rotation_x(FRAC_PI_2) * Quat::from_rotation_y(1.0);
    let upright = Pose3::from_parts(rotor_centre, turned);
    parts.extend(blades(2, 0.5, 0.05).map(|blade| blade.posed(&upright)));
    parts
}

/// A skid and its two struts, on one side.
fn landing_gear(side: f32) -> [Mesh; 3] {
    let skid = [
        [-1.05, 0.05],
        [-0.4, 0.05],
        [0.3, 0.05],
        [0.95, 0.05],
        [1.15, 0.09],
        [1.27, 0.19],
        [1.32, 0.32],
    ]
    .map(|[x, y]| Vec3::new(x, y, side * 0.62));
    let strut = |x: f32| {
        let path = [[0.72, 0.22], [0.30, 0.52], [0.05, 0.62]];
        tube(&path.map(|[y, z]| Vec3::new(x, y, side * z)), 0.035, 8)
    };
    [tube(&skid, 0.05, 8), strut(-0.35), strut(0.65)]
}

/// Blades about the `y` axis, all at height zero.
fn blades(count: u32, radius: f32, half_chord: f32) -> impl Iterator<Item = Mesh> {
    let half_axes =
        [Vec3::new(0.0, 0.17, 1.0) * half_chord, Vec3::new(0.0, -1.0, 0.17) * 0.12 * half_chord];
    let rings: Vec<Ring> = (0..=16)
        .map(|step| Ring { centre: Vec3::X * radius * (0.04 + 0.06 * step as f32), half_axes })
        .collect();
    let blade = loft(&rings, 6);
    (0..count).map(move |index| {
        let angle = TAU * index as f32 / count as f32;
        blade.clone().posed(&Pose3::from_rotation(Quat::from_rotation_y(angle)))
    })
}

/// A solid along `x`; per ring position, height of its middle, half height and half width.
fn along_x(rings: &[[f32; 4]], segments: u32) -> Mesh {
    let ring = |&[x, y, half_height, half_width]: &[f32; 4]| Ring {
        centre: Vec3::new(x, y, 0.0),
        half_axes: [Vec3::Y * half_height, Vec3::Z * half_width],
    };
    loft(&rings.iter().map(ring).collect::<Vec<_>>(), segments)
}

/// A round tube along a path without sharp bends.
fn tube(path: &[Vec3], radius: f32, segments: u32) -> Mesh {
    let ring = |index: usize| {
        let [before, after] = [index.saturating_sub(1), (index + 1).min(path.len() - 1)];
        let forward = (path[after] - path[before]).normalize();
        let side = forward.any_orthonormal_vector();
        Ring {
            centre: path[index],
            half_axes: [side, forward.cross(side)].map(|axis| axis * radius),
        }
    };
    loft(&(0..path.len()).map(ring).collect::<Vec<_>>(), segments)
}
