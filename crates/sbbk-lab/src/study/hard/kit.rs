//! Worlds, bodies and figures of the hard scenes.

use std::cell::RefCell;
pub(super) use std::f32::consts::{FRAC_PI_2, FRAC_PI_3, FRAC_PI_4, PI, TAU};
use std::ops::{Deref, DerefMut};
use std::rc::Rc;

pub(super) use glamx::Vec2;
use rapier_integration::{PreparedTree, SurfaceKind};
use rapier3d::dynamics::GenericJoint;
use rapier3d::geometry::HeightFieldFlags;
use rapier3d::parry::utils::Array2;

pub(super) use super::Trial;
pub(super) use super::depth::{Depths, touching_pairs};
pub(super) use super::figures::{Figures, greatest_rise, largest};
pub(super) use crate::prelude::*;

/// A dispatcher, and the shapes of the bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Column {
    /// Stock Rapier, plain meshes.
    Stock,
    /// Stock Rapier, all meshes with `TriMeshFlags::FIX_INTERNAL_EDGES`.
    StockFlag,
    /// SBBK, plain meshes.
    Sbbk,
    /// SBBK with every contact, plain meshes.
    Every,
    /// SBBK, all meshes with `TriMeshFlags::FIX_INTERNAL_EDGES`.
    SbbkFlag,
    /// Stock Rapier, convex shapes instead of the meshes.
    Control,
}

impl Column {
    /// Stock with and without the flag, and SBBK: the columns of tables.
    pub const USUAL: [Self; 3] = [Self::Stock, Self::StockFlag, Self::Sbbk];
}

/// A mesh, and the convex shapes that replace it in the control.
#[derive(Clone)]
pub(super) struct Form {
    pub mesh: Mesh,
    pub control: Option<SharedShape>,
}

impl Form {
    /// A mesh that the control uses, too.
    pub fn mesh(mesh: Mesh) -> Self {
        Self { mesh, control: None }
    }

    /// A box of `12 * cells * cells` triangles.
    pub fn cuboid(half_extents: Vec3, cells: u32) -> Self {
        let Vec3 { x, y, z } = half_extents;
        let control = Some(SharedShape::cuboid(x, y, z));
        Self { mesh: mesh::cuboid(half_extents, cells), control }
    }

    /// A mesh that consists of convex parts, each the hull of some points.
    pub fn parts(mesh: Mesh, parts: impl IntoIterator<Item = Vec<Vec3>>) -> Self {
        let hulls = parts.into_iter().filter_map(|points| SharedShape::convex_hull(&points));
        let hulls: Vec<_> = hulls.map(|hull| (Pose3::IDENTITY, hull)).collect();
        Self { mesh, control: Some(SharedShape::compound(hulls)) }
    }
}

/// Numbers of a scene, the same in all columns.
pub(super) fn seeded() -> Rand32 {
    Rand32::new(1)
}

/// A shared recording, empty before the first step.
pub(super) type Film = Rc<RefCell<Option<Recorder>>>;

/// Settings of one run of a scene.
pub(super) struct Kit {
    pub column: Column,
    /// Records the first world.
    film: Option<Film>,
}

impl Kit {
    pub fn new(column: Column, film: Option<Film>) -> Self {
        Self { column, film }
    }

    /// An empty world with the column's dispatcher.
    pub fn world(&self) -> World {
        self.world_with(None)
    }

    /// An empty world with the column's dispatcher, which is told that a mesh is a solid.
    pub fn world_with(&self, solid: Option<&ColliderBuilder>) -> World {
        let mut world = PhysicsWorld::new();
        let backend = match self.column {
            Column::Stock | Column::StockFlag | Column::Control => Backend::Stock,
            Column::Sbbk | Column::SbbkFlag => Backend::Sbbk,
            Column::Every => Backend::Every,
        };
        let mut declared = None;
        if let Some(sbbk) = backend.dispatcher().sbbk {
            let mesh = solid.and_then(|solid| solid.shape.as_trimesh());
            declared = mesh.and_then(|mesh| sbbk.prepare(mesh).ok());
            declared.iter().for_each(|solid| solid.set_surface_kind(SurfaceKind::Solid));
            world.narrow_phase.set_query_dispatcher(sbbk);
        }
        let column = self.column;
        let film = self.film.clone().filter(|film| film.borrow().is_none());
        World { world, film, column, watched: Vec::new(), _declared: declared }
    }

    fn is_flagged(&self) -> bool {
        matches!(self.column, Column::StockFlag | Column::SbbkFlag)
    }

    /// Makes a collider. Clones share its shape.
    pub fn collider(&self, form: &Form) -> ColliderBuilder {
        match (self.column, &form.control) {
            (Column::Control, Some(control)) => ColliderBuilder::new(control.clone()),
            _ => self.mesh(&form.mesh),
        }
    }

    /// Makes a collider of a mesh, in the control as well.
    pub fn mesh(&self, mesh: &Mesh) -> ColliderBuilder {
        let flag = TriMeshFlags::FIX_INTERNAL_EDGES;
        let flags = if self.is_flagged() { flag } else { TriMeshFlags::empty() };
        ColliderBuilder::new(mesh.shape_with(flags))
    }

