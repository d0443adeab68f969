//! Bodies that start in each other or in the ground, and cubes on sheets without an inside.

use super::kit::*;

/// Bodies that are released in each other.
pub(super) fn overlaps() -> Vec<Trial> {
    let ball = Form { mesh: mesh::ball(0.5, 8), control: Some(SharedShape::ball(0.5)) };
    let head = Form::mesh(mesh::monkey_head().centred().scaled_to(1.0));
    let balls = Trial::new("eight balls in each other", move |kit| overlap(kit, &ball));
    let heads = Trial::new("eight heads in each other", move |kit| overlap(kit, &head));
    vec![balls, heads.without_control()]
}

/// Bodies of a unit, their centres in a cube of a unit.
fn overlap(kit: &Kit, form: &Form) -> Figures {
    const BODIES: usize = 8;
    /// Pairs that are no deeper in each other only touch.
    const APART: f32 = 0.01;
    let (mut world, mut random) = (kit.world(), seeded());
    world.gravity = Vec3::ZERO;
    let collider = kit.collider(form);
    for _ in 0..BODIES {
        let place = Vec3::from_array([(); 3].map(|()| random.rand_float() - 0.5));
        world.put(Pose3::from_parts(place, random::rotation(&mut random)), &collider);
    }
    let fastest = world.fastest(120);
    let depths = Depths::new(&form.mesh);
    let pose = |body: usize| world.bodies[world.watched[body]].position();
    let pairs = (1..BODIES).flat_map(|j| (0..j).map(move |i| [i, j]));
    let found = pairs.map(|[i, j]| depths.between(pose(i), &depths, pose(j)));
    let found: Vec<f32> = found.collect();
    let apart = found.iter().filter(|&&depth| depth <= APART).count();
    Figures::default()
        .none("pairs not apart", found.len() - apart)
        .at_most("speed", fastest, 5.0)
        .note("deepest", largest(found))
}

/// Boxes that start in a slab, or in the ground.
pub(super) fn sunk() -> Vec<Trial> {
    let trials = [1, 8].into_iter().flat_map(|cells| {
        let triangles = 12 * cells * cells;
        let slab = |thickness: f32| {
            let name = format!("boxes in a slab of {thickness}, {triangles} triangles each");
            Trial::new(name, move |kit| {
                let slab = Form::cuboid(Vec3::new(5.0, 0.5 * thickness, 5.0), cells);
                let slab = kit.collider(&slab).translation(-0.5 * thickness * Vec3::Y);
                sink(kit, slab, thickness, cells)
            })
        };
        let name = format!("boxes in a height field, {triangles} triangles each");
        let field = Trial::new(name, move |kit| {
            let field = kit.flat_field([10 * cells; 2], Vec3::splat(10.0));
            sink(kit, field, f32::INFINITY, cells)
        });
        [slab(2.0), slab(0.8), field.without_control()]
    });
    trials.collect()
}

/// Ten boxes of a unit, their lowest points 0.1 to 1.2 units below the upper side of a ground of so
/// much thickness, which is at height 0.
fn sink(kit: &Kit, ground: ColliderBuilder, thickness: f32, cells: u32) -> Figures {
    /// Difference of the ways up and down, in units, below which either is right.
    const DOUBT: f32 = 0.25;
    let cube = kit.collider(&Form::cuboid(Vec3::splat(0.5), cells));
    // Bodies wholly below the ground are left alone, as in a cave.
    let most: f32 = if thickness.is_finite() { 1.2 } else { 0.9 };
    let (mut inside, mut wrong_side, mut fastest) = (0, 0, 0.0_f32);
    for index in 0..10 {
        let depth = 0.1 + (most - 0.1) * index as f32 / 9.0;
        let mut world = kit.world_with(Some(&ground));
        world.fix(Vec3::ZERO, ground.clone());
        let body = world.put(Pose3::from_translation(Vec3::Y * (0.5 - depth)), &cube);
        // One that has left below may fall as fast as it likes.
        let (mut left_below, mut lowest_speed) = (false, 0.0);
        for _ in 0..180 {
            world.step();
            left_below |= world.bodies[body].translation().y < -thickness - 0.45;
            if !left_below {
                lowest_speed = largest([lowest_speed, world.top_speed()]);
            }
        }
        fastest = largest([fastest, lowest_speed]);
        let is_above = world.bodies[body].translation().y > 0.45;
        // Down it is the slab's thickness and the box, less the way up.
        let shorter_down = depth - (thickness + 1.0 - depth);
        inside += usize::from(!is_above && !left_below);
        wrong_side += usize::from(
            (is_above && shorter_down > DOUBT) || (left_below && shorter_down < -DOUBT),
        );
    }
    Figures::default()
        .none("stay", inside)
        .none("on the far side", wrong_side)
        .at_most("speed", fastest, 5.0)
}

/// Cubes that fall slowly on sheets: one layer of triangles, which has no inside.
pub(super) fn sheets() -> Vec<Trial> {
    let trials = [(false, "flat"), (true, "bent")].into_iter().flat_map(|(is_bent, bent)| {
        [(false, "front"), (true, "back")].map(|(from_behind, side)| {
            let name = format!("64 cubes on the {side} of a {bent} sheet");
            let run = move |kit: &Kit| cubes_on_sheet(kit, is_bent, from_behind);
            Trial::new(name, run).without_control()
        })
    });
    trials.collect()
}

fn cubes_on_sheet(kit: &Kit, is_bent: bool, from_behind: bool) -> Figures {
    /// Cubes along a side of the square in which they start, and the half of their side.
    const ROW: usize = 8;
    const HALF: f32 = 0.3;
    /// Side of a sheet, and cells along it.
    const SIZE: f32 = 20.0;
    const CELLS: u32 = 40;
    let height = |place: Vec3| {
        let height = mesh::hill_height(SIZE, place.x, place.z);
        if is_bent { height } else { 0.0 }
    };
    let sheet = if is_bent { mesh::hills(SIZE, CELLS) } else { mesh::floor(SIZE, CELLS) };
    let sheet = if from_behind { mesh::turned_inside_out(sheet) } else { sheet };
    let (mut world, mut random) = (kit.world(), seeded());
    world.fix(Vec3::ZERO, kit.mesh(&sheet));
    let cube = kit.collider(&Form::cuboid(Vec3::splat(HALF), 2));
    for index in 0..ROW * ROW {
        let [x, z] = [index % ROW, index / ROW].map(|k| 1.6 * (k as f32 - 3.5));
        let place = Vec3::new(x, 0.0, z);
        // A cube's corners are no farther from its middle. It lands at 2 units a second or less.
        let up = height(place) + 1.75 * HALF + 0.2;
        let turn = random::rotation(&mut random);
        let body = RigidBodyBuilder::dynamic().translation(place.with_y(up));
        world.add(body.rotation(turn.to_scaled_axis()), &cube);
    }
    world.run(240);
    let below = world.places().into_iter().map(|place| height(place) - place.y);
    let kept = below.clone().filter(|&below| below <= 0.0).count();
    Figures::default().none("passed", ROW * ROW - kept).note("lowest", -largest(below))
}
