use std::collections::BTreeMap;

use oorandom::Rand32;
use rapier_integration::{ContactGenerator, SbbkDispatcher};
use rapier3d::parry::shape::{TriMesh, TriMeshFlags};
use sbbk_lab::mesh::{self, Mesh};

use crate::support::{
    Manifold, Query, TrianglePair, by_triangles, fresh, generating, shape_with, stock, touching,
};
use crate::truth::pairs_within;

/// All of a manifold that a user can see, as bits.
#[derive(Debug, PartialEq)]
struct Bits {
    normals: [[u32; 3]; 2],
    points: Vec<PointBits>,
}

#[derive(Debug, PartialEq)]
struct PointBits {
    positions: [[u32; 3]; 2],
    distance: u32,
    features: [u32; 2],
}

impl Bits {
    fn of(manifold: &Manifold) -> Self {
        let bits = |v: rapier3d::math::Vector| v.to_array().map(f32::to_bits);
        let points = manifold.points.iter().map(|point| PointBits {
            positions: [bits(point.local_p1), bits(point.local_p2)],
            distance: point.dist.to_bits(),
            features: [point.fid1.0, point.fid2.0],
        });
        Self {
            normals: [bits(manifold.local_n1), bits(manifold.local_n2)],
            points: points.collect(),
        }
    }
}

fn all_bits(manifolds: &[Manifold]) -> BTreeMap<TrianglePair, Bits> {
    let bits = by_triangles(manifolds).into_iter();
    bits.map(|(pair, manifold)| (pair, Bits::of(manifold))).collect()
}

/// Distances this close to the prediction distance, as a share of it, may go either way: f32 poses
/// and vertices are exact in f64, what remains is its rounding.
const BAND: f64 = 1e-9;

/// Compares one fresh answer with stock's; the number of pairs of triangles that have contacts.
fn check(dispatcher: &SbbkDispatcher, query: &Query) -> usize {
    let found = all_bits(&fresh(dispatcher, query));
    let mut stock = all_bits(&stock(query));
    let prediction = f64::from(query.prediction);
    let truth = pairs_within(query, prediction * (1.0 + BAND));
    for (pair, truth) in &truth {
        let expected = stock.remove(pair);
        if truth.distance < prediction * (1.0 - BAND) {
            assert_eq!(found.get(pair), expected.as_ref(), "{pair:?} at {}", truth.distance);
        }
    }
    for pair in found.keys() {
        assert!(truth.contains_key(pair), "{pair:?} is beyond the prediction distance");
    }
    found.len()
}

/// Checks poses of two meshes from just apart to deep in each other, in both orders.
fn check_poses(seed: u64, size: f32, meshes: [&Mesh; 2], flags: [TriMeshFlags; 2]) {
    let dispatcher = generating(ContactGenerator::Parry);
    let [one, two]: [TriMesh; 2] =
        [0, 1].map(|i| shape_with(&meshes[i].clone().scaled(size), flags[i]));
    let mut random = Rand32::new(seed);
    let mut pair_count = 0;
    for depth in [-0.005, 0.0, 0.01, 0.1, 0.4] {
        let pos12 = touching(&mut random, [&one, &two], size * depth);
        let query = Query::new(&one, &two, pos12).within(0.01 * size);
        pair_count += check(&dispatcher, &query) + check(&dispatcher, &query.swapped());
    }
    assert!(pair_count > 100, "{pair_count} contacts in all");
}

/// Would catch another pose, other normals or other arguments than stock passes to Parry, and pairs
/// of triangles lost or invented on the way there.
#[test]
fn parrys_contacts_are_stocks() {
    let (head, ring) = (mesh::monkey_head(), mesh::torus(0.8, 0.35, 20, 10));
    let none = [TriMeshFlags::empty(); 2];
    for (seed, size) in [0.1, 1.0, 20.0].into_iter().enumerate() {
        check_poses(seed as u64, size, [&head, &ring], none);
        // Boxes of equal size: neither mesh goes first by its size.
        check_poses(seed as u64, size, [&head, &head], none);
    }
}

/// Would catch cones that are not those of the triangle, not on the right side, or computed with
/// other bits.
#[test]
fn parrys_constrained_contacts_are_stocks() {
    let (head, ring) = (mesh::monkey_head(), mesh::torus(0.8, 0.35, 20, 10));
    let [none, one, two] = [
        TriMeshFlags::empty(),
        TriMeshFlags::FIX_INTERNAL_EDGES,
        TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED,
    ];
    for (seed, flags) in [[one, none], [none, one], [one, one], [two, none], [one, two], [two, two]]
        .into_iter()
        .enumerate()
    {
        check_poses(10 + seed as u64, 10.0, [&head, &ring], flags);
    }
}
