//! The paper's "overlapping area" (figures 6 and 7) as a number: what a hierarchy still reports as
//! touching when the descent stops at a certain depth.

use std::collections::{HashMap, HashSet};

use glamx::{Pose3, Vec3};
use oorandom::Rand32;
use rapier3d::geometry::TriMesh;
use sbbk_core::traverse::{
    Descent, DescentScratch, NodePair, PairFrame, Verdict, Visitor, descend,
};
use sbbk_core::tree::{BuildOptions, LayerPlan, LeafBatch, Node, Slot, Tree};

use super::StudyError;
use crate::backend::Backend;
use crate::metrics::{Judge, PosePairs};
use crate::report::{Row, Table, TableSpec, faster, number};
use crate::scene::{BallKind, HelicopterBallDrop, Scene};

const CUT: &str = "cut at depth";
/// The hierarchies, by the backends that use them.
const HIERARCHIES: [(Backend, LayerPlan); 2] =
    [(Backend::AabbOnly, LayerPlan::AABB_ONLY), (Backend::Sbbk, LayerPlan::SBBK)];
/// Steps within which the ball must have met the helicopter: four seconds.
const STEP_LIMIT: usize = 240;
/// Points that measure a volume: enough for 5 % of a hundredth of the ball's box.
const POINT_COUNT: usize = 50_000;

/// Follows the mesh ball to its first penetration, and cuts both hierarchies at every depth, from 0
/// to that of the deepest leaf: pairs of inner nodes are not opened from there on. A pair with a
/// leaf on one side goes on to the leaves of the other. Nothing when the ball does not meet the
/// helicopter.
///
/// Errors: a mesh does not serve.
pub fn cut(scene: &HelicopterBallDrop) -> Result<Vec<Row>, StudyError> {
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
            return cut_pair(&pairs, index, step);
        }
    }
    Ok(Vec::new())
}

fn cut_pair(pairs: &PosePairs, index: usize, step: usize) -> Result<Vec<Row>, StudyError> {
    let question = pairs.question(index, 0);
    let truth = Judge::new(pairs.shapes()).truth(&question);
    let true_triangle_count = distinct_count(truth.pairs());
    let mut rows = Vec::new();
    for (backend, layers) in HIERARCHIES {
        let meshes = pairs.meshes(index);
        let trees = Trees::new(layers, meshes, question.pos12, question.prediction)?;
        rows.extend((0..=trees.depth()).map(|depth| {
            let pairs = trees.cut(depth);
            Row::new(CUT, backend)
                .key("depth", depth)
                .with("step", step)
                .with("true_triangle_count", true_triangle_count)
                .with("pair_count", pairs.len())
                .with("triangle_count", triangle_count(&pairs))
                .with("volume", trees.volume(&pairs))
        }));
    }
    Ok(rows)
}

/// Number of different triangles of both meshes in some pairs.
fn distinct_count(pairs: impl Iterator<Item = (u32, u32)>) -> usize {
    let (triangles1, triangles2): (HashSet<u32>, HashSet<u32>) = pairs.unzip();
    triangles1.len() + triangles2.len()
}

/// Both meshes in one kind of hierarchy.
struct Trees {
    trees: [Tree; 2],
    pos12: Pose3,
    margin: f32,
}

impl Trees {
    fn new(
        layers: LayerPlan,
        meshes: [&TriMesh; 2],
        pos12: Pose3,
        margin: f32,
    ) -> Result<Self, StudyError> {
        let options = BuildOptions { layers, ..BuildOptions::default() };
        let build = |mesh: &TriMesh| {
            Tree::build(mesh.vertices(), mesh.indices(), &options).map_err(|cause| {
                StudyError::Tree { mesh: "of the helicopter scene".to_owned(), cause }
            })
        };
        Ok(Self { trees: [build(meshes[0])?, build(meshes[1])?], pos12, margin })
    }

    /// Depth of the deepest leaf.
    fn depth(&self) -> u32 {
        let [depth1, depth2] = self.trees.each_ref().map(|tree| tree.stats().depth);
        depth1.max(depth2)
    }

    /// The pairs of nodes at which a descent stops.
    fn cut(&self, depth: u32) -> Vec<[Node<'_>; 2]> {
        let [tree1, tree2] = &self.trees;
        let nodes = [tree1, tree2].map(|tree| {
            let mut nodes = Nodes::default();
            nodes.add(tree.root());
            nodes
        });
        let mut frame = PairFrame::new(tree1, tree2, &self.pos12, self.margin);
        let mut cut = Cut { nodes, depth, pairs: Vec::new() };
        let scratch = &mut DescentScratch::default();
        descend((tree1, tree2), &mut frame, Descent::Simultaneous, scratch, (), &mut cut);
        cut.pairs
    }

