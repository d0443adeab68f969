use std::collections::BTreeMap;

use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier_integration::SbbkDispatcher;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::details::NormalConstraints;
use rapier3d::parry::query::{DefaultQueryDispatcher, PersistentQueryDispatcher, QueryDispatcher};
use rapier3d::parry::shape::{SharedShape, TriMesh, TriMeshFlags};
use sbbk_lab::mesh;

use crate::support::{Dispatcher, Manifold, Pair, direction, nudge, rotation, shape_with};

/// A convex shape of each kind, about `size` across.
fn shapes(size: Real) -> Vec<(&'static str, SharedShape)> {
    let half = 0.5 * size;
    let [a, b, c] = [Vec3::new(-half, 0.0, 0.1 * size), Vec3::new(half, 0.2 * size, 0.0), Vec3::new(0.0, -0.3 * size, half)];
    let mut random = Rand32::new(77);
    let cloud: Vec<Vec3> = (0..30).map(|_| half * direction(&mut random)).collect();
    let hull = |points: &[Vec3]| SharedShape::convex_hull(points).expect("a cloud has a hull");
    let round_hull = SharedShape::round_convex_hull(&cloud, 0.1 * size).expect("as above");
    vec![
        ("ball", SharedShape::ball(half)),
        ("cuboid", SharedShape::cuboid(half, 0.7 * half, 0.5 * half)),
        ("capsule", SharedShape::capsule_y(half, 0.4 * half)),
        ("skew capsule", SharedShape::capsule(a, b, 0.3 * half)),
        ("segment", SharedShape::segment(a, b)),
        ("triangle", SharedShape::triangle(a, b, c)),
        ("cylinder", SharedShape::cylinder(half, 0.6 * half)),
        ("cone", SharedShape::cone(half, 0.6 * half)),
        ("hull", hull(&cloud)),
        ("round cuboid", SharedShape::round_cuboid(half, 0.7 * half, 0.5 * half, 0.1 * size)),
        ("round triangle", SharedShape::round_triangle(a, b, c, 0.1 * size)),
        ("round cylinder", SharedShape::round_cylinder(half, 0.6 * half, 0.1 * size)),
        ("round cone", SharedShape::round_cone(half, 0.6 * half, 0.1 * size)),
        ("round hull", round_hull),
        ("half-space", SharedShape::halfspace(Vec3::new(0.36, 0.8, -0.48))),
    ]
}

/// A large flat floor, whose box holds the whole mesh as soon as it is turned.
fn floor() -> SharedShape {
    SharedShape::cuboid(50.0, 0.25, 50.0)
}

/// What is asked: the contacts of a mesh and a convex shape.
#[derive(Clone, Copy)]
struct Question<'a> {
    mesh: &'a TriMesh,
    shape: &'a SharedShape,
    /// The pose of the shape in the frame of the mesh.
    pose: Pose,
    prediction: Real,
    /// Whether the shape comes first.
    flipped: bool,
}

impl Question<'_> {
    /// The pose of the second shape in the frame of the first.
    fn pos12(&self) -> Pose {
        if self.flipped { self.pose.inverse() } else { self.pose }
    }

    fn ask<'p, M, C>(
        &self,
        dispatcher: &impl Dispatcher<M, C>,
        pair: &'p mut Pair<M, C>,
    ) -> &'p mut Pair<M, C> {
        let Pair { manifolds, workspace } = &mut *pair;
        let (mesh, shape) = (self.mesh, &*self.shape.0);
        let pos12 = self.pos12();
        let answer = if self.flipped {
            dispatcher.contact_manifolds(&pos12, shape, mesh, self.prediction, manifolds, workspace)
        } else {
            dispatcher.contact_manifolds(&pos12, mesh, shape, self.prediction, manifolds, workspace)
        };
        answer.expect("a mesh and a convex shape are supported");
        pair
    }

    fn fresh(&self, dispatcher: &impl Dispatcher<(), ()>) -> Vec<Manifold> {
        std::mem::take(&mut self.ask(dispatcher, &mut Pair::default()).manifolds)
    }

    fn triangle_of<M, C>(&self, manifold: &rapier3d::parry::query::ContactManifold<M, C>) -> u32 {
        let [mesh, other] = if self.flipped {
            [manifold.subshape2, manifold.subshape1]
        } else {
            [manifold.subshape1, manifold.subshape2]
        };
        assert_eq!(other, 0, "the convex shape has no subshapes");
        mesh
    }

    /// Parry's routine on each triangle of the mesh, called as stock calls it; manifolds with points.
    fn brute_force(&self) -> BTreeMap<u32, Manifold> {
        let all = (0..self.mesh.indices().len() as u32).filter_map(|index| {
            let subshapes = if self.flipped { [0, index] } else { [index, 0] };
            let mut manifold = Manifold::with_data(subshapes[0], subshapes[1], ());
            let triangle = self.mesh.triangle(index);
            let cone = self.mesh.triangle_normal_constraints(index);
            let cone = cone.as_ref().map(|cone| cone as &dyn NormalConstraints);
            let (shape, parry) = (&*self.shape.0, DefaultQueryDispatcher);
            let (pos12, within) = (self.pos12(), self.prediction);
            let answer = if self.flipped {
                let pose = pos12.inverse().inverse();
                parry.contact_manifold_convex_convex(
                    &pose, shape, &triangle, None, cone, within, &mut manifold,
                )
            } else {
                parry.contact_manifold_convex_convex(
                    &pos12, &triangle, shape, cone, None, within, &mut manifold,
                )
            };
            answer.expect("Parry knows contacts of all these shapes with triangles");
            (!manifold.points.is_empty()).then_some((index, manifold))
        });
        all.collect()
    }
}

