use super::moving::walled;
use crate::prelude::*;

/// A shape that lies on a floor, turned by `turn`, with its middle at `height`.
struct Slider {
    name: &'static str,
    shape: SharedShape,
    turn: Quat,
    height: Real,
    spin_of_speed: Vec3,
    friction: Real,
}

fn sliders() -> Vec<Slider> {
    let slider = |name, shape, height| Slider {
        name,
        shape,
        turn: Quat::IDENTITY,
        height,
        spin_of_speed: Vec3::ZERO,
        friction: 0.0,
    };
    let wheel = slider("wheel", SharedShape::cylinder(0.15, 0.43), 0.43);
    let turn = Quat::from_rotation_x(FRAC_PI_2);
    vec![
        Slider { turn, spin_of_speed: -Vec3::Z / 0.43, friction: 1.0, ..wheel },
        slider("puck", SharedShape::cylinder(0.1, 0.5), 0.1),
        slider("cone", SharedShape::cone(0.3, 0.5), 0.3),
        slider("round puck", SharedShape::round_cylinder(0.1, 0.4, 0.05), 0.15),
    ]
}

impl Slider {
    /// Returns the place of the body at the end, and how far it came along the x axis.
    fn slide(&self, steps: usize, ground: TriMesh, start: Vec3, speed: Real) -> (Vec3, Real) {
        let ground = ColliderBuilder::new(SharedShape::new(ground)).friction(self.friction);
        let world = world_of([ground], SbbkDispatcher::default());
        let body = RigidBodyBuilder::dynamic()
            .translation(start + self.height * Vec3::Y)
            .rotation(self.turn.to_scaled_axis())
            .linvel(speed * Vec3::X)
            .angvel(speed * self.spin_of_speed)
            .ccd_enabled(true);
        let collider = ColliderBuilder::new(self.shape.clone()).friction(self.friction);
        let mut farthest = start.x;
        let look = |body: &RigidBody| farthest = farthest.max(body.translation().x);
        (watched(steps, world, body, collider, look).translation(), farthest)
    }
}

/// Would catch impacts with the floor that a shape stands on, which end steps early.
#[test]
fn shapes_that_slide_over_a_mesh_make_all_of_their_way() {
    for cells in [20, 200] {
        for slider in sliders() {
            let ground = shape(&mesh::floor(60.0, cells));
            let start = Vec3::new(-12.0, 0.0, 0.13);
            let (end, _) = slider.slide(60, ground, start, 20.0);
            let (name, share) = (slider.name, (end.x - start.x) / 20.0);
            assert!((0.99..1.01).contains(&share), "{name}, {cells} cells: {share}");
            assert!((end.y - slider.height).abs() < 0.02, "{name}, {cells} cells: {end}");
        }
    }
}

/// Would catch an impact that is lost, as the shape is in contact with the floor at the start.
#[test]
fn fast_shapes_on_a_floor_stop_at_a_wall() {
    for slider in sliders() {
        for speed in [20.0, 60.0, 200.0] {
            for phase in 0..4 {
                let start = Vec3::new(-0.7 * phase as Real - 2.0, 0.0, 0.13);
                let (_, farthest) = slider.slide(40, walled(60.0, 60, 8.0), start, speed);
                assert!(farthest < 8.0, "{} at {speed}, {phase}: {farthest}", slider.name);
            }
        }
    }
}

/// Would catch a lost impact with the wall, and an impact with the floor. At the end of a step a
/// shape may sink in by a tenth of its thickness.
#[test]
fn casts_along_a_floor_meet_the_wall() {
    let (dispatcher, mesh) = (SbbkDispatcher::default(), walled(60.0, 60, 8.0));
    let random = &mut Rand32::new(7);
    let still = NonlinearRigidMotion::constant_position(Pose::IDENTITY);
    let mut hits = 0;
    for slider in sliders() {
        for _ in 0..60 {
            let speed = 5.0 + 200.0 * random.rand_float();
            let end = 1.0 / 60.0;
            let height = slider.height + 0.01 * (random.rand_float() - 0.7);
            let wide = slider.shape.compute_aabb(&Pose::from_rotation(slider.turn)).maxs.x;
            // Its place at the end, before or behind the wall.
            let beyond = 1.5 * speed * end * (random.rand_float() - 0.4);
            let start = Vec3::new(8.0 - wide + beyond - speed * end, height, 0.13);
            let velocity = speed * Vec3::X;
            let start = Pose::from_parts(start, slider.turn);
            let spin = speed * slider.spin_of_speed;
            let moving = NonlinearRigidMotion::new(start, Vec3::ZERO, velocity, spin);
            let found = dispatcher
                .cast_shapes_nonlinear(&moving, &*slider.shape, &still, &mesh, 0.0, end, false)
                .unwrap();
            let says = format!("{} at {speed}, {beyond} beyond: {found:?}", slider.name);
            let met = end - beyond / speed;
            if let Some(hit) = found {
                assert!((hit.time_of_impact - met).abs() < 2.0e-5, "{says}, {met}");
                hits += 1;
            } else {
                let sunk = 0.1 * slider.shape.ccd_thickness() + 0.01;
                assert!(beyond < sunk || beyond > speed * end, "{says}, {met}");
            }
        }
    }
    assert!(hits > 60, "{hits}");
}

/// Fast bodies roll or slide over a floor of fine triangles that is [`TriMeshFlags::ORIENTED`].
/// Rapier sweeps these shapes itself. Would catch contacts that stop them, or let them sink so far
/// that the sweep stops them.
#[test]
fn fast_bodies_keep_their_way_over_oriented_floors() {
    const RADIUS: Real = 0.3;
    const SPEED: Real = 9.0;
    let rolling = (-Vec3::Z / RADIUS, 0.7);
    let shapes = [
        ("ball", SharedShape::ball(RADIUS), rolling),
        ("capsule", SharedShape::capsule_z(0.5, RADIUS), rolling),
        ("cuboid", SharedShape::cuboid(RADIUS, RADIUS, RADIUS), (Vec3::ZERO, 0.0)),
    ];
    let start = Vec3::new(-6.03, 0.0, 0.07);
    for cells in [40, 200] {
        for (name, shape, (spin_of_speed, friction)) in shapes.clone() {
            let (turn, height) = (Quat::IDENTITY, RADIUS);
            let slider = Slider { name, shape, turn, height, spin_of_speed, friction };
            let floor = mesh::floor(20.0, cells).trimesh(TriMeshFlags::ORIENTED);
            let (end, _) = slider.slide(60, floor, start, SPEED);
            let way = end.x - start.x;
            assert!((way - SPEED).abs() < 0.01 * SPEED, "{name}: {way} over {cells} cells");
        }
    }
}
