//! What a user is told about meshes.

use sbbk_core::surface::SurfaceKind;
use sbbk_lab::mesh;
use sbbk_lab::study::everyday::{Advice, advise, advise_robot};

fn measured(mesh: &sbbk_lab::mesh::Mesh) -> (Advice, Vec<String>) {
    let advice = advise(mesh, 60, 1);
    let text = advice.to_string();
    (advice, text.lines().map(str::to_owned).collect())
}

/// Meshes that want different settings. Would catch scenes in which nothing touches, errors that are
/// counted for the wrong side, large meshes that are measured without their trees, and settings that
/// do not fit the mesh.
#[test]
fn advice_fits_the_mesh() {
    let mut inside_out = mesh::cuboid(glamx::Vec3::splat(1.0), 2);
    inside_out.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    let cases = [
        (mesh::torus(0.005, 0.002, 48, 24).named("washer"), SurfaceKind::Solid),
        (mesh::torus(1.0, 0.35, 120, 50).named("fine ring"), SurfaceKind::Solid),
        (mesh::hills(20.0, 40).named("hills"), SurfaceKind::Sheet),
        (inside_out.named("inside out"), SurfaceKind::InsideOut),
    ];
    for (mesh, kind) in &cases {
        let (advice, lines) = measured(mesh);
        assert_eq!((advice.kind, lines.len()), (*kind, 4), "{lines:?}");
        assert!(lines[0].starts_with(&mesh.name), "{lines:?}");
        for ([stock, sbbk], speed) in advice.rows.iter().zip(advice.speeds()) {
            assert!(stock.number("detection.mean") > 0.0 && speed > 0.0, "{stock:?}");
            assert!(sbbk.count("pairs.mesh_pairs") > 5, "{sbbk:?}");
            assert!(sbbk.wrong("judged") <= stock.wrong("judged"), "{sbbk:?}");
        }
        let is_large = mesh.triangle_count() > 8192;
        for line in &lines[2..] {
            assert_eq!(line.contains("prepare_shape"), is_large, "{line}");
            assert_eq!(line.contains("inwards"), *kind == SurfaceKind::InsideOut, "{line}");
        }
        assert_eq!(lines[2].contains("length_unit"), mesh.name == "washer", "{}", lines[2]);
        // Only bodies and sensors meet meshes: a terrain gets no tree.
        let trees = advice.rows.each_ref().map(|[_, sbbk]| sbbk.number("plugin_mebibytes") > 0.0);
        assert_eq!(trees, [false, true, true]);
        // Stock's tolerances are lengths, SBBK has none.
        if mesh.name == "washer" {
            let [stock, sbbk] = &advice.rows[1];
            assert!(stock.wrong("judged") > 100 && sbbk.wrong("judged") == 0, "{stock:?} {sbbk:?}");
        }
    }
}

/// Would catch robots whose links are lost, lie apart or hang in the air, flags that take the inside
/// of meshes away, and files that cannot be used but do not say so.
#[test]
fn robots_are_measured_as_a_whole() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/walker/walker.urdf");
    let advice = advise_robot(file.as_ref(), 60, 1).unwrap();
    assert_eq!((&*advice.name, advice.kind), ("walker", SurfaceKind::Solid));
    assert!(advice.triangles > 2500 && (0.5..2.0).contains(&advice.size), "{advice}");
    for [stock, sbbk] in &advice.rows {
        assert!(sbbk.count("pairs.mesh_pairs") > 50, "{sbbk:?}");
        assert!(sbbk.wrong("judged") <= stock.wrong("judged"), "{sbbk:?}");
    }
    // Whether two meshes meet is not judged.
    for [_, sbbk] in &advice.rows[..2] {
        assert_eq!(sbbk.count("pairs.missed") + sbbk.count("pairs.phantom"), 0, "{sbbk:?}");
    }
    let lines: Vec<String> = advice.to_string().lines().map(str::to_owned).collect();
    assert!(lines[2].contains("TriMeshFlags::empty()"), "{}", lines[2]);
    let missing = advise_robot("no/such.urdf".as_ref(), 1, 1).unwrap_err().to_string();
    assert!(missing.contains("no/such.urdf"), "{missing}");
}
