//! Triangles that lie over one face of a cuboid, which on a floor all do: the contacts of Parry's
//! routine, bit for bit, without its search.
//!
//! Parry's routine tries 16 axes and clips the triangle with the face that wins: twelve pairs of
//! edges, seven corners. That was four fifths of a query about a floor. If all of a triangle is
//! well inside the outline of a face there is little to find: only the axes that the triangle has a
//! part in can beat that of the face, and the points are the triangle's corners, seen from the
//! face. If another axis wins, or the triangle is not inside, Parry's routine is asked.
//!
//! Inside is by a share of the cuboid's size, so that no rounding makes an edge of the triangle
//! cross the outline, and slivers are left to Parry's routine, in whose clip rounding can put a
//! corner of the face into them.
//!
//! # Axes that need no test
//!
//! Let `c` be the distance of the triangle to the outline of the face, `s` its signed distance to
//! the face, `l` the length of an edge of the triangle, `z` its part along the normal, `H` the sum
//! of the cuboid's half-lengths and `u = 2⁻²⁴`.
//!
//! * *Other faces*: each of Parry's gaps is that of some corner and at most that of the lowest one,
//!   as rounding is monotone.
//! * *Products of edges*: along a direction of length 1 with the part `m` across the normal, the
//!   lowest corner shows the gap to be at most `s - (c - |s|)·m`, if the face opposite does not
//!   win. The products of an edge have `m >= |z|/l`. With `c >= 2|s|`, `c >= H/128` and `|z| >=
//!   l/512` the gap is below `s` by `c/1024 >= 128·u·H`. Parry's sums lose below `10·u·(2·H + |s| +
//!   l)`, and with `c >= 3l` that is below `30·u·H`.
//!
//! # Corners of the face
//!
//! Seen along the normal, let `A` be the area of the triangle and `L` its longest edge. A corner of
//! the face is `c` or more away from it. If its barycentric coordinates were all above `-c/3L`, it
//! would be in the triangle blown up by `1 + c/L` about its centroid, so nearer; one is below, and
//! so one is at least 1/3. Parry looks at the signs of these times `2·A`, as signed areas that it
//! has but for `20·u·L·H`: two differ if `A·c/L >= 64·u·L·H`. Where `2·A` is below 2⁻²³ it does not
//! look, so that the product of two signed areas does not underflow.

use glamx::Vec3;
use parry3d::math::{Pose, Real};
use parry3d::query::sat::{
    cuboid_triangle_find_local_separating_edge_twoway,
    triangle_cuboid_find_local_separating_normal_oneway,
};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::{Cuboid, PackedFeatureId, SupportMap, Triangle};

/// `c/H`.
const INSIDE_OF_SIZE: Real = 1.0 / 128.0;
/// `c/|s|`.
const INSIDE_OF_DEPTH: Real = 2.0;
/// `(c/l)²`.
const INSIDE_OF_EDGE_SQUARED: Real = 9.0;
/// `(|z|/l)²`.
const SLOPE_SQUARED: Real = 1.0 / (512.0 * 512.0);
/// `2·A·c/(L²·H)`: `128·u`.
const AREA: Real = 1.0 / 131_072.0;

/// The face of a cuboid that a mesh is over.
#[derive(Copy, Clone, Debug)]
pub(super) struct OverFace {
    cuboid: Cuboid,
    /// Triangles in the frame of the cuboid, and the reverse.
    poses: [Pose; 2],
    axis: usize,
    sign: Real,
    /// What Parry takes for the outer normal, in the frame of the cuboid and in that of the
    /// triangles.
    normals: [Vec3; 2],
    /// Against the normal, in the frame of the triangles.
    inward: Vec3,
    /// One of its corners, the product of two edges there and the least of `c`.
    corner: Vec3,
    edge_product: Vec3,
    denominator: Real,
    /// The sum of the half-lengths; NaN if there is no face, so that no triangle is inside.
    size: Real,
    fid: PackedFeatureId,
    corner_ids: [PackedFeatureId; 3],
}

impl OverFace {
    /// The face that is farthest below `point`, which is in the frame of the cuboid. `to_cuboid`
    /// places triangles in that frame, `to_triangle` is its inverse as Parry is given it.
    pub(super) fn below(
        point: Vec3,
        cuboid: &Cuboid,
        [to_cuboid, to_triangle]: [&Pose; 2],
    ) -> Self {
        let above = point.abs() - cuboid.half_extents;
        let axis = above.max_position();
        let sign = Real::copysign(1.0, point[axis]);
        let mut normal = Vec3::ZERO;
        normal[axis] = sign;
        let face = cuboid.support_face(normal);
        let [a, b, c, _] = face.vertices;
        let edge_product = (c - b).cross(a - b);
        let denominator = -edge_product.dot(normal);
        // Parry takes a face as small as that for none.
        let is_face = denominator.abs() > Real::EPSILON && denominator.is_finite();
        let size = if is_face { cuboid.half_extents.element_sum() } else { Real::NAN };
        Self {
            cuboid: *cuboid,
            poses: [*to_cuboid, *to_triangle],
            axis,
            sign,
            normals: [normal, to_triangle.rotation * -normal],
            inward: to_cuboid.rotation.inverse() * -normal,
            corner: a,
            edge_product,
            denominator,
            size,
            fid: face.fid,
            corner_ids: [0, 1, 2].map(PackedFeatureId::vertex),
        }
    }

