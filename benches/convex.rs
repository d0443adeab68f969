//! Time per contact of a triangle and a convex shape: `cargo bench --features bench --bench
//! convex`.
//!
//! *near* is apart within the margin, *far* beyond it, *crossing* where the core of the shape
//! crosses the triangle.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glamx::DVec3;
use sbbk_core::contact::convex::{
    ConeSupport, CuboidSupport, CylinderSupport, HullPoints, SegmentSupport, SupportMap,
    convex_contact,
};
use std::hint::black_box;
use std::time::Duration;

const MARGIN: f64 = 0.02;

/// SplitMix64: coordinates from -1 to 1.
struct Random(u64);

impl Random {
    fn coordinate(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn point(&mut self) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.coordinate()))
    }
}

fn kind<S: SupportMap>(c: &mut Criterion, name: &str, core: &S, radius: f64) {
    let mut random = Random(1);
    let mut sets = [const { Vec::new() }; 3];
    while sets.iter().any(|set| set.len() < 500) {
        let at = random.point();
        let triangle = [0; 3].map(|_| at + 0.2 * random.point());
        let set = match convex_contact(&triangle, core, MARGIN + radius) {
            None => 1,
            Some(contact) if contact.distance > 0.0 => 0,
            Some(_) => 2,
        };
        if sets[set].len() < 500 {
            sets[set].push(triangle);
        }
    }
    let mut group = c.benchmark_group(name);
    for (set, pose) in sets.iter().zip(["near", "far", "crossing"]) {
        group.throughput(Throughput::Elements(set.len() as u64));
        let contact =
            |t| black_box(convex_contact(t, core, MARGIN + radius)).map_or(0.0, |c| c.distance);
        group.bench_function(pose, |b| b.iter(|| set.iter().map(contact).sum::<f64>()));
    }
}

fn each_kind(c: &mut Criterion) {
    let mut random = Random(2);
    let points = (0..20).map(|_| (random.point().normalize() * 0.5).as_vec3());
    let hull = HullPoints::new(points);
    let (half_height, radius) = (0.5, 0.3);
    kind(c, "capsule", &SegmentSupport([DVec3::Y * half_height, DVec3::Y * -half_height]), 0.2);
    kind(c, "cuboid", &CuboidSupport(DVec3::new(0.5, 0.3, 0.4)), 0.0);
    kind(c, "cylinder", &CylinderSupport { half_height, radius }, 0.0);
    kind(c, "cone", &ConeSupport { half_height, radius }, 0.0);
    kind(c, "hull of 20", &hull, 0.0);
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
