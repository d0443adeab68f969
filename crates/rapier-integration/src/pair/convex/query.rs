use std::cell::RefCell;
use std::sync::Arc;

use parry3d::bounding_volume::BoundingVolume;
use parry3d::math::{Pose, Real};
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace};
use parry3d::shape::{CompoundPseudoNormals, TriMesh};
use sbbk_core::leaf::ProbeTest;
use sbbk_core::traverse::{
    Convex, Counters, Placement, Probe, ProbeScratch, Verdict, descend_probe,
};
use sbbk_core::volumes::rounding::gamma;

use super::contacts::{Generator, Limits, NearTriangle};
use super::shape::{ConvexShape, Fingerprint, Kind};
use crate::mesh::{Change, Held, KnownMesh, PreparedMesh, TreeCache, root_box};
use crate::pair::candidates::OrderKey;
use crate::pair::coherence::{Coherence, KnownCandidate, Plan};
use crate::pair::state::{History, PairKind, PairState, state_in};
use crate::pair::{Answer, Question};

/// The question: which contacts do a mesh and a convex shape have?
#[derive(Copy, Clone)]
pub(crate) struct ConvexPair<'a> {
    /// The pose of shape 2 in the frame of shape 1.
    pub(crate) pos12: &'a Pose,
    pub(crate) mesh: &'a TriMesh,
    pub(crate) shape: ConvexShape<'a>,
    /// The cones that contact normals of the shape must be in.
    pub(crate) cone: Option<&'a CompoundPseudoNormals>,
    /// Whether the mesh is shape 2.
    pub(crate) flipped: bool,
    pub(crate) prediction: Real,
    /// `pos12` as stock passes it on, bit for bit.
    pub(crate) parrys_pose: Pose,
}

/// A mesh and a convex shape, as a kind of pair.
#[derive(Clone)]
struct MeshAndConvex;

impl PairKind for MeshAndConvex {
    type Shapes = KnownShapes;
    type Candidate = NearTriangle;
    type Contact = ();
}

/// The mesh, as far as it is known, and the shape that the candidates are for.
type KnownShapes = (KnownMesh, Option<Fingerprint>);

/// Parry's GJK ends when it knows a distance, radii not counted, to this share; it calls triangles that are so much
/// beyond the prediction distance contacts as well. Looking for them makes the contacts those of a test of all
/// triangles.
const GJK_TOLERANCE: Real = 1.2e-3;

/// Greatest slack of candidates as a share of the prediction distance. A candidate out of reach costs next to nothing, so it
/// can be more than for two meshes. More: descents that find much; fewer: descents in each step of a fast body. At half a prediction distance a step, 4
/// instead of 8 costs 4 % on the mean over all kinds.
const GREATEST_SLACK: f64 = 8.0;

/// Memory of one query, kept by each thread.
#[derive(Default)]
struct Scratch {
    descent: ProbeScratch,
    candidates: Vec<KnownCandidate<NearTriangle>>,
    places: Vec<(OrderKey, u32)>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

impl<'a> ConvexPair<'a> {
    /// The whole of two colliders: stock passes on the inverse of an inverse where the mesh is shape 2.
    pub(crate) fn new(
        pos12: &'a Pose,
        (mesh, shape): (&'a TriMesh, ConvexShape<'a>),
        flipped: bool,
        prediction: Real,
    ) -> Self {
        let parrys_pose = if flipped { pos12.inverse().inverse() } else { *pos12 };
        Self { pos12, mesh, shape, cone: None, flipped, prediction, parrys_pose }
    }

    /// The mesh in the frame of the shape.
    fn placement(&self) -> Placement {
        let placement = Placement::new(self.pos12);
        if self.flipped { placement } else { placement.inverted() }
    }

    /// Whether the boxes meet, as stock tests them. Asked before there is a tree.
    fn root_boxes_meet(&self) -> bool {
        let Some(root) = root_box(self.mesh) else {
            return true;
        };
        let pose = if self.flipped { &self.pos12.inverse() } else { self.pos12 };
        let rounding = 1e-5 * (root.half_extents().length() + root.center().length());
        let moved = self.shape.shape.compute_aabb(pose);
        root.intersects(&moved.loosened(self.prediction.max(0.0) + rounding))
    }

    /// How far Parry's routine may see: the prediction distance, what GJK adds, and what Parry rounds away in f32, some
    /// sixty operations on coordinates of the mesh, the pose and the shape.
    fn sight(&self, prepared: &PreparedMesh) -> Real {
        // A NaN stays one.
        let prediction = if self.prediction < 0.0 { 0.0 } else { self.prediction };
        let size = match self.shape.kind {
            Kind::HalfSpace(_) => 0.0,
            _ => self.shape.outline().size() as Real,
        };
        let largest = prepared.tree.magnitude() + self.pos12.translation.abs().max_element() + size;
        prediction + GJK_TOLERANCE * (prediction + self.shape.radius()) + gamma(64) * largest
    }

