//! Recordings, written and read again.

use crate::prelude::*;
use std::io::Read;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::read::GzDecoder;
use serde_json::Value;

use super::difference::Difference;
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

/// The numbers after the header.
struct Stream(std::vec::IntoIter<u8>);

impl Stream {
    fn open(text: &str) -> (Value, Self) {
        let packed = BASE64_STANDARD.decode(text).unwrap();
        let mut bytes = Vec::new();
        GzDecoder::new(&packed[..]).read_to_end(&mut bytes).unwrap();
        let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
        let header = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
        (header, Self(bytes.split_off(4 + length.next_multiple_of(4)).into_iter()))
    }

    fn words(&mut self, count: usize) -> Vec<u32> {
        (0..count).map(|_| u32::from_le_bytes([(); 4].map(|()| self.0.next().unwrap()))).collect()
    }

    fn floats(&mut self, count: usize) -> Vec<f32> {
        self.words(count).into_iter().map(f32::from_bits).collect()
    }

    fn planes<const N: usize>(&mut self, count: usize) -> [Vec<i32>; N] {
        [(); N].map(|()| {
            let bytes: Vec<u32> = self.0.by_ref().take(3 * count).map(u32::from).collect();
            let mut last = 0;
            let number = |index: usize| {
                let folded = (0..3).map(|k| bytes[k * count + index] << (8 * k)).sum::<u32>();
                last += (folded >> 1) as i32 ^ -((folded & 1) as i32);
                last
            };
            (0..count).map(number).collect()
        })
    }
}

/// Would catch lost or mixed up poses, contacts and times, removed bodies that stay, and large pages.
#[test]
fn what_is_written_can_be_read() {
    let runs = [Backend::Stock, Backend::Sbbk].map(recorded);
    let text = encode(&runs);
    let (header, mut stream) = Stream::open(&text);
    let quantum = header["quantum"].as_f64().unwrap() as f32;
    assert!(quantum > 5e-4 && quantum < 2e-3, "{quantum}");
    let number = |value: &Value| value.as_u64().unwrap() as usize;
    for level in header["shapes"].as_array().unwrap().iter().flat_map(|s| s.as_array().unwrap()) {
        let [vertices, triangles] = [0, 1].map(|index| number(&level[index]));
        assert!(stream.floats(3 * vertices).iter().all(|k| k.abs() < 100.0));
        assert!(stream.words(3 * triangles).iter().all(|&vertex| (vertex as usize) < vertices));
    }
    for (run, header) in runs.iter().zip(header["runs"].as_array().unwrap()) {
        assert_eq!(header["name"], run.name);
        let [frames, objects] = [number(&header["frames"]), run.objects.len()];
        assert_eq!((frames, objects), (1 + STEPS / 2, HEADS + 1));
        assert_eq!(stream.floats(number(&header["steps"])), run.times);
        let poses: [Vec<i32>; 7] = stream.planes(frames * objects);
        for (object, frame) in (0..objects).flat_map(|o| (0..frames).map(move |f| (o, f))) {
            let [x, y, z, i, j, k, w] =
                poses.each_ref().map(|part| part[object * frames + frame] as f32);
            let rotation = Quat::from_xyzw(i, j, k, w);
            let Some(pose) = run.frames[frame].poses.get(object).copied().flatten() else {
                assert_eq!(rotation.length(), 0.0, "object {object} in frame {frame}");
                continue;
            };
            let place = quantum * Vec3::new(x, y, z);
            assert!(place.distance(pose.translation) < 0.9 * quantum, "{place} {pose:?}");
            assert!(rotation.normalize().angle_between(pose.rotation) < 1e-3);
        }
        let counts = stream.words(frames);
        let contacts: [Vec<i32>; 3] = stream.planes(counts.iter().sum::<u32>() as usize);
        let points = run.frames.iter().flat_map(|frame| &frame.contacts);
        assert!(points.clone().count() > 100);
        for (index, point) in points.enumerate() {
            let [x, y, z] = contacts.each_ref().map(|axis| axis[index] as f32);
            assert!((quantum * Vec3::new(x, y, z)).distance(*point) < 0.9 * quantum);
        }
        let gone = run.frames.last().unwrap().poses.iter().filter(|pose| pose.is_none());
        assert_eq!(gone.count(), 1);
    }
    assert_eq!(stream.0.next(), None);

    // A page of 200 heads and 600 steps may have 5 MB.
    let head_frames = 2 * HEADS * (STEPS / 2);
    let shapes = 30_000;
    assert!(text.len() < shapes + 40 * head_frames, "{} for {head_frames}", text.len());
}

/// Would catch a difference before bodies meet, and pages that lack a part or take titles for markup.
#[test]
fn runs_part_at_a_contact_and_pages_are_whole() {
    let runs = [Backend::Stock, Backend::Sbbk].map(recorded);
    let found = Difference::first(&runs[0], &runs[1]).unwrap();
    assert!(found.step > 20 && found.pair[0] < found.pair[1], "{found:?}");
    assert_eq!(Difference::first(&runs[1], &runs[1].clone()), None);
    let page = page("a < b", &runs);
    assert_eq!(page.matches("a &lt; b").count(), 2);
    let parts = ["style", "library", "decode", "draw", "play", "data", "title"];
    assert!(parts.iter().all(|part| !page.contains(&format!("@{part}@"))));
    assert_eq!(page.matches("</script>").count(), 3);
    assert!(!page.contains("<script src") && !page.contains("<link"));
}
