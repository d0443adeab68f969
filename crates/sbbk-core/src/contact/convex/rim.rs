//! The rim of a disc around the y axis, and an edge.

use glamx::DVec3;

/// Steps of Newton's method at most; some five are taken.
const STEPS: u32 = 40;

/// The last step, as a share of the tangent. The depth is off by the square of it.
const STEP: f64 = 1.0e-9;

/// The line of an edge, seen along the axis. Places are shares of the edge.
pub(super) struct LevelEdge {
    /// Square of the length.
    pub(super) squared: f64,
    /// The place nearest to the axis.
    pub(super) to_axis: f64,
    /// Twice the area of the triangle with the axis.
    area: f64,
}

impl LevelEdge {
    #[inline(always)]
    pub(super) fn new(start: DVec3, edge: DVec3) -> Self {
        let squared = edge.x * edge.x + edge.z * edge.z;
        Self {
            squared,
            to_axis: -(start.x * edge.x + start.z * edge.z) / squared,
            area: start.x * edge.z - start.z * edge.x,
        }
    }

    /// Half the chord of a circle around the axis; NaN if the line passes the circle.
    #[inline(always)]
    pub(super) fn half_chord(&self, radius: f64) -> f64 {
        let beside = self.area.powi(2) / self.squared;
        ((radius * radius - beside) / self.squared).sqrt()
    }

    /// The place nearest to an endless slope, which comes `lean` nearer to the axis for each unit
    /// up. `up` is the height of the edge.
    ///
    /// Across the slope the distance varies with `√(a² + l² t²) + lean y t`. The edge has the level
    /// length `l` and the height `y`. It is nearest to the axis at `t = 0`, at distance `a`. The
    /// minimum is at `l² t = -lean y √(a² + l² t²)`. Steeper edges have none.
    #[inline(always)]
    pub(super) fn near_slope(&self, up: f64, lean: f64) -> f64 {
        let fall = -lean * up;
        if fall == 0.0 {
            return self.to_axis;
        }
        let beside = self.area / self.squared;
        self.to_axis + fall * beside.abs() / (self.squared - fall * fall).sqrt()
    }
}

/// The direction, by level and upright coordinates, of the least depth of the surface that a rim
/// and an edge make. The centre of the rim is at `(a, b)` from the edge; `rise` is the height of
/// the upright unit vector across the edge. `None` if no direction with a positive or zero upright
/// part has a least depth.
///
/// Along `(cos f, sin f)` the depth is `a cos f + b sin f + r √(1 - rise² sin² f)`. With `t = tan
/// f` and `a < 0`, the minimum has `f < 90°`, and the slope has the sign of `|a| t + b - r rise² t
/// / √(1 + run² t²)`, `run² = 1 - rise²`. This function is convex for `t > 0`. So the depth is
/// least at the last root, which Newton's method approaches from above. If `a > 0` and `b > 0`, the
/// slope over `sin f cos f` falls, and there is no least depth.
#[inline(always)]
pub(super) fn rim_and_edge([a, b]: [f64; 2], rise: f64, radius: f64) -> Option<[f64; 2]> {
    let (steep, sign) = (a.abs(), if a < 0.0 { 1.0 } else { -1.0 });
    let lift = radius * rise * rise;
    if b >= 0.0 && steep >= lift {
        // In the plane of the rim it is least where the cone's normals go on beyond.
        return (b == 0.0).then_some([sign, 0.0]);
    }
    let run_squared = (1.0 - rise * rise).max(0.0);
    let value = |t: f64| {
        let root = (1.0 + run_squared * t * t).sqrt();
        (steep * t + b - lift * t / root, steep - lift / (root * root * root))
    };
    // The product is at most `lift / run`, and at most `lift t`.
    let by_run = (lift / run_squared.sqrt() - b) / steep;
    let by_tangent = -b / (steep - lift);
    let mut t = if steep > lift && by_tangent < by_run { by_tangent } else { by_run };
    if !t.is_finite() {
        return Some([0.0, 1.0]);
    }
    for _ in 0..STEPS {
        let (height, slope) = value(t);
        // Past the lowest point: there is no root.
        let falls = slope > 0.0 && height >= 0.0;
        if !falls {
            if height > 0.0 {
                return None;
            }
            break;
        }
        let step = height / slope;
        t -= step;
        if t <= 0.0 {
            return None;
        }
        if step <= STEP * t {
            break;
        }
    }
    let scale = 1.0 / (1.0 + t * t).sqrt();
    Some([sign * scale, t * scale])
}
