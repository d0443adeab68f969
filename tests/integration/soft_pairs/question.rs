use glamx::Vec3;
use oorandom::Rand32;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::shape::{Compound, HeightField, HeightFieldCellStatus, SharedShape};
use rapier3d::parry::utils::Array2;

use crate::support::{Dispatcher, Manifold, Question, assert_same, rebuilt, triangles};

/// In units.
pub const PREDICTION: Real = 0.02;

/// The answer for the mesh built anew, which has a BVH of its own.
pub fn anew(question: &Question, dispatcher: &impl Dispatcher<(), ()>) -> Vec<Manifold> {
    let mesh = rebuilt(question.mesh());
    Question { shapes: [question.shapes[0], &mesh], ..*question }.fresh(dispatcher)
}

/// Panics unless both have the same manifolds, in any order, bit for bit up to the sign of a zero.
pub fn assert_same_set(found: &[Manifold], expected: &[Manifold]) {
    assert_same(&sorted(found), &sorted(expected), 0.0);
}

/// By triangles.
pub fn sorted(manifolds: &[Manifold]) -> Vec<Manifold> {
    let mut manifolds = manifolds.to_vec();
    manifolds.sort_by_key(triangles);
    manifolds
}

/// Hills over four units, with holes and cells divided either way.
pub fn hills(random: &mut Rand32) -> HeightField {
    let heights = (0..17 * 15).map(|_| 0.3 * random.rand_float()).collect();
    field(random, [17, 15], heights)
}

/// Steps and plains: heights that are whole multiples of a quarter, cells of a quarter.
pub fn steps(random: &mut Rand32) -> HeightField {
    let heights = (0..17 * 17).map(|_| 0.25 * random.rand_range(0..2) as Real).collect();
    field(random, [17, 17], heights)
}

fn field(random: &mut Rand32, lines: [usize; 2], heights: Vec<Real>) -> HeightField {
    let heights = Array2::new(lines[0], lines[1], heights);
    let mut field = HeightField::new(heights, Vec3::new(4.0, 1.0, 4.0));
    for status in field.cells_statuses_mut().data_mut() {
        let hole = if random.rand_range(0..8) == 0 { 2 << random.rand_range(0..2) } else { 0 };
        let bits = hole | random.rand_range(0..2) as u8;
        *status = HeightFieldCellStatus::from_bits_truncate(bits);
    }
    field
}

/// A floor of boxes, with balls and a bar on it.
pub fn furniture(bar: SharedShape) -> Compound {
    let mut parts = Vec::new();
    for (x, z) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
        parts.push((Pose::translation(x, -0.1, z), SharedShape::cuboid(1.0, 0.2, 1.0)));
        parts.push((Pose::translation(0.4 * x, 0.1, 0.4 * z), SharedShape::ball(0.2)));
    }
    parts.push((Pose::translation(0.1, 0.2, 0.0), bar));
    Compound::new(parts)
}
