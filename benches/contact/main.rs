//! Time per triangle pair of the contact generator, over the pairs of two bumpy spheres that
//! truly lie within the margin: `cargo bench --features bench --bench contact`.
//!
//! *coarse* has triangles far larger than the margin, most of which cross or meet edge to edge;
//! *fine* has triangles about as large as the margin, most of which meet vertex to edge.
//! *search* is a first contact, *steady* one that keeps its features, *manifold* the steady one
//! with all its points.

mod pairs;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pairs::{Pair, bumpy_spheres};
use sbbk_core::contact::{ManifoldPoints, clip, contact, contact_from, push_closest};
use std::hint::black_box;
use std::time::Duration;

const KINDS: [&str; 6] =
    ["All", "VertexFace", "EdgeEdge", "VertexEdge", "VertexVertex", "Crossing"];

fn each_kind(c: &mut Criterion) {
    for (name, subdivisions) in [("coarse", 24), ("fine", 80)] {
        let all = bumpy_spheres(subdivisions, 0.02);
        for kind in KINDS {
            let is_of = |pair: &&Pair| kind == "All" || kind == pair.kind();
            let pairs: Vec<_> = all.iter().filter(is_of).copied().collect();
            if pairs.is_empty() {
                continue;
            }
            let mut group = c.benchmark_group(format!("{name} {kind}"));
            group.throughput(Throughput::Elements(pairs.len() as u64));
            group.bench_function("search", |b| b.iter(|| pairs.iter().map(search).sum::<f64>()));
            group.bench_function("steady", |b| b.iter(|| pairs.iter().map(steady).sum::<f64>()));
            group
                .bench_function("manifold", |b| b.iter(|| pairs.iter().map(points).sum::<usize>()));
        }
    }
}

fn search(pair: &Pair) -> f64 {
    black_box(contact(&pair.t1, &pair.t2, pair.margin)).map_or(0.0, |c| c.distance)
}

fn steady(pair: &Pair) -> f64 {
    let found = contact_from(&pair.t1, &pair.t2, pair.margin, pair.contact.features);
    black_box(found).map_or(0.0, |c| c.distance)
}

fn points(pair: &Pair) -> usize {
    let Pair { t1, t2, margin, contact: last } = pair;
    let mut points = ManifoldPoints::new();
    if let Some(contact) = contact_from(t1, t2, *margin, last.features) {
        clip(t1, t2, contact.normal, &mut points);
        push_closest(t1, t2, &contact, &mut points);
    }
    black_box(&points).len()
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(300))
        .sample_size(20)
        .nresamples(1000)
        .without_plots();
    targets = each_kind
}
criterion_main!(benches);
