//! Questions to a dispatcher, comparisons, meshes and poses.

use crate::prelude::*;
use rapier_integration::{PreparedTree, SbbkConfig, SurfaceKind};
use rapier3d::parry::query::{ContactManifold, ContactManifoldsWorkspace};
pub use sbbk_testkit::mesh::turned_inside_out;
use sbbk_testkit::scene::random::first_touch;
pub use sbbk_testkit::scene::random::{direction, rotation};

/// Manifolds without data, as hosts other than Rapier may have them.
pub type Manifold = ContactManifold<(), ()>;
/// Indices of a triangle of mesh 1 and one of mesh 2.
pub type TrianglePair = [u32; 2];

/// A question of a host: the contacts of two shapes.
#[derive(Clone, Copy)]
pub struct Question<'a> {
    pub shapes: [&'a dyn Shape; 2],
    /// Pose of the second shape in the frame of the first.
    pub pose: Pose,
    pub prediction: Real,
    /// True if the host passes the second shape first.
    pub is_flipped: bool,
}

impl<'a> Question<'a> {
    pub fn new(shape1: &'a dyn Shape, shape2: &'a dyn Shape, pose: Pose) -> Self {
        Self { shapes: [shape1, shape2], pose, prediction: 0.02, is_flipped: false }
    }

    pub fn at(self, pose: Pose) -> Self {
        Self { pose, ..self }
    }

    pub fn within(self, prediction: Real) -> Self {
        Self { prediction, ..self }
    }

    pub fn flipped(self, is_flipped: bool) -> Self {
        Self { is_flipped, ..self }
    }

    /// The shapes in the order of the host.
    pub fn host_shapes(&self) -> [&'a dyn Shape; 2] {
        self.host_order(self.shapes)
    }

    /// The pose of the host's second shape in the frame of its first.
    pub fn pos12(&self) -> Pose {
        if self.is_flipped { self.pose.inverse() } else { self.pose }
    }

    /// Both shapes, which must be meshes, in the order of the host.
    pub fn meshes(&self) -> [&'a TriMesh; 2] {
        self.host_shapes().map(|shape| shape.as_trimesh().expect("a mesh"))
    }

    /// The last shape that is a mesh.
    pub fn mesh(&self) -> &'a TriMesh {
        self.shapes.iter().rev().find_map(|shape| shape.as_trimesh()).expect("a mesh")
    }

    /// The subshapes of a manifold in the order of [`Self::shapes`].
    pub fn subshapes<M, C>(&self, manifold: &ContactManifold<M, C>) -> TrianglePair {
        self.host_order(triangles(manifold))
    }

    /// The manifolds for a host that keeps nothing of the pair.
    pub fn fresh(&self, dispatcher: &impl PersistentQueryDispatcher) -> Vec<Manifold> {
        std::mem::take(&mut Pair::default().ask(dispatcher, self).manifolds)
    }

    /// Puts what belongs to the shapes into the order of the host, or back.
    pub fn host_order<T>(&self, [one, two]: [T; 2]) -> [T; 2] {
        if self.is_flipped { [two, one] } else { [one, two] }
    }
}

/// Memory of a host about a pair of shapes.
#[derive(Clone)]
pub struct Pair<M = (), C = ()> {
    pub manifolds: Vec<ContactManifold<M, C>>,
    pub workspace: Option<ContactManifoldsWorkspace>,
}

impl<M, C> Default for Pair<M, C> {
    fn default() -> Self {
        Self { manifolds: Vec::new(), workspace: None }
    }
}

impl<M, C> Pair<M, C> {
    /// Asks for the contacts, with what the pair has kept.
    pub fn ask(
        &mut self,
        dispatcher: &impl PersistentQueryDispatcher<M, C>,
        question: &Question,
    ) -> &mut Self {
        let [g1, g2] = question.host_shapes();
        let Self { manifolds, workspace } = self;
        dispatcher
            .contact_manifolds(&question.pos12(), g1, g2, question.prediction, manifolds, workspace)
            .expect("the pair is supported");
        self
    }
}

/// Both sets of contacts, the default one first.
pub const SETS: [ContactSet; 2] = [ContactSet::Surfaces, ContactSet::Triangles];

