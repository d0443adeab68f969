//! Recordings, written and read again.

use crate::prelude::*;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::read::GzDecoder;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::{encode, page};

const HEADS: usize = 12;
const STEPS: usize = 90;
/// The step after which a head is taken away.
const GONE: usize = 70;

fn recorded(backend: Backend) -> Recorder {
    let mut built = MonkeyPile::with_heads(HEADS).build();
    let _installed = backend.install(&mut built.world);
    let mut recorder = Recorder::new(backend, &built.world);
    for step in 0..STEPS {
        if step == GONE {
            built.world.remove_body(built.watched[3]);
        }
        recorder.step(&mut built.world);
    }
    recorder
}

fn numbers<T: DeserializeOwned>(value: &Value) -> Vec<T> {
    serde_json::from_value(value.clone()).unwrap()
}

/// Sums up a list of differences.
fn summed(value: &Value) -> Vec<f32> {
    let sum = |last: &mut i32, difference| {
        *last += difference;
        Some(*last as f32)
    };
    numbers::<i32>(value).into_iter().scan(0, sum).collect()
}

/// Panics unless places, rotations, contacts and times are those of the run.
fn check_run(run: &Recorder, written: &Value, quantum: f32) {
    let frames = run.frames.len();
    assert_eq!((frames, run.objects.len()), (1 + STEPS / 2, HEADS + 1));
    assert_eq!(numbers::<f32>(&written["times"]), run.times);
    let poses = written["poses"].as_array().unwrap().iter().map(summed).collect::<Vec<_>>();
    for (object, frame) in (0..HEADS + 1).flat_map(|o| (0..frames).map(move |f| (o, f))) {
        let number = |part: usize| poses[part][object * frames + frame];
        let rotation = Quat::from_array([3, 4, 5, 6].map(number));
        let Some(pose) = run.frames[frame].poses.get(object).copied().flatten() else {
            assert_eq!(rotation.length(), 0.0, "object {object} in frame {frame}");
            continue;
        };
        let place = quantum * Vec3::from_array([0, 1, 2].map(number));
        assert!(place.distance(pose.translation) < 0.9 * quantum, "{place} {pose:?}");
        assert!(rotation.normalize().angle_between(pose.rotation) < 1e-3);
    }
    let contacts = written["contacts"].as_array().unwrap().iter().map(summed);
    let contacts = contacts.collect::<Vec<_>>();
    let points = run.frames.iter().flat_map(|frame| &frame.contacts);
    assert!(points.clone().count() > 100 && points.clone().count() == contacts[0].len());
    for (index, point) in points.enumerate() {
        let place = quantum * Vec3::from_array([0, 1, 2].map(|axis| contacts[axis][index]));
        assert!(place.distance(*point) < 0.9 * quantum);
    }
    let gone = run.frames.last().unwrap().poses.iter().filter(|pose| pose.is_none());
    assert_eq!(gone.count(), 1);
}

/// Would catch lost or mixed up poses, contacts and times, removed bodies that stay, and large
/// pages.
#[test]
fn what_is_written_can_be_read() {
    let runs = [Backend::Stock, Backend::Sbbk].map(recorded);
    let text = encode(&runs);
    let packed = BASE64_STANDARD.decode(&text).unwrap();
    let replay: Value = serde_json::from_reader(GzDecoder::new(&packed[..])).unwrap();
    let quantum = replay["quantum"].as_f64().unwrap() as f32;
    assert!(quantum > 5e-4 && quantum < 2e-3, "{quantum}");
    for (run, written) in runs.iter().zip(replay["runs"].as_array().unwrap()) {
        check_run(run, written, quantum);
    }
    for level in replay["shapes"].as_array().unwrap().iter().flat_map(|s| s.as_array().unwrap()) {
        let vertices = numbers::<f32>(&level["vertices"]).len();
        let triangles = numbers::<usize>(&level["triangles"]);
        assert!(triangles.iter().all(|vertex| 3 * vertex < vertices));
    }

    // A page of 200 heads and 600 steps may have 5 MB.
    let head_frames = 2 * HEADS * (STEPS / 2);
    let shapes = 30_000;
    assert!(text.len() < shapes + 40 * head_frames, "{} for {head_frames}", text.len());
}

/// Would catch pages that lack a part or take titles for markup.
#[test]
fn pages_are_whole() {
    let runs = [Backend::Stock, Backend::Sbbk].map(recorded);
    let page = page("a < b", &runs);
    assert_eq!(page.matches("a &lt; b").count(), 2);
    let parts = ["style", "library", "decode", "draw", "play", "data", "title"];
    assert!(parts.iter().all(|part| !page.contains(&format!("@{part}@"))));
    assert_eq!(page.matches("</script>").count(), 3);
    assert!(!page.contains("<script src") && !page.contains("<link"));
}
