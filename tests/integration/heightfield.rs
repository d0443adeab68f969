//! The same terrain is always at hand as a mesh: what brute force and the pair of meshes say of it is expected of the field.

use allocation_counter::measure;
use glamx::{Quat, Vec3};
use oorandom::Rand32;
use rapier_integration::{SbbkConfig, SbbkDispatcher, TriangleContacts};
use rapier3d::geometry::{ContactData, ContactManifoldData};
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::DefaultQueryDispatcher;
use rapier3d::parry::query::details::NormalConstraints;
use rapier3d::parry::shape::{
    HeightField, HeightFieldCellStatus, HeightFieldFlags, SharedShape, TriMesh, TriMeshFlags,
};
use rapier3d::parry::utils::Array2;
use rapier3d::pipeline::PhysicsWorld;
use rapier3d::prelude::{ColliderBuilder, RigidBodyBuilder, RigidBodyHandle};
use sbbk_lab::mesh;

use crate::support::{
    Dispatcher, Manifold, Pair, Query, assert_same, counting, fresh, nudge, shape, shape_with,
    touching,
};
use crate::truth::Tally;

/// A field, and the mesh of its triangles in the order of their numbers.
struct Terrain {
    field: HeightField,
    mesh: TriMesh,
    /// The number in the field of each triangle of the mesh, ascending.
    ids: Vec<u32>,
}

impl Terrain {
    fn new(field: HeightField) -> Self {
        let all = 0..2 * (field.nrows() * field.ncols()) as u32;
        let triangles = all.filter_map(|id| Some((id, field.triangle_at_id(id)?)));
        let is_finite = |corner: &Vec3| corner.is_finite();
        let (ids, corners): (Vec<_>, Vec<_>) = triangles
            .map(|(id, triangle)| (id, *triangle.vertices()))
            .filter(|(_, corners)| corners.iter().all(is_finite))
            .unzip();
        let indices = (0..ids.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
        let mesh = TriMesh::new(corners.concat(), indices.collect()).unwrap();
        Self { field, mesh, ids }
    }

    /// Hills at random, `cells` along z and x, with every kind of cell.
    fn random(random: &mut Rand32, cells: [usize; 2], scale: Vec3) -> Self {
        let heights = heights(cells, |_, _| random.rand_float() - 0.5);
        let mut field = HeightField::new(heights, scale);
        for i in 0..cells[0] {
            for j in 0..cells[1] {
                let bits = [random.rand_range(0..2), u32::from(random.rand_range(0..8) == 0)];
                let status = HeightFieldCellStatus::from_bits_truncate(
                    (bits[0] | (bits[1] * (2 << random.rand_range(0..2)))) as u8,
                );
                field.set_cell_status(i, j, status);
            }
        }
        field.set_cell_status(cells[0] / 2, 0, HeightFieldCellStatus::CELL_REMOVED);
        Self::new(field)
    }

    /// Steps, plains and cliffs: heights that are whole multiples of a quarter, cells of a half.
    fn lattice(random: &mut Rand32) -> Self {
        let heights = heights([12, 16], |_, _| random.rand_range(0..3) as Real * 0.25);
        Self::new(HeightField::new(heights, Vec3::new(8.0, 1.0, 6.0)))
    }
}

fn heights(cells: [usize; 2], mut height: impl FnMut(usize, usize) -> Real) -> Array2<Real> {
    let mut data = Vec::new();
    for j in 0..=cells[1] {
        data.extend((0..=cells[0]).map(|i| height(i, j)));
    }
    Array2::new(cells[0] + 1, cells[1] + 1, data)
}

/// The terrain of the laboratory as a field.
fn rolling(size: Real, cells: u32, height: Real) -> HeightField {
    let mesh = mesh::terrain(size, cells, height);
    let lines = cells as usize + 1;
    let heights = Array2::from_fn(lines, lines, |i, j| mesh.vertices[i * lines + j].y);
    let mut field = HeightField::new(heights, Vec3::new(size, 1.0, size));
    for status in field.cells_statuses_mut().data_mut() {
        *status = HeightFieldCellStatus::ZIGZAG_SUBDIVISION;
    }
    field
}

/// What is asked: the contacts of a terrain and a mesh.
#[derive(Clone, Copy)]
struct Question<'a> {
    terrain: &'a Terrain,
    mesh: &'a TriMesh,
    /// The pose of the mesh in the frame of the terrain.
    pose: Pose,
    prediction: Real,
    is_mesh_first: bool,
}

