use glamx::{Quat, Vec3};
use rapier3d::math::{Pose, Real};
use rapier3d::parry::shape::HeightField;
use rapier3d::parry::utils::Array2;
use sbbk_testkit::mesh;

use super::terrain::Terrain;
use crate::support::{Question, counting, shape};

/// Would catch a descent that visits more cells than lie under the mesh, and lost digits far from
/// the middle.
#[test]
fn a_million_cells_cost_what_is_under_the_mesh() {
    let head = shape(&mesh::monkey_head());
    let visited = |cells: u32, x: Real| {
        let size = 0.1 * cells as Real;
        // Hills do not depend on the size of the field.
        let lines = cells as usize + 1;
        let wave = |k: usize| (k as f32 - 0.5 * cells as f32) * 0.1;
        let heights = Array2::from_fn(lines, lines, |i, j| {
            0.3 * (1.7 * wave(i)).sin() * (1.3 * wave(j)).cos()
        });
        let field = HeightField::new(heights, Vec3::new(size, 1.0, size));
        let terrain = Terrain { field, mesh: head.clone(), ids: Vec::new() };
        let dispatcher = counting();
        let pose = Pose::from_parts(Vec3::new(x, 0.6, x), Quat::from_rotation_y(0.4));
        let count = Question::new(&terrain.field, &head, pose).fresh(&dispatcher).len();
        (count, dispatcher.stats().internals.descent.cells)
    };
    let (small_count, small) = visited(32, 0.1);
    let (large_count, large) = visited(1000, 0.1);
    assert!(small_count > 10, "{small_count} contacts");
    assert!(large_count.abs_diff(small_count) <= 2, "{large_count} for {small_count}");
    // Two units across are four hundred cells; a few layers of nodes are above them.
    assert!(large < 10 * 400, "{large} cells");
    assert!(large <= small + small / 4, "{large} for {small}");
    // In a corner of it.
    let (_, far) = visited(1000, 48.7);
    assert!(far < 10 * 400, "{far} cells");
    let (count, none) = visited(1000, 60.0);
    assert_eq!((count, none), (0, 0));
}
