//! Machine and build of a measurement.

use std::env::consts::ARCH;
use std::fs;
use std::process::Command;

use crate::parallel::threads;

/// Processor, threads, compiler, profile and vector instructions of this process.
pub(super) fn environment() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find(|line| line.starts_with("model name"));
    let model = model.and_then(|line| Some(line.split_once(':')?.1.trim()));
    let rapier = if cfg!(feature = "parallel") { "on its threads" } else { "on one thread" };
    // The compiler in the path, which built this program if nothing was changed since.
    let rustc = said_by("rustc", &["--version"]);
    let profile = if cfg!(debug_assertions) { "debug assertions" } else { "release" };
    let simd = match () {
        () if cfg!(target_feature = "avx512f") => "avx512f",
        () if cfg!(target_feature = "avx2") => "avx2",
        () if cfg!(target_feature = "sse2") => "sse2",
        () if cfg!(target_feature = "neon") => "neon",
        () => "no simd",
    };
    let (cpu, cores) = (model.unwrap_or(ARCH), threads());
    format!("{cpu}, {cores} cores; Rapier {rapier}; {rustc}; {profile}, {simd}")
}

/// What a program prints; nothing if there is no such program.
pub(super) fn said_by(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output();
    let text = output.ok().and_then(|output| String::from_utf8(output.stdout).ok());
    text.map_or_else(String::new, |text| text.trim().to_owned())
}
