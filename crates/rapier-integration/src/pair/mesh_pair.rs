//! A mesh and another mesh or a height field.
//!
//! Stock Parry finds no contacts of a mesh and a height field. Triangles of a field have the numbers that Parry gives them in
//! contacts with convex shapes.
//!
//! # Edits
//!
//! A pair keeps candidates, and Rapier drops them when a shape was edited. For hosts that do not,
//! another field, scale or flag is noticed at once. A removed triangle is noticed when the pair moves, and an added one at the
//! next descent.

use std::sync::OnceLock;

use sbbk_core::surface::Side;
use sbbk_core::tree::Tree;

use super::field::{Field, FieldToken};
use super::inside::{HeldMesh, InsideTest};
use super::pose::PairPose;
use super::query::Pair;
use super::reduce::PatchPlan;
use super::triangle_shape::{FieldShape, MeshShape, Room, TriangleShape};
use super::triangle_shapes::{Hint, TriangleShapes, filter_distance};
use super::triangles::TriangleQuery;
use crate::SbbkConfig;
use crate::mesh::{Change, LazySurface, MeshView, PairMesh, use_trees};

/// A mesh and another mesh or a height field.
#[derive(Copy, Clone)]
pub(crate) struct MeshPair<'a> {
    pub(crate) pose: &'a PairPose,
    pub(crate) shapes: [ShapeView<'a>; 2],
    pub(crate) config: &'a SbbkConfig,
}

/// A shape during one query.
#[derive(Copy, Clone)]
pub(crate) enum ShapeView<'a> {
    Mesh(MeshView<'a>),
    Field(Field<'a>),
}

/// A pair's knowledge of one of its shapes, which is a mesh or a field.
#[derive(Clone, Default)]
pub(crate) struct KnownShape {
    mesh: PairMesh,
    field: Option<FieldToken>,
}

impl KnownShape {
    /// Compares with the shape of the last query, and stores the one of this query.
    fn update(&mut self, shape: &ShapeView<'_>) -> Change {
        let field = match shape {
            ShapeView::Mesh(mesh) => {
                self.field = None;
                return self.mesh.update(mesh);
            }
            ShapeView::Field(field) => FieldToken::of(field.0),
        };
        self.mesh = PairMesh::default();
        match self.field.replace(field) {
            None => Change::Unknown,
            Some(known) if known == field => Change::Unchanged,
            Some(_) => Change::Replaced,
        }
    }
}

impl MeshPair<'_> {
    /// Returns true for two meshes that use trees.
    fn needs_trees(&self) -> bool {
        let [ShapeView::Mesh(one), ShapeView::Mesh(two)] = &self.shapes else { return false };
        use_trees([one.mesh, two.mesh])
    }

    /// Returns true if no shape can change while its token stays.
    fn are_rigid(&self) -> bool {
        self.shapes.iter().all(|shape| match shape {
            ShapeView::Mesh(mesh) => mesh.is_rigid(),
            ShapeView::Field(_) => true,
        })
    }

    /// Returns true for contacts of surfaces.
    fn has_surfaces(&self) -> bool {
        self.config.has_surfaces() && self.are_rigid()
    }

    /// Returns a shape with its tree, if there is one. Meshes get trees for each other.
    fn opened<'q>(
        &self,
        shape: &'q ShapeView<'q>,
        known: &'q mut KnownShape,
    ) -> (TriangleShape<'q>, Option<&'q Tree>) {
        let has_surfaces = self.has_surfaces();
        match shape {
            ShapeView::Mesh(view) => {
                let needs_trees = self.needs_trees();
                let is_needed = has_surfaces || needs_trees && self.are_rigid();
                let surface = is_needed.then(|| known.mesh.acquire(view, needs_trees)).flatten();
                let tree = surface.as_ref().and_then(LazySurface::tree).filter(|_| needs_trees);
                let surface = surface.filter(|_| has_surfaces);
                (TriangleShape::Mesh(MeshShape { view, surface, room: Room::No }), tree)
            }
            ShapeView::Field(field) => {
                let is_solid = self.config.solid_height_fields && field.points_up();
                let side = if is_solid { Side::Outer } else { Side::Sheet };
                let side = has_surfaces.then_some(side);
                (TriangleShape::Field(FieldShape { field: *field, side, cone: None }), None)
            }
        }
    }
}

impl<'a> Pair for MeshPair<'a> {
    /// The shapes, whether one is a room for the other, and whether one is inside the other.
    type State = ([KnownShape; 2], [InsideTest; 2]);
    type Hint = Hint;
    type Query<'q>
        = TriangleQuery<'q>
    where
        Self: 'q;

    fn pose(&self) -> &PairPose {
        self.pose
    }

    fn update(&self, ([known1, known2], tests): &mut Self::State) -> Change {
        let [shape1, shape2] = &self.shapes;
        let change = known1.update(shape1).max(known2.update(shape2));
        if change != Change::Unchanged {
            *tests = Default::default();
        }
        change
    }

    fn open<'q>(
        &'q self,
        ([known1, known2], [in_room, inside]): &'q mut Self::State,
    ) -> TriangleQuery<'q> {
        let [shape1, shape2] = &self.shapes;
        let (shape1, tree1) = self.opened(shape1, known1);
        let (shape2, tree2) = self.opened(shape2, known2);
        let radius = shape1.ball().radius.min(shape2.ball().radius);
        let mut shapes = TriangleShapes {
            pose: self.pose,
            larger: usize::from(shape1.size_squared() < shape2.size_squared()),
            shapes: [shape1, shape2],
            trees: tree1.zip(tree2).map(<[_; 2]>::from),
            filter_distance: filter_distance(self.has_surfaces(), radius),
            reach: OnceLock::new(),
            over_sheets: Default::default(),
        };
        let room = HeldMesh::of(&shapes).map_or(Room::No, |mesh| mesh.room(in_room));
        if let TriangleShape::Mesh(mesh) = &mut shapes.shapes[shapes.larger] {
            mesh.room = room;
        }
        let has_patches = self.config.has_patches() && self.are_rigid();
        let patches = has_patches.then(|| PatchPlan::new(self.pose.prediction, radius));
        TriangleQuery { shapes, patches, in_room, inside }
    }
}
