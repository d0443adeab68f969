//! The study of several engines, with two heads.

use std::fs;
use std::path::Path;

use glamx::Mat3;
use rapier3d::geometry::SharedShape;
use sbbk_lab::mesh;
use sbbk_lab::report::Results;
use sbbk_lab::scene::MonkeyPile;
use sbbk_lab::study::hard::Column;
use sbbk_lab::study::hard::engines::EnginePile;

use super::support::{line_counts, rows};

const STEPS: usize = 600;

fn value(results: &Results, engine: &str, figure: &str) -> f64 {
    let rows = rows(results, "engines", engine);
    rows.iter().find(|row| row.is("figure", figure)).unwrap().number("value")
}

/// Would catch bits lost on the way to other engines, a head whose mass is not where they take it to
/// be, and a run that they could not have written.
#[test]
fn engines_get_the_same_heads() {
    let pile = EnginePile::new(&MonkeyPile::with_heads(2));
    let folder = tempfile::tempdir().unwrap();
    let [scene, run] = ["scene", "sbbk.1"].map(|name| folder.path().join(name));
    pile.write(&scene).unwrap();
    assert_eq!(EnginePile::read(&scene).unwrap(), pile);

    let head = SharedShape::new(pile.mesh.trimesh(Default::default()).unwrap());
    let properties = head.mass_properties(1.0);
    let difference = properties.reconstruct_inertia_matrix() - Mat3::from_diagonal(pile.inertia);
    assert!(difference.to_cols_array().iter().all(|entry| entry.abs() < 1e-5), "{difference}");
    assert!(properties.local_com.length() < 1e-5 && pile.inertia.max_element() > 0.1);
    assert!(pile.parts.len() > 1);

    for column in [Column::Sbbk, Column::Control] {
        pile.run(column, &run).unwrap();
        let found = pile.judge(&[("sbbk".to_owned(), vec![&run])]).unwrap();
        let figure = |name| value(&found, "sbbk", name);
        assert!((0.6..0.9).contains(&figure("mean height after 10 s")), "{found}");
        assert!(figure("energy gained, of that at the start") < 0.02, "{found}");
    }
    let bytes = fs::read(&scene).unwrap();
    fs::write(&scene, &bytes[..bytes.len() - 4]).unwrap();
    assert!(EnginePile::read(&scene).is_err());
}

/// Would catch times, energies and depths of other steps, heads or units, runs whose times are mixed
/// up though they went other ways, and files that break off.
#[test]
fn figures_are_those_of_the_file() {
    let pile = EnginePile::new(&MonkeyPile::of(2, mesh::ball(1.0, 8)));
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, slower: f32, apart: f32| {
        let mut numbers = Vec::new();
        for step in 0..STEPS {
            numbers.extend([slower + step as f32, 7.0, 30.0, 20.0]);
            // In each other by half a unit until 9 s.
            let apart = if step < 540 { 1.5 } else { apart };
            for x in [0.0, apart] {
                numbers.extend([x, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 3.0, 0.0, 4.0, 0.0, 2.0, 0.0]);
            }
        }
        let path = folder.path().join(name);
        fs::write(&path, numbers.iter().flat_map(|n: &f32| n.to_le_bytes()).collect::<Vec<_>>())
            .unwrap();
        path
    };
    let paths = [write("a.1", 1.0, 5.0), write("a.2", 0.5, 5.0), write("b.1", 0.0, 4.0)];
    let [first, second, other] = paths.each_ref().map(|path| path.as_path());
    let judge = |paths: Vec<&Path>| pile.judge(&[("a".to_owned(), paths)]);
    let found = judge(vec![first, second]).unwrap();
    let kinetic = 0.5 * (25.0 * pile.mass + 4.0 * pile.inertia.y);
    let expected = [
        ("step in motion, median, ms", 120.0),
        ("step at rest, mean, ms", 570.0),
        ("points at rest", 7.0),
        ("mean height after 2 s", 1.0),
        ("kinetic energy in motion, J a head", f64::from(kinetic)),
        ("energy gained, of that at the start", 0.0),
        ("pairs inside each other after 2 s", 1.0),
        ("pairs inside each other after 10 s", 0.0),
        ("deepest pair after 10 s, mm", 0.0),
        ("peak memory above an empty world, MiB", 20.0),
        ("peak memory of the process, MiB", 30.0),
    ];
    for (figure, expected) in expected {
        let found = value(&found, "a", figure);
        assert!((found - expected).abs() < 1e-4, "{figure}: {found}, not {expected}");
    }
    for figure in ["mean depth of a head after 2 s, mm", "deepest pair after 2 s, mm"] {
        let depth = value(&found, "a", figure);
        assert!((depth - 500.0).abs() < 30.0, "{figure}: {depth}");
    }
    assert_eq!(line_counts(&found), [20]);
    assert!(judge(vec![first, other]).is_err());
    fs::write(other, &fs::read(first).unwrap()[4..]).unwrap();
    assert!(judge(vec![other]).is_err());
}
