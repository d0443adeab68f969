//! Points and planes, by four.

use glamx::DVec3;
use wide::f64x4;

/// Points in lanes; the first one pads the last lanes.
#[derive(Clone, Debug)]
pub(super) struct PointLanes(Vec<[f64x4; 3]>);

/// Four planes `normal·x = height` with unit normals; the first one pads missing lanes.
#[derive(Clone, Debug)]
pub(super) struct PlaneLanes {
    normals: [f64x4; 3],
    heights: f64x4,
}

#[inline(always)]
pub(super) fn splat(point: DVec3) -> [f64x4; 3] {
    [f64x4::splat(point.x), f64x4::splat(point.y), f64x4::splat(point.z)]
}

impl PlaneLanes {
    pub fn new(planes: &[(DVec3, f64)]) -> Self {
        let at = |i: usize| *planes.get(i).unwrap_or(&planes[0]);
        let axis = |axis: usize| f64x4::new([0, 1, 2, 3].map(|i| at(i).0[axis]));
        let heights = f64x4::new([0, 1, 2, 3].map(|i| at(i).1));
        Self { normals: [axis(0), axis(1), axis(2)], heights }
    }

    pub fn normal(&self, lane: usize) -> DVec3 {
        DVec3::from_array(self.normals.map(|axis| axis.to_array()[lane]))
    }

    /// Depth of a point below each plane.
    #[inline(always)]
    pub fn depth(&self, [x, y, z]: &[f64x4; 3]) -> f64x4 {
        let [nx, ny, nz] = self.normals;
        self.heights - (nx * *x + ny * *y + nz * *z)
    }
}

impl PointLanes {
    pub fn new(points: &[DVec3]) -> Self {
        let lanes = points.chunks(4).map(|four| {
            let at = |i: usize| *four.get(i).unwrap_or(&points[0]);
            let axis = |axis: usize| f64x4::new([0, 1, 2, 3].map(|i| at(i)[axis]));
            [axis(0), axis(1), axis(2)]
        });
        Self(lanes.collect())
    }

    pub fn iter(&self) -> impl Iterator<Item = DVec3> {
        self.0.iter().flat_map(|lanes| [0, 1, 2, 3].map(|lane| point_of(lanes, lane)))
    }

    /// Finds a point that is farthest along a direction, and its height.
    #[inline(always)]
    pub fn farthest(&self, direction: DVec3) -> (f64, DVec3) {
        let [x, y, z] = splat(direction);
        let (mut most, mut at) = (f64x4::splat(f64::NEG_INFINITY), f64x4::ZERO);
        for (i, lanes) in self.0.iter().enumerate() {
            let height = lanes[0] * x + lanes[1] * y + lanes[2] * z;
            at = most.simd_lt(height).bitselect(f64x4::splat(i as f64), at);
            most = most.fast_max(height);
        }
        let (most, at) = (most.to_array(), at.to_array());
        let lane = first_lane(|one, other| most[other] > most[one]);
        (most[lane], point_of(&self.0[at[lane] as usize], lane))
    }

    /// Four of the points that are not in one plane. `None` if the hull is thinner than `flat`.
    pub fn tetrahedron(&self, flat: f64) -> Option<[DVec3; 4]> {
        let a = self.iter().next()?;
        let across = |direction: DVec3| {
            let [up, down] = [direction, -direction].map(|u| (u, self.farthest(u)));
            let height = |(u, (height, _)): (DVec3, (f64, DVec3))| height - a.dot(u);
            let (farther, (_, point)) = if height(down) > height(up) { down } else { up };
            ((point - a).dot(farther) > flat).then_some(point)
        };
        let b = DVec3::AXES.into_iter().find_map(across)?;
        let along = (b - a).try_normalize()?;
        let aside = along.any_orthonormal_vector();
        let c = across(aside).or_else(|| across(along.cross(aside)))?;
        let d = across(along.cross(c - a).try_normalize()?)?;
        Some([a, b, c, d])
    }
}

/// The first of the best lanes; `is_better` compares a second one with a first.
#[inline(always)]
pub(super) fn first_lane(is_better: impl Fn(usize, usize) -> bool) -> usize {
    (1..4).fold(0, |best, other| if is_better(best, other) { other } else { best })
}

fn point_of(lanes: &[f64x4; 3], lane: usize) -> DVec3 {
    DVec3::from_array(lanes.map(|axis| axis.to_array()[lane]))
}