impl<'a> Question<'a> {
    fn new(terrain: &'a Terrain, mesh: &'a TriMesh, pose: Pose) -> Self {
        Self { terrain, mesh, pose, prediction: 0.02, is_mesh_first: false }
    }

    fn pos12(&self) -> Pose {
        if self.is_mesh_first { self.pose.inverse() } else { self.pose }
    }

    /// The same of the terrain as a mesh.
    fn of_meshes(&self) -> Query<'a> {
        let meshes = [&self.terrain.mesh, self.mesh];
        let meshes = if self.is_mesh_first { [meshes[1], meshes[0]] } else { meshes };
        Query { meshes, pos12: self.pos12(), prediction: self.prediction }
    }

    fn ask<'p, M, C>(
        &self,
        dispatcher: &impl Dispatcher<M, C>,
        pair: &'p mut Pair<M, C>,
    ) -> &'p mut Pair<M, C> {
        let (field, mesh) = (&self.terrain.field, self.mesh);
        let Pair { manifolds, workspace } = pair;
        let answer = if self.is_mesh_first {
            dispatcher.contact_manifolds(
                &self.pos12(),
                mesh,
                field,
                self.prediction,
                manifolds,
                workspace,
            )
        } else {
            dispatcher.contact_manifolds(
                &self.pos12(),
                field,
                mesh,
                self.prediction,
                manifolds,
                workspace,
            )
        };
        answer.expect("the pair is supported");
        pair
    }

    fn fresh(&self, dispatcher: &SbbkDispatcher) -> Vec<Manifold> {
        std::mem::take(&mut self.ask(dispatcher, &mut Pair::default()).manifolds)
    }

    /// With the numbers of the terrain as a mesh.
    fn renumbered(&self, manifolds: &[Manifold]) -> Vec<Manifold> {
        let index = |id: &mut u32| {
            *id = self.terrain.ids.binary_search(id).expect("a triangle of the field") as u32;
        };
        let mut manifolds = manifolds.to_vec();
        for manifold in &mut manifolds {
            index(if self.is_mesh_first {
                &mut manifold.subshape2
            } else {
                &mut manifold.subshape1
            });
        }
        manifolds
    }
}

/// Where the mesh touches the terrain, somewhere on it.
fn place(random: &mut Rand32, terrain: &Terrain, mesh: &TriMesh, depth: Real) -> Pose {
    let pose = touching(random, [&terrain.mesh, mesh], depth);
    if random.rand_range(0..3) == 0 {
        return pose;
    }
    let box_ = terrain.field.root_aabb();
    let [x, z] = [0, 2].map(|axis| 2.0 * box_.half_extents()[axis] * (random.rand_float() - 0.5));
    Pose::from_parts(Vec3::new(x, pose.translation.y, z), pose.rotation)
}

fn terrains() -> Vec<Terrain> {
    let mut random = Rand32::new(1);
    vec![
        Terrain::random(&mut random, [14, 17], Vec3::new(6.0, 1.0, 4.0)),
        Terrain::random(&mut random, [1, 2], Vec3::new(4.0, 0.5, 5.0)),
        Terrain::random(&mut random, [30, 20], Vec3::new(3.0, 2.0, 3.0)),
        Terrain::random(&mut random, [8, 9], Vec3::new(-4.0, -0.7, 5.0)),
        Terrain::lattice(&mut random),
        Terrain::new(rolling(6.0, 20, 0.5)),
    ]
}

