//! The backends that are compared.

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use clap::ValueEnum;
use rapier_integration::{ContactDetail, ContactSet, SbbkConfig, SbbkDispatcher};
use rapier3d::geometry::{ContactData, ContactManifoldData};
use rapier3d::parry::query::{DefaultQueryDispatcher, PersistentQueryDispatcher};
use rapier3d::pipeline::PhysicsWorld;
use serde::Serialize;

use super::{Primed, Probe, Timed};

/// A dispatcher as Rapier takes it.
pub type SharedDispatcher = Arc<dyn PersistentQueryDispatcher<ContactManifoldData, ContactData>>;

/// A backend's dispatcher.
#[derive(Clone)]
pub struct Dispatcher {
    /// As Rapier takes it.
    pub shared: SharedDispatcher,
    /// As what it is, unless it is stock's.
    pub sbbk: Option<SbbkDispatcher>,
}

impl Deref for Dispatcher {
    type Target = SharedDispatcher;

    fn deref(&self) -> &SharedDispatcher {
        &self.shared
    }
}

/// Who answers the contact queries of a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Backend {
    /// Parry's own dispatcher, which Rapier installs when it is told nothing.
    Stock,
    /// SBBK's code with AABBs in every layer: what the paper compares with.
    AabbOnly,
    /// SBBK as a user gets it.
    Sbbk,
    /// SBBK with a manifold for every contact, as in stock.
    Every,
}

impl Backend {
    /// All backends, stock first.
    pub const ALL: [Self; 3] = [Self::Stock, Self::AabbOnly, Self::Sbbk];

    /// A fresh dispatcher, with nothing cached.
    pub fn dispatcher(self) -> Dispatcher {
        self.having(ContactSet::Surfaces, self.detail())
    }

    /// The same, for the contacts of each two triangles of meshes by themselves. These are what
    /// stock has, and what can be judged by brute force over all triangles.
    pub fn per_triangle(self) -> Dispatcher {
        self.having(ContactSet::Triangles, ContactDetail::Every)
    }

    /// Whether two rigid meshes have the contacts of their surfaces.
    pub fn has_surfaces(self) -> bool {
        matches!(self, Self::AabbOnly | Self::Sbbk | Self::Every)
    }

    fn detail(self) -> ContactDetail {
        if self == Self::Every { ContactDetail::Every } else { ContactDetail::default() }
    }

    fn having(self, contact_set: ContactSet, detail: ContactDetail) -> Dispatcher {
        let mut config = SbbkConfig::default();
        match self {
            Self::Stock => {
                return Dispatcher { shared: Arc::new(DefaultQueryDispatcher), sbbk: None };
            }
            Self::AabbOnly => config = SbbkConfig::aabb_only(),
            Self::Sbbk | Self::Every => {}
        }
        (config.contact_set, config.detail) = (contact_set, detail);
        let sbbk = SbbkDispatcher::new(config);
        Dispatcher { shared: Arc::new(sbbk.clone()), sbbk: Some(sbbk) }
    }

    /// Makes a fresh, timed dispatcher the one that answers `world`'s narrow phase. It is
    /// [`primed`](Primed) with the meshes that are in the world.
    pub fn install(self, world: &mut PhysicsWorld) -> Installed {
        let (dispatcher, probe) = (self.dispatcher(), Probe::default());
        let shapes = world.colliders.iter().map(|(_, collider)| collider.shared_shape());
        let primed = Primed::new(&dispatcher, shapes);
        world.narrow_phase.set_query_dispatcher(Timed::new(dispatcher.shared, probe.clone()));
        Installed { probe, primed }
    }
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.to_possible_value().expect("none is hidden").get_name())
    }
}

/// What [`Backend::install`] put into a world.
pub struct Installed {
    /// Times and answers of the world's own queries.
    pub probe: Probe,
    /// Keeps the trees from being dropped while nothing touches.
    pub primed: Primed,
}
