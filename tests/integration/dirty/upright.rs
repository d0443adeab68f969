use super::*;

const POSES: usize = 200;
/// Draws a pose.
type Draw = fn(&mut Rand32) -> Pose;

/// A triangle of 3 by 2 in the plane `z = 0`, about the origin.
fn triangle() -> Mesh {
    let corners = [(-1.0, -1.0), (2.0, -1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0));
    Mesh::new("triangle", corners.to_vec(), vec![[0, 1, 2]])
}

/// Along the edges of the grid: quarter turns, any height that crosses, corners on the lattice or
/// not.
fn along_lines(random: &mut Rand32, is_on_corners: bool) -> Pose {
    let mut quarters = |turn: fn(f32) -> Quat| turn(FRAC_PI_2 * random.rand_range(0..4) as f32);
    let turn = quarters(Quat::from_rotation_y) * quarters(Quat::from_rotation_z);
    let mut place = [(); 2].map(|()| random.rand_range(0..5) as f32 - 2.0);
    if !is_on_corners {
        let along = usize::from((turn * Vec3::Z).x.abs() > 0.5);
        place[along] += random.rand_float();
    }
    let height = 0.9 * (2.0 * random.rand_float() - 1.0);
    Pose3::from_parts(Vec3::new(place[0], height, place[1]), turn)
}

/// Upright, turned about the vertical by chance.
fn upright(random: &mut Rand32) -> Pose {
    let turn = Quat::from_rotation_y(7.0 * random.rand_float());
    Pose3::from_parts(along_lines(random, false).translation, turn)
}

fn anyhow(random: &mut Rand32) -> Pose {
    Pose3::from_parts(along_lines(random, false).translation, rotation(random))
}

/// The poses at which the sheets cross and have no contact.
fn lost(floor: &TriMesh, sheet: &TriMesh, pose: impl Fn(&mut Rand32) -> Pose) -> [usize; 2] {
    let mut random = Rand32::new(5);
    let (mut crossing, mut lost) = (0, 0);
    for _ in 0..POSES {
        let pose = pose(&mut random);
        let answer = DefaultQueryDispatcher.intersection_test(&pose, floor, sheet).unwrap();
        if !answer.intersecting {
            continue;
        }
        crossing += 1;
        for is_flipped in [false, true] {
            let query = Question::new(floor, sheet, pose).flipped(is_flipped);
            let found = query.fresh(&SbbkDispatcher::default());
            lost += usize::from(found.iter().all(|manifold| manifold.points.is_empty()));
        }
    }
    [lost, crossing]
}

/// Would catch sheets that cross along edges and have no contact at all.
#[test]
fn sheets_that_cross_along_grid_lines_have_contacts() {
    let plain = mesh::floor(12.0, 12);
    let floors = [
        ("plain", plain.clone()),
        ("turned", mesh::turned_inside_out(plain.clone())),
        ("two-sided", mesh::two_sided(&plain)),
        ("random winding", mesh::random_winding(&plain, 4)),
        ("soup", mesh::unwelded(&plain, 0.0, 1)),
        ("each third twice", mesh::doubled(&plain, 3)),
    ];
    let poses: [(&str, Draw); 4] = [
        ("on corners", |random| along_lines(random, true)),
        ("along lines", |random| along_lines(random, false)),
        ("upright", upright),
        ("any", anyhow),
    ];
    let mut cases = Vec::new();
    for (flags, (name, floor)) in with_flags(&floors) {
        let [floor, sheet] = [floor, &triangle()].map(|mesh| mesh.trimesh(flags));
        for (column, pose) in poses {
            let [lost, crossing] = lost(&floor, &sheet, pose);
            assert!(crossing > POSES / 4, "{crossing} of {name}, {column} cross");
            let shown = format!("{lost} of {}", 2 * crossing);
            cases.push(Case::new(name, flags, column, shown, lost == 0));
        }
    }
    judge("an upright triangle crosses a floor: queries without contacts", &cases, &[]);
}