/// Would catch cells that are cut off too early, triangles that are taken for others, holes that are filled, contacts in
/// the frame of the other shape, and rounding that is not allowed for. Against brute force over all triangles in f64.
#[test]
fn contacts_are_those_of_brute_force() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(2);
    let meshes = [mesh::monkey_head_with(6), mesh::ball(0.7, 6), mesh::cuboid(Vec3::splat(0.6), 1)];
    let meshes = meshes.map(|mesh| shape(&mesh));
    for (index, terrain) in terrains().iter().enumerate() {
        let mut tally = Tally::default();
        for i in 0..36 {
            let mesh = &meshes[i % 3];
            let pose = place(&mut random, terrain, mesh, 0.03);
            let prediction = [0.02, 0.002, 0.1, 0.02][i % 4];
            let question = Question { prediction, ..Question::new(terrain, mesh, pose) };
            let question = Question { is_mesh_first: i % 2 == 1, ..question };
            let found = question.renumbered(&question.fresh(&dispatcher));
            tally.add(&question.of_meshes(), &found);
        }
        assert!(!terrain.ids.is_empty(), "{index}");
        tally.check_all_right(300);
    }
}

/// Poses on a lattice against heights on a lattice: faces in one plane, edges on edges.
#[test]
fn lattice_contacts_are_those_of_brute_force() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(3);
    let terrain = Terrain::lattice(&mut random);
    let cuboid = shape(&mesh::cuboid(Vec3::splat(0.5), 2));
    let mut tally = Tally::default();
    for i in 0..60 {
        let mut coordinate =
            |range: u32| (random.rand_range(0..range) as Real - 0.5 * range as Real) * 0.25;
        let at = Vec3::new(coordinate(30), coordinate(4) + 0.75, coordinate(20));
        let turn = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2 * (i % 4) as Real);
        let question = Question::new(&terrain, &cuboid, Pose::from_parts(at, turn));
        let question = Question { is_mesh_first: i % 2 == 1, prediction: 0.021, ..question };
        let found = question.renumbered(&question.fresh(&dispatcher));
        tally.add(&question.of_meshes(), &found);
    }
    tally.check_all_right(1000);
}

/// Would catch any difference between a terrain and the same terrain: the contacts are those of two meshes, bit for bit,
/// but for the order.
#[test]
fn contacts_equal_those_of_the_terrain_as_a_mesh() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(4);
    let head = shape_with(&mesh::monkey_head(), TriMeshFlags::FIX_INTERNAL_EDGES);
    let mut count = 0;
    for terrain in &terrains() {
        for i in 0..20 {
            let pose = place(&mut random, terrain, &head, 0.05);
            let question = Question::new(terrain, &head, pose);
            let question = Question { is_mesh_first: i % 2 == 1, ..question };
            let mut found = question.renumbered(&question.fresh(&dispatcher));
            let mut expected = fresh(&dispatcher, &question.of_meshes());
            for manifolds in [&mut found, &mut expected] {
                manifolds.sort_by_key(|manifold| [manifold.subshape1, manifold.subshape2]);
            }
            assert_same(&found, &expected, 0.0);
            count += found.len();
        }
    }
    assert!(count > 5000, "{count} contacts");
}