    /// Fills an empty manifold with the contacts that Parry's routine has without normal
    /// constraints; `flipped` if the cuboid is shape 2.
    ///
    /// If that is not sure, nothing is done and the answer is `false`.
    pub(super) fn contacts<M, C: Default + Copy>(
        &self,
        triangle: &Triangle,
        prediction: Real,
        flipped: bool,
        manifold: &mut ContactManifold<M, C>,
    ) -> bool {
        let [to_cuboid, to_triangle] = &self.poses;
        let placed = [to_cuboid * triangle.a, to_cuboid * triangle.b, to_cuboid * triangle.c];
        let lowest = to_cuboid * triangle.local_support_point_toward(self.inward);
        let height = lowest[self.axis] * self.sign - self.cuboid.half_extents[self.axis];
        let Some(inside) = self.inside(&placed, height) else {
            return false;
        };
        if height > prediction {
            return true;
        }
        let (mut of_triangle, _) = triangle_cuboid_find_local_separating_normal_oneway(
            triangle,
            &self.cuboid,
            to_triangle,
        );
        if !self.beats_edges(&placed, height, inside) {
            let (of_edges, _) = cuboid_triangle_find_local_separating_edge_twoway(
                &self.cuboid,
                triangle,
                to_cuboid,
            );
            of_triangle = of_triangle.max(of_edges);
        }
        if of_triangle > prediction {
            return true;
        }
        // Not "less": NaN does not lose.
        let wins = height >= of_triangle;
        if !wins {
            return false;
        }
        for (point, corner_id) in placed.into_iter().zip(self.corner_ids) {
            let distance = (self.corner - point).dot(self.edge_product) / self.denominator;
            manifold.points.push(TrackedContact::flipped(
                point - distance * self.normals[0],
                to_cuboid.inverse_transform_point(point),
                self.fid,
                corner_id,
                distance,
                flipped,
            ));
        }
        let [normal1, normal2] = self.normals;
        [manifold.local_n1, manifold.local_n2] =
            if flipped { [normal2, normal1] } else { [normal1, normal2] };
        true
    }

    /// How far a triangle is inside the outline, if it is enough; `height` must beat the gaps to
    /// the other faces.
    #[inline]
    fn inside(&self, [a, b, c]: &[Vec3; 3], height: Real) -> Option<Real> {
        let half = self.cuboid.half_extents;
        let (i, j, k) = (self.axis, (self.axis + 1) % 3, (self.axis + 2) % 3);
        let farthest = a.abs().max(b.abs()).max(c.abs());
        let inside = (half[j] - farthest[j]).min(half[k] - farthest[k]);
        let lowest = (a[i] * self.sign).min(b[i] * self.sign).min(c[i] * self.sign);
        let beats_faces = height > -inside && height > -lowest - half[i];
        let (ab, bc, ca) = (b - a, c - b, a - c);
        let longest_squared = ab.length_squared().max(bc.length_squared()).max(ca.length_squared());
        let double_area = (ab[j] * bc[k] - ab[k] * bc[j]).abs();
        // No comparison holds for a NaN.
        let is_inside = beats_faces
            && inside >= INSIDE_OF_SIZE * self.size
            && double_area * inside >= AREA * longest_squared * self.size;
        is_inside.then_some(inside)
    }

    /// Whether the products of the triangle's edges and those of the cuboid need no test.
    #[inline]
    fn beats_edges(&self, [a, b, c]: &[Vec3; 3], height: Real, inside: Real) -> bool {
        let is_clear = |from: &Vec3, to: &Vec3| {
            let edge = to - from;
            let (rise, length_squared) = (edge[self.axis], edge.length_squared());
            rise * rise >= SLOPE_SQUARED * length_squared
                && inside * inside >= INSIDE_OF_EDGE_SQUARED * length_squared
        };
        inside >= INSIDE_OF_DEPTH * height.abs()
            && is_clear(a, b)
            && is_clear(b, c)
            && is_clear(c, a)
    }
}

#[cfg(test)]
mod tests {
    use glamx::Quat;
    use oorandom::Rand32;
    use parry3d::query::details::contact_manifold_cuboid_triangle;

    use super::*;

    type Manifold = ContactManifold<(), ()>;

    fn bits(manifold: &Manifold) -> Vec<u32> {
        let normals = [manifold.local_n1, manifold.local_n2];
        let of_point = |p: &TrackedContact<()>| {
            let [p1, p2] = [p.local_p1.to_array(), p.local_p2.to_array()];
            let floats = [p1[0], p1[1], p1[2], p2[0], p2[1], p2[2], p.dist];
            floats.map(Real::to_bits).into_iter().chain([p.fid1.0, p.fid2.0])
        };
        let points = manifold.points.iter().flat_map(of_point);
        let normals = normals.iter().flat_map(|n| n.to_array()).map(Real::to_bits);
        if manifold.points.is_empty() { vec![] } else { normals.chain(points).collect() }
    }

