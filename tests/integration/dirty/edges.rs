use super::*;

/// Height of the bodies over the block.
const GAP: Real = 0.006;

/// A block with one triangle that is split at one of its edges.
fn split_block(triangle: usize, edge: usize) -> Mesh {
    let mut block = mesh::cuboid(Vec3::splat(0.5), 1);
    let corners = block.triangles[triangle];
    let [a, b, c] = [0, 1, 2].map(|i| corners[(edge + i) % 3]);
    let [start, end] = [a, b].map(|corner| block.vertices[corner as usize]);
    let middle = block.vertices.len() as u32;
    block.vertices.push(start.lerp(end, 0.3));
    block.triangles[triangle] = [a, middle, c];
    block.triangles.push([middle, b, c]);
    block
}

/// Flat bodies, and a round one.
fn bodies(half: Vec3, round: (&'static str, SharedShape)) -> [(&'static str, SharedShape); 4] {
    [
        ("cuboid", SharedShape::cuboid(half.x, half.y, half.z)),
        ("cylinder", SharedShape::cylinder(half.y, half.x)),
        round,
        ("mesh", mesh::cuboid(half, 1).shape()),
    ]
}

/// Bodies that come in over an edge of a block. Would catch an edge with a T-junction that counts
/// as a border, and contacts along the face beside an edge that stop bodies above it.
#[test]
fn bodies_over_an_edge_of_a_block_touch_nothing() {
    let half = Vec3::new(0.1, 0.05, 0.08);
    let bodies = bodies(half, ("ball", SharedShape::ball(half.y)));
    let every = every();
    let mut count = 0;
    let sides = (0..12).flat_map(|triangle| [0, 1, 2].map(|edge| (triangle, edge)));
    let split = sides.map(|(triangle, edge)| split_block(triangle, edge));
    let block = mesh::cuboid(Vec3::splat(0.5), 1);
    let open = block.keeping(|corners| corners.iter().any(|corner| corner.y < 0.0));
    for (index, block) in split.chain([open]).enumerate() {
        let block = block.shape();
        for (name, body) in &bodies {
            for step in 0..160 {
                let x = -0.65 + 0.002 * step as Real;
                for z in [-0.35, 0.05, 0.4] {
                    let place = Vec3::new(x, 0.5 + half.y + GAP, z);
                    let pose = Pose::from_translation(place);
                    let found = Question::new(&*block.0, &*body.0, pose).fresh(&every);
                    let least = found.iter().map(distance).fold(Real::INFINITY, Real::min);
                    count += found.len();
                    assert!(least > GAP - 1e-5, "block {index}, {name} at {place}: {least}");
                }
            }
        }
    }
    assert!(count > 10_000, "{count} contacts");
}

/// Flat bodies that are sunk in the top of a block and reach past its edge by up to 2 cm, or nearly
/// so. Would catch contacts with the wall behind the edge, which lead into the block and stop
/// bodies that slide off.
#[test]
fn bodies_sunk_in_a_block_do_not_meet_the_wall_below_its_edge() {
    let half = Vec3::new(0.1, 0.05, 0.08);
    let bodies = bodies(half, ("cone", SharedShape::cone(half.y, half.x)));
    let (every, mut random, mut count) = (every(), Rand32::new(11), 0);
    let blocks = [1, 4].map(|cells| mesh::cuboid(Vec3::new(1.0, 0.5, 1.0), cells).shape());
    for i in 0..300 {
        for (name, body) in &bodies {
            let mut within = |low: Real, high: Real| low + (high - low) * random.rand_float();
            let turn = Quat::from_rotation_y(within(-PI, PI));
            let reach = body.compute_aabb(&Pose::from_rotation(turn)).maxs.x;
            let over = 1.0 - reach + within(-0.02, 0.02);
            let place = Vec3::new(over, 0.5 + half.y - within(0.0, 0.005), within(-0.5, 0.5));
            let pose = Pose::from_parts(place, turn);
            let block = &blocks[i % 2];
            let found = Question::new(&*block.0, &*body.0, pose).fresh(&every);
            let least = found.iter().map(|manifold| manifold.local_n1.x).reduce(Real::min);
            assert!(least.is_some_and(|x| x > -0.5), "{name} at {pose:?}: {least:?}");
            count += found.len();
        }
    }
    assert!(count > 1000, "{count} contacts");
}

/// Flat bodies that are sunk in two blocks and reach over the gap between these, so that the far
/// wall is near. Would catch contacts with the far wall. Such contacts stop bodies that slide over
/// the gap.
#[test]
fn bodies_over_a_gap_do_not_meet_its_far_wall() {
    let profile = [[0.0, -0.1], [0.3, -0.1], [0.3, 0.1], [0.0, 0.1]].map(Vec2::from);
    let bodies = [
        mesh::cuboid(Vec3::new(0.3, 0.1, 0.2), 2).shape(),
        mesh::revolved(&profile, 24).shape(),
        SharedShape::cuboid(0.3, 0.1, 0.2),
        SharedShape::cylinder(0.1, 0.3),
        SharedShape::cone(0.1, 0.3),
    ];
    let block =
        |cells: u32, x: Real| mesh::cuboid(Vec3::splat(0.5), cells).mapped(|v| v + x * Vec3::X);
    let grounds = [1, 3]
        .map(|cells| Mesh::merged("gap", &[block(cells, -0.525), block(cells, 0.525)]).shape());
    let (every, mut random) = (every(), Rand32::new(12));
    let (mut count, mut aside) = (0, 0);
    for i in 0..2500 {
        let mut within = |low: Real, high: Real| low + (high - low) * random.rand_float();
        let turn = Quat::from_rotation_y(within(-PI, PI));
        let body = &bodies[i % bodies.len()];
        let reach = body.compute_aabb(&Pose::from_rotation(turn)).maxs.x;
        let over = 0.025 - reach + within(-0.01, 0.001);
        let place = Vec3::new(over, 0.6 - within(2e-4, 2e-3), within(-0.2, 0.2));
        let ground = &grounds[i / bodies.len() % 2];
        let found =
            Question::new(&*ground.0, &*body.0, Pose::from_parts(place, turn)).fresh(&every);
        count += found.len();
        aside += found.iter().filter(|manifold| manifold.local_n1.y < 0.5).count();
    }
    println!("{aside} of {count} aside");
    assert!(count > 1000 && 1000 * aside <= count, "{aside} of {count} aside");
}

