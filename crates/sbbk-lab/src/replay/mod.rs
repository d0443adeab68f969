//! Runs of a scene to be played side by side in a browser.
//!
//! A [`Recorder`] looks at a world after each step; [`write()`] puts the recordings of one scene
//! into one self-contained page. Poses are quantised to a thousandth of the smallest moving body.
//!
//! ```no_run
//! use sbbk_lab::backend::Backend;
//! use sbbk_lab::progress::Progress;
//! use sbbk_lab::replay;
//! use sbbk_lab::scene::MonkeyPile;
//!
//! let pile = MonkeyPile::with_heads(8);
//! replay::play("page.html".as_ref(), &pile, &[Backend::Stock, Backend::Sbbk], 120, &Progress::hidden())?;
//! # Ok::<(), std::io::Error>(())
//! ```

use crate::prelude::*;
mod encode;
mod recorder;
mod shapes;
#[cfg(test)]
mod tests;

use crate::report::write_file;

pub use encode::encode;
pub use recorder::Recorder;

/// Runs a scene on some backends, all at the same time, and writes their page.
///
/// Errors: the file cannot be written.
pub fn play(
    path: &Path,
    scene: &dyn Scene,
    backends: &[Backend],
    steps: usize,
    progress: &Progress,
) -> io::Result<()> {
    let start = |&backend: &Backend| {
        let SceneWorld { mut world, .. } = scene.build();
        let dispatcher = backend.install(&mut world);
        (Recorder::new(backend, &world), world, dispatcher)
    };
    let mut runs: Vec<_> = backends.iter().map(start).collect();
    progress.phase("the run of the page", steps);
    for _ in 0..steps {
        progress.step();
        runs.iter_mut().for_each(|(recorder, world, _)| recorder.step(world));
    }
    let recorders: Vec<Recorder> = runs.into_iter().map(|(recorder, ..)| recorder).collect();
    write(path, &scene.name(), &recorders)
}

/// Writes the runs of one scene, the first beside the others, into a page.
///
/// Errors: the file cannot be written.
pub fn write(path: &Path, title: &str, runs: &[Recorder]) -> io::Result<()> {
    write_file(path, page(title, runs))
}

fn page(title: &str, runs: &[Recorder]) -> String {
    let parts = [
        ("@title@", &*title.replace('&', "&amp;").replace('<', "&lt;")),
        ("@style@", include_str!("page/style.css")),
        // [OGL](https://github.com/oframe/ogl) is in the public domain; its licence is in the page.
        ("@library@", include_str!("page/ogl.min.js")),
        ("@decode@", include_str!("page/decode.js")),
        ("@draw@", include_str!("page/draw.js")),
        ("@play@", include_str!("page/play.js")),
        ("@data@", &encode(runs)),
    ];
    let page = include_str!("page/page.html").to_owned();
    parts.iter().fold(page, |page, (name, part)| page.replace(name, part))
}
