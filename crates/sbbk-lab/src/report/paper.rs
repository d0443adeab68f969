//! The paper's results.

/// All numbers that "A Three-layer Hybrid Bounding Volume Hierarchy for Collision Detection" gives.
///
/// It names neither machine nor engine, nor triangle counts, the k of its k-DOPs or the depth of
/// the layers. Its Diagram 1 is a picture without numbers; of it, only the point at 2000 heads is
/// known, from Table 2.
#[derive(Clone, Copy, Debug)]
pub struct Paper {
    /// Table 1: frames a second of ball and helicopter with AABBs, drawing included.
    pub aabb_fps: f64,
    /// Table 1, with SBBK.
    pub sbbk_fps: f64,
    /// Table 2: milliseconds of "the whole time of CD process" in a pile with AABBs. It is not
    /// said whether this is a frame's time.
    pub aabb_ms: f64,
    /// Table 2, with SBBK.
    pub sbbk_ms: f64,
    /// Table 2: number of monkey heads.
    pub heads: usize,
}

/// The paper's results.
pub const PAPER: Paper =
    Paper { aabb_fps: 162.0, sbbk_fps: 180.0, aabb_ms: 71.8, sbbk_ms: 34.5, heads: 2000 };

impl Paper {
    /// How many times more frames a second SBBK gave than AABBs.
    pub fn fps_ratio(&self) -> f64 {
        self.sbbk_fps / self.aabb_fps
    }

    /// How many times less time collision detection took with SBBK than with AABBs.
    pub fn time_ratio(&self) -> f64 {
        self.aabb_ms / self.sbbk_ms
    }
}
