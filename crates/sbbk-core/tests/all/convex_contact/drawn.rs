//! Triangles and shapes from whole numbers, drawn by the fuzzer or at random. Corners are on a
//! grid, some equal, some moved by very little.

use super::shape::{Core, Shape, rounded};
use super::truth::{check, size};
use glamx::DVec3;
use sbbk_core::contact::convex::{ConeSupport, CylinderSupport, convex_contact};

/// Draws a number below another.
type Draw<'a, E> = &'a mut dyn FnMut(u64) -> Result<u64, E>;

/// A point on the grid of eighths, or next to one.
fn point<E>(draw: Draw<E>) -> Result<DVec3, E> {
    let mut coordinates = || -> Result<DVec3, E> {
        let mut coordinate = || draw(33).map(|x| (x as f64 - 16.0) / 8.0);
        Ok(DVec3::new(coordinate()?, coordinate()?, coordinate()?))
    };
    let (grid, nudge) = (coordinates()?, coordinates()?);
    let power = draw(51)?;
    Ok(grid + if power == 0 { DVec3::ZERO } else { nudge * 0.5_f64.powi(power as i32) })
}

/// Checks the contact of a triangle and a shape: points, segments, triangles, boxes and hulls by
/// the truth, cylinders and cones by the search.
pub fn check_drawn<E>(draw: Draw<E>) -> Result<(), E> {
    let triangle = [point(draw)?, point(draw)?, point(draw)?];
    let mut length = || draw(17).map(|x| x as f64 / 8.0);
    let (radius, half_height, half_width) = (length()?, length()?, length()?);
    let core = match draw(7)? {
        0 => Core::Point(point(draw)?),
        1 => Core::Segment([point(draw)?, point(draw)?]),
        2 => Core::Triangle([point(draw)?, point(draw)?, point(draw)?]),
        3 => Core::Cuboid(DVec3::new(half_height, half_width, radius)),
        4 => Core::Cylinder(CylinderSupport { half_height, radius: half_width }),
        5 => Core::Cone(ConeSupport { half_height, radius: half_width }),
        _ => {
            let count = 4 + draw(4)?;
            let points = (0..count).map(|_| point(draw)).collect::<Result<Vec<_>, E>>()?;
            // Hulls in f32 have faces of their own.
            let is_rounded = draw(3)? > 0;
            Core::Hull(if is_rounded { points.into_iter().map(rounded).collect() } else { points })
        }
    };
    let shape = Shape { core, radius };
    let contact = shape.contact(&triangle, 100.0).expect("within the margin");
    // Coordinates are up to 4. Bodies closer than 1e-10 of their sums may count as touching.
    let size = size(&triangle, &shape).max(8.0);
    let says = || format!("{contact:?} {shape:?} {triangle:?}");
    if matches!(shape.core, Core::Cylinder(_) | Core::Cone(_)) {
        check(&triangle, &shape, &contact, 1.0e-5 * size);
        let core = |direction: DVec3| shape.support(direction);
        let searched = convex_contact(&triangle, &core, 100.0).expect("within the margin");
        let is_no_deeper = contact.distance >= searched.distance - radius - 1.0e-5 * size;
        assert!(is_no_deeper, "{searched:?} {}", says());
    } else {
        check(&triangle, &shape, &contact, 1.0e-9 * size + open(&triangle, &shape, size));
        // No farther: the check has proved the rest, even of a point on a segment, where brute
        // force finds no axis.
        let truth = shape.truth().distance(&triangle);
        assert!(truth - contact.distance <= 1.0e-9 * size, "{truth} {}", says());
    }
    Ok(())
}

/// Angle by which rounding may move the normal of the thinnest face of the difference, times the
/// size.
///
/// A corner is off by `1e-16 size`, so the normal of a face of least height `h` is off by `1e-16
/// size / h`. All shadows along it are off by that times the size. Faces whose sine is below 1e-11
/// have no normal of their own.
fn open(triangle: &[DVec3; 3], shape: &Shape, size: f64) -> f64 {
    let corners: Vec<DVec3> =
        shape.vertices().iter().flat_map(|s| triangle.map(|t| *s - t)).collect();
    let mut least = f64::INFINITY;
    for (i, &a) in corners.iter().enumerate() {
        for (j, &b) in corners.iter().enumerate().skip(i + 1) {
            for &c in &corners[j + 1..] {
                let (u, v) = (b - a, c - a);
                let longest = u.length().max(v.length()).max((v - u).length());
                let height = u.cross(v).length() / longest;
                if height > 1.0e-15 * size {
                    least = least.min(height);
                }
            }
        }
    }
    (1.0e-15 * size * size / least).min(1.0e-5 * size)
}