/// Would catch candidates kept too long, cells that are not looked at again, and anything else that depends on where the pair
/// was before. Proves that candidates were kept.
#[test]
fn motion_never_differs_from_fresh_queries() {
    let terrains = terrains();
    let head = shape(&mesh::monkey_head_with(6));
    for (seed, is_mesh_first) in [(0, false), (1, true), (2, false), (4, true), (5, false)] {
        let terrain = &terrains[seed];
        let mut random = Rand32::new(seed as u64);
        let (dispatcher, unaware) = (counting(), SbbkDispatcher::default());
        let _tree = unaware.prepare(&head).unwrap();
        let pose = place(&mut random, terrain, &head, 0.02);
        let mut question = Question { is_mesh_first, ..Question::new(terrain, &head, pose) };
        let mut pair: Pair = Pair::default();
        let (mut stride, mut count) = (1e-3, 0);
        for _ in 0..1500 {
            match random.rand_range(0..100) {
                0..=2 => question.pose = place(&mut random, terrain, &head, 0.03),
                3..=5 => stride = [0.0, 1e-5, 1e-3, 5e-3, 3e-2][random.rand_range(0..5) as usize],
                6..=8 => {
                    question.prediction = [0.0, 0.01, 0.02, 0.06][random.rand_range(0..4) as usize]
                }
                9 => pair.workspace = None,
                10 => question.pose.translation.y += 5.0,
                11 => question.pose.translation.z = Real::NAN,
                _ => question.pose = nudge(&mut random, stride) * question.pose,
            }
            if !question.pose.translation.is_finite() || question.pose.translation.y > 4.0 {
                question.ask(&dispatcher, &mut pair);
                assert_eq!(pair.manifolds.len(), 0);
                question.pose = place(&mut random, terrain, &head, 0.03);
            }
            question.ask(&dispatcher, &mut pair);
            let expected = question.fresh(&unaware);
            assert_same(&pair.manifolds, &expected, 0.0);
            count += expected.len();
        }
        let stats = dispatcher.stats();
        assert!(stats.reused_queries > 300 && stats.descended_queries > 100, "{stats:?}");
        assert!(stats.unchanged_queries > 10 && count > 5000, "{count}, {stats:?}");
    }
}

