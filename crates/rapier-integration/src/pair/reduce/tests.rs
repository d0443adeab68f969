use std::f32::consts::TAU;

use super::*;

/// Contacts divided up: for each by its place the number of its patch, in order.
fn patches(summaries: &[ContactSummary], plan: PatchPlan) -> Vec<(u32, u32)> {
    let mut patches = Reduction::default();
    patches.reduce(plan, summaries.iter().copied().map(Some));
    patches.members.iter().map(|member| (member.contact, member.patch)).collect()
}

const PLAN: PatchPlan = PatchPlan {
    far: 1.0,
    hover_distance: 0.3,
    equal_depth: 0.01,
    size: 1.0,
    one_normal: ONE_NORMAL,
};

fn summary(x: Real, distance: Real) -> ContactSummary {
    let point = Vec3::new(x, 0.0, 0.0);
    ContactSummary { part: 0, normal: Vec3::Y, point, distance, spread: 0.0 }
}

/// Would catch patches that mix parts, directions or places. A contact that carries must not be
/// replaced by one that hovers.
#[test]
fn contacts_join_the_patch_of_their_part_direction_and_place() {
    let row = [0.0, 2.0, 4.0, 4.5, 6.0, 8.0].map(|x| summary(x, -0.1));
    // Contacts between the ends of a row have no patch.
    assert_eq!(patches(&row, PLAN), [(0, 0), (5, 0)]);
    assert_eq!(patches(&row, PatchPlan::ALL_FAR), [(0, 0), (5, 0)]);
    // Four corners of an octagon make a patch. Each other one is far from these, and stays once.
    let corners = (0..16).map(|i| {
        let (sin, cos) = (TAU * i as Real / 8.0).sin_cos();
        ContactSummary { point: 4.0 * Vec3::new(cos, 0.0, sin), ..summary(0.0, -0.1) }
    });
    let corners: Vec<ContactSummary> = corners.collect();
    let chosen = patches(&corners, PLAN);
    let mut places: Vec<u32> = chosen.iter().map(|(contact, _)| contact % 8).collect();
    places.sort_unstable();
    assert_eq!(places, [0, 1, 2, 3, 4, 5, 6, 7]);
    assert!(chosen.iter().all(|(_, patch)| *patch == 0));
    let of_four = patches(&corners, PatchPlan { size: 1.5, ..PLAN });
    let first = of_four[0].0;
    assert_eq!(of_four, [0, 2, 4, 6].map(|i| (first + i, 0)));
    // Touching contacts are chosen before contacts that hover.
    let mut hanging = row.map(|row| ContactSummary { distance: 0.1, ..row });
    hanging[1].distance = -0.1;
    hanging[0].distance = -0.09;
    assert_eq!(patches(&hanging, PLAN), [(1, 0), (0, 0), (5, 0)]);
    // The deepest one opens the first.
    let deep = [summary(0.0, -0.1), summary(0.9, -0.2), summary(1.8, -0.1)];
    assert_eq!(patches(&deep, PLAN)[0], (1, 0));
    let other_part = ContactSummary { part: 1, ..summary(0.0, -0.1) };
    assert_eq!(patches(&[summary(0.0, -0.1), other_part], PLAN), [(0, 0), (1, 1)]);
    let mixed = [summary(0.0, -0.1), other_part, summary(0.1, -0.2), other_part];
    assert_eq!(patches(&mixed, PLAN), [(2, 0), (0, 0), (1, 1), (3, 1)]);
    let turned = |degrees: Real| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        ContactSummary { normal: Vec3::new(sin, cos, 0.0), ..summary(0.0, -0.1) }
    };
    assert_eq!(patches(&[summary(0.0, -0.1), turned(8.0)], PLAN), [(0, 0), (1, 0)]);
    assert_eq!(patches(&[summary(0.0, -0.1), turned(8.2)], PLAN), [(0, 0), (1, 1)]);
    // A contact that hovers beside one that touches joins its patch up to 25 degrees off.
    let over = |distance: Real, touching: Real, x: Real| {
        let over = ContactSummary { point: Vec3::new(x, 0.0, 0.0), distance, ..turned(25.0) };
        patches(&[summary(0.0, touching), over], PLAN)[1].1 == 0
    };
    assert!(over(0.4, 0.0, 0.9));
    assert!(!over(0.2, 0.0, 0.9) && !over(0.4, 0.1, 0.9) && !over(0.4, 0.0, 1.1));
    // A far contact joins a patch up to 14 degrees off.
    let is_apart = |degrees: Real| {
        let four = [0.0, 1.0, 2.0, 3.0].map(|x| summary(x, -0.1));
        let point = Vec3::new(-2.0, 0.0, 0.0);
        let far = ContactSummary { point, distance: 1.1, ..turned(degrees) };
        let kept = patches(&[&four[..], &[far]].concat(), PLAN);
        kept.iter().any(|(contact, patch)| *contact == 4 && *patch > 0)
    };
    assert_eq!([13.9, 14.2].map(is_apart), [false, true]);
}