    /// Volume of the union of the intersections of all pairs, in cubed units: the share of random
    /// points of the second mesh's box that are in one.
    fn volume(&self, pairs: &[[Node; 2]]) -> f64 {
        let root = self.trees[1].root().aabb();
        let extents = root.max - root.min;
        let regions = pairs.iter().map(|pair| pair.map(|node| (node.aabb(), node.kdop())));
        let regions: Vec<_> = regions.collect();
        let mut random = Rand32::new(1);
        let hits = (0..POINT_COUNT).filter(|_| {
            let share = Vec3::from_array(std::array::from_fn(|_| random.rand_float()));
            let point2 = root.min + share * extents;
            let points = [self.pos12 * point2, point2];
            regions.iter().any(|pair| {
                let mut sides = pair.iter().zip(points);
                sides.all(|((aabb, kdop), point)| {
                    aabb.contains(point) && kdop.is_none_or(|kdop| kdop.contains(point))
                })
            })
        });
        let share = hits.count() as f64 / POINT_COUNT as f64;
        share * extents.to_array().into_iter().map(f64::from).product::<f64>()
    }
}

/// Number of triangles of both meshes below some nodes.
fn triangle_count(pairs: &[[Node; 2]]) -> usize {
    let counts = [0, 1].map(|side| {
        let mut triangles = HashSet::<u32>::new();
        let mut nodes: Vec<Node> = pairs.iter().map(|pair| pair[side]).collect();
        while let Some(node) = nodes.pop() {
            nodes.extend(node.children().into_iter().flatten());
            triangles.extend(node.leaf().into_iter().flat_map(|leaf| leaf.batch.triangles()));
        }
        triangles.len()
    });
    counts.iter().sum()
}

/// The nodes of a tree, as a descent names them.
#[derive(Default)]
struct Nodes<'a> {
    inner: HashMap<Slot, Node<'a>>,
    leaves: HashMap<u32, Node<'a>>,
}

impl<'a> Nodes<'a> {
    /// Adds a node and all below it.
    fn add(&mut self, node: Node<'a>) {
        if let Some(leaf) = node.leaf() {
            self.leaves.insert(leaf.number, node);
        } else {
            self.inner.insert(node.slot(), node);
        }
        node.children().into_iter().flatten().for_each(|child| self.add(child));
    }
}

/// Collects the pairs of nodes at which a descent stops.
struct Cut<'a> {
    nodes: [Nodes<'a>; 2],
    depth: u32,
    pairs: Vec<[Node<'a>; 2]>,
}

impl Visitor for Cut<'_> {
    fn nodes(&mut self, pair: NodePair) -> Verdict {
        let [nodes1, nodes2] = &self.nodes;
        match (nodes1.inner.get(&pair.slot1), nodes2.inner.get(&pair.slot2)) {
            (Some(&node1), Some(&node2)) if pair.depth >= self.depth => {
                self.pairs.push([node1, node2]);
                Verdict::Prune
            }
            _ => Verdict::Descend,
        }
    }

    fn leaves(&mut self, leaf1: u32, _: &LeafBatch, leaf2: u32, _: &LeafBatch) -> Verdict {
        let [nodes1, nodes2] = &self.nodes;
        self.pairs.push([nodes1.leaves[&leaf1], nodes2.leaves[&leaf2]]);
        Verdict::Descend
    }
}

/// The paper's figures 6 and 7; empty if nothing was cut.
pub fn table(rows: &[Row]) -> Table {
    let sides = |header: &str, path| {
        let side = |backend: Backend| number(&format!("{header}, {backend}"), path).of(backend);
        [side(Backend::AabbOnly), side(Backend::Sbbk)]
    };
    let ratio = |path| faster("ratio", path, Backend::Sbbk).inverse().of(Backend::AabbOnly);
    let columns = [
        &sides("node pairs", "pair_count")[..],
        &sides("triangles", "triangle_count"),
        &[ratio("triangle_count")],
        &sides("volume", "volume"),
        &[ratio("volume")],
    ];
    let first = rows.iter().find(|row| row.study == CUT);
    let moment = first.map_or("the ball does not meet the helicopter".to_owned(), |row| {
        format!(
            "ball of triangles on the rotor, step {}: the first at which it penetrates; {} triangles \
             are truly within the prediction distance; deeper cuts change nothing",
            row.count("step"),
            row.count("true_triangle_count")
        )
    });
    let spec = TableSpec {
        title: "Figures 6 and 7. \"Overlapping area\" when the descent is cut at a depth"
            .to_owned(),
        study: CUT,
        keys: &["depth"],
        total: None,
        columns: columns.concat(),
        notes: vec![
            moment,
            "triangles: those of both meshes below a node reported as touching; volume: what lies \
             within both nodes of a reported pair, cubed units"
                .to_owned(),
        ],
    };
    let mut table = spec.of(rows);
    // Deeper cuts than the leaves change nothing.
    table.lines.dedup_by(|line, before| line[1..] == before[1..]);
    table
}