/// Would catch a descent that looks at more of a terrain than what lies under the mesh: the same mesh on a field of the same
/// cells, of a thousand times as many. And loss of digits far from the middle of it.
#[test]
fn a_million_cells_cost_what_is_under_the_mesh() {
    let head = shape(&mesh::monkey_head());
    let visited = |cells: u32, x: Real| {
        let size = 0.1 * cells as Real;
        // The same hills, wherever the field ends.
        let lines = cells as usize + 1;
        let wave = |k: usize| (k as f32 - 0.5 * cells as f32) * 0.1;
        let heights = Array2::from_fn(lines, lines, |i, j| {
            0.3 * (1.7 * wave(i)).sin() * (1.3 * wave(j)).cos()
        });
        let field = HeightField::new(heights, Vec3::new(size, 1.0, size));
        let terrain = Terrain { field, mesh: head.clone(), ids: Vec::new() };
        let dispatcher = counting();
        let pose = Pose::from_parts(Vec3::new(x, 0.6, x), Quat::from_rotation_y(0.4));
        let count = Question::new(&terrain, &head, pose).fresh(&dispatcher).len();
        (count, dispatcher.stats().descent.cells)
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

/// Would catch contacts at poses that are none, and panics there.
#[test]
fn poses_that_are_none_have_no_contacts() {
    let terrain = Terrain::new(rolling(6.0, 20, 0.5));
    let head = shape(&mesh::monkey_head());
    let dispatcher = SbbkDispatcher::default();
    for broken in [Real::NAN, Real::INFINITY, -Real::INFINITY] {
        let shift = Pose::from_parts(Vec3::new(0.1, broken, 0.0), Quat::IDENTITY);
        let turn = Pose::from_parts(Vec3::ZERO, Quat::from_xyzw(broken, 0.0, 0.0, 1.0));
        for (pose, is_mesh_first) in [(shift, false), (shift, true), (turn, false), (turn, true)] {
            let good = Question::new(&terrain, &head, Pose::IDENTITY);
            let good = Question { is_mesh_first, ..good };
            let mut pair: Pair = Pair::default();
            assert!(!good.ask(&dispatcher, &mut pair).manifolds.is_empty());
            let question = Question { pose, ..good };
            assert!(question.ask(&dispatcher, &mut pair).manifolds.is_empty());
            assert!(question.fresh(&dispatcher).is_empty());
        }
    }
    let question = Question::new(&terrain, &head, Pose::IDENTITY);
    assert!(Question { prediction: Real::NAN, ..question }.fresh(&dispatcher).is_empty());
}

/// A triangle with a height that is NaN or infinite is a hole; its neighbours are not.
#[test]
fn heights_that_are_none_make_holes() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(5);
    let ball = shape(&mesh::ball(0.7, 6));
    for broken in [Real::NAN, Real::INFINITY, -Real::INFINITY] {
        let heights = heights([14, 14], |_, _| match random.rand_range(0..6) {
            0 => broken,
            _ => 0.3 * random.rand_float(),
        });
        let terrain = Terrain::new(HeightField::new(heights, Vec3::new(4.0, 1.0, 4.0)));
        assert!(terrain.ids.len() < 300);
        let mut tally = Tally::default();
        for i in 0..20 {
            let [x, z] = [(); 2].map(|()| 3.0 * random.rand_float() - 1.5);
            let pose = Pose::translation(x, 0.8, z);
            let question = Question::new(&terrain, &ball, pose);
            let question = Question { is_mesh_first: i % 2 == 1, ..question };
            let found = question.renumbered(&question.fresh(&dispatcher));
            tally.add(&question.of_meshes(), &found);
        }
        tally.check_all_right(50);
    }
}

/// Would catch constraints of a neighbour, of the wrong shape or none at all: each manifold is the one that the
/// generator makes of its two triangles and their cones.
#[test]
fn internal_edges_of_the_field_are_fixed() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(6);
    let mut terrain = Terrain::random(&mut random, [14, 17], Vec3::new(6.0, 0.6, 4.0));
    let mesh = shape_with(&mesh::monkey_head_with(6), TriMeshFlags::FIX_INTERNAL_EDGES);
    let (mut count, mut changed_count) = (0, 0);
    for i in 0..40 {
        let pose = place(&mut random, &terrain, &mesh, 0.05);
        let ask = |terrain: &Terrain| {
            let question = Question::new(terrain, &mesh, pose);
            Question { is_mesh_first: i % 2 == 1, ..question }.fresh(&dispatcher)
        };
        terrain.field.set_flags(HeightFieldFlags::empty());
        let free = ask(&terrain);
        terrain.field.set_flags(HeightFieldFlags::FIX_INTERNAL_EDGES);
        let constrained = ask(&terrain);
        changed_count += usize::from(format!("{free:?}") != format!("{constrained:?}"));
        for manifold in &constrained {
            let [one, two] = [manifold.subshape1, manifold.subshape2];
            let [in_mesh, in_field] = if i % 2 == 1 { [one, two] } else { [two, one] };
            let field = terrain.field.triangle_at_id(in_field).unwrap();
            let cones = [
                mesh.triangle_normal_constraints(in_mesh),
                terrain.field.triangle_normal_constraints(in_field),
            ];
            let [of_mesh, of_field] =
                cones.each_ref().map(|cone| cone.as_ref().map(|c| c as &dyn NormalConstraints));
            let triangle = mesh.triangle(in_mesh);
            let mut expected = Manifold::new();
            let (pos12, triangles, cones) = if i % 2 == 1 {
                (pose.inverse(), [&triangle, &field], [of_mesh, of_field])
            } else {
                (pose, [&field, &triangle], [of_field, of_mesh])
            };
            TriangleContacts::default().update(&pos12, triangles, cones, 0.02, &mut expected);
            [expected.subshape1, expected.subshape2] = [one, two];
            assert_same(std::slice::from_ref(manifold), &[expected], 0.0);
            count += 1;
        }
    }
    assert!(count > 150 && changed_count > 20, "{count} manifolds, {changed_count} changed");
}

