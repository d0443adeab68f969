//! Triangles exactly the margin apart are found, where f32 rounds most: by descents of every plan,
//! leaf tests and height fields. Each test fails if what the arithmetic loses there is not
//! allowed for; the numbers are in `sbbk_core::volumes::rounding`.

use crate::descent;
use crate::field::grid::Grid;
use crate::prelude::*;
use sbbk_core::field::FieldFrame;
use sbbk_core::traverse::BoxTest;
use sbbk_truth as truth;

const KDOPS: LayerPlan = LayerPlan { sphere_root: true, kdop_from_depth: Some(1) };

/// The number of pairs of triangles that are found.
fn survivors(tree1: &Tree, tree2: &Tree, pos12: &Pose3, margin: f32) -> usize {
    descent::survivors((tree1, tree2), pos12, margin).0.len()
}

/// Two triangles in frames of their own, near each other, and how far they are apart in truth.
struct Pair {
    corners: [[Vec3; 3]; 2],
    pos12: Pose3,
    distance: f64,
}

impl Pair {
    /// From corners in one frame, `apart` from each other, seen in two frames far from it. Rounding
    /// moves the corners a little, and the truth is computed from the rounded ones.
    fn of(random: &mut Random, corners: [[DVec3; 3]; 2], far: f32) -> Self {
        let turn = random.rotation();
        let pos12 = Pose3::from_parts(random.vector(far), turn);
        let placement = Placement::new(&pos12);
        let place = random.vector(far).as_dvec3();
        let one = corners[0].map(|x| (x + place).as_vec3());
        let two = corners[1].map(|x| placement.to_frame2(x + place, Vec3::ZERO).as_vec3());
        let placed = two.map(|x| placement.to_frame1(x, Vec3::ZERO));
        let distance = truth::contact(&one.map(Vec3::as_dvec3), &placed).distance;
        Self { corners: [one, two], pos12, distance }
    }

    /// Corner against corner along `n`, all others behind: what nodes can tell.
    fn tips(random: &mut Random, n: DVec3, gap: f64, far: f32) -> Self {
        let mut behind = |sign: f64| {
            let aside = random.vector(0.1).as_dvec3();
            (aside - n * aside.dot(n)) + n * (sign * f64::from(random.range(0.3, 1.0)))
        };
        let tip = n * gap;
        let one = [DVec3::ZERO, behind(-1.0), behind(-1.0)];
        let two = [tip, tip + behind(1.0), tip + behind(1.0)];
        Self::of(random, [one, two], far)
    }

    /// Corner against face, the face at a right angle to `n`: what triangles can tell.
    fn corner_and_face(random: &mut Random, n: DVec3, gap: f64, far: f32, size: f64) -> Self {
        let u = n.any_orthonormal_vector();
        let v = n.cross(u);
        let face = [2.0 * u, -u + 2.0 * v, -u - 2.0 * v].map(|x| x * size);
        let tip = n * gap;
        let two = [tip, tip + n + 0.3 * u, tip + 0.7 * n - 0.2 * v];
        Self::of(random, [face, two], far)
    }

    /// Edges across each other, nearly along each other if `across` is small, `n` at a right angle
    /// to both.
    fn edges(random: &mut Random, n: DVec3, gap: f64, far: f32, across: f64) -> Self {
        let u = n.any_orthonormal_vector();
        let v = n.cross(u);
        let tip = n * gap;
        let one = [u, -u, -n + 0.2 * v];
        let w = (0.4 * u + across * v).normalize();
        Self::of(random, [one, [tip + 1.7 * w, tip - 0.3 * w, tip + n + 0.1 * u]], far)
    }

    /// Each triangle fills two leaves of its tree, so that the root has children.
    fn check(&self, layers: LayerPlan) {
        let trees = self.corners.map(|corners| Soup::apart(corners.repeat(2 * BATCH)).tree(layers));
        let margin = (self.distance as f32).next_up();
        let survivors = survivors(&trees[0], &trees[1], &self.pos12, margin);
        assert_eq!(
            survivors,
            4 * BATCH * BATCH,
            "{margin}, {:?} at {:?}",
            self.corners,
            self.pos12
        );
    }
}

