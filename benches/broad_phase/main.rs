//! A step of this crate's broad phase and of Parry's tree, which Rapier uses, on the same frames.
//!
//! `cargo bench --features bench --bench broad_phase`, with a part of a name such as `pile/2000` to
//! run less. Before they are timed, both are compared with brute force.

mod candidate;
mod scenes;

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, SamplingMode, criterion_group, criterion_main};
use sbbk_core::broad_phase::Bounds;

use candidate::{Candidate, IndexPair, parry, sbbk};
use scenes::SCENES;

/// Rapier's default prediction distance for objects of about one unit.
const MARGIN: f32 = 0.02;

type Constructor = fn() -> Candidate;

const CANDIDATES: [(&str, Constructor); 2] = [("sbbk", sbbk), ("parry", parry)];

fn brute_force(frame: &[Bounds]) -> Vec<IndexPair> {
    let pairs_of = |i: usize| {
        let is_partner = move |&j: &usize| frame[i].is_pair_with(&frame[j], MARGIN);
        (i + 1..frame.len()).filter(is_partner).map(move |j| [i as u32, j as u32])
    };
    (0..frame.len()).flat_map(pairs_of).collect()
}

/// Compares both with brute force over a few frames of every scene.
fn check() {
    for scene in SCENES {
        let frames = scene.frames(1000);
        for (name, construct) in CANDIDATES {
            let mut step = construct();
            for (f, frame) in frames.iter().enumerate() {
                let mut pairs = step(frame);
                if f % 8 == 0 {
                    pairs.sort_unstable();
                    let is_equal = pairs == brute_force(frame);
                    assert!(is_equal, "{name} is wrong in frame {f} of {}", scene.name);
                }
            }
        }
    }
}

fn broad_phase(criterion: &mut Criterion) {
    check();
    for scene in SCENES {
        for count in [100, 2000, 20_000] {
            let frames = scene.frames(count);
            let mut group = criterion.benchmark_group(format!("{}/{count}", scene.name));
            group.sampling_mode(SamplingMode::Flat);
            for (name, construct) in CANDIDATES {
                let mut candidate = construct();
                let mut next_frames = frames.iter().cycle();
                let mut step = || black_box(candidate(next_frames.next().unwrap()).len());
                // What the first frame costs is not the question here.
                step();
                group.bench_function(BenchmarkId::from_parameter(name), |bencher| {
                    bencher.iter(&mut step);
                });
            }
            group.finish();
        }
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .nresamples(1000)
        .without_plots()
        .warm_up_time(Duration::from_millis(30))
        .measurement_time(Duration::from_millis(200));
    targets = broad_phase
}
criterion_main!(benches);
