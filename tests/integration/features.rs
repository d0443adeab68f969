//! The tests of `main.rs` that compare bits or worlds, where Rapier's features change arithmetic or
//! threads. They are a binary of their own, as all is built anew with these features.

#![allow(dead_code, unused_imports, reason = "of what the tests share, these use a part")]

mod coming_back;
mod compound;
mod convex {
    pub mod shapes;
}
mod determinism;
mod heightfield {
    pub mod terrain;
}
mod kinds;
mod motion;
mod prelude;
mod properties;
mod same_mesh;
mod snapshot;
mod support;
mod threads;
mod truth;
mod worlds;
