//! SBBK for `bevy_rapier3d`: fast and exact contacts of triangle meshes.
//!
//! ```
//! use bevy::prelude::*;
//! use bevy_rapier_sbbk::SbbkPlugin;
//! use bevy_rapier3d::prelude::*;
//!
//! App::new().add_plugins((
//!     MinimalPlugins,
//!     TransformPlugin,
//!     RapierPhysicsPlugin::<NoUserData>::default(),
//!     SbbkPlugin::default(), // the one line
//! ));
//! ```
//!
//! All Rapier contexts have the dispatcher of the resource [`Sbbk`], those too that are spawned or
//! replaced later; a context with [`StockContacts`] keeps its own. Meshes of new colliders are
//! prepared, so that large ones have trees and are known as solids:
//! see [`SbbkDispatcher::prepare_shape`].

use bevy::ecs::intern::Interned;
use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
pub use rapier_integration;
use rapier_integration::{PreparedTree, SbbkDispatcher};

/// Gives each Rapier context the dispatcher of [`Sbbk`].
///
/// Where [`RapierPhysicsPlugin::in_schedule`] is used, call [`in_schedule`](Self::in_schedule) with
/// the same.
pub struct SbbkPlugin {
    dispatcher: SbbkDispatcher,
    schedule: Interned<dyn ScheduleLabel>,
    prepares: bool,
}

impl Default for SbbkPlugin {
    fn default() -> Self {
        Self::new(SbbkDispatcher::default())
    }
}

impl SbbkPlugin {
    /// With a dispatcher of one's own configuration.
    pub fn new(dispatcher: SbbkDispatcher) -> Self {
        Self { dispatcher, schedule: PostUpdate.intern(), prepares: true }
    }

    /// For physics in this schedule instead of `PostUpdate`.
    #[must_use]
    pub fn in_schedule(mut self, schedule: impl ScheduleLabel) -> Self {
        self.schedule = schedule.intern();
        self
    }

    /// Prepares no meshes: for terrains of millions of triangles that meet no other meshes, or to
    /// call [`SbbkDispatcher::prepare_shape`] elsewhere. Meshes of up to 8192 triangles get their
    /// trees all the same, as they meet others.
    #[must_use]
    pub fn without_preparing(mut self) -> Self {
        self.prepares = false;
        self
    }
}

impl Plugin for SbbkPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(Sbbk(self.dispatcher.clone()));
        // Before the backend is synchronised, as character controllers ask the dispatcher there.
        app.add_systems(self.schedule, set_dispatcher.before(PhysicsSet::SyncBackend));
        if self.prepares {
            let prepare =
                prepare_meshes.after(PhysicsSet::SyncBackend).before(PhysicsSet::StepSimulation);
            app.add_systems(self.schedule, prepare);
        }
    }
}

/// The dispatcher of all contexts: to ask it for [`stats`](SbbkDispatcher::stats). May be replaced
/// at any time.
#[derive(Resource, Clone, Debug, Deref)]
pub struct Sbbk(pub SbbkDispatcher);

/// Leaves a Rapier context as it is: with stock contacts, or with a dispatcher of one's own.
#[derive(Component, Copy, Clone, Debug, Default)]
pub struct StockContacts;

/// The tree of a collider's mesh, for as long as the collider has this shape.
#[derive(Component, Clone, Debug, Deref)]
pub struct SbbkTree(pub PreparedTree);

/// In each frame: contexts come, are replaced, and restored from snapshots without a dispatcher. It
/// is an `Arc` a context, and keeps all contacts.
fn set_dispatcher(
    sbbk: Res<Sbbk>,
    mut contexts: Query<&mut RapierContextSimulation, Without<StockContacts>>,
) {
    for mut context in &mut contexts {
        context.bypass_change_detection().narrow_phase.set_query_dispatcher(sbbk.0.clone());
    }
}

/// After the backend was synchronised: colliders have their scaled shapes then.
fn prepare_meshes(
    mut commands: Commands,
    sbbk: Res<Sbbk>,
    colliders: Query<(Entity, Ref<Collider>)>,
) {
    let is_asked = |collider: &Ref<Collider>| sbbk.is_changed() || collider.is_changed();
    for (entity, collider) in colliders.iter().filter(|(_, collider)| is_asked(collider)) {
        // A mesh that cannot have a tree is answered by Parry, and counted in `SbbkStats`.
        match sbbk.prepare_shape(&collider.raw) {
            Ok(Some(tree)) => commands.entity(entity).insert(SbbkTree(tree)),
            _ => commands.entity(entity).remove::<SbbkTree>(),
        };
    }
}