/// Would catch answers for a field that is no longer there, where a host keeps the workspace over an edit.
#[test]
fn an_edited_field_is_noticed() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(7);
    let mut terrain = Terrain::random(&mut random, [14, 17], Vec3::new(6.0, 1.0, 4.0));
    let head = shape(&mesh::monkey_head());
    let pose = place(&mut random, &terrain, &head, 0.1);
    let mut pair: Pair = Pair::default();
    let check = |terrain: &Terrain, pair: &mut Pair| {
        let question = Question::new(terrain, &head, pose);
        let expected = question.fresh(&dispatcher);
        assert_same(&question.ask(&dispatcher, pair).manifolds, &expected, 0.0);
        expected.len()
    };
    assert!(check(&terrain, &mut pair) > 0);
    terrain.field.set_scale(Vec3::new(5.0, 1.1, 4.5));
    assert!(check(&terrain, &mut pair) > 0);
    terrain.field.set_flags(HeightFieldFlags::FIX_INTERNAL_EDGES);
    check(&terrain, &mut pair);
    terrain = Terrain::random(&mut random, [14, 17], Vec3::new(6.0, 1.0, 4.0));
    check(&terrain, &mut pair);
    // A hole where the contacts are, seen at the next motion.
    for manifold in Question::new(&terrain, &head, pose).fresh(&dispatcher) {
        let cell = manifold.subshape1 as usize % (14 * 17);
        terrain.field.set_cell_status(cell % 14, cell / 14, HeightFieldCellStatus::CELL_REMOVED);
    }
    let moved = Question::new(&terrain, &head, nudge(&mut random, 1e-5) * pose);
    let expected = moved.fresh(&dispatcher);
    assert_same(&moved.ask(&dispatcher, &mut pair).manifolds, &expected, 0.0);
}

/// Would catch manifolds, lists of candidates and descents that are made anew in each step.
#[test]
fn steady_contact_allocates_nothing() {
    let mut terrain = Terrain::new(rolling(6.0, 20, 0.5));
    terrain.field.set_flags(HeightFieldFlags::FIX_INTERNAL_EDGES);
    let head = shape(&mesh::monkey_head());
    for (stride, is_mesh_first) in [(1e-4, false), (1e-3, true), (2.5e-2, false)] {
        let dispatcher = counting();
        let mut random = Rand32::new(8);
        let start = touching(&mut random, [&terrain.mesh, &head], 0.02);
        let poses: Vec<Pose> = (0..20).map(|_| nudge(&mut random, 0.5 * stride) * start).collect();
        let mut pair = Pair::<ContactManifoldData, ContactData>::default();
        let question = |pose| Question { is_mesh_first, ..Question::new(&terrain, &head, pose) };
        for &pose in poses.iter().cycle().take(20 * 20) {
            question(pose).ask(&dispatcher, &mut pair);
        }
        for &pose in poses.iter().cycle().take(20 * 5) {
            let allocated = measure(|| _ = question(pose).ask(&dispatcher, &mut pair));
            assert!(!pair.manifolds.is_empty());
            assert_eq!(allocated.count_total, 0, "{stride}: {allocated:?}");
        }
        assert!(dispatcher.stats().reused_queries + dispatcher.stats().descended_queries > 400);
    }
}

/// A world with four heads above a terrain.
fn world(terrain: SharedShape) -> (PhysicsWorld, Vec<RigidBodyHandle>) {
    let mut world = PhysicsWorld::new();
    let fixed = world.bodies.insert(RigidBodyBuilder::fixed());
    let ground = ColliderBuilder::new(terrain).build();
    world.colliders.insert_with_parent(ground, fixed, &mut world.bodies);
    let head = mesh::monkey_head().shared_shape().unwrap();
    let place = |i: usize| Vec3::new(3.0 * (i % 2) as Real - 1.5, 2.2, 3.0 * (i / 2) as Real - 1.5);
    let heads = (0..4).map(|i| {
        let body = RigidBodyBuilder::dynamic().translation(place(i)).angular_damping(3.0).build();
        let body = world.bodies.insert(body);
        let collider = ColliderBuilder::new(head.clone()).density(1.0).build();
        world.colliders.insert_with_parent(collider, body, &mut world.bodies);
        body
    });
    let heads = heads.collect();
    (world, heads)
}

fn step(world: &mut PhysicsWorld, count: usize) {
    (0..count).for_each(|_| world.step());
}

