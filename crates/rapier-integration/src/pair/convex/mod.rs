//! A mesh and convex shapes: one, or the parts of a compound or a polyline.
//!
//! * [`shape`], [`parts`]: Parry's shapes, with bounds and poses.
//! * [`near`]: descends Parry's BVH of the mesh with the box of a part in the frame of the part.
//! * [`contact`]: the exact contact of a triangle and a part.
//! * [`triangle_part`], [`points`]: write a contact to a manifold. [`half_space`]: contacts with a
//!   half-space.
//! * [`pair`]: a mesh and its parts. [`query`]: the contact query.
//! * [`ghosts`], [`internal_edges`]: correct contacts at internal edges. [`walls`]: removes
//!   contacts with walls that are not in the way. [`push_out`]: moves parts out of solids.
//! * [`search`], [`cast`]: queries without manifolds.

mod cast;
mod contact;
mod ghosts;
mod half_space;
mod internal_edges;
mod near;
mod pair;
mod parts;
mod points;
mod push_out;
mod query;
mod search;
mod shape;
mod triangle_part;
mod walls;

pub(crate) use near::lowest;
pub(crate) use pair::ConvexPair;
pub(crate) use parts::{Parts, PlacedPart};
pub(crate) use search::{ConvexSearch, FoundTriangle, WIDE};
pub(crate) use shape::ConvexShape;
