//! The questions, where they are asked, and what is kept of the answers.

use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;
use rapier3d::parry::query::details::ShapeCastOptions;
use rapier3d::parry::query::{ClosestPoints, NonlinearRigidMotion};

use crate::backend::{Memory, SharedDispatcher};
pub(super) use crate::study::motion::Place as Placed;

named! {
    /// A kind of question.
    pub(super) enum Query {
        /// The distance.
        Distance = "distance",
        /// The closest points, at any distance.
        ClosestPoints = "closest points",
        /// Whether the surfaces meet.
        Intersection = "intersection",
        /// The deepest contact, or the nearest within a tenth of the size.
        Contact = "contact",
        /// The first impact on the way towards the first mesh.
        Cast = "cast",
        /// The same while turning, by one radian on a way of the size.
        NonlinearCast = "nonlinear cast",
        /// The contact manifolds of touching triangles, with nothing known of the pair.
        Contacts = "all contacts",
    }
}

impl Query {
    /// The largest mesh that is asked about: stock takes seconds for a nonlinear cast of larger
    /// ones.
    pub fn largest_mesh(self) -> usize {
        if self == Self::NonlinearCast { 1000 } else { usize::MAX }
    }

    /// Where it is asked.
    pub fn distances(self) -> &'static [Distance] {
        use Distance::{Crossing, Far, HardlyApart, Near};
        match self {
            Self::Distance => &[HardlyApart, Near, Far],
            Self::ClosestPoints => &[Near],
            Self::Intersection => &[Crossing, HardlyApart, Near],
            Self::Contact => &[Crossing, Near],
            Self::Cast | Self::NonlinearCast => &[Far],
            Self::Contacts => &[Crossing],
        }
    }
}

named! {
    /// How far the second mesh stands off the first touch on its way, in sizes of the mesh.
    pub(super) enum Distance {
        /// 0.03 beyond it.
        Crossing = "crossing",
        /// 0.001 short of it.
        HardlyApart = "hardly apart",
        /// 0.05 short of it.
        Near = "near",
        /// 1 short of it.
        Far = "far",
    }
}

impl Distance {
    /// Way back from the first touch, in sizes.
    pub fn back(self) -> Real {
        match self {
            Self::Crossing => -0.03,
            Self::HardlyApart => 0.001,
            Self::Near => 0.05,
            Self::Far => 1.0,
        }
    }
}

/// An answer, by what can be judged of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Answered {
    /// A distance, or minus a depth; none beyond the limit of the query.
    Distance(Option<Real>),
    /// Whether the meshes meet.
    Meet(bool),
    /// A time of impact, or none.
    Time(Option<Real>),
    /// How many pairs of triangles.
    Pairs(usize),
}

impl Answered {
    /// As one number for files; NaN for none.
    pub fn number(self) -> f64 {
        match self {
            Self::Distance(x) | Self::Time(x) => x.map_or(f64::NAN, f64::from),
            Self::Meet(meet) => f64::from(u8::from(meet)),
            Self::Pairs(count) => count as f64,
        }
    }
}

/// The motion of the second mesh in a nonlinear cast.
pub(super) fn motion(placed: &Placed, size: Real) -> NonlinearRigidMotion {
    let turn = placed.direction.any_orthonormal_vector() / size;
    NonlinearRigidMotion::new(placed.pos12, Default::default(), -placed.direction, turn)
}

/// Asks about a mesh and itself.
pub(super) fn ask(
    query: Query,
    dispatcher: &SharedDispatcher,
    shape: &SharedShape,
    placed: &Placed,
    size: Real,
) -> Answered {
    let (pos12, mesh) = (&placed.pos12, &**shape);
    let supported = "every backend answers for two meshes";
    match query {
        Query::Distance => {
            let found = dispatcher.distance(pos12, mesh, mesh).expect(supported);
            Answered::Distance(Some(found.distance))
        }
        Query::ClosestPoints => {
            let found = dispatcher.closest_points(pos12, mesh, mesh, Real::MAX).expect(supported);
            Answered::Distance(match found {
                ClosestPoints::Intersecting => Some(0.0),
                ClosestPoints::WithinMargin(p1, p2) => Some((pos12 * p2 - p1).length()),
                ClosestPoints::Disjoint => None,
            })
        }
        Query::Intersection => {
            let found = dispatcher.intersection_test(pos12, mesh, mesh).expect(supported);
            Answered::Meet(found.intersecting)
        }
        Query::Contact => {
            let found = dispatcher.contact(pos12, mesh, mesh, 0.1 * size).expect(supported);
            Answered::Distance(found.map(|contact| contact.dist))
        }
        Query::Cast => {
            let options = ShapeCastOptions::with_max_time_of_impact(8.0 * size);
            let found = dispatcher.cast_shapes(pos12, -placed.direction, mesh, mesh, options);
            Answered::Time(found.expect(supported).map(|hit| hit.time_of_impact))
        }
        Query::NonlinearCast => {
            let motions = [NonlinearRigidMotion::identity(), motion(placed, size)];
            let [motion1, motion2] = &motions;
            let found = dispatcher.cast_shapes_nonlinear(
                motion1,
                mesh,
                motion2,
                mesh,
                0.0,
                4.0 * size,
                true,
            );
            Answered::Time(found.expect(supported).map(|hit| hit.time_of_impact))
        }
        Query::Contacts => {
            let mut memory = Memory::default();
            memory.ask(dispatcher, [mesh; 2], pos12, 0.0);
            Answered::Pairs(memory.manifolds.iter().filter(|m| !m.points.is_empty()).count())
        }
    }
}
