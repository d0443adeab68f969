//! The least translation that parts bodies that cross or touch.
//!
//! G. van den Bergen, "Proximity queries and penetration depth computation on 3D game objects",
//! 2001. A polytope inside the difference grows around the origin. Its nearest face is never
//! farther than the surface of the difference. A move to the support plane of the difference along
//! any direction separates the bodies. If both distances agree, the move is the least one. Rounding
//! of thin faces can end the growth early, but every move separates the bodies.

use super::ConvexContact;
use super::polytope::{Face, Polytope};
use super::simplex::{Simplex, thin_normal};
use super::support::{Difference, SupportMap, Vertex};
use glamx::DVec3;

/// Share of the depth that may be left open, for polytopes and for curved shapes.
const PROVED: [f64; 2] = [1.0e-10, 1.0e-5];

/// Share of the size that rounding leaves open.
const ROUNDING: f64 = 1.0e-14;

/// A difference with less extent across its widest plane or line, as a share of the size, has none.
const FLAT: f64 = 1.0e-12;

/// The contact if the difference holds the origin inside a tetrahedron.
pub(super) fn crossing_contact<S: SupportMap>(
    difference: &Difference<S>,
    tetrahedron: [Vertex; 4],
    size: f64,
) -> Option<ConvexContact> {
    let slack = ROUNDING * size;
    let proved = PROVED[usize::from(S::IS_CURVED)];
    let mut polytope = Polytope::empty(slack);
    polytope.begin(tetrahedron);
    let mut best: Option<(f64, Face)> = None;
    while let Some(i) = polytope.nearest_open() {
        let face = polytope.get(i);
        let new = difference.farthest(face.normal);
        let reach = new.point.dot(face.normal);
        let open = slack + proved * reach.abs();
        let is_proved = reach - face.distance <= open;
        // The origin may be above one of two faces as near as the proved one. Rounding of a thin
        // difference may prove a face that is far; each move separates the bodies, so the least one
        // counts.
        if best.is_none_or(|(depth, _)| reach < depth || is_proved && reach <= depth + open) {
            best = Some((reach, *face));
        }
        if is_proved {
            break;
        }
        if !polytope.expand(i, new) {
            polytope.close(i);
        }
    }
    let (depth, face) = best?;
    let on_triangle = point_below(&polytope, &face, difference.triangle, 100.0 * slack);
    Some(ConvexContact::new(on_triangle, -face.normal, -depth))
}

/// The point of the triangle at the foot of the origin on a face. If the foot is beside the face,
/// another face in nearly the same plane holds it.
fn point_below(polytope: &Polytope, face: &Face, corners: &[DVec3; 3], slack: f64) -> DVec3 {
    let foot = face.normal * face.distance;
    let (mut least, mut point) = polytope.nearest_to(foot, face, corners);
    if least > slack * slack {
        for (_, other) in polytope.faces() {
            let (squared, candidate) = polytope.nearest_to(foot, other, corners);
            if squared < least {
                (least, point) = (squared, candidate);
            }
        }
    }
    point
}

/// The contact if a simplex of the difference holds the origin up to rounding.
#[cold]
pub(super) fn touching_contact<S: SupportMap>(
    difference: &Difference<S>,
    simplex: &Simplex,
    size: f64,
) -> Option<ConvexContact> {
    let on_triangle = simplex.on_triangle(difference.triangle);
    let flat = |normal: DVec3| {
        let [up, down] = [normal, -normal].map(|u| (difference.farthest(u).point.dot(u), u));
        let (depth, outward) = if down.0 < up.0 { down } else { up };
        Some(ConvexContact::new(on_triangle, -outward, -depth))
    };
    let given = simplex.vertices();
    let a = given[0];
    let beyond_point = || farthest_of(difference, a, DVec3::AXES, size);
    let Some(b) = given.get(1).copied().or_else(beyond_point) else {
        return flat(DVec3::Z);
    };
    let along = b.point - a.point;
    let is_wide = |c: &Vertex| thin_normal([a.point, b.point, c.point]).is_some();
    let third = given.get(2).copied().filter(is_wide);
    let Some(c) = third.or_else(|| beyond_line(difference, a, along, size)) else {
        return flat(along.try_normalize()?.any_orthonormal_vector());
    };
    let Some((normal, squared)) = thin_normal([a.point, b.point, c.point]) else {
        return flat(along.try_normalize()?.any_orthonormal_vector());
    };
    let normal = normal / squared.sqrt();
    match across(difference, a, normal) {
        (height, d) if height > FLAT * size => crossing_contact(difference, [a, b, c, d], size),
        _ => flat(normal),
    }
}

/// The farther one of both support points across a plane through `a`, and how far it is.
fn across<S: SupportMap>(difference: &Difference<S>, a: Vertex, normal: DVec3) -> (f64, Vertex) {
    let [up, down] = [normal, -normal].map(|u| {
        let vertex = difference.farthest(u);
        ((vertex.point - a.point).dot(u), vertex)
    });
    if down.0 > up.0 { down } else { up }
}

fn beyond_line<S: SupportMap>(
    difference: &Difference<S>,
    a: Vertex,
    along: DVec3,
    size: f64,
) -> Option<Vertex> {
    let along = along.try_normalize()?;
    let across = along.any_orthonormal_vector();
    farthest_of(difference, a, [across, along.cross(across), DVec3::ZERO], size)
}

/// The support point farthest from `a` along any of some axes. `None` if no point is off `a`.
fn farthest_of<S: SupportMap>(
    difference: &Difference<S>,
    a: Vertex,
    axes: [DVec3; 3],
    size: f64,
) -> Option<Vertex> {
    let found = axes.map(|axis| across(difference, a, axis));
    let most = found.into_iter().reduce(|x, y| if y.0 > x.0 { y } else { x })?;
    (most.0 > FLAT * size).then_some(most.1)
}
