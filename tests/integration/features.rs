//! The tests of `main.rs` that compare bits or worlds, where Rapier's features change arithmetic or
//! threads. They are a binary of their own, as all is built anew with these features.

#![allow(dead_code, reason = "of what the tests share, these use a part")]

mod allocation;
mod coming_back;
mod convex {
    mod motion;
    mod question;
    mod shapes;
}
mod determinism;
mod heightfield {
    mod motion;
    mod terrain;
}
mod motion;
mod same_mesh;
mod snapshot;
mod support;
mod truth;
