//! A mesh and a height field.
//!
//! Stock Parry finds no contacts here. The descent visits Parry's BVH of the mesh and reads the
//! cells under it ([`sbbk_core::field`]).
//!
//! Triangles of the field have the numbers that Parry gives them in contacts with convex shapes.
//!
//! Contacts of a rigid mesh are those of both surfaces. The surface of the field is read from the
//! grid ([`Field`]).
//!
//! # Edits
//!
//! A pair keeps candidates, and Rapier drops them when a shape was edited. For hosts that do not,
//! another field, scale, flag, or a removed triangle is noticed at once. An added triangle is
//! noticed at the next descent.

use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, PoisonError};

use glamx::DVec3;
use parry3d::math::{Real, Vector};
use parry3d::query::details::NormalConstraints;
use parry3d::shape::{HeightField, Triangle, TrianglePseudoNormals};
use sbbk_core::contact::Feature;
use sbbk_core::field::{FieldFrame, FieldLeaves};
use sbbk_core::surface::{Around, Facets, NormalCones, PlaceMemo, Side, SurfaceKind};
use sbbk_core::traverse::{DescentCounts, Placement};
use sbbk_core::tree::{BATCH, LeafBatch};

use super::far::MOST_PAIRS;
use super::field::{Field, FieldToken};
use super::pose::{MeshPlace, PairPose};
use super::query::{Moving, Pair};
use super::ranges::{filter_distance, reach};
use super::reduce::PatchPlan;
use super::state::Candidate;
use super::triangle_shapes::{Cones, DescentMemory, Hint, TriangleShape, TriangleShapes};
use super::triangles::TriangleQuery;
use crate::SbbkConfig;
use crate::mesh::{Change, LazySurface, MeshFacets, MeshStore, MeshView, PairMesh};

/// A mesh and a height field.
#[derive(Copy, Clone)]
pub(crate) struct FieldPair<'a> {
    pub(crate) pose: &'a PairPose,
    pub(crate) mesh: MeshView<'a>,
    pub(crate) field: &'a HeightField,
    pub(crate) mesh_place: MeshPlace,
    pub(crate) config: &'a SbbkConfig,
}

impl FieldPair<'_> {
    /// The mesh in the frame of the field.
    fn mesh_placement(&self) -> &Placement {
        self.mesh_place.placements(self.pose)[0]
    }

    /// Returns true if few pairs of triangles may be within the prediction distance.
    fn are_few(&self) -> bool {
        let PairPose { pos12, prediction, .. } = self.pose;
        let around = self.mesh.placed_root(&self.mesh_place.mesh_in_shape(pos12), *prediction);
        let of_mesh = self.mesh.mesh.indices().len() as f64;
        of_mesh * Field(self.field).count_under(&around) <= MOST_PAIRS as f64
    }
}

impl<'a> Pair for FieldPair<'a> {
    /// The mesh, and the field that the candidates are for.
    type State = (PairMesh, Option<FieldToken>);
    type Hint = Hint;
    type Query<'q>
        = TriangleQuery<'q, MeshAndField<'q>>
    where
        Self: 'q;

    fn open<'q>(
        &'q self,
        _: &'q Arc<MeshStore>,
        (known_mesh, known_field): &'q mut Self::State,
    ) -> (Change, Self::Query<'q>) {
        let mut change = known_mesh.update(&self.mesh);
        let field = FieldToken::of(self.field);
        if known_field.replace(field).is_some_and(|known| known != field) {
            change = Change::Replaced;
        }
        let radius = self.mesh.ball().radius;
        let prediction = self.pose.prediction;
        let has_surfaces = self.config.has_surfaces();
        let surface = has_surfaces.then(|| known_mesh.acquire(&self.mesh, false)).flatten();
        let filter_distance = filter_distance(surface.is_some(), radius);
        let shapes = MeshAndField {
            pair: self,
            field: Field(self.field),
            filter_distance,
            reach: reach(prediction, filter_distance, || self.are_few()),
            surface,
            cone: Mutex::new((u32::MAX, None)),
        };
        let query = TriangleQuery {
            shapes,
            pose: self.pose,
            patches: (self.config.has_patches() && self.mesh.is_rigid())
                .then(|| PatchPlan::new(prediction, radius)),
        };
        (change, query)
    }
}

/// A mesh and a height field.
pub(crate) struct MeshAndField<'q> {
    pair: &'q FieldPair<'q>,
    field: Field<'q>,
    /// Surface of the mesh, for contacts of surfaces.
    surface: Option<LazySurface<'q>>,
    filter_distance: f64,
    reach: Real,
    /// Normal cone of one triangle of the field. Contacts of a triangle follow each other, and
    /// Parry computes the cone from four triangles.
    cone: Mutex<(u32, Option<TrianglePseudoNormals>)>,
}