    /// Asks both, and compares what ours answers: whether it does, and whether with points.
    fn compare(cuboid: &Cuboid, triangle: &Triangle, to_cuboid: &Pose, flipped: bool) -> [bool; 2] {
        const PREDICTION: Real = 0.05;
        let to_triangle = to_cuboid.inverse();
        let poses = [to_cuboid, &to_triangle];
        let middle = to_cuboid * ((triangle.a + triangle.b + triangle.c) / 3.0);
        let face = OverFace::below(middle, cuboid, poses);
        let [mut ours, mut parrys] = [Manifold::new(), Manifold::new()];
        let is_answered = face.contacts(triangle, PREDICTION, flipped, &mut ours);
        contact_manifold_cuboid_triangle(
            to_cuboid,
            &to_triangle,
            cuboid,
            triangle,
            None,
            None,
            PREDICTION,
            &mut parrys,
            flipped,
        );
        if is_answered {
            assert_eq!(bits(&ours), bits(&parrys), "{cuboid:?} {triangle:?} {to_cuboid:?}");
        }
        [is_answered, is_answered && !ours.points.is_empty()]
    }

    /// Would catch an axis that is taken to lose and does not, a point too many or too few, and
    /// another order of operations: triangles near a face, any and flat ones, with edges along the
    /// axes among them.
    #[test]
    fn contacts_are_parrys_bit_for_bit() {
        const COUNT: usize = 200_000;
        let mut random = Rand32::new(7);
        let mut unit = || random.rand_float() * 2.0 - 1.0;
        let (mut answered, mut touching) = (0, 0);
        for round in 0..COUNT {
            let half = Vec3::ONE.map(|_| Real::powf(10.0, 1.5 * unit()));
            let (axis, sign) = (round % 3, Real::copysign(1.0, unit()));
            let size = half.min_element() * Real::powf(10.0, 1.5 * unit() - 1.0);
            let is_lattice = round % 4 == 0;
            let steps = |x: Real| if is_lattice { (x * 2.0).round() / 2.0 } else { x };
            let mut place = Vec3::new(unit(), unit(), unit()) * half;
            place[axis] = sign * half[axis];
            let slope = if round % 8 < 2 { 0.0 } else { 1.0 };
            let mut corner = || {
                let mut x = size * Vec3::new(steps(unit()), steps(unit()), steps(unit()));
                x[axis] *= slope;
                x
            };
            let placed = [place + corner(), place + corner(), place + corner()];
            let turn = if is_lattice { Vec3::ZERO } else { Vec3::new(unit(), unit(), unit()) };
            let turn = Quat::from_scaled_axis(3.0 * turn);
            let to_cuboid = Pose::from_parts(Vec3::new(unit(), unit(), unit()), turn);
            let [a, b, c] = placed.map(|x| to_cuboid.inverse_transform_point(x));
            let triangle = Triangle::new(a, b, c);
            let cuboid = Cuboid::new(half);
            let [is_answered, touches] = compare(&cuboid, &triangle, &to_cuboid, round % 2 == 0);
            answered += usize::from(is_answered);
            touching += usize::from(touches);
        }
        assert!(touching > COUNT / 4, "{answered} answered, {touching} of them touching");
    }

    /// Would catch slivers, seen from the face, that are taken: walls in a plane with a corner of
    /// the face, in which Parry's clip may find that corner by rounding.
    #[test]
    fn walls_toward_a_corner_are_parrys() {
        let mut random = Rand32::new(8);
        let mut unit = || random.rand_float() * 2.0 - 1.0;
        let (mut answered, mut corners) = (0, 0);
        for round in 0..200_000 {
            let half = Vec3::new(30.0 + 20.0 * unit(), 1.0, 20.0 + 12.0 * unit());
            let corner = Vec3::new(half.x.copysign(unit()), half.y, half.z.copysign(unit()));
            let lean = if round % 3 == 0 { 1e-5 * unit() } else { 0.0 };
            let mut at = || {
                let along = 0.3 * unit();
                let aside = Vec3::new(-corner.z, 0.0, corner.x) * lean * unit();
                Vec3::new(corner.x * along, half.y + 0.3 * unit(), corner.z * along) + aside
            };
            let triangle = Triangle::new(at(), at(), at());
            let cuboid = Cuboid::new(half);
            answered += usize::from(compare(&cuboid, &triangle, &Pose::IDENTITY, false)[0]);
            let mut parrys = Manifold::new();
            let (pose, prediction) = (Pose::IDENTITY, 0.05);
            contact_manifold_cuboid_triangle(
                &pose,
                &pose,
                &cuboid,
                &triangle,
                None,
                None,
                prediction,
                &mut parrys,
                false,
            );
            corners += usize::from(parrys.points.len() > 3);
        }
        assert!(answered > 1000 && corners > 10, "{answered} answered, {corners} with a corner");
    }
}
