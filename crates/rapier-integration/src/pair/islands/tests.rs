use super::*;

type Contact = (DVec3, f64);

fn crossing(pair: [u32; 2], contact: Option<&Contact>, sheet: Option<SheetSide>) -> Crossing {
    let (normal, depth) = contact.copied().unwrap_or_default();
    let is_reliable = contact.is_some();
    Crossing {
        pair,
        is_crossing: true,
        is_touching: false,
        is_reliable,
        normal,
        depth,
        outward: [sheet.is_none().then_some(1.0), Some(1.0)],
        sheet,
        is_rejected: false,
        counts: true,
        island: 0,
    }
}

fn support(islands: &OverlapIslands, pair: [u32; 2]) -> Support {
    islands.support[islands.crossing(pair).unwrap().island]
}

fn is_open(islands: &OverlapIslands, pair: [u32; 2]) -> bool {
    islands.open_support(islands.crossing(pair).unwrap().island).is_some()
}

/// Would catch islands that are not joined through common triangles, and pairs that a second
/// pass changes without need.
#[test]
fn islands_without_a_reliable_contact_need_support() {
    let good = (DVec3::Y, 0.1);
    let mut islands = OverlapIslands::default();
    for _ in 0..2 {
        islands.clear();
        // One island is held by a contact far along it, one is not.
        for (pair, contact) in
            [([1, 1], None), ([1, 2], None), ([3, 2], Some(&good)), ([7, 7], None), ([7, 8], None)]
        {
            islands.crossings.push(crossing(pair, contact, None));
        }
        islands.join();
        assert!(islands.settle_one_ways(0.0, |_, _, _| false));
        let pairs = [[1, 1], [1, 2], [3, 2], [7, 7], [7, 8]];
        let open = pairs.map(|pair| is_open(&islands, pair));
        assert_eq!(open, [false, false, false, true, true]);
        assert!(islands.crossing([9, 9]).is_none(), "it does not cross");
        let settled = [[3, 2], [9, 9], [1, 1], [7, 8]].map(|pair| islands.is_final(pair));
        assert_eq!(settled, [true, true, false, false]);
    }
    islands.clear();
    islands.crossings.push(crossing([1, 1], Some(&good), None));
    islands.join();
    assert!(!islands.settle_one_ways(0.0, |_, _, _| false), "all is good");
    islands.clear();
    islands.crossings.push(crossing([1, 1], None, None));
    islands.crossings.push(crossing([1, 2], Some(&good), None));
    islands.join();
    assert!(!islands.settle_one_ways(0.0, |_, _, _| false), "the island is held");
}

/// Would catch a large island that turns about its only contact, and added contacts that push
/// against reliable ones.
#[test]
fn one_contact_does_not_support_a_large_island() {
    let good = (DVec3::Y, 0.1);
    let needs_support = |pairs: u32, contacts: u32| {
        let mut islands = OverlapIslands::default();
        for i in 0..pairs {
            islands.crossings.push(crossing([1, i], Some(&good).filter(|_| i < contacts), None));
        }
        islands.join();
        let needs_more = islands.settle_one_ways(0.0, |_, _, _| false);
        assert_eq!(needs_more, islands.support.first().is_some_and(|support| !support.is_enough()));
        assert!(!needs_more || islands.is_final([1, 0]));
        assert!(support(&islands, [1, 0]).agrees(DVec3::new(1.0, 0.1, 0.0)));
        assert!(!support(&islands, [1, 0]).agrees(-DVec3::Y));
        needs_more && is_open(&islands, [1, pairs - 1])
    };
    assert_eq!([4, 5].map(|pairs| needs_support(pairs, 1)), [false, true]);
    assert_eq!([8, 9].map(|pairs| needs_support(pairs, 2)), [false, true]);
}

/// Would catch added contacts that push a thin solid through a sheet.
#[test]
fn added_contacts_do_not_push_through_a_sheet() {
    for side in [1.0, -1.0] {
        let mut islands = OverlapIslands::default();
        let sheet = SheetSide { shape: Some(0), away: DVec3::Y, height: 0.01 * side };
        islands.crossings.push(crossing([1, 0], None, Some(sheet)));
        islands.join();
        assert!(islands.settle_one_ways(0.0, |_, _, _| false) && is_open(&islands, [1, 0]));
        let support = support(&islands, [1, 0]);
        assert!(support.agrees(side * DVec3::Y) && !support.agrees(-side * DVec3::Y));
    }
}
