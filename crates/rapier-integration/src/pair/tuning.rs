//! The numbers that choose contacts and patches. They do not depend on the unit of length.
//!
//! A sweep in `docs/measurements.md` halves and doubles each number. Hardly any random scene depends
//! on it. So three numbers, [`HALF`], [`QUARTER`] and [`TENTH`], serve most purposes, and a purpose
//! has its own number only where tests need one. Numbers that bound rounding, memory or time stand
//! where they are used.

use parry3d::math::Real;

/// Share of a whole that counts as most of it.
const HALF: f64 = 0.5;

/// Share of a length that is little beside it.
const QUARTER: f64 = 0.25;

/// Share of a length that hardly counts beside it.
const TENTH: f64 = 0.1;

// Angles, as cosines.

/// Least cosine of two normals of one direction, and of one patch. Higher: more points, and nested
/// bowls are less calm. Lower: gears lose speed.
pub(super) const SAME_DIRECTION: f64 = 0.99;

/// Least cosine of the normal of a far contact and of a direction in which it counts, or of a patch
/// that it joins. Higher: thin plates with soft CCD turn through sheets. Lower: small bodies are
/// stopped by triangles ahead.
pub(super) const SAME_FAR_DIRECTION: f64 = 0.97;

/// Least cosine between the normal of a [`DISTANT`] contact and both triangle normals. Higher:
/// smooth bodies lose contacts; lower: gears are braked. Also least cosine of the normals of a
/// contact and of one that it [hovers](HOVER) beside. Higher: more points in piles at rest; lower:
/// contacts about to touch are left out.
pub(super) const NEAR_NORMAL: f64 = 0.9;

/// Cosine above which two normals push to one side. Higher: bodies that pierce a solid are held in
/// it. Lower: contacts that do not push against each other are rejected, and bodies stumble over
/// walls within a mesh.
pub(super) const SAME_SIDE: f64 = HALF;

// Lengths in prediction distances.

/// Greatest depth of points in prediction distances, at least. Rapier recycles contacts until
/// bodies have moved by 2.5. Higher: bodies that are deep leave faster; lower: they fall asleep
/// inside.
pub(super) const DEEPEST: f64 = 4.0;

/// Least depth of the lowest point of a body in a room, in prediction distances or, if less, in
/// tenths of its radius. Higher: thin bodies fall out of rooms. Lower: thin bodies sink into
/// solids.
pub(super) const ROOM_DEPTH: f64 = HALF;

/// Depth, in prediction distances, up to which a part counts as above the face at a border. Higher:
/// rims do not carry what overhangs them. Lower: fast bodies stumble where meshes meet.
pub(super) const BORDER_DEPTH: f64 = HALF;

/// Depth up to which a shape counts as above the plane of a border triangle, in filter units.
/// Higher: rims do not carry what overhangs them. Lower: bodies stumble where meshes meet.
pub(super) const LIP: f64 = QUARTER;

/// Distance in prediction distances beyond which a contact of edges or vertices needs a normal near
/// both triangle normals. Higher: gears are braked by edges that pass each other; lower: edges meet
/// with less warning.
pub(super) const DISTANT: f64 = QUARTER;

/// Greatest depth of resting bodies, in filter distances: a fortieth of the radius. Higher: bodies
/// deep in others leave along one way. Lower: heavy bodies stop at gaps.
pub(super) const RESTING_DEPTH: f64 = QUARTER;

/// Greatest distance of a contact that belongs to a patch of another direction. Higher: more
/// points; lower: bodies in motion come deeper into others.
pub(super) const HOVER: Real = TENTH as Real;

/// Difference of depth below which points count as equally deep. Higher: points that hover replace
/// points that carry, and bodies rock; lower: thin plates turn through what they hit.
pub(super) const EQUAL_DEPTH: Real = 0.02;

/// Radius, in prediction distances, below which a convex shape is small. Small shapes turn far in a
/// step, so [`EQUAL_DEPTH`] grows with the square of their ratio, up to the size of a patch.
/// Higher: cones on uneven ground stay awake. Lower: coins stand on one arc of the rim, and turn
/// through floors.
pub(super) const SMALL_RADIUS: Real = 20.0;

/// Greatest half thickness of a thin body, in the units of [`LIP`]. Higher: bodies fall through
/// sheets that face away from them. Lower: rods and plates sink through sheets.
pub(super) const THIN: f64 = TENTH;

// Lengths in radii or sizes of a shape.

