//! Pairs of every kind that SBBK answers for.

use std::sync::OnceLock;

use glamx::Vec3;
use oorandom::Rand32;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::shape::{SharedShape, TriMeshFlags};
use sbbk_testkit::mesh;

use crate::compound::compounds;
use crate::convex::shapes::{floor, shapes};
use crate::heightfield::terrain::rolling;
use crate::support::{Question, direction, per_triangle, rotation, shape_with};

/// A mesh, or a height field, and another shape.
pub struct Kind {
    pub name: String,
    pub shapes: [SharedShape; 2],
    /// False where every query makes its contacts anew.
    pub keeps_candidates: bool,
}

impl Kind {
    fn new(name: &str, shape1: &SharedShape, shape2: SharedShape) -> Self {
        let keeps_candidates = shape2.as_ball().is_none();
        Self { name: name.into(), shapes: [shape1.clone(), shape2], keeps_candidates }
    }

    pub fn question(&self, pose: Pose) -> Question<'_> {
        Question::new(&*self.shapes[0], &*self.shapes[1], pose)
    }

    /// A random pose at which the shapes have come along a line until they were `gap` apart;
    /// a negative gap is a depth.
    pub fn pose(&self, random: &mut Rand32, gap: Real) -> Pose {
        const START: Real = 6.0;
        let mut approach = || {
            let (turn, away) = (rotation(random), direction(random));
            let at = |way: Real| Pose::from_parts(way * away, turn);
            let meet = |way| {
                !self.question(at(way)).within(gap.max(1e-3)).fresh(&per_triangle()).is_empty()
            };
            let steps = 64;
            let way = |i: u32| START * (1.0 - i as Real / steps as Real);
            let first = (0..steps).find(|&i| meet(way(i))).filter(|&i| i > 0)?;
            let [mut inside, mut outside] = [way(first), way(first - 1)];
            for _ in 0..16 {
                let middle = 0.5 * (inside + outside);
                *(if meet(middle) { &mut inside } else { &mut outside }) = middle;
            }
            Some(at(inside + gap.min(0.0)))
        };
        (0..100).find_map(|_| approach()).expect("most lines meet the other shape")
    }
}

/// A pair of each kind: two meshes, a mesh and each convex shape, compounds, and a height field.
pub fn kinds() -> &'static [Kind] {
    static KINDS: OnceLock<Vec<Kind>> = OnceLock::new();
    KINDS.get_or_init(|| {
        let head = |flags| SharedShape::new(shape_with(&mesh::monkey_head_with(6), flags));
        let [plain, flagged] = [TriMeshFlags::empty(), TriMeshFlags::FIX_INTERNAL_EDGES].map(head);
        let field = SharedShape::new(rolling(6.0, 20, 0.5));
        let ball = SharedShape::new(shape_with(&mesh::ball(0.7, 5), TriMeshFlags::empty()));
        let line = (0..9).map(|i| Vec3::new(0.2 * i as Real, 0.1 * (i % 2) as Real, 0.0)).collect();
        let mut kinds = vec![
            Kind::new("two meshes", &plain, plain.clone()),
            Kind::new("two meshes, flagged", &flagged, flagged.clone()),
            Kind::new("mesh and small mesh", &plain, ball),
            Kind::new("height field", &field, plain.clone()),
            Kind::new("polyline", &plain, SharedShape::polyline(line, None)),
            Kind::new("floor", &plain, floor()),
        ];
        kinds.extend(shapes(0.6).into_iter().map(|(name, shape)| Kind::new(name, &plain, shape)));
        let compounds = compounds(1.0).into_iter();
        kinds.extend(compounds.map(|(name, compound)| {
            Kind::new(&format!("compound, {name}"), &plain, SharedShape::new(compound))
        }));
        kinds
    })
}