/// Flat bodies on two blocks with chamfers of 1 cm, before the chamfer on the far side of the gap.
/// Would catch contacts with this chamfer or with the wall below. Such contacts launch bodies that
/// slide over the gap.
#[test]
fn bodies_over_a_gap_do_not_meet_its_far_chamfer() {
    let bodies = bodies(Vec3::new(0.3, 0.1, 0.2), ("cone", SharedShape::cone(0.1, 0.3)));
    let outline = [[0.49, 0.5], [-0.49, 0.5], [-0.5, 0.49], [-0.5, -0.5], [0.5, -0.5], [0.5, 0.49]];
    let block = mesh::prism(&outline.map(Vec2::from), 0.5);
    let block = |x: Real| block.clone().mapped(|v| v + x * Vec3::X);
    let ground = Mesh::merged("gap", &[block(-0.515), block(0.515)]).shape();
    let (every, mut random) = (every(), Rand32::new(14));
    let (mut count, mut aside) = (0, 0);
    for i in 0..2000 {
        let mut within = |low: Real, high: Real| low + (high - low) * random.rand_float();
        let turn = Quat::from_rotation_y(within(-PI, PI));
        let (_, body) = &bodies[i % bodies.len()];
        let reach = body.compute_aabb(&Pose::from_rotation(turn)).maxs.x;
        let place =
            Vec3::new(within(0.0, 0.0244) - reach, 0.6 - within(5e-5, 5e-4), within(-0.2, 0.2));
        let pose = Pose::from_parts(place, turn);
        let found = Question::new(&*ground.0, &*body.0, pose).within(0.02).fresh(&every);
        count += found.len();
        aside += found.iter().filter(|manifold| manifold.local_n1.x < -0.3).count();
    }
    println!("{aside} of {count} aside");
    assert!(count > 1000 && 1000 * aside <= count, "{aside} of {count} aside");
}

/// A block that goes down by a step at x = 0, and its ground alone.
fn step_down(height: Real) -> [Mesh; 2] {
    // All of the outline is seen from the origin.
    let middle = Vec2::new(1.0, 0.5);
    let outline =
        [[2.0, -height], [0.0, -height], [0.0, 0.0], [-2.0, 0.0], [-2.0, -1.0], [2.0, -1.0]];
    let outline = outline.map(|point| Vec2::from(point) + middle);
    let solid = mesh::prism(&outline, 1.0).mapped(|v| v - middle.extend(0.0));
    let sheet = solid.clone().keeping(|[a, b, c]| {
        let is_end = a.z == b.z && b.z == c.z;
        !is_end && [a, b, c].iter().all(|corner| corner.y > -0.75)
    });
    [solid, sheet]
}

/// Bodies at the height of the upper of two floors, less than a prediction distance before the edge
/// between these. Would catch contacts with the foot of the step, or with the back of its riser.
/// Such contacts stop bodies that slide over the edge.
#[test]
fn bodies_before_a_step_down_meet_neither_its_foot_nor_its_riser() {
    let bodies = bodies(Vec3::new(0.25, 0.15, 0.2), ("cone", SharedShape::cone(0.15, 0.25)));
    let (every, mut random, mut count) = (every(), Rand32::new(13), 0);
    for i in 0..400 {
        let mut within = |low: Real, high: Real| low + (high - low) * random.rand_float();
        let height = [within(5e-4, 1e-2), within(0.05, 0.5)][i % 2];
        let (gap, sunk, z) = (within(0.0, 0.009), within(-5e-4, 5e-4), within(-0.3, 0.3));
        let turn = Quat::from_rotation_y(within(-PI, PI));
        for (is_sheet, ground) in step_down(height).map(|ground| ground.shape()).iter().enumerate()
        {
            for (name, body) in &bodies {
                // The foot of a sheet has no side, and meshes may still meet it.
                if is_sheet == 1 && *name == "mesh" {
                    continue;
                }
                let reach = body.compute_aabb(&Pose::from_rotation(turn)).maxs.x;
                let pose = Pose::from_parts(Vec3::new(-gap - reach, 0.15 - sunk, z), turn);
                let found = Question::new(&*ground.0, &*body.0, pose).fresh(&every);
                let least = found.iter().map(|manifold| manifold.local_n1.x).reduce(Real::min);
                assert!(least.is_some_and(|x| x > -0.3), "{name} at {pose:?}, {height}: {least:?}");
                count += found.len();
            }
        }
    }
    assert!(count > 1000, "{count} contacts");
}
