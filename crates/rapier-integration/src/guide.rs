#![doc = include_str!("../guide.md")]
//!
//! ## With a dispatcher of your own
//!
//! Put your dispatcher before [`SbbkDispatcher`](crate::SbbkDispatcher), which handles every pair
//! that Parry can:
//!
//! ```
//! use rapier3d::parry::math::{Pose, Real, Vector};
//! use rapier3d::parry::query::details::{NormalConstraints, ShapeCastOptions};
//! use rapier3d::parry::query::*;
//! use rapier3d::parry::shape::{Ball, Shape};
//! use rapier_integration::SbbkDispatcher;
//!
//! /// Lets balls pass through balls, and handles no other pairs.
//! struct Ghosts;
//!
//! fn ghosts(g1: &dyn Shape, g2: &dyn Shape) -> Result<(), Unsupported> {
//!     if g1.as_ball().is_some() && g2.as_ball().is_some() { Ok(()) } else { Err(Unsupported) }
//! }
//!
//! impl<M, C> PersistentQueryDispatcher<M, C> for Ghosts {
//!     fn contact_manifolds(
//!         &self,
//!         _: &Pose,
//!         g1: &dyn Shape,
//!         g2: &dyn Shape,
//!         _: Real,
//!         manifolds: &mut Vec<ContactManifold<M, C>>,
//!         _: &mut Option<ContactManifoldsWorkspace>,
//!     ) -> Result<(), Unsupported> {
//!         ghosts(g1, g2).map(|()| manifolds.clear())
//!     }
//!
//!     fn contact_manifold_convex_convex(
//!         &self,
//!         _: &Pose,
//!         _: &dyn Shape,
//!         _: &dyn Shape,
//!         _: Option<&dyn NormalConstraints>,
//!         _: Option<&dyn NormalConstraints>,
//!         _: Real,
//!         _: &mut ContactManifold<M, C>,
//!     ) -> Result<(), Unsupported> {
//!         Err(Unsupported)
//!     }
//! }
//!
//! type Answer<T> = Result<T, Unsupported>;
//! type Motion = NonlinearRigidMotion;
//!
//! impl QueryDispatcher for Ghosts {
//!     fn intersection_test(&self, _: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Answer<ShapeIntersection> {
//!         ghosts(g1, g2).map(|()| ShapeIntersection::new(false))
//!     }
//!
//!     fn distance(&self, _: &Pose, _: &dyn Shape, _: &dyn Shape) -> Answer<ShapeDistance> {
//!         Err(Unsupported)
//!     }
//!
//!     fn contact(&self, _: &Pose, _: &dyn Shape, _: &dyn Shape, _: Real) -> Answer<Option<Contact>> {
//!         Err(Unsupported)
//!     }
//!
//!     fn closest_points(&self, _: &Pose, _: &dyn Shape, _: &dyn Shape, _: Real) -> Answer<ClosestPoints> {
//!         Err(Unsupported)
//!     }
//!
//!     fn cast_shapes(
//!         &self, _: &Pose, _: Vector, _: &dyn Shape, _: &dyn Shape, _: ShapeCastOptions,
//!     ) -> Answer<Option<ShapeCastHit>> {
//!         Err(Unsupported)
//!     }
//!
//!     fn cast_shapes_nonlinear(
//!         &self, _: &Motion, _: &dyn Shape, _: &Motion, _: &dyn Shape, _: Real, _: Real, _: bool,
//!     ) -> Answer<Option<ShapeCastHit>> {
//!         Err(Unsupported)
//!     }
//! }
//!
//! let dispatcher = Ghosts.chain(SbbkDispatcher::default());
//! let (ball, at) = (Ball::new(1.0), Pose::translation(0.5, 0.0, 0.0));
//! assert!(!dispatcher.intersection_test(&at, &ball, &ball)?.intersecting);
//! assert_eq!(dispatcher.distance(&Pose::translation(3.0, 0.0, 0.0), &ball, &ball)?.distance, 1.0);
//! # Ok::<(), Unsupported>(())
//! ```