    /// A flat height field at height 0, of so many cells along z and x.
    pub fn flat_field(&self, cells: [u32; 2], size: Vec3) -> ColliderBuilder {
        let flag = HeightFieldFlags::FIX_INTERNAL_EDGES;
        let flags = if self.is_flagged() { flag } else { HeightFieldFlags::empty() };
        let [rows, columns] = cells.map(|cells| cells as usize + 1);
        let heights = Array2::repeat(rows, columns, 0.0);
        ColliderBuilder::new(SharedShape::heightfield_with_flags(heights, size, flags))
    }
}

/// A world with the bodies of its scene, and a recording if there is a film.
pub(super) struct World {
    _declared: Option<PreparedTree>,
    world: PhysicsWorld,
    film: Option<Film>,
    column: Column,
    /// Bodies of the scene, in the order of insertion.
    pub watched: Vec<RigidBodyHandle>,
}

/// Measurements of the steps of a world.
pub(super) struct Watched {
    /// Greatest rise of the energy.
    pub rise: f64,
    /// Greatest rise, as a share of the energy at the start.
    pub gain: f64,
    /// Median time of the measured steps, in milliseconds.
    pub step_time: f64,
    /// Mean number of solver points in these steps.
    pub points: f64,
}

impl World {
    /// Adds a fixed collider.
    pub fn fix(&mut self, place: Vec3, collider: ColliderBuilder) {
        self.insert(RigidBodyBuilder::fixed().translation(place), collider);
    }

    /// Adds a body of the scene.
    pub fn add(&mut self, body: RigidBodyBuilder, collider: &ColliderBuilder) -> RigidBodyHandle {
        let (body, _) = self.insert(body, collider.clone());
        self.watched.push(body);
        body
    }

    /// Adds a body at rest.
    pub fn put(&mut self, pose: Pose3, collider: &ColliderBuilder) -> RigidBodyHandle {
        self.add(RigidBodyBuilder::dynamic().pose(pose), collider)
    }

    /// Holds a body where it is by a joint at its middle.
    pub fn hang(&mut self, body: RigidBodyHandle, joint: impl Into<GenericJoint>) {
        let place = RigidBodyBuilder::fixed().translation(self.bodies[body].translation());
        let axle = self.insert_body(place);
        self.insert_impulse_joint(axle, body, joint);
    }

    pub fn run(&mut self, steps: usize) {
        (0..steps).for_each(|_| self.step());
    }

    /// Steps the world and measures the steps after number `full`. Calls `seen` after each step
    /// with its number, from one.
    pub fn watch(
        &mut self,
        steps: usize,
        full: usize,
        mut seen: impl FnMut(&Self, usize),
    ) -> Watched {
        let (mut energies, mut times, mut points) = (vec![self.energy()], Vec::new(), 0.0);
        for step in 1..=steps {
            let clock = Instant::now();
            self.step();
            let time = 1e3 * clock.elapsed().as_secs_f64();
            energies.push(self.energy());
            if step > full {
                times.push(time);
                points += solver_points(self) as f64 / (steps - full) as f64;
            }
            seen(self, step);
        }
        let step_time = Summary::of(times).map_or(f64::NAN, |times| times.median);
        let (start, rise) = (energies[0], greatest_rise(energies));
        Watched { rise, gain: rise / start, step_time, points }
    }

    /// Runs for some steps. Returns the greatest rise of the energy.
    pub fn rise(&mut self, steps: usize) -> f64 {
        self.watch(steps, steps, |_, _| ()).rise
    }

    /// Runs for some steps. Returns the highest speed of a body after any of them.
    pub fn fastest(&mut self, steps: usize) -> f32 {
        let speeds = (0..steps).map(|_| {
            self.step();
            self.top_speed()
        });
        largest(speeds)
    }

    /// Highest speed of a body; NaN if a speed is NaN.
    pub fn top_speed(&self) -> f32 {
        largest(self.watched.iter().map(|&body| self.bodies[body].linvel().length()))
    }

    pub fn places(&self) -> Vec<Vec3> {
        self.watched.iter().map(|&body| self.bodies[body].translation()).collect()
    }

    /// Kinetic and potential energy of the bodies. Sleeping bodies have no kinetic energy.
    pub fn energy(&self) -> f64 {
        let energies = self.watched.iter().map(|&body| {
            let body = &self.bodies[body];
            let height = f64::from(-self.gravity.dot(body.center_of_mass()));
            f64::from(body.kinetic_energy()) + f64::from(body.mass()) * height
        });
        energies.sum()
    }

    pub fn step(&mut self) {
        let Some(film) = &self.film else { return self.world.step() };
        let mut film = film.borrow_mut();
        film.get_or_insert_with(|| Recorder::new(self.column, &self.world)).step(&mut self.world);
    }
}

impl Deref for World {
    type Target = PhysicsWorld;

    fn deref(&self) -> &PhysicsWorld {
        &self.world
    }
}

impl DerefMut for World {
    fn deref_mut(&mut self) -> &mut PhysicsWorld {
        &mut self.world
    }
}