/// Boxes and k-DOPs along each of their directions.
#[test]
fn nodes_the_margin_apart_are_found() {
    let random = &mut Random(1);
    for i in 0..3000 {
        let far = [0.0, 3.0, 300.0, 1.0e4][i % 4];
        let n = match i % 3 {
            0 => [DVec3::X, DVec3::Y, DVec3::Z][i / 3 % 3],
            1 => random.vector(1.0).as_dvec3().normalize(),
            _ => directions::DIRECTIONS[i / 3 % SLABS].as_dvec3().normalize(),
        };
        let gap = f64::from(random.range(0.1, 1.0));
        let pair = Pair::tips(random, n, gap, far);
        pair.check(KDOPS);
        pair.check(LayerPlan::AABB_ONLY);
    }
}

/// Triangles along their normals and along the products of their edges; and tiny ones, whose
/// squares underflow.
#[test]
fn triangles_the_margin_apart_are_found() {
    let random = &mut Random(2);
    for i in 0..6000 {
        let far = [0.0, 3.0, 300.0, 1.0e4][i % 4];
        let n = random.vector(1.0).as_dvec3().normalize();
        let gap = f64::from(random.range(0.01, 1.0));
        let mut pair = match i % 2 {
            0 => Pair::corner_and_face(random, n, gap, far, 1.0),
            _ => Pair::edges(random, n, gap, far, 1.0),
        };
        if i % 3 == 0 {
            let tiny = 1.0e-7;
            pair.corners = pair.corners.map(|corners| corners.map(|x| x * tiny));
            pair.pos12.translation *= tiny;
            let placement = Placement::new(&pair.pos12);
            let [one, two] = pair.corners;
            let placed = two.map(|x| placement.to_frame1(x, Vec3::ZERO));
            pair.distance = truth::contact(&one.map(Vec3::as_dvec3), &placed).distance;
        }
        if pair.distance > 0.0 {
            pair.check(KDOPS);
        }
    }
}

/// Edges nearly along each other, whose product is off by much for its length.
#[test]
fn edges_along_each_other_the_margin_apart_are_found() {
    let random = &mut Random(7);
    for i in 0..4000 {
        let n = random.vector(1.0).as_dvec3().normalize();
        let gap = f64::from(random.range(0.01, 1.0));
        let across = [1.0e-2, 1.0e-3, 1.0e-4, 1.0e-5][i % 4];
        Pair::edges(random, n, gap, 0.0, across).check(KDOPS);
    }
}

/// A face so small that squares of its normal underflow, and a corner that is far for its size.
#[test]
fn tiny_triangles_the_margin_apart_are_found() {
    let random = &mut Random(6);
    for _ in 0..2000 {
        let n = random.vector(1.0).as_dvec3().normalize();
        let size = f64::from(random.range(1.0e-11, 1.0e-10));
        let gap = f64::from(random.range(0.5, 2.0));
        Pair::corner_and_face(random, n, gap, 0.0, size).check(KDOPS);
    }
}

