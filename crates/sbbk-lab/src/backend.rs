//! The dispatchers that are compared.

use crate::prelude::*;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use rapier_integration::{ContactDetail, ContactSet, PreparedTree, SbbkConfig, SbbkDispatcher};
use rapier3d::geometry::{ContactData, ContactManifoldData};
use rapier3d::parry::query::{
    ContactManifoldsWorkspace, DefaultQueryDispatcher, PersistentQueryDispatcher,
};
use rapier3d::parry::shape::Shape;
use sbbk_core::tree::LayerPlan;

pub use sbbk_testkit::probe::{Answer, Probe, Question, Recording, Reported, shape_address};

/// A dispatcher as Rapier takes it.
pub type SharedDispatcher = Arc<dyn PersistentQueryDispatcher<ContactManifoldData, ContactData>>;

/// The dispatcher of a backend.
#[derive(Clone)]
pub struct Dispatcher {
    /// The dispatcher as Rapier takes it.
    pub shared: SharedDispatcher,
    /// SBBK's dispatcher, unless the backend is stock.
    pub sbbk: Option<SbbkDispatcher>,
}

impl Deref for Dispatcher {
    type Target = SharedDispatcher;

    fn deref(&self) -> &SharedDispatcher {
        &self.shared
    }
}

/// A way to find the contacts of a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
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

    /// Makes a fresh dispatcher for the contacts of each two triangles of meshes. These are the
    /// contacts of stock, and those that brute force over all triangles can judge.
    pub fn per_triangle(self) -> Dispatcher {
        self.configured(ContactSet::Triangles, ContactDetail::Every)
    }

    /// True if two rigid meshes have the contacts of their surfaces.
    pub fn has_surfaces(self) -> bool {
        self != Self::Stock
    }

    fn configured(self, contact_set: ContactSet, detail: ContactDetail) -> Dispatcher {
        let mut config = match self {
            Self::Stock => {
                return Dispatcher { shared: Arc::new(DefaultQueryDispatcher), sbbk: None };
            }
            Self::AabbOnly => SbbkConfig::default().with_layers(Some(LayerPlan::AABB_ONLY)),
            Self::Sbbk | Self::Every => SbbkConfig::default(),
        };
        (config.contact_set, config.detail) = (contact_set, detail);
        let sbbk = SbbkDispatcher::new(config);
        Dispatcher { shared: Arc::new(sbbk.clone()), sbbk: Some(sbbk) }
    }

    /// Installs a fresh dispatcher in a world, with the trees of all its meshes.
    pub fn install(self, world: &mut PhysicsWorld) -> Installed {
        let (dispatcher, probe) = (self.dispatcher(), Probe::default());
        let shapes = world.colliders.iter().map(|(_, collider)| collider.shared_shape());
        let primed = Primed::new(&dispatcher, shapes);
        world.narrow_phase.set_query_dispatcher(Recording::new(dispatcher.shared, probe.clone()));
        Installed { probe, primed }
    }
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.to_possible_value().expect("none is hidden").get_name())
    }
}

/// Result of [`Backend::install`].
pub struct Installed {
    /// Answers to the queries of the world.
    pub probe: Probe,
    /// Trees of the meshes of the world.
    pub primed: Primed,
}

/// Trees that were built before the first query, so that times do not contain builds.
pub struct Primed(#[expect(dead_code, reason = "kept alive")] Vec<PreparedTree>);

impl Primed {
    /// Prepares the meshes among `shapes`.
    pub fn new<'a>(
        dispatcher: &Dispatcher,
        shapes: impl IntoIterator<Item = &'a SharedShape>,
    ) -> Self {
        let prepare = |shape| dispatcher.sbbk.as_ref()?.prepare_shape(shape).ok()?;
        Self(shapes.into_iter().filter_map(prepare).collect())
    }
}

/// Data that a host keeps of a pair of shapes from query to query.
#[derive(Default)]
pub struct Memory {
    /// Result of the last query.
    pub manifolds: Vec<ContactManifold>,
    workspace: Option<ContactManifoldsWorkspace>,
}

impl Memory {
    /// Brings the manifolds up to date.
    ///
    /// # Panics
    ///
    /// If the dispatcher does not support the shapes.
    pub fn ask(
        &mut self,
        dispatcher: &SharedDispatcher,
        [shape1, shape2]: [&dyn Shape; 2],
        pos12: &Pose,
        prediction: Real,
    ) {
        let Self { manifolds, workspace } = self;
        dispatcher
            .contact_manifolds(pos12, shape1, shape2, prediction, manifolds, workspace)
            .expect("every backend supports a mesh and the shapes of the studies");
    }
}
