//! Machine and build of a measurement.

use std::fmt;
use std::fs;
use std::thread::available_parallelism;

use crate::report::said_by;

/// Machine and build of a measurement.
#[derive(Clone, Debug)]
pub struct Environment {
    /// Model of the processor, or its architecture where the system does not tell.
    pub cpu: String,
    /// Hardware threads that the process may use.
    pub cores: usize,
    /// Threads that Rapier uses.
    pub rapier: &'static str,
    /// Version of the compiler in the path, which built this program if nothing was changed since.
    pub rustc: String,
    /// `release`, or with debug assertions.
    pub profile: &'static str,
    /// Vector instructions that the compiler was allowed to use.
    pub simd: &'static str,
}

impl Environment {
    /// The machine and build of this process.
    pub fn detect() -> Self {
        let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let model = info.lines().find(|line| line.starts_with("model name"));
        let model = model.and_then(|line| Some(line.split_once(':')?.1.trim()));
        Self {
            cpu: model.unwrap_or(std::env::consts::ARCH).to_owned(),
            cores: available_parallelism().map_or(1, usize::from),
            rapier: if cfg!(feature = "parallel") { "on its threads" } else { "on one thread" },
            rustc: said_by("rustc", &["--version"]),
            profile: if cfg!(debug_assertions) { "debug assertions" } else { "release" },
            simd: match () {
                () if cfg!(target_feature = "avx512f") => "avx512f",
                () if cfg!(target_feature = "avx2") => "avx2",
                () if cfg!(target_feature = "sse2") => "sse2",
                () if cfg!(target_feature = "neon") => "neon",
                () => "no simd",
            },
        }
    }
}

impl fmt::Display for Environment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { cpu, cores, rapier, rustc, profile, simd } = self;
        write!(f, "{cpu}, {cores} cores; Rapier {rapier}; {rustc}; {profile}, {simd}")
    }
}
