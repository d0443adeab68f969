use crate::prelude::*;
use crate::truth::{normalized, of_meshes};
use sbbk_truth::TruthPair;

/// Two meshes on their ways, until the time of one unit.
struct Cast<'a> {
    meshes: [&'a TriMesh; 2],
    motions: [NonlinearRigidMotion; 2],
}

impl Cast<'_> {
    fn ask(&self, dispatcher: &dyn QueryDispatcher) -> Option<ShapeCastHit> {
        let ([mesh1, mesh2], [motion1, motion2]) = (self.meshes, &self.motions);
        let hit = dispatcher.cast_shapes_nonlinear(motion1, mesh1, motion2, mesh2, 0.0, 1.0, false);
        hit.expect("two meshes are supported")
    }

    fn pos12(&self, time: f32) -> Pose3 {
        let [pos1, pos2] = self.motions.each_ref().map(|motion| motion.position_at_time(time));
        pos1.inv_mul(&pos2)
    }

    /// All pairs of triangles up to a distance, by brute force in f64.
    fn truth(&self, time: f32, distance: f32) -> Vec<TruthPair> {
        of_meshes(self.meshes, normalized(&self.pos12(time)), f64::from(distance))
    }

    /// Speed at which a touching pair approaches, at the middle of its first triangle, and the
    /// error of that.
    fn approach(&self, pair: &TruthPair) -> (f32, f32) {
        let [motion1, motion2] = &self.motions;
        let triangles = [0, 1].map(|i| self.meshes[i].triangle(pair.triangles[i]));
        let start1 = motion1.position_at_time(0.0);
        let point = start1 * triangles[0].center();
        let velocity = |motion: &NonlinearRigidMotion| {
            let centre = motion.start * motion.local_center;
            motion.linvel + motion.angvel.cross(point - centre)
        };
        let normal = start1.rotation * pair.normal.as_vec3();
        let sizes = triangles.map(|t| t.local_aabb().extents().length());
        let spin = (motion2.angvel - motion1.angvel).length();
        let speed = -(velocity(motion2) - velocity(motion1)).dot(normal);
        (speed, spin * (sizes[0] + sizes[1]) + 1e-3)
    }

    /// True if a pair approaches at the start, with the pairs that touch then. `None` if rounding
    /// decides.
    fn start(&self, slack: f32) -> Option<(bool, Vec<[u32; 2]>)> {
        let near = self.truth(0.0, 10.0 * slack);
        let is_touching = |pair: &TruthPair| pair.distance < f64::from(0.01 * slack);
        let clear = |pair: &TruthPair| {
            let (speed, doubt) = self.approach(pair);
            pair.normal_is_unique && speed.abs() > doubt
        };
        let approaches = |pair: &TruthPair| self.approach(pair).0 > 0.0;
        let is_sure = |pair: &TruthPair| is_touching(pair) && clear(pair);
        let names = near.iter().map(|pair| pair.triangles).collect();
        if near.iter().any(|pair| is_sure(pair) && approaches(pair)) {
            return Some((true, names));
        }
        near.iter().all(is_sure).then_some((false, names))
    }
}

