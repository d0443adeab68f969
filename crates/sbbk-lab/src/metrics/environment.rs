//! Where and how a measurement was taken.

use std::fmt;
use std::fs;
use std::thread::available_parallelism;

use serde::Serialize;

use crate::backend::clock_cost;

/// What a reader must know to compare times with their own.
#[derive(Clone, Debug, Serialize)]
pub struct Environment {
    /// Model of the processor, or its architecture where the system does not tell.
    pub cpu: String,
    /// Hardware threads that the process may use.
    pub cores: usize,
    /// Whether Rapier uses one of them or all: its `parallel` feature.
    pub rapier: &'static str,
    /// Version of the compiler.
    pub rustc: &'static str,
    /// Optimised, or with debug assertions.
    pub profile: &'static str,
    /// Vector instructions that the compiler was allowed to use.
    pub simd: &'static str,
    /// What the clock adds to each timed query, in nanoseconds.
    pub clock_ns: u64,
}

impl Environment {
    /// The machine and build of this process.
    pub fn detect() -> Self {
        Self {
            cpu: cpu_model().unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
            cores: available_parallelism().map_or(1, usize::from),
            rapier: if cfg!(feature = "parallel") { "parallel" } else { "on one thread" },
            rustc: env!("SBBK_LAB_RUSTC"),
            profile: if cfg!(debug_assertions) { "debug assertions" } else { "release" },
            simd: match () {
                () if cfg!(target_feature = "avx512f") => "avx512f",
                () if cfg!(target_feature = "avx2") => "avx2",
                () if cfg!(target_feature = "sse2") => "sse2",
                () if cfg!(target_feature = "neon") => "neon",
                () => "no simd",
            },
            clock_ns: clock_cost().as_nanos() as u64,
        }
    }
}

impl fmt::Display for Environment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { cpu, cores, rapier, rustc, profile, simd, clock_ns } = self;
        write!(
            f,
            "{cpu}, {cores} cores; Rapier {rapier}; {rustc}; {profile}, {simd}; clock {clock_ns} ns a query"
        )
    }
}

/// The first model name in Linux's list of processors.
fn cpu_model() -> Option<String> {
    let info = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = info.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}
