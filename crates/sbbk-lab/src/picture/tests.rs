//! Small pictures, judged by single pixels.

use std::fs::File;
use std::io::BufReader;

use glamx::{Pose3, Vec3};

use super::{Camera, Colour, Picture, PictureError};
use crate::mesh::{self, Mesh};

const WIDTH: usize = 64;
const HEIGHT: usize = 48;
const RED: Colour = [220, 20, 20];
const BLUE: Colour = [20, 20, 220];

/// A picture from the `z` axis, five units away from the origin.
fn front_view() -> Picture {
    let camera = Camera::looking(Vec3::Z * 5.0, Vec3::ZERO);
    Picture::new(WIDTH as u32, HEIGHT as u32, camera)
}

/// The picture's pixels as they come out of the file, by rows.
fn pixels(picture: &Picture) -> Vec<[u8; 3]> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    picture.save(&path).unwrap();
    let file = BufReader::new(File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((frame.width, frame.height), (WIDTH as u32, HEIGHT as u32));
    bytes.as_chunks::<3>().0.to_vec()
}

fn centre(picture: &Picture) -> [u8; 3] {
    pixels(picture)[HEIGHT / 2 * WIDTH + WIDTH / 2]
}

/// Whether a pixel is of this colour, lit or shaded.
fn is_like(pixel: [u8; 3], colour: Colour) -> bool {
    let strongest = |channels: [u8; 3]| (0..3).max_by_key(|&i| channels[i]);
    let [low, high] = [pixel.iter().min().unwrap(), pixel.iter().max().unwrap()];
    strongest(pixel) == strongest(colour) && *high / 2 > *low
}

fn wall(z: f32) -> Mesh {
    mesh::cuboid(Vec3::new(1.0, 1.0, 0.1), 1).mapped(|v| v + Vec3::Z * z)
}

/// Catches a depth test that goes by the order of drawing.
#[test]
fn the_nearest_surface_is_seen() {
    for order in [[0, 1], [1, 0]] {
        let mut picture = front_view();
        for index in order {
            let colour = [RED, BLUE][index];
            picture.draw(&wall(index as f32), Pose3::IDENTITY, colour);
        }
        let pixel = centre(&picture);
        assert!(is_like(pixel, BLUE), "{pixel:?}");
    }
}

/// Catches a mirrored or upside-down picture.
#[test]
fn right_is_right_and_up_is_up() {
    let mut picture = front_view();
    let dot = mesh::ball(0.2, 4);
    picture.draw(&dot, Pose3::translation(1.0, 0.0, 0.0), RED);
    picture.draw(&dot, Pose3::translation(0.0, 1.0, 0.0), BLUE);
    let pixels = pixels(&picture);
    let middle = |colour| {
        let found: Vec<usize> = (0..pixels.len()).filter(|&i| is_like(pixels[i], colour)).collect();
        assert!(!found.is_empty());
        let sum = found.iter().fold([0, 0], |[x, y], i| [x + i % WIDTH, y + i / WIDTH]);
        sum.map(|s| s / found.len())
    };
    let [x, y] = middle(RED);
    assert!(x > WIDTH / 2 + 5 && y.abs_diff(HEIGHT / 2) < 2, "{x} {y}");
    let [x, y] = middle(BLUE);
    assert!(y < HEIGHT / 2 - 5 && x.abs_diff(WIDTH / 2) < 2, "{x} {y}");
}

/// A floor from behind the camera to far ahead fills the lower half: without clipping its triangles
/// would vanish or turn over.
#[test]
fn what_reaches_behind_the_camera_is_cut() {
    let mut picture = front_view();
    let floor = mesh::floor(1000.0, 1);
    picture.draw(&floor, Pose3::translation(0.0, -1.0, 0.0), RED);
    for (index, pixel) in pixels(&picture).into_iter().enumerate() {
        let row = index / WIDTH;
        if row.abs_diff(HEIGHT / 2) > 2 {
            assert_eq!(is_like(pixel, RED), row > HEIGHT / 2, "row {row}: {pixel:?}");
        }
    }
}

/// Catches a lost shadow, one cast upwards, and a surface that shades itself all over.
#[test]
fn shadows_fall_on_the_ground() {
    let camera = Camera::looking(Vec3::new(0.0, 8.0, 8.0), Vec3::ZERO);
    let brightness = |with_roof: bool| {
        let mut picture = Picture::new(WIDTH as u32, HEIGHT as u32, camera).with_ground(0.0);
        if with_roof {
            let roof = mesh::cuboid(Vec3::new(1.0, 0.05, 1.0), 1);
            picture.draw(&roof, Pose3::translation(-1.0, 2.5, 1.8), RED);
        }
        u32::from(centre(&picture)[1])
    };
    assert!(brightness(true) * 4 < brightness(false) * 3);

    let mut picture = Picture::new(WIDTH as u32, HEIGHT as u32, camera);
    picture.draw(&mesh::floor(40.0, 40), Pose3::IDENTITY, RED);
    let pixels = pixels(&picture);
    let mut reds = pixels.iter().filter(|p| is_like(**p, RED)).map(|p| p[0]);
    let first = reds.next().unwrap();
    assert!(reds.all(|red| red.abs_diff(first) < 8), "a flat floor shades itself");
}

/// "which hides what is below"
#[test]
fn the_ground_hides_what_is_below() {
    let camera = Camera::looking(Vec3::new(0.0, 3.0, 5.0), Vec3::NEG_Y);
    for (ground, hidden) in [(0.0, true), (-3.0, false)] {
        let mut picture = Picture::new(WIDTH as u32, HEIGHT as u32, camera).with_ground(ground);
        picture.draw(&mesh::ball(0.5, 4), Pose3::translation(0.0, -1.0, 0.0), RED);
        assert_eq!(is_like(centre(&picture), RED), !hidden);
    }
}

/// Catches segments without depth, and ones lost when they begin behind the camera.
#[test]
fn segments_are_hidden_cut_and_drawn() {
    let draw = |from: Vec3, to: Vec3| {
        let mut picture = front_view();
        picture.draw(&wall(0.0), Pose3::IDENTITY, RED);
        picture.segment(from, to, 4.0, BLUE);
        is_like(centre(&picture), BLUE)
    };
    let across = |z: f32| draw(Vec3::new(-2.0, 0.0, z), Vec3::new(2.0, 0.0, z));
    assert!(across(1.0));
    assert!(across(0.1), "on the surface");
    assert!(!across(-1.0));
    assert!(draw(Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, -2.0, 9.0)));
    assert!(draw(Vec3::new(0.0, 2.0, 9.0), Vec3::new(0.0, 0.0, 1.0)));
    assert!(!draw(Vec3::new(0.0, 0.0, 6.0), Vec3::new(0.0, 0.0, 9.0)));
}

#[test]
fn unwritable_pictures_name_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("missing").join("picture.png");
    let error = front_view().save(&path).unwrap_err();
    assert!(error.to_string().contains(&path.display().to_string()));
    let empty = Picture::new(0, 10, Camera::looking(Vec3::Z, Vec3::ZERO));
    let error = empty.save(&folder.path().join("empty.png")).unwrap_err();
    assert!(matches!(error, PictureError::Write { .. }), "{error}");
}
