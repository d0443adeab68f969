use crate::prelude::*;
use rapier3d::geometry::{ColliderHandle, ContactManifold};

/// A ring of 576 triangles.
pub fn torus() -> TriMesh {
    shape(&mesh::torus(1.0, 0.4, 24, 12))
}

/// A pose at which two such rings overlap.
pub fn beside() -> Pose {
    Pose::from_parts(Vector::new(1.5, 0.4, 0.2), glamx::Quat::from_rotation_x(1.0))
}

/// Panics unless a pair has the contacts of an edited mesh, which stays at its address.
///
/// Would catch a tree, candidates, contact points or normal constraints of the mesh before the
/// edit.
fn check_edit(set: ContactSet, flags: TriMeshFlags, edit: impl Fn(&mut TriMesh)) {
    let other = torus();
    let dispatcher = having(set);
    let mut edited = mesh::torus(1.0, 0.4, 24, 12).shape_with(flags);
    let mut pair: Pair = Pair::default();
    let ask = |pair: &mut Pair, shape: &SharedShape| {
        let query = Question::new(shape.as_trimesh().unwrap(), &other, beside());
        // Twice at nearly the same place, so that candidates are kept.
        for shift in [0.0, 1e-5, 0.0] {
            pair.ask(&dispatcher, &query.at(Pose::translation(shift, 0.0, 0.0) * beside()));
        }
        (pair.manifolds.clone(), query.fresh(&having(set)))
    };
    let (before, _) = ask(&mut pair, &edited);
    assert!(!before.is_empty());
    let address = edited.as_trimesh().unwrap().vertices().as_ptr();
    edit(edited.make_mut().as_trimesh_mut().expect("the shape is a mesh"));
    assert_eq!(edited.as_trimesh().unwrap().vertices().as_ptr(), address);
    let (found, expected) = ask(&mut pair, &edited);
    let contact = |m: &Manifold| (triangles(m), m.local_n1, distance(m));
    assert!(before.iter().map(contact).ne(expected.iter().map(contact)), "nothing has changed");
    assert_same(&found, &expected, 1e-5);
}

/// Would catch a mesh known by its address, by rounded numbers, or by its vertices alone.
#[test]
fn edits_in_place_are_seen() {
    let plain = TriMeshFlags::empty();
    check_edit(ContactSet::Surfaces, plain, |mesh| {
        mesh.transform_vertices(&Pose::translation(0.004, 0.0, 0.0))
    });
    check_edit(ContactSet::Surfaces, plain, |mesh| {
        mesh.update_vertices(|vertices| vertices.iter_mut().for_each(|vertex| *vertex *= 1.02));
    });
    // Contacts of surfaces do not depend on the winding.
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
    check_edit(ContactSet::Triangles, flags, TriMesh::reverse);
}

/// Would catch a mesh known by its address, which a new mesh of the same size may get.
#[test]
fn a_freed_address_does_not_stand_for_the_freed_mesh() {
    // Allocators reuse the place of small blocks more often.
    let lab_mesh = mesh::torus(1.0, 0.4, 8, 5);
    let other = shape(&lab_mesh);
    let mut reused = 0;
    for attempt in 0..100 {
        let dispatcher = SbbkDispatcher::default();
        let ring = shape(&lab_mesh);
        let mut pair: Pair = Pair::default();
        pair.ask(&dispatcher, &Question::new(&ring, &other, beside()));
        let addresses = |mesh: &TriMesh| (mesh.vertices().as_ptr(), mesh.indices().as_ptr());
        let old = addresses(&ring);
        // Another shape with equal counts of vertices and triangles.
        let stretched = lab_mesh.clone().mapped(|v| v * Vector::new(1.0, 1.2, 1.0));
        drop(ring);
        let ellipse = shape(&stretched);
        reused += usize::from(addresses(&ellipse) == old);
        let query = Question::new(&ellipse, &other, beside());
        let expected = query.fresh(&SbbkDispatcher::default());
        assert!(!expected.is_empty());
        assert_same(&pair.ask(&dispatcher, &query).manifolds, &expected, 1e-5);
        assert_same(&query.fresh(&dispatcher), &expected, 0.0);
        if reused == 3 {
            return;
        }
        assert!(attempt < 99, "no address was used again: nothing was tested");
    }
}