/// Filter distance in radii of the smaller shape. Higher: plates that soft CCD sees turn through
/// what they meet; lower: small bodies keep contacts at internal edges.
pub(super) const FILTERED: Real = TENTH as Real;

/// Greatest reach of fine meshes in filter distances: 0.04 radii. A body of one length unit has a
/// radius of half a unit, and Rapier predicts 0.02 units by default. Higher: fine meshes cost more;
/// lower: bodies come deeper into others before they meet.
pub(super) const REACH: f64 = 0.4;

/// Least reach of fine meshes in filter distances: 0.01 radii. Higher: fine meshes cost more;
/// lower: bodies turn and sink where they are pressed together.
pub(super) const LEAST_REACH: f64 = TENTH;

/// Reach of fine meshes in sizes of their triangles. Higher: each triangle is near more others.
/// Lower: meshes of a few thousand triangles have contacts late.
pub(super) const REACH_PER_TRIANGLE: f64 = QUARTER;

/// Size of a patch in radii of the smaller shape. Higher: legs of a table are left out; lower: a
/// flat side is many patches, and points that move lose their data.
pub(super) const PATCH_SIZE: Real = 0.2;

/// Greatest depth of a body's middle behind the front of a sheet, in half heights of the body, at
/// which its side is sure. Higher: thin bodies from behind are pulled through; lower: contacts hold
/// bodies that hit a ground fast halfway through it.
pub(super) const SURE_SIDE: f64 = QUARTER;

/// Greatest depth of a body's middle behind the front of a surface that holds the body in front, in
/// half heights of the body. A room holds a body that sticks out as far. Higher: bodies deep in a
/// solid stay there, and bodies from behind are pulled through sheets. Lower: fast bodies fall
/// through open floors and the floors of rooms.
pub(super) const STICKS_OUT: Real = HALF as Real;

/// Least height of a room, in the second longest side of its mesh. Higher: bodies fall out of low
/// halls. Lower: small fast bodies fall through floors and walls that are solids.
pub(super) const SLAB: Real = TENTH as Real;

// Shares.

/// The reach by triangle size is used if it is below this share of the other reach. Higher: far
/// contacts take more time than the smaller reach saves. Lower: fine meshes cost more.
pub(super) const MUCH_LESS: f64 = 1.0 - QUARTER;

/// Share of the depth of the deepest point that counts like [`EQUAL_DEPTH`] where points are
/// chosen. Higher: points that hover replace points that carry. Lower: thin discs stand on one arc
/// of the rim, and turn through floors.
pub(super) const DEPTH_SHARE: Real = HALF as Real;

/// Share of the direction out of two triangles in the direction of their contact, if the contour of
/// the overlap is not flat. Higher: bodies that are deep in each other are pushed aside. Lower:
/// heavy loads press bodies deeper.
pub(super) const OUTWARD: f64 = QUARTER;

/// Ratio of lengths up to which triangles are parted as an overlap is. Higher: walls beside a floor
/// let go. Lower: edges that cross push each other aside.
pub(super) const ALIKE: f64 = 1.0 + TENTH;

/// Least area vector of a contour, as a share of the area that its segments sweep around the
/// middle. Higher: bodies that hook into each other keep the contacts of their triangles. Lower:
/// contours push nowhere.
pub(super) const COHERENT: f64 = HALF;

/// Greatest depth behind a contour, as a share of its length. Higher: pins are pushed back all
/// their way. Lower: bodies deep in others turn and sink.
pub(super) const DEPTH_PER_LENGTH: f64 = HALF;

/// Greatest gap of a closed contour, as a share of its length. Higher: contours that leave a sheet
/// at its border are closed. Lower: surfaces with small gaps have none, so bodies deep in others
/// stay.
pub(super) const OPEN: f64 = TENTH;

/// Greatest distance of a flat contour from its plane, as a share of its length. Higher: contours
/// around edges are flat. Lower: rounding makes flat faces uneven.
pub(super) const UNEVEN: f64 = 1e-3;

/// An end of an edge counts if its distance from the border exceeds the least one by less than this
/// share. Higher: rods that stick out over a cliff are held up. Lower: rods that roll over a border
/// turn.
pub(super) const ALONG_BORDER: f64 = QUARTER;

/// Greatest depth along the normal of a face, as a share of the height of the part, that never
/// shows a part beyond the face. Higher: shapes over an edge of a box are pushed in. Lower: tips
/// stumble over internal edges.
pub(super) const HARDLY_BEHIND: f64 = TENTH;
