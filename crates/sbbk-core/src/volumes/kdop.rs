use glamx::Vec3;

use super::rounding::gamma;
use super::{Aabb, DirectionSet, Directions, Slabs};

/// A discrete oriented polytope of `AXES` slabs, k = 2·`AXES` half-spaces.
///
/// The first three slabs are those of the [`Aabb`]. Klosowski et al., *Efficient Collision
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
    /// The k-DOP of no point at all: merging with it changes nothing.
    pub const EMPTY: Self = Self { min: [f32::INFINITY; AXES], max: [f32::NEG_INFINITY; AXES] };

    /// The k-DOP around `points`.
    pub fn fit(points: &[Vec3]) -> Self {
        let mut kdop = Self::EMPTY;
        for &point in points {
            let projections = <Directions<AXES> as DirectionSet<AXES>>::project(point);
            // Comparisons, as `f32::min` has to care about NaN; a NaN is left out here.
            for axis in 0..AXES {
                let projection = projections[axis];
                let (min, max) = (kdop.min[axis], kdop.max[axis]);
                kdop.min[axis] = if projection < min { projection } else { min };
                kdop.max[axis] = if projection > max { projection } else { max };
            }
        }
        Self::of_projections(kdop.min, kdop.max)
    }

    /// The k-DOP around two.
    #[must_use]
    pub fn merge(&self, other: &Self) -> Self {
        let mut merged = *self;
        for axis in 0..AXES {
            let (min, max) = (other.min[axis], other.max[axis]);
            merged.min[axis] = if min < merged.min[axis] { min } else { merged.min[axis] };
            merged.max[axis] = if max > merged.max[axis] { max } else { merged.max[axis] };
        }
        merged
    }

    /// Whether `point` is in the k-DOP, computed in f64: fitted points are.
    pub fn contains(&self, point: Vec3) -> bool {
        let coordinates = point.as_dvec3().to_array();
        let projections = <Directions<AXES> as DirectionSet<AXES>>::project_components(coordinates);
        let ends = self.min.iter().zip(&self.max);
        ends.zip(projections).all(|((&min, &max), x)| f64::from(min) <= x && x <= f64::from(max))
    }

    /// The k-DOP of points whose projections have these ends.
    ///
    /// All directions but the axes get the slack of the largest coordinates, for what projections
    /// round: one a corner is no tighter, and takes twice the time.
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
}