    /// The tree of the mesh, from the state if it is known and still valid, refitted if the mesh has deformed.
    ///
    /// If only another dispatcher was here before, or a snapshot was restored, the manifolds are as good as ours: all are of
    /// Parry's routine.
    fn tree<'s, M, C: Default + Copy>(
        &self,
        cache: &Arc<TreeCache>,
        (known, known_shape): &'s mut KnownShapes,
        coherence: &mut Coherence<NearTriangle>,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) -> Option<Held<'s>> {
        let (mut change, tree) = cache.noting(self.mesh, known.update(self.mesh, cache))?;
        let fingerprint = self.shape.fingerprint();
        if known_shape.replace(fingerprint).is_some_and(|known| known != fingerprint) {
            change = Change::Replaced;
        }
        match change {
            Change::Unknown => coherence.clear(),
            _ => coherence.follow(change, manifolds),
        }
        tree.drop_broken(manifolds, |manifold| {
            [manifold.subshape1, manifold.subshape2][usize::from(self.flipped)]
        });
        Some(tree)
    }

    /// Fills `scratch.candidates` with all triangles within `margin`, and few others, in stock order.
    fn collect(
        &self,
        prepared: &PreparedMesh,
        placement: &Placement,
        margin: Real,
        counters: impl Counters,
        scratch: &mut Scratch,
    ) {
        let Scratch { descent, candidates, .. } = scratch;
        candidates.clear();
        let mut probe = Probe::new(&prepared.tree, placement, &self.shape, f64::from(margin));
        let test = ProbeTest::new(&probe);
        descend_probe(&prepared.tree, &mut probe, descent, counters, |batch| {
            test.survivors(batch, |lane, distance, axis| {
                let triangle = batch.triangles()[lane];
                if prepared.is_broken(triangle) {
                    return;
                }
                let key = OrderKey::of_triangle(prepared, triangle);
                let candidate = NearTriangle { key, triangle, axis };
                candidates.push(KnownCandidate { candidate, clear: distance });
            });
            Verdict::Descend
        });
        candidates.sort_unstable_by_key(|known| known.candidate.key);
    }

    /// Brings the manifolds up to date from what is known of the pair and the tree of the mesh.
    pub(in crate::pair) fn update<M, C>(
        &self,
        prepared: &PreparedMesh,
        (coherence, history): (&mut Coherence<NearTriangle>, &mut History<M, C, ()>),
        counters: impl Counters,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) -> Answer
    where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        let placement = self.placement();
        let sight = self.sight(prepared);
        let ball = prepared.tree.bounding_ball();
        let plan = coherence.plan(ball, (self.pos12, placement), sight, GREATEST_SLACK);
        if plan == Plan::Nothing && history.is_of(manifolds) {
            return Answer::Unchanged;
        }
        let generator = Generator::new(self, prepared, placement);
        SCRATCH.with_borrow_mut(|scratch| match plan {
            Plan::Reuse { .. } => {
                let limits = Limits { sight: f64::from(sight), travel: coherence.travel() };
                let candidates = coherence.candidates_mut();
                generator.update(candidates, limits, &mut scratch.places, history, manifolds);
                Answer::Reused
            }
            Plan::Nothing | Plan::Descend { .. } => {
                let margin = if let Plan::Descend { margin } = plan { margin } else { sight };
                self.collect(prepared, &placement, margin, counters, scratch);
                let Scratch { candidates, places, .. } = scratch;
                let limits = Limits { sight: f64::from(sight), travel: 0.0 };
                generator.update(candidates, limits, places, history, manifolds);
                if matches!(plan, Plan::Descend { .. }) {
                    coherence.keep(candidates.iter().copied());
                }
                Answer::Descended
            }
        })
    }
}

impl Question for ConvexPair<'_> {
    fn contact_manifolds<M, C>(
        self,
        cache: &Arc<TreeCache>,
        counters: impl Counters,
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
        let PairState::<_, _, MeshAndConvex> { shapes, coherence, history } =
            state_in(workspace, manifolds);
        if shapes.0.is_unknown() && !self.root_boxes_meet() {
            manifolds.clear();
            return Answer::Apart;
        }
        let Some(prepared) = self.tree(cache, shapes, coherence, manifolds) else {
            return Answer::Unsupported;
        };
        self.update(&prepared, (coherence, history), counters, manifolds)
    }
}