fn poses(world: &PhysicsWorld, bodies: &[RigidBodyHandle]) -> Vec<Pose> {
    bodies.iter().map(|&body| *world.bodies[body].position()).collect()
}

/// The reason for all this: under stock Rapier heads fall through a height field. Here they come to rest, about where they do on
/// the same terrain as a mesh.
#[test]
fn heads_rest_on_a_height_field() {
    let field = rolling(12.0, 24, 0.4);
    let as_mesh = mesh::terrain(12.0, 24, 0.4).shared_shape().unwrap();
    let field = SharedShape::new(field);
    let run = |terrain: &SharedShape, dispatcher: Option<SbbkDispatcher>| {
        let (mut world, heads) = world(terrain.clone());
        if let Some(dispatcher) = dispatcher {
            world.narrow_phase.set_query_dispatcher(dispatcher);
        }
        step(&mut world, 30);
        let early = poses(&world, &heads);
        step(&mut world, 570);
        let before = poses(&world, &heads);
        step(&mut world, 60);
        let late = poses(&world, &heads);
        let moved = before.iter().zip(&late).map(|(a, b)| (a.translation - b.translation).length());
        (early, late.clone(), moved.fold(0.0, Real::max))
    };
    let (_, fallen, _) = run(&field, None);
    assert!(fallen.iter().all(|pose| pose.translation.y < -100.0), "stock has learnt it");
    let dispatcher = SbbkDispatcher::default();
    let (early, on_field, moved) = run(&field, Some(dispatcher.clone()));
    let (expected, on_mesh, moved_on_mesh) = run(&as_mesh, Some(dispatcher));
    for (pose, expected) in early.iter().zip(&expected) {
        let apart = (pose.translation - expected.translation).length();
        assert!(apart < 1e-3, "{apart} apart at the first touch");
    }
    assert!(moved < 0.05 && moved_on_mesh < 0.05, "move by {moved} and {moved_on_mesh}");
    for pose in on_field.iter().chain(&on_mesh) {
        assert!((0.0..1.6).contains(&pose.translation.y), "{pose:?}");
    }
}

/// Would catch a workspace that cannot be stored, and contacts or their order lost with it.
#[test]
fn a_restored_world_goes_on_bit_for_bit() {
    let (mut world, heads) = world(SharedShape::new(rolling(12.0, 24, 0.4)));
    world.narrow_phase.set_query_dispatcher(SbbkDispatcher::default());
    step(&mut world, 60);
    let bytes = postcard::to_stdvec(&world).expect("a world with SBBK can be saved");
    let mut copy: PhysicsWorld = postcard::from_bytes(&bytes).expect("and loaded");
    copy.narrow_phase.set_query_dispatcher(SbbkDispatcher::new(SbbkConfig::default()));
    let manifold_count: usize =
        world.narrow_phase.contact_pairs().map(|pair| pair.manifolds().len()).sum();
    assert!(manifold_count > 4, "{manifold_count} manifolds");
    step(&mut world, 40);
    step(&mut copy, 40);
    assert_eq!(poses(&world, &heads), poses(&copy, &heads));
}

/// Would catch manifolds of stock's own for this pair, should it have any, that are taken for ours. Stock has none.
#[test]
fn stock_has_no_contacts_to_hand_over() {
    let terrain = Terrain::new(rolling(6.0, 20, 0.5));
    let head = shape(&mesh::monkey_head());
    let question = Question::new(&terrain, &head, Pose::IDENTITY);
    let mut pair: Pair = Pair::default();
    question.ask(&DefaultQueryDispatcher, &mut pair);
    let has_points = |manifold: &Manifold| !manifold.points.is_empty();
    assert!(!pair.manifolds.iter().any(has_points));
    let dispatcher = SbbkDispatcher::default();
    let expected = question.fresh(&dispatcher);
    assert!(!expected.is_empty());
    assert_same(&question.ask(&dispatcher, &mut pair).manifolds, &expected, 0.0);
}