/// Returns a dispatcher that counts its queries. Otherwise its configuration differs from the
/// default by a change.
pub fn with(change: impl FnOnce(&mut SbbkConfig)) -> SbbkDispatcher {
    let mut config = SbbkConfig::default().with_count_queries(true);
    change(&mut config);
    SbbkDispatcher::new(config)
}

/// A dispatcher with a manifold for every contact: what can be compared triangle by triangle.
pub fn every() -> SbbkDispatcher {
    having(ContactSet::default())
}

/// A dispatcher with every contact of this set.
pub fn having(contact_set: ContactSet) -> SbbkDispatcher {
    with(|config| (config.contact_set, config.detail) = (contact_set, ContactDetail::Every))
}

/// A dispatcher as a user gets it, which counts its queries.
pub fn counting_patches() -> SbbkDispatcher {
    with(|_| ())
}

/// Declares that a mesh is a solid, as long as the result lives.
pub fn declare_solid(dispatcher: &SbbkDispatcher, mesh: &TriMesh) -> PreparedTree {
    let prepared = dispatcher.prepare(mesh).unwrap();
    prepared.set_surface_kind(SurfaceKind::Solid);
    prepared
}

/// A dispatcher with contacts of each two triangles alone, as stock and brute force have them.
pub fn per_triangle() -> SbbkDispatcher {
    having(ContactSet::Triangles)
}

pub fn triangles<M, C>(manifold: &ContactManifold<M, C>) -> TrianglePair {
    [manifold.subshape1, manifold.subshape2]
}

/// The triangle pairs of manifolds in their order.
pub fn sequence<M, C>(manifolds: &[ContactManifold<M, C>]) -> Vec<TrianglePair> {
    manifolds.iter().map(triangles).collect()
}

/// The manifolds by their triangles. Panics when two have the same.
pub fn by_triangles<M, C>(
    manifolds: &[ContactManifold<M, C>],
) -> BTreeMap<TrianglePair, &ContactManifold<M, C>> {
    let map: BTreeMap<_, _> = manifolds.iter().map(|m| (triangles(m), m)).collect();
    assert_eq!(map.len(), manifolds.len(), "two manifolds of one pair of triangles");
    map
}

/// The least signed distance of the points of a manifold.
pub fn distance<M, C>(manifold: &ContactManifold<M, C>) -> Real {
    manifold.points.iter().map(|point| point.dist).fold(Real::INFINITY, Real::min)
}

/// Panics unless both have the same triangle pairs in order, and equal normals and points up to
/// `tolerance` (units, radians).
pub fn assert_same<M1, C1, M2, C2>(
    left: &[ContactManifold<M1, C1>],
    right: &[ContactManifold<M2, C2>],
    tolerance: Real,
) {
    assert_eq!(sequence(left), sequence(right));
    for (left, right) in left.iter().zip(right) {
        let pair = triangles(left);
        let normals = (left.local_n1 - right.local_n1).length();
        assert!(normals <= tolerance, "normals of {pair:?} differ by {normals}");
        assert_eq!(left.points.len(), right.points.len(), "number of points of {pair:?}");
        for (p, q) in left.points.iter().zip(&right.points) {
            let off = [
                (p.dist - q.dist).abs(),
                (p.local_p1 - q.local_p1).length(),
                (p.local_p2 - q.local_p2).length(),
            ];
            assert!(off.iter().all(|&x| x <= tolerance), "points of {pair:?} differ by {off:?}");
        }
    }
}

/// All that a host can see of a manifold; a zero has no sign.
pub fn bits<M, C>(manifold: &ContactManifold<M, C>) -> Vec<u32> {
    let mut bits = triangles(manifold).to_vec();
    let normals = [manifold.local_n1, manifold.local_n2];
    let ends = manifold.points.iter().flat_map(|point| [point.local_p1, point.local_p2]);
    let vectors = normals.into_iter().chain(ends).flat_map(|vector| vector.to_array());
    let numbers = vectors.chain(manifold.points.iter().map(|point| point.dist));
    bits.extend(numbers.map(|number| (number + 0.0).to_bits()));
    for pose in [manifold.subshape_pos1(), manifold.subshape_pos2()].into_iter().flatten() {
        bits.extend(pose.translation.to_array().map(Real::to_bits));
        bits.extend(pose.rotation.to_array().map(Real::to_bits));
    }
    bits.extend(manifold.points.iter().flat_map(|point| [point.fid1.0, point.fid2.0]));
    bits
}