/// Would catch points of one side only, a second point that is not the farthest, and points
/// that come twice.
#[test]
fn the_outermost_points_that_carry_are_chosen_once() {
    let at = |places: &[[Real; 3]]| -> Vec<(Vec3, Real)> {
        places.iter().map(|&[x, z, distance]| (Vec3::new(x, 0.0, z), distance)).collect()
    };
    let chosen = |points: &[(Vec3, Real)]| {
        let mut chosen = Outermost::default().choose(PLAN, points, |_| Vec3::Y).to_vec();
        chosen.sort_unstable();
        chosen
    };
    let mut points = at(&[
        [0.0, 0.0, 0.0],
        [1.0, 0.3, 0.0],
        [3.0, 0.0, 0.0],
        [1.0, -0.5, 0.0],
        [2.0, 0.9, 0.0],
        [2.0, -0.4, 0.0],
    ]);
    assert_eq!(chosen(&points), [0, 2, 3, 4]);
    points[4].1 = 0.1;
    assert_eq!(chosen(&points), [0, 1, 2, 3]);
    // Ends of two arcs that touch come before points farther aside that hover.
    let arcs = [[-0.9, 0.4, 0.0], [-0.9, -0.4, 0.0], [0.9, 0.4, 0.0], [0.9, -0.4, 0.0]];
    let aside = [[0.0, 1.3, 0.01], [0.0, -1.3, 0.01]];
    assert_eq!(chosen(&at(&[&arcs[..], &aside].concat())), [0, 1, 2, 3]);
    let line = [0.0, 1.0, 2.0, 3.0, 2.5].map(|x| [x, 0.0, -0.2]);
    assert_eq!(chosen(&at(&line)), [0, 3]);
    // A disc that is deep stands on more than one arc of its rim.
    let rim = (0..24).map(|i| {
        let (sin, cos) = (TAU * i as Real / 24.0).sin_cos();
        (Vec3::new(cos, 0.0, sin), -0.3 - 0.1 * cos)
    });
    let rim: Vec<(Vec3, Real)> = rim.collect();
    let across = chosen(&rim).into_iter().map(|i| rim[i].0.x).fold(1.0, Real::min);
    assert!(across < 0.0, "{across}");
    // A plate that is aslant still has its corners.
    let aslant = [0.0, 0.1, 0.2, 0.5, 0.9, 1.0].map(|x| [x, 0.0, 0.3 * x]);
    assert_eq!(chosen(&at(&aslant)), [0, 5]);
    // Both far corners count more than the upper rim above a corner that is near.
    let plate = [[0.0, 0.0, 0.01], [1.0, 0.0, 0.01], [0.0, -0.01, 0.04]];
    let far = [[0.0, 1.0, 0.3], [1.0, 1.0, 0.3]];
    assert_eq!(chosen(&at(&[&plate[..], &far].concat())), [0, 1, 3, 4]);
    assert_eq!(chosen(&points[..4]), [0, 1, 2, 3]);
}
