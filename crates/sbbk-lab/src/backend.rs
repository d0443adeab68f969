//! The dispatchers that are compared.

use crate::prelude::*;
use std::ops::Deref;

use rapier_integration::{ContactDetail, ContactSet, PreparedTree, SbbkConfig, SbbkDispatcher};
use rapier3d::geometry::{ContactData, ContactManifoldData};
use rapier3d::parry::query::{
    ContactManifoldsWorkspace, DefaultQueryDispatcher, PersistentQueryDispatcher,
};
use sbbk_core::tree::LayerPlan;

/// The dispatchers that Rapier takes.
pub type SharedDispatcher = Arc<dyn PersistentQueryDispatcher<ContactManifoldData, ContactData>>;

/// The dispatcher of a backend.
pub struct Dispatcher {
    pub backend: Backend,
    /// The dispatcher as Rapier takes it.
    pub shared: SharedDispatcher,
    /// SBBK's dispatcher, unless the backend is stock.
    pub sbbk: Option<SbbkDispatcher>,
    /// Trees that were built before the first query, so that times do not contain builds.
    trees: Vec<PreparedTree>,
}

impl Dispatcher {
    /// Prepares the meshes among some shapes.
    pub fn prepare<'a>(&mut self, shapes: impl IntoIterator<Item = &'a SharedShape>) {
        let Some(sbbk) = &self.sbbk else { return };
        let prepare = |shape| sbbk.prepare_shape(shape).ok()?;
        self.trees.extend(shapes.into_iter().filter_map(prepare));
    }
}

impl Deref for Dispatcher {
    type Target = SharedDispatcher;

    fn deref(&self) -> &SharedDispatcher {
        &self.shared
    }
}

/// A way to find the contacts of a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// Parry's own dispatcher, Rapier's default.
    Stock,
    /// SBBK with AABBs in every layer: the paper's comparison.
    AabbOnly,
    /// SBBK with its default configuration.
    Sbbk,
    /// SBBK with a manifold for every contact, as in stock.
    Every,
}

impl Backend {
    /// The backends of the paper's experiments, stock first.
    pub const ALL: [Self; 3] = [Self::Stock, Self::AabbOnly, Self::Sbbk];

    /// Makes a fresh dispatcher with nothing cached.
    pub fn dispatcher(self) -> Dispatcher {
        let detail = match self {
            Self::Every => ContactDetail::Every,
            _ => ContactDetail::default(),
        };
        self.configured(ContactSet::Surfaces, detail)
    }

    /// Makes a fresh dispatcher for the contacts of each two triangles of meshes, with the trees of
    /// some. These are the contacts of stock, and those that brute force can judge.
    pub fn per_triangle<'a>(self, shapes: impl IntoIterator<Item = &'a SharedShape>) -> Dispatcher {
        let mut dispatcher = self.configured(ContactSet::Triangles, ContactDetail::Every);
        dispatcher.prepare(shapes);
        dispatcher
    }

    fn configured(self, contact_set: ContactSet, detail: ContactDetail) -> Dispatcher {
        let layers = (self == Self::AabbOnly).then_some(LayerPlan::AABB_ONLY);
        let mut config = SbbkConfig::default().with_layers(layers);
        (config.contact_set, config.detail) = (contact_set, detail);
        let sbbk = (self != Self::Stock).then(|| SbbkDispatcher::new(config));
        let shared: SharedDispatcher = match &sbbk {
            Some(sbbk) => Arc::new(sbbk.clone()),
            None => Arc::new(DefaultQueryDispatcher),
        };
        Dispatcher { backend: self, shared, sbbk, trees: Vec::new() }
    }

    /// Installs a fresh dispatcher in a world with Rapier's default, with the trees of all its
    /// meshes.
    pub fn install(self, world: &mut PhysicsWorld) -> Dispatcher {
        let mut dispatcher = self.dispatcher();
        dispatcher.prepare(world.colliders.iter().map(|(_, collider)| collider.shared_shape()));
        if let Some(sbbk) = &dispatcher.sbbk {
            world.narrow_phase.set_query_dispatcher(sbbk.clone());
        }
        dispatcher
    }
}

/// Data that a host keeps of a pair of shapes from query to query.
#[derive(Default)]
pub struct Memory {
    /// Result of the last query.
    pub manifolds: Vec<ContactManifold>,
    pub workspace: Option<ContactManifoldsWorkspace>,
}
