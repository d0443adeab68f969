//! Pairs of every kind that SBBK answers for.

use crate::compound::compounds;
use crate::convex::shapes::shapes;
use crate::heightfield::terrain::rolling;
use crate::prelude::*;
use sbbk_testkit::scene::random::first_touch;
use std::sync::OnceLock;

/// A mesh, or a height field, and another shape.
pub struct Kind {
    pub name: String,
    pub shapes: [SharedShape; 2],
    /// True if a mesh may deform, so every query makes its contacts anew.
    pub is_soft: bool,
}

impl Kind {
    fn new(name: &str, shape1: &SharedShape, shape2: SharedShape) -> Self {
        let shapes = [shape1.clone(), shape2];
        let is_soft = shapes
            .iter()
            .filter_map(|shape| shape.as_trimesh())
            .any(|mesh| mesh.flags().contains(TriMeshFlags::DEFORMABLE));
        Self { name: name.into(), shapes, is_soft }
    }

    pub fn question(&self, pose: Pose) -> Question<'_> {
        Question::new(&*self.shapes[0], &*self.shapes[1], pose)
    }

    /// A random pose at which the shapes are `gap` apart; a negative gap is a depth.
    pub fn pose(&self, random: &mut Rand32, gap: Real) -> Pose {
        const START: Real = 6.0;
        let mut approach = || {
            let (turn, away) = (rotation(random), direction(random));
            let at = |way: Real| Pose::from_parts(way * away, turn);
            let meets = |way| {
                !self.question(at(way)).within(gap.max(1e-3)).fresh(&per_triangle()).is_empty()
            };
            let inside = first_touch(START, START / 64.0 / 65536.0, meets)?;
            (inside < START).then(|| at(inside + gap.min(0.0)))
        };
        (0..100).find_map(|_| approach()).expect("most lines meet the other shape")
    }
}

/// Pairs of meshes that differ in size, detail, place of the origin, or surface kind. The last one
/// is too large for a tree that was not prepared.
pub fn mesh_pairs() -> Vec<Kind> {
    let plain = mesh::monkey_head_with(6).shape();
    let [ring, ball, fine, large] = [
        mesh::torus(3.0, 0.3, 40, 8),
        mesh::ball(0.5, 5),
        mesh::ball(0.3, 16),
        mesh::torus(1.4, 0.6, 100, 48),
    ]
    .map(|mesh| mesh.shape());
    let distant = mesh::monkey_head_with(6).mapped(|vertex| vertex + 0.7 * Vec3::X).shape();
    vec![
        Kind::new("ring and ball", &ring, ball.clone()),
        Kind::new("ball and ring", &ball, ring),
        Kind::new("distant origin", &plain, distant),
        Kind::new("fine balls", &fine, fine.clone()),
        Kind::new("terrain", &mesh::terrain(3.0, 12, 0.5).shape(), plain.clone()),
        Kind::new("inside out", &turned_inside_out(mesh::ball(0.7, 4)).shape(), plain.clone()),
        Kind::new("large mesh", &large, plain),
    ]
}

/// A pair of each kind, some with a mesh that may deform.
pub fn kinds() -> &'static [Kind] {
    static KINDS: OnceLock<Vec<Kind>> = OnceLock::new();
    KINDS.get_or_init(|| {
        let flags = [TriMeshFlags::FIX_INTERNAL_EDGES, TriMeshFlags::DEFORMABLE];
        let [flagged, soft] = flags.map(|flags| mesh::monkey_head_with(6).shape_with(flags));
        let plain = mesh::monkey_head_with(6).shape();
        let field = SharedShape::new(rolling(6.0, 20, 0.5));
        let ball = mesh::ball(0.7, 5).shape();
        let line = (0..9).map(|i| Vec3::new(0.2 * i as Real, 0.1 * (i % 2) as Real, 0.0)).collect();
        let mut kinds = vec![
            Kind::new("two meshes", &plain, plain.clone()),
            Kind::new("two meshes, flagged", &flagged, flagged.clone()),
            Kind::new("mesh and small mesh", &plain, ball),
            Kind::new("height field", &field, plain.clone()),
            Kind::new("polyline", &plain, SharedShape::polyline(line, None)),
            // Its box holds the whole mesh if it is turned.
            Kind::new("floor", &plain, SharedShape::cuboid(50.0, 0.25, 50.0)),
        ];
        kinds.extend(shapes(0.6).into_iter().map(|(name, shape)| Kind::new(name, &plain, shape)));
        let compounds = compounds(1.0).into_iter().map(|(name, compound)| {
            Kind::new(&format!("compound, {name}"), &plain, SharedShape::new(compound))
        });
        kinds.extend(compounds);
        for index in 0..kinds.len() {
            let Kind { name, shapes: [_, other], .. } = &kinds[index];
            let names =
                ["two meshes", "ball", "cuboid", "cylinder", "half-space", "compound, mixed"];
            if names.contains(&&**name) {
                kinds.push(Kind::new(&format!("soft, {name}"), &soft, other.clone()));
            }
        }
        kinds.push(Kind::new("soft, height field", &field, soft));
        kinds
    })
}