/// The triangles of either.
pub(crate) enum MeshOrField<'a> {
    Mesh(MeshFacets<'a>),
    Field(Field<'a>),
}

impl Facets for MeshOrField<'_> {
    fn twin(&self, half_edge: u32) -> Option<u32> {
        match self {
            Self::Mesh(mesh) => mesh.twin(half_edge),
            Self::Field(field) => field.twin(half_edge),
        }
    }

    fn is_whole(&self, triangle: u32, feature: Feature) -> bool {
        match self {
            Self::Mesh(mesh) => mesh.is_whole(triangle, feature),
            Self::Field(field) => field.is_whole(triangle, feature),
        }
    }

    fn near(&self, corners: [DVec3; 2], visit: &mut dyn FnMut(u32) -> ControlFlow<()>) {
        match self {
            Self::Mesh(mesh) => mesh.near(corners, visit),
            Self::Field(field) => field.near(corners, visit),
        }
    }

    fn cones(&self, triangle: u32) -> NormalCones {
        match self {
            Self::Mesh(mesh) => mesh.cones(triangle),
            Self::Field(field) => field.cones(triangle),
        }
    }

    fn memo(&self) -> Option<&PlaceMemo> {
        match self {
            Self::Mesh(mesh) => mesh.memo(),
            Self::Field(_) => None,
        }
    }

    fn corner(&self, half_edge: u32, i: usize) -> DVec3 {
        match self {
            Self::Mesh(mesh) => mesh.corner(half_edge, i),
            Self::Field(field) => field.corner(half_edge, i),
        }
    }
}

impl MeshAndField<'_> {
    fn is_field(&self, i: usize) -> bool {
        (i == 1) != self.pair.mesh_place.is_second()
    }
}

impl TriangleShapes for MeshAndField<'_> {
    type Facets<'f>
        = MeshOrField<'f>
    where
        Self: 'f;

    fn moving(&self) -> Moving<'_> {
        Moving { ball: self.pair.mesh.ball(), placement: self.pair.mesh_placement() }
    }

    fn descend(
        &self,
        margin: Real,
        counts: &mut DescentCounts,
        memory: &mut DescentMemory,
        found: &mut Vec<Candidate<Hint>>,
    ) {
        let mesh = &self.pair.mesh;
        let frame = FieldFrame::new(&self.field, self.pair.mesh_placement(), margin);
        let leaves = FieldLeaves::new(&frame, mesh.ball().centre, mesh.magnitude());
        let near = &mut memory.near;
        near.clear();
        let _ = mesh.near(
            |node| frame.meets(node, ()),
            |triangle| {
                near.push(triangle);
                ControlFlow::Continue(())
            },
        );
        for triangles in near.chunks(BATCH) {
            let batch = LeafBatch::gather(triangles, |triangle| mesh.corners(triangle));
            leaves.visit(&batch, &mut *counts, |triangle, of_mesh| {
                let pair = [of_mesh, self.field.id(triangle)];
                found.push(Candidate::new(self.pair.mesh_place.swap(pair)));
            });
        }
    }

    #[inline(always)]
    fn corners(&self, triangles: [u32; 2]) -> Option<[[Vector; 3]; 2]> {
        let place = self.pair.mesh_place;
        let [mesh, field] = place.swap(triangles);
        let Triangle { a, b, c } = self.field.triangle(field)?;
        Some(place.swap([self.pair.mesh.corners(mesh), [a, b, c]]))
    }

    fn separation(&self) -> Option<DVec3> {
        let of_mesh = usize::from(self.is_field(0));
        self.way_out(self.pair.pose, of_mesh, self.pair.mesh.ball().centre)?.try_normalize()
    }

    fn with_cones(&self, triangles: [u32; 2], then: impl FnOnce(Cones<'_>)) {
        let place = self.pair.mesh_place;
        let [mesh, field] = place.swap(triangles);
        let of_mesh = self.pair.mesh.mesh.triangle_normal_constraints(mesh);
        let cone = &mut *self.cone.lock().unwrap_or_else(PoisonError::into_inner);
        if cone.0 != field {
            *cone = (field, self.field.0.triangle_normal_constraints(field));
        }
        let cones = [of_mesh.as_ref(), cone.1.as_ref()];
        then(place.swap(cones).map(|cone| cone.map(|cone| cone as &dyn NormalConstraints)));
    }

    fn surface(&self, i: usize, triangle: u32) -> Option<Around<MeshOrField<'_>>> {
        let surface = self.surface.as_ref()?;
        if self.is_field(i) {
            let side = if self.is_solid(i) { Side::Outer } else { Side::Sheet };
            return Some(Around { facets: MeshOrField::Field(self.field), side });
        }
        let Around { facets, side } = surface.around(triangle);
        Some(Around { facets: MeshOrField::Mesh(facets), side })
    }

    fn shape(&self, i: usize) -> TriangleShape<'_> {
        if self.is_field(i) {
            TriangleShape::Field(self.field)
        } else {
            TriangleShape::Mesh(&self.pair.mesh, self.surface.as_ref())
        }
    }

    fn is_solid(&self, i: usize) -> bool {
        if self.is_field(i) {
            return self.pair.config.solid_height_fields && self.field.points_up();
        }
        self.surface.as_ref().is_some_and(|surface| surface.kind() == SurfaceKind::Solid)
    }

    fn filter_distance(&self) -> f64 {
        self.filter_distance
    }

    fn reach(&self) -> Real {
        self.reach
    }
}