/// Boxes of two bodies, a corner of one over a face of the other; asked either way round.
#[test]
fn boxes_the_margin_apart_are_found() {
    let random = &mut Random(3);
    for i in 0..6000 {
        let far = [0.0, 3.0, 300.0, 1.0e4][i % 4];
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][i / 4 % 3];
        // So large that no corner of the other is beside it.
        let boxes = [2.0, 0.1].map(|least| {
            let (centre, half) = (random.vector(far), random.vector(0.5).abs() + least);
            [centre - half, centre + half]
        });
        let [[_, max1], [min2, max2]] = boxes;
        // The corners of box 2 in frame 1, lowest along the axis.
        let below = |placement: &Placement| {
            let pick = |bit: usize, k: usize| if k >> bit & 1 == 0 { min2[bit] } else { max2[bit] };
            let corner = |k: usize| Vec3::from_array([0, 1, 2].map(|bit| pick(bit, k)));
            let heights = (0..8).map(|k| axis.dot(placement.to_frame1(corner(k), Vec3::ZERO)));
            heights.fold(f64::INFINITY, f64::min)
        };
        let turn = random.rotation();
        let turned = Placement::new(&Pose3::from_parts(Vec3::ZERO, turn));
        let [middle1, middle2] = boxes.map(|[min, max]| 0.5 * (min.as_dvec3() + max.as_dvec3()));
        let over = middle1 - turned.rotation * middle2;
        let top = axis.dot(max1.as_dvec3());
        let lift = top + f64::from(random.range(0.01, 1.0)) - (below(&turned) + axis.dot(over));
        let pose = Pose3::from_parts((over + lift * axis).as_vec3(), turn);
        let placement = Placement::new(&pose);
        let distance = below(&placement) - top;
        if distance <= 0.0 {
            // Far from the origin by the rounding of the pose.
            continue;
        }
        let magnitudes = boxes.map(|[min, max]| min.abs().max(max.abs()).max_element());
        let [one, two] = boxes.map(|[min, max]| TestedBox::new(min, max));
        let meet = |margin: f32| {
            let there = BoxTest::new(magnitudes, &placement, margin);
            let [m1, m2] = magnitudes;
            let back = BoxTest::new([m2, m1], &placement.inverted(), margin);
            [there.of(two).meets(one), back.of(one).meets(two)]
        };
        assert_eq!(meet((distance as f32).next_up()), [true; 2], "{i}: {distance}");
        let less = 0.9 * distance - 2.0e-5 * f64::from(magnitudes[0] + magnitudes[1] + far);
        if less > 0.0 {
            assert_eq!(meet(less as f32), [false; 2], "{i}: {less}");
        }
    }
}

/// A corner of a triangle above or below a flat field, and beside it.
#[test]
fn fields_the_margin_apart_are_found() {
    let random = &mut Random(4);
    for i in 0..2400 {
        let size = [1.0, 1.0e3, 1.0e5][i % 3];
        let scale =
            Vec3::new(random.range(0.5, 1.0), random.range(0.1, 2.0), random.range(0.5, 1.0))
                * size;
        let height = random.range(-1.0, 1.0);
        let field = Grid::new([11, 7], scale, |_, _| height);
        let (low, high) = (field.corner(0, 0), field.corner(11, 7));
        let gap = random.range(0.001, 0.1) * size;
        let inside =
            low + (high - low) * Vec3::new(random.range(0.2, 0.8), 1.0, random.range(0.2, 0.8));
        let (n, foot) = match i / 3 % 4 {
            0 => (Vec3::Y, inside),
            1 => (-Vec3::Y, inside),
            2 => (Vec3::X, inside.with_x(high.x)),
            _ => (-Vec3::Z, inside.with_z(low.z)),
        };
        let tip = (foot + gap * n).as_dvec3();
        let (n, aside) =
            (n.as_dvec3() * f64::from(size), f64::from(0.1 * size) * DVec3::new(0.6, 0.7, -0.4));
        // Quaternions of any length stretch, and the margin may be meant in the frame of the mesh.
        let stretch = [1.0, 1.5][i / 12 % 2];
        let pose = Pose3::from_parts(random.vector(size), random.rotation() * stretch);
        let placement = Placement::new(&pose);
        let corners = [tip, tip + n + aside, tip + 0.5 * n - aside];
        let corners = corners.map(|x| placement.to_frame2(x, Vec3::ZERO).as_vec3());
        let tree = Soup::apart(corners).tree(KDOPS);
        let placed = corners.map(|x| placement.to_frame1(x, Vec3::ZERO));
        let distances = field.all_triangles().map(|(_, t)| truth::contact(&t, &placed).distance);
        let distance = distances.fold(f64::INFINITY, f64::min);
        let margin = (distance / placement.rotation.x_axis.length()) as f32;
        let frame = FieldFrame::new(&field, &placement, margin.next_up());
        let mut count = 0;
        descend_field(&tree, &frame, |_, _| count += 1);
        assert!(count > 0, "{i}: {distance} from the field");
    }
}

