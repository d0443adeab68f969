//! The paper's "overlapping area" (figures 6 and 7) as a number: what a hierarchy still reports as
//! touching when the descent stops at a certain depth.

use std::collections::HashSet;

use glamx::{Pose3, Vec3};
use oorandom::Rand32;
use rapier3d::geometry::TriMesh;
use sbbk_core::traverse::{
    Descent, DescentScratch, NodePair, PairFrame, Verdict, Visitor, descend,
};
use sbbk_core::tree::{BuildOptions, LayerPlan, LeafBatch, Tree};
use serde::Serialize;

use super::StudyError;
use super::outline::{Outline, Region};
use crate::backend::Backend;
use crate::metrics::{Judge, PosePairs};
use crate::scene::{BallKind, HelicopterBallDrop, Scene};

/// Which hierarchy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hierarchy {
    /// AABBs in all layers.
    AabbOnly,
    /// Sphere, AABBs, k-DOPs.
    Sbbk,
}

impl Hierarchy {
    /// Both, the paper's comparison first.
    pub const ALL: [Self; 2] = [Self::AabbOnly, Self::Sbbk];

    fn plan(self) -> LayerPlan {
        match self {
            Self::AabbOnly => LayerPlan::AABB_ONLY,
            Self::Sbbk => LayerPlan::SBBK,
        }
    }
}

/// What one hierarchy reports at one depth.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CutRow {
    /// Which hierarchy.
    pub hierarchy: Hierarchy,
    /// Depth of the cut: pairs of inner nodes are not opened from there on. A pair with a leaf on
    /// one side goes on to the leaves of the other.
    pub depth: u32,
    /// Pairs of nodes reported.
    pub pair_count: usize,
    /// Triangles of both meshes below a reported node.
    pub triangle_count: usize,
    /// Volume that lies within both nodes of a reported pair, in cubed units, by sampling.
    pub volume: f64,
}

/// The moment when the ball meets the helicopter, as both hierarchies see it.
#[derive(Clone, Debug, Serialize)]
pub struct CutStudy {
    /// Step of the stock run at which the ball first penetrates the helicopter.
    pub step: usize,
    /// Triangles of both meshes that are within the prediction distance of the other mesh.
    pub true_triangle_count: usize,
    /// Each hierarchy at all depths from 0 to that of the deepest leaf.
    pub rows: Vec<CutRow>,
}

/// Steps within which the ball must have met the helicopter: four seconds.
const STEP_LIMIT: usize = 240;
/// Points that measure a volume: enough for 5 % of a hundredth of the ball's box.
const POINT_COUNT: usize = 50_000;

/// Follows the mesh ball to its first penetration, and cuts both hierarchies at every depth.
/// `None` when the ball does not meet the helicopter.
///
/// Errors: a mesh does not serve.
pub fn cut(scene: &HelicopterBallDrop) -> Result<Option<CutStudy>, StudyError> {
    let scene = HelicopterBallDrop { ball: BallKind::Mesh, ..scene.clone() };
    let mut world = scene.build()?.world;
    let stock = Backend::Stock.dispatcher();
    for step in 1..=STEP_LIMIT {
        let pairs = PosePairs::capture(&mut world, |world| world.step());
        let penetrates = |index| {
            let [fresh, _] = pairs.answers(&stock, index);
            fresh.reported.iter().any(|pair| pair.distance < 0.0)
        };
        if let Some(index) = (0..pairs.pair_count()).find(|&index| penetrates(index)) {
            return cut_pair(&pairs, index, step).map(Some);
        }
    }
    Ok(None)
}

fn cut_pair(pairs: &PosePairs, index: usize, step: usize) -> Result<CutStudy, StudyError> {
    let question = pairs.question(index, 0);
    let truth = Judge::new(pairs.shapes()).truth(&question);
    let meshes = pairs.meshes(index);
    let mut rows = Vec::new();
    for hierarchy in Hierarchy::ALL {
        let trees = Trees::new(hierarchy, meshes, question.pos12, question.prediction)?;
        rows.extend((0..=trees.depth()).map(|depth| trees.cut(depth)));
    }
    Ok(CutStudy { step, true_triangle_count: distinct_count(truth.pairs()), rows })
}