/// All of a manifold that a user can see. Bits, but a zero has no sign.
fn bits(manifold: &Manifold) -> Vec<u32> {
    let mut bits = Vec::new();
    let mut push = |x: f32| bits.push((x + 0.0).to_bits());
    for normal in [manifold.local_n1, manifold.local_n2] {
        normal.to_array().into_iter().for_each(&mut push);
    }
    for point in &manifold.points {
        for p in [point.local_p1, point.local_p2] {
            p.to_array().into_iter().for_each(&mut push);
        }
        push(point.dist);
    }
    let features = manifold.points.iter().flat_map(|point| [point.fid1.0, point.fid2.0]);
    bits.extend(features.collect::<Vec<_>>());
    bits
}

fn touches(manifold: &Manifold, prediction: Real) -> bool {
    manifold.points.iter().any(|point| point.dist <= prediction)
}

/// Panics unless a fresh answer is that of Parry's routine on all triangles, bit for bit: each manifold of ours is
/// one of brute force, and each of brute force that has a point within the prediction distance is one of ours. The
/// number of contacts.
fn check_fresh(name: &str, dispatcher: &SbbkDispatcher, question: &Question) -> usize {
    let found = question.fresh(dispatcher);
    let all = question.brute_force();
    let by_triangle: BTreeMap<u32, &Manifold> =
        found.iter().map(|manifold| (question.triangle_of(manifold), manifold)).collect();
    assert_eq!(by_triangle.len(), found.len(), "{name}: two manifolds of one triangle");
    for (triangle, manifold) in &by_triangle {
        let expected = all.get(triangle).unwrap_or_else(|| panic!("{name}: {triangle} is invented"));
        assert_eq!(bits(manifold), bits(expected), "{name}: {triangle}");
    }
    let mut count = 0;
    for (triangle, expected) in &all {
        if touches(expected, question.prediction) {
            count += 1;
            assert!(
                by_triangle.contains_key(triangle),
                "{name}: {triangle} is lost, {:?} {}", expected.points, question.prediction
            );
        }
    }
    count
}

/// Poses at which a shape touches a mesh: on the surface, just apart, and inside, at random.
fn pose(random: &mut Rand32, mesh: &TriMesh, size: Real) -> Pose3 {
    let triangle = mesh.triangle(random.rand_range(0..mesh.indices().len() as u32));
    let turn = rotation(random);
    let away = direction(random) * (0.5 + 0.2 * random.rand_float()) * size;
    Pose3::from_parts(triangle.center() + away, turn)
}

#[test]
fn fresh_contacts_are_those_of_parrys_routine_on_all_triangles() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(1);
    let head = shape_with(&mesh::monkey_head(), TriMeshFlags::empty());
    let constrained = shape_with(&mesh::monkey_head(), TriMeshFlags::FIX_INTERNAL_EDGES);
    for size in [0.1, 0.6, 3.0] {
        for (name, shape) in shapes(size) {
            let mut count = 0;
            for (i, prediction) in [0.0, 0.002, 0.02, 0.2].into_iter().cycle().take(16).enumerate() {
                let mesh = if i % 8 < 4 { &head } else { &constrained };
                let pose = pose(&mut random, mesh, size);
                for flipped in [false, true] {
                    let question = Question { mesh, shape: &shape, pose, prediction, flipped };
                    count += check_fresh(name, &dispatcher, &question);
                }
            }
            println!("{name} {size}: {count}");
            assert!(count > 10, "{name} of {size}: {count} contacts");
        }
    }
}