/// The least that a bound of motion may lose is the rounding of f64.
#[test]
fn the_least_motion_is_bounded() {
    let random = &mut Random(5);
    for _ in 0..2000 {
        let ball = Sphere { centre: random.vector(1.0e3), radius: random.range(0.0, 1.0) };
        let pose = random.pose(1.0e6);
        let mut next = pose;
        next.translation.x = next.translation.x.next_up();
        let [then, now] = [pose, next].map(|pose| Placement::new(&pose));
        let moved = now.translation.x - then.translation.x;
        assert!(now.motion_bound(&then, ball.centre, ball.radius) >= moved);
        // A quaternion a little longer than one moves the centre as well.
        let mut longer = pose;
        longer.rotation *= 1.0 + f32::EPSILON;
        let longer = Placement::new(&longer);
        let centre = ball.centre.as_dvec3();
        let moved = ((longer.rotation - then.rotation) * centre).length();
        assert!(longer.motion_bound(&then, ball.centre, ball.radius) >= moved);
    }
}

/// However far a query looks, all of it is found: margins whose squares, and sums with slack,
/// overflow.
#[test]
fn any_finite_margin_finds_everything() {
    let ball = bumpy_ball(4, 0.2);
    let flat = Soup { vertices: vec![Vec3::ZERO; 3], triangles: vec![[0, 1, 2]] };
    for soup in [&ball, &flat] {
        for layers in [KDOPS, LayerPlan::SBBK, LayerPlan::AABB_ONLY] {
            let tree = soup.tree(layers);
            let count = soup.triangles.len();
            for margin in [1.0e4, 1.0e15, 2.0e19, 1.0e30, f32::MAX] {
                for distance in [0.0, 1.0e3, 1.0e-3 * margin, 0.2 * margin] {
                    let pose = Pose3::translation(0.6 * distance, -0.8 * distance, 0.0);
                    let survivors = survivors(&tree, &tree, &pose, margin);
                    assert_eq!(survivors, count * count, "{margin} at {distance}");

                    let placement = Placement::new(&pose);
                    check_boxes(&tree, &placement, margin);
                    check_field(&tree, &placement, margin, count);
                }
            }
        }
    }
}

fn check_boxes(tree: &Tree, placement: &Placement, margin: f32) {
    let magnitude = tree.magnitude();
    let test = BoxTest::new([magnitude; 2], placement, margin);
    let all = TestedBox::new(Vec3::splat(-magnitude), Vec3::splat(magnitude));
    assert!(test.of(all).meets(all), "{margin} at {:?}", placement.translation);
}

fn check_field(tree: &Tree, placement: &Placement, margin: f32, count: usize) {
    let field = Grid::new([3, 2], Vec3::ONE, |_, _| 0.1);
    let frame = FieldFrame::new(&field, placement, margin);
    let mut found = 0;
    descend_field(tree, &frame, |_, _| found += 1);
    assert_eq!(found, 2 * 3 * 2 * count, "{margin} at {:?}", placement.translation);
}

/// Slack on top of the greatest prediction distance is none.
#[test]
fn slack_stays_finite() {
    let ball = Sphere { centre: Vec3::ZERO, radius: 1.0 };
    let body = MovingBody { ball, is_ball: false };
    let placement = Placement::new(&Pose3::IDENTITY);
    for prediction in [2.0e19, 3.0e38, f32::MAX] {
        let mut slack = Slack::default();
        for _ in 0..3 {
            let limits = SlackLimits { steps: 16.0, greatest: 8.0 };
            let (SlackPlan::Descend { margin } | SlackPlan::Reuse { margin }) =
                slack.plan(body, &placement, prediction, limits);
            assert!(margin.is_finite() && margin >= prediction);
        }
    }
}