/// Number of different triangles of both meshes in some pairs.
fn distinct_count(pairs: impl Iterator<Item = (u32, u32)>) -> usize {
    let (triangles1, triangles2): (HashSet<u32>, HashSet<u32>) = pairs.unzip();
    triangles1.len() + triangles2.len()
}

/// Both meshes in one kind of hierarchy.
struct Trees {
    hierarchy: Hierarchy,
    trees: [Tree; 2],
    outlines: [Outline; 2],
    pos12: Pose3,
    margin: f32,
}

impl Trees {
    fn new(
        hierarchy: Hierarchy,
        meshes: [&TriMesh; 2],
        pos12: Pose3,
        margin: f32,
    ) -> Result<Self, StudyError> {
        let options = BuildOptions { layers: hierarchy.plan(), ..BuildOptions::default() };
        let build = |mesh: &TriMesh| {
            Tree::build(mesh.vertices(), mesh.indices(), &options).map_err(|cause| {
                StudyError::Tree { mesh: "of the helicopter scene".to_owned(), cause }
            })
        };
        let trees = [build(meshes[0])?, build(meshes[1])?];
        Ok(Self {
            hierarchy,
            outlines: trees.each_ref().map(|tree| Outline::new(tree, options.layers)),
            trees,
            pos12,
            margin,
        })
    }

    /// Depth of the deepest leaf.
    fn depth(&self) -> u32 {
        let [depth1, depth2] = self.trees.each_ref().map(|tree| tree.stats().depth);
        depth1.max(depth2)
    }

    fn cut(&self, depth: u32) -> CutRow {
        let [tree1, tree2] = &self.trees;
        let mut frame = PairFrame::new(tree1, tree2, &self.pos12, self.margin);
        let mut cut = Cut { outlines: &self.outlines, depth, pairs: Vec::new() };
        let scratch = &mut DescentScratch::default();
        descend((tree1, tree2), &mut frame, Descent::Simultaneous, scratch, (), &mut cut);
        let triangles = |side: usize| -> HashSet<u32> {
            let regions = cut.pairs.iter().map(|pair| pair[side]);
            regions.flat_map(|region| region.triangles.iter().copied()).collect()
        };
        CutRow {
            hierarchy: self.hierarchy,
            depth,
            pair_count: cut.pairs.len(),
            triangle_count: triangles(0).len() + triangles(1).len(),
            volume: self.volume(&cut.pairs),
        }
    }

    /// Volume of the union of the intersections of all pairs: the share of random points of the
    /// second mesh's box that are in one.
    fn volume(&self, pairs: &[[&Region; 2]]) -> f64 {
        let root = self.outlines[1].root_box();
        let extents = root.max - root.min;
        let mut random = Rand32::new(1);
        let hits = (0..POINT_COUNT).filter(|_| {
            let share = Vec3::from_array(std::array::from_fn(|_| random.rand_float()));
            let point2 = root.min + share * extents;
            let points = [self.pos12 * point2, point2];
            let is_in = |(region, point): (&&Region, Vec3)| region.contains(point);
            pairs.iter().any(|pair| pair.iter().zip(points).all(is_in))
        });
        let share = hits.count() as f64 / POINT_COUNT as f64;
        share * extents.to_array().into_iter().map(f64::from).product::<f64>()
    }
}

/// Collects the pairs of nodes at which a descent stops.
struct Cut<'a> {
    outlines: &'a [Outline; 2],
    depth: u32,
    pairs: Vec<[&'a Region; 2]>,
}

impl Visitor for Cut<'_> {
    fn nodes(&mut self, pair: NodePair) -> Verdict {
        let [outline1, outline2] = self.outlines;
        let inner = (outline1.inner.get(&pair.slot1), outline2.inner.get(&pair.slot2));
        match inner {
            (Some(region1), Some(region2)) if pair.depth >= self.depth => {
                self.pairs.push([region1, region2]);
                Verdict::Prune
            }
            _ => Verdict::Descend,
        }
    }

    fn leaves(&mut self, leaf1: u32, _: &LeafBatch, leaf2: u32, _: &LeafBatch) -> Verdict {
        let [outline1, outline2] = self.outlines;
        self.pairs.push([&outline1.leaves[&leaf1], &outline2.leaves[&leaf2]]);
        Verdict::Descend
    }
}