/// Panics unless both answers are equal to the last bit.
pub fn assert_bits<M, C>(
    found: &[ContactManifold<M, C>],
    expected: &[ContactManifold<M, C>],
    context: &str,
) {
    let all = |manifolds: &[ContactManifold<M, C>]| manifolds.iter().map(bits).collect::<Vec<_>>();
    assert!(all(found) == all(expected), "{context}");
}

/// A flat circle of triangles around a hub at the origin.
pub fn fan(count: u32) -> Mesh {
    turned_inside_out(mesh::revolved(&[Vec2::ZERO, Vec2::X], count))
}

/// A cone with its tip at the origin, pointing down.
pub fn cone(count: u32) -> Mesh {
    let mut cone = mesh::revolved(&[Vec2::ZERO, Vec2::new(1.0, 2.0)], count);
    cone.triangles.extend((1..count - 1).map(|i| [1, 2 + i, 1 + i]));
    cone
}

/// Cuts each triangle into four, so many times. Gaps stay as wide, and the triangles get smaller.
pub fn split(mut mesh: Mesh, times: u32) -> Mesh {
    for _ in 0..times {
        let quarters = (0..mesh.triangle_count()).flat_map(|triangle| {
            let [a, b, c] = mesh.corners(triangle);
            let [ab, bc, ca] = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
            [a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca]
        });
        let vertices: Vec<Vec3> = quarters.collect();
        let count = vertices.len() as u32 / 3;
        let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        mesh = Mesh::new("split", vertices, triangles).welded();
    }
    mesh
}

/// Parry's mesh of a mesh of the laboratory.
pub fn shape(mesh: &Mesh) -> TriMesh {
    mesh.trimesh(TriMeshFlags::empty())
}

/// A mesh of equal triangles in other memory, built with these flags.
pub fn rebuilt(mesh: &TriMesh, flags: TriMeshFlags) -> TriMesh {
    TriMesh::with_flags(mesh.vertices().to_vec(), mesh.indices().to_vec(), flags).unwrap()
}

/// Dents that wander over a mesh, from where its vertices are at rest.
pub fn deform(mesh: &mut TriMesh, rest: &[Vec3], frame: usize) {
    let phase = 0.07 * frame as Real;
    mesh.update_vertices(|vertices| {
        for (vertex, &rest) in vertices.iter_mut().zip(rest) {
            let dent = (4.0 * rest.x + phase).sin() * (3.0 * rest.z - 2.0 * phase).cos();
            *vertex = rest * (1.0 + 0.15 * dent);
        }
    });
}

/// A small motion: a shift and a turn, both of at most `size` (units, radians).
pub fn nudge(random: &mut Rand32, size: f32) -> Pose3 {
    let shift = direction(random) * size * random.rand_float();
    let turn = direction(random) * size * random.rand_float();
    Pose3::from_parts(shift, Quat::from_scaled_axis(turn))
}

/// A random pose `depth` beyond the first touch of two meshes, along a line towards the origin.
pub fn touching(random: &mut Rand32, meshes: [&TriMesh; 2], depth: Real) -> Pose {
    let farthest = meshes.iter().map(|mesh| reach(mesh)).sum();
    touching_shapes(random, meshes.map(|mesh| mesh as &dyn Shape), farthest, depth)
}

/// Like [`touching`], for shapes that are apart at a distance of `farthest`.
pub fn touching_shapes(
    random: &mut Rand32,
    [shape1, shape2]: [&dyn Shape; 2],
    farthest: Real,
    depth: Real,
) -> Pose {
    let mut approach = || {
        let (turn, from) = (rotation(random), direction(random));
        let at = |distance: Real| Pose::from_parts(from * distance, turn);
        let meet = |distance: Real| {
            let answer = DefaultQueryDispatcher.intersection_test(&at(distance), shape1, shape2);
            answer.unwrap().intersecting
        };
        // Shape 2 may pass through a hole of shape 1.
        Some(at(first_touch(farthest, 1e-5 * farthest, meet)? - depth))
    };
    (0..100).find_map(|_| approach()).expect("most lines through the origin make the shapes meet")
}

/// Radius of the ball about the origin that holds a mesh.
pub fn reach(mesh: &TriMesh) -> Real {
    mesh.vertices().iter().map(|vertex| vertex.length()).fold(0.0, Real::max)
}
