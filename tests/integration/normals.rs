use crate::prelude::*;
use rapier3d::parry::query::details::NormalConstraints;

const FREE: TriMeshFlags = TriMeshFlags::empty();
const ONE_SIDED: TriMeshFlags = TriMeshFlags::FIX_INTERNAL_EDGES;
const TWO_SIDED: TriMeshFlags = TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED;

/// Meshes with triangles of about a unit and sharp as well as flat edges.
fn meshes() -> [Mesh; 2] {
    [mesh::monkey_head_with(7).scaled_to(20.0), mesh::torus(8.0, 3.0, 24, 12)]
}

/// Panics if the flags renumber the mesh.
fn flagged(mesh: &Mesh, flags: TriMeshFlags) -> TriMesh {
    let (free, flagged) = (shape(mesh), mesh.trimesh(flags));
    assert_eq!((free.vertices(), free.indices()), (flagged.vertices(), flagged.indices()));
    flagged
}

/// Normals of pairs of triangles in the frame of mesh `k` (0 or 1), pointing away from it.
fn normals(manifolds: &[Manifold], k: usize) -> BTreeMap<TrianglePair, Vector> {
    let manifolds = by_triangles(manifolds).into_iter();
    manifolds.map(|(pair, m)| (pair, [m.local_n1, m.local_n2][k])).collect()
}

/// Checks contacts of two meshes, of which mesh `k` alone has constraints.
///
/// Would catch a normal outside of its cone, a change of one inside, wrong rejections, and depths
/// along the free normal.
fn check_cone(k: usize, flags: TriMeshFlags) {
    let meshes = meshes();
    let free = [0, 1].map(|i| flagged(&meshes[i], FREE));
    let fixed = [0, 1].map(|i| flagged(&meshes[i], if i == k { flags } else { FREE }));
    let dispatcher = per_triangle();
    let mut random = Rand32::new(1);
    let [mut pushed, mut untouched, mut rejected] = [0; 3];
    for depth in [-0.01, 0.0, 0.1, 0.5, 2.0].repeat(4) {
        let pos12 = touching(&mut random, [&free[0], &free[1]], depth);
        let ask = |[one, two]: &[TriMesh; 2]| Question::new(one, two, pos12).fresh(&dispatcher);
        let (answer, constrained) = (ask(&free), ask(&fixed));
        for manifold in &constrained {
            for point in &manifold.points {
                let along = (pos12 * point.local_p2 - point.local_p1).dot(manifold.local_n1);
                let off = (along - point.dist).abs();
                assert!(off < 1e-4, "{} deep, {along} along the normal", point.dist);
            }
        }
        let constrained = normals(&constrained, k);
        for (pair, normal) in normals(&answer, k) {
            let cone = fixed[k].triangle_normal_constraints(pair[k]).unwrap();
            match (cone.project_local_normal(normal), constrained.get(&pair)) {
                (None, found) => {
                    assert_eq!(found, None, "{pair:?} is rejected by the cone");
                    rejected += 1;
                }
                (Some(expected), Some(&found)) => {
                    let off = (found - expected).length();
                    assert!(off < 1e-5, "{pair:?}: {found} instead of {expected}");
                    *(if expected == normal { &mut untouched } else { &mut pushed }) += 1;
                }
                // A normal turned so far that the triangles do not face each other along it.
                (Some(expected), None) => {
                    assert!((expected - normal).length() > 0.05, "{pair:?} was lost");
                }
            }
        }
        let missing = constrained.keys().find(|pair| !normals(&answer, k).contains_key(*pair));
        assert_eq!(missing, None, "constraints make no contacts");
    }
    assert!(pushed > 50 && untouched > 50, "{pushed} pushed, {untouched} not, {rejected} rejected");
    assert_eq!(rejected > 50, flags == ONE_SIDED, "{rejected} rejected");
}

#[test]
fn normals_lie_in_the_cones_of_either_mesh() {
    for (k, flags) in [0, 1].into_iter().flat_map(|k| [(k, ONE_SIDED), (k, TWO_SIDED)]) {
        check_cone(k, flags);
    }
}
