use std::cell::RefCell;
use std::sync::Arc;

use parry3d::math::{Pose, Real};
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace};
use parry3d::shape::{HeightField, TriMesh};
use sbbk_core::contact::FeaturePair;
use sbbk_core::field::{FieldFrame, FieldScratch, descend_field};
use sbbk_core::traverse::{Counters, GREATEST_SLACK, Placement};
use sbbk_core::volumes::Aabb;

use super::field::{Field, FieldToken};
use super::shapes::MeshAndField;
use crate::ContactGenerator;
use crate::mesh::{Change, Held, KnownMesh, PreparedMesh, TreeCache, root_box};
use crate::pair::candidates::{Candidate, Scratch};
use crate::pair::coherence::{Coherence, Plan};
use crate::pair::manifolds::{Generator, TriangleShapes};
use crate::pair::state::{PairKind, PairState, state_in};
use crate::pair::{Answer, Question};

/// The question: which contacts do a mesh and a height field have?
#[derive(Copy, Clone)]
pub(crate) struct FieldPair<'a> {
    /// The pose of shape 2 in the frame of shape 1.
    pub(crate) pos12: &'a Pose,
    pub(crate) mesh: &'a TriMesh,
    pub(crate) field: &'a HeightField,
    /// Whether the mesh is shape 2.
    pub(crate) flipped: bool,
    pub(crate) prediction: Real,
    pub(crate) contacts: ContactGenerator,
}

/// A mesh and a height field, as a kind of pair.
#[derive(Clone)]
struct MeshAndHeightField;

impl PairKind for MeshAndHeightField {
    type Shapes = KnownShapes;
    type Candidate = Candidate;
    type Contact = FeaturePair;
}

/// The mesh, as far as it is known, and the field that the candidates are for.
type KnownShapes = (KnownMesh, Option<FieldToken>);

thread_local! {
    static SCRATCH: RefCell<(FieldScratch, Scratch)> = RefCell::default();
}

impl<'a> FieldPair<'a> {
    /// The mesh in the frame of the field, and shape 2 in the frame of shape 1.
    fn placements(&self) -> [Placement; 2] {
        let placement = Placement::new(self.pos12);
        [if self.flipped { placement } else { placement.inverted() }, placement]
    }

    /// Whether the box around the mesh meets the ground. Asked before there is a tree.
    fn root_box_meets(&self, mesh_at: &Placement, counters: impl Counters) -> bool {
        let Some(root) = root_box(self.mesh) else {
            return true;
        };
        let field = Field(self.field);
        let frame = FieldFrame::new(&field, mesh_at, self.prediction);
        frame.meets(&Aabb { min: root.mins, max: root.maxs }, counters)
    }

    /// The tree of the mesh, from the state if it is known and still valid.
    fn tree<'s, M, C: Default + Copy>(
        &self,
        cache: &Arc<TreeCache>,
        (known, known_field): &'s mut KnownShapes,
        coherence: &mut Coherence<Candidate>,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) -> Option<Held<'s>> {
        let (mut change, tree) = cache.noting(self.mesh, known.update(self.mesh, cache))?;
        let field = FieldToken::of(self.field);
        if known_field.replace(field).is_some_and(|known| known != field) {
            change = Change::Replaced;
        }
        coherence.follow(change, manifolds);
        Some(tree)
    }

    /// Fills `scratch.candidates` with all pairs of triangles within the margin, and few others, in order.
    fn collect(
        &self,
        (prepared, shapes): (&PreparedMesh, &MeshAndField<'a>),
        (mesh_at, margin): (&Placement, Real),
        counters: impl Counters,
        (descent, scratch): (&mut FieldScratch, &mut Scratch),
    ) {
        let field = Field(self.field);
        let candidates = &mut scratch.candidates;
        candidates.clear();
        let frame = FieldFrame::new(&field, mesh_at, margin);
        descend_field(&prepared.tree, &frame, descent, counters, |triangle, of_mesh| {
            if prepared.is_broken(of_mesh) {
                return;
            }
            let triangles = shapes.ordered([of_mesh, field.id(triangle)]);
            candidates.push(Candidate::new(shapes.key(triangles), triangles));
        });
        candidates.sort_unstable_by_key(|candidate| candidate.key);
    }
}

impl Question for FieldPair<'_> {
    fn contact_manifolds<M, C>(
        self,
        cache: &Arc<TreeCache>,
        mut counters: impl Counters,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Answer
    where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        if cache.is_unsupported(&[self.mesh]) {
            return Answer::Unsupported;
        }
        let PairState::<_, _, MeshAndHeightField> { shapes: known, coherence, history } =
            state_in(workspace, manifolds);
        let [mesh_at, placement] = self.placements();
        if known.0.is_unknown() && !self.root_box_meets(&mesh_at, &mut counters) {
            manifolds.clear();
            return Answer::Apart;
        }
        let Some(prepared) = self.tree(cache, known, coherence, manifolds) else {
            return Answer::Unsupported;
        };
        let prepared = &*prepared;
        let ball = prepared.tree.bounding_ball();
        let plan = coherence.plan(ball, (self.pos12, mesh_at), self.prediction, GREATEST_SLACK);
        if plan == Plan::Nothing && history.is_of(manifolds) {
            return Answer::Unchanged;
        }
        let margin = match plan {
            Plan::Descend { margin } | Plan::Reuse { margin } => margin,
            Plan::Nothing => self.prediction,
        };
        let shapes = MeshAndField::new((self.mesh, prepared), Field(self.field), !self.flipped);
        SCRATCH.with_borrow_mut(|(descent, scratch)| {
            if let Plan::Reuse { .. } = plan {
                coherence.near(self.prediction, &mut scratch.candidates);
            } else {
                let found = (prepared, &shapes);
                self.collect(found, (&mesh_at, margin), &mut counters, (descent, scratch));
            }
            let generator = Generator {
                shapes,
                pos12: self.pos12,
                placement: &placement,
                margin,
                prediction: self.prediction,
                parrys_pose: *self.pos12,
                contacts: self.contacts,
            };
            generator.update(scratch, coherence, history, manifolds);
        });
        match plan {
            Plan::Reuse { .. } => Answer::Reused,
            Plan::Nothing | Plan::Descend { .. } => Answer::Descended,
        }
    }
}