/// Triangles here and there about the origin: meshes that can leave each other.
fn scattered(random: &mut Rand32, count: u32) -> TriMesh {
    let mut corners = Vec::new();
    for _ in 0..count {
        let middle = 0.6 * direction(random);
        corners.extend([(); 3].map(|()| middle + 0.5 * direction(random)));
    }
    TriMesh::new(corners, (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect()).unwrap()
}

fn motion(random: &mut Rand32, start: Pose3, spin: f32) -> NonlinearRigidMotion {
    let [centre, velocity, spin] = [0.2, 1.5, spin].map(|size| size * direction(random));
    NonlinearRigidMotion::new(start, centre, velocity, spin)
}

/// Would catch velocities of the wrong point, frame or sign, and forgotten pairs. Pairs that touch
/// at the start stop a cast only if they approach.
#[test]
fn casts_from_contact_are_true() {
    let dispatcher = SbbkDispatcher::default();
    let (mut at_start, mut later, mut never, mut unclear) = (0, 0, 0, 0);
    for seed in 0..400 {
        let random = &mut Rand32::new(seed);
        let size = [0.01, 1.0, 100.0][seed as usize % 3];
        let scaled = |mesh: TriMesh| mesh.scaled(Vec3::splat(size));
        let meshes = [5, 4].map(|count| scaled(scattered(random, count)));
        let start = Pose3::from_parts(0.5 * direction(random), rotation(random));
        let mut motions = [Pose3::from_parts(Vec3::ONE, rotation(random)), start];
        motions[1] = motions[0] * motions[1];
        let motions = motions.map(|start| {
            let mut motion = motion(random, start, 0.2);
            motion.start.translation *= size;
            motion.local_center *= size;
            motion.linvel *= size;
            motion
        });
        let cast = Cast { meshes: meshes.each_ref(), motions };
        let slack = 1e-5 * meshes.iter().map(reach).sum::<f32>();
        let Some((approaches, touching)) = cast.start(slack) else {
            unclear += 1;
            continue;
        };
        let hit = cast.ask(&dispatcher);
        if approaches {
            let hit = hit.expect("a pair approaches");
            assert_eq!((hit.time_of_impact, hit.status), (0.0, ShapeCastStatus::Converged));
            assert!(touching.contains(&[hit.subshape1, hit.subshape2]));
            at_start += 1;
            continue;
        }
        let others = |time: f32, distance: f32| -> Vec<TruthPair> {
            let is_other = |pair: &TruthPair| !touching.contains(&pair.triangles);
            cast.truth(time, distance).into_iter().filter(is_other).collect()
        };
        let end = hit.map_or(1.0, |hit| hit.time_of_impact);
        for step in 0..50 {
            let met = others(end * step as f32 / 50.0, 0.0);
            assert!(met.is_empty(), "case {seed}: {met:?} before {hit:?}");
        }
        let Some(hit) = hit else {
            never += 1;
            continue;
        };
        assert_eq!(hit.status, ShapeCastStatus::Converged);
        let found = [hit.subshape1, hit.subshape2];
        let near = others(end, slack);
        assert!(near.iter().any(|pair| pair.triangles == found), "case {seed}");
        assert!((cast.pos12(end) * hit.witness2 - hit.witness1).length() < 2.0 * slack);
        later += usize::from(!touching.is_empty());
    }
    assert!(at_start > 60 && later > 20 && never > 10, "{at_start} {later} {never}");
    assert!(unclear < 160, "{unclear} unclear");
}

/// Beside stock where stock is right: triangles of about a unit. Would catch a meaning of our own.
#[test]
fn casts_from_contact_are_like_stock() {
    let dispatcher = SbbkDispatcher::default();
    let (mut same, mut both, mut count) = (0, 0, 0);
    for seed in 0..300 {
        let random = &mut Rand32::new(1000 + seed);
        let meshes = [7, 5].map(|count| scattered(random, count));
        let starts = [(); 2].map(|()| Pose3::from_parts(0.3 * direction(random), rotation(random)));
        let motions = starts.map(|start| motion(random, start, 1.0));
        let cast = Cast { meshes: meshes.each_ref(), motions };
        if cast.truth(0.0, 0.0).is_empty() {
            continue;
        }
        let [ours, stock] = [&dispatcher as &dyn QueryDispatcher, &DefaultQueryDispatcher]
            .map(|dispatcher| cast.ask(dispatcher).map(|hit| hit.time_of_impact));
        count += 1;
        both += usize::from(ours.is_some() && stock.is_some());
        same += usize::from(match (ours, stock) {
            (Some(ours), Some(stock)) => (ours - stock).abs() < 1e-3,
            (ours, stock) => ours == stock,
        });
    }
    // The rest is up to EPA's normals.
    assert!(count > 100 && both > 50 && 10 * same >= 9 * count, "{same} of {count}, {both} hit");
}

/// Balls that spin pass each other at a small distance. Would catch steps that a spin shortens, and
/// that are used up.
#[test]
fn balls_that_spin_pass_each_other() {
    let dispatcher = SbbkDispatcher::default();
    let ball = mesh::ball(0.5, 12).shape();
    for (height, spin) in [(1.001, 1.0e3), (1.001, 1.0e6), (5.0, 1.0e6), (0.9, 1.0e3)] {
        let start =
            [0.0, 3.0].map(|x| Pose3::translation(x, if x == 0.0 { 0.0 } else { height }, 0.0));
        let velocities = [Vec3::ZERO, Vec3::new(-6.0, 0.0, 0.0)];
        let motions = [0, 1].map(|i| {
            NonlinearRigidMotion::new(start[i], Vec3::ZERO, velocities[i], spin * Vec3::Y)
        });
        let meshes = [ball.as_trimesh().unwrap(); 2];
        let hit = Cast { meshes, motions }.ask(&dispatcher);
        assert_eq!(hit.is_some(), height < 1.0, "{height} {spin}: {hit:?}");
    }
}