/// Two toruses that overlap, in a world without gravity.
struct Overlap {
    world: PhysicsWorld,
    colliders: [ColliderHandle; 2],
}

impl Overlap {
    fn new() -> Self {
        let mut world = world_of([], SbbkDispatcher::default());
        world.gravity = Vector::ZERO;
        let collider = || ColliderBuilder::new(SharedShape::new(torus()));
        let (_, one) = world.insert(RigidBodyBuilder::fixed(), collider());
        let (_, two) = world.insert(RigidBodyBuilder::dynamic().pose(beside()), collider());
        Self { world, colliders: [one, two] }
    }

    /// Manifolds of Rapier's next step, and of a new dispatcher.
    fn step(&mut self) -> (Vec<ContactManifold>, Vec<Manifold>) {
        let [one, two] = self.colliders.map(|handle| self.world.colliders[handle].clone());
        self.world.step();
        let pair = self.world.contact_pair(self.colliders[0], self.colliders[1]).unwrap();
        let is_swapped = pair.collider1 == self.colliders[1];
        let [one, two] = if is_swapped { [two, one] } else { [one, two] };
        let [mesh1, mesh2] = [&one, &two].map(|collider| collider.shape().as_trimesh().unwrap());
        let query = Question::new(mesh1, mesh2, one.position().inv_mul(two.position()));
        (pair.manifolds().to_vec(), query.fresh(&SbbkDispatcher::default()))
    }

    fn fixed(&self) -> &TriMesh {
        self.world.colliders[self.colliders[0]].shape().as_trimesh().expect("a torus")
    }

    /// A vertex of a touching triangle of the fixed torus.
    fn touching_vertex(&self, manifolds: &[ContactManifold]) -> usize {
        let pair = self.world.contact_pair(self.colliders[0], self.colliders[1]).unwrap();
        let side = usize::from(pair.collider1 != self.colliders[0]);
        let triangle = triangles(&manifolds[0])[side];
        self.fixed().indices()[triangle as usize][0] as usize
    }
}

/// Lets Rapier meet the pair, moves one vertex inwards, and checks the next step. Would catch an
/// old tree or old contacts, whether the collider edits its mesh or gets another shape.
#[test]
fn a_vertex_that_moved_between_steps_is_seen() {
    for is_in_place in [true, false] {
        let mut overlap = Overlap::new();
        let (found, expected) = overlap.step();
        assert!(!found.is_empty());
        assert_same(&found, &expected, 0.0);
        let vertex = overlap.touching_vertex(&found);
        let unedited = overlap.fixed().clone();
        let dent = |mesh: &mut TriMesh| mesh.update_vertices(|vertices| vertices[vertex] *= 0.97);
        let collider = &mut overlap.world.colliders[overlap.colliders[0]];
        if is_in_place {
            dent(collider.shape_mut().as_trimesh_mut().unwrap());
        } else {
            let mut mesh = unedited.clone();
            dent(&mut mesh);
            collider.set_shape(SharedShape::new(mesh));
        }
        let edited = overlap.fixed();
        let moved = |i: &usize| unedited.vertices()[*i] != edited.vertices()[*i];
        assert_eq!((0..unedited.vertices().len()).filter(moved).collect::<Vec<_>>(), [vertex]);
        assert_eq!(unedited.local_aabb(), edited.local_aabb());
        let (found, expected) = overlap.step();
        assert_same(&found, &expected, 1e-6);
        let touched = |m: &ContactManifold| triangles(m).map(|t| unedited.indices()[t as usize]);
        assert!(found.iter().any(|m| touched(m).iter().any(|t| t.contains(&(vertex as u32)))));
    }
}
