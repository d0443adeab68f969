use glamx::{Pose3, Vec3};

use super::rounding::gamma;
use super::{Aabb, DirectionSet, Directions, Slabs, Volume};

/// A discrete oriented polytope of `AXES` slabs, k = 2·`AXES` half-spaces.
///
/// The first three slabs are those of the [`Aabb`](super::Aabb). Klosowski et al., *Efficient Collision
/// Detection Using Bounding Volume Hierarchies of k-DOPs*, 1998.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Kdop<const AXES: usize> {
    /// The smallest projection on each direction of the [`DirectionSet`].
    pub min: Slabs<AXES>,
    /// The largest projection on each direction.
    pub max: Slabs<AXES>,
}

/// Faces of the cube and its corners.
pub type Kdop14 = Kdop<7>;
/// Faces of the cube and its edges: the best of the three in most measurements, here as in the
/// literature.
pub type Kdop18 = Kdop<9>;
/// Faces, edges and corners.
pub type Kdop26 = Kdop<13>;

impl<const AXES: usize> Kdop<AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    /// The slabs' directions.
    pub const DIRECTIONS: [Vec3; AXES] = <Directions<AXES> as DirectionSet<AXES>>::DIRECTIONS;

    /// The k-DOP grown to contain `point`. Fitting points one by one costs two additions a slab.
    ///
    /// A projection on more than one axis rounds: two additions of exact terms lose at most
    /// γ_2·(|x| + |y| + |z|) of it.
    #[must_use]
    pub fn with_point(mut self, point: Vec3) -> Self {
        let slack = gamma(3) * (point.x.abs() + point.y.abs() + point.z.abs());
        let projections = <Directions<AXES> as DirectionSet<AXES>>::project(point);
        for axis in 0..AXES {
            let slack = if axis < 3 { 0.0 } else { slack };
            // Comparisons, as `f32::min` has to care about NaN; a NaN is left out here.
            let (low, high) = (projections[axis] - slack, projections[axis] + slack);
            self.min[axis] = if low < self.min[axis] { low } else { self.min[axis] };
            self.max[axis] = if high > self.max[axis] { high } else { self.max[axis] };
        }
        self
    }

    /// The k-DOP of points whose projections have these ends.
    ///
    /// One slack for all directions but the axes, that of the largest coordinates, for what the projections round.
    pub(crate) fn of_projections(min: Slabs<AXES>, max: Slabs<AXES>) -> Self {
        let mut kdop = Self { min, max };
        let magnitude = |axis: usize| min[axis].abs().max(max[axis].abs());
        let slack = gamma(3) * (magnitude(0) + magnitude(1) + magnitude(2));
        for axis in 3..AXES {
            kdop.min[axis] -= slack;
            kdop.max[axis] += slack;
        }
        kdop
    }

    /// The box of the first three slabs.
    pub(crate) fn aabb(&self) -> Aabb {
        let corner = |slabs: &Slabs<AXES>| Vec3::new(slabs[0], slabs[1], slabs[2]);
        Aabb { min: corner(&self.min), max: corner(&self.max) }
    }

    /// The largest absolute slab bound.
    fn magnitude(&self) -> f32 {
        self.min.iter().chain(&self.max).fold(0.0, |m: f32, x| m.max(x.abs()))
    }
}

impl<const AXES: usize> Volume for Kdop<AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    const EMPTY: Self = Self { min: [f32::INFINITY; AXES], max: [f32::NEG_INFINITY; AXES] };

    /// As point by point, but with one slack for all, that of the largest coordinates: half the time.
    fn fit(points: &[Vec3]) -> Self {
        let mut kdop = Self::EMPTY;
        for &point in points {
            let projections = <Directions<AXES> as DirectionSet<AXES>>::project(point);
            for axis in 0..AXES {
                let projection = projections[axis];
                let (min, max) = (kdop.min[axis], kdop.max[axis]);
                kdop.min[axis] = if projection < min { projection } else { min };
                kdop.max[axis] = if projection > max { projection } else { max };
            }
        }
        Self::of_projections(kdop.min, kdop.max)
    }

    fn merge(&self, other: &Self) -> Self {
        let mut merged = *self;
        for axis in 0..AXES {
            let (min, max) = (other.min[axis], other.max[axis]);
            merged.min[axis] = if min < merged.min[axis] { min } else { merged.min[axis] };
            merged.max[axis] = if max > merged.max[axis] { max } else { merged.max[axis] };
        }
        merged
    }

    fn overlaps(&self, other: &Self, margin: f32) -> bool {
        // As for boxes; a margin is |d| times longer along a direction d.
        (0..AXES).all(|axis| {
            let length = Self::DIRECTIONS[axis].length();
            let gap = (self.min[axis] - other.max[axis]).max(other.min[axis] - self.max[axis]);
            gap <= margin * length * (1.0 + gamma(4))
        })
    }

    /// By the correspondence of the [`DirectionSet`]: each direction of the new frame is a
    /// combination of three old ones.
    ///
    /// Rounding: the coefficients are f64 rounded once to f32 and are at most 2 in magnitude (γ_1), the
    /// three products and sums lose γ_4, the translation γ_3 of its three terms: below
    /// γ_8·(6·magnitude + 3·|t|).
    fn transformed(&self, pose: &Pose3) -> Self {
        let inverse = pose.rotation.as_dquat().inverse();
        let slack =
            gamma(8) * (6.0 * self.magnitude() + 3.0 * pose.translation.abs().max_element());
        let mut moved = Self::EMPTY;
        for axis in 0..AXES {
            let direction = Self::DIRECTIONS[axis];
            let offset = direction.dot(pose.translation);
            let terms = Directions::<AXES>::correspondence(inverse * direction.as_dvec3());
            let (mut min, mut max) = (offset, offset);
            for (slab, coefficient) in terms {
                let coefficient = coefficient as f32;
                let ends = [coefficient * self.min[slab], coefficient * self.max[slab]];
                min += ends[0].min(ends[1]);
                max += ends[0].max(ends[1]);
            }
            moved.min[axis] = min - slack;
            moved.max[axis] = max + slack;
        }
        moved
    }

    /// With the slack of [`with_point`](Self::with_point), so that fitted points are inside.
    fn contains(&self, point: Vec3) -> bool {
        let other = Self::EMPTY.with_point(point);
        (0..AXES).all(|axis| other.max[axis] >= self.min[axis] && other.min[axis] <= self.max[axis])
    }
}
